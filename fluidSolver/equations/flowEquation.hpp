// SPDX-License-Identifier: GPL-3.0-or-later
/// Assembly of one step's linear system from the state, the geometry and the boundary values.
#pragma once

#include "algebra/flowSystem.hpp"
#include "equations/beyondMesh.hpp"
#include "equations/eddyViscosity.hpp"
#include "equations/elementLoader.hpp"
#include "equations/rowPrefetch.hpp"
#include "equations/slipNormals.hpp"
#include "equations/solidEdges.hpp"
#include "equations/viscousForce.hpp"
#include "equations/volumeFlux.hpp"

#include <array>
#include <map>
#include <memory>
#include <tuple>

namespace flotsam
{

/// A free solid's part of the system: its inertia and what acts on it besides the fluid. Space frame.
struct FreeBody
{
    double mass = 0;                                    ///< [kg]
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centre of mass, in the predicted orientation [kg m^2]
    Vec3 velocity = Vec3::Zero();                       ///< V^n [m/s]
    Vec3 angularVelocity = Vec3::Zero();                ///< at t^n [rad/s]
    Motion lastChange;                                  ///< of both in the last step's solve, over the step
    Vec3 angularMomentum = Vec3::Zero();                ///< L^n [kg m^2/s]
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();   ///< mean over the step of all loads but newLoadShare times the fluid's new one
    double newLoadShare = 1;                            ///< of the step's mean fluid load: see Fluid::newLoadShare()
};

template<int D> struct Turning;
class PatchForces;

class FlowEquation
{
public:
    FlowEquation(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const FluidProperties& fluid,
        const NumericsControls& controls, const std::vector<BoundaryPatch>& patches);

    /// Fills system(): matrix, right-hand side, ghost faces, solids (inertia and rhs of free solids: setFreeBodies()).
    void assemble(const FlowStepData& step);
    void assembleAgain() { assemble(FlowStepData(step_)); } ///< needless: the same

    /// Inertia and right-hand side of the free solids, by the change of velocity within the step, so that a DEM step with the same
    /// constant load ends at the solved velocity. bodies: one per solid of kind Free, in the order of the solids.
    void setFreeBodies(const std::vector<FreeBody>& bodies, double dt);

    /// Adds to the solids' rows that of the fluid beyond the mesh which free ones move (BeyondMesh), as setFreeBodies() has taken it into their inertia. q: the solids' motions.
    void addBeyondRows(const std::vector<double>& q, std::vector<double>& rows) const;

    /// Basins without a prescribed pressure: shifts those of x to the level of FluidProperties::pRefValue. Collective.
    void setPressureLevel(std::vector<double>& x);

    /// Writes prescribed velocities and pressures into x (nNodes*(dim+1)).
    void applyConstraints(const std::vector<PatchValues>& values, std::vector<double>& x) const;

    /// u' = -tau (du/dt + a.grad u + (grad p - mu lap u - f)/rho) of the solution x, per element (nElements*dim) [m/s]; du/dt = c0 x + c1 u^n + c2 u^(n-1): the state
    /// must still hold t^n. The continuity rows then are those of x + u'. Of inner elements, the others' entries are left as they are: ElementHalo.
    void fineScale(const std::vector<double>& x, std::vector<double>& result) const;

    /// Volume fluxes of the pressure ghost terms and of films on walls between node pairs, for the conservative transport:
    /// row contributions r_i of face nodes as (r_i - r_j)/(dim+2).
    void ghostFluxes(const std::vector<double>& x, std::vector<PairFlux>& result) const;

    /// Forces of the solution (x, velocities q of the solids) on patches; the state must still hold t^n. Collective.
    void addPatchForces(const std::vector<double>& x, const std::vector<double>& q, PatchForces& forces) const;

    /// nNodes: by a patch, without the edge of the gas that is left out.
    const std::vector<char>& isPatchPressureFixed() const { return isPatchPressureFixed_; }

    FlowSystem& system() { return system_; }
    const FlowSystem& system() const { return system_; }

private:
    /// Volume flux from node a to b: conductance (p_a - p_b - hydrostatic) [m^dim/s].
    struct FilmPair { int a, b; double conductance, hydrostatic; };

