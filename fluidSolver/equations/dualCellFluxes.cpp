// SPDX-License-Identifier: GPL-3.0-or-later
/// The element loops of the dual-cell transport: face values, model flux.
#include "equations/dualCellTransport.hpp"

#include <algorithm>
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

/// Faces with a profile upwind, of which the means over what passes during the step are computed together.
class SweptFaces
{
public:
    struct Face
    {
        double* antiFlux;
        double volume, upwind;      ///< that passes, and the upwind value of alpha
        const NodeProfile* film;    ///< null: one front
    };

    ~SweptFaces() { evaluate(); }

    void addFront(const Face& face, double psi, double swept)
    {
        addMean(psi, swept);
        addFace(face);
    }

    template<int dim>
    void addFilm(const Face& face, const double* offset, const double* velocity, double dt)
    {
        const NodeProfile& film = *face.film;
        double direction[dim];
        const double across = film.steepness*bentDistance<dim>(film, offset, direction), sweptAcross = film.steepness*dt*dot<dim>(direction, velocity);
        const double wedge = film.steepness*dot<dim>(film.taper, offset), sweptWedge = film.steepness*dt*dot<dim>(film.taper, velocity);
        addMean(film.value + wedge - across, sweptWedge - sweptAcross);
        addMean(film.otherValue + wedge + across, sweptWedge + sweptAcross);
        addFace(face);
    }

private:
    static constexpr int most = 128;

    void addMean(double psi, double swept)
    {
        psi_[nMeans_] = psi;
        swept_[nMeans_++] = swept;
    }

    void addFace(const Face& face)
    {
        faces_[nFaces_++] = face;
        if (nMeans_ > most - 2) evaluate();
    }

    void evaluate()
    {
        double mean[most];
        sweptMeans(psi_, swept_, nMeans_, mean);
        const double* next = mean;
        for (int k = 0; k < nFaces_; ++k)
        {
            const Face& face = faces_[k];
            double value = *next++;
            if (face.film)
            {
                const double share = std::max(0., value + *next++ - 1);
                value = face.film->isGas ? 1 - share : share;
            }
            *face.antiFlux = face.volume*(value - face.upwind);
        }
        nMeans_ = nFaces_ = 0;
    }

    int nMeans_ = 0, nFaces_ = 0;
    double psi_[most], swept_[most];
    Face faces_[most];
};

} // namespace

/// antiFlux_ = dt F (alpha of the profile at the face - value of the upwind exchange), from the first corner to the second.
template<int dim>
void DualCellTransport::addFaceValues(const Arguments& in)
{
    using Pairs = CornerPairs<dim>;
    constexpr int n = dim + 1;
    antiFlux_.resize(active_.size()*Pairs::count);
    SweptFaces faces;
    for (std::size_t k = 0; k < active_.size(); ++k)
    {
        const int e = stored_[active_[k]];
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        const double dt = timeStep(in, activeLevel_[k]);
        const double* flux = &flux_[std::size_t(active_[k])*Pairs::count];
        double* antiFlux = &antiFlux_[k*Pairs::count];
        const FaceGeometry<dim> geometry(mesh_, in.u, nodes);

        ProfileKind kinds[n];
        bool hasRoof = false;
        for (int a = 0; a < n; ++a)
        {
            kinds[a] = reconstruction_.kind(nodes[a]);
            hasRoof = hasRoof || kinds[a] == ProfileKind::Roof;
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
            const int i = nodes[upwind];
            const ProfileKind kind = kinds[upwind];
            const SweptFaces::Face face{&antiFlux[p], dt*flux[p], upwind_[i], nullptr};
            if (kind == ProfileKind::Tail)
            {
                const double own = in.alpha[i], most = std::min(own, 1 - own);
                antiFlux[p] = face.volume*(own + std::clamp(in.alpha[nodes[a + b - upwind]] - own, -most, most) - face.upwind);
                continue;
            }
            if (kind == ProfileKind::Bulk)
            {
                antiFlux[p] = face.volume*(in.alpha[i] - face.upwind);
                continue;
            }
            const NodeProfile& profile = reconstruction_.profile(i);
            double offset[dim], velocity[dim];
            geometry.evaluate(a, b, upwind, offset, velocity);
            if (kind == ProfileKind::Film)
            {
                faces.addFilm<dim>({face.antiFlux, face.volume, face.upwind, &profile}, offset, velocity, dt);
            }
            else if (kind == ProfileKind::Front)
            {
                double direction[dim];
                const double psi = profile.value + profile.steepness*bentDistance<dim>(profile, offset, direction);
                faces.addFront(face, psi, profile.steepness*dt*dot<dim>(direction, velocity));
            }
            else
            {
                const double scale = std::min(profile.roofFactor, 1/gradientLength)*profile.steepness;
                faces.addFront(face, profile.value + scale*dot<dim>(gradient, offset), scale*dt*dot<dim>(gradient, velocity));
            }
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
            inBand = inBand || reconstruction_.kind(i) != ProfileKind::Bulk;
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
