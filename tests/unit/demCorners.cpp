// SPDX-License-Identifier: GPL-3.0-or-later
/// Small spheres in the corners of boxes: what they touch, and about what boxes tip.
#include "support/near.hpp"
#include "unit/demSupport.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;
using namespace demTest;

namespace
{

constexpr double degree = M_PI / 180;
constexpr double cornerRadius = 0.00625;    // of a box of 0.1 m thickness

/// 590 kg/m3, as constant/bodies makes it.
BodyDefinition box(const Vec3& size, bool isPlanar)
{
    const double radius = 0.25 * size.minCoeff();
    BodyDefinition body = bar(size, 2 * radius, 2 * radius, Vec3(0, 0, 0.5 * size.z()));
    const auto shape = makeBox(Vec3::Zero(), size);
    body.isPlanar = isPlanar;
    body.planeAxis = 1;
    body.spheres = isPlanar ? sectionSpheres(*shape, Vec3::Zero(), Vec3::UnitY(), radius, 2 * radius, radius) : surfaceSpheres(*shape, radius, 2 * radius);
    body.corners = isPlanar ? sectionCorners(*shape, Vec3::Zero(), Vec3::UnitY(), cornerRadius) : cornerSpheres(*shape, cornerRadius);
    return body;
}

/// On a floor that is tilted about y by an angle [degrees].
bool tips(const BodyDefinition& body, const WallDefinition& floor, double angle)
{
    ContactLaw law;
    law.frictionAngleDeg = 80;
    law.stiffness = 1e6;
    LiggghtsEngine engine(scene({body}, {floor}, law));
    engine.setLoads({{body.mass * gravity * Vec3(std::sin(angle * degree), 0, -std::cos(angle * degree)), Vec3::Zero()}});
    for (int i = 0; i < 20; ++i)
    {
        engine.advance(0.05);
        if (engine.states()[0].pose.orientation.angularDistance(Eigen::Quaterniond::Identity()) > 0.3)
            return true;
    }
    return false;
}

/// At which a box tips whose length is shorter by the diameter of the spheres at its edges [degrees].
double tippingAngle(const Vec3& size, double radius) { return std::atan((size.x() - 2 * radius) / size.z()) / degree; }

/// A cube whose corner points down.
BodyDefinition onCorner()
{
    BodyDefinition body = box(Vec3::Constant(0.1), false);
    body.pose.orientation = Eigen::Quaterniond::FromTwoVectors(Vec3::Ones(), -Vec3::UnitZ());
    body.pose.position.z() = 0.05 * std::sqrt(3.0);
    return body;
}

double heightOfCorner(const BodyDefinition& body, const Pose& pose)
{
    double lowest = 1;
    for (const SurfaceSphere& s : body.corners)
        lowest = std::min(lowest, (pose.position + pose.orientation * s.centre).z());
    return lowest;
}

const WallDefinition floorPlane = plane(Vec3::Zero(), Vec3::UnitZ());
const WallDefinition floorMesh = block(Vec3(-1, -1, -0.3), Vec3(1, 1, 0));

} // namespace

TEST_CASE("boxes tip about the spheres in their corners, on planes and meshes, in 3D and 2D")
{
    for (const bool isPlanar : {false, true})
        for (const Vec3& size : {Vec3(0.1, 0.1, 0.1), Vec3(0.2, 0.1, 0.1), Vec3(0.1, 0.1, 0.2)})
        {
            CAPTURE(isPlanar);
            CAPTURE(size);
            BodyDefinition body = box(size, isPlanar);
            const double angle = tippingAngle(size, cornerRadius);
            CHECK_FALSE(tips(body, floorPlane, angle - 0.8));
            CHECK(tips(body, floorPlane, angle + 0.4));
            CHECK_FALSE(tips(body, floorMesh, angle - 0.8));
            body.corners.clear();
            CHECK(tips(body, floorPlane, angle - 0.8));
        }
}

TEST_CASE("corners do not touch other bodies")
{
    const auto collide = [](bool hasCorners)
    {
        std::vector<BodyDefinition> cubes {onCorner(), onCorner()};
        cubes[1].pose.orientation = Eigen::Quaterniond::FromTwoVectors(Vec3::Ones(), Vec3::UnitZ());
        cubes[1].pose.position = cubes[0].pose.position - Vec3(0.004, 0.002, 0.2);
        cubes[1].motion.velocity.z() = 1;
        if (!hasCorners)
            for (BodyDefinition& cube : cubes)
                cube.corners.clear();
        LiggghtsEngine engine(scene(cubes, {}));
        engine.advance(0.1);
        return engine.states()[0];
    };
    const BodyState with = collide(true), without = collide(false);
    CHECK(without.motion.velocity.z() > 0.1);
    CHECK((with.motion.velocity - without.motion.velocity).norm() < 1e-12);
    CHECK((with.motion.angularVelocity - without.motion.angularVelocity).norm() < 1e-11);
}

TEST_CASE("a corner that is pressed through a wall retreats, gives back no work, and returns; states hold that")
{
    constexpr double load = 300;    // [N]
    for (const WallDefinition& floor : {floorPlane, floorMesh})
    {
        BodyDefinition body = onCorner();
        body.motion.velocity.z() = -8;  // pressed by half of what a sphere bears, it stops beyond the corner
        ContactLaw law;
        law.stiffness = 1e5;
        LiggghtsEngine engine(scene({body}, {floor}, law));
        engine.setLoads({{Vec3(0, 0, -load), Vec3::Zero()}});
        for (int i = 0; i < 40; ++i)
            engine.advance(0.002);
        CHECK(heightOfCorner(body, engine.states()[0].pose) < 0);
        double centre = 1;  // of the lowest sphere that is no corner: it bears the load
        for (const SurfaceSphere& s : body.spheres)
            centre = std::min(centre, (engine.states()[0].pose.position + engine.states()[0].pose.orientation * s.centre).z());
        CHECK(0.025 - centre == near(load / (law.stiffness / 4), 0.01));

        const DemState state = engine.save();
        const auto release = [&](LiggghtsEngine& from)
        {
            from.setLoads({{Vec3::Zero(), Vec3::Zero()}});
            from.advance(0.02);
            return from.states()[0];
        };
        const BodyState free = release(engine);
        // what the main sphere's spring held, less its dashpot
        CHECK(free.motion.velocity.z() > 0);
        CHECK(free.motion.velocity.z() < load / std::sqrt(law.stiffness / 4 * body.mass));
        LiggghtsEngine other(scene({body}, {floor}, law));
        other.restore(state);
        CHECK(release(other).motion.velocity == free.motion.velocity);

        // back above the floor it lands on that corner again
        BodyState back = free;
        back.pose = body.pose;
        back.motion = {Vec3(0, 0, -0.1), Vec3::Zero()};
        back.angularMomentum.setZero();
        engine.setStates({back});
        for (int i = 0; i < 8; ++i)
            engine.advance(0.01);
        CHECK(engine.states()[0].motion.velocity.z() > 0);
        CHECK(heightOfCorner(body, engine.states()[0].pose) > 0.9 * cornerRadius);
    }
}
