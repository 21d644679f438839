// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/bodyGroup.H"
#include "demCoupling/foam/bodyVariation.H"
#include "demCoupling/foam/contactReader.H"
#include "foam/dictionaryChecks.H"
#include "geometry/primitives.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace flotsam
{

namespace
{

const std::vector<std::string> bodyKeywords{"shape", "density", "mass", "material", "spheres", "position", "orientation", "velocity",
    "angularVelocity", "releaseTime", "beforeRelease", "array", "poses", "random", "variation"};

/// density [kg/m3]: a member's own, 0: the group's.
double readMass(const Foam::dictionary& dict, double volume, double density)
{
    if (density > 0) return density*volume;
    if (dict.found("mass") == dict.found("density"))
        failIn(dict, "Give either 'density' [kg/m^3] or 'mass' [kg] of the body.");
    return dict.found("mass") ? readNumber(dict, "mass", positive) : readNumber(dict, "density", positive)*volume;
}

bool readEntersAtRelease(const Foam::dictionary& dict)
{
    const std::string before = readWordOr(dict, "beforeRelease", "held");
    if (before != "held" && before != "absent") failUnknown(dict, "beforeRelease", before, {"held", "absent"});
    return before == "absent";
}

/// thinnest: smallest extent [m] of the shape that the dictionary gives them for; a thinner member has finer ones.
void readKindSpheres(const Foam::dictionary& dict, double thinnest, BodyKind& kind)
{
    kind.sphereRadius = 0.25*kind.prototype.thinnest;
    if (!dict.found("spheres")) return;
    double radius = 0.25*thinnest, spacing = 0;
    readSpheres(subGroup(dict, "spheres"), thinnest, radius, spacing);
    const double share = kind.prototype.thinnest/thinnest;
    kind.sphereRadius = share*radius;
    kind.sphereSpacing = share*spacing;
}

/// Of the box around the body [m2].
double boxArea(const BodyDefinition& body)
{
    const auto [lower, upper] = body.shape->bounds();
    const Vec3 s = upper - lower;
    return 2*(s[0]*s[1] + s[1]*s[2] + s[2]*s[0]);
}

/// Such that the smallest spheres of any body do not sink in between; more than 16 times as many as without them only up to a number that costs little.
double chooseSpacing(const BodyKind& kind, double smallest)
{
    constexpr double enough = 4000;
    const double R = kind.sphereRadius;
    return closedSpacing(R, smallest, kind.prototype.isPlanar ? 0 : std::min(0.5*R, std::sqrt(boxArea(kind.prototype)/enough))); // around a section there are few
}

/// Before they are made: a radius in other units than m would fill the memory.
void checkSphereCount(const Foam::dictionary& dict, const BodyKind& kind, double spacing)
{
    constexpr double most = 1e6;
    const BodyDefinition& body = kind.prototype;
    const double count = boxArea(body)/(spacing*spacing);
    if (body.isPlanar || count <= most) return;
    failIn(dict, text("Body ", body.name, " would have some ", count, " contact spheres of radius ", kind.sphereRadius, " m, ", spacing, " m apart; allowed: ", most,
        ".\n    Give larger ones, spheres { radius; spacing; } [m]; its smallest extent is ", body.thinnest, " m."));
}

void makeKindSpheres(const Foam::dictionary& dict, BodyKind& kind, double smallest)
{
    constexpr double cornerShare = 1.0/16; // radius of corners over the thickness (docs/contact.md)
    const double spacing = kind.sphereSpacing > 0 ? kind.sphereSpacing : chooseSpacing(kind, smallest);
    const double ofRows = kind.sphereSpacing > 0 ? kind.sphereSpacing : 0.5*kind.sphereRadius;
    checkSphereCount(dict, kind, spacing);
    BodyDefinition& body = kind.prototype;
    const Vec3 across = body.pose.orientation.conjugate()*Vec3::Unit(body.planeAxis);
    body.spheres = body.isPlanar ? sectionSpheres(*body.shape, Vec3::Zero(), across, kind.sphereRadius, spacing, ofRows)
                                 : surfaceSpheres(*body.shape, kind.sphereRadius, spacing, ofRows);
    const double ofCorners = cornerShare*body.thinnest;
    if (ofCorners < (1 - 1e-9)*body.spheres.front().radius)
        body.corners = body.isPlanar ? sectionCorners(*body.shape, Vec3::Zero(), across, ofCorners) : cornerSpheres(*body.shape, ofCorners);
}

/// Of a kind: members of one kind have the same spheres, those that join them as well.
std::optional<double> storedFinest(const BodyGroup& group, std::size_t kind, const StoredFinest& stored)
{
    const bool isMany = group.dict->found("array") || group.dict->found("poses") || group.dict->found("random");
    const auto found = stored.find(isMany ? text("body ", group.name, '.', kind) : "body " + group.name);
    return found == stored.end() ? std::nullopt : std::optional<double>(found->second);
}

void reportKeptSpheres(const BodyGroup& group, const BodyKind& kind, double smallest)
{
    constexpr double roundOff = 1e-9;
    const double finest = kind.prototype.finest;
    if (kind.sphereSpacing > 0 || finest <= (1 + roundOff)*smallest || chooseSpacing(kind, finest) <= (1 + roundOff)*chooseSpacing(kind, smallest)) return;
    Foam::Info<< text("Contact: ", group.name, " keeps the contact spheres of the stored state, made for others of ", finest, " m and more; new ones of ", smallest,
        " m sink in deeper between them").c_str() << Foam::nl;
}

/// density [kg/m3]: 0: as the dictionary says; thinnest: of the group's shape [m].
BodyKind readKind(const std::string& name, const Foam::dictionary& dict, const Foam::dictionary& shape, double density, const SceneFrame& frame, std::optional<double> thinnest = {})
{
    BodyKind kind;
    const PrincipalShape principal = toPrincipalFrame(readShape(shape, frame.stlFolder));
    BodyDefinition& body = kind.prototype;
    body.name = name;
    body.shape = principal.shape;
    body.volume = principal.volume;
    body.mass = readMass(dict, principal.volume, density);
    body.principalInertia = principal.inertia*(body.mass/principal.volume);
    body.pose = principal.inUserFrame;
    body.material = readMaterial(dict, "material", frame.materials);
    body.isPlanar = frame.isPlanar;
    body.planeAxis = frame.planeAxis;
    body.thinnest = touchingThickness(body.shape, frame);
    body.entersAtRelease = readEntersAtRelease(dict);
    kind.sampled = sampleShape(body.shape, body.thinnest);
    readKindSpheres(dict, thinnest.value_or(body.thinnest), kind);
    return kind;
}

} // namespace

void checkPlanarMotion(const Foam::dictionary& dict, const std::string& name, const Motion& motion, const SceneFrame& frame)
{
    if (!frame.isPlanar) return;
    constexpr double roundOff = 1e-9;   // of a direction
    for (int k = 0; k < 3; ++k)
    {
        const bool isAcross = k == frame.planeAxis;
        const Vec3& all = isAcross ? motion.velocity : motion.angularVelocity;
        if (std::abs(all[k]) <= roundOff*all.norm()) continue;
        failIn(dict, text("2D mesh, one cell along ", "xyz"[frame.planeAxis], ": ", isAcross ? "velocity" : "angularVelocity", " of ", name, " along ", "xyz"[k], " is ",
            all[k], "; allowed: 0."));
    }
}

void readSpheres(const Foam::dictionary& dict, double thinnest, double& radius, double& spacing)
{
    checkKeywords(dict, {"radius", "spacing"});
    radius = readNumberOr(dict, "radius", radius, {0, 0.5*thinnest*(1 + 1e-9), true},
        text("The smallest extent is ", thinnest, " m, in a union that of its thinnest part: the spheres must fit into it."));
    spacing = readNumberOr(dict, "spacing", 0, {0, 4*radius, true}, "At most twice the diameter, or bodies pass between the spheres.");
}

double closedSpacing(double R, double r, double finest)
{
    constexpr double height = 0.41421356237309503;
    const double low = R + height*r, s = std::sqrt(2*((R + r)*(R + r) - low*low));
    return r < R ? std::clamp(s, std::min(finest, 2*R), 2*R) : 2*R;
}

double thinnestExtent(const Shape& shape, const SceneFrame& frame)
{
    const auto* placed = dynamic_cast<const PlacedShape*>(&shape);
    if (const auto* joined = dynamic_cast<const UnionShape*>(placed ? &placed->inner() : &shape))
    {
        double thinnest = 1e300;
        for (const auto& part : joined->parts()) thinnest = std::min(thinnest, thinnestExtent(*part, frame));
        return thinnest;
    }
    if (const auto* cylinder = dynamic_cast<const CylinderShape*>(&shape); cylinder && !frame.isPlanar)
        return 2*std::min(cylinder->radius(), cylinder->halfLength());
    if (const auto* capsule = dynamic_cast<const CapsuleShape*>(&shape)) return 2*capsule->radius();
    const auto [lower, upper] = shape.bounds();
    double thinnest = 1e300;
    for (int d = 0; d < 3; ++d)
        if (!frame.isPlanar || d != frame.planeAxis) thinnest = std::min(thinnest, upper[d] - lower[d]);
    return thinnest;
}

std::shared_ptr<const SampledShape> sampleShape(std::shared_ptr<const Shape> shape, double thinnest)
{
    constexpr double largestNumber = 2e4;
    const auto [lower, upper] = shape->bounds();
    const Vec3 s = upper - lower;
    const double area = 2*(s[0]*s[1] + s[1]*s[2] + s[2]*s[0]);
    return std::make_shared<SampledShape>(std::move(shape), std::max(0.25*thinnest, std::sqrt(area/largestNumber)));
}

void makeSpheres(std::vector<BodyGroup>& groups, const StoredFinest& stored)
{
    const double smallest = smallestSphere(groups);
    for (BodyGroup& group : groups)
        for (std::size_t k = 0; k < group.kinds.size(); ++k)
        {
            BodyKind& kind = group.kinds[k];
            kind.prototype.finest = storedFinest(group, k, stored).value_or(smallest);
            makeKindSpheres(*group.dict, kind, kind.prototype.finest);
            if (k == 0) reportKeptSpheres(group, kind, smallest);
        }
}

double smallestSphere(const std::vector<BodyGroup>& groups)
{
    double smallest = 1e300;
    for (const BodyGroup& group : groups)
        for (const BodyKind& kind : group.kinds) smallest = std::min(smallest, kind.sphereRadius);
    return smallest;
}

BodyGroup readBodyGroup(const std::string& name, const Foam::dictionary& dict, const SceneFrame& frame)
{
    checkKeywords(dict, bodyKeywords);
    if (dict.found("array") + dict.found("poses") + dict.found("random") > 1)
        failIn(dict, "Give only one of 'array', 'poses' and 'random'.");
    BodyGroup group;
    group.name = name;
    group.dict = &dict;
    const Foam::dictionary& shape = subGroup(dict, "shape");
    if (!dict.found("variation"))
    {
        group.kinds.push_back(readKind(name, dict, shape, 0, frame));
        return group;
    }
    const double thinnest = touchingThickness(readShape(shape, frame.stlFolder), frame);
    for (const MemberVariation& member : drawVariations(dict, memberCount(dict)))
        group.kinds.push_back(readKind(name, dict, member.shape, member.density, frame, thinnest));
    return group;
}

} // namespace flotsam
