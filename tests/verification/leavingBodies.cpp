// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies that reach beyond the mesh through an open patch: the fluid carries them as if it went on there (equations/beyondMesh.hpp).
#include "equations/materials.hpp"
#include "geometry/coverBuilder.hpp"
#include "support/near.hpp"
#include "support/waterAtRest.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

constexpr double g = 10, rho = 1000;    // [m/s^2], [kg/m^3]
constexpr double heavy = 1e6;           // a body that stays where it is

/// What bounds the tank at x = 1: the pressure of water at rest; a free overfall; a prescribed velocity, zero; that, and nothing passes.
enum class End { Water, Overfall, Velocity, Bar };

/// Water at rest in a tank of unit length, width and height, of which the end x = 1 is open.
class OpenTank
{
public:
    OpenTank(int dim, double level, End end)
    :   mesh_(makeBoxMesh(MPI_COMM_WORLD, dim, {10, 10, 10}, {0, 0, 0}, {1, 1, 1}, 0.12)), halo_(mesh_, MPI_COMM_WORLD), level_(level)
    {
        usePetsc();
        properties_.rhoLiquid = rho;
        properties_.gravity[dim - 1] = -g;
        controls_.tolerance = 1e-10;
        controls_.forceTolerance = 1e-8;
        controls_.maxIterations = 500;
        patches_ = allPatches(mesh_, BoundaryPatch::Velocity::Slip);
        const bool isOpen = end == End::Water || end == End::Overfall;
        patches_[1] = makePatch(mesh_, 1, isOpen ? BoundaryPatch::Velocity::Open : BoundaryPatch::Velocity::Fixed);
        patches_[1].stopsBodies = end == End::Bar;
        if (!isOpen) return;
        const std::vector<int> nodes = patches_[1].nodes;
        patches_[1].evaluate = [this, nodes, end](const BoundaryState& s, PatchValues& values)
        {
            values.pressure.assign(nodes.size(), 0.0);
            for (std::size_t k = 0; k < nodes.size() && end == End::Water; ++k)
                values.pressure[k] = density(properties_, controls_, s.alpha[nodes[k]])*g*(level_ - height(nodes[k]));
            values.alpha.assign(nodes.size(), 0.0);
        };
    }

    /// On a held body after the first step, over the weight of the fluid that it displaces in all: force, and moment over this weight times `arm`.
    Fluid::SolidLoad load(std::shared_ptr<const Shape> shape, const Pose& pose, double weight, double arm)
    {
        Fluid fluid(mesh_, halo_, properties_, controls_, patches_);
        std::vector<Solid> solids(1);
        solids[0].kind = Solid::Kind::Free;
        solids[0].shape = shape;
        solids[0].pose = pose;
        solids[0].pose.position[0] = 0.5;
        fluid.start(state(fluid), false);
        CoverBuilder builder(mesh_, fluid.graph(), halo_);
        for (int pass = 0; pass < 6; ++pass) builder.buildExactVolume(solids);
        solids[0].pose = pose;
        builder.buildExactVolume(solids);
        fluid.setGeometry(&builder.cover(), &solids, true);
        FreeBody body;
        body.mass = heavy*weight;
        body.inertia = Eigen::Matrix3d::Identity()*heavy*weight*arm*arm;
        Fluid::SolidLoad load{};
        for (int step = 0; step < 3; ++step)
        {
            fluid.beginStep(0.002);
            fluid.assemble();
            REQUIRE(fluid.solve({body}).hasConverged);
            load = fluid.solidLoads()[0];
            fluid.endStep();
        }
        load.force /= weight;
        load.moment /= weight*arm;
        return load;
    }

    /// The end becomes the top.
    void turnGravity() { properties_.gravity = {-g, 0, 0}; }

    /// What acts on a body beyond the end alone: force, moment [N, N m].
    std::vector<double> loadBeyond(std::shared_ptr<const Shape> shape, const Vec3& position)
    {
        const BeyondMesh beyond(mesh_, halo_, properties_, patches_);
        std::vector<double> load(6, 0.0);
        std::vector<Solid> solids(1);
        solids[0].kind = Solid::Kind::Free;
        solids[0].shape = shape;
        solids[0].pose.position = position;
        const FlowState state = restState(mesh_); // full of water
        std::vector<PatchValues> values(patches_.size());
        patches_[1].evaluate({0, state.u.data(), state.alpha.data()}, values[1]);
        FlowStepData step;
        step.state = &state;
        step.solids = &solids;
        step.patchValues = &values;
        if (beyond.isReached(solids)) beyond.addLoads(step, 6, load);
        halo_.sum(load.data(), 6);
        return load;
    }

private:
    double height(int i) const { return mesh_.x[std::size_t(i)*mesh_.dim + mesh_.dim - 1]; }

