// SPDX-License-Identifier: GPL-3.0-or-later
/// Iterations of a solve do not grow as bodies close the gaps between them, down to a thousandth of an element: stacks of free plates across the surface of
/// moving water, at any place and angle; the gaps of every second stack are wedges.
#include "equations/fluid.hpp"
#include "geometry/coverBuilder.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

using namespace flotsam;

namespace
{

constexpr double gravity = 9.81, density = 500, speed = 1;
constexpr int unsolved = 1000;

/// Number from -1 to 1.
using Random = std::mt19937;
double signedUnit(Random& random) { return 2.0*random()/Random::max() - 1; }

/// Water and gas in the unit square or cube, open at the top.
struct Tank
{
    const int dim;
    const double h;
    SimplexMesh mesh;
    Halo halo{mesh, MPI_COMM_WORLD};
    FluidProperties fluid;
    NumericsControls controls;
    std::vector<BoundaryPatch> patches;

    Tank(int dim, int n) : dim(dim), h(1.0/n), mesh(makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {0, 0, 0}, {1, 1, 1}))
    {
        fluid.gravity[dim - 1] = -gravity;
        const int top = 2*dim - 1;
        for (int p = 0; p < 2*dim; ++p) patches.push_back(makePatch(mesh, p, p == top ? BoundaryPatch::Velocity::Open : BoundaryPatch::Velocity::Slip));
    }

    /// A vortex, and below a slanted plane through the middle water.
    FlowState start(Random& random) const
    {
        FlowState state = restState(mesh);
        const double level = 0.5 + 0.1*signedUnit(random), slope = 0.3*signedUnit(random);
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            const double* x = &mesh.x[std::size_t(i)*dim];
            state.u[std::size_t(i)*dim] = speed*std::sin(M_PI*x[0])*std::cos(M_PI*x[1]);
            state.u[std::size_t(i)*dim + 1] = -speed*std::cos(M_PI*x[0])*std::sin(M_PI*x[1]);
            state.alpha[i] = x[dim - 1] < level + slope*(x[0] - 0.5);
        }
        state.uOld = state.u;
        return state;
    }
};

struct Stack
{
    int plates;
    double thickness, length;
    double wedge;               // angle between neighbours [rad]

    Vec3 size(int dim) const { return Vec3(length, thickness, dim == 2 ? 1 : length); }

    /// gap: least distance between neighbours.
    std::vector<Solid> solids(int dim, double gap, Random& random) const
    {
        const Vec3 centre = Vec3(0.5, 0.5, 0.5) + 0.1*Vec3(signedUnit(random), signedUnit(random), dim == 2 ? 0 : signedUnit(random));
        const Vec3 axis = dim == 2 ? Vec3(0, 0, 1) : Vec3(signedUnit(random), signedUnit(random), signedUnit(random)).normalized();
        const Eigen::Quaterniond turn(Eigen::AngleAxisd(M_PI*signedUnit(random), axis));
        const double turnedThickness = thickness*std::cos(wedge) + length*std::sin(wedge);
        const double pitch = 0.5*(thickness + turnedThickness) + gap;
        std::vector<Solid> solids(plates);
        for (int k = 0; k < plates; ++k)
        {
            Solid& s = solids[k];
            s.kind = Solid::Kind::Free;
            s.shape = makeBox(Vec3::Zero(), size(dim));
            s.pose.position = centre + turn*Vec3(0, (k - 0.5*(plates - 1))*pitch, 0);
            s.pose.orientation = turn*Eigen::Quaterniond(Eigen::AngleAxisd(k % 2 ? wedge : 0, Vec3(0, 0, 1)));
            s.motion.velocity = speed*Vec3(signedUnit(random), signedUnit(random), dim == 2 ? 0 : signedUnit(random));
        }
        return solids;
    }

    FreeBody body(int dim, const Solid& solid) const
    {
        const Vec3 square = size(dim).cwiseAbs2();
        const Eigen::Matrix3d R = solid.pose.orientation.toRotationMatrix();
        FreeBody body;
        body.mass = density*size(dim).prod();
        body.inertia = R*(body.mass/12*(Vec3::Constant(square.sum()) - square)).asDiagonal()*R.transpose();
        body.velocity = solid.motion.velocity;
        body.force[dim - 1] = -gravity*body.mass;
        return body;
    }
};

int iterations(const Tank& tank, const Stack& stack, double gap, unsigned seed)
{
    Random random(seed);
    Fluid fluid(tank.mesh, tank.halo, tank.fluid, tank.controls, tank.patches);
    fluid.start(tank.start(random), true);
    const std::vector<Solid> solids = stack.solids(tank.dim, gap, random);
    std::vector<FreeBody> bodies;
    for (const Solid& s : solids) bodies.push_back(stack.body(tank.dim, s));
    CoverBuilder builder(tank.mesh, fluid.graph(), tank.halo);
    fluid.setGeometry(&builder.build(solids), &solids, true);
    fluid.beginStep(0.5*tank.h/speed);
    fluid.assemble();
    const SolveReport report = fluid.solve(bodies);
    return report.hasConverged ? report.iterations : unsolved;
}

/// Largest number of iterations over the stacks.
int mostIterations(const Tank& tank, Stack stack, double elements, int nStacks)
{
    int most = 0, sum = 0;
    const double wedge = stack.wedge;
    for (int k = 0; k < nStacks; ++k)
    {
        stack.wedge = k % 2 ? wedge : 0;
        const int n = iterations(tank, stack, elements*tank.h, k);
        most = std::max(most, n);
        sum += n;
    }
    std::printf("%dD gap %-5g of an element: %5.1f iterations, at most %d\n", tank.dim, elements, double(sum)/nStacks, most);
    return most;
}

void checkStacks(const Tank& tank, const Stack& stack, int nStacks)
{
    const int wide = mostIterations(tank, stack, 2, nStacks);
    for (const double gap : {1., 0.3, 0.1, 0.03, 0.01, 0.003, 0.001}) CHECK(mostIterations(tank, stack, gap, nStacks) < 1.6*wide);
}

} // namespace

TEST_CASE("iterations do not grow as plates close the gaps between them")
{
    usePetsc();
    checkStacks(Tank(2, 32), {5, 0.08, 0.5, 0.05}, 40);
    checkStacks(Tank(3, 16), {4, 0.1, 0.6, 0.03}, 10);
}
