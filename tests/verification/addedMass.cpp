// SPDX-License-Identifier: GPL-3.0-or-later
/// Added mass of a cylinder, a square bar, a sphere and a cube against theory: a force acts on a free body of the fluid's density in
/// fluid at rest, one step; its acceleration gives the added mass. The box is so wide that its walls matter by less than 0.5 %.
#include "equations/fluid.hpp"
#include "geometry/coverBuilder.hpp"
#include "support/errorTable.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

/// Coefficients over the displaced mass. Cylinder, sphere: exact. Square: 2 pi c^2 - 1, c = Gamma(1/4)^2/(4 pi^1.5). Cube: panel method,
/// extrapolated.
constexpr double ofCylinder = 1, ofSquare = 1.18844, ofSphere = 0.5, ofCube = 0.6384;

/// Cells of nearly equal size around the centre, growing outwards: x = halfWidth sinh(a s)/sinh(a), s in [-1, 1].
SimplexMesh stretchedMesh(int dim, int n, double halfWidth, double a)
{
    SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {-1, -1, -1}, {1, 1, 1}, 0.05);
    for (double& x : mesh.x) x = halfWidth*std::sinh(a*x)/std::sinh(a);
    if (dim == 2) mesh.thickness = 1;
    mesh.computeGeometry();
    return mesh;
}

struct Case
{
    int dim;
    std::shared_ptr<const Shape> shape; ///< of size 1 along the motion
    double volume;                      ///< area in 2D
    double exact, halfWidth, stretching;
    double angle = 0;                   ///< of the body about z [rad]
};

/// Added mass over displaced mass; sizeOverH: elements over the body's size.
double addedMass(const Case& c, int n, double& sizeOverH)
{
    usePetsc();
    const SimplexMesh mesh = stretchedMesh(c.dim, n, c.halfWidth, c.stretching);
    const Halo halo(mesh, MPI_COMM_WORLD);
    sizeOverH = std::sinh(c.stretching)*n/(2*c.halfWidth*c.stretching);
    FluidProperties properties;
    properties.isTwoPhase = false;
    properties.rhoLiquid = 1;
    properties.muLiquid = 1e-6;
    NumericsControls controls;
    controls.tolerance = 1e-6;
    Fluid fluid(mesh, halo, properties, controls, allPatches(mesh, BoundaryPatch::Velocity::Slip));
    fluid.start(restState(mesh), true);
    std::vector<Solid> solids(1);
    solids[0].kind = Solid::Kind::Free;
    solids[0].shape = c.shape;
    solids[0].pose.position = Vec3(0.013, 0.021, c.dim == 3 ? -0.008 : 0);
    solids[0].pose.orientation = Eigen::AngleAxisd(c.angle, Vec3::UnitZ());
    CoverBuilder builder(mesh, fluid.graph(), halo);
    for (int k = 0; k < 4; ++k) builder.buildExactVolume(solids);
    fluid.setGeometry(&builder.cover(), &solids, true);
    FreeBody body;
    body.mass = c.volume;
    body.inertia = Eigen::Matrix3d::Identity()*body.mass/6;
    body.force = Vec3(1, 0, 0);
    const double dt = 0.005;
    fluid.beginStep(dt);
    fluid.assemble();
    REQUIRE(fluid.solve({body}).hasConverged);
    const double acceleration = fluid.solidMotions()[0].velocity[0]/dt;
    return (1/acceleration - body.mass)/c.volume;
}

/// Relative error on the finest of the meshes; prints all.
ErrorTable study(const char* title, const Case& c, const std::vector<int>& sizes)
{
    ErrorTable table(title, "h/size");
    for (int n : sizes)
    {
        double resolution = 0;
        const double value = addedMass(c, n, resolution);
        table.add(1/resolution, {{"|error|", std::abs(value/c.exact - 1)}, {"coefficient", value}});
    }
    table.print();
    return table;
}

double lastError(const ErrorTable& table, int rows) { return table.value("|error|", rows - 1); }

} // namespace

TEST_CASE("cylinder")
{
    const Case c{2, makeCylinder(Vec3(0, 0, -0.5), Vec3(0, 0, 0.5), 0.5), M_PI/4, ofCylinder, 10, 4, 0};
    const ErrorTable table = study("Cylinder", c, {24, 48, 96});
    CHECK(table.value("|error|", 0) < 0.01);
    CHECK(lastError(table, 3) < 0.01);
}
TEST_CASE("square bar along a side and along the diagonal")
{
    Case c{2, makeBox(Vec3::Zero(), Vec3::Ones()), 1, ofSquare, 10, 4, 0};
    CHECK(lastError(study("Square bar", c, {24, 48, 96}), 3) < 0.01);
    c.angle = M_PI/4; // the same in every direction
    CHECK(lastError(study("Square bar turned by 45 degrees", c, {24, 48, 96}), 3) < 0.01);
}
TEST_CASE("sphere")
{
    const Case c{3, makeSphere(Vec3::Zero(), 0.5), M_PI/6, ofSphere, 3, 3, 0};
    const ErrorTable table = study("Sphere", c, {10, 20, 40});
    CHECK(table.value("|error|", 0) < 0.07); // six elements
    CHECK(lastError(table, 3) < 0.01);
}
TEST_CASE("cube")
{
    const Case c{3, makeBox(Vec3::Zero(), Vec3::Ones()), 1, ofCube, 3, 3, 0};
    const ErrorTable table = study("Cube", c, {10, 20, 40}); // edges: first order
    CHECK(table.value("|error|", 0) < 0.1);  // 0.22 with all of the ghost penalties on every cut
    CHECK(lastError(table, 3) < 0.045);
}
