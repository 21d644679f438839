// SPDX-License-Identifier: GPL-3.0-or-later
/// Gas far from the water left out: its elements count as solid in the cover, its nodes are no unknowns. At the edge of what is computed the
/// gas is open to the pressure of gas at rest.
#pragma once

#include "geometry/cover.hpp"

namespace flotsam
{

class GasRegion
{
public:
    /// nRings: rings of elements around the water that are computed.
    GasRegion(const SimplexMesh& mesh, const Halo& halo, int nRings);

    /// Chooses anew from where the water is; elements that are computed stay so two rings longer. Collective.
    void choose(const std::vector<double>& alpha, const Cover* cover);
    /// The next choice does not know the last one.
    void forget() { isLeftOut_.assign(isLeftOut_.size(), 1); }

    /// `cover` (may be null) without the gas that is left out. Valid until the next call. Collective.
    const Cover& cover(const Cover* cover);

    bool isLeftOut(int e) const { return isLeftOut_[e] != 0; }
    const std::vector<char>& isEdge() const { return isEdge_; }    ///< nNodes: between what is computed and what is left out

private:
    void findDepths(const std::vector<double>& alpha, const Cover* cover);

    const SimplexMesh& mesh_;
    const Halo& halo_;
    int nRings_;
    std::vector<int> depth_;            // nNodes: rings from the water
    std::vector<char> isLeftOut_;       // nElements
    std::vector<char> isEdge_;
    Cover cover_;
};

} // namespace flotsam
