// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/shapeReader.H"
#include "foam/dictionaryChecks.H"

#include "OSspecific.H"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace flotsam
{

namespace
{

const std::vector<std::string> shapeTypes{"box", "sphere", "cylinder", "capsule", "stl", "union"};

Vec3 readSize(const Foam::dictionary& dict)
{
    const Vec3 size = readVec3(dict, "size");
    for (int d = 0; d < 3; ++d) checkRange(dict, "size", size[d], positive);
    return size;
}

void checkEnds(const Foam::dictionary& dict)
{
    if (readVec3(dict, "end1") == readVec3(dict, "end2")) failIn(dict, "end1 and end2 are the same point: the shape has no length.");
}

std::shared_ptr<const Shape> readParts(const Foam::dictionary& dict, const Foam::fileName& stlFolder)
{
    std::vector<std::shared_ptr<const Shape>> parts;
    for (const Foam::entry& part : subGroup(dict, "parts"))
    {
        if (!part.isDict()) failIn(dict, text("parts: '", std::string(part.keyword()), "' must be a shape { type ..; .. }."));
        parts.push_back(readShape(part.dict(), stlFolder));
    }
    if (parts.empty()) failIn(dict, "A union needs at least one shape in 'parts'.");
    return makeUnion(parts);
}

/// A file of the folder; where it is missing what the folder has instead.
Foam::fileName stlFile(const Foam::dictionary& dict, const Foam::fileName& folder)
{
    const Foam::fileName file = folder/readAs<Foam::fileName>(dict, "file", "the name of a file below constant/triSurface");
    if (Foam::isFile(file, false)) return file;
    std::vector<std::string> present;
    for (const Foam::fileName& name : Foam::readDir(file.path(), Foam::fileName::FILE, false)) present.push_back(name);
    std::sort(present.begin(), present.end());
    failIn(dict, text("STL file ", std::string(file), " is missing; its folder ", present.empty() ? "is missing, too, or empty." : "has " + joined(present) + "."));
}

} // namespace

Vec3 readVec3(const Foam::dictionary& dict, const char* keyword)
{
    const auto v = readAs<Foam::vector>(dict, keyword, "three numbers in round brackets: (x y z)");
    return Vec3(v.x(), v.y(), v.z());
}

Vec3 readVec3Or(const Foam::dictionary& dict, const char* keyword, const Vec3& byDefault)
{
    return dict.found(keyword) ? readVec3(dict, keyword) : byDefault;
}

Vec3 readDirection(const Foam::dictionary& dict, const char* keyword)
{
    const Vec3 v = readVec3(dict, keyword);
    if (v.norm() < 1e-12) failIn(dict, text("Entry '", keyword, "' is (0 0 0): it must be a direction."));
    return v.normalized();
}

std::shared_ptr<const Shape> readShape(const Foam::dictionary& dict, const Foam::fileName& stlFolder)
{
    const std::string type = readWord(dict, "type", shapeTypes);
    try
    {
        if (type == "box")
        {
            checkKeywords(dict, {"type", "size", "centre"});
            return makeBox(readVec3Or(dict, "centre", Vec3::Zero()), readSize(dict));
        }
        if (type == "sphere")
        {
            checkKeywords(dict, {"type", "radius", "centre"});
            return makeSphere(readVec3Or(dict, "centre", Vec3::Zero()), readNumber(dict, "radius", positive));
        }
        if (type == "cylinder" || type == "capsule")
        {
            checkKeywords(dict, {"type", "end1", "end2", "radius"});
            checkEnds(dict);
            const auto make = type == "cylinder" ? makeCylinder : makeCapsule;
            return make(readVec3(dict, "end1"), readVec3(dict, "end2"), readNumber(dict, "radius", positive));
        }
        if (type == "stl")
        {
            checkKeywords(dict, {"type", "file", "scale"});
            return makeStl(stlFile(dict, stlFolder), readNumberOr(dict, "scale", 1, positive));
        }
        if (type == "union")
        {
            checkKeywords(dict, {"type", "parts"});
            return readParts(dict, stlFolder);
        }
    }
    catch (const std::runtime_error& error)
    {
        failIn(dict, error.what());
    }
    failUnknown(dict, "shape type", type, shapeTypes);
}

Eigen::Quaterniond readOrientation(const Foam::dictionary& parent)
{
    if (!parent.found("orientation")) return Eigen::Quaterniond::Identity();
    const Foam::dictionary& dict = subGroup(parent, "orientation");
    checkKeywords(dict, {"axis", "angleDeg"});
    const double angle = readNumber(dict, "angleDeg", {-360, 360})*M_PI/180;
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, readDirection(dict, "axis")));
}

Pose readPose(const Foam::dictionary& dict)
{
    return {readVec3Or(dict, "position", Vec3::Zero()), readOrientation(dict)};
}

PrincipalShape toPrincipalFrame(std::shared_ptr<const Shape> shape)
{
    const VolumeMoments moments = shape->moments();
    PrincipalShape result;
    result.volume = moments.volume;
    result.inUserFrame.position = moments.centroid;

    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d& inertia = moments.inertia;
    const Eigen::Matrix3d off = inertia - Eigen::Matrix3d(inertia.diagonal().asDiagonal());
    // unions of round parts have errors of 1e-5: of a log they would turn the two equal axes anywhere, and the box around it with them
    if (off.cwiseAbs().maxCoeff() > 3e-5*inertia.trace())
    {
        axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvectors();
        if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
    }
    result.inUserFrame.orientation = Eigen::Quaterniond(axes).normalized();
    result.inertia = (axes.transpose()*inertia*axes).diagonal();
    if (axes.isIdentity() && moments.centroid.norm() < 1e-14*std::cbrt(moments.volume))
    {
        result.shape = std::move(shape); // spares every distance a transformation
        return result;
    }
    const Eigen::Quaterniond back = result.inUserFrame.orientation.conjugate();
    result.shape = makePlaced(std::move(shape), back, -(back*moments.centroid));
    return result;
}

Pose compose(const Pose& outer, const Pose& inner)
{
    return {outer.position + outer.orientation*inner.position, (outer.orientation*inner.orientation).normalized()};
}

} // namespace flotsam
