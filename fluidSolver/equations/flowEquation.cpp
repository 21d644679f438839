// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/flowEquation.hpp"

#include "algebra/needlessWork.hpp"
#include "equations/elementAssembly.hpp"
#include "equations/elementLanes.hpp"
#include "equations/gasRegion.hpp"
#include "equations/materials.hpp"
#include "equations/shutPockets.hpp"
#include "equations/surfaceRings.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

constexpr double lightDensity = 0.1;  // of a light node over the mean of an element around it, at most

} // namespace

FlowEquation::FlowEquation(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const FluidProperties& fluid,
    const NumericsControls& controls, const std::vector<BoundaryPatch>& patches)
:   mesh_(mesh), graph_(graph), halo_(halo), fluid_(fluid), controls_(controls), patches_(patches),
    viscousForce_(mesh, halo), beyond_(mesh, halo, fluid, patches), hasInsides_(doesNeedless("insides"))
{
    const int dim = mesh.dim;
    system_.dim = dim;
    system_.nDof = dim == 2 ? 3 : 6;
    system_.matrix.resize(graph.column.size(), dim);
    system_.schur.resize(graph.column.size());
    system_.pressureMass.resize(mesh.nOwned);
    system_.dualVolume.resize(mesh.nOwned);
    system_.rhs.resize(std::size_t(mesh.nOwned)*(dim + 1));
    for (auto* v : {&nodal_.rho, &nodal_.rhoOld, &nodal_.rhoOlder, &nodal_.mu}) v->resize(mesh.nNodes);
    nodal_.fluid.resize(mesh.nNodes);
    for (auto* v : {&nodal_.advection, &nodal_.history}) v->resize(std::size_t(mesh.nNodes)*dim);
    isOpen_.assign(mesh.nNodes, 0);
    for (const BoundaryPatch& p : patches)
        if (p.velocity == BoundaryPatch::Velocity::Open)
            for (int i : p.nodes) isOpen_[i] = 1;
    buildConstraints();
    if (controls.mixingDepth > 0) eddies_ = std::make_unique<EddyViscosity>(mesh, halo, patches, controls);
}

void FlowEquation::setMaterials()
{
    const FlowState& s = *step_.state;
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        const double alpha = fluid_.isTwoPhase ? s.alpha[i] : 1;
        nodal_.rho[i] = density(fluid_, controls_, alpha);
        nodal_.rhoOld[i] = fluid_.isTwoPhase ? density(fluid_, controls_, s.alphaOld[i]) : nodal_.rho[i];
        nodal_.rhoOlder[i] = fluid_.isTwoPhase ? density(fluid_, controls_, s.alphaOlder[i]) : nodal_.rho[i];
        nodal_.mu[i] = viscosity(fluid_, controls_, alpha);
    }
    // Two fluids of one density are one here; by the phase, not by densities, which differ by round-off then
    const bool hasTwo = fluid_.isTwoPhase && fluid_.rhoLiquid != fluid_.rhoGas;
    const auto isAlways = [&](int i, double share)
    {
        return hasTwo ? liquidShare(controls_, s.alpha[i]) == share && liquidShare(controls_, s.alphaOld[i]) == share && liquidShare(controls_, s.alphaOlder[i]) == share
                      : share == 1;
    };
    for (int i = 0; i < mesh_.nNodes; ++i) nodal_.fluid[i] = isAlways(i, 1) ? NodalData::Liquid : isAlways(i, 0) ? NodalData::Gas : NodalData::Mixed;
    const TimeScheme& t = step_.time;
    const std::size_t n = std::size_t(mesh_.nNodes)*mesh_.dim;
    for (std::size_t k = 0; k < n; ++k)
    {
        nodal_.advection[k] = (1 + t.extrapolation)*s.u[k] - t.extrapolation*s.uOld[k];
        nodal_.history[k] = -(t.c1*s.u[k] + t.c2*s.uOld[k]);
    }
    if (!step_.transport) return;
    setNodeInertia(mesh_, step_, nodal_);
    findSurfaceRings(mesh_, halo_, nodal_);
}

