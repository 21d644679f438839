// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/patchDistance.hpp"

#include "algebra/exchange.hpp"
#include "geometry/closestPoint.hpp"
#include "geometry/nodeBins.hpp"

namespace flotsam
{

namespace
{

constexpr int faceLength = 9;   // coordinates of three corners; of an edge the last one twice

std::vector<double> ownFaces(const SimplexMesh& mesh, const std::vector<int>& patches)
{
    std::vector<double> corners;
    for (int p : patches)
    {
        const MeshPatch& patch = mesh.patches[p];
        for (std::size_t f = 0; f < patch.faceElement.size(); ++f)
            for (int k = 0; k < 3 && patch.isOwnedFace[f]; ++k)
            {
                const auto x = mesh.spacePoint(patch.faceNodes[f*mesh.dim + std::min(k, mesh.dim - 1)]);
                corners.insert(corners.end(), x.begin(), x.end());
            }
    }
    return corners;
}

} // namespace

std::vector<double> distanceFromPatches(const SimplexMesh& mesh, const Halo& halo, const std::vector<int>& patches, double farthest)
{
    const std::vector<double> corners = gatherAll(ownFaces(mesh, patches), halo.comm());
    const NodeBins bins(mesh, std::vector<double>(mesh.nNodes, farthest));
    std::vector<double> distance(mesh.nNodes, farthest);
    for (std::size_t k = 0; k < corners.size(); k += faceLength)
    {
        const Vec3 a(&corners[k]), b(&corners[k + 3]), c(&corners[k + 6]);
        bins.forEachNear({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)}, [&](int node, const Vec3& x)
        {
            distance[node] = std::min(distance[node], (x - closestPointOfTriangle(x, a, b, c)).norm());
        });
    }
    return distance;
}

} // namespace flotsam
