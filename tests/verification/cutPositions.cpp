// SPDX-License-Identifier: GPL-3.0-or-later
/// 200 positions of the walls relative to the mesh, 25 in 3D: neither errors nor condition numbers spike at any of them.
#include "support/cutFlows.hpp"
#include "support/flowCases.hpp"
#include "support/near.hpp"
#include "support/systemMatrix.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace flotsam;

namespace
{

constexpr int nPositions = 200, nPositions3D = 25;

/// Median and largest of a sweep.
struct Spread
{
    double median = 0, largest = 0;

    explicit Spread(std::vector<double> values)
    {
        std::sort(values.begin(), values.end());
        median = values[values.size()/2];
        largest = values.back();
    }
    void print(const char* name) const { std::printf("| %s | %.3e | %.3e | %.2f |\n", name, median, largest, largest/median); }
};

void printHeader(const char* title) { std::printf("\n%s\n| | median | largest | ratio |\n|---|---|---|---|\n", title); }

NumericsControls steadyControls()
{
    NumericsControls controls;
    controls.timeOrder = 1;
    controls.tolerance = 1e-7;
    controls.restart = 150;
    controls.maxIterations = 1000;
    return controls;
}

/// Position k: the walls' centre anywhere in one cell in the middle of the mesh.
Vec3 centreAt(int k, int n) { return Vec3(0.5, 0.5, 0.5) + (haltonPoint(k) - Vec3::Constant(0.5))/n; }

/// Errors over positions.
struct PositionErrors
{
    std::vector<double> velocity, gradient, pressure, nodal;

    /// Those of the steady flow around `solids`.
    void add(ForcedFlow& flow, CoverBuilder& builder, const std::vector<Solid>& solids, double largestChange)
    {
        flow.setGeometry(builder.build(solids), solids);
        REQUIRE(flow.toSteadyState(1e3, largestChange, 40) < 40);
        const FlowErrors e = flow.errors();
        velocity.push_back(e.velocity);
        gradient.push_back(e.gradient);
        pressure.push_back(e.pressure);
        nodal.push_back(e.largest);
    }

    void print() const
    {
        Spread(velocity).print("u L2");
        Spread(gradient).print("u H1");
        Spread(pressure).print("p L2");
        Spread(nodal).print("largest nodal velocity error");
    }

    /// Largest over median.
    void check(double most, double mostOfNodal) const
    {
        for (const auto* values : {&velocity, &gradient, &pressure}) CHECK(Spread(*values).largest < most*Spread(*values).median);
        CHECK(Spread(nodal).largest < mostOfNodal*Spread(nodal).median); // a maximum norm
    }
};

} // namespace

TEST_CASE("errors of the Couette flow between cut cylinders")
{
    usePetsc();
    const int n = 20;
    const double rho = 1, mu = 0.05;
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {n, n, 1}, {0, 0, 0}, {1, 1, 1}, 0.1);
    const Halo halo(mesh, MPI_COMM_WORLD);
    PositionErrors errors;
    std::vector<double> torque;
    for (int k = 0; k < nPositions; ++k)
    {
        AnnularCouette annulus;
        annulus.innerRadius = 0.2;
        annulus.outerRadius = 0.42;
        annulus.centre = centreAt(k, n);
        ForcedFlow flow(mesh, halo, oneFluid(rho, mu), steadyControls(), annulus.flow(rho));
        const std::vector<Solid> solids = annulus.solids();
        CoverBuilder builder(mesh, flow.graph(), halo);
        errors.add(flow, builder, solids, 1e-5);
        const double exact = annulus.torque(mu);
        torque.push_back(std::max(std::abs(flow.load(0)[2]/exact - 1), std::abs(flow.load(1)[2]/exact + 1)));
    }
    printHeader("Couette between cut cylinders, n = 20, 200 positions");
    errors.print();
    Spread(torque).print("torque");
    errors.check(2, 3);
    CHECK(Spread(torque).largest < 2*Spread(torque).median);
}

