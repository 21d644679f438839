// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/movingStructures.H"
#include "foam/dictionaryChecks.H"

#include "geometry/primitives.hpp"

namespace flotsam
{

namespace
{

constexpr std::size_t mostSpheres = 50000;

/// A box cut to the mesh's plane, as thick as its spheres: they are one layer, as those of the bodies.
std::shared_ptr<const Shape> inPlane(const BoxShape& box, const Pose& pose, double radius, const SceneFrame& frame)
{
    const Vec3 normal = pose.orientation.conjugate()*Vec3::Unit(frame.planeAxis);
    int across = 0;
    normal.cwiseAbs().maxCoeff(&across);
    if (std::abs(normal[across]) < 1 - 1e-9) return nullptr;
    Vec3 centre = box.centre(), size = 2*box.half();
    centre[across] = (frame.midPlane - pose.position[frame.planeAxis])*normal[across];
    size[across] = 2*radius;
    return makeBox(centre, size);
}

std::vector<SurfaceSphere> spheresInPlane(const StructureDefinition& s, const SceneFrame& frame, double spacing)
{
    const Pose& pose = s.solid.pose;
    if (const auto* box = dynamic_cast<const BoxShape*>(s.solid.shape.get()))
        if (const auto cut = inPlane(*box, pose, s.sphereRadius, frame)) return surfaceSpheres(*cut, s.sphereRadius, spacing);
    const auto* cylinder = dynamic_cast<const CylinderShape*>(s.solid.shape.get());
    if (!cylinder || std::abs((pose.orientation*cylinder->axis())[frame.planeAxis]) < 1 - 1e-9) return {};
    const Vec3 inSpace = pose.orientation*cylinder->centre() + pose.position;
    const Vec3 shift = Vec3::Unit(frame.planeAxis)*(frame.midPlane - inSpace[frame.planeAxis]);
    return {{cylinder->centre() + pose.orientation.conjugate()*shift, cylinder->radius()}};
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
        failIn(dict, text("2D mesh: bodies feel moving structures that are boxes with a side along ", "xyz"[frame.planeAxis], ", or cylinders along it.\n",
            "    Set 'contact off;' in it if the bodies do not reach it."));
    if (mover.spheres.size() > mostSpheres)
        failIn(dict, text("Structure ", mover.name, " moves: bodies would feel it by ", mover.spheres.size(), " spheres of radius ", radius, " m; allowed: ", mostSpheres,
            ".\n    Give larger ones, spheres { radius; spacing; }, or a smaller or thicker shape."));
    return mover;
}

} // namespace flotsam
