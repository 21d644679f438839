// SPDX-License-Identifier: GPL-3.0-or-later
/// Conservative transport of the phase field on median dual cells (docs/numerics.md, section 4):
/// the face value is the model's own equilibrium profile alpha = 1/(1+exp(-psi/delta)), |grad psi| = 1,
/// reconstructed in the upwind dual cell (THINC-type), with piecewise "roof" cells where neighbouring normals disagree.
///
/// Local time steps: a node whose dual cell exchanges more than `transportCourant` of its volume in the step advances in 2^level
/// parts, an element in as many as its most demanding node. Lower levels exchange first. Between the levels' common times a
/// node carries the liquid and the whole volume it holds; their ratio is the upwind value: conservative, and bounded because no part
/// takes more than a cell holds. alpha itself then leaves out the share of the first exchange that belongs to later times.
#pragma once

#include "algebra/halo.hpp"
#include "core/boundary.hpp"
#include "core/controls.hpp"
#include "equations/interfacePlanes.hpp"
#include "equations/profileReconstruction.hpp"
#include "equations/transportBoundary.hpp"
#include "equations/transportReport.hpp"
#include "equations/volumeFlux.hpp"
#include "geometry/cover.hpp"

namespace flotsam
{

/// Where the surface is in a phase field, as gravity sees it, for cells that disagree about it to come together.
struct SurfaceReading
{
    const std::vector<double>& distance; ///< nNodes, halo up to date: from the surface by each cell's own alpha, positive in the liquid [m]
    const InterfacePlanes& planes;
    double rate;                        ///< times (element length)^(-1/2): how fast they do [m^(1/2)/s]
};

class DualCellTransport
{
public:
    DualCellTransport(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const NumericsControls& controls,
        const std::array<double, 3>& gravity = {});

    /// Advances alpha (nNodes, halo up to date before and after) by dt.
    /// u: nNodes*dim velocity at t+dt/2; fineScale: nElements*dim u' at t+dt/2 (may be empty: zero).
    /// The volume flux between nodes a and b of element e comes from r_a = -grad N_a . int_{fluid part}(u + u'),
    /// so that the sum over a dual cell is the continuity row of the flow solver (plus `pairFlux`).
    /// cover: geometry during the step (null: no solids), atEnd: at its end (null: the same). patches: where fluid enters and with what alpha;
    /// values[p] belongs to patches[p]. velocity at Fixed/Slip patches decides the boundary flux int N_i u.n;
    /// at nodes with fixed pressure the boundary flux closes the node's balance.
    /// pairFlux: further volume fluxes between nodes (ghost penalty); every rank lists all that touch its owned nodes.
    /// surface: found from this alpha (null: the profile is kept by the flow alone).
    /// Collective. Throws std::runtime_error (on every rank) for velocities that are not finite or absurdly large.
    TransportReport advance(std::vector<double>& alpha, double dt, const std::vector<double>& u,
        const std::vector<double>& fineScale, const Cover* cover,
        const std::vector<BoundaryPatch>& patches, const std::vector<PatchValues>& values,
        const std::vector<char>& isPressureFixed, const std::vector<PairFlux>& pairFlux = {}, const Cover* atEnd = nullptr,
        const SurfaceReading* surface = nullptr);

    /// Volume fluxes of the last advance(), means over its step, of an element in which alpha varied: pairs of corners in the
    /// order of CornerPairs, first to second [m^dim/s]. Null pointers elsewhere. What the momentum must be carried with.
    struct ElementFluxes { const double* total; const double* liquid; };
    ElementFluxes fluxes(int e) const;

    /// No cover will ever be given.
    void forgetFaces() { volumeFlux_.forgetNeighbours(); }

    /// Interface width delta of a node [m]: interfaceWidth().
    const std::vector<double>& width() const { return width_; }
    const DualCells& cells() const { return cells_; }

    /// Fluid volume of the dual cell of every local node [m^dim] (complete for owned and first-ring nodes), at the end
    /// of the last advance() (before it: no solids).
    const std::vector<double>& dualVolume() const { return dualVolume_; }

    /// Liquid volume the scene should hold [m^dim]. With solids, whose motion changes the dual cells, advance() keeps this
    /// value (plus inflow, minus outflow) instead of measuring alpha; NaN until the first advance() with a cover. Part of a
    /// run's state: save it, and set it back when a step is repeated or restarted.
    double liquidVolume() const { return liquidVolume_; }
    void setLiquidVolume(double volume) { liquidVolume_ = volume; }

private:
    /// What every part of the step reads; alpha is advanced in place.
    struct Arguments
    {
        std::vector<double>& alpha;
        double dt;
        const std::vector<double>& u;
        const std::vector<double>& fineScale;
        const Cover* cover;
        const std::vector<PairFlux>& pairFlux;
        double mobility;    // [m/s]
        const SurfaceReading* surface;
    };
    template<int dim> void advanceAll(const Arguments& in, TransportReport& report);
    void useCover(const Cover* cover);
    double effectiveVolume(int i) const;

