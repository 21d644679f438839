// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/thinSolids.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

constexpr double opposite = -0.7;   // cosine of normals below which two faces look to different sides
constexpr double leastDepth = 0.05; // of the solid between such faces, over the element: around a node that lies on an edge facets look anywhere

/// Whether element e is near solid s alone. Between two of them the cut rounds corners, and facets look anywhere.
bool isNearOne(const SimplexMesh& mesh, const Cover& cover, int e, int s)
{
    const int* nodes = &mesh.elements[std::size_t(e)*(mesh.dim + 1)];
    return std::all_of(nodes, nodes + mesh.dim + 1, [&](int j) { return cover.nearestSolid[j] == s; });
}

Eigen::Vector3d centroid(const SimplexMesh& mesh, const CutFacet& facet)
{
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    const int* nodes = &mesh.elements[std::size_t(facet.element)*(mesh.dim + 1)];
    for (int q = 0; q < facet.nPoints; ++q)
        for (int a = 0; a <= mesh.dim; ++a)
            for (int d = 0; d < mesh.dim; ++d) x[d] += facet.weight[q]/facet.area*facet.shape[q][a]*mesh.x[std::size_t(nodes[a])*mesh.dim + d];
    return x;
}

/// Whether facets around node i look to opposite sides of its solid.
bool seesTwoSides(const SimplexMesh& mesh, const NodeGraph& graph, const Cover& cover, int i)
{
    struct Side { Eigen::Vector3d normal, place; };
    std::vector<Side> sides;
    for (int k = graph.nodeElementStart[i]; k < graph.nodeElementStart[i + 1]; ++k)
    {
        const int e = graph.nodeElement[k], cut = cover.cutIndex[e];
        if (cut < 0 || !isNearOne(mesh, cover, e, cover.nearestSolid[i])) continue;
        for (int f = cover.cuts[cut].facetStart; f < cover.cuts[cut].facetEnd; ++f)
        {
            const Side side{Eigen::Map<const Eigen::Vector3d>(cover.facets[f].normal), centroid(mesh, cover.facets[f])};
            const auto isOther = [&](const Side& s)
            {
                return s.normal.dot(side.normal) < opposite && (s.place - side.place).dot(side.normal) > leastDepth*mesh.h[e];
            };
            if (std::any_of(sides.begin(), sides.end(), isOther)) return true;
            sides.push_back(side);
        }
    }
    return false;
}

} // namespace

std::vector<SharedNodes> findSharedNodes(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const Cover& cover, std::size_t nSolids)
{
    std::vector<double> sums(4*nSolids, 0.0);   // of each solid: nodes, their coordinates
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        if (cover.distance[i] >= 0 || !cover.isActiveNode[i] || !seesTwoSides(mesh, graph, cover, i)) continue;
        double* sum = &sums[4*std::size_t(cover.nearestSolid[i])];
        const auto x = mesh.spacePoint(i);
        sum[0] += 1;
        for (int d = 0; d < 3; ++d) sum[1 + d] += x[d];
    }
    halo.sum(sums.data(), int(sums.size()));
    std::vector<SharedNodes> result(nSolids);
    for (std::size_t s = 0; s < nSolids; ++s)
    {
        result[s].count = std::lround(sums[4*s]);
        for (int d = 0; d < 3 && result[s].count > 0; ++d) result[s].middle[d] = sums[4*s + 1 + d]/sums[4*s];
    }
    return result;
}

} // namespace flotsam
