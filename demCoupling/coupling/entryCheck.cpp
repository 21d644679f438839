// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/entryCheck.hpp"

#include <algorithm>
#include <cstdio>
#include <numeric>

namespace flotsam
{

namespace
{

constexpr double wet = 0.01;            // alpha that counts as liquid
constexpr double gapOfThickness = 0.05; // of bodies, that contact does not begin at once
constexpr int halvings = 9;             // of an element, to an eighth of its length in 3D

using Corners = std::array<Vec3, 4>;    // of an element, 2D: three

double distanceOf(const BodyDefinition& body, const Pose& pose, const Vec3& x)
{
    return body.shape->distance(pose.orientation.conjugate()*(x - pose.position));
}

/// Of spheres in the frame of the pose from what `distance` is the distance of.
template<class Distance>
double gapOfSpheres(const std::vector<SurfaceSphere>& spheres, const Pose& pose, const Distance& distance)
{
    double gap = 1e300;
    for (const SurfaceSphere& s : spheres) gap = std::min(gap, distance(pose.position + pose.orientation*s.centre) - s.radius);
    return gap;
}

double length(const Corners& x, std::array<int, 2> edge) { return (x[edge[0]] - x[edge[1]]).norm(); }

std::array<int, 2> longestEdge(const Corners& x, int n)
{
    std::array<int, 2> longest{0, 1};
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < a; ++b)
            if (length(x, {a, b}) > length(x, longest)) longest = {a, b};
    return longest;
}

/// Whether the body reaches into the element. Its distance changes no faster than the place: what that at the centre leaves open the halves answer; after
/// the last of them: yes.
bool reachesInto(const BodyDefinition& body, const Corners& x, int n, int halvingsLeft)
{
    const Vec3 centre = std::accumulate(x.begin(), x.begin() + n, Vec3(0, 0, 0))/n;
    double size = 0;
    for (int a = 0; a < n; ++a) size = std::max(size, (x[a] - centre).norm());
    const double distance = distanceOf(body, body.pose, centre);
    if (distance <= 0 || distance >= size || halvingsLeft == 0) return distance < size;
    const std::array<int, 2> edge = longestEdge(x, n);
    for (int end : edge)
    {
        Corners half = x;
        half[end] = 0.5*(x[edge[0]] + x[edge[1]]);
        if (reachesInto(body, half, n, halvingsLeft - 1)) return true;
    }
    return false;
}

/// With the largest alpha: little of it is the surface's tail, which reaches farther than the level that one sees.
Obstacle liquid(double alpha)
{
    if (alpha <= wet) return {};
    char text[64];
    std::snprintf(text, sizeof text, "liquid (alpha up to %.2g) in the elements", alpha);
    return {text, true};
}

} // namespace

EntryCheck::EntryCheck(const SimplexMesh& mesh, const Halo& halo, const std::vector<BodyDefinition>& bodies)
:   mesh_(mesh), halo_(halo), bodies_(bodies), nodes_(bodies.size())
{
    for (const BodyDefinition& body : bodies) extents_.push_back(outerRadius(body));
}

Obstacle EntryCheck::obstacle(int body, const std::vector<double>& alpha, const std::vector<BodyState>& states, const std::vector<char>& isAway,
    const std::vector<Solid>& structures)
{
    for (const Solid& structure : structures)
        if (structure.kind == Solid::Kind::Prescribed && touches(body, structure)) return {"structure '" + structure.name + "'"};
    for (int other = 0; other < int(bodies_.size()); ++other)
        if (other != body && !isAway[other] && touches(body, other, states[other].pose)) return {"body '" + bodies_[other].name + "'"};
    double wettest = 0;
    for (int i : nodesAt(body)) wettest = std::max(wettest, alpha[i]);
    return liquid(halo_.max(wettest));
}

bool EntryCheck::touches(int body, int other, const Pose& pose) const
{
    const BodyDefinition &a = bodies_[body], &b = bodies_[other];
    const double gap = gapOfThickness*std::min(a.thinnest, b.thinnest);
    if ((a.pose.position - pose.position).norm() > extents_[body] + extents_[other] + gap) return false;
    return gapOfSpheres(a.spheres, a.pose, [&](const Vec3& x) { return distanceOf(b, pose, x); }) < gap
        || gapOfSpheres(b.spheres, pose, [&](const Vec3& x) { return distanceOf(a, a.pose, x); }) < gap;
}

bool EntryCheck::touches(int body, const Solid& structure) const
{
    const BodyDefinition& b = bodies_[body];
    if ((b.pose.position - structure.pose.position).norm() > extents_[body] + structure.radius() + b.thinnest) return false;
    return gapOfSpheres(spheresAtWalls(b), b.pose, [&](const Vec3& x) { return structure.distance(x); }) < gapOfThickness*b.thinnest;
}

/// Nodes of the elements that the body reaches into, or that have a node within half an element from it.
const std::vector<int>& EntryCheck::nodesAt(int body)
{
    if (nodes_[body]) return *nodes_[body];
    const BodyDefinition& b = bodies_[body];
    const int n = mesh_.dim + 1;
    std::vector<int> nodes;
    for (int e = 0; e < mesh_.nElements; ++e)
    {
        const int *first = &mesh_.elements[std::size_t(e)*n], *last = first + n;
        Corners x;
        x.fill(Vec3::Zero());
        for (int a = 0; a < n; ++a) x[a] = Vec3(mesh_.spacePoint(first[a]).data());
        double farthest = mesh_.h[e];
        for (int a = 1; a < n; ++a) farthest = std::max(farthest, (x[a] - x[0]).norm());
        if ((x[0] - b.pose.position).norm() > extents_[body] + b.thinnest + farthest) continue;
        const bool isNear = std::any_of(x.begin(), x.begin() + n, [&](const Vec3& p) { return distanceOf(b, b.pose, p) < 0.5*mesh_.h[e]; });
        if (isNear || reachesInto(b, x, n, halvings)) nodes.insert(nodes.end(), first, last);
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    nodes_[body] = std::move(nodes);
    return *nodes_[body];
}

} // namespace flotsam
