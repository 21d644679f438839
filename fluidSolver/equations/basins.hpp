// SPDX-License-Identifier: GPL-3.0-or-later
/// Which fluid is joined: solids and walls divide the fluid into basins, joined within each by elements with a fluid part. A pressure that is constant
/// over a basin has no gradient anywhere.
#pragma once

#include "algebra/halo.hpp"
#include "geometry/cover.hpp"

namespace flotsam
{

class Basins
{
public:
    Basins(const SimplexMesh& mesh, const Halo& halo) : mesh_(mesh), halo_(halo) {}

    /// cover: of what is computed; null: no solids. isLeftOut (nNodes, same on every rank; null: none): nodes that join nothing and are in no basin. Collective.
    void find(const Cover* cover, const std::vector<int>* isLeftOut = nullptr);

    int count() const { return count_; }            ///< of all ranks
    int of(int i) const { return basin_[i]; }       ///< node i: 0..count()-1, the same on every rank; -1: no fluid there

    /// any: per basin, whether isNode (nNodes) holds for any of its nodes. Collective.
    void haveAny(const std::vector<char>& isNode, std::vector<char>& any) const;

private:
    int root(int i);
    void joinLocally(const Cover* cover, const std::vector<int>* isLeftOut);
    void number();

    const SimplexMesh& mesh_;
    const Halo& halo_;
    int count_ = 0;
    std::vector<int> basin_;        // nNodes; while find() works: parent of each node, its own number for the root of a tree
    std::vector<double> lowest_;    // nNodes: lowest global number of a node joined to this one, -1: no fluid
    std::vector<double> least_, own_, all_; // work: nNodes; basins numbered here, on all ranks
};

} // namespace flotsam
