// SPDX-License-Identifier: GPL-3.0-or-later
/// Gathers what the volume terms of one element need from the nodal arrays.
#pragma once

#include "equations/elementTerms.hpp"
#include "equations/flowStep.hpp"
#include "equations/materials.hpp"
#include "equations/stabilisation.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

/// Nodal arrays of one assembly. Sizes nNodes or nNodes*dim.
struct NodalData
{
    std::vector<double> rho, rhoOld, rhoOlder;  ///< at t^(n+1), t^n, t^(n-1) [kg/m^3]
    std::vector<double> mu;                     ///< [Pa s]
    std::vector<double> advection;              ///< a at t^(n+1) [m/s]
};

/// Ratio of densities within the three time levels of an element from which its inertia is taken first order in time: a second
/// order formula of a density that falls a thousandfold within two steps is a negative mass.
constexpr double steepDensity = 1.5;

/// By element means, and by the nodes' values where these count.
template<int D>
inline bool isSteep(const ElementData<D>& data, const int* nodes, const NodalData& nodal, double rho1, double rho2)
{
    const auto changes = [](double now, double old, double older) {
        return std::max({now, old, older}) > steepDensity*std::min({now, old, older});
    };
    if (!data.isVarying) return changes(data.rho, rho1, rho2);
    for (int a = 0; a <= D; ++a)
        if (changes(nodal.rho[nodes[a]], nodal.rhoOld[nodes[a]], nodal.rhoOlder[nodes[a]])) return true;
    return false;
}

/// Whether only structures at rest cut the element. Beside moving solids the element's mean density serves: nodes come out of them with
/// densities of their own that nothing has carried there, and with the nodes' masses a bar that falls into water gains energy.
inline bool isAtRest(const FlowStepData& step, const CutElement& cut)
{
    for (int f = cut.facetStart; f < cut.facetEnd; ++f)
        if ((*step.solids)[step.cover->facets[f].solid].kind != Solid::Kind::Fixed) return false;
    return true;
}

/// Convection by the transport's mass fluxes, moved from the middle of the step to its end, and from the resolved to the whole velocity, with
/// the mean density. Half the flux is the skew-symmetric form, in which a node's own velocity does not appear: a gas node through which in one
/// step more mass flows than its dual cell holds would be moved by a multiple of its neighbours' differences, in splashes to 100 m/s and more.
/// What exceeds the smaller of the two nodes' masses is therefore taken upwind: a difference of velocities then moves neither by more than itself.
template<int D>
inline void loadConvection(const DualCellTransport::ElementFluxes& fluxes, const FluidProperties& fluid, const NumericsControls& controls,
    ElementData<D>& data)
{
    using Pairs = CornerPairs<D>;
    constexpr int N = D + 1;
    double ag[N];
    for (int a = 0; a < N; ++a)
    {
        ag[a] = 0;
        for (int d = 0; d < D; ++d) ag[a] += data.advection[d]*data.gradN[a*D + d];
        data.convection[a*(N + 1)] = 0;
    }
    for (int p = 0; p < Pairs::count; ++p)
    {
        const int a = Pairs::first[p], b = Pairs::second[p];
        const double atEnd = data.volume/N*(ag[b] - ag[a]);
        // fluxes may be as small as 1e-310: the quotient only where it is below 1
        const double liquid = std::abs(fluxes.liquid[p]), total = std::abs(fluxes.total[p]);
        const bool isForward = (fluxes.liquid[p] > 0) == (fluxes.total[p] > 0);
        const double alpha = !isForward || liquid == 0 ? 0 : liquid < total ? liquid/total : 1;
        const double flux = density(fluid, controls, alpha)*fluxes.total[p] + data.rho*(atEnd - fluxes.total[p]);
        const double mass = std::min(data.nodalInertia[a]*data.first[a], data.nodalInertia[b]*data.first[b]);
        const double upwind = std::max(0.0, 0.5*std::abs(flux) - mass);
        data.convection[a*N + b] = 0.5*flux - upwind;
        data.convection[b*N + a] = -0.5*flux - upwind;
        data.convection[a*(N + 1)] += upwind;
        data.convection[b*(N + 1)] += upwind;
    }
}

