// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/wallFilm.hpp"

#include "core/patchFaces.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

constexpr double reachOfFilm = 0.5;     // over the height of the elements on the wall
constexpr double facingCosine = 0.5;    // least one of a face that looks at the wall

/// Without the offset, which the cut still looks for.
double plainDistance(const Solid& solid, const Vec3& x)
{
    return solid.shape->distance(solid.pose.orientation.conjugate()*(x - solid.pose.position));
}

} // namespace

WallFilm::WallFilm(const SimplexMesh& mesh, const Halo& halo) : mesh_(mesh), position_(mesh.nNodes, -1)
{
    const int dim = mesh.dim;
    std::vector<double> normal(std::size_t(mesh.nNodes)*dim, 0.0), height(mesh.nNodes, 0.0);
    for (const MeshPatch& patch : mesh.patches)
    {
        if (patch.type != "wall") continue;
        for (std::size_t f = 0; f < patch.faceElement.size(); ++f)
        {
            double v[3], area = 0;
            outwardVector(mesh, patch, f, v);
            for (int d = 0; d < dim; ++d) area += v[d]*v[d];
            const double ofElement = dim*mesh.volume[patch.faceElement[f]]/std::sqrt(area);
            for (int k = 0; k < dim; ++k)
            {
                const int i = patch.faceNodes[f*dim + k];
                for (int d = 0; d < dim; ++d) normal[std::size_t(i)*dim + d] += v[d];
                height[i] = height[i] > 0 ? std::min(height[i], ofElement) : ofElement;
            }
        }
    }
    halo.update(normal, dim);   // second-ring copies do not see all of their faces
    halo.update(height, 1);
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        if (height[i] <= 0) continue;
        WallNode node;
        for (int d = 0; d < dim; ++d) node.normal[mesh.axes[d]] = normal[std::size_t(i)*dim + d];
        node.normal.normalize();
        node.height = height[i];
        position_[i] = int(nodes_.size());
        nodes_.push_back(node);
    }
}

const WallFilm::WallNode* WallFilm::wallNode(int i, const Solid& solid) const
{
    return solid.isLoose && position_[i] >= 0 ? &nodes_[position_[i]] : nullptr;
}

Vec3 WallFilm::pointOver(int i, const WallNode& wall, double heights) const
{
    const std::array<double, 3> x = mesh_.spacePoint(i);
    return Vec3(x[0], x[1], x[2]) - heights*wall.height*wall.normal;
}

double WallFilm::thickness(int i, const Solid& solid) const
{
    const WallNode* wall = wallNode(i, solid);
    if (!wall) return noFilm;
    // beside the solid as far as the film is thick: no jump as its edges pass the node
    const double film = filmThickness*wall->height;
    return plainDistance(solid, pointOver(i, *wall, reachOfFilm)) < film ? film : noFilm;
}

double WallFilm::share(int i, const Solid& solid, double distance) const
{
    const WallNode* wall = wallNode(i, solid);
    return wall ? std::clamp(1 - distance/wall->height, 0.0, 1.0) : 0;
}

bool WallFilm::lift(int i, const Solid& solid, int nFaces, double* distances) const
{
    const WallNode* wall = wallNode(i, solid);
    if (!wall) return false;
    const std::array<double, 3> x = mesh_.spacePoint(i);
    double here[maxFaces], over[maxFaces];
    solid.faceDistances(Vec3(x[0], x[1], x[2]), here);
    solid.faceDistances(pointOver(i, *wall, reachOfFilm), over);
    bool isLifted = false;
    for (int k = 0; k < nFaces; ++k)
    {
        const double film = filmThickness*wall->height;
        if (distances[k] >= film || here[k] - over[k] <= facingCosine*reachOfFilm*wall->height) continue;
        distances[k] = film;
        isLifted = true;
    }
    return isLifted;
}

} // namespace flotsam
