// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/motionCheck.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

bool isStill(const BodyState& before, const BodyState& after)
{
    return before.pose.position == after.pose.position && before.pose.orientation.coeffs() == after.pose.orientation.coeffs();
}

/// Whether the way from a to b leads through the triangle.
bool crosses(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& q, const Vec3& r)
{
    const Vec3 normal = (q - p).cross(r - p);
    const double heightA = normal.dot(a - p), heightB = normal.dot(b - p);
    if ((heightA > 0) == (heightB > 0)) return false;
    const Vec3 x = a + (b - a)*(heightA/(heightA - heightB));
    return normal.dot((q - p).cross(x - p)) >= 0 && normal.dot((r - q).cross(x - q)) >= 0 && normal.dot((p - r).cross(x - r)) >= 0;
}

} // namespace

MotionCheck::MotionCheck(const std::vector<BodyDefinition>& bodies, const std::vector<WallDefinition>& walls)
:   bodies_(bodies), walls_(walls)
{
    for (const BodyDefinition& body : bodies)
    {
        double radius = 0;
        Vec3 halves = Vec3::Zero();
        for (const SurfaceSphere& s : body.spheres)
        {
            radius = std::max(radius, s.radius);
            halves = halves.cwiseMax(s.centre.cwiseAbs() + Vec3::Constant(s.radius));
        }
        extents_.push_back(outerRadius(body));
        halves_.push_back(halves);
        largestRadius_.push_back(radius);
    }
    for (const WallDefinition& wall : walls)
    {
        Box box{Vec3::Constant(1e300), Vec3::Constant(-1e300)};
        for (const Vec3& x : wall.surface.points) box = {box.lower.cwiseMin(x), box.upper.cwiseMax(x)};
        wallBoxes_.push_back(box);
    }
}

std::string MotionCheck::strayBody(const std::vector<BodyState>& predicted, const std::vector<BodyState>& found, double distance) const
{
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        if (!(largestWay(b, predicted[b].pose, found[b].pose) <= distance)) return bodies_[b].name;
    return "";
}

/// Along its own axes: a bar that rolls about its length takes its ends nowhere.
double MotionCheck::largestWay(std::size_t body, const Pose& from, const Pose& to) const
{
    const double turn = std::min(2.0, to.orientation.angularDistance(from.orientation));
    const Eigen::Matrix3d turned = to.orientation.toRotationMatrix() - from.orientation.toRotationMatrix();
    return (to.position - from.position).norm() + std::min(turn*extents_[body], turned.colwise().norm().dot(halves_[body].transpose()));
}

double MotionCheck::surfaceSpeed(std::size_t body, const BodyState& state) const
{
    return fastestCorner({-halves_[body], halves_[body]}, state.pose, state.motion);
}

std::string MotionCheck::thrownBody(const std::vector<BodyState>& before, const std::vector<BodyState>& after, const std::vector<Load>& contact,
    double fluidSpeed, double slack) const
{
    double fastest = fluidSpeed;
    for (std::size_t b = 0; b < bodies_.size(); ++b) fastest = std::max(fastest, surfaceSpeed(b, before[b]));
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        if (!contact[b].isZero() && !(surfaceSpeed(b, after[b]) <= 3*fastest + slack)) return bodies_[b].name;
    return "";
}

bool MotionCheck::meet(const Box& a, const Box& b)
{
    return (a.lower.array() <= b.upper.array()).all() && (b.lower.array() <= a.upper.array()).all();
}

MotionCheck::Path MotionCheck::path(std::size_t body, const BodyState& before, const BodyState& after) const
{
    Path p{{}, {}, {Vec3::Constant(1e300), Vec3::Constant(-1e300)}};
    const Eigen::Matrix3d R0 = before.pose.orientation.toRotationMatrix(), R1 = after.pose.orientation.toRotationMatrix();
    for (const SurfaceSphere& s : bodies_[body].spheres)
    {
        p.before.push_back(before.pose.position + R0*s.centre);
        p.after.push_back(after.pose.position + R1*s.centre);
        p.box = {p.box.lower.cwiseMin(p.before.back()).cwiseMin(p.after.back()), p.box.upper.cwiseMax(p.before.back()).cwiseMax(p.after.back())};
    }
    return p;
}

bool MotionCheck::passes(const Path& path, std::size_t w) const
{
    const WallDefinition& wall = walls_[w];
    const std::size_t n = path.before.size();
    if (wall.kind == WallDefinition::Kind::Plane)
    {
        for (std::size_t s = 0; s < n; ++s)
            if ((wall.normal.dot(path.before[s] - wall.point) > 0) != (wall.normal.dot(path.after[s] - wall.point) > 0)) return true;
        return false;
    }
    if (!meet(path.box, wallBoxes_[w])) return false;
    for (std::size_t s = 0; s < n; ++s)
    {
        const Vec3 &a = path.before[s], &b = path.after[s];
        if (!meet({a.cwiseMin(b), a.cwiseMax(b)}, wallBoxes_[w])) continue;
        for (const std::array<int, 3>& t : wall.surface.triangles)
            if (crosses(a, b, wall.surface.points[t[0]], wall.surface.points[t[1]], wall.surface.points[t[2]])) return true;
    }
    return false;
}

bool MotionCheck::entersBody(const Path& path, std::size_t other, const BodyState& before, const BodyState& after) const
{
    const Box box{after.pose.position - Vec3::Constant(extents_[other]), after.pose.position + Vec3::Constant(extents_[other])};
    if (!meet(path.box, box)) return false;
    const Eigen::Matrix3d R0 = before.pose.orientation.toRotationMatrix(), R1 = after.pose.orientation.toRotationMatrix();
    // inside one of its spheres or below them: what touches is rounder than the shape, at sharp edges and between spheres a centre may be in the shape
    const std::vector<SurfaceSphere>& spheres = bodies_[other].spheres;
    const double deep = -largestRadius_[other];
    auto isInside = [&](const Vec3& x, const Pose& pose, const Eigen::Matrix3d& R)
    {
        const Vec3 d = x - pose.position;
        if (d.squaredNorm() >= extents_[other]*extents_[other]) return false;
        const Vec3 inBody = R.transpose()*d;
        const double distance = bodies_[other].shape->distance(inBody);
        if (distance >= 0 || distance < deep) return distance < deep;
        return std::any_of(spheres.begin(), spheres.end(), [&](const SurfaceSphere& s) { return (inBody - s.centre).squaredNorm() < s.radius*s.radius; });
    };
    for (std::size_t s = 0; s < path.before.size(); ++s)
        if (isInside(path.after[s], after.pose, R1) && !isInside(path.before[s], before.pose, R0)) return true;
    return false;
}

std::string MotionCheck::passage(const std::vector<BodyState>& before, const std::vector<BodyState>& after, const std::vector<Load>& contact,
    const std::vector<char>& isAway) const
{
    for (std::size_t b = 0; b < bodies_.size(); ++b)
    {
        if (contact[b].isZero() || isStill(before[b], after[b])) continue;
        const Path way = path(b, before[b], after[b]);
        for (std::size_t w = 0; w < walls_.size(); ++w)
            if (passes(way, w)) return "body '" + bodies_[b].name + "' passes through '" + walls_[w].name + "'";
        for (std::size_t other = 0; other < bodies_.size(); ++other)
            if (other != b && !isAway[other] && entersBody(way, other, before[other], after[other]))
                return "body '" + bodies_[b].name + "' passes into body '" + bodies_[other].name + "'";
    }
    return "";
}

} // namespace flotsam
