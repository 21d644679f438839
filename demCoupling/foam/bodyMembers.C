// SPDX-License-Identifier: GPL-3.0-or-later
/// Where the members of a group of bodies are: one place, an array, a list of poses, or drawn at random.
#include "demCoupling/foam/bodyGroup.H"
#include "demCoupling/foam/structureChecks.H"
#include "foam/dictionaryChecks.H"

#include "List.H"

#include <algorithm>
#include <cmath>
#include <map>

namespace flotsam
{

namespace
{

constexpr double largestCount = 1e6;    // members of a group: a slip of the pen must not take all of the memory

/// A pose of the user's frame -> of the body frame; 2D: moved to the mid-plane.
Pose bodyPose(const Pose& user, const BodyKind& kind, const SceneFrame& frame)
{
    Pose pose = compose(user, kind.prototype.pose); // the prototype's pose is that of the body frame in the user's
    if (!frame.isPlanar) return pose;
    const auto box = ShapeAtPose{"", kind.sampled, pose}.spaceBounds();
    pose.position[frame.planeAxis] += frame.midPlane - 0.5*(box[0] + box[1])[frame.planeAxis];
    return pose;
}

Vec3 sizeOf(const BodyKind& kind, const Pose& pose)
{
    const auto box = ShapeAtPose{"", kind.sampled, pose}.spaceBounds();
    return box[1] - box[0];
}

/// Ends messages about bodies for which there is no room; empty: they are not larger than the mesh along any axis.
std::string unitsAdvice(const Vec3& size, const Vec3& meshSize)
{
    if ((size.array() <= meshSize.array()).all()) return "";
    return text("\n    It is ", size[0], " m x ", size[1], " m x ", size[2], " m, the mesh ", meshSize[0], " m x ", meshSize[1], " m x ", meshSize[2],
        " m. Lengths are in m: an STL file in mm needs 'scale 0.001'.");
}

/// A 2D mesh computes per thickness: a body whose extent or section differs would have another mass than the water it displaces.
void checkPlanar(const Foam::dictionary& dict, const BodyKind& kind, const BodyDefinition& body, const SceneFrame& frame)
{
    if (!frame.isPlanar) return;
    const auto box = ShapeAtPose{"", kind.sampled, body.pose}.spaceBounds();
    const double extent = (box[1] - box[0])[frame.planeAxis];
    if (std::abs(extent - frame.thickness) > 1e-6*frame.thickness)
        failIn(dict, text("2D mesh: body ", body.name, " must reach through the mesh from front to back. Its extent along ", "xyz"[frame.planeAxis],
            " is ", extent, " m, the mesh's ", frame.thickness, " m.\n    Use a box or cylinder of that length along ", "xyz"[frame.planeAxis], extent > 100*frame.thickness ? ". Lengths are in m: an STL file in mm needs 'scale 0.001'." : "."));
    Solid solid;
    solid.shape = body.shape;
    solid.pose = body.pose;
    if (!isSameAcross(solid, frame)) // a ball as thick as the mesh
        failIn(dict, text("2D mesh: body ", body.name, " reaches through the mesh from front to back, but its section changes on the way: the flow would see another volume than that of its mass.\n    Use a box or cylinder along ",
            "xyz"[frame.planeAxis], ", or a union of these."));
}

/// Of a body that is not there at the start with what is fixed alone: whether its place is free is seen when it comes in.
std::optional<Conflict> conflictOf(const BodyKind& kind, const BodyDefinition& body, const Obstacles& obstacles, double minGap)
{
    return findConflict({body.name, kind.sampled, body.pose}, obstacles, minGap, !body.entersAtRelease);
}

void join(Obstacles& obstacles, const BodyKind& kind, const BodyDefinition& body)
{
    if (!body.entersAtRelease) obstacles.bodies.push_back({"body " + body.name, kind.sampled, body.pose});
}

/// dict: what says how it moves.
BodyDefinition member(const BodyKind& kind, const SceneFrame& frame, const std::string& suffix, const Pose& userPose, const Foam::dictionary& dict)
{
    BodyDefinition body = kind.prototype;
    body.name += suffix;
    body.pose = bodyPose(userPose, kind, frame);
    body.motion = {readVec3Or(dict, "velocity", Vec3::Zero()), readVec3Or(dict, "angularVelocity", Vec3::Zero())};
    body.releaseTime = readNumberOr(dict, "releaseTime", 0, notNegative);
    checkPlanar(dict, kind, body, frame);
    checkPlanarMotion(dict, "body " + body.name, body.motion, frame);
    return body;
}

Foam::List<Foam::dictionary> readPoses(const Foam::dictionary& group)
{
    const auto poses = readAs<Foam::List<Foam::dictionary>>(group, "poses",
        "a list of groups in round brackets, with ';' after every value: ( { position (x y z); } { .. } )");
    if (poses.empty()) failIn(group, "'poses' is empty: list at least one { position (..); }.");
    return poses;
}

void placeList(BodyGroup& group, const SceneFrame& frame)
{
    const auto poses = readPoses(*group.dict);
    forAll(poses, i)
    {
        Foam::dictionary dict(*group.dict); // what a pose does not give is the group's
        checkKeywords(poses[i], {"position", "orientation", "velocity", "angularVelocity", "releaseTime"});
        dict.merge(poses[i]);
        group.members.push_back(member(group.kindOf(i), frame, text(".", i), readPose(dict), dict));
    }
}

void placeArray(BodyGroup& group, const SceneFrame& frame)
{
    bool isArray = false;
    const Pose first = readPose(*group.dict);
    int i = 0;
    for (const Vec3& offset : readArray(*group.dict, isArray))
    {
        const Pose pose{first.position + offset, first.orientation};
        group.members.push_back(member(group.kindOf(i), frame, isArray ? text(".", i) : "", pose, *group.dict));
        ++i;
    }
}

struct RandomPlacement
{
    int count, tries;
    std::array<Vec3, 2> box;
    double minGap, from, interval;
    std::string orientation;
    std::uint64_t seed;
};

int readRandomCount(const Foam::dictionary& dict) { return readCount(dict, "count", {1, largestCount}); }

/// group: around it, whose releaseTime is that of the first body.
RandomPlacement readRandom(const Foam::dictionary& dict, const Foam::dictionary& group)
{
    checkKeywords(dict, {"count", "box", "seed", "minGap", "tries", "orientation", "release"});
    RandomPlacement r;
    r.count = readRandomCount(dict);
    r.tries = readCountOr(dict, "tries", 1000, {1, 1e7});
    r.seed = readCountOr(dict, "seed", 1, {0, 2147483647});
    r.minGap = readNumberOr(dict, "minGap", 0, notNegative);
    r.orientation = readWordOr(dict, "orientation", "fixed");
    const std::vector<std::string> known{"random", "uniformYaw", "fixed"};
    if (std::find(known.begin(), known.end(), r.orientation) == known.end()) failUnknown(dict, "orientation", r.orientation, known);
    const std::string what = "two corners: ((xmin ymin zmin) (xmax ymax zmax))";
    const auto corners = readAs<Foam::List<Foam::vector>>(dict, "box", what);
    if (corners.size() != 2) failValue(dict, "box", what);
    for (int d = 0; d < 3; ++d)
    {
        if (corners[0][d] > corners[1][d]) failIn(dict, "'box': the first corner must hold the smaller coordinates.");
        r.box[0][d] = corners[0][d];
        r.box[1][d] = corners[1][d];
    }
    r.from = readNumberOr(group, "releaseTime", 0, notNegative);
    r.interval = 0;
    if (!dict.found("release")) return r;
    const Foam::dictionary& release = subGroup(dict, "release");
    checkKeywords(release, {"from", "interval"});
    if (release.found("from") && group.found("releaseTime"))
        failIn(release, "Both 'releaseTime' of the group and 'from' of 'release' say when the first body is released: give one of them.");
    r.from = readNumberOr(release, "from", r.from, notNegative);
    r.interval = readNumberOr(release, "interval", 0, notNegative);
    return r;
}

Eigen::Quaterniond drawOrientation(const RandomPlacement& random, const Eigen::Quaterniond& base, const SceneFrame& frame, RandomNumbers& numbers)
{
    if (random.orientation == "fixed") return base;
    if (frame.isPlanar || random.orientation == "uniformYaw")
    {
        const Vec3 axis = frame.isPlanar ? Vec3(Vec3::Unit(frame.planeAxis)) : frame.up;
        return Eigen::Quaterniond(Eigen::AngleAxisd(2*M_PI*numbers.uniform(), axis))*base;
    }
    return numbers.rotation();
}

/// The draw that came nearest to fitting into the box.
struct TightestFit
{
    double excess = 1e300, extent = 0; ///< what the body is longer than the box along `axis`, negative: shorter; how long it is there [m]
    int axis = 0;
};

/// A pose whose body lies inside the box, centred anywhere it can be. False: the body, turned like this, is larger than the box.
bool drawPose(const BodyKind& kind, const RandomPlacement& random, const Eigen::Quaterniond& base, const SceneFrame& frame, RandomNumbers& numbers, Pose& pose, TightestFit& tightest)
{
    pose = compose({Vec3::Zero(), drawOrientation(random, base, frame, numbers)}, kind.prototype.pose);
    const auto box = ShapeAtPose{"", kind.sampled, pose}.spaceBounds();
    const Vec3 lower = random.box[0] - box[0], upper = random.box[1] - box[1];
    const auto isFree = [&](int d) { return frame.isPlanar && d == frame.planeAxis; };
    TightestFit fit{-1e300};
    for (int d = 0; d < 3; ++d)
        if (!isFree(d) && lower[d] - upper[d] > fit.excess) fit = {lower[d] - upper[d], box[1][d] - box[0][d], d};
    if (fit.excess < tightest.excess) tightest = fit;
    for (int d = 0; d < 3; ++d)
    {
        const double u = numbers.uniform();
        if (!isFree(d) && lower[d] - upper[d] > coordinateRoundOff(random.box)) return false;
        pose.position[d] += isFree(d) ? frame.midPlane - 0.5*(box[0] + box[1])[d] : lower[d] + u*(upper[d] - lower[d]);
    }
    return true;
}

/// What was in the way of most of some further tries: bodies may be too many, or the box lies in a structure or nearer to the bed than minGap.
std::string mostlyInTheWay(const BodyKind& kind, const RandomPlacement& random, const Eigen::Quaterniond& base, const SceneFrame& frame, const Obstacles& obstacles, RandomNumbers& numbers)
{
    constexpr int nTries = 200;
    std::map<std::string, int> counts;
    for (int k = 0; k < nTries; ++k)
    {
        Pose pose;
        TightestFit tightest;
        if (!drawPose(kind, random, base, frame, numbers, pose, tightest)) continue;
        const auto conflict = findConflict({kind.prototype.name, kind.sampled, pose}, obstacles, random.minGap, !kind.prototype.entersAtRelease);
        if (conflict) ++counts[conflict->with.rfind("body ", 0) == 0 ? "other bodies" : conflict->with];
    }
    if (counts.empty()) return "";
    const auto most = std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    return text("\n    Of ", nTries, " more tries ", most->second, " lay in ", most->first, random.minGap > 0 ? text(" or nearer than minGap, ", random.minGap, " m, to it") : "", '.');
}

[[noreturn]] void failToPlace(const BodyGroup& group, const RandomPlacement& random, int nPlaced, const TightestFit& tightest, const std::string& inTheWay, const Foam::dictionary& dict)
{
    if (tightest.excess > coordinateRoundOff(random.box))
        failIn(dict, text("Bodies '", group.name, "' do not fit into 'box', which must hold the whole of them: it is ", tightest.extent - tightest.excess,
            " m long along ", "xyz"[tightest.axis], ", a body ", random.orientation == "fixed" ? "" : "in the best of all orientations that were tried ", tightest.extent,
            " m.\n    Enlarge 'box'", random.orientation == "fixed" ? ", or turn the bodies ('orientation')." : ", or allow more 'tries'."));
    failIn(dict, text("Only ", nPlaced, " of ", random.count, " bodies '", group.name, "' found a place within ", random.tries,
        " tries.\n    Enlarge 'box', lower 'count' or 'minGap', or allow more 'tries'.", inTheWay));
}

void placeRandomly(BodyGroup& group, const SceneFrame& frame, Obstacles& obstacles)
{
    const Foam::dictionary& dict = subGroup(*group.dict, "random");
    if (group.dict->found("position"))
        failIn(*group.dict, "With 'random' the bodies have their places in its 'box', and 'position' does nothing: remove it.");
    const RandomPlacement random = readRandom(dict, *group.dict);
    RandomNumbers numbers(random.seed);
    const Eigen::Quaterniond base = readOrientation(*group.dict);
    for (int i = 0; i < random.count; ++i)
    {
        const BodyKind& kind = group.kindOf(i);
        BodyDefinition body = member(kind, frame, text(".", i), {}, *group.dict);
        bool isPlaced = false;
        TightestFit tightest;
        for (int k = 0; k < random.tries && !isPlaced; ++k)
            isPlaced = drawPose(kind, random, base, frame, numbers, body.pose, tightest)
                && isPlaceFree({body.name, kind.sampled, body.pose}, obstacles, random.minGap, !body.entersAtRelease);
        if (!isPlaced) failToPlace(group, random, i, tightest, mostlyInTheWay(kind, random, base, frame, obstacles, numbers), dict);
        body.releaseTime = random.from + i*random.interval;
        join(obstacles, kind, body);
        group.members.push_back(std::move(body));
    }
}

} // namespace

std::vector<Vec3> readArray(const Foam::dictionary& dict, bool& isArray)
{
    isArray = dict.found("array");
    if (!isArray) return {Vec3::Zero()};
    const Foam::dictionary& array = subGroup(dict, "array");
    checkKeywords(array, {"count", "spacing"});
    const Vec3 count = readVec3(array, "count"), spacing = readVec3(array, "spacing");
    for (int d = 0; d < 3; ++d)
        if (count[d] < 1 || count[d] != std::floor(count[d]))
            failIn(array, text("Entry 'count' has ", count[d], " along ", "xyz"[d], ": whole numbers, at least 1, for instance (1 7 1)."));
    if (count.prod() > largestCount) failIn(array, text("Entry 'count' makes ", count.prod(), " members: at most ", largestCount, " are possible."));
    std::vector<Vec3> offsets;
    for (int k = 0; k < count[2]; ++k)
        for (int j = 0; j < count[1]; ++j)
            for (int i = 0; i < count[0]; ++i) offsets.push_back(spacing.cwiseProduct(Vec3(i, j, k)));
    return offsets;
}

int memberCount(const Foam::dictionary& dict)
{
    bool isArray = false;
    if (dict.found("random")) return readRandomCount(subGroup(dict, "random"));
    return dict.found("poses") ? readPoses(dict).size() : static_cast<int>(readArray(dict, isArray).size());
}

bool isRandom(const BodyGroup& group) { return group.dict->found("random"); }

void placeMembers(BodyGroup& group, const SceneFrame& frame, Obstacles& obstacles)
{
    if (isRandom(group)) placeRandomly(group, frame, obstacles);
    else if (group.dict->found("poses")) placeList(group, frame);
    else placeArray(group, frame);
}

void checkMembers(const BodyGroup& group, Obstacles& obstacles)
{
    // bodies may touch, resting on each other or on a wall: a thousandth of the thickness is allowed
    for (std::size_t i = 0; i < group.members.size(); ++i)
    {
        const BodyKind& kind = group.kindOf(i);
        const BodyDefinition& body = group.members[i];
        if (const auto conflict = conflictOf(kind, body, obstacles, -1e-3*body.thinnest))
            failIn(*group.dict, text("Body ", body.name, " reaches ", 1000*conflict->overlap, " mm into ", conflict->with,
                " at the start.\n    Its centre is at (", body.pose.position[0], ' ', body.pose.position[1], ' ', body.pose.position[2], "). Move it, or let 'random' find places.", unitsAdvice(sizeOf(kind, body.pose), obstacles.box[1] - obstacles.box[0])));
        join(obstacles, kind, body);
    }
}

} // namespace flotsam
