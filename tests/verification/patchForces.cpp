// SPDX-License-Identifier: GPL-3.0-or-later
/// Forces on patches: weight and pressure of water at rest, friction of a shear flow, action and reaction where walls meet in edges.
#include "equations/interfaceWidth.hpp"
#include "equations/surfaceLevel.hpp"
#include "geometry/coverBuilder.hpp"
#include "geometry/primitives.hpp"
#include "support/budgets.hpp"
#include "support/flowCases.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace flotsam;

namespace
{

using Velocity = BoundaryPatch::Velocity;

constexpr double g = 9.81;

std::vector<int> allOf(const std::vector<BoundaryPatch>& patches)
{
    std::vector<int> all;
    for (int p = 0; p < int(patches.size()); ++p) all.push_back(p);
    return all;
}

Vec3 forceOn(const PatchForce& f) { return f.pressure + f.friction; }

Vec3 sumOf(const Fluid& fluid)
{
    Vec3 sum = Vec3::Zero();
    for (const PatchForce& f : fluid.patchForces()) sum += forceOn(f);
    return sum;
}

/// mayStall: solves that begin at a steady flow cannot reduce their residual any more.
void advance(Fluid& fluid, double dt, int steps, bool mayStall = false)
{
    for (int k = 0; k < steps; ++k)
    {
        fluid.beginStep(dt);
        fluid.assemble();
        const bool hasConverged = fluid.solve({}).hasConverged;
        REQUIRE((hasConverged || mayStall));
        fluid.endStep();
    }
}

bool isRoot()
{
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank == 0;
}

/// Walls of every patch; no-slip ones held on their faces.
std::vector<BoundaryPatch> walls(const SimplexMesh& mesh, Velocity kind)
{
    std::vector<BoundaryPatch> patches = allPatches(mesh, kind);
    for (BoundaryPatch& p : patches) p.isNoSlipWall = kind != Velocity::Slip;
    return patches;
}

/// Water, half a tank of 0.2 x 0.05 x 0.2 m, 2D in the plane of x and y; gravity off the mesh's axis by degrees.
struct Tank
{
    int dim;
    double c, s, level;
    SimplexMesh mesh;
    Halo halo;
    NumericsControls controls;
    FluidProperties properties;
    std::vector<BoundaryPatch> patches;
    std::unique_ptr<Fluid> fluid;

    Tank(int dim_, int n, double degrees, Velocity kind)
    :   dim(dim_), c(std::cos(degrees*M_PI/180)), s(std::sin(degrees*M_PI/180)), level(0.1 + 0.37*0.2/n),
        mesh(dim == 2 ? makeBoxMesh(MPI_COMM_WORLD, 2, {n, n, 1}, {0, 0, 0}, {0.2, 0.2, 0.05}, 0.19)
                      : makeBoxMesh(MPI_COMM_WORLD, 3, {n, n/2, n}, {0, 0, 0}, {0.2, 0.05, 0.2}, 0.19)),
        halo(mesh, MPI_COMM_WORLD), patches(walls(mesh, kind))
    {
        usePetsc();
        controls.tolerance = 1e-9;
        properties.gravity[dim - 1] = -g*c;
        properties.gravity[0] = -g*s;
        fluid = std::make_unique<Fluid>(mesh, halo, properties, controls, patches);
        fluid->watchPatches(allOf(patches));
        start();
    }

    void start()
    {
        FlowState state = restState(mesh);
        const DualCells cells(mesh);
        double normal[3] = {-s};
        normal[dim - 1] = -c;
        const std::vector<double> width = interfaceWidth(mesh, fluid->graph(), halo, controls.interfaceWidth);
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            const double* x = &mesh.x[std::size_t(i)*dim];
            state.alpha[i] = profileSlab(&cells, i, normal, c*(level - x[dim - 1]) + s*(0.1 - x[0]), width[i]).mean();
        }
        halo.update(state.alpha, 1);
        state.alphaOld = state.alphaOlder = state.alpha;
        fluid->start(state, false);
    }

    Vec3 weight() const { return fluidBudget(*fluid, properties, controls, nullptr).weight; }
    const PatchForce& on(const char* name) const
    {
        for (std::size_t p = 0; p < patches.size(); ++p) if (patches[p].name == name) return fluid->patchForces()[p];
        throw std::runtime_error(name);
    }
};