    FlowState state(const Fluid& fluid) const
    {
        FlowState s = waterAtRest(fluid, level_);
        for (int i = 0; i < mesh_.nNodes; ++i) s.p[i] = std::max(level_ - height(i), 0.0)*g*rho;
        s.pOld = s.p;
        return s;
    }

    SimplexMesh mesh_;
    Halo halo_;
    double level_;
    FluidProperties properties_;
    NumericsControls controls_;
    std::vector<BoundaryPatch> patches_;
};

constexpr double length = 0.5, radius = 0.11;

/// Half of it below the level, in space: along x, turned about the vertical (3D) or the plane's normal (2D: a disc).
Fluid::SolidLoad loadOfLog(OpenTank& tank, int dim, double level, double x, double angle)
{
    Pose pose;
    if (dim == 2)
    {
        pose.position = Vec3(x, level, 0.5);
        return tank.load(makeCylinder(Vec3(0, 0, -0.5), Vec3(0, 0, 0.5), radius), pose, rho*g*M_PI*radius*radius/2, radius);
    }
    pose.position = Vec3(x, 0.5, level);
    pose.orientation = Eigen::AngleAxisd(angle, Vec3::UnitZ());
    return tank.load(makeCylinder(Vec3(-length/2, 0, 0), Vec3(length/2, 0, 0), radius), pose, rho*g*M_PI*radius*radius/2*length, length);
}

/// Largest differences from the load far from the end, in parts of the displaced weight (and the log's length).
struct Differences { double force, moment; };

Differences largest(End end, int dim, const std::vector<double>& places, const std::vector<double>& angles)
{
    Differences d{};
    for (const double level : {0.5, 0.47})
    {
        OpenTank tank(dim, level, end);
        for (const double angle : angles)
            for (const double x : places)
            {
                const Fluid::SolidLoad load = loadOfLog(tank, dim, level, x, angle);
                d.force = std::max(d.force, (load.force - Vec3::Unit(dim - 1)).norm());
                d.moment = std::max(d.moment, load.moment.norm());
            }
    }
    return d;
}

} // namespace

TEST_CASE("bodies are carried by their displaced weight wherever the mesh ends")
{
    for (const End end : {End::Water, End::Velocity})
    {
        const Differences log = largest(end, 3, {0.8, 0.9, 1.0, 1.1, 1.2}, {0, 0.7}), disc = largest(end, 2, {0.92, 0.97, 1.0, 1.05, 1.09}, {0});
        MESSAGE((end == End::Water ? "prescribed pressure" : "prescribed velocity"), ": log, force ", log.force, ", moment ", log.moment, "; disc ", disc.force, ", ", disc.moment);
        CHECK(log.force < 0.05);
        CHECK(log.moment < 0.015);
        CHECK(disc.force < 0.15);     // along x: the chord of a disc of 2.2 elements, cut linearly
        CHECK(disc.moment < 0.01);
    }
}

TEST_CASE("beyond a patch the pressure that it prescribes acts, and none above a top nor where bodies are stopped")
{
    const auto block = makeBox(Vec3::Zero(), Vec3(0.5, 0.3, 0.2));
    const Vec3 centre(1.05, 0.45, 0.3);     // 0.3 of its length are outside
    const double depth = 1 - centre[2], beyond = 0.3, middle = 1 + beyond/2 - centre[0];
    const std::vector<double> load = OpenTank(3, 1, End::Water).loadBeyond(block, centre);
    const double up = rho*g*beyond*0.3*0.2, back = rho*g*depth*0.3*0.2;
    CHECK(load[0] == near(-back, 0.01*back));
    CHECK(load[1] == within(0, 1e-9*up));
    CHECK(load[2] == near(up, 0.01*up));
    CHECK(load[3] == within(0, 1e-3*up*beyond));
    CHECK(load[4] == near(-middle*up + rho*g*0.3*std::pow(0.2, 3)/12, 0.02*middle*up));
    CHECK(load[5] == within(0, 1e-3*up*beyond));
    for (const Vec3& inside : {Vec3(0.7, 0.45, 0.3), Vec3(0.749, 0.45, 0.3)})
        for (const double l : OpenTank(3, 1, End::Water).loadBeyond(block, inside)) CHECK(l == 0);
    OpenTank openAbove(3, 1, End::Water);
    openAbove.turnGravity();
    for (const double l : openAbove.loadBeyond(block, centre)) CHECK(l == 0);
    for (const End end : {End::Overfall, End::Bar})
        for (const double l : OpenTank(3, 1, end).loadBeyond(block, centre)) CHECK(l == 0);
}
