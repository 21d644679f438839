// SPDX-License-Identifier: GPL-3.0-or-later
/// WallFilm: where structures that move close the gap to a wall.
///
/// What a structure presses out of such a gap is as fast as the gap is thin, v L/gap, and the step that maxCo allows closes a part h/L of what is left of it: the gap
/// never closes, the velocity and its pressure have no bound, and the friction that bounds them in nature is not resolved. A hundredth of an element carries
/// nothing that means anything: from there on the structure has come to the wall. The cut then sees what the gap is to become, for all that follows from it: fluid behind it
/// is shut in, a gate lies on its bed.
#include "geometry/wallFilm.hpp"

#include <algorithm>
#include <array>

namespace flotsam
{

namespace
{

constexpr double closedGap = 0.01;  // over the height of the elements on the wall
constexpr double lifted = 0.02;     // points that the structure must be over, at the node; beside it within closedGap. What wider gaps let out has a bound: v h/gap
constexpr double depth = 1e-6;      // of the node in the structure then

} // namespace

const WallFilm::WallNode* WallFilm::jointNode(int i, const Solid& solid) const
{
    return solid.kind == Solid::Kind::Prescribed && !solid.isLoose && position_[i] >= 0 ? &nodes_[position_[i]] : nullptr;
}

double WallFilm::joined(int i, const SolidPart& part, double distance) const
{
    const WallNode* wall = jointNode(i, part.solid());
    if (!wall || distance <= 0 || distance >= closedGap*wall->height) return distance;
    const auto from = [&](const Vec3& x) { return part.plainDistance(x - lifted*wall->height*wall->normal); };
    const auto isNear = [&](const Vec3& x) { return from(x) < closedGap*wall->height; };
    const auto corner = corners_.begin();
    const bool isClosed = from(pointOver(i, *wall, 0)) < 0 && std::all_of(corner + wall->firstCorner, corner + wall->endCorner, isNear);
    return isClosed ? -depth*wall->height : distance;
}

/// Face by face, as far as its plane goes: where the structure ends over the wall its other faces go on to it. Left open, the gap would end in an element of the rim as a sliver
/// whose nodes are in nothing else.
void WallFilm::join(int i, const SolidPart& part, int nFaces, double* distances) const
{
    const WallNode* wall = jointNode(i, part.solid());
    if (!wall) return;
    const double gap = closedGap*wall->height;
    std::array<bool, maxFaces> isClosed{};
    std::transform(distances, distances + nFaces, isClosed.begin(), [&](double d) { return d > 0 && d < gap; });
    const auto keep = [&](const Vec3& x, double limit)
    {
        double over[maxFaces];
        part.faceDistances(x - lifted*wall->height*wall->normal, over);
        for (int k = 0; k < nFaces; ++k) isClosed[k] = isClosed[k] && over[k] < limit;
        return std::any_of(isClosed.begin(), isClosed.end(), [](bool is) { return is; });
    };
    bool any = std::any_of(isClosed.begin(), isClosed.end(), [](bool is) { return is; }) && keep(pointOver(i, *wall, 0), 0);
    for (std::size_t c = wall->firstCorner; c < wall->endCorner && any; ++c) any = keep(corners_[c], gap);
    for (int k = 0; k < nFaces; ++k)
        if (isClosed[k]) distances[k] = -depth*wall->height;
}

} // namespace flotsam
