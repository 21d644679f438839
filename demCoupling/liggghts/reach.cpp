// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/reach.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

bool boxesMeet(const Vec3& lowerA, const Vec3& upperA, const Vec3& lowerB, const Vec3& upperB)
{
    return (lowerA.array() <= upperB.array()).all() && (lowerB.array() <= upperA.array()).all();
}

template <class Box>
bool meets(const SurfaceSphere& s, const Box& box)
{
    const Vec3 outside = (box.lower - s.centre).cwiseMax(s.centre - box.upper).cwiseMax(0.0);
    return outside.squaredNorm() <= s.radius * s.radius;
}

TriangleBoxes::Box boxOf(const TriSurface& surface, const std::array<int, 3>& triangle)
{
    TriangleBoxes::Box box {Vec3::Constant(1e300), Vec3::Constant(-1e300)};
    for (const int corner : triangle)
    {
        const Vec3& point = surface.points[static_cast<size_t>(corner)];
        box = {box.lower.cwiseMin(point), box.upper.cwiseMax(point)};
    }
    return box;
}

/// Upper bound of the angle [rad] a tumbling body turns through. The spin cannot exceed what its energy allows about
/// the axis of least inertia, and it changes no faster than I dw/dt = M - w x L.
double largestTurn(const BodyState& state, const Load& load, double leastInertia, double duration)
{
    const double moment = load.moment.norm();
    const double twiceEnergy = std::max(0.0, state.motion.angularVelocity.dot(state.angularMomentum));
    const double largestSpin = std::sqrt(twiceEnergy / leastInertia) + moment * duration / leastInertia;
    const double largestMomentum = state.angularMomentum.norm() + moment * duration;
    const double change = (moment + largestSpin * largestMomentum) / leastInertia;
    return std::min(largestSpin * duration,
                    state.motion.angularVelocity.norm() * duration + 0.5 * change * duration * duration);
}

struct Way { double shift, turn; };

Way wayOf(const BodyDefinition& body, const BodyState& state, const Load& load, double duration)
{
    return {state.motion.velocity.norm() * duration + 0.5 * load.force.norm() / body.mass * duration * duration,
            largestTurn(state, load, body.principalInertia.minCoeff(), duration)};
}

double wayOf(const Way& way, const Vec3& place) { return way.shift + std::min(way.turn, 2.0) * place.norm(); } // at most the diameter

} // namespace

double largestWay(const BodyDefinition& body, const Vec3& place, const BodyState& state, const Load& load, double duration)
{
    return wayOf(wayOf(body, state, load, duration), place);
}

TriangleBoxes::TriangleBoxes(const TriSurface& surface)
{
    for (const std::array<int, 3>& t : surface.triangles)
    {
        boxes_.push_back(boxOf(surface, t));
        boxes_.back().triangle = static_cast<int>(boxes_.size()) - 1;
    }
    tree_.reserve(2 * boxes_.size() + 1);
    tree_.push_back({{}, 0, static_cast<int>(boxes_.size()), -1});
    grow(0);
}

void TriangleBoxes::grow(size_t branch)
{
    constexpr int leafSize = 8;
    const int first = tree_[branch].first, last = tree_[branch].last, middle = (first + last) / 2;
    Box all {Vec3::Constant(1e300), Vec3::Constant(-1e300)};
    for (auto box = boxes_.begin() + first; box != boxes_.begin() + last; ++box)
        all = {all.lower.cwiseMin(box->lower), all.upper.cwiseMax(box->upper)};
    tree_[branch].box = all;
    if (last - first <= leafSize)
        return;
    int axis = 0;
    (all.upper - all.lower).maxCoeff(&axis);
    std::nth_element(boxes_.begin() + first, boxes_.begin() + middle, boxes_.begin() + last,
                     [axis](const Box& a, const Box& b) { return a.lower[axis] + a.upper[axis] < b.lower[axis] + b.upper[axis]; });
    const size_t child = tree_.size();
    tree_[branch].child = static_cast<int>(child);
    tree_.push_back({{}, first, middle, -1});
    tree_.push_back({{}, middle, last, -1});
    grow(child);
    grow(child + 1);
}

