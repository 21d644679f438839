// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/movingStructures.H"
#include "demCoupling/foam/structureChecks.H"
#include "foam/dictionaryChecks.H"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

constexpr std::size_t mostSpheres = 50000, enoughSpheres = 4000; // more only where they are needed or asked for

/// Of one layer in the mid-plane of a 2D mesh; empty: the shape's section with it is not that with the mesh's front and back.
std::vector<SurfaceSphere> spheresInPlane(const StructureDefinition& s, const SceneFrame& frame, double spacing)
{
    const Pose& pose = s.solid.pose;
    const Vec3 across = Vec3::Unit(frame.planeAxis), normal = pose.orientation.conjugate()*across;
    const Vec3 point = pose.orientation.conjugate()*(frame.midPlane*across - pose.position);
    if (!isSameAcross(s.solid, frame)) return {};
    const auto spheres = sectionSpheres(*s.solid.shape, point, normal, s.sphereRadius, spacing, 0.5*s.sphereRadius);
    const auto isBeside = [&](const SurfaceSphere& sphere) { return std::abs((sphere.centre - point).dot(normal)) > 1e-6*sphere.radius; };
    if (std::any_of(spheres.begin(), spheres.end(), isBeside)) return {};
    return spheres;
}

/// Bodies that slide catch in the grooves between spheres: these lie as near to each other as their number allows. smallest: radius of the bodies' spheres [m].
std::vector<SurfaceSphere> contactSpheres(const StructureDefinition& s, const SceneFrame& frame, double smallest)
{
    const double radius = s.sphereRadius;
    const auto at = [&](double spacing) { return frame.isPlanar ? spheresInPlane(s, frame, spacing) : surfaceSpheres(*s.solid.shape, radius, spacing, 0.5*radius); };
    if (s.sphereSpacing > 0) return at(s.sphereSpacing);
    const double finest = (frame.isPlanar ? 0.125 : 0.25)*radius;
    const std::size_t growth = frame.isPlanar ? 2 : 4;  // of their number, at half the spacing
    double spacing = closedSpacing(radius, smallest, 0.5*radius);
    std::vector<SurfaceSphere> spheres = at(spacing);
    while (spheres.size() > 1 && growth*spheres.size() <= enoughSpheres && spacing > finest)
        spheres = at(spacing = std::max(finest, 0.5*spacing));
    return spheres;
}

} // namespace

void readContactSpheres(const Foam::dictionary& dict, const SceneFrame& frame, StructureDefinition& structure)
{
    const double thinnest = touchingThickness(structure.solid.shape, frame);
    structure.sphereRadius = 0.25*thinnest;
    if (!dict.found("spheres")) return;
    if (!structure.motion) failIn(dict, "Entry 'spheres' is for structures with 'motion': of others bodies feel the facets (entry facetSize). Remove it.");
    readSpheres(subGroup(dict, "spheres"), thinnest, structure.sphereRadius, structure.sphereSpacing);
}

MoverDefinition makeMover(const Foam::dictionary& dict, const SceneFrame& frame, const StructureDefinition& structure, double smallest)
{
    MoverDefinition mover;
    mover.name = structure.solid.name;
    mover.material = structure.material;
    mover.motion = structure.motion;
    mover.finest = smallest;
    mover.spheres = contactSpheres(structure, frame, smallest);
    if (mover.spheres.empty())
        failIn(dict, text("2D mesh: bodies feel moving structures that are boxes with a side along ", "xyz"[frame.planeAxis], ", cylinders along it, or unions of these.\n",
            "    Set 'contact off;' in it if the bodies do not reach it."));
    if (mover.spheres.size() > mostSpheres)
        failIn(dict, text("Structure ", mover.name, " moves: bodies would feel it by ", mover.spheres.size(), " spheres of radius ", structure.sphereRadius, " m; allowed: ", mostSpheres,
            ".\n    Give larger ones, spheres { radius; spacing; }, or a smaller or thicker shape."));
    return mover;
}

} // namespace flotsam
