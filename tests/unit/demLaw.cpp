// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/contactLaw.hpp"
#include "support/near.hpp"
#include "unit/demSupport.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;
using namespace demTest;

TEST_CASE("restitution without attraction agrees with integrating the contact")
{
    for (const double beta : {0.05, 0.3, 0.73123, 0.99, 1.0, 1.3, 3.0})
    {
        double x = 0, v = 1;
        const double dt = 1e-5;
        while (true)
        {
            const double a = -x - 2 * beta * v;
            if (a > 0)
                break; // the force would pull: it is cut, and the speed stays
            const double xm = x + 0.5 * dt * v, vm = v + 0.5 * dt * a;
            x += dt * vm;
            v += dt * (-xm - 2 * beta * vm);
        }
        CHECK(restitutionOf(beta) == near(-v, 1e-9));
    }
    for (const double e : {0.01, 0.1, 0.2, 0.5, 0.9, 1.0})
        CHECK(restitutionOf(dampingRatioFor(e)) == near(e, 1e-14));
    CHECK(dampingRatioFor(0.2) == near(0.731247, 1e-6));
}

TEST_CASE("spheres of the flattest face")
{
    CHECK(flattestFaceCount(debris(Vec3::Zero())) == 40);
    CHECK(flattestFaceCount(ball(0.1, 1, Vec3::Zero())) == 1);
    BodyDefinition flat = debris(Vec3::Zero());
    flat.isPlanar = true;
    flat.planeAxis = 1;
    CHECK(flattestFaceCount(flat) == 40);
    for (SurfaceSphere& s : flat.spheres)
        s.centre.y() = 0; // all spheres in the plane of motion: they never land on it together
    CHECK(flattestFaceCount(flat) == 40);
}

TEST_CASE("classes: one per material, mass and face; shared when there are very many")
{
    DemSetup setup = scene({ball(0.01, 0.1, Vec3::Zero()), ball(0.02, 0.1, Vec3::Zero()), ball(0.01, 0.3, Vec3::Zero())},
                           {plane(Vec3::Zero(), Vec3::UnitZ())});
    const ContactTable table = makeContactTable(setup);
    CHECK(table.classOfBody == std::vector<int> {0, 0, 1});
    CHECK(table.classOfWall == std::vector<int> {2});
    const double c = 2 * dampingRatioFor(0.2) * std::sqrt(1e6);
    CHECK(table.damping[1] == near(c * std::sqrt(0.1 * 0.3 / 0.4), 1e-14));
    CHECK(table.damping[2] == near(c * std::sqrt(0.1), 1e-14));
    setup.bodies.clear();
    for (int i = 0; i < 200; ++i)
        setup.bodies.push_back(ball(0.01, 0.1 * (1 + 0.01 * i), Vec3::Zero()));
    CHECK(makeContactTable(setup).size() <= 33);
    setup.bodies[7].material = 3;
    CHECK_THROWS_AS(makeContactTable(setup), DemError);
}