/// (-1, 1) x (0, 1), its bottom folded to a ridge, as in slipEdge.
SimplexMesh ridgeMesh(int dim, int n)
{
    SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {2*n, n, 2}, {-1, 0, 0}, {1, 1, 0.5}, 0.1);
    for (int i = 0; i < mesh.nNodes; ++i) mesh.x[std::size_t(i)*dim + 1] -= std::abs(mesh.x[std::size_t(i)*dim]);
    mesh.computeGeometry();
    return mesh;
}

} // namespace

TEST_CASE("a tank at rest: the bottom carries the water, a side rho g h^2/2 a metre, all walls together the weight")
{
    for (const int dim : {2, 3})
        for (const Velocity kind : {Velocity::Slip, Velocity::NoSlip})
            for (const double degrees : {0., 30.})
            {
                Tank tank(dim, dim == 2 ? 20 : 10, degrees, kind);
                advance(*tank.fluid, 2e-3, 3);
                const Vec3 all = sumOf(*tank.fluid), weight = tank.weight();
                const double ofWater = 1000*g*0.2*0.05*tank.level, side = 0.5*1000*g*tank.level*tank.level*0.05;
                const char *bottom = dim == 2 ? "yMin" : "zMin";
                if (isRoot())
                    std::printf("%dD, %s, %g degrees: sum %.2e off the weight; bottom %.2e, side %.2e off\n", dim, kind == Velocity::Slip ? "slip" : "no-slip", degrees,
                        (all - weight).norm()/weight.norm(), -forceOn(tank.on(bottom))[dim - 1]/ofWater - 1, forceOn(tank.on("xMax"))[0]/side - 1);
                CHECK((all - weight).norm() < 1e-3*weight.norm());  // measured 6e-4: what balanced gravity makes of the surface's elements
                for (const PatchForce& f : tank.fluid->patchForces()) CHECK(f.friction.norm() < 1e-6*weight.norm());
                if (degrees > 0) continue;
                CHECK(-forceOn(tank.on(bottom))[dim - 1] == near(ofWater, 2e-3));
                CHECK(forceOn(tank.on("xMax"))[0] == near(side, 5e-3));
                CHECK(forceOn(tank.on("xMin"))[0] == near(-side, 5e-3));
                // acts a third of the depth over the bottom; 2D: about the axis across the mesh, whose mid-plane is anywhere
                const double arm = tank.on("xMax").pressureMoment[dim == 2 ? 2 : 1]/forceOn(tank.on("xMax"))[0];
                CHECK(std::abs(arm) == near(tank.level/3, 1e-2));
            }
}

TEST_CASE("a pile through bed and surface of a tank at rest: walls and pile together have the weight of what is left, the bed that of the water beside the pile")
{
    for (const int dim : {2, 3})
        for (const Velocity kind : {Velocity::Slip, Velocity::NoSlip})
        {
            Tank tank(dim, dim == 2 ? 20 : 12, 0, kind);
            std::vector<Solid> solids(1);   // 2D: a wall that stands on the bed
            solids[0].shape = dim == 2 ? makeBox(Vec3(0.103, 0.1, 0.025), Vec3(0.033, 0.5, 0.2)) : makeCylinder(Vec3(0.103, 0.026, -1), Vec3(0.103, 0.026, 1), 0.0162);
            CoverBuilder builder(tank.mesh, tank.fluid->graph(), tank.halo);
            const Cover& cover = builder.build(solids);
            tank.fluid->setGeometry(&cover, &solids, true);
            advance(*tank.fluid, 2e-3, 3);
            const Vec3 pile = tank.fluid->solidLoads()[0].force, all = sumOf(*tank.fluid), weight = fluidBudget(*tank.fluid, tank.properties, tank.controls, &cover).weight;
            const double size = weight.norm(), beside = -1000*g*tank.level*(0.2*0.05 - (dim == 2 ? 0.033*0.05 : M_PI*0.0162*0.0162));
            if (isRoot()) std::printf("%dD, %s, with a pile: sum %.1e off the weight, bed %.1e off the water's, pile %.1e of it\n", dim, kind == Velocity::Slip ? "slip" : "no-slip",
                (all + pile - weight).norm()/size, forceOn(tank.on(dim == 2 ? "yMin" : "zMin"))[dim - 1]/beside - 1, pile.norm()/size);
            CHECK((all + pile - weight).norm() < 2e-3*size);
            CHECK(forceOn(tank.on(dim == 2 ? "yMin" : "zMin"))[dim - 1] == near(beside, 2e-2)); // 3D: the cut pile of two elements is a polygon
        }
}

