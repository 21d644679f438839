// SPDX-License-Identifier: GPL-3.0-or-later
/// Slip patches that meet in a re-entrant edge, as on a box that is left out of the mesh: potential flow around it, a jet that leaves it, water at rest on it.
#include "support/errorTable.hpp"
#include "support/potentialFlow.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <complex>

using namespace flotsam;

namespace
{

/// Square or slab (-1, 1) x (0, 1) whose bottom is folded to a ridge at x = 0, between walls that fall off by 45 degrees: the fluid fills 270 degrees.
SimplexMesh ridgeMesh(int dim, int n)
{
    SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {2*n, n, 2}, {-1, 0, 0}, {1, 1, dim == 2 ? 1 : 2./n}, 0.1);
    for (int i = 0; i < mesh.nNodes; ++i) mesh.x[std::size_t(i)*dim + 1] -= std::abs(mesh.x[std::size_t(i)*dim]);
    mesh.computeGeometry();
    return mesh;
}

constexpr double dt = 1e-3;

/// A point as a complex number, turned so that the right wall is the real axis and the fluid fills arguments from 0 to 3 pi/2.
std::complex<double> turned(const double* x)
{
    const double angle = std::atan2(x[1], x[0]) + M_PI/4;
    return std::polar(std::hypot(x[0], x[1]), angle < 0 ? angle + 2*M_PI : angle);
}

/// zeta^power, cut where the solid is.
std::complex<double> power(const std::complex<double>& zeta, double exponent)
{
    const double angle = std::arg(zeta);
    return std::polar(std::pow(std::abs(zeta), exponent), exponent*(angle < -M_PI/4 ? angle + 2*M_PI : angle));
}

/// Potential flow around the ridge, phi = Re(3/2 zeta^(2/3)). Infinite at the ridge.
double potential(const double* x) { return 1.5*power(turned(x), 2./3).real(); }

std::array<double, 2> cornerFlow(const double* x)
{
    const std::complex<double> velocity = power(turned(x), -1./3)*std::polar(1.0, M_PI/4);  // u - iv
    return {velocity.real(), -velocity.imag()};
}

/// Slip patches; unless closed those above the ridge open, with the pressure that sets the fluid moving within one step.
std::vector<BoundaryPatch> patches(const SimplexMesh& mesh, bool isClosed)
{
    std::vector<BoundaryPatch> result = allPatches(mesh, BoundaryPatch::Velocity::Slip);
    if (isClosed) return result;
    for (int p : {0, 1, 3}) result[p] = drivenPatch(mesh, p, dt, potential);
    return result;
}

/// Nodal L2 error over the flow's own norm, without the ridge.
double cornerError(int dim, int n)
{
    const SimplexMesh mesh = ridgeMesh(dim, n);
    const Halo halo(mesh, MPI_COMM_WORLD);
    return planeFlowError(mesh, halo, afterOneStep(mesh, halo, oneFluid(1, 1e-8), patches(mesh, false), dt), cornerFlow,
        [](const double* x) { return std::hypot(x[0], x[1]) == 0; });
}

ErrorTable study(const char* title, int dim, const std::vector<int>& sizes)
{
    ErrorTable table(title, "h");
    for (int n : sizes) table.add(1./n, {{"u L2", cornerError(dim, n)}});
    table.print();
    return table;
}

double largestSpeedAtRest(int dim, int n)
{
    const SimplexMesh mesh = ridgeMesh(dim, n);
    const Halo halo(mesh, MPI_COMM_WORLD);
    FluidProperties properties = oneFluid(1, 1e-8);
    properties.gravity = {3, -8, dim == 3 ? 4. : 0.};
    return largestComponent(mesh, halo, afterOneStep(mesh, halo, properties, patches(mesh, true), dt));
}

/// Of the velocity at the ridge what goes into the wall that a stream came along, over its speed. The stream starts with that wall's direction everywhere
/// and passes ten elements.
double enteringShare(int dim, int n)
{
    usePetsc();
    const SimplexMesh mesh = ridgeMesh(dim, n);
    const Halo halo(mesh, MPI_COMM_WORLD);
    std::vector<BoundaryPatch> boundary = patches(mesh, true);
    for (int p : {0, 1, 3}) boundary[p] = makePatch(mesh, p, BoundaryPatch::Velocity::Open);
    NumericsControls controls;
    Fluid fluid(mesh, halo, oneFluid(1, 1e-8), controls, boundary);
    FlowState start = restState(mesh);
    for (int i = 0; i < mesh.nNodes; ++i)
        for (int d = 0; d < 2; ++d) start.u[std::size_t(i)*dim + d] = std::sqrt(0.5);
    fluid.start(std::move(start), true);
    for (int step = 0; step < 20; ++step)
    {
        fluid.beginStep(0.5/n);
        fluid.assemble();
        REQUIRE(fluid.solve({}).hasConverged);
        fluid.endStep();
    }
    double entering = 0;
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        const double *x = &mesh.x[std::size_t(i)*dim], *u = &fluid.state().u[std::size_t(i)*dim];
        if (std::hypot(x[0], x[1]) == 0) entering = std::max(entering, (u[0] - u[1])*std::sqrt(0.5)/std::hypot(u[0], u[1]));
    }
    return halo.max(entering);
}

/// A jet in air slides along the left wall and leaves it at the ridge: without gravity it goes straight on, and its pressure is that of the air.
struct Jet
{
    static constexpr double speed = 3, thickness = 0.3;    // [m/s], [m]

    double largestPressure = 0;     ///< size of a node's mean over the second half of the steps, over rho speed^2/2, near the ridge
    double leastSpeed = 1e300;      ///< at the ridge, mean over the same steps, over the jet's

