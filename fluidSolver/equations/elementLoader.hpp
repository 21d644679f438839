// SPDX-License-Identifier: GPL-3.0-or-later
/// Gathers what the volume terms of one element need from the nodal arrays.
#pragma once

#include "equations/elementTerms.hpp"
#include "equations/flowStep.hpp"
#include "equations/massFluxes.hpp"
#include "equations/materials.hpp"
#include "equations/stabilisation.hpp"
#include "geometry/wallFilm.hpp"

#include <algorithm>

namespace flotsam
{

/// What an element in which the density varies has of a node: by the node's own densities.
struct NodeInertia
{
    double inertia;             ///< like that of elements [kg/(m^3 s)]
    double densityRate;         ///< drho/dt [kg/(m^3 s)]
    double momentumHistory[3];  ///< -(c1 rho^n u^n + c2 rho^(n-1) u^(n-1)) [N/m^3]
    double isSecondOrder;       ///< 1, or 0: all of these are of first order in time
    bool isSteep;               ///< see steepDensity
};

/// Nodal arrays of one assembly. Sizes nNodes or nNodes*dim.
struct NodalData
{
    std::vector<double> rho, rhoOld, rhoOlder;  ///< at t^(n+1), t^n, t^(n-1) [kg/m^3]
    std::vector<double> mu;                     ///< with the eddy viscosity [Pa s]
    std::vector<double> eddy;                   ///< eddy viscosity (EddyViscosity); empty: none [Pa s]
    std::vector<double> advection;              ///< a at t^(n+1) [m/s]
    std::vector<double> history;                ///< -(c1 u^n + c2 u^(n-1)) [m/s^2]
    enum Fluid : char { Mixed, Liquid, Gas };
    std::vector<Fluid> fluid;                   ///< the one that was there at all three times
    std::vector<NodeInertia> own;               ///< with a transport
    enum SurfaceRing : int { Far, Beside, At }; ///< At: the node has elements in which the density varies; Beside: neighbours that have
    std::vector<int> surfaceRing;               ///< with a transport
    std::vector<double> film;                   ///< FilmNode::share; empty: no films
};

/// Where the density of an element changes by more than this factor within its three time levels, its residual is first order in time, and so is its inertia where its mean
/// density counts: with a density that falls a thousandfold within two steps the second order formula gives a negative mass.
constexpr double steepDensity = 1.5;

inline bool isSteep(double now, double old, double older)
{
    return std::max({now, old, older}) > steepDensity*std::min({now, old, older});
}

/// A node's inertia is second order only where that is at least this share of the first order one: nodes that have just lost their liquid have less.
constexpr double leastInertia = 0.5;

/// What a node has of its own densities. First order in time in two cases: second order leaves too little inertia (the node has just lost its liquid), or its rate of mass
/// exceeds that of first order by more than the inertia (the node has lost its liquid and gets it back in the next step). Only the last step's fluxes balance
/// that difference. Where these are not known (beside moving solids, in elements in which the density did not vary then) it is taken from the neighbours
/// (removeMassDefect()): the node would be moved by a multiple of their velocity, and several such nodes together at any speed.
/// isFirstOrder: first order in any case.
inline NodeInertia nodeInertia(int node, int dim, bool isFirstOrder, const FlowStepData& step, const NodalData& nodal)
{
    const double now = nodal.rho[node], old = nodal.rhoOld[node], older = nodal.rhoOlder[node];
    const TimeScheme first = TimeScheme::bdf(1, step.time.dt, 0);
    const auto inertia = [&](const TimeScheme& t) { return 0.5*(t.c0*now - t.c1*old - t.c2*older); };
    const auto rate = [&](const TimeScheme& t) { return t.c0*now + t.c1*old + t.c2*older; };
    const bool isEmptied = inertia(step.time) < leastInertia*inertia(first), isRefilled = rate(step.time) - rate(first) > inertia(step.time);
    const bool isFirst = isFirstOrder || isEmptied || isRefilled;
    const TimeScheme& t = isFirst ? first : step.time;
    NodeInertia own{inertia(t), rate(t), {}, isFirst ? 0. : 1., isSteep(now, old, older)};
    for (int d = 0; d < dim; ++d)
    {
        const std::size_t k = std::size_t(node)*dim + d;
        own.momentumHistory[d] = -(t.c1*old*step.state->u[k] + t.c2*older*step.state->uOld[k]);
    }
    return own;
}

/// Fills nodal.own.
inline void setNodeInertia(const SimplexMesh& mesh, const FlowStepData& step, NodalData& nodal)
{
    nodal.own.resize(mesh.nNodes);
    for (int i = 0; i < mesh.nNodes; ++i) nodal.own[i] = nodeInertia(i, mesh.dim, false, step, nodal);
}

/// Of the element's n nodes the ring nearest to the surface; Far without a transport.
inline int nearestRing(const int* nodes, int n, const NodalData& nodal)
{
    int nearest = NodalData::Far;
    for (int a = 0; a < n && !nodal.surfaceRing.empty(); ++a) nearest = std::max(nearest, nodal.surfaceRing[nodes[a]]);
    return nearest;
}

/// Whether the transport's mass fluxes convect in an element, if it has any: where a node has elements in which the density varies. Elsewhere they carry one density, and
/// the element's own fluxes, at the end of the step, do the same.
inline bool isCarried(const int* nodes, int n, const NodalData& nodal) { return nearestRing(nodes, n, nodal) == NodalData::At; }

/// The nodes are not all of one fluid at all three times.
inline bool variesAtNodes(const int* nodes, int n, const NodalData& nodal)
{
    const NodalData::Fluid first = nodal.fluid[nodes[0]];
    return first == NodalData::Mixed || std::any_of(nodes + 1, nodes + n, [&](int i) { return nodal.fluid[i] != first; });
}

/// Share of the time step's rate in the grad-div term. Beside the surface all of it, as waves grow with less: in the elements that the mass fluxes convect in and those
/// around. Elsewhere it only resists motions that P1 cannot make free of divergence, the more the smaller the step (docs/numerics.md).
inline double gradDivTimeShare(const int* nodes, int n, const NumericsControls& controls, const NodalData& nodal)
{
    return nearestRing(nodes, n, nodal) == NodalData::Far ? controls.tauContBulk : 1;
}

/// By the element's mean densities; where the mass fluxes convect (goesByNodes), by those of its nodes.
template<int D>
inline bool isSteepElement(bool goesByNodes, const ElementData<D>& data, const int* nodes, const NodalData& nodal, double rhoOld, double rhoOlder)
{
    if (!goesByNodes) return isSteep(data.rho, rhoOld, rhoOlder);
    return std::any_of(nodes, nodes + D + 1, [&](int i) { return nodal.own[i].isSteep; });
}

/// Whether only structures at rest cut the element. Beside moving solids the element's mean density serves: nodes come out of them with
/// densities of their own that nothing has carried there, and with the nodes' masses a bar that falls into water gains energy.
inline bool isAtRest(const FlowStepData& step, const CutElement& cut)
{
    for (int f = cut.facetStart; f < cut.facetEnd; ++f)
        if ((*step.solids)[step.cover->facets[f].solid].kind != Solid::Kind::Fixed) return false;
    return true;
}

/// What the loaders hand from one to the next.
struct ElementSource
{
    const CutElement* cut = nullptr;                        ///< null: not cut
    DualCellTransport::ElementFluxes fluxes{};              ///< null where the density does not vary
    double rhoOld = 0, rhoOlder = 0;                        ///< means over the fluid part at t^n, t^(n-1) [kg/m^3]
    TimeScheme time;                                        ///< first order where the density is steep
    bool isSteep = false;                                   ///< see steepDensity
    ElementRates<double> rates;
};

/// Fluxes between the corners of an element in the order of CornerPairs.
template<int D, class Real>
struct PairFluxes
{
    static constexpr int count = CornerPairs<D>::count;

