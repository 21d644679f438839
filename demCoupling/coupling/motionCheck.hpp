// SPDX-License-Identifier: GPL-3.0-or-later
/// Motions that a step must not end with, because fluid or contact no longer knew where the bodies are.
#pragma once

#include "demCoupling/core/rigidBody.hpp"

namespace flotsam
{

class MotionCheck
{
public:
    MotionCheck(const std::vector<BodyDefinition>& bodies, const std::vector<WallDefinition>& walls);

    /// Name of a body whose surface lies farther than `distance` [m] from where it was predicted; empty: none.
    std::string strayBody(const std::vector<BodyState>& predicted, const std::vector<BodyState>& found, double distance) const;

    /// The same for a body in contact whose surface ends faster than three times the fastest there was of bodies and fluid (a light body struck
    /// by a heavy one, or carried by the fluid, gets less) plus `slack`; all in m/s.
    std::string thrownBody(const std::vector<BodyState>& before, const std::vector<BodyState>& after, const std::vector<Load>& contact,
        double fluidSpeed, double slack) const;

    /// What got through what: a contact sphere whose centre is on the other side of a wall or inside another body, that is with an overlap
    /// beyond its radius. Its spring then pushes the wrong way. Bodies without contact load are not looked at. Empty: nothing.
    /// isAway: bodies that nothing touches.
    std::string passage(const std::vector<BodyState>& before, const std::vector<BodyState>& after, const std::vector<Load>& contact,
        const std::vector<char>& isAway) const;

private:
    /// Bound of the way of any point of the body's surface [m].
    double largestWay(std::size_t body, const Pose& from, const Pose& to) const;
    double surfaceSpeed(std::size_t body, const BodyState& state) const;
    struct Box { Vec3 lower, upper; };
    struct Path { std::vector<Vec3> before, after; Box box; }; // of the spheres' centres
    Path path(std::size_t body, const BodyState& before, const BodyState& after) const;
    bool passes(const Path& path, std::size_t wall) const;
    bool entersBody(const Path& path, std::size_t other, const BodyState& before, const BodyState& after) const;
    static bool meet(const Box& a, const Box& b);

    std::vector<BodyDefinition> bodies_;
    std::vector<WallDefinition> walls_;
    std::vector<double> extents_, largestRadius_; ///< of the bodies about their centres, of their spheres [m]
    std::vector<Vec3> halves_;  ///< of the bodies along their own axes, from their centres [m]
    std::vector<Box> wallBoxes_;
};

} // namespace flotsam