    Jet(int dim, int n)
    {
        usePetsc();
        const SimplexMesh mesh = ridgeMesh(dim, n);
        const Halo halo(mesh, MPI_COMM_WORLD);
        FluidProperties properties;     // water and air
        properties.gravity = {0, 0, 0};
        std::vector<BoundaryPatch> boundary = patches(mesh, true);
        for (int p : {1, 3}) boundary[p] = makePatch(mesh, p, BoundaryPatch::Velocity::Open);
        boundary[0] = makePatch(mesh, 0, BoundaryPatch::Velocity::Fixed, [](const double* x, double) { return velocity(x); }, 1);
        boundary[0].phase = BoundaryPatch::Phase::Inflow;
        boundary[0].evaluate = [&mesh, nodes = boundary[0].nodes, base = boundary[0].evaluate](const BoundaryState& state, PatchValues& values)
        {
            base(state, values);
            for (std::size_t k = 0; k < nodes.size(); ++k) values.alpha[k] = content(&mesh.x[std::size_t(nodes[k])*mesh.dim], 0.01);
        };
        NumericsControls controls;
        Fluid fluid(mesh, halo, properties, controls, boundary);
        FlowState start = restState(mesh);
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            const double* x = &mesh.x[std::size_t(i)*dim];
            start.alpha[i] = content(x, 0.2/n);
            for (int d = 0; d < 2; ++d) start.u[std::size_t(i)*dim + d] = velocity(x)[d];
        }
        start.uOld = start.u;
        start.alphaOld = start.alphaOlder = start.alpha;
        fluid.start(std::move(start), false);
        run(fluid, mesh, halo, 0.4/(n*speed), 3*n);
    }

private:
    /// Depth below the jet's surfaces: from the wall and its continuation to `thickness` above them.
    static double depth(const double* x)
    {
        const double height = (x[1] - x[0])*std::sqrt(0.5), below = thickness - height;
        return x[0] < 0 ? below : std::min(height, below);
    }

    static double content(const double* x, double width) { return 1/(1 + std::exp(-depth(x)/width)); }

    static std::array<double, 3> velocity(const double* x)
    {
        const double u = depth(x) > -1e-9 ? speed*std::sqrt(0.5) : 0;
        return {u, u, 0};
    }

    void run(Fluid& fluid, const SimplexMesh& mesh, const Halo& halo, double dt, int steps)
    {
        const auto fromRidge = [&](int i) { return std::hypot(mesh.x[std::size_t(i)*mesh.dim], mesh.x[std::size_t(i)*mesh.dim + 1]); };
        std::vector<double> pressure(mesh.nOwned, 0.0), speeds(mesh.nOwned, 0.0);
        for (int step = 0; step < steps; ++step)
        {
            fluid.beginStep(dt);
            fluid.assemble();
            REQUIRE(fluid.solve({}).hasConverged);
            fluid.endStep();
            const double share = 1./(steps - steps/2);
            for (int i = 0; i < mesh.nOwned && step >= steps/2; ++i)
            {
                const double* u = &fluid.state().u[std::size_t(i)*mesh.dim];
                pressure[i] += share*fluid.state().p[i]/(500*speed*speed);
                speeds[i] += share*std::hypot(u[0], u[1])/speed;
            }
        }
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            if (fromRidge(i) < 0.4) largestPressure = std::max(largestPressure, std::abs(pressure[i]));
            if (fromRidge(i) == 0) leastSpeed = std::min(leastSpeed, speeds[i]);
        }
        largestPressure = halo.max(largestPressure);
        leastSpeed = halo.min(leastSpeed);
    }
};

} // namespace

TEST_CASE("a jet leaves the ridge straight on, at the pressure of the air")
{
    // one velocity of the ridge for all elements: 0.51 and 0.55; 0.49 and 0.35 of the speed
    for (const auto& [dim, n] : {std::pair(2, 20), std::pair(3, 10)})
    {
        const Jet jet(dim, n);
        MESSAGE(dim, "D: largest pressure ", jet.largestPressure, " rho speed^2/2, speed at the ridge ", jet.leastSpeed);
        CHECK(jet.largestPressure < 0.25);
        CHECK(jet.leastSpeed > 0.9);
    }
}

TEST_CASE("a stream leaves the ridge along the wall that it came along")
{
    // held by both walls alike: 0.45 and 0.60
    const double flat = enteringShare(2, 20), slab = enteringShare(3, 8);
    MESSAGE("into the wall: ", flat, " of the speed in 2D, ", slab, " in 3D");
    CHECK(flat < 0.22);
    CHECK(slab < 0.28);
}

TEST_CASE("fluid flows around the ridge")
{
    // the velocity is infinite at the ridge: order 2/3 at best
    const ErrorTable flat = study("Potential flow around a ridge", 2, {10, 20, 40});
    CHECK(flat.lastOrder("u L2") > 0.57);
    // held at the ridge: 0.030 and 0.066. The grad-div term pushes around it what starts from rest: with all of the time step in tau_cont
    // (tauContBulk 1, docs/numerics.md) 0.027 and 0.052, order 0.65; elements that see all of the ridge's velocity: 0.0282 and 0.0577
    CHECK(flat.value("u L2", 2) < 0.0278);
    CHECK(study("The same in 3D", 3, {8, 16}).value("u L2", 1) < 0.056);
}

TEST_CASE("fluid at rest stays at rest on the ridge")
{
    CHECK(largestSpeedAtRest(2, 10) < 1e-10);
    CHECK(largestSpeedAtRest(3, 6) < 1e-10);
}
