// SPDX-License-Identifier: GPL-3.0-or-later
/// Whether anything can touch anything during an interval: decides between contact sub-steps and large ones.
#pragma once

#include "demCoupling/core/rigidBody.hpp"

#include <functional>

namespace flotsam
{

/// Boxes of a surface's triangles in a tree: a terrain has many, of which few are near a body.
class TriangleBoxes
{
public:
    struct Box { Vec3 lower = Vec3::Zero(), upper = Vec3::Zero(); int triangle = -1; };
    explicit TriangleBoxes(const TriSurface& surface);
    /// Whether `test` holds for any triangle whose box meets the given one.
    bool any(const Box& near, const std::function<bool(const Box&)>& test) const;

private:
    struct Branch { Box box; int first = 0, last = 0, child = -1; };   ///< child -1: a leaf with the boxes first to last - 1; else child, child + 1
    void grow(size_t branch);

    std::vector<Box> boxes_;
    std::vector<Branch> tree_;
};

/// Upper bound of the way [m] that a point of a body goes under a constant load; place: in the frame of the body.
double largestWay(const BodyDefinition& body, const Vec3& place, const BodyState& state, const Load& load, double duration);

class ReachCheck
{
public:
    /// firstMover: bodies from this one on move as prescribed, and touch the others alone.
    ReachCheck(const std::vector<BodyDefinition>& bodies, const std::vector<WallDefinition>& walls, size_t firstMover);

    /// True when no free body can touch another body or a wall within `duration` [s] under constant loads.
    /// Errs on the safe side only. `isHeld` bodies stay where they are, `isGone` ones touch nothing.
    bool isFree(const std::vector<BodyState>& states, const std::vector<Load>& loads, const std::vector<char>& isHeld,
                const std::vector<char>& isGone, double duration);

private:
    struct Moving
    {
        std::vector<SurfaceSphere> spheres, corners; ///< in space, radii grown by how far the body can move
        Vec3 lower, upper;
    };
    static bool anySphere(const Moving& a, const std::function<bool(const SurfaceSphere&)>& test);
    void move(size_t body, const BodyState& state, const Load& load, bool isHeld, double duration);
    bool canTouch(const Moving& a, const Moving& b) const;
    bool canTouch(const Moving& a, size_t wall) const;

    std::vector<BodyDefinition> bodies_;
    std::vector<WallDefinition> walls_;     ///< without the triangles
    std::vector<TriangleBoxes> triangles_;  ///< of each wall
    size_t firstMover_;
    std::vector<Moving> moving_;
};

} // namespace flotsam
