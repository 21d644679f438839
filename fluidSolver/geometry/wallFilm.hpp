// SPDX-License-Identifier: GPL-3.0-or-later
/// The film of fluid between a body and a wall of the mesh that it lies on.
///
/// A body that touches a wall leaves no element between: no pressure would act on its side there, though under driftwood on a bed there always is water. So the cut keeps
/// the surface of a loose solid a film's thickness off the walls: the pressure goes on from the film's rim under the body, on the body and on the wall alike, and a
/// body that lifts draws the fluid in. Of wider gaps the film knows nothing: the cut is continuous in the body's place.
#pragma once

#include "algebra/halo.hpp"
#include "geometry/solid.hpp"

#include <vector>

namespace flotsam
{

constexpr double filmThickness = 0.05;  ///< over the height of the elements on the wall
constexpr double noFilm = -1e30;        ///< thickness where there is none [m]

class WallFilm
{
public:
    /// Of the mesh's patches of type wall. Collective.
    WallFilm(const SimplexMesh& mesh, const Halo& halo);

    /// Distance that a solid less than half an element over a wall keeps from its node at least [m]; noFilm: no such node, no such solid.
    double thickness(int node, const SolidPart& part) const;

    /// Of a solid that is cut by its faces: signed distances of the faces at the node. Those that look at the wall are kept off it. Thickness as above; noFilm: there are none.
    /// nearer: as if all faces were nearer by this, over the height of the elements on the wall.
    double lift(int node, const SolidPart& part, int nFaces, double* distances, double nearer = 0) const;

    /// FilmNode::share of a solid `distance` away from the node [m].
    double share(int node, const Solid& solid, double distance) const;

    /// Distance that the cut has of a solid `distance` away from the node [m]: that, or just inside of a structure that moves and has come as near to the wall as
    /// makes no difference, at the node and all around it (wallJoints.cpp).
    double joined(int node, const SolidPart& part, double distance) const;

    /// The same of a solid that is cut by its faces: signed distances of the faces at the node.
    void join(int node, const SolidPart& part, int nFaces, double* distances) const;

private:
    struct WallNode
    {
        Vec3 normal = Vec3::Zero();     // out of the fluid
        double height = 0;              // of the elements on the wall, the lowest [m]
        std::size_t firstCorner = 0, endCorner = 0; // in corners_
        std::size_t firstFacing = 0, endFacing = 0; // in facings_; none where the wall is flat
    };

    const WallNode* wallNode(int node, const Solid& solid) const;
    const WallNode* jointNode(int node, const Solid& solid) const;
    Vec3 pointOver(int node, const WallNode& wall, double heights) const;
    Vec3 pointOver(int node, const WallNode& wall, const Vec3& normal, double heights) const;
    void findFaces(const Halo& halo);
    void takeFace(const double* numbers);
    std::vector<std::vector<double>> facesOfNodes() const;
    double cosineToFaces(int node, const WallNode& wall, const SolidPart& part, int face, double distance) const;
    double touch(const WallNode& wall, const SolidPart& part, int nFaces, const double* distances, double shift) const;

    const SimplexMesh& mesh_;
    std::vector<int> position_;         // nNodes: in nodes_, -1: not on a wall
    std::vector<WallNode> nodes_;
    std::vector<Vec3> corners_;         // of the walls' faces at each wall node the others than this, face by face
    std::vector<Vec3> facings_;         // normals of the walls' faces at each wall node where these differ, out of the fluid
};

} // namespace flotsam
