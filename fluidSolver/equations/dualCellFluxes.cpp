// SPDX-License-Identifier: GPL-3.0-or-later
/// The element loops of the dual-cell transport: face values, model flux.
#include "equations/dualCellTransport.hpp"

#include <cmath>

namespace flotsam
{

namespace
{

template<int dim>
double dot(const double* a, const double* b)
{
    double s = a[0]*b[0] + a[1]*b[1];
    if constexpr (dim == 3)
    {
        s += a[2]*b[2];
    }
    return s;
}

/// What the dual faces of one element share.
template<int dim>
struct FaceGeometry
{
    static constexpr int n = dim + 1;
    static constexpr DualFaceWeights weights = DualFaceWeights::of(dim);
    const double* x[n];
    const double* u[n];
    double xSum[dim] = {}, uSum[dim] = {};

    FaceGeometry(const SimplexMesh& mesh, const std::vector<double>& velocity, const int* nodes)
    {
        for (int a = 0; a < n; ++a)
        {
            x[a] = &mesh.x[std::size_t(nodes[a])*dim];
            u[a] = &velocity[std::size_t(nodes[a])*dim];
            for (int d = 0; d < dim; ++d)
            {
                xSum[d] += x[a][d];
                uSum[d] += u[a][d];
            }
        }
    }

    static double atFace(double sum, double a, double b) { return weights.far*sum + (weights.near - weights.far)*(a + b); }

