// SPDX-License-Identifier: GPL-3.0-or-later
/// WallFilm: where structures that move close the gap to a wall.
///
/// What a structure presses out of such a gap is as fast as the gap is thin, v L/gap, and the step that maxCo allows closes a part h/L of what is left of it: the gap
/// never closes, the velocity and its pressure have no bound, and the friction that bounds them in nature is not resolved. A hundredth of an element carries
/// nothing that means anything: from there on the structure has come to the wall. The cut then sees what the gap is to become, for all that follows from it: fluid behind it
/// is shut in, a gate lies on its bed.
#include "geometry/wallFilm.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

constexpr double closedGap = 0.01;  // over the height of the elements on the wall
constexpr double lifted = 0.02;     // points that the structure must be over, at the node; beside it within closedGap. What wider gaps let out has a bound: v h/gap
constexpr double depth = 1e-6;      // of the node in the structure then

} // namespace

double WallFilm::joined(int i, const Solid& solid, double distance) const
{
    if (solid.kind != Solid::Kind::Prescribed || solid.isLoose || position_[i] < 0) return distance;
    const WallNode& wall = nodes_[position_[i]];
    if (distance <= 0 || distance >= closedGap*wall.height) return distance;
    const auto from = [&](const Vec3& x) { return plainDistance(solid, x - lifted*wall.height*wall.normal); };
    const auto isNear = [&](const Vec3& x) { return from(x) < closedGap*wall.height; };
    const auto corner = corners_.begin();
    const bool isClosed = from(pointOver(i, wall, 0)) < 0 && std::all_of(corner + wall.firstCorner, corner + wall.endCorner, isNear);
    return isClosed ? -depth*wall.height : distance;
}

} // namespace flotsam