TEST_CASE("errors of the flow around a sphere")
{
    usePetsc();
    const int n = 10;
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 3, {n, n, n}, {0, 0, 0}, {1, 1, 1}, 0.1);
    const Halo halo(mesh, MPI_COMM_WORLD);
    PositionErrors errors;
    for (int k = 0; k < nPositions3D; ++k)
    {
        FlowAroundBody body;
        body.dim = 3;
        body.centre = centreAt(k, n);
        ForcedFlow flow(mesh, halo, oneFluid(1, 0.05), steadyControls(), body.flow());
        const std::vector<Solid> solids = body.solids();
        CoverBuilder builder(mesh, flow.graph(), halo);
        errors.add(flow, builder, solids, 1e-4);
    }
    printHeader("Sphere, n = 10, 25 positions");
    errors.print();
    errors.check(1.5, 2);
}

namespace
{

/// Condition numbers with a disc or sphere in positions 0 to `positions`.
Spread conditions(int dim, int n, int positions, double mu, double dt, bool hasGhosts)
{
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {0, 0, 0}, {1, 1, 1}, 0.1);
    const Halo halo(mesh, MPI_COMM_WORLD);
    NumericsControls controls = steadyControls();
    controls.maxIterations = 1; // only the matrix is wanted
    if (!hasGhosts) controls.ghostVelocity = controls.ghostConvection = controls.ghostPressure = 0;
    std::vector<double> values;
    for (int k = 0; k < positions; ++k)
    {
        FlowAroundBody body;
        body.dim = dim;
        body.centre = centreAt(k, n);
        const std::vector<Solid> solids = body.solids();
        ForcedFlow flow(mesh, halo, oneFluid(1, mu), controls, body.flow());
        CoverBuilder builder(mesh, flow.graph(), halo);
        flow.setGeometry(builder.build(solids), solids);
        flow.step(dt);
        values.push_back(conditionNumber(mesh, flow.system(), systemMatrix(mesh, flow.graph(), flow.system())));
    }
    return Spread(values);
}

} // namespace

TEST_CASE("condition number of the scaled system")
{
    usePetsc();
    struct Setting { const char* name; double mu, dt; bool hasGhosts; };
    const Setting settings[] = {{"viscous, steady", 1, 1e3, true}, {"mu 1e-3, dt 0.01 s", 1e-3, 0.01, true},
        {"viscous, without ghost penalty", 1, 1e3, false}};
    for (int dim : {2, 3})
    {
        printHeader(dim == 2 ? "Disc, n = 16: condition number" : "Sphere, n = 8: condition number");
        for (const Setting& setting : settings)
        {
            const int all = dim == 2 ? nPositions : nPositions3D, positions = setting.hasGhosts ? all : all/4;
            const Spread spread = conditions(dim, dim == 2 ? 16 : 8, positions, setting.mu, setting.dt, setting.hasGhosts);
            spread.print(setting.name);
            if (setting.hasGhosts) CHECK(spread.largest < 2*spread.median);
        }
    }
}

TEST_CASE("the constant pressure is the only null vector of a closed box, from both sides")
{
    usePetsc();
    const int n = 8;
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {n, n, 1}, {0, 0, 0}, {1, 1, 1}, 0.1);
    const Halo halo(mesh, MPI_COMM_WORLD);
    FluidProperties fluid;
    fluid.rhoLiquid = 1;
    fluid.muLiquid = 1e-2;
    const FlowAroundBody body;
    const std::vector<Solid> solids = body.solids();
    for (bool isCut : {false, true})
    {
        ForcedFlow flow(mesh, halo, fluid, steadyControls(), body.flow());
        CoverBuilder builder(mesh, flow.graph(), halo);
        if (isCut) flow.setGeometry(builder.build(solids), solids);
        flow.step(0.1);
        const SystemMatrix m = systemMatrix(mesh, flow.graph(), flow.system());
        const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(m.matrix));
        const Eigen::VectorXd& s = svd.singularValues();
        CHECK(s[s.size() - 1] < 1e-14*s[0]);
        CHECK(s[s.size() - 2] > 1e-3*s[0]);
        CHECK(conditionNumber(mesh, flow.system(), m) == near(s[0]/s[s.size() - 2], 0.03));
        Eigen::VectorXd constant = Eigen::VectorXd::Zero(s.size());
        for (int i = 0; i < mesh.nNodes; ++i)
            if (const int k = m.unknown[3*i + 2]; k >= 0) constant[k] = 1/m.scale[k];
        CHECK((m.matrix*constant).norm() < 1e-13*constant.norm());
        CHECK((m.matrix.transpose()*constant).norm() < 1e-13*constant.norm());
    }
}