void FlowEquation::assemble(const FlowStepData& step)
{
    step_ = step;
    setMaterials();
    if (controls_.viscousResidual && viscousForce_.find(nodal_.rho, nodal_.mu, nodal_.advection, step_.cover, step_.time.dt))
        step_.viscousForce = &viscousForce_.values();
    if (eddies_) eddies_->add(step_.cover, nodal_);
    std::fill(system_.rhs.begin(), system_.rhs.end(), 0.0);
    std::fill(system_.pressureMass.begin(), system_.pressureMass.end(), 0.0);
    std::fill(system_.dualVolume.begin(), system_.dualVolume.end(), 0.0);
    if (step_.cover) system_.isActive = step_.cover->isActiveNode;
    else system_.isActive.assign(mesh_.nNodes, 1);
    fixGasEdge();
    fixPressures();
    holdPockets();
    findLayers();
    findFilms();
    if (mesh_.dim == 2)
    {
        assembleElements<2>();
        assembleOpenBoundaries<2>();
        assemblePatchWalls<2>();
        assembleEdges<2>();
        assembleGasEdge<2>();
        assembleFilms<2>();
        assembleWalls<2>();
        assembleLayers<2>();
        assembleOwnLoads<2>();
        keepSweptMass<2>();
        removeMassDefect<2>();
        assembleGhosts<2>();
    }
    else
    {
        assembleElements<3>();
        assembleOpenBoundaries<3>();
        assemblePatchWalls<3>();
        assembleEdges<3>();
        assembleGasEdge<3>();
        assembleFilms<3>();
        assembleWalls<3>();
        assembleLayers<3>();
        assembleOwnLoads<3>();
        keepSweptMass<3>();
        removeMassDefect<3>();
        assembleGhosts<3>();
    }
    findPressureLevels();
    if (!hasInsides_ || !step_.cover) return;
    if (mesh_.dim == 2) assembleInsides<2>(); else assembleInsides<3>();
}

/// Needless: elements inside solids as if they were fluid, in the rows of nodes inside alone. Rows of nodes outside have no entries there: the flow does not change.
template<int D>
void FlowEquation::assembleInsides()
{
    constexpr int N = D + 1;
    const std::vector<char>& isOutside = step_.cover->isActiveNode;
    FlowStepData step = step_;
    step.cover = nullptr;
    step.transport = nullptr;
    ElementData<D> data;
    for (int e = 0; e < mesh_.nInnerElements; ++e)
    {
        if (step_.cover->state[e] != ElementState::Solid) continue;
        loadElementData<D>(e, mesh_, step, fluid_, controls_, nodal_, data);
        const int* nodes = &mesh_.elements[std::size_t(e)*N];
        const ElementHistory<D, double> history(data);
        int slots[N*N], slot[N*N][1];
        graph_.slots<N>(e, nodes, mesh_.nOwned, slots);
        for (int a = 0; a < N; ++a)
        {
            const int i = nodes[a];
            for (int b = 0; b < N; ++b) slot[a*N + b][0] = isOutside[i] ? -1 : slots[a*N + b];
            if (isOutside[i] || i >= mesh_.nOwned) continue;
            const NodeSource<D, double> source(data, a, history);
            for (int d = 0; d < D; ++d) system_.rhs[std::size_t(i)*N + d] += source.momentum[d];
            system_.rhs[std::size_t(i)*N + D] += source.continuity;
            system_.dualVolume[i] += data.first[a];
            system_.pressureMass[i] += data.first[a]/(data.mu + data.tauCont);
        }
        addElement(data, slot, system_);
    }
    system_.isActive.assign(mesh_.nNodes, 1);
}

/// Zeroes row i of the matrix unless that has been done. Just before its first use: the row then comes into the cache once instead of twice.
void FlowEquation::startRow(int i)
{
    if (isStarted_[i]) return;
    isStarted_[i] = 1;
    system_.matrix.setZero(graph_.rowStart[i], graph_.rowStart[i + 1], mesh_.dim);
    std::fill(system_.schur.begin() + graph_.rowStart[i], system_.schur.begin() + graph_.rowStart[i + 1], 0.0);
}

namespace
{

/// All elements below n: those of a kind in full batches, each of the others alone.
template<int width, class Kind, class Batch, class Single>
inline void sweep(int n, const Kind& kindOf, const Batch& ofBatch, const Single& ofSingle)
{
    int batch[nLaneKinds][width], count[nLaneKinds] = {};
    for (int e = 0; e < n; ++e)
    {
        const ElementKind kind = kindOf(e);
        if (kind == ElementKind::Alone)
        {
            ofSingle(e);
            continue;
        }
        const int k = int(kind);
        batch[k][count[k]++] = e;
        if (count[k] < width) continue;
        ofBatch(batch[k], kind);
        count[k] = 0;
    }
    for (int k = 0; k < nLaneKinds; ++k)
        for (int l = 0; l < count[k]; ++l) ofSingle(batch[k][l]);
}

} // namespace