    // levels (transportLevels.cpp)
    template<int dim> void findLevels(const Arguments& in);
    template<int dim> void sumElementRates(const Arguments& in);
    void sumOtherRates(const Arguments& in);
    void findNodeLevels(const Arguments& in);
    template<int dim> void storeSteppedBulk(const Arguments& in);
    void sortElements();
    void findMeetingNodes();
    void storeNeedless();
    void findPhases(const std::vector<double>& alpha, int begin, int end);
    int elementLevel(int e) const;
    template<int dim> bool isBulk(int e) const;

    // one part of the step: the elements of a level and above
    struct Part
    {
        int index;      // 0 .. 2^largestLevel_ - 1
        int level;      // begins a time step of its own, as all higher levels do
    };
    Part partAt(int index) const;
    template<int dim> void advancePart(const Arguments& in, const Part& part, TransportReport& report);
    void openCells(const Arguments& in, const Part& part);
    template<int dim> void addUpwind(const Arguments& in, const Part& part);
    void addBoundary(const Arguments& in, const Part& part, TransportReport& report);
    void addPairs(const Arguments& in, const Part& part);
    template<int dim> void findActive(const Part& part);
    template<int dim> void findAround(const Part& part);
    template<int dim> void addFaceValues(const Arguments& in);
    template<int dim> void addModelFlux(const Arguments& in);
    template<int dim> void keepProfile(const Arguments& in);
    double profileCapacity(const Arguments& in, int i) const;
    template<int dim> double disagreement(const Arguments& in, int i, int j) const;
    template<int dim> void limit(const Arguments& in, TransportReport& report);
    template<int dim> void addLimited(const Arguments& in, std::size_t k, TransportReport& report);
    void closeCells(const Arguments& in, const Part& part, TransportReport& report);
    double timeStep(const Arguments& in, int level) const { return in.dt/(1 << level); }
    void fill(int node, double volume, double alpha) { volume_[node] += volume; liquid_[node] += volume*alpha; }
    void open(int node) { if (!isOpen_[node]) { isOpen_[node] = 1; openNodes_.push_back(node); } }

    const SimplexMesh& mesh_;
    const NodeGraph& graph_;
    const Halo& halo_;
    const NumericsControls& controls_;
    std::vector<double> width_, dualVolume_, wholeVolume_;
    DualCells cells_;
    ProfileReconstruction reconstruction_;
    VolumeFlux volumeFlux_;
    TransportBoundary boundary_;
    double liquidVolume_;
    bool hasSolids_ = false;

    // one step
    enum Phase : char { Empty = 1, Full = 2 };
    std::vector<char> phase_;               // per node: Empty, Full or, between, both
    std::vector<double> inflow_, outflow_;  // per node: sums [m^dim/s]
    std::vector<double> rest_;              // per node: inflow - outflow of the elements that are not stored
    std::vector<int> level_;                // per node
    int largestLevel_ = 0;                  // of all ranks
    std::vector<int> stored_;               // inner elements: those that alpha varies in, then the others of level 1 and above
    std::vector<int> byLevel_;              // positions in stored_ by level
    std::vector<std::size_t> levelStart_;   // per level in byLevel_, and the end
    std::vector<int> storedAt_;             // per element: position in stored_, -1
    std::vector<double> liquidFlux_;        // like flux_: of the liquid, mean over the step
    std::vector<double> flux_;              // per stored element and pair of its corners, first to second [m^dim/s]
    std::vector<int> steppedNodes_;         // nodes of level 1 and above, by falling level
    std::vector<int> steppedPairs_;         // pairs with such a node, by falling level
    std::vector<int> sorted_;               // while those are sorted
    std::vector<double> liquid_, volume_;   // per owned node: what its cell holds at this moment [m^dim]
    std::vector<double> upwind_;            // per node: their ratio
    std::vector<std::vector<int>> meeting_; // per level (and higher ones that were): nodes of it in elements of higher levels
    std::vector<char> isMeeting_;
    std::vector<double> firstLiquid_, firstVolume_; // of those: what their own level has exchanged for the whole of its time step

    // one part of it
    std::vector<int> active_;               // positions in stored_ of acting elements that alpha varies in
    std::vector<int> activeLevel_;          // their levels
    std::vector<int> aroundActive_;         // elements that alpha varies in, all that touch activeNodes_
    std::vector<int> activeNodes_;          // owned and first-ring nodes of the acting elements that alpha varies in
    std::vector<std::size_t> frontElements_;    // positions in active_ of those with several fronts
    std::vector<char> isActiveNode_, isListed_;     // the latter: elements in aroundActive_
    std::vector<double> antiFlux_;          // per active element and pair: liquid beyond the upwind value [m^dim]
    std::vector<double> limiter_;           // per node: {increase, decrease}: first sums, then factors
    std::vector<int> openNodes_;            // nodes whose alpha may change
    std::vector<char> isOpen_;

    const bool isEverywhere_;               // see algebra/needlessWork.hpp
    std::size_t nNeeded_ = 0;               // of stored_, the first ones; the others because of it alone
};

/// alpha does not vary in the element.
template<int dim>
inline bool DualCellTransport::isBulk(int e) const
{
    const int* nodes = &mesh_.elements[std::size_t(e)*(dim + 1)];
    int phases = 0;
    for (int a = 0; a <= dim; ++a) phases |= phase_[nodes[a]];  // no branch: none could be foretold near the surface
    return phases != (Empty | Full);
}

} // namespace flotsam
