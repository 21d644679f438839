// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/shutPockets.hpp"

#include "equations/solidExtension.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

constexpr double leastShare = 0.02; // of its dual cell that is fluid: with less a node between solids joins nothing

} // namespace

ShutPockets::ShutPockets(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo)
:   mesh_(mesh), graph_(graph), halo_(halo), fluids_(mesh, halo), isBoundaryNode_(mesh.nNodes, 0)
{
    for (const MeshPatch& patch : mesh.patches)
        for (int i : patch.faceNodes) isBoundaryNode_[i] = 1;
}

/// Of the dual cell of owned node i.
double ShutPockets::fluidShare(const Cover& cover, int i) const
{
    const int n = mesh_.dim + 1;
    double fluid = 0, whole = 0;
    for (int k = graph_.nodeElementStart[i]; k < graph_.nodeElementStart[i + 1]; ++k)
    {
        const int e = graph_.nodeElement[k], *nodes = &mesh_.elements[std::size_t(e)*n];
        const double share = mesh_.volume[e]/n;
        whole += share;
        if (cover.state[e] == ElementState::Fluid) fluid += share;
        else if (cover.state[e] == ElementState::Cut) fluid += cover.cuts[cover.cutIndex[e]].first[std::find(nodes, nodes + n, i) - nodes];
    }
    return fluid/whole;
}

/// Nodes in solids, and in gaps between solids so thin that what flows there means nothing. Not under bodies on walls of the mesh, where films carry what flows.
void ShutPockets::findLeftOut(const Cover& cover)
{
    isLeftOut_.assign(mesh_.nNodes, 0);
    isKnown_ = isBoundaryNode_; // many cut elements share a node
    for (int i = 0; i < mesh_.nOwned; ++i)
        if (cover.distance[i] < 0) isLeftOut_[i] = isKnown_[i] = 1;
    for (const CutElement& cut : cover.cuts)
        for (int a = 0; a <= mesh_.dim; ++a)
        {
            const int i = mesh_.elements[std::size_t(cut.element)*(mesh_.dim + 1) + a];
            if (i >= mesh_.nOwned || isKnown_[i]) continue;
            isKnown_[i] = 1;
            isLeftOut_[i] = fluidShare(cover, i) < leastShare;
        }
    halo_.update(isLeftOut_, 1);
}

/// Nodes with whole elements all around, or a pressure from a boundary: their fluid is no pocket.
void ShutPockets::findOpen(const Cover& cover, const std::vector<char>& isPressureFixed)
{
    const int n = mesh_.dim + 1;
    isOpen_.assign(mesh_.nNodes, 1);
    for (int e = 0; e < mesh_.nElements; ++e)
        for (int a = 0; a < n && cover.state[e] != ElementState::Fluid; ++a) isOpen_[mesh_.elements[std::size_t(e)*n + a]] = 0;
    for (int i = 0; i < mesh_.nNodes; ++i) isOpen_[i] |= isPressureFixed[i];
}

void ShutPockets::find(const Cover& cover, const std::vector<char>& isPressureFixed)
{
    findLeftOut(cover);
    fluids_.find(&cover, &isLeftOut_);
    findOpen(cover, isPressureFixed);
    std::vector<char>& isOutside = isBasinOutside_;
    fluids_.haveAny(isOpen_, isOutside);
    isIn_.assign(mesh_.nNodes, 0);
    isOutside_.assign(mesh_.nNodes, 0);
    bool areAny = false;
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        const int f = fluids_.of(i);
        isOutside_[i] = f >= 0 && isOutside[f];
        const bool isThin = isLeftOut_[i] && cover.distance[i] > 0;
        isIn_[i] = isThin || (f >= 0 && !isOutside[f]);
        areAny = areAny || isIn_[i];
    }
    if (halo_.any(areAny) && std::count(isOutside.begin(), isOutside.end(), 1) > 0) addNodesInSolids(cover);
    else isIn_.clear();
}

/// Those that no element of other fluid holds.
void ShutPockets::addNodesInSolids(const Cover& cover)
{
    const int n = mesh_.dim + 1;
    std::vector<char> isOfPocket(mesh_.nNodes, 0), isOfOther(mesh_.nNodes, 0);
    for (const CutElement& cut : cover.cuts)
    {
        const int* nodes = &mesh_.elements[std::size_t(cut.element)*n];
        const bool isPocket = std::all_of(nodes, nodes + n, [&](int i) { return isIn_[i] || cover.distance[i] < 0; });
        for (int a = 0; a < n; ++a) (isPocket ? isOfPocket : isOfOther)[nodes[a]] = 1;
    }
    for (int i = 0; i < mesh_.nOwned; ++i) isIn_[i] = isIn_[i] || (isOfPocket[i] && !isOfOther[i]);
    halo_.update(isIn_, 1);
}

void ShutPockets::setPressures(const std::vector<double>& p, const std::vector<double>& rho, const std::array<double, 3>& gravity)
{
    // with the pressure the place it was taken from: the same mean
    const int dim = mesh_.dim, width = dim + 1;
    std::vector<double> values(std::size_t(mesh_.nNodes)*width);
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        values[std::size_t(i)*width] = p[i];
        std::copy_n(&mesh_.x[std::size_t(i)*dim], dim, &values[std::size_t(i)*width + 1]);
    }
    extendTo(mesh_, graph_, halo_, isOutside_, isIn_, values, width);
    pressure_ = p;
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        if (!isIn_[i]) continue;
        const double* source = &values[std::size_t(i)*width];
        pressure_[i] = source[0];
        for (int d = 0; d < dim; ++d) pressure_[i] += rho[i]*gravity[d]*(mesh_.x[std::size_t(i)*dim + d] - source[1 + d]);
    }
}

} // namespace flotsam
