// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/gasRegion.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

constexpr double wet = 0.01;        // alpha from which a node counts as water
constexpr int keptLonger = 2;       // rings beyond nRings in which a computed element stays one

} // namespace

GasRegion::GasRegion(const SimplexMesh& mesh, const Halo& halo, int nRings)
:   mesh_(mesh), halo_(halo), nRings_(nRings), depth_(mesh.nNodes), isLeftOut_(mesh.nElements, 1), isEdge_(mesh.nNodes, 0)
{}

/// Cut elements count as water: the terms of a solid's surface reach over its neighbours.
void GasRegion::findDepths(const std::vector<double>& alpha, const Cover* cover)
{
    const int n = mesh_.dim + 1, far = nRings_ + keptLonger + 1;
    for (int i = 0; i < mesh_.nNodes; ++i) depth_[i] = alpha[i] > wet ? 0 : far;
    if (cover)
        for (const CutElement& cut : cover->cuts)
            for (int a = 0; a < n; ++a) depth_[mesh_.elements[std::size_t(cut.element)*n + a]] = 0;
    halo_.update(depth_, 1);
    for (int ring = 1; ring < far; ++ring)
    {
        for (int e = 0; e < mesh_.nElements; ++e)
        {
            const int* nodes = &mesh_.elements[std::size_t(e)*n];
            if (std::none_of(nodes, nodes + n, [&](int i) { return depth_[i] == ring - 1; })) continue;
            for (int a = 0; a < n; ++a) depth_[nodes[a]] = std::min(depth_[nodes[a]], ring);
        }
        halo_.update(depth_, 1);
    }
}

void GasRegion::choose(const std::vector<double>& alpha, const Cover* cover)
{
    findDepths(alpha, cover);
    const int n = mesh_.dim + 1;
    for (int e = 0; e < mesh_.nElements; ++e)
    {
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        int nearest = depth_[nodes[0]];
        for (int a = 1; a < n; ++a) nearest = std::min(nearest, depth_[nodes[a]]);
        isLeftOut_[e] = nearest >= nRings_ + (isLeftOut_[e] ? 0 : keptLonger);
    }
}

const Cover& GasRegion::cover(const Cover* cover)
{
    const int n = mesh_.dim + 1;
    if (cover) cover_ = *cover;
    else
    {
        cover_.distance.assign(mesh_.nNodes, farDistance);
        cover_.nearestSolid.assign(mesh_.nNodes, -1);
        cover_.state.assign(mesh_.nElements, ElementState::Fluid);
        cover_.cutIndex.assign(mesh_.nElements, -1);
    }
    cover_.isActiveNode.assign(mesh_.nNodes, 0);
    std::fill(isEdge_.begin(), isEdge_.end(), char(0));
    for (int e = 0; e < mesh_.nElements; ++e)
    {
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        const bool isOut = isLeftOut_[e] && cover_.state[e] == ElementState::Fluid;
        if (isOut) cover_.state[e] = ElementState::Solid;
        for (int a = 0; a < n; ++a)
        {
            if (isOut) isEdge_[nodes[a]] = 1;
            else if (cover_.state[e] != ElementState::Solid) cover_.isActiveNode[nodes[a]] = 1;
        }
    }
    std::vector<int> flags(mesh_.nNodes);
    for (int i = 0; i < mesh_.nNodes; ++i) flags[i] = cover_.isActiveNode[i] + 2*isEdge_[i];
    halo_.update(flags, 1);
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        cover_.isActiveNode[i] = flags[i] & 1;
        isEdge_[i] = flags[i] == 3;
    }
    return cover_;
}

} // namespace flotsam
