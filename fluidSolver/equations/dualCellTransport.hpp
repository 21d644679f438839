// SPDX-License-Identifier: GPL-3.0-or-later
/// Conservative transport of the phase field on median dual cells (docs/numerics.md, section 4):
/// the face value is the model's own equilibrium profile alpha = 1/(1+exp(-psi/delta)), |grad psi| = 1,
/// reconstructed in the upwind dual cell (THINC-type), with piecewise "roof" cells where neighbouring normals disagree.
#pragma once

#include "algebra/halo.hpp"
#include "core/boundary.hpp"
#include "core/controls.hpp"
#include "equations/profileReconstruction.hpp"
#include "equations/transportBoundary.hpp"
#include "equations/transportReport.hpp"
#include "equations/volumeFlux.hpp"
#include "geometry/cover.hpp"

namespace flotsam
{

class DualCellTransport
{
public:
    DualCellTransport(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const NumericsControls& controls);

    /// Advances alpha (nNodes, halo up to date before and after) by dt.
    /// u: nNodes*dim velocity at t+dt/2; fineScale: nElements*dim u' at t+dt/2 (may be empty: zero).
    /// The volume flux between nodes a and b of element e comes from r_a = -grad N_a . int_{fluid part}(u + u'),
    /// so that the sum over a dual cell is the continuity row of the flow solver (plus `pairFlux`).
    /// cover: geometry during the step (null: no solids). patches: where fluid enters and with what alpha;
    /// values[p] belongs to patches[p]. velocity at Fixed/Slip patches decides the boundary flux int N_i u.n;
    /// at nodes with fixed pressure the boundary flux closes the node's balance.
    /// pairFlux: further volume fluxes between nodes (ghost penalty); every rank lists all that touch its owned nodes.
    /// Collective. Throws std::runtime_error (on every rank) for velocities that are not finite or absurdly large.
    TransportReport advance(std::vector<double>& alpha, double dt, const std::vector<double>& u,
        const std::vector<double>& fineScale, const Cover* cover,
        const std::vector<BoundaryPatch>& patches, const std::vector<PatchValues>& values,
        const std::vector<char>& isPressureFixed, const std::vector<PairFlux>& pairFlux = {});

    /// Interface width delta of a node [m]: controls.interfaceWidth times the mean element length around it.
    const std::vector<double>& width() const { return width_; }

    /// Fluid volume of the dual cell of every local node [m^dim] (complete for owned and first-ring nodes), for the cover
    /// of the last advance() (before it: no solids).
    const std::vector<double>& dualVolume() const { return dualVolume_; }

    /// Liquid volume the scene should hold [m^dim]. With solids, whose motion changes the dual cells, advance() keeps this
    /// value (plus inflow, minus outflow) instead of measuring alpha; NaN until the first advance() with a cover. Part of a
    /// run's state: save it, and set it back when a step is repeated or restarted.
    double liquidVolume() const { return liquidVolume_; }
    void setLiquidVolume(double volume) { liquidVolume_ = volume; }

private:
    /// What every sub-step reads; alpha is advanced in place.
    struct Arguments
    {
        std::vector<double>& alpha;
        double dt;
        const std::vector<double>& u;
        const std::vector<double>& fineScale;
        const Cover* cover;
        const std::vector<PairFlux>& pairFlux;
    };
    template<int dim> void advanceAll(const Arguments& arguments, TransportReport& report);
    void findActive(const std::vector<double>& alpha, const std::vector<PairFlux>& pairFlux);
    template<int dim> void storeVolumeFluxes(const Arguments& arguments);
    void clearSums();
    void addBoundaryInflow(const std::vector<double>& alpha);
    double largestRate(const Arguments& arguments);
    template<int dim> void addFaceValues(const Arguments& arguments, double dt);
    template<int dim> void addModelFlux(const Arguments& arguments, double mobility);
    void limit(const Arguments& arguments, double dt);
    template<int dim> void update(const Arguments& arguments, double dt, TransportReport& report);
    void countBoundary(const std::vector<double>& alpha, double dt, TransportReport& report) const;
    void useCover(const Cover* cover);
    double effectiveVolume(int i) const;

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

    // where alpha varies, renewed every sub-step
    std::vector<char> phase_;               // per node: 0 empty, 1 full, 2 between
    std::vector<int> activeElements_;       // inner elements first
    std::size_t nInnerActive_ = 0;
    std::vector<int> activeNodes_;          // owned and first-ring nodes of the inner active elements and of the inflow
    std::vector<char> isActiveNode_;
    std::vector<double> flux_, antiFlux_;   // per inner active element and pair of its corners
    std::vector<double> inflowSum_, gain_;  // per node: sum of inflow [m^dim/s]; upwind change of alpha times volume
    std::vector<double> limiter_;           // per node: {increase, decrease}: first sums, then factors
};

} // namespace flotsam