/// Matrix, right-hand side and what is summed for each node of elements e[], one in each lane.
template<int D, class Real>
inline void FlowEquation::addElements(const int* e, const ElementData<D, Real>& data)
{
    constexpr int N = D + 1, B = D + 1, width = widthOf<Real>;
    const int* nodes[width];
    int slot[N*N][width];
    for (int l = 0; l < width; ++l)
    {
        nodes[l] = &mesh_.elements[std::size_t(e[l])*N];
        int slots[N*N];
        graph_.slots<N>(e[l], nodes[l], mesh_.nOwned, slots);
        for (int k = 0; k < N*N; ++k) slot[k][l] = slots[k];
    }
    const ElementHistory<D, Real> history(data);
    const Real ofMass = 1/(data.mu + data.tauCont);
    for (int a = 0; a < N; ++a)
    {
        const NodeSource<D, Real> source(data, a, history);
        const Real defect = massDefect(data, a), mass = (data.isVarying ? data.nodalInertia[a] : data.inertia)*data.first[a];
        const Real pressureMass = data.first[a]*ofMass;
        for (int l = 0; l < width; ++l)
        {
            const int i = nodes[l][a];
            if (i >= mesh_.nOwned) continue;
            startRow(i);
            double* rhs = &system_.rhs[std::size_t(i)*B];
            addLane<D>(source.momentum, l, rhs);
            rhs[D] += lane(source.continuity, l);
            system_.dualVolume[i] += lane(data.first[a], l);
            defect_[i] += lane(defect, l);
            system_.inertia[i] += lane(mass, l);
            system_.pressureMass[i] += lane(pressureMass, l);
            carriesMass_[i] |= data.isVarying;
            system_.isLight[i] |= nodal_.rho[i] < lightDensity*lane(data.rho, l);
        }
    }
    addElement(data, slot, system_);
}

/// Lanes of `Real`.
template<int D, class Real>
inline void FlowEquation::assembleElementsIn()
{
    defect_.assign(mesh_.nOwned, 0.0);
    carriesMass_.assign(mesh_.nOwned, 0);
    system_.isLight.assign(mesh_.nOwned, 0);
    system_.inertia.assign(mesh_.nOwned, 0.0);
    swept_.assign(mesh_.nOwned, 0.0);
    isStarted_.assign(mesh_.nOwned, 0);
    double viscous[2] = {}; // elements; sum of their mu dt/(rho h^2)
    ElementLanes<D, Real> lanes(mesh_, step_, fluid_, controls_, nodal_);
    ElementData<D> data;
    const auto countViscous = [&](int e, double mu, double rho)
    {
        if (!mesh_.isOwnedElement[e]) return;
        viscous[0] += 1;
        viscous[1] += mu*step_.time.dt/(rho*mesh_.h[e]*mesh_.h[e]);
    };
    rows_.start(mesh_, mesh_.nInnerElements);
    const auto kindOfNext = [&](int e)
    {
        rows_.fetch(e, mesh_, graph_, system_);
        return kindOf<D>(e, mesh_, step_, controls_, nodal_);
    };
    sweep<widthOf<Real>>(mesh_.nInnerElements, kindOfNext,
        [&](const int* elements, ElementKind kind)
        {
            lanes.loadResidual(elements, kind);
            lanes.loadInertia();
            addElements(elements, lanes.data);
            for (int l = 0; l < widthOf<Real>; ++l) countViscous(elements[l], lanes.data.mu[l], lanes.data.rho[l]);
        },
        [&](int e)
        {
            if (!loadElementData<D>(e, mesh_, step_, fluid_, controls_, nodal_, data)) return;
            addElements(&e, data);
            countViscous(e, data.mu, data.rho);
        });
    for (int i = 0; i < mesh_.nOwned; ++i) startRow(i);
    halo_.sum(viscous, 2);
    system_.viscousNumber = viscous[0] > 0 ? viscous[1]/viscous[0] : 0;
}

template<int D> FLOTSAM_WIDE_LANES void FlowEquation::assembleElementsWide() { assembleElementsIn<D, Lanes4>(); }

template<int D>
void FlowEquation::assembleElements()
{
    if (hasWideLanes()) assembleElementsWide<D>(); else assembleElementsIn<D, Lanes2>();
}

/// Takes from the rows of the nodes around varying densities what inertia and convection leave of a uniform velocity: the rest of
/// the mass balance (time levels, cut elements, corrections of the phase field). After assembleWalls(): what a moving surface sweeps belongs to the
/// balance. Open boundaries have their own part of it.
/// Mass that vanishes takes its node's velocity along, mass that appears has that of the nodes around, by their densities: a uniform velocity meets no force
/// either way, and no speed above the neighbours' comes from it. With the node's own velocity it drives gas beside water and moving bodies by a constant factor a step.
template<int D>
void FlowEquation::removeMassDefect()
{
    for (int i = 0; i < mesh_.nOwned; ++i)
    {
        if (!carriesMass_[i] || isOpen_[i] || (step_.gas && step_.gas->isEdge()[i])) continue;
        if (defect_[i] > 0) coupleToNeighbours<D>(i, -defect_[i]);
        else addVelocity<D>(graph_.diagonal[i], -defect_[i]);
    }
}

