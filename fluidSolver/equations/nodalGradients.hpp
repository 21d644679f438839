// SPDX-License-Identifier: GPL-3.0-or-later
/// Gradients of a P1 velocity recovered at the nodes.
#pragma once

#include "algebra/halo.hpp"
#include "geometry/cover.hpp"

#include <vector>

namespace flotsam
{

class NodalGradients
{
public:
    NodalGradients(const SimplexMesh& mesh, const Halo& halo) : mesh_(mesh), halo_(halo) {}

    /// Means over the elements with a fluid part around a node, by their volumes. A cut element counts whole: its gradient is that of the whole of it.
    /// u: nNodes*dim [m/s]; cover: null without solids. Collective.
    void find(const std::vector<double>& u, const Cover* cover);

    /// dim*dim: du_k/dx_l at k*dim + l [1/s]; 0 inside solids.
    const double* at(int node) const { return &values_[std::size_t(node)*mesh_.dim*mesh_.dim]; }

private:
    template<int D> void findOf(const std::vector<double>& u, const Cover* cover);

    const SimplexMesh& mesh_;
    const Halo& halo_;
    std::vector<double> values_, weight_;   // nNodes*dim*dim; nNodes: volume of the elements around
};

} // namespace flotsam