TEST_CASE("water at rest over a re-entrant edge: all walls together have its weight, to round-off")
{
    usePetsc();
    for (const int dim : {2, 3})
        for (const Velocity kind : {Velocity::Slip, Velocity::NoSlip})
        {
            const SimplexMesh mesh = ridgeMesh(dim, 6);
            const Halo halo(mesh, MPI_COMM_WORLD);
            FluidProperties properties = oneFluid(1000, 1e-3);
            properties.gravity = {3, -8, dim == 3 ? 4. : 0.};
            NumericsControls controls;
            controls.tolerance = 1e-10;
            const std::vector<BoundaryPatch> patches = walls(mesh, kind);
            Fluid fluid(mesh, halo, properties, controls, patches);
            fluid.watchPatches(allOf(patches));
            fluid.start(restState(mesh), false);
            advance(fluid, 1e-2, 3);
            const Vec3 weight = fluidBudget(fluid, properties, controls, nullptr).weight;
            CHECK((sumOf(fluid) - weight).norm() < 1e-7*weight.norm());
        }
}

// The lid, parallel to the bed, moves along itself but at its ends and its bend, for so long that nothing changes any more. What convects passes walls by the
// fine scales u', by which the method loses momentum where inertia counts: half as much on elements of half the size
TEST_CASE("a steady flow over a re-entrant edge pulls, pushes and turns the walls as much as its lid: to round-off without inertia, with it to 2 %")
{
    usePetsc();
    for (const int dim : {2, 3})
        for (const Velocity kind : {Velocity::Slip, Velocity::NoSlip, Velocity::Fixed})
            for (const double rho : {1e-6, 1.})
            {
                const SimplexMesh mesh = ridgeMesh(dim, 6);
                const Halo halo(mesh, MPI_COMM_WORLD);
                NumericsControls controls;
                controls.tolerance = 1e-9;
                std::vector<BoundaryPatch> patches = walls(mesh, kind);
                patches[3] = makePatch(mesh, 3, Velocity::Fixed, [](const double* x, double)
                {
                    const double along = x[0]*x[0]*(1 - x[0]*x[0]);
                    return std::array<double, 3>{along, x[0] > 0 ? -along : along, 0};
                });
                Fluid fluid(mesh, halo, oneFluid(rho, 0.02), controls, patches);
                fluid.watchPatches(allOf(patches));
                fluid.start(restState(mesh), false);
                advance(fluid, 0.5, 40, true);
                Vec3 turning = Vec3::Zero();
                for (const PatchForce& f : fluid.patchForces()) turning += f.pressureMoment + f.frictionMoment;
                const double scale = fluid.patchForces()[3].friction.norm(), rest = sumOf(fluid).norm()/scale, turn = turning.norm()/scale;
                if (isRoot()) std::printf("%dD, kind %d, density %g: friction of the lid %.4f N; sum of all forces %.1e, of moments %.1e of it\n", dim, int(kind), rho, scale, rest, turn);
                CHECK(rest < (rho < 1 ? 1e-6 : 0.02));
                CHECK(turn < (rho < 1 ? 1e-6 : 0.02));
            }
}

// u = y: the wall is pulled along by mu a square metre, the lid back
TEST_CASE("friction of a shear flow on a no-slip wall and on the lid")
{
    usePetsc();
    for (const int dim : {2, 3})
    {
        const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {6, 6, 3}, {0, 0, 0}, {1, 1, 0.5}, 0.15);
        const Halo halo(mesh, MPI_COMM_WORLD);
        NumericsControls controls;
        controls.tolerance = 1e-10;
        const auto shear = [](const double* x, double) { return std::array<double, 3>{x[1], 0, 0}; };
        std::vector<BoundaryPatch> patches{makePatch(mesh, 0, Velocity::Fixed, shear), makePatch(mesh, 1, Velocity::Fixed, shear),
            makePatch(mesh, 2, Velocity::NoSlip), makePatch(mesh, 3, Velocity::Fixed, shear)};
        patches[2].isNoSlipWall = true;
        for (int p = 4; p < 2*dim; ++p) patches.push_back(makePatch(mesh, p, Velocity::Slip));
        const double mu = 1e4, area = 0.5;
        Fluid fluid(mesh, halo, oneFluid(1, mu), controls, patches);
        fluid.watchPatches({2, 3});
        fluid.start(restState(mesh), false);
        advance(fluid, 0.1, 6);
        CHECK(fluid.patchForces()[2].friction[0] == near(mu*area, 1e-6));
        CHECK(fluid.patchForces()[3].friction[0] == near(-mu*area, 0.4)); // the corners' nodes are the inlet's and the outlet's, too
        CHECK(fluid.patchForces()[0].friction.norm() == 0);    // not asked for
    }
}
