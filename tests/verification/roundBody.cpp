// SPDX-License-Identifier: GPL-3.0-or-later
/// Round bodies at the surface of water at rest do not start to turn about their axes, however coarse the mesh: pressure has no moment about them.
#include "support/floatingBodies.hpp"

#include <algorithm>
#include <cstdio>

using namespace flotsam;

namespace
{

constexpr int nPlaces = 6;

/// Largest angular acceleration about the axes of symmetry in the first step, of what the weight at the arm of a radius gives. Half immersed, density half of water's.
double spinUp(int dim, std::shared_ptr<const Shape> shape, double radius)
{
    Solid solid;
    solid.shape = shape;
    FloatingBodies body(dim, shape, 500, radius);
    double largest = 0;
    for (int k = 0; k < nPlaces; ++k)
    {
        const Vec3 position = Vec3(0.5, 0.5, 0.5) + (haltonPoint(k) - Vec3::Constant(0.5))/FloatingBodies::n;
        const Vec3 spin = solid.turning()*body.release(position, position[dim - 1]).angularVelocity;
        largest = std::max(largest, spin.norm()*body.inertia()/(body.mass()*FloatingBodies::gravity*radius));
    }
    std::printf("%dD, %.1f elements a diameter: %.1e\n", dim, 2*radius*FloatingBodies::n, largest);
    return largest;
}

/// A log with a root wad, of two overlapping cylinders, about its centre of mass.
std::shared_ptr<const Shape> rootWad(double radius)
{
    const Vec3 end(-0.25, 0, 0);
    const auto shape = makeUnion({makeCylinder(end, Vec3(0.25, 0, 0), radius), makeCylinder(end, Vec3(-0.15, 0, 0), 1.5*radius)});
    return makePlaced(shape, Eigen::Quaterniond::Identity(), -shape->moments().centroid);
}

} // namespace

TEST_CASE("round bodies that float do not set themselves spinning")
{
    for (const double radius : {0.06, 0.075, 0.1, 0.15})    // with the moment of the pressure 0.08 to 0.15, 0.04 to 0.13, 0.03 to 0.06, 0.015 to 0.02
    {
        CHECK(spinUp(2, makeCylinder(Vec3(0, 0, -0.5), Vec3(0, 0, 0.5), radius), radius) < 5e-3);
        CHECK(spinUp(3, makeCylinder(Vec3(-0.3, 0, 0), Vec3(0.3, 0, 0), radius), radius) < 5e-3);
        CHECK(spinUp(3, makeCapsule(Vec3(0, -0.2, 0), Vec3(0, 0.2, 0), radius), radius) < 5e-3);
        CHECK(spinUp(3, makeSphere(Vec3::Zero(), radius), radius) < 5e-3);
        CHECK(spinUp(3, rootWad(radius), radius) < 5e-3);
    }
}

TEST_CASE("rotations that turn a solid into itself")
{
    Solid log;
    log.shape = makePlaced(makeCylinder(Vec3(1, 0, 0), Vec3(1, 0, 2), 0.1), Eigen::Quaterniond(Eigen::AngleAxisd(M_PI/2, Vec3::UnitX())), Vec3(-1, 1, 0));
    log.pose.orientation = Eigen::AngleAxisd(0.3, Vec3::UnitZ());
    const Vec3 axis(std::sin(0.3), -std::cos(0.3), 0);
    CHECK((log.turning() - axis*axis.transpose()).norm() < 1e-12);
    log.shape = makeCylinder(Vec3(0.1, 0, 0), Vec3(0.1, 0, 2), 0.1);     // not about the origin
    CHECK(log.turning().norm() == 0);
    log.shape = makeSphere(Vec3::Zero(), 0.1);
    CHECK((log.turning() - Eigen::Matrix3d::Identity()).norm() == 0);
    log.shape = makeBox(Vec3::Zero(), Vec3(1, 1, 1));
    CHECK(log.turning().norm() == 0);
    const auto sphereAt = [](double x) { return makeSphere(Vec3(x, 0, 0), 0.1); };
    const auto alongX = makeCylinder(Vec3(-1, 0, 0), Vec3(1, 0, 0), 0.1);
    log.pose.orientation = Eigen::Quaterniond::Identity();
    const Eigen::Matrix3d aboutX = Vec3::UnitX()*Vec3::UnitX().transpose();
    log.shape = makeUnion({sphereAt(-0.2), sphereAt(0.3)});
    CHECK((log.turning() - aboutX).norm() < 1e-12);
    log.shape = makeUnion({sphereAt(0.9), alongX, makeCylinder(Vec3(1, 0, 0), Vec3(0.8, 0, 0), 0.3)});
    CHECK((log.turning() - aboutX).norm() < 1e-12);
    log.shape = makeUnion({alongX, makeCylinder(Vec3(0, -1, 0), Vec3(0, 1, 0), 0.1)});  // a cross
    CHECK(log.turning().norm() == 0);
    log.shape = makeUnion({alongX, makeSphere(Vec3(0, 0.05, 0), 0.1)});
    CHECK(log.turning().norm() == 0);
}