    void startRow(int i);
    template<int D, class Real> void addElements(const int* e, const ElementData<D, Real>& data);
    template<int D> void assembleElements();
    template<int D> void assembleElementsWide();
    template<int D, class Real> void assembleElementsIn();
    template<int D> void assembleInsides();
    template<int D> void keepSweptMass();
    template<int D> void removeMassDefect();
    template<int D> void addVelocity(int slot, double value);
    template<int D> void coupleToNeighbours(int i, double value);
    template<int D> void assembleWalls();
    template<int D> void assembleOwnLoads();
    void setBeyondInertia(std::size_t s, const FreeBody& body, double dt);
    template<int D> void addSurfaceLoads(const std::vector<FacetPressure>& facets);
    template<int D> void addFacetGroup(const FacetGroup<D>& group, const Solid& solid, const Turning<D>& turning, const double* q, SolidCoupling& coupling);
    template<int D> void sumSwept();
    static constexpr double layerThickness = 0.25;  // of unresolved layers on walls and between solids, over the size of the elements there
    double layerTime(double height) const;
    double penaltyRateOf(int e) const;
    void findLayers();
    std::vector<int> findLayerNodes() const;
    void findLayerShares();
    void findCoveredRuns();
    void findLayerSolids();
    template<int D> void assembleLayers();
    template<int D> void addLayerElement(int e, double share);
    template<int D> void coupleLayers();
    template<int D> bool isOfLayer(int e) const;
    template<int D> double layerShare(int s, int e, const double* shape) const;
    template<int D> void addCoveredFacet(int s, const Turning<D>& turning, const CoveredFacet& facet, SolidCoupling& coupling);
    template<int D> void addCoveredVolume(int s, const Turning<D>& turning, const CoveredVolume& volume, SolidCoupling& coupling);
    template<int D> void addLayerWeight(int s, const Turning<D>& turning, const CoveredVolume& volume);
    template<int D> void addLayerLoad(int e, int a, const double* load, SolidCoupling& coupling);
    template<int D> void addConductance(int a, int b, double conductance, double hydrostatic);
    template<int D> void assembleGhosts();
    void findFilms();
    template<int D> void assembleFilms();
    template<int D> void addFilmFace(const MeshPatch& patch, std::size_t f);
    template<int D> void addFilm(int a, int b, double conductance, const double* force);
    template<int D> void assembleOpenBoundaries();
    template<int D> void assemblePatchWalls();
    bool hasWallTerms(const BoundaryPatch& patch, std::size_t f) const;
    template<int D, class Use> void forWallFace(const BoundaryPatch& patch, std::size_t f, const Use& use) const;
    template<int D> void addWallFace(const BoundaryPatch& patch, std::size_t f);
    template<int D> void addFaceForce(int p, std::size_t f, const std::vector<double>& x, PatchForces& forces) const;
    template<int D> void addFaceTraction(int p, std::size_t f, const std::vector<double>& x, PatchForces& forces) const;
    template<int D> void addPatchForcesT(const std::vector<double>& x, PatchForces& forces) const;
    template<int D> void addEdgeForces(const std::vector<double>& x, PatchForces& forces) const;
    void addReactions(const std::vector<double>& x, const std::vector<double>& q, PatchForces& forces) const;
    void findEdgeElements(const std::map<int, SlipNormals>& slip);
    template<int D> void assembleEdges();
    template<int D> void addEdgeElement(const EdgeElement& edge);
    template<int D> void addSolidEdge(const SolidEdges::Element& edge, const Turning<D>& turning, SolidCoupling& coupling);
    template<int D> void takeWhatWouldPass(const std::vector<double>& x, std::vector<double>& result) const;
    template<int D> void addOpenFace(const int* nodes, const double* v, const double* first, const double* second, const double* pressure);
    template<int D> void assembleGasEdge();
    void fixGasEdge();
    void fixPressures();
    void findWeakPressures();
    bool isOfPocket(int e) const;
    void holdPockets();
    void applyPockets(std::vector<double>& x) const;
    void findPressureLevels();
    void findLevelVolumes(const std::vector<int>& level, std::vector<double>& volume) const;
    void joinByBodies(const std::vector<char>& hasGas, std::vector<int>& level) const;
    double gasShare(int i) const { return fluid_.isTwoPhase ? 1 - std::clamp(step_.state->alpha[i], 0.0, 1.0) : 0; }
    void applyGasEdge(std::vector<double>& x) const;
    double gasPressure(int i) const;
    template<int D> void fineScaleT(const std::vector<double>&, std::vector<double>&) const;
    template<int D> void fineScaleWide(const std::vector<double>&, std::vector<double>&) const;
    template<int D, class Real> void fineScaleIn(const std::vector<double>&, std::vector<double>&) const;
    /// What the terms of surfaces need of an element.
    template<int D> bool loadElement(int e, ElementData<D>& data) const
    {
        ElementSource source;
        return loadMeans<D>(e, mesh_, step_, controls_, nodal_, data, source);
    }
    void setMaterials();
    void buildConstraints();
    void findWallRims(const std::vector<char>& isFixed);
    void addRimNodes(int p, const std::vector<char>& isResting);
    void setRimVelocities(const std::vector<PatchValues>& values, std::vector<double>& x) const;