    Real total[count], liquid[count];   ///< of volume, in the step [m^D/s]
    Real lastMass[count];               ///< of mass in the last step, by the last density where none have been kept [kg/s]
    Real unkeptDensity;                 ///< the last density where none have been kept, else 0 [kg/m^3]
};

/// Convection by the transport's mass fluxes at the end of the step. Between nodes of second order they are extrapolated from the means over this step and the last, as
/// BDF2 of the nodes' masses asks (massFluxes.hpp). Elsewhere the mean over the step is used, plus the mean density times what the volume flux at the end differs from its
/// mean, and where none have been kept of the last step, as its density did not vary, both: the volume flux by the latter, the density by the former.
/// Half the flux is the skew-symmetric form, in which a node's own velocity does not appear. A gas node through which more mass flows in one step than its dual cell
/// holds would then be moved by a multiple of its neighbours' differences, in splashes to 100 m/s and more. So what exceeds the smaller of the two nodes'
/// masses, shared among the D pairs that a node has in an element, is taken upwind: the differences of velocities around a node then move it by no more
/// than themselves. (With all of the mass for each pair spikes remain in 3D, and a dam break lost half its water.)
/// source: fluxes [kg/s or m^D/s]; share: of the last step's in the extrapolation.
template<int D, class Real>
inline void loadConvection(const PairFluxes<D, Real>& source, double share, const FluidProperties& fluid, const NumericsControls& controls, ElementData<D, Real>& data)
{
    using Pairs = CornerPairs<D>;
    constexpr int N = D + 1;
    for (int a = 0; a < N; ++a) data.convection[a*(N + 1)] = Real{};
    for (int p = 0; p < Pairs::count; ++p)
    {
        const int a = Pairs::first[p], b = Pairs::second[p];
        const Real inStep = massFlux<Real>(source.liquid[p], source.total[p], fluid, controls);
        const Real ahead = share*data.isSecondOrder[a]*data.isSecondOrder[b];
        const Real atEnd = data.volume*(1.0/N)*(data.ag[b] - data.ag[a]);
        const Real later = atEnd - source.total[p];
        const Real flux = inStep + (ahead > 0 ? ahead*(inStep - source.lastMass[p]) + source.unkeptDensity*later : data.rho*later);
        const Real mass = smaller<Real>(data.nodalInertia[a]*data.first[a], data.nodalInertia[b]*data.first[b])*(1.0/D);
        const Real upwind = larger<Real>(Real{}, 0.5*absolute<Real>(flux) - mass);
        data.convection[a*N + b] = 0.5*flux - upwind;
        data.convection[b*N + a] = -0.5*flux - upwind;
        data.convection[a*(N + 1)] += upwind;
        data.convection[b*(N + 1)] += upwind;
    }
}

/// Weight of the last step's mass fluxes, see above; 0 without them.
inline double lastFluxShare(const FlowStepData& step)
{
    return step.massFluxes ? step.time.extrapolation/(1 + step.time.extrapolation) : 0;
}

template<int D, class Real>
inline Real squared(const Real* v)
{
    Real sum{};
    for (int d = 0; d < D; ++d) sum += v[d]*v[d];
    return sum;
}

/// Adds to what convects, whose mean velocity is loaded, the inertial share of u' (D; null: none). tau follows. h: length of the element [m].
template<int D, class Real>
inline ElementRates<Real> addFineScale(const Real* fineScale, const Real& h, double dt, const NumericsControls& controls, ElementData<D, Real>& data)
{
    ElementRates<Real> rates(dt, squared<D>(data.advection), h, data.mu/data.rho);
    if (fineScale)
    {
        const Real share = rates.convectingShare();
        for (int d = 0; d < D; ++d) data.advection[d] += share*fineScale[d];
        rates.setSpeed(squared<D>(data.advection), h);
    }
    data.tau = rates.tauMomentum(controls.tauFactor);
    return rates;
}

template<int D, class Real>
inline void loadTauContinuity(const ElementRates<Real>& rates, const Real& h, const Real& timeShare, const FlowStepData& step, const NumericsControls& controls,
    ElementData<D, Real>& data)
{
    const Real rate = timeShare*penaltyRate<Real>(step.time.dt, step.gravity, step.speed, controls.penaltyRate, h);
    data.tauCont = controls.tauContFactor*(controls.tauContWithTimeStep ? rates.tauContinuity(data.rho, h, rate)
        : steadyTauContinuity<Real>(data.rho, squared<D>(data.advection), h, data.mu/data.rho));
}

/// Factor of the grad-div term in a film: the length in tau_cont is that of the gap there. The film's conductance lets in what a body's motion displaces, so the
/// velocity's divergence means nothing.
inline double filmContinuity(const int* nodes, int n, const std::vector<double>& film)
{
    double share = 0;
    for (int a = 0; a < n; ++a) share = std::max(share, film[nodes[a]]);
    const double gap = std::max(filmThickness, 1 - share);
    return gap*gap;
}

/// Fluid part, materials, what convects, tau: all that the terms of surfaces need. False for an element without a fluid part.
template<int D>
inline bool loadMeans(int e, const SimplexMesh& mesh, const FlowStepData& step, const NumericsControls& controls, const NodalData& nodal,
    ElementData<D>& data, ElementSource& source)
{
    constexpr int N = D + 1;
    source = {};
    const CutElement*& cut = source.cut;
    if (step.cover)
    {
        const ElementState state = step.cover->state[e];
        if (state == ElementState::Solid) return false;
        if (state == ElementState::Cut) cut = &step.cover->cuts[step.cover->cutIndex[e]];
    }
    const int* nodes = &mesh.elements[std::size_t(e)*N];
    data.volume = cut ? cut->volume : mesh.volume[e];
    data.gradN = &mesh.gradN[std::size_t(e)*N*D];
    // sums in variables of their own: added up in `data`, every addition would wait until the last one has been written to memory and read back
    double rho = 0, rhoOld = 0, rhoOlder = 0, mu = 0, eddy = 0, advection[D] = {};
    const double inverse = cut ? 1/data.volume : 0;
    for (int a = 0; a < N; ++a)
    {
        const int i = nodes[a];
        const double w = cut ? cut->first[a]*inverse : 1.0/N;
        data.first[a] = cut ? cut->first[a] : data.volume*(1.0/N);
        rho += w*nodal.rho[i];
        rhoOld += w*nodal.rhoOld[i];
        rhoOlder += w*nodal.rhoOlder[i];
        mu += w*nodal.mu[i];
        if (!nodal.eddy.empty()) eddy += w*nodal.eddy[i];
        for (int d = 0; d < D; ++d) advection[d] += w*nodal.advection[std::size_t(i)*D + d];
    }
    data.rho = rho;
    data.mu = mu;
    data.molecular = mu - eddy;
    source.rhoOld = rhoOld;
    source.rhoOlder = rhoOlder;
    for (int d = 0; d < D; ++d) data.advection[d] = advection[d];
    source.rates = addFineScale<D, double>(step.fineScale ? &(*step.fineScale)[std::size_t(e)*D] : nullptr, mesh.h[e], step.time.dt, controls, data);
    return true;
}

/// With history and force all that the momentum residual needs. False for an element without a fluid part.
template<int D>
inline bool loadResidualData(int e, const SimplexMesh& mesh, const FlowStepData& step, const NumericsControls& controls, const NodalData& nodal,
    ElementData<D>& data, ElementSource& source)
{
    constexpr int N = D + 1;
    if (!loadMeans<D>(e, mesh, step, controls, nodal, data, source)) return false;
    const int* nodes = &mesh.elements[std::size_t(e)*N];
    if (step.transport && isCarried(nodes, N, nodal) && (!source.cut || isAtRest(step, *source.cut))) source.fluxes = step.transport->fluxes(e);
    data.isVarying = source.fluxes.total != nullptr;
    source.time = step.time;
    source.isSteep = isSteepElement<D>(data.isVarying, data, nodes, nodal, source.rhoOld, source.rhoOlder);
    if (source.isSteep) source.time = TimeScheme::bdf(1, step.time.dt, 0);
    const double c1 = source.time.c1, c2 = source.time.c2;
    data.c0 = source.time.c0;
    for (int a = 0; a < N; ++a)
        for (int d = 0; d < D; ++d)
        {
            const std::size_t k = std::size_t(nodes[a])*D + d;
            data.history[a*D + d] = -(c1*step.state->u[k] + c2*step.state->uOld[k]);
        }
    for (int d = 0; d < D; ++d)
        data.force[d] = step.elementForce ? (*step.elementForce)[std::size_t(e)*D + d] : 0;
    for (int d = 0; d < D; ++d)
        data.viscousForce[d] = step.viscousForce ? (*step.viscousForce)[std::size_t(e)*D + d] : 0;
    data.prepare();
    return true;
}

/// -(c1 rho^n u^n + c2 rho^(n-1) u^(n-1)) of corner a with the element's densities: rho^n times the velocity's own history, loaded before, and where rho^(n-1) is
/// another the difference. In most elements it is not, which saves two thirds of the reads.
template<int D>
inline void loadMomentumHistory(int a, int node, double old, double older, const FlowStepData& step, const TimeScheme& time, ElementData<D>& data)
{
    for (int d = 0; d < D; ++d) data.momentumHistory[a*D + d] = old*data.history[a*D + d];
    const double more = (old - older)*time.c2;
    for (int d = 0; d < D && more != 0; ++d) data.momentumHistory[a*D + d] += more*step.state->uOld[std::size_t(node)*D + d];
}

/// What corner a has of its node, and what the element's streamline density and force share follow from.
template<int D>
inline void loadNodeInertia(int a, double rho, const NodeInertia& own, ElementData<D>& data)
{
    data.isSecondOrder[a] = own.isSecondOrder;
    data.nodalInertia[a] = own.inertia;
    data.densityRate[a] = own.densityRate;
    data.forceShare[a] = rho/data.rho - 1;
    std::copy_n(own.momentumHistory, D, data.momentumHistory + a*D);
}

/// Inertia and momentum history by BDF of the momentum, with the nodes' own densities where the density varies.
template<int D>
inline void loadInertia(const int* nodes, const FlowStepData& step, const NumericsControls& controls, const NodalData& nodal, const ElementSource& source,
    ElementData<D>& data)
{
    const TimeScheme& t = source.time;
    data.inertia = 0.5*(t.c0*data.rho - t.c1*source.rhoOld - t.c2*source.rhoOlder);
    data.streamlineDensity = data.rho;
    if (!data.isVarying)
    {
        const double rate = t.c0*data.rho + t.c1*source.rhoOld + t.c2*source.rhoOlder;
        for (int a = 0; a <= D; ++a)
        {
            data.densityRate[a] = rate;
            loadMomentumHistory(a, nodes[a], source.rhoOld, source.rhoOlder, step, t, data);
        }
        return;
    }
    const bool isFirstOrder = source.isSteep && controls.surfaceTimeOrder == 1;
    double least = data.inertia;
    for (int a = 0; a <= D; ++a)
    {
        loadNodeInertia<D>(a, nodal.rho[nodes[a]], isFirstOrder ? nodeInertia(nodes[a], D, true, step, nodal) : nodal.own[nodes[a]], data);
        least = std::min(least, data.nodalInertia[a]);
    }
    data.streamlineDensity *= least/data.inertia;
}

/// All that the matrix needs. False for an element without a fluid part.
template<int D>
inline bool loadElementData(int e, const SimplexMesh& mesh, const FlowStepData& step, const FluidProperties& fluid,
    const NumericsControls& controls, const NodalData& nodal, ElementData<D>& data)
{
    ElementSource source;
    if (!loadResidualData<D>(e, mesh, step, controls, nodal, data, source)) return false;
    data.second = source.cut ? source.cut->second : nullptr;
    loadInertia<D>(&mesh.elements[std::size_t(e)*(D + 1)], step, controls, nodal, source, data);
    if (data.isVarying)
    {
        PairFluxes<D, double> fluxes;
        const double* last = step.massFluxes ? step.massFluxes->of(e) : nullptr;
        fluxes.unkeptDensity = last ? 0 : source.rhoOld;
        for (int p = 0; p < fluxes.count; ++p)
        {
            fluxes.total[p] = source.fluxes.total[p];
            fluxes.liquid[p] = source.fluxes.liquid[p];
            fluxes.lastMass[p] = last ? last[p] : source.rhoOld*fluxes.total[p];
        }
        loadConvection<D, double>(fluxes, lastFluxShare(step), fluid, controls, data);
    }
    loadTauContinuity<D, double>(source.rates, mesh.h[e], gradDivTimeShare(&mesh.elements[std::size_t(e)*(D + 1)], D + 1, controls, nodal), step, controls, data);
    if (!nodal.film.empty()) data.tauCont *= filmContinuity(&mesh.elements[std::size_t(e)*(D + 1)], D + 1, nodal.film);
    return true;
}

} // namespace flotsam
