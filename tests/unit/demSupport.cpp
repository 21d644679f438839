// SPDX-License-Identifier: GPL-3.0-or-later
#include "unit/demSupport.hpp"

#include <cmath>

namespace demTest
{

namespace
{

std::vector<double> stations(double length, double diameter, double pitch)
{
    const double span = length - diameter;
    const int n = span < 1e-12 ? 1 : static_cast<int>(std::ceil(span / pitch - 1e-9)) + 1;
    std::vector<double> result;
    for (int i = 0; i < n; ++i)
        result.push_back(n == 1 ? 0 : -span / 2 + span * i / (n - 1));
    return result;
}

} // namespace

BodyDefinition bar(const Vec3& size, double diameter, double pitch, const Vec3& position)
{
    BodyDefinition body;
    body.name = "bar";
    body.volume = size.prod();
    body.mass = 590 * body.volume;
    const Vec3 s2 = size.cwiseAbs2();
    body.principalInertia = body.mass / 12 * Vec3(s2.y() + s2.z(), s2.x() + s2.z(), s2.x() + s2.y());
    const auto x = stations(size.x(), diameter, pitch), y = stations(size.y(), diameter, pitch),
               z = stations(size.z(), diameter, pitch);
    const auto isEnd = [](size_t i, const std::vector<double>& v) { return i == 0 || i + 1 == v.size(); };
    for (size_t i = 0; i < x.size(); ++i)
        for (size_t j = 0; j < y.size(); ++j)
            for (size_t k = 0; k < z.size(); ++k)
                if (isEnd(i, x) || isEnd(j, y) || isEnd(k, z))
                    body.spheres.push_back({Vec3(x[i], y[j], z[k]), diameter / 2});
    body.pose.position = position;
    return body;
}

BodyDefinition debris(const Vec3& position) { return bar(Vec3(0.2, 0.02, 0.02), 0.01, 0.01, position); }

BodyDefinition ball(double radius, double mass, const Vec3& position)
{
    BodyDefinition body;
    body.name = "ball";
    body.mass = mass;
    body.volume = 4.0 / 3 * M_PI * radius * radius * radius;
    body.principalInertia.setConstant(0.4 * mass * radius * radius);
    body.spheres = {{Vec3::Zero(), radius}};
    body.pose.position = position;
    return body;
}

WallDefinition plane(const Vec3& point, const Vec3& normal)
{
    WallDefinition wall;
    wall.name = "plane";
    wall.point = point;
    wall.normal = normal;
    return wall;
}

WallDefinition block(const Vec3& lower, const Vec3& upper)
{
    WallDefinition wall;
    wall.name = "block";
    wall.kind = WallDefinition::Kind::Surface;
    for (int i = 0; i < 8; ++i)
        wall.surface.points.push_back(Vec3(i & 1 ? upper.x() : lower.x(), i & 2 ? upper.y() : lower.y(),
                                           i & 4 ? upper.z() : lower.z()));
    wall.surface.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                              {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return wall;
}

WallDefinition pipe(const Vec3& foot, double radius, double height, int sides)
{
    WallDefinition wall;
    wall.name = "pipe";
    wall.kind = WallDefinition::Kind::Surface;
    TriSurface& s = wall.surface;
    for (int i = 0; i < sides; ++i)
    {
        const double a = 2 * M_PI * i / sides;
        const Vec3 p = foot + radius * Vec3(std::cos(a), std::sin(a), 0);
        s.points.push_back(p);
        s.points.push_back(p + height * Vec3::UnitZ());
    }
    s.points.push_back(foot);
    s.points.push_back(foot + height * Vec3::UnitZ());
    for (int i = 0; i < sides; ++i)
    {
        const int a = 2 * i, b = 2 * ((i + 1) % sides);
        s.triangles.push_back({a, b, b + 1});
        s.triangles.push_back({a, b + 1, a + 1});
        s.triangles.push_back({2 * sides, b, a});
        s.triangles.push_back({2 * sides + 1, a + 1, b + 1});
    }
    return wall;
}

DemSetup scene(std::vector<BodyDefinition> bodies, std::vector<WallDefinition> walls, const flotsam::ContactLaw& law)
{
    DemSetup setup;
    setup.bodies = std::move(bodies);
    setup.walls = std::move(walls);
    setup.laws = {law};
    setup.box = {Vec3::Constant(-0.5), Vec3::Constant(0.5)};
    return setup;
}

std::vector<Load> weights(const DemSetup& setup)
{
    std::vector<Load> loads;
    for (const BodyDefinition& body : setup.bodies)
        loads.push_back({Vec3(0, 0, -body.mass * gravity), Vec3::Zero()});
    return loads;
}

DemSetup heap(int count, bool hasMeshes)
{
    std::vector<BodyDefinition> bodies;
    for (int i = 0; i < count; ++i)
    {
        BodyDefinition body = debris(Vec3(0.01 * (i % 3 - 1), 0.05 * (i / 2 % 3 - 1), 0.05 + 0.03 * i));
        body.pose.orientation = Eigen::AngleAxisd(0.1 * i, Vec3::UnitZ());
        body.motion.velocity = Vec3(0.3 * std::sin(i), 0.3 * std::cos(i), -0.5);
        body.motion.angularVelocity = Vec3(0.1 * i, 0.2, 0);
        body.name += std::to_string(i);
        bodies.push_back(body);
    }
    std::vector<WallDefinition> walls;
    if (hasMeshes)
        walls = {block(Vec3(-0.3, -0.3, -0.1), Vec3(0.3, 0.3, 0)), plane(Vec3(-0.2, 0, 0), Vec3::UnitX()),
                 block(Vec3(0.2, -0.3, -0.1), Vec3(0.3, 0.3, 0.6)), pipe(Vec3(0, 0.1, 0), 0.0109, 0.4, 24),
                 pipe(Vec3(0, -0.1, 0), 0.0109, 0.4, 24)};
    else
        walls = {plane(Vec3::Zero(), Vec3::UnitZ()), plane(Vec3(-0.2, 0, 0), Vec3::UnitX()),
                 plane(Vec3(0.2, 0, 0), -Vec3::UnitX()), plane(Vec3(0, -0.2, 0), Vec3::UnitY()),
                 plane(Vec3(0, 0.2, 0), -Vec3::UnitY())};
    flotsam::ContactLaw law;
    law.flatRestitution = true; // larger sub-steps: quicker tests
    return scene(std::move(bodies), std::move(walls), law);
}

DemSetup pile()
{
    std::vector<BodyDefinition> bodies;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 5; ++row)
        {
            BodyDefinition body = debris(Vec3(-0.0212 - 0.0205 * column, 0.004 * ((row + column) % 3 - 1), 0.0105 + 0.0205 * row));
            body.pose.orientation = Eigen::AngleAxisd(M_PI / 2 + 0.01 * (row - 2), Vec3::UnitZ());
            body.name += std::to_string(bodies.size());
            bodies.push_back(body);
        }
    std::vector<WallDefinition> walls = {plane(Vec3::Zero(), Vec3::UnitZ()), plane(Vec3(0, -0.14, 0), Vec3::UnitY()),
                                         plane(Vec3(0, 0.14, 0), -Vec3::UnitY())};
    for (int i = -3; i <= 3; ++i)
        walls.push_back(pipe(Vec3(0, 0.04 * i, -0.01), 0.01085, 0.28, 32));
    return scene(std::move(bodies), std::move(walls));
}

std::vector<Load> pressing(const DemSetup& setup)
{
    std::vector<Load> loads = weights(setup);
    for (Load& load : loads)
        load.force = Vec3(0.2, 0, 0.1 * load.force.z());
    return loads;
}

} // namespace demTest
