// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies on surfaces with triangles too thin for the contact engine, divided: as on the same surfaces without such.
#include "geometry/thinTriangles.hpp"
#include "support/near.hpp"
#include "support/prism.hpp"
#include "unit/demSupport.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace flotsam;
using namespace demTest;

namespace
{

constexpr double half = 0.4, strip = 8e-5; // of a plate [m]; 1e4 times as long as wide

WallDefinition divided(TriSurface surface)
{
    WallDefinition wall;
    wall.name = "plate";
    wall.kind = WallDefinition::Kind::Surface;
    wall.surface = divideThinTriangles(surface, 200000).surface;
    return wall;
}

/// A plate with its upper side at z = 0, of strips across x: every other one thin.
TriSurface stripPlate()
{
    std::vector<Vec3> outline{{-half, -half, 0}};
    for (int i = -3; i <= 3; ++i)
    {
        outline.emplace_back(0.1*i - 0.5*strip, -half, 0);
        outline.emplace_back(0.1*i + 0.5*strip, -half, 0);
    }
    outline.insert(outline.end(), {{half, -half, 0}, {half, -half, -0.1}, {-half, -half, -0.1}});
    std::rotate(outline.begin(), outline.end() - 1, outline.end()); // the fans of the lower corner have needles, too
    return prism(outline, Vec3(0, 2*half, 0));
}

/// The same plate, in its upper side a point beside its diagonal: a cap, the angles at its long edge both too small.
TriSurface capPlate()
{
    TriSurface s;
    for (const double z : {-0.1, 0.0})
        for (const Vec3& x : {Vec3(-half, -half, z), Vec3(half, -half, z), Vec3(half, half, z), Vec3(-half, half, z)}) s.points.push_back(x);
    s.points.emplace_back(strip, -strip, 0);
    s.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 8}, {5, 6, 8}, {4, 8, 6}, {4, 6, 7}};
    for (int i = 0; i < 4; ++i)
    {
        const int j = (i + 1) % 4;
        s.triangles.push_back({i, j, 4 + j});
        s.triangles.push_back({i, 4 + j, 4 + i});
    }
    return s;
}

struct Ride
{
    std::vector<BodyState> states;
    double carried = 0;     // at rest
    bool isRestored = false;
};

/// A bar and a ball land, slide and roll across the plate, and come to rest (the bar).
Ride ride(const WallDefinition& plate)
{
    BodyDefinition sliding = debris(Vec3(-0.25, -0.1, 0.0101)), rolling = ball(0.02, 0.02, Vec3(-0.35, 0.15, 0.0201));
    sliding.motion.velocity = Vec3(0.8, 0.13, 0);
    rolling.motion.velocity = Vec3(0.5, -0.11, 0);
    DemSetup setup = scene({sliding, rolling}, {plate});
    LiggghtsEngine engine(setup);
    engine.setLoads(weights(setup));
    Ride r;
    for (int i = 0; i < 60; ++i)
    {
        if (i % 10 == 5)
        {
            const DemState before = engine.save();
            engine.advance(1e-2);
            const Vec3 once = engine.states()[0].pose.position;
            engine.restore(before);
            engine.advance(1e-2);
            r.isRestored = engine.states()[0].pose.position == once && (i == 5 || r.isRestored);
        }
        else engine.advance(1e-2);
        for (const BodyState& s : engine.states()) r.states.push_back(s);
    }
    r.carried = -engine.meanWallLoads()[0].force.z();
    return r;
}

} // namespace

TEST_CASE("bodies that slide and roll over needles and caps of a plate go as on one without, to rest on it")
{
    const Ride plain = ride(block(Vec3(-half, -half, -0.1), Vec3(half, half, 0)));
    CHECK(plain.states[0].motion.velocity.norm() > 0.5);
    CHECK(plain.states[plain.states.size() - 2].motion.velocity.norm() < 1e-4);
    for (const TriSurface& surface : {stripPlate(), capPlate()})
    {
        int thin = 0;
        for (const auto& t : surface.triangles) thin += ThinTriangle(surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]).isRefused;
        CHECK(thin > 0);
        const Ride needles = ride(divided(surface));
        CHECK(needles.isRestored);
        CHECK(needles.carried == near(plain.carried, 1e-6));
        double apart = 0, faster = 0;
        for (std::size_t i = 0; i < plain.states.size(); ++i)
        {
            apart = std::max(apart, (needles.states[i].pose.position - plain.states[i].pose.position).norm());
            faster = std::max(faster, (needles.states[i].motion.velocity - plain.states[i].motion.velocity).norm());
        }
        CHECK(apart < 1e-9);
        CHECK(faster < 1e-9);
    }
}

TEST_CASE("surfaces with needles of all kinds are accepted, of 2 cm as of 300 m, and those of fans")
{
    Random random(5);
    int thin = 0;
    const auto isAccepted = [&](const TriSurface& surface)
    {
        const DividedSurface d = divideThinTriangles(surface, 200000);
        thin += int(d.divided);
        DemSetup setup = scene({ball(0.01, 0.05, Vec3(0, 0, 5))}, {block(Vec3(-1, -1, -1), Vec3(1, 1, 0))});
        setup.walls[0].surface = d.surface;
        setup.box = {Vec3(-500, -500, -500), Vec3(500, 500, 500)};
        try
        {
            LiggghtsEngine engine(setup);
        }
        catch (const DemError& e)
        {
            MESSAGE(e.what());
            return false;
        }
        return true;
    };
    for (const double scale : {0.006, 1.0, 100.0})
        for (int i = 0; i < 15; ++i)
        {
            CAPTURE(scale);
            CAPTURE(i);
            TriSurface s = collapsed(prism(circle(7, 1), Vec3(0.1, 0.2, 3)), random);
            for (Vec3& x : s.points) x *= scale;
            CHECK(isAccepted(s));
        }
    CHECK(thin > 80);
    std::vector<Vec3> sector{Vec3::Zero()};
    for (int i = 0; i <= 200; ++i) sector.emplace_back(0.5*std::cos(5e-4*i), 0.5*std::sin(5e-4*i), 0);
    CHECK(isAccepted(prism(sector, Vec3(0, 0, 0.1))));
}
