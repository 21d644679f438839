// SPDX-License-Identifier: GPL-3.0-or-later
/// What the faces of walls prescribe at one node.
#pragma once

#include "algebra/flowSystem.hpp"

#include <array>
#include <vector>

namespace flotsam
{

/// Walls are faces of nearly the same direction. Where two of them meet in a re-entrant edge (the fluid fills more than 180 degrees, as at the rim
/// of a box that is left out of the mesh) their normals together would hold the whole velocity of the node, though fluid streams past the edge;
/// no normal of its own is right there either. Such walls prescribe nothing at the node, FlowEquation::assemblePatchWalls() holds them weakly.
class SlipNormals
{
public:
    /// v: normal of a face at the node, out of the fluid, as long as the face is to weigh; place: the face's centre seen from the node. dim values each.
    void addFace(const double* v, const double* place, int dim);

    /// After all faces, before anything is asked. Joins those of nearly the same direction, the nearest first: in whatever order they were added, which is another on other
    /// processes.
    void findWalls();

    /// Whether walls meet in a re-entrant edge here.
    bool hasEdge() const;

    /// Whether faces of one wall differ in direction here: what its normal leaves to the velocity passes these faces.
    bool isBent() const { return isBent_; }

    /// Unit normals, out of the fluid, of the walls that meet in a re-entrant edge here.
    std::vector<std::array<double, 3>> edgeNormals() const;

    /// Orthonormal directions of the walls that are not at a re-entrant edge.
    NodeConstraint constraint(int node, int dim) const;

private:
    struct Wall
    {
        std::array<double, 3> area{}, place{};  // sums over its faces
        std::array<long, 3> direction() const;  // of its normal, in round numbers: an order
    };

    struct Pair
    {
        std::size_t first, second;
        double cosine;  // of the angle between them
    };

    static double cosine(const Wall& wall, const Wall& other);
    static bool isOutside(const Wall& wall, const Wall& other);
    void join(Wall& wall, const Wall& other);
    Pair nearestPair() const;
    bool isAtEdge(const Wall& wall) const;

    std::vector<Wall> walls_;
    bool isBent_ = false;
};

} // namespace flotsam