/// Where moving surfaces sweep more fluid away in the step than they leave, the sweep's part of the skew form, -S u with S the half of what is swept, exceeds
/// the inertia that is left: a negative mass. The swept fluid's inertia then stays in the row: (V u)^(n+1) - (V u)^n - u/2 (V^(n+1) - V^n) instead of
/// V du + u/2 dV differs by (V^n - V^(n+1)) du, and is a positive mass whatever is swept.
template<int D>
void FlowEquation::keepSweptMass()
{
    for (int i = 0; i < mesh_.nOwned; ++i)
    {
        const double removed = carriesMass_[i] ? std::max(0.0, -defect_[i]) : 0; // by removeMassDefect()
        const double kept = 2*swept_[i] - system_.inertia[i] - removed;
        if (kept <= 0) continue;
        addVelocity<D>(graph_.diagonal[i], kept);
        for (int d = 0; d < D; ++d) system_.rhs[std::size_t(i)*(D + 1) + d] += kept*step_.state->u[std::size_t(i)*D + d];
    }
}

/// value times the velocity of one entry of the matrix.
template<int D>
void FlowEquation::addVelocity(int slot, double value)
{
    for (int d = 0; d < D; ++d) system_.matrix.velocity[std::size_t(slot)*D*D + d*(D + 1)] += value;
}

/// value times the mean velocity of the active neighbours of node i, weighted with their densities.
template<int D>
void FlowEquation::coupleToNeighbours(int i, double value)
{
    const auto weight = [&](int k)
    {
        const int j = graph_.column[k];
        return j != i && system_.isActive[j] ? nodal_.rho[j] : 0;
    };
    double sum = 0;
    for (int k = graph_.rowStart[i]; k < graph_.rowStart[i + 1]; ++k) sum += weight(k);
    for (int k = graph_.rowStart[i]; k < graph_.rowStart[i + 1]; ++k) addVelocity<D>(k, value*weight(k)/sum);
}

template<int D, class Real>
inline void FlowEquation::fineScaleIn(const std::vector<double>& x, std::vector<double>& result) const
{
    constexpr int N = D + 1, B = D + 1;
    ElementLanes<D, Real> lanes(mesh_, step_, fluid_, controls_, nodal_);
    ElementData<D> data;
    ElementSource source;
    sweep<widthOf<Real>>(mesh_.nInnerElements, [&](int e) { return kindOf<D>(e, mesh_, step_, controls_, nodal_); },
        [&](const int* elements, ElementKind kind)
        {
            Real u[N*B], r[D];
            lanes.loadResidual(elements, kind);
            for (int a = 0; a < N; ++a)
                for (int k = 0; k < B; ++k) u[a*B + k] = lanes.corner(a, [&](int i) { return x[std::size_t(i)*B + k]; });
            fineScaleVelocity(lanes.data, u, r);
            for (int l = 0; l < widthOf<Real>; ++l)
                for (int d = 0; d < D; ++d) result[std::size_t(elements[l])*D + d] = r[d][l];
        },
        [&](int e)
        {
            double u[N*B], *r = &result[std::size_t(e)*D];
            std::fill(r, r + D, 0.0);
            if (isOfPocket(e)) return; // not solved for
            if (!loadResidualData<D>(e, mesh_, step_, controls_, nodal_, data, source)) return;
            for (int a = 0; a < N; ++a) std::copy_n(&x[std::size_t(mesh_.elements[std::size_t(e)*N + a])*B], B, u + a*B);
            fineScaleVelocity(data, u, r);
        });
}

template<int D> FLOTSAM_WIDE_LANES void FlowEquation::fineScaleWide(const std::vector<double>& x, std::vector<double>& result) const
{
    fineScaleIn<D, Lanes4>(x, result);
}

template<int D>
void FlowEquation::fineScaleT(const std::vector<double>& x, std::vector<double>& result) const
{
    if (hasWideLanes()) fineScaleWide<D>(x, result); else fineScaleIn<D, Lanes2>(x, result);
    takeWhatWouldPass<D>(x, result);
}

void FlowEquation::fineScale(const std::vector<double>& x, std::vector<double>& result) const
{
    result.resize(std::size_t(mesh_.nElements)*mesh_.dim);
    if (mesh_.dim == 2) fineScaleT<2>(x, result); else fineScaleT<3>(x, result);
}

template void FlowEquation::addVelocity<2>(int, double);
template void FlowEquation::addVelocity<3>(int, double);

} // namespace flotsam
