// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/structureChecks.H"
#include "demCoupling/foam/shortList.H"

#include "foam/dictionaryChecks.H"
#include "geometry/primitives.hpp"
#include "geometry/thinSolids.hpp"
#include "geometry/triSurface.hpp"

#include <cmath>

namespace flotsam
{

namespace
{

/// Surface points are made for pairs alone whose boxes meet: a shape may have a million facets.
class Samples
{
public:
    Samples(const std::vector<StructureDefinition>& structures, const SceneFrame& frame) : structures_(structures), frame_(frame), sampled_(structures.size()) {}

    ShapeAtPose operator()(std::size_t s)
    {
        const Solid& solid = structures_[s].solid;
        for (std::size_t other = 0; !sampled_[s] && other < sampled_.size(); ++other) // members of a group share their shape
            if (sampled_[other] && &sampled_[other]->shape() == solid.shape.get()) sampled_[s] = sampled_[other];
        if (!sampled_[s]) sampled_[s] = sampleShape(solid.shape, thinnestExtent(*solid.shape, frame_));
        return {solid.name, sampled_[s], solid.pose};
    }

private:
    const std::vector<StructureDefinition>& structures_;
    const SceneFrame& frame_;
    std::vector<std::shared_ptr<const SampledShape>> sampled_;
};

std::array<Vec3, 2> boundsOf(const StructureDefinition& s)
{
    return PlacedShape(s.solid.shape, s.solid.pose.orientation, s.solid.pose.position).bounds();
}

bool boxesMeet(const std::array<Vec3, 2>& a, const std::array<Vec3, 2>& b)
{
    return (a[0].array() < b[1].array()).all() && (b[0].array() < a[1].array()).all();
}

bool liesIn(const ShapeAtPose& a, const ShapeAtPose& b, double tolerance)
{
    for (const Vec3& p : a.shape->points())
        if (b.distance(a.pose.orientation*p + a.pose.position) > tolerance) return false;
    return true;
}

/// A fixed structure beside the mesh does nothing: most likely a wrong place, axis or scale.
void warnOutside(const BodiesInput& input)
{
    for (const StructureDefinition& s : input.structures)
    {
        const auto [lower, upper] = boundsOf(s);
        if (s.motion || boxesMeet({lower, upper}, input.box)) continue;
        Foam::Info<< "Warning: structure " << s.solid.name.c_str() << " lies outside of the mesh, it does nothing: from "
            << Foam::vector(lower[0], lower[1], lower[2]) << " to " << Foam::vector(upper[0], upper[1], upper[2]);
        if ((upper - lower).maxCoeff() > (input.box[1] - input.box[0]).maxCoeff()) Foam::Info<< ". It is longer than the mesh. Lengths are in m: an STL file in mm needs 'scale 0.001'";
        Foam::Info<< Foam::nl;
    }
}

/// The box is the mesh's: shapes are asked for nodes only where theirs holds it.
bool coversMesh(const StructureDefinition& s, const std::array<Vec3, 2>& box, const SimplexMesh& mesh, const Halo& halo)
{
    const auto [lower, upper] = boundsOf(s);
    if (!((lower.array() <= box[0].array()).all() && (box[1].array() <= upper.array()).all())) return false;
    const PlacedShape placed(s.solid.shape, s.solid.pose.orientation, s.solid.pose.position);
    bool isLeft = false;
    for (int i = 0; i < mesh.nOwned && !isLeft; ++i)
    {
        const auto x = mesh.spacePoint(i);
        isLeft = placed.distance({x[0], x[1], x[2]}) > 0;
    }
    return !halo.any(isLeft);
}

/// Whether a structure's box lies in that of another one.
bool liesInOther(const std::vector<StructureDefinition>& structures, std::size_t s)
{
    const auto inner = boundsOf(structures[s]);
    for (std::size_t other = 0; other < structures.size(); ++other)
    {
        if (other == s) continue;
        const auto outer = boundsOf(structures[other]);
        if ((outer[0].array() <= inner[0].array()).all() && (inner[1].array() <= outer[1].array()).all()) return true;
    }
    return false;
}

void warnUneven(const BodiesInput& input, const SceneFrame& frame)
{
    ShortList uneven;
    for (const StructureDefinition& s : input.structures)
        if (boxesMeet(boundsOf(s), input.box) && !isSameAcross(s.solid, frame)) uneven.add(s.solid.name);
    if (uneven.isEmpty()) return;
    const char axis = "xyz"[frame.planeAxis];
    Foam::Info<< "Warning: 2D mesh: structures that are not the same from its front to its back, " << axis << " = " << frame.midPlane - 0.5*frame.thickness << " to "
        << frame.midPlane + 0.5*frame.thickness << " m: " << uneven.text().c_str() << ". The flow has their section at " << axis << " = " << frame.midPlane
        << " m all through, bodies meet them as they are. Let them reach through the mesh" << Foam::nl;
}

} // namespace

bool isSameAcross(const Solid& solid, const SceneFrame& frame)
{
    if (!frame.isPlanar) return true;
    const Vec3 across = Vec3::Unit(frame.planeAxis), normal = solid.pose.orientation.conjugate()*across;
    const Vec3 point = solid.pose.orientation.conjugate()*(frame.midPlane*across - solid.pose.position);
    const auto area = [&](double share) { return solid.shape->sectionArea(point + share*frame.thickness*normal, normal); };
    const double middle = area(0);
    return middle > 0 && std::abs(area(0.499) - middle) <= 1e-3*middle && std::abs(area(-0.499) - middle) <= 1e-3*middle;
}

StructureOverlaps findOverlaps(const std::vector<StructureDefinition>& structures, const SceneFrame& frame)
{
    StructureOverlaps overlaps;
    Samples sample(structures, frame);
    std::vector<std::array<Vec3, 2>> boxes;
    for (const StructureDefinition& s : structures) boxes.push_back(boundsOf(s));
    for (int a = 0; a < int(structures.size()); ++a)
        for (int b = a + 1; b < int(structures.size()); ++b)
        {
            if (!boxesMeet(boxes[a], boxes[b])) continue;
            const ShapeAtPose first = sample(a), second = sample(b);
            const double tolerance = 1e-3*std::min(thinnestExtent(first.shape->shape(), frame), thinnestExtent(second.shape->shape(), frame));
            if (liesIn(second, first, tolerance)) overlaps.inside.emplace_back(b, a);
            else if (liesIn(first, second, tolerance)) overlaps.inside.emplace_back(a, b);
            else if (gap(first, second, 0) < -tolerance) overlaps.overlapping.emplace_back(a, b);
        }
    return overlaps;
}

void checkCovering(const BodiesInput& input, const SimplexMesh& mesh, const Halo& halo, const Foam::dictionary& dict)
{
    for (const StructureDefinition& s : input.structures)
    {
        if (!coversMesh(s, input.box, mesh, halo)) continue;
        const Vec3 size = boundsOf(s)[1] - boundsOf(s)[0], meshSize = input.box[1] - input.box[0];
        failIn(dict, text("Structure '", s.solid.name, "' covers the whole mesh: it is ", size[0], " m x ", size[1], " m x ", size[2], " m, the mesh ",
            meshSize[0], " m x ", meshSize[1], " m x ", meshSize[2], " m, and no fluid is left.\n    Lengths are in m: an STL file in mm needs 'scale 0.001'."));
    }
}

void reportStructures(const BodiesInput& input, const SceneFrame& frame)
{
    if (!Foam::Pstream::master()) return;
    warnOutside(input);
    warnUneven(input, frame);
    const StructureOverlaps overlaps = findOverlaps(input.structures, frame);
    const auto name = [&](int s) { return input.structures[s].solid.name.c_str(); };
    for (const auto& [inner, outer] : overlaps.inside)
        Foam::Info<< "Warning: structure " << name(inner) << " lies inside of structure " << name(outer) << ", it does nothing" << Foam::nl;
    if (overlaps.overlapping.empty()) return;
    const auto& [a, b] = overlaps.overlapping.front();
    Foam::Info<< overlaps.overlapping.size() << (overlaps.overlapping.size() == 1 ? " pair of structures overlaps: " : " pairs of structures overlap, the first: ")
        << name(a) << " and " << name(b) << ". Together they are one solid; each gets the force on its part of the surface" << Foam::nl;
}

void reportThinStructures(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const Cover& cover, const BodiesInput& input, std::size_t nSolids)
{
    const std::vector<SharedNodes> shared = findSharedNodes(mesh, graph, halo, cover, nSolids);
    ShortList seeping, unseen;
    for (std::size_t s = 0; s < input.structures.size(); ++s)
    {
        const StructureDefinition& structure = input.structures[s];
        const auto& x = shared[s].middle;
        if (shared[s].count > 0)
            seeping.add(text(structure.solid.name, ", ", shared[s].count, shared[s].count == 1 ? " node around (" : " nodes around (", x[0], " ", x[1], " ", x[2], ")"));
        if (cover.solidVolume[s] <= 0 && !structure.motion && boxesMeet(boundsOf(structure), input.box) && !liesInOther(input.structures, s)) unseen.add(structure.solid.name);
    }
    if (!unseen.isEmpty())
        Foam::Info<< "Warning: the flow does not know of structures that are thinner than an element and have no node of the mesh inside: " << unseen.text().c_str()
            << ". Refine the mesh there, or make them thicker" << Foam::nl << Foam::endl;
    if (!seeping.isEmpty())
        Foam::Info<< "Warning: fluid seeps through structures that are thinner than two elements, where it has nodes in common on both sides: " << seeping.text().c_str()
            << ". Refine the mesh there, or make them thicker" << Foam::nl << Foam::endl;
}

} // namespace flotsam
