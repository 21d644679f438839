// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/movingStructures.H"
#include "foam/dictionaryChecks.H"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

constexpr std::size_t mostSpheres = 50000;

/// Of one layer in the mid-plane of a 2D mesh; empty: the shape's section with it is not that with the mesh's front and back.
std::vector<SurfaceSphere> spheresInPlane(const StructureDefinition& s, const SceneFrame& frame, double spacing)
{
    const Pose& pose = s.solid.pose;
    const Vec3 across = Vec3::Unit(frame.planeAxis), normal = pose.orientation.conjugate()*across;
    const Vec3 point = pose.orientation.conjugate()*(frame.midPlane*across - pose.position);
    const double area = s.solid.shape->sectionArea(point, normal);
    for (const double side : {-1, 1})
        if (std::abs(s.solid.shape->sectionArea(point + 0.499*side*frame.thickness*normal, normal) - area) > 1e-3*area) return {};
    const auto spheres = sectionSpheres(*s.solid.shape, point, normal, s.sphereRadius, spacing, 0.5*s.sphereRadius);
    const auto isBeside = [&](const SurfaceSphere& sphere) { return std::abs((sphere.centre - point).dot(normal)) > 1e-6*sphere.radius; };
    if (std::any_of(spheres.begin(), spheres.end(), isBeside)) return {};
    return spheres;
}

} // namespace

void readContactSpheres(const Foam::dictionary& dict, const SceneFrame& frame, StructureDefinition& structure)
{
    const double thinnest = thinnestExtent(*structure.solid.shape, frame);
    structure.sphereRadius = 0.25*thinnest;
    if (!dict.found("spheres")) return;
    if (!structure.motion) failIn(dict, "Entry 'spheres' is for structures with 'motion': of others bodies feel the facets (entry facetSize). Remove it.");
    readSpheres(dict.subDict("spheres"), thinnest, structure.sphereRadius, structure.sphereSpacing);
}

MoverDefinition makeMover(const Foam::dictionary& dict, const SceneFrame& frame, const StructureDefinition& structure, double smallest)
{
    const double radius = structure.sphereRadius, spacing = structure.sphereSpacing > 0 ? structure.sphereSpacing : closedSpacing(radius, smallest);
    MoverDefinition mover;
    mover.name = structure.solid.name;
    mover.material = structure.material;
    mover.motion = structure.motion;
    mover.spheres = frame.isPlanar ? spheresInPlane(structure, frame, spacing) : surfaceSpheres(*structure.solid.shape, radius, spacing, 0.5*radius);
    if (mover.spheres.empty())
        failIn(dict, text("2D mesh: bodies feel moving structures that are boxes with a side along ", "xyz"[frame.planeAxis], ", cylinders along it, or unions of these.\n",
            "    Set 'contact off;' in it if the bodies do not reach it."));
    if (mover.spheres.size() > mostSpheres)
        failIn(dict, text("Structure ", mover.name, " moves: bodies would feel it by ", mover.spheres.size(), " spheres of radius ", radius, " m; allowed: ", mostSpheres,
            ".\n    Give larger ones, spheres { radius; spacing; }, or a smaller or thicker shape."));
    return mover;
}

} // namespace flotsam