bool TriangleBoxes::any(const Box& near, const std::function<bool(const Box&)>& test) const
{
    const auto isNear = [&](const Box& box) { return boxesMeet(near.lower, near.upper, box.lower, box.upper); };
    std::vector<int> open {0};
    while (!open.empty())
    {
        const Branch& branch = tree_[static_cast<size_t>(open.back())];
        open.pop_back();
        if (!isNear(branch.box))
            continue;
        if (branch.child >= 0)
            open.insert(open.end(), {branch.child, branch.child + 1});
        else if (std::any_of(boxes_.begin() + branch.first, boxes_.begin() + branch.last, [&](const Box& box) { return isNear(box) && test(box); }))
            return true;
    }
    return false;
}

ReachCheck::ReachCheck(const std::vector<BodyDefinition>& bodies, const std::vector<WallDefinition>& walls, size_t firstMover)
    : bodies_(bodies), walls_(walls), firstMover_(firstMover), moving_(bodies.size())
{
    for (size_t b = 0; b < bodies.size(); ++b)
    {
        moving_[b].spheres.resize(bodies[b].spheres.size());
        moving_[b].corners.resize(bodies[b].corners.size());
    }
    for (WallDefinition& wall : walls_)
    {
        triangles_.emplace_back(wall.surface);
        wall.surface = {};
    }
}

void ReachCheck::move(size_t body, const BodyState& state, const Load& load, bool isHeld, double duration)
{
    const BodyDefinition& definition = bodies_[body];
    const Way way = isHeld ? Way {0, 0} : wayOf(definition, state, load, duration);
    Moving& m = moving_[body];
    m.lower.setConstant(1e300);
    m.upper.setConstant(-1e300);
    const Eigen::Matrix3d rotation = state.pose.orientation.toRotationMatrix();
    const auto place = [&](const SurfaceSphere& local, SurfaceSphere& sphere)
    {
        sphere.centre = state.pose.position + rotation * local.centre;
        sphere.radius = local.radius + wayOf(way, local.centre);
        m.lower = m.lower.cwiseMin(sphere.centre - Vec3::Constant(sphere.radius));
        m.upper = m.upper.cwiseMax(sphere.centre + Vec3::Constant(sphere.radius));
    };
    for (size_t s = 0; s < m.spheres.size(); ++s)
        place(definition.spheres[s], m.spheres[s]);
    for (size_t s = 0; s < m.corners.size(); ++s)
        place(definition.corners[s], m.corners[s]);
}

bool ReachCheck::canTouch(const Moving& a, const Moving& b) const
{
    if (!boxesMeet(a.lower, a.upper, b.lower, b.upper))
        return false;
    for (const SurfaceSphere& s : a.spheres)
    {
        if (!meets(s, b))
            continue;
        for (const SurfaceSphere& t : b.spheres)
        {
            const double reach = s.radius + t.radius;
            if ((s.centre - t.centre).squaredNorm() <= reach * reach)
                return true;
        }
    }
    return false;
}

bool ReachCheck::anySphere(const Moving& a, const std::function<bool(const SurfaceSphere&)>& test)
{
    return std::any_of(a.spheres.begin(), a.spheres.end(), test) || std::any_of(a.corners.begin(), a.corners.end(), test);
}

bool ReachCheck::canTouch(const Moving& a, size_t index) const
{
    const WallDefinition& wall = walls_[index];
    if (wall.kind == WallDefinition::Kind::Plane)
    {
        const Vec3 normal = wall.normal.normalized();
        return anySphere(a, [&](const SurfaceSphere& s) { return std::abs(normal.dot(s.centre - wall.point)) <= s.radius; });
    }
    return triangles_[index].any({a.lower, a.upper}, [&](const TriangleBoxes::Box& box)
        { return anySphere(a, [&](const SurfaceSphere& s) { return meets(s, box); }); });
}

bool ReachCheck::isFree(const std::vector<BodyState>& states, const std::vector<Load>& loads,
                        const std::vector<char>& isHeld, const std::vector<char>& isGone, double duration)
{
    const size_t n = bodies_.size();
    for (size_t b = 0; b < n; ++b)
        if (!isGone[b])
            move(b, states[b], loads[b], isHeld[b] != 0, duration);
    for (size_t b = 0; b < firstMover_; ++b)
    {
        if (isGone[b])
            continue;
        for (size_t c = b + 1; c < n; ++c)
            if (!isGone[c] && !(isHeld[b] && isHeld[c]) && canTouch(moving_[b], moving_[c]))
                return false;
        if (isHeld[b])
            continue;
        for (size_t w = 0; w < walls_.size(); ++w)
            if (canTouch(moving_[b], w))
                return false;
    }
    return true;
}

} // namespace flotsam
