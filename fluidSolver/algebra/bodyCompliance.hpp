// SPDX-License-Identifier: GPL-3.0-or-later
/// The part of free bodies in the pressure's Schur complement: a pressure on a body moves it, and the fluid around it the less.
///
///     S = T^-1 + K M^-1 K^T,   S^-1 = T - T K (M + K^T T K)^-1 K^T T      (Sherman, Morrison & Woodbury)
///
/// T: inverse of the fluid's own Schur complement, K: continuity rows by the bodies' motions, M: the bodies' own rows. In gaps between bodies hardly any pressure is
/// needed to move them apart, and a T that knows no bodies answers far too strongly there (docs/numerics/5-linear-solver.md, 5.9). What a body feels is of the whole T; its
/// answer, and the added mass K^T T K, are of the diagonal of T: bodies in gaps couple through their common nodes.
#pragma once

#include "algebra/keptCholesky.hpp"
#include "algebra/solidUnknowns.hpp"

#include <utility>

namespace flotsam
{

class BodyCompliance
{
public:
    BodyCompliance(const Halo& halo, int nOwned) : halo_(halo), nOwned_(nOwned) {}

    /// pointwise: of each owned node, the inverse of the fluid's Schur complement there; 0 at nodes without a free pressure. Collective.
    void set(const FlowSystem& system, const SolidUnknowns& solids, const std::vector<double>& pointwise);

    /// Takes from p = T r (owned nodes) what the bodies give way. Collective.
    void correct(double* p);

private:
    /// One of the nodes at the surface of a body.
    struct SurfaceNode
    {
        int node, body;     // owned; number among the free bodies
        double flux[6];     // into the node's continuity row by the body's motions
        double pointwise;
    };
    using Pair = std::pair<int, int>;           // bodies, the first not the smaller

    void findSurface(const FlowSystem& system, const SolidUnknowns& solids, const std::vector<double>& pointwise);
    template<class Visit> void forPairs(const Visit& visit) const;
    void findAddedMasses();
    void setEntries(const SolidUnknowns& solids);

    const Halo& halo_;
    const int nOwned_;
    int nDof_ = 0, nBodies_ = 0;
    std::vector<SurfaceNode> surface_;  // ascending by node
    KeptCholesky matrix_;               // M + K^T T K: all free bodies, the same on every rank
    std::vector<Pair> pairs_;           // work: bodies with common nodes here
    std::vector<double> blocks_, allBlocks_;    // likewise: of this rank, of all
    SparseEntries entries_;             // likewise
    std::vector<double> motion_;
};

} // namespace flotsam
