// SPDX-License-Identifier: GPL-3.0-or-later
/// Patches of prescribed velocity: what passes them beside no-slip walls (docs/numerics/2-momentum.md, 2.15) and solids (2.8).
#include "core/patchFaces.hpp"
#include "equations/fluid.hpp"
#include "geometry/coverBuilder.hpp"
#include "support/flowCases.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <set>

using namespace flotsam;

namespace
{

constexpr double speed = 2;     // [m/s]
using Kind = BoundaryPatch::Velocity;

/// A no-slip wall, held weakly or at its nodes.
BoundaryPatch noSlipWall(const SimplexMesh& mesh, int patch, Kind kind)
{
    BoundaryPatch wall = makePatch(mesh, patch, kind);
    wall.isNoSlipWall = true;
    return wall;
}

BoundaryPatch moving(const SimplexMesh& mesh, int patch, const std::array<double, 3>& velocity)
{
    return makePatch(mesh, patch, Kind::Fixed, [velocity](const double*, double) { return velocity; });
}

/// Volume that the P1 velocity takes into the mesh through a patch [m^dim/s].
double discharge(const Fluid& fluid, int patch)
{
    const SimplexMesh& mesh = fluid.mesh();
    const MeshPatch& faces = mesh.patches[patch];
    double sum = 0, v[3];
    for (std::size_t f = 0; f < faces.faceElement.size(); ++f)
    {
        if (!faces.isOwnedFace[f]) continue;
        outwardVector(mesh, faces, f, v);
        for (int k = 0; k < mesh.dim; ++k)
            for (int d = 0; d < mesh.dim; ++d) sum -= v[d]*fluid.state().u[std::size_t(faces.faceNodes[f*mesh.dim + k])*mesh.dim + d]/mesh.dim;
    }
    return fluid.halo().sum(sum);
}

void advance(Fluid& fluid, double dt, int steps)
{
    for (int step = 0; step < steps; ++step)
    {
        fluid.beginStep(dt);
        fluid.assemble();
        REQUIRE(fluid.solve({}).hasConverged);
        fluid.endStep();
    }
}

/// Of a box whose top is at height z of the last axis, wider than the mesh.
Solid slab(int dim, double z, Solid::Kind kind)
{
    Solid solid;
    solid.name = "slab";
    solid.kind = kind;
    solid.wall = Solid::Wall::Slip;
    Vec3 size(20, 20, 20);
    size[dim - 1] = 2;
    solid.shape = makeBox(Vec3::Zero(), size);
    solid.pose.position = (z - 1)*Vec3::Unit(dim - 1);
    return solid;
}

/// A duct 1 high full of water under gas that is nowhere; a slab covers its lower part, from the inlet to the open end.
class CoveredDuct
{
public:
    CoveredDuct(int dim, double move, double height, Solid::Kind kind)
    :   mesh_(makeBoxMesh(MPI_COMM_WORLD, dim, dim == 2 ? std::array{10, 5, 1} : std::array{6, 3, 5}, {0, 0, 0}, {2, dim == 2 ? 1 : 0.6, 1}, move)), halo_(mesh_, MPI_COMM_WORLD),
        graph_(mesh_), builder_(mesh_, graph_, halo_), height_(height)
    {
        controls_.tolerance = 1e-10;
        patches_ = allPatches(mesh_, Kind::Slip);
        patches_[0] = makePatch(mesh_, 0, Kind::Fixed, [](const double*, double) { return std::array<double, 3>{speed, 0, 0}; }, 1);
        patches_[0].phase = BoundaryPatch::Phase::Inflow;
        patches_[1] = makePatch(mesh_, 1, Kind::Open);
        fluid_ = std::make_unique<Fluid>(mesh_, halo_, properties_, controls_, patches_);
        solids_ = {slab(dim, height, kind)};
        FlowState start = restState(mesh_);
        for (int i = 0; i < mesh_.nNodes; ++i) start.u[std::size_t(i)*dim] = speed;
        start.uOld = start.u;
        fluid_->start(start, false);
        fluid_->setGeometry(&builder_.build(solids_), &solids_, false);
    }

    /// rise: of the slab during the step [m].
    TransportReport advance(double dt, double rise = 0)
    {
        if (rise != 0)
        {
            fluid_->keepGeometry();
            solids_[0].pose.position[mesh_.dim - 1] += rise;
            solids_[0].motion.velocity[mesh_.dim - 1] = rise/dt;
            fluid_->setGeometry(&builder_.build(solids_), &solids_, true);
        }
        const TransportReport report = fluid_->beginStep(dt);
        fluid_->assemble();
        REQUIRE(fluid_->solve({}).hasConverged);
        fluid_->endStep();
        height_ += rise;
        return report;
    }