TEST_CASE("bars of many sizes share classes: stiffness within a factor, damping ratios no larger and not much smaller")
{
    DemSetup setup = scene({}, {plane(Vec3::Zero(), Vec3::UnitZ())});
    std::vector<ContactTable> own;
    for (int i = 0; i < 120; ++i)
    {
        const double length = 0.1 + 0.3 * (0.618034 * i - std::floor(0.618034 * i)), width = 0.015 + 0.02 * (0.7548777 * i - std::floor(0.7548777 * i));
        BodyDefinition body = debris(Vec3::Zero());
        const auto box = makeBox(Vec3::Zero(), {length, width, width});
        body.shape = box;
        body.mass = 600 * length * width * width;
        body.thinnest = width;
        body.spheres = surfaceSpheres(*box, 0.25 * width, 0.5 * width, 0.125 * width);
        body.corners = cornerSpheres(*box, width / 16);
        setup.bodies.push_back(body);
        own.push_back(makeContactTable(scene({body}, {plane(Vec3::Zero(), Vec3::UnitZ())})));
    }
    const ContactTable table = makeContactTable(setup);
    CHECK(table.size() <= 65);
    CHECK(table.size() > 24);
    const auto atWall = [](const ContactTable& t, const std::vector<double>& values, int a) { return values[static_cast<size_t>(a * t.size() + t.classOfWall[0])]; };
    for (size_t b = 0; b < own.size(); ++b)
        for (const bool isCorner : {false, true})
        {
            const int shared = isCorner ? table.classOfCorners[b] : table.classOfBody[b], alone = isCorner ? own[b].classOfCorners[0] : own[b].classOfBody[0];
            const double stiffer = atWall(table, table.stiffness, shared) / atWall(own[b], own[b].stiffness, alone);
            CHECK(std::abs(std::log(stiffer)) < std::log(1.8));
            // damping ratio of one sphere
            const double damped = atWall(table, table.damping, shared) / atWall(own[b], own[b].damping, alone) / std::sqrt(stiffer);
            CHECK(damped <= 1 + 1e-6);
            CHECK(damped > 0.8);
        }
}

TEST_CASE("corners: as stiff as their radius is smaller, damped for the same restitution; flat landings count them in")
{
    BodyDefinition body = debris(Vec3::Zero());
    const double r = 0.25 * body.spheres.front().radius;
    body.corners = cornerSpheres(*makeBox(Vec3::Zero(), {0.2, 0.02, 0.02}), r);
    for (const bool isFlat : {false, true})
    {
        ContactLaw law;
        law.flatRestitution = isFlat;
        const ContactTable table = makeContactTable(scene({body}, {plane(Vec3::Zero(), Vec3::UnitZ())}, law));
        const int n = table.size(), own = table.classOfBody[0], corner = table.classOfCorners[0], wall = table.classOfWall[0];
        REQUIRE(n == 3);
        REQUIRE(corner != own);
        const auto of = [&](const std::vector<double>& values, int a) { return values[static_cast<size_t>(a * n + wall)]; };
        const double k = of(table.stiffness, own), kCorner = of(table.stiffness, corner), c = of(table.damping, own), cCorner = of(table.damping, corner);
        CHECK(k == near(law.stiffness / 40, 1e-14));
        CHECK(kCorner == near(4 * k, 1e-6));
        const double ratio = dampingRatioFor(law.restitution);
        const double together = isFlat ? (40 * c + 4 * cCorner) / std::sqrt((40 * k + 4 * kCorner) * body.mass) : cCorner / std::sqrt(kCorner * body.mass);
        CHECK(together == near(2 * ratio, 1e-6));
        if (isFlat)
            CHECK(cCorner / kCorner == near(c / k, 1e-6));
        else
            CHECK(c == near(2 * ratio * std::sqrt(k * body.mass), 1e-12));
    }
}

TEST_CASE("dashpots of many spheres: at most the velocity there is, and never much less")
{
    for (const double z : {0.01, 0.5, 1.0})
        CHECK(DampingLevel::of(z) == 0);
    for (const double z : {1.01, 1.7, 3.0, 12.0})
    {
        const double taken = z * DampingLevel::share(DampingLevel::of(z));
        CHECK(taken <= 1 + 1e-8);
        CHECK(taken > 0.84);
    }
    DemSetup setup = scene({debris(Vec3::Zero())}, {plane(Vec3::Zero(), Vec3::UnitZ())});
    ContactTable table = makeContactTable(setup);
    const double step = contactTimeStep(setup, table);
    CHECK(dampingLevels(setup, table, 0.01 * step) == 1);
    table.levels = dampingLevels(setup, table, step);
    CHECK(table.levels > 8);
    const int bar = table.typeOf(table.classOfBody[0], 4), wall = table.typeOf(table.classOfWall[0], 0);
    CHECK(table.dampingOf(bar, wall) == near(0.5 * table.damping[table.entryOf(bar, wall)], 1e-14));
    CHECK(table.dampingOf(wall, bar) == table.dampingOf(bar, wall));
}
