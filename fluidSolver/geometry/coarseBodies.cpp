// SPDX-License-Identifier: GPL-3.0-or-later
/// CoverBuilder: solids thinner than an element or little more. Of a round one the linear cut sees what nodes lie inside, and between several solids it sees none without nodes inside:
/// a log of half an element would weigh, but not float, and a rack of such bars would hold nothing back. They are cut by plane faces.
#include "geometry/coverBuilder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flotsam
{

namespace
{

constexpr double unknownThickness = std::numeric_limits<double>::infinity();

std::shared_ptr<const Shape> partOf(const Solid& solid, int number) { return {solid.shape, &solid.shape->part(number)}; }

} // namespace

/// Null: not round. Kept per shape.
std::shared_ptr<const PlaneFaces> CoverBuilder::facesOfRound(const std::shared_ptr<const Shape>& shape)
{
    for (const RoundShape& round : roundShapes_)
        if (round.shape == shape) return round.faces;
    return roundShapes_.emplace_back(RoundShape{shape, makePlaneFaces(*shape)}).faces;
}

/// Kept per shape: a body in a 2D mesh turns about the mesh's normal, which is the same to it.
double CoverBuilder::thicknessOfPolyhedron(const std::shared_ptr<const Shape>& shape, const Vec3& across)
{
    constexpr double tolerance = 1e-6;
    for (const Polyhedron& known : polyhedra_)
        if (known.shape == shape && (known.across - across).norm() < tolerance) return known.thickness;
    return polyhedra_.emplace_back(Polyhedron{shape, across, planeThickness(*shape, across)}).thickness;
}

/// Of what can be cut by plane faces [m]; infinite: others. In 2D what is round must stand across the plane: the polyhedron's section is the shape's then.
double CoverBuilder::partThickness(const Solid& solid, const std::shared_ptr<const Shape>& part)
{
    const Vec3 across = mesh_.dim == 2 ? Vec3(solid.pose.orientation.conjugate() * Vec3::Unit(mesh_.axes[2])) : Vec3(Vec3::Zero());
    if (part->hasPlaneFaces()) return thicknessOfPolyhedron(part, across);
    const bool isAlongPlane = mesh_.dim == 2 && std::abs(across.dot(part->symmetry().axis)) < 1 - 1e-9;
    return facesOfRound(part) && !isAlongPlane ? roundThickness(*part) : unknownThickness;
}

/// Of its thinnest part, if all can be cut by plane faces.
double CoverBuilder::thickness(const Solid& solid)
{
    double least = unknownThickness;
    for (int k = 0; k < solid.shape->nParts(); ++k)
    {
        const double ofPart = partThickness(solid, partOf(solid, k));
        if (ofPart == unknownThickness) return unknownThickness;
        least = std::min(least, ofPart);
    }
    return least;
}

void CoverBuilder::chooseThin(std::vector<Solid>& solids)
{
    std::vector<double> lengths; // of each candidate: number of elements at nodes near it, sum of their lengths
    std::vector<std::size_t> candidates;
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
        solids[s].isThin = false;
        if (thickness(solids[s]) < resolvedThickness * longest_) candidates.push_back(s);
        else solids[s].planeFaces.clear();
    }
    if (candidates.empty()) return;
    for (const std::size_t s : candidates)
    {
        double count = 0, sum = 0;
        Solid plain = solids[s]; // whether it is thin decides about the offsets: it must not depend on them
        plain.offset = 0;
        plain.offsetSlope.setZero();
        bins_.forEachNear(plain.spaceBounds(), [&](int node, const Vec3&)
        {
            if (node >= mesh_.nOwned) return;
            for (int k = graph_.nodeElementStart[node]; k < graph_.nodeElementStart[node + 1]; ++k) sum += mesh_.h[graph_.nodeElement[k]];
            count += graph_.nodeElementStart[node + 1] - graph_.nodeElementStart[node];
        });
        lengths.insert(lengths.end(), {count, sum});
    }
    halo_.sum(lengths.data(), static_cast<int>(lengths.size()));
    for (std::size_t k = 0; k < candidates.size(); ++k)
    {
        Solid& solid = solids[candidates[k]];
        solid.isThin = thickness(solid) * lengths[2 * k] < resolvedThickness * lengths[2 * k + 1];
        solid.planeFaces.clear();
        if (!solid.isThin) continue;
        for (int part = 0; part < solid.shape->nParts(); ++part) solid.planeFaces.push_back(facesOfRound(partOf(solid, part)));
        if (needsOffsets(solid)) continue;
        solid.offset = 0; // their volume is exact
        solid.offsetSlope.setZero();
    }
}

} // namespace flotsam
