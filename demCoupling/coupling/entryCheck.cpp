// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/entryCheck.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

constexpr double wet = 0.01;            // alpha that counts as liquid
constexpr double gapOfThickness = 0.05; // of bodies, that contact does not begin at once

double distanceOf(const BodyDefinition& body, const Pose& pose, const Vec3& x)
{
    return body.shape->distance(pose.orientation.conjugate()*(x - pose.position));
}

/// Of a's spheres.
double gapOfSpheres(const BodyDefinition& a, const Pose& poseOfA, const BodyDefinition& b, const Pose& poseOfB)
{
    double gap = 1e300;
    for (const SurfaceSphere& s : a.spheres)
        gap = std::min(gap, distanceOf(b, poseOfB, poseOfA.position + poseOfA.orientation*s.centre) - s.radius);
    return gap;
}

double extent(const BodyDefinition& body)
{
    double radius = 0;
    for (const SurfaceSphere& s : body.spheres) radius = std::max(radius, s.centre.norm() + s.radius);
    return radius;
}

} // namespace

EntryCheck::EntryCheck(const SimplexMesh& mesh, const Halo& halo, const std::vector<BodyDefinition>& bodies)
:   mesh_(mesh), halo_(halo), bodies_(bodies), nodes_(bodies.size())
{}

std::string EntryCheck::obstacle(int body, const std::vector<double>& alpha, const std::vector<BodyState>& states, const std::vector<char>& isThere)
{
    for (int other = 0; other < int(bodies_.size()); ++other)
        if (other != body && isThere[other] && touches(body, other, states[other].pose)) return "body '" + bodies_[other].name + "'";
    const std::vector<int>& nodes = nodesAt(body);
    return halo_.any(std::any_of(nodes.begin(), nodes.end(), [&](int i) { return alpha[i] > wet; })) ? "liquid" : "";
}

bool EntryCheck::touches(int body, int other, const Pose& pose) const
{
    const BodyDefinition &a = bodies_[body], &b = bodies_[other];
    const double gap = gapOfThickness*std::min(a.thinnest, b.thinnest);
    if ((a.pose.position - pose.position).norm() > extent(a) + extent(b) + gap) return false;
    return std::min(gapOfSpheres(a, a.pose, b, pose), gapOfSpheres(b, pose, a, a.pose)) < gap;
}

/// Nodes of the elements that have one within the body or half an element from it.
const std::vector<int>& EntryCheck::nodesAt(int body)
{
    if (nodes_[body]) return *nodes_[body];
    const BodyDefinition& b = bodies_[body];
    const double radius = extent(b);
    std::vector<int> nodes;
    for (int e = 0; e < mesh_.nElements; ++e)
    {
        const int *first = &mesh_.elements[std::size_t(e)*(mesh_.dim + 1)], *last = first + mesh_.dim + 1;
        const bool isNear = std::any_of(first, last, [&](int i)
        {
            const std::array<double, 3> p = mesh_.spacePoint(i);
            const Vec3 x(p[0], p[1], p[2]);
            return (x - b.pose.position).norm() < radius + mesh_.h[e] && distanceOf(b, b.pose, x) < 0.5*mesh_.h[e];
        });
        if (isNear) nodes.insert(nodes.end(), first, last);
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    nodes_[body] = std::move(nodes);
    return *nodes_[body];
}

} // namespace flotsam