    const SimplexMesh& mesh_;
    const NodeGraph& graph_;
    const Halo& halo_;
    const FluidProperties& fluid_;
    const NumericsControls& controls_;
    const std::vector<BoundaryPatch>& patches_;

    FlowStepData step_;
    FlowSystem system_;
    NodalData nodal_;
    RowPrefetch rows_;
    std::vector<char> isStarted_;               // owned nodes: see startRow()
    ViscousForce viscousForce_;
    std::unique_ptr<EddyViscosity> eddies_;  // null: none
    BeyondMesh beyond_;
    std::vector<double> defect_;                // owned nodes: see massDefect()
    std::vector<FilmPair> films_;
    struct LayerElement { int element; double share; }; // share of the solids' surface there that they cover of each other
    std::vector<LayerElement> layers_;
    struct CoveredRun { int element, solid, start, end; };  // in Cover::coveredFacets
    std::vector<CoveredRun> coveredRuns_;
    std::vector<std::vector<int>> facetsOf_, volumesOf_; // per solid: those of the cover's covered ones that it has a part in
    std::vector<char> isLayerNode_;             // nNodes, empty: no layers on any rank; nodes of layers in solids and pockets
    std::vector<int> layerSolid_;               // nNodes: whose share of the layers' content is 1 there
    std::vector<int> placeInSolid_;             // nNodes: in the coupling being assembled, else -1
    std::vector<double> ownLoads_;              // nDof of each solid: of the fluid besides the unknowns
    std::vector<double> beyondInertia_;         // nDof*nDof of each solid: see BeyondMesh; empty: no solid reaches there
    std::vector<double> beyondRate_, beyondHistory_; // of the free ones' rows: times that inertia and the motion; and without it (nDof each)
    std::tuple<FacetGroups<2>, FacetGroups<3>> facetGroups_;
    std::vector<double> swept_;                 // owned nodes: what moving surfaces take from FlowSystem::inertia, a half [kg/s]
    std::vector<double> sweptOfCut_;            // that half at the corners of every cut element, negative where fluid appears
    std::vector<char> carriesMass_, isOpen_;    // nodes of varying elements; nodes on open patches
    std::vector<char> isPatchPressureFixed_;    // nNodes: by a patch
    std::vector<char> isPressureWeak_;          // nNodes: of these, where liquid enters: see findWeakPressures()
    std::vector<double> entering_;              // nNodes, work of findWeakPressures(): volume flux into the mesh [m^dim/s]
    struct LevelWork        // of findPressureLevels(): nNodes; the others per basin or level
    {
        std::vector<char> isGiven, hasPressure, hasGas;
        std::vector<int> level, kept;
        std::vector<double> volume, sum;
    } levels_;
    double gasLevel_ = 0;                       // of the gas at rest's pressure [Pa]
    std::vector<char> isSlipEdge_;              // nNodes: on a re-entrant edge of walls, see SlipNormals
    std::vector<char> isSlipBend_;              // nNodes: where faces of one wall differ in direction
    std::vector<EdgeElement> edgeElements_;     // of patches
    SolidEdges solidEdges_;
    std::vector<int> restingNodes_;             // owned, of no-slip walls that prescribe them or share them with a patch of prescribed velocity
    struct RimNode { int node, patch, position; std::array<double, 3> area; };  // position: in the patch's nodes; area: of its faces around the node, outwards
    std::vector<RimNode> rimNodes_;             // of the resting ones: those that a patch may move, see setRimVelocities()
    std::size_t nPatchConstraints_ = 0;         // of the system's, the first ones; then those of shut pockets
    const bool hasInsides_;                     // see algebra/needlessWork.hpp
    std::vector<NodeConstraint> constraints_;   // all local nodes; directions from the walls
};

} // namespace flotsam