/// False for an element without a fluid part.
template<int D>
inline bool loadElementData(int e, const SimplexMesh& mesh, const FlowStepData& step, const FluidProperties& fluid,
    const NumericsControls& controls, const NodalData& nodal, ElementData<D>& data)
{
    constexpr int N = D + 1;
    const CutElement* cut = nullptr;
    if (step.cover)
    {
        const ElementState state = step.cover->state[e];
        if (state == ElementState::Solid) return false;
        if (state == ElementState::Cut) cut = &step.cover->cuts[step.cover->cutIndex[e]];
    }
    if (cut)
    {
        data.volume = cut->volume;
        for (int a = 0; a < N; ++a) data.first[a] = cut->first[a];
        for (int k = 0; k < N*N; ++k) data.second[k] = cut->second[k];
    }
    else
    {
        data.volume = mesh.volume[e];
        const double first = data.volume/N, off = data.volume/(N*(N + 1));
        for (int a = 0; a < N; ++a) data.first[a] = first;
        for (int k = 0; k < N*N; ++k) data.second[k] = off;
        for (int a = 0; a < N; ++a) data.second[a*(N + 1)] = 2*off;
    }
    const int* nodes = &mesh.elements[std::size_t(e)*N];
    data.gradN = &mesh.gradN[std::size_t(e)*N*D];
    data.rho = data.mu = 0;
    const bool isCarried = step.transport && (!cut || isAtRest(step, *cut));
    const DualCellTransport::ElementFluxes fluxes = isCarried ? step.transport->fluxes(e) : DualCellTransport::ElementFluxes{};
    data.isVarying = fluxes.total != nullptr;
    double rho1 = 0, rho2 = 0;
    for (int d = 0; d < D; ++d) data.advection[d] = 0;
    const double inverse = 1/data.volume;
    for (int a = 0; a < N; ++a)
    {
        const int i = nodes[a];
        const double w = data.first[a]*inverse;
        data.rho += w*nodal.rho[i];
        rho1 += w*nodal.rhoOld[i];
        rho2 += w*nodal.rhoOlder[i];
        data.mu += w*nodal.mu[i];
        for (int d = 0; d < D; ++d) data.advection[d] += w*nodal.advection[std::size_t(i)*D + d];
    }
    const double h = mesh.h[e], nu = data.mu/data.rho;
    if (step.fineScale)
    {
        double square = 0;
        for (int d = 0; d < D; ++d) square += data.advection[d]*data.advection[d];
        const double share = convectingShare(step.time.dt, std::sqrt(square), h, nu);
        for (int d = 0; d < D; ++d) data.advection[d] += share*(*step.fineScale)[std::size_t(e)*D + d];
    }
    TimeScheme t = step.time;
    if (isSteep<D>(data, nodes, nodal, rho1, rho2)) t = TimeScheme::bdf(1, step.time.dt, 0);
    data.c0 = t.c0;
    data.inertia = 0.5*(t.c0*data.rho - t.c1*rho1 - t.c2*rho2);
    double one[N], two[N];  // densities of the nodes' mass at t^n, t^(n-1)
    double least = data.inertia;
    for (int a = 0; a < N; ++a)
    {
        const double now = data.isVarying ? nodal.rho[nodes[a]] : data.rho;
        one[a] = data.isVarying ? nodal.rhoOld[nodes[a]] : rho1;
        two[a] = data.isVarying ? nodal.rhoOlder[nodes[a]] : rho2;
        data.nodalInertia[a] = 0.5*(t.c0*now - t.c1*one[a] - t.c2*two[a]);
        data.densityRate[a] = t.c0*now + t.c1*one[a] + t.c2*two[a];
        data.forceShare[a] = now/data.rho - 1;
        least = std::min(least, data.nodalInertia[a]);
    }
    data.streamlineDensity = data.rho*least/data.inertia;
    if (data.isVarying) loadConvection<D>(fluxes, fluid, controls, data);
    for (int a = 0; a < N; ++a)
        for (int d = 0; d < D; ++d)
        {
            const std::size_t k = std::size_t(nodes[a])*D + d;
            const double now = t.c1*step.state->u[k], old = t.c2*step.state->uOld[k];
            data.history[a*D + d] = -(now + old);
            data.momentumHistory[a*D + d] = -(one[a]*now + two[a]*old);
        }
    double speed = 0;
    for (int d = 0; d < D; ++d) speed += data.advection[d]*data.advection[d];
    speed = std::sqrt(speed);
    data.tau = tauMomentum(step.time.dt, speed, h, nu);
    data.tauCont = controls.tauContFactor*tauContinuity(controls.tauContWithTimeStep, data.rho, speed, h, nu, data.tau);
    for (int d = 0; d < D; ++d)
        data.force[d] = step.elementForce ? (*step.elementForce)[std::size_t(e)*D + d] : 0;
    data.prepare();
    return true;
}

} // namespace flotsam
