// SPDX-License-Identifier: GPL-3.0-or-later
/// Whether anything can touch anything during an interval: decides between contact sub-steps and large ones.
#pragma once

#include "demCoupling/core/rigidBody.hpp"

namespace flotsam
{

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
        std::vector<SurfaceSphere> spheres; ///< in space, radii grown by how far the body can move
        Vec3 lower, upper;
    };
    void move(size_t body, const BodyState& state, const Load& load, bool isHeld, double duration);
    bool canTouch(const Moving& a, const Moving& b) const;
    bool canTouch(const Moving& a, const WallDefinition& wall) const;

    std::vector<BodyDefinition> bodies_;
    std::vector<WallDefinition> walls_;
    size_t firstMover_;
    std::vector<Moving> moving_;
};

} // namespace flotsam
