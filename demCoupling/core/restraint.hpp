// SPDX-License-Identifier: GPL-3.0-or-later
/// Springs and tethers between a body and a point, another body or a structure that moves.
#pragma once

#include "geometry/solid.hpp"

#include <limits>
#include <string>

namespace flotsam
{

/// What a restraint is fastened to.
struct RestraintEnd
{
    int body = -1;              ///< index of the body, -1: none
    int mover = -1;             ///< index of the structure that moves, -1: none; without either a point of space
    Vec3 place = Vec3::Zero();  ///< in the frame of the body or structure, or in space [m]
};

/// A straight line without mass between two ends; force = stiffness x (length - unstretched length) + damping x rate of the length.
struct RestraintDefinition
{
    enum class Kind { LinearSpring, Tether };
    std::string name;
    Kind kind = Kind::LinearSpring;
    RestraintEnd end, other;    ///< end: of a body
    double length = 0;          ///< unstretched [m]
    double stiffness = 0;       ///< [N/m]
    double damping = 0;         ///< [N s/m]
    double breakingForce = std::numeric_limits<double>::infinity(); ///< lost for good where it pulls, or pushes, harder [N]

    double stretch(double now) const { return kind == Kind::Tether && now < length ? 0 : now - length; }
    /// Force that pulls the ends together [N]; a tether never pushes.
    double tension(double now, double rate) const
    {
        if (kind == Kind::Tether && now <= length) return 0;
        const double force = stiffness*(now - length) + damping*rate;
        return kind == Kind::Tether && force < 0 ? 0 : force;
    }
};

/// What a restraint has done in a step.
struct RestraintLoad
{
    Vec3 force = Vec3::Zero();  ///< on the body of `end`, mean over the step [N]
    double tension = 0;         ///< mean over the step, negative where it pushes [N]
    double largest = 0;         ///< that of the sub-step in which its size was largest [N]
    double length = 0;          ///< at the end of the step [m]
    char isBroken = 0;
};

} // namespace flotsam