    double width() const { return mesh_.dim == 2 ? 1 : 0.6; }
    double height() const { return height_; }

private:
    SimplexMesh mesh_;
    Halo halo_;
    NodeGraph graph_;
    CoverBuilder builder_;
    FluidProperties properties_;
    NumericsControls controls_;
    std::vector<BoundaryPatch> patches_;
    std::vector<Solid> solids_;
    std::unique_ptr<Fluid> fluid_;
    double height_;
};

} // namespace

TEST_CASE("a uniform inlet between no-slip walls brings its velocity times its area")
{
    usePetsc();
    for (const int dim : {2, 3})
        for (const Kind walls : {Kind::NoSlip, Kind::Fixed})
        {
            const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {12, 6, 4}, {0, 0, 0}, {2, 1, 0.7}, 0.1);
            const Halo halo(mesh, MPI_COMM_WORLD);
            std::vector<BoundaryPatch> patches{moving(mesh, 0, {speed, 0, 0}), makePatch(mesh, 1, Kind::Open)};
            for (int p = 2; p < 2*dim; ++p) patches.push_back(noSlipWall(mesh, p, walls));
            Fluid fluid(mesh, halo, oneFluid(1000, 1e-3), NumericsControls(), patches);
            FlowState start = restState(mesh);
            for (int i = 0; i < mesh.nNodes; ++i) start.u[std::size_t(i)*dim] = speed;
            start.uOld = start.u;
            fluid.start(start, false);
            advance(fluid, 0.05, 10);
            CHECK(discharge(fluid, 0) == near(speed*(dim == 2 ? 1 : 0.7), 1e-14));
            if (walls == Kind::Fixed) continue;
            double slowest = speed;     // the walls' layer is far thinner than the elements
            for (int i = 0; i < mesh.nOwned; ++i) slowest = std::min(slowest, fluid.state().u[std::size_t(i)*dim]);
            slowest = halo.min(slowest);
            MESSAGE(dim, "D: slowest ", slowest, " m/s");
            CHECK(slowest > 0.9*speed);
        }
}

TEST_CASE("a lid that moves along itself does not move the walls beside it")
{
    usePetsc();
    for (const int dim : {2, 3})
    {
        const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {4, 4, 4}, {0, 0, 0}, {1, 1, 1}, 0.1);
        const Halo halo(mesh, MPI_COMM_WORLD);
        std::vector<BoundaryPatch> patches;
        for (int p = 0; p < 2*dim; ++p) patches.push_back(p == 3 ? moving(mesh, 3, {speed, 0, 0}) : noSlipWall(mesh, p, Kind::NoSlip));
        Fluid fluid(mesh, halo, oneFluid(1, 1e-2), NumericsControls(), patches);
        fluid.start(restState(mesh), false);
        advance(fluid, 0.1, 2);
        std::set<int> walls;
        for (int p = 0; p < 2*dim; ++p)
            if (p != 3) walls.insert(patches[p].nodes.begin(), patches[p].nodes.end());
        for (int i : patches[3].nodes) CHECK(fluid.state().u[std::size_t(i)*dim] == (walls.count(i) ? 0 : speed));
    }
}

TEST_CASE("what a structure leaves of an inlet brings its area times the velocity")
{
    usePetsc();
    constexpr double dt = 0.02;
    for (const int dim : {2, 3})
        for (const double move : {0.0, 0.1})
            for (const double height : {0.4, 0.33, 0.59})  // a plane of nodes, if they are not moved; between them
            {
                CoveredDuct duct(dim, move, height, Solid::Kind::Fixed);
                for (int step = 0; step < 3; ++step)
                {
                    const TransportReport report = duct.advance(dt);
                    const double expected = speed*(1 - height)*duct.width()*dt;
                    CHECK(report.inflow == near(expected, 1e-9));
                    CHECK(std::abs(report.redistributed) < 1e-8*expected);
                }
            }
}

TEST_CASE("a moving cover of an inlet counts with its mean over the step")
{
    usePetsc();
    constexpr double dt = 0.02;
    for (const int dim : {2, 3})
        for (const double rise : {0.03, -0.03})
        {
            CoveredDuct duct(dim, 0.1, 0.43, Solid::Kind::Prescribed);
            for (int step = 0; step < 6; ++step)
            {
                const double mean = duct.height() + 0.5*rise;
                CHECK(duct.advance(dt, rise).inflow == near(speed*(1 - mean)*duct.width()*dt, 1e-9));
            }
        }
}