    /// Centroid of the dual face (a, b) relative to corner `from`, and the velocity there.
    void evaluate(int a, int b, int from, double* offset, double* velocity) const
    {
        for (int d = 0; d < dim; ++d)
        {
            offset[d] = atFace(xSum[d], x[a][d], x[b][d]) - x[from][d];
            velocity[d] = atFace(uSum[d], u[a][d], u[b][d]);
        }
    }
};

/// Mean alpha of a film over what passes a face during a step.
template<int dim>
double filmSweptMean(const NodeProfile& film, const double* offset, const double* velocity, double dt)
{
    double direction[dim];
    const double across = film.steepness*bentDistance<dim>(film, offset, direction), sweptAcross = film.steepness*dt*dot<dim>(direction, velocity);
    const double wedge = film.steepness*dot<dim>(film.taper, offset), sweptWedge = film.steepness*dt*dot<dim>(film.taper, velocity);
    const double upper = sweptMean(film.value + wedge - across, sweptWedge - sweptAcross);
    const double lower = sweptMean(film.otherValue + wedge + across, sweptWedge + sweptAcross);
    const double share = std::max(0., upper + lower - 1);
    return film.isGas ? 1 - share : share;
}

} // namespace

/// antiFlux_ = dt F (alpha of the profile at the face - value of the upwind exchange), from the first corner to the second.
template<int dim>
void DualCellTransport::addFaceValues(const Arguments& in)
{
    using Pairs = CornerPairs<dim>;
    constexpr int n = dim + 1;
    antiFlux_.resize(active_.size()*Pairs::count);
    for (std::size_t k = 0; k < active_.size(); ++k)
    {
        const int e = stored_[active_[k]];
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        const double dt = timeStep(in, activeLevel_[k]);
        const double* flux = &flux_[std::size_t(active_[k])*Pairs::count];
        double* antiFlux = &antiFlux_[k*Pairs::count];
        const FaceGeometry<dim> geometry(mesh_, in.u, nodes);

        bool hasRoof = false;
        for (int a = 0; a < n; ++a)
        {
            hasRoof = hasRoof || reconstruction_.profile(nodes[a]).kind == NodeProfile::Kind::Roof;
        }
        double gradient[dim] = {}, gradientLength = 1e-30;
        if (hasRoof)
        {
            const double* g = &mesh_.gradN[std::size_t(e)*n*dim];
            for (int a = 0; a < n; ++a)
            {
                for (int d = 0; d < dim; ++d)
                {
                    gradient[d] += reconstruction_.level(nodes[a])*g[a*dim + d];
                }
            }
            gradientLength += std::sqrt(dot<dim>(gradient, gradient));
        }

        for (int p = 0; p < Pairs::count; ++p)
        {
            const int a = Pairs::first[p], b = Pairs::second[p], upwind = flux[p] > 0 ? a : b;
            const NodeProfile& profile = reconstruction_.profile(nodes[upwind]);
            if (profile.kind == NodeProfile::Kind::Tail)
            {
                const double own = in.alpha[nodes[upwind]], most = std::min(own, 1 - own);
                antiFlux[p] = dt*flux[p]*(own + std::clamp(in.alpha[nodes[upwind == a ? b : a]] - own, -most, most) - upwind_[nodes[upwind]]);
                continue;
            }
            if (profile.kind == NodeProfile::Kind::Bulk)
            {
                antiFlux[p] = dt*flux[p]*(in.alpha[nodes[upwind]] - upwind_[nodes[upwind]]);
                continue;
            }
            double offset[dim], velocity[dim];
            geometry.evaluate(a, b, upwind, offset, velocity);
            if (profile.kind == NodeProfile::Kind::Film)
            {
                antiFlux[p] = dt*flux[p]*(filmSweptMean<dim>(profile, offset, velocity, dt) - upwind_[nodes[upwind]]);
                continue;
            }
            double psi, swept;
            if (profile.kind == NodeProfile::Kind::Front)
            {
                double direction[dim];
                psi = profile.value + profile.steepness*bentDistance<dim>(profile, offset, direction);
                swept = profile.steepness*dt*dot<dim>(direction, velocity);
            }
            else
            {
                const double scale = std::min(profile.roofFactor, 1/gradientLength)*profile.steepness;
                psi = profile.value + scale*dot<dim>(gradient, offset);
                swept = scale*dt*dot<dim>(gradient, velocity);
            }
            antiFlux[p] = dt*flux[p]*(sweptMean(psi, swept) - upwind_[nodes[upwind]]);
        }
    }
}

/// The Allen-Cahn flux gamma delta grad alpha (1 - 1/|grad level|), which vanishes in the equilibrium profile
/// (ratio form).
template<int dim>
void DualCellTransport::addModelFlux(const Arguments& in)
{
    using Pairs = CornerPairs<dim>;
    constexpr int n = dim + 1;
    for (std::size_t k = 0; k < active_.size(); ++k)
    {
        const int e = stored_[active_[k]];
        if (in.cover && in.cover->state[e] != ElementState::Fluid)
        {
            continue;
        }
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        const double* g = &mesh_.gradN[std::size_t(e)*n*dim];
        double slope[dim] = {}, gradient[dim] = {}, width = 0;
        bool inBand = false;
        for (int a = 0; a < n; ++a)
        {
            const int i = nodes[a];
            inBand = inBand || reconstruction_.profile(i).kind != NodeProfile::Kind::Bulk;
            width += width_[i]/n;
            for (int d = 0; d < dim; ++d)
            {
                slope[d] += in.alpha[i]*g[a*dim + d];
                gradient[d] += reconstruction_.level(i)*g[a*dim + d];
            }
        }
        const double length = std::sqrt(dot<dim>(gradient, gradient));
        if (!inBand || length <= 0)
        {
            continue;
        }
        const double factor = timeStep(in, activeLevel_[k])*in.mobility*width*(1 - std::min(2., 1/length))*mesh_.volume[e]/n;
        for (int p = 0; p < Pairs::count; ++p)
        {
            antiFlux_[k*Pairs::count + p] -= factor*(dot<dim>(slope, g + Pairs::second[p]*dim) - dot<dim>(slope, g + Pairs::first[p]*dim));
        }
    }
}

template void DualCellTransport::addFaceValues<2>(const Arguments&);
template void DualCellTransport::addModelFlux<2>(const Arguments&);
template void DualCellTransport::addFaceValues<3>(const Arguments&);
template void DualCellTransport::addModelFlux<3>(const Arguments&);

} // namespace flotsam
