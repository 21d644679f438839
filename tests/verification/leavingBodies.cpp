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
        if (isOpen) open(1, end);
    }

    /// The end x = 0, too: water at rest beyond it.
    void openFarEnd()
    {
        patches_[0] = makePatch(mesh_, 0, BoundaryPatch::Velocity::Open);
        open(0, End::Water);
    }

    /// On a held body after the first step, over the weight of the fluid that it displaces in all: force, and moment over this weight times `arm`.
    Fluid::SolidLoad load(std::shared_ptr<const Shape> shape, const Pose& pose, double weight, double arm)
    {
        Fluid fluid(mesh_, halo_, properties_, controls_, patches_);
        std::vector<Solid> solids(1);
        CoverBuilder builder(mesh_, fluid.graph(), halo_);
        start(fluid, builder, solids, shape, pose);
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

    /// Accelerations of a body of `density` in every step from rest, where it is, over gravity; that of its rotation times `arm`.
    std::vector<Motion> release(std::shared_ptr<const Shape> shape, const Pose& pose, double density, double arm)
    {
        Fluid fluid(mesh_, halo_, properties_, controls_, patches_);
        std::vector<Solid> solids(1);
        CoverBuilder builder(mesh_, fluid.graph(), halo_);
        start(fluid, builder, solids, shape, pose);
        const double dt = 1e-4, mass = density*shape->moments().volume, inertia = mass*arm*arm/4;
        Fluid::SolidLoad mean{Vec3::Zero(), Vec3::Zero()};
        FreeBody body;
        body.mass = mass;
        body.inertia = Eigen::Matrix3d::Identity()*inertia;
        std::vector<Motion> result;
        for (int step = 0; step < 12; ++step)
        {
            fluid.beginStep(dt);
            fluid.assemble();
            const double share = body.newLoadShare = fluid.newLoadShare();
            const Vec3 weight = mass*Vec3(properties_.gravity[0], properties_.gravity[1], properties_.gravity[2]);
            body.force = share*weight + (1 - share)*mean.force;
            body.moment = (1 - share)*mean.moment;
            REQUIRE(fluid.solve({body}).hasConverged);
            const Fluid::SolidLoad load = fluid.solidLoads()[0];
            mean = {share*(load.force + weight) + (1 - share)*mean.force, share*load.moment + (1 - share)*mean.moment};
            const Motion after = fluid.solidMotions()[0];
            body.lastChange = {(after.velocity - body.velocity)/dt, (after.angularVelocity - body.angularVelocity)/dt};
            body.velocity = solids[0].motion.velocity = after.velocity;
            body.angularVelocity = solids[0].motion.angularVelocity = after.angularVelocity;
            body.angularMomentum = inertia*after.angularVelocity;
            CHECK((mean.force - mass*body.lastChange.velocity).norm() < 1e-6*rho*g*shape->moments().volume);
            result.push_back({body.lastChange.velocity/g, body.lastChange.angularVelocity*arm/g});
            fluid.endStep();
        }
        return result;
    }

    /// The end becomes the top.
    void turnGravity() { properties_.gravity = {-g, 0, 0}; }

    struct Beyond { std::vector<double> load, inertia; };

    /// What a body has beyond the end alone: force, moment [N, N m]; inertia of the fluid that it moves there.
    Beyond beyond(std::shared_ptr<const Shape> shape, const Vec3& position)
    {
        const BeyondMesh outside(mesh_, halo_, properties_, patches_);
        std::vector<double> load(6, 0.0), inertia(36, 0.0);
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
        if (outside.isReached(solids)) outside.addLoads(step, 6, load, inertia);
        halo_.sum(load.data(), 6);
        halo_.sum(inertia.data(), 36);
        return {load, inertia};
    }

private:
    /// Its volume is that in the middle of the tank.
    void start(Fluid& fluid, CoverBuilder& builder, std::vector<Solid>& solids, std::shared_ptr<const Shape> shape, const Pose& pose)
    {
        solids[0].kind = Solid::Kind::Free;
        solids[0].shape = shape;
        solids[0].pose = pose;
        solids[0].pose.position[0] = 0.5;
        fluid.start(state(fluid), false);
        for (int pass = 0; pass < 6; ++pass) builder.buildExactVolume(solids);
        solids[0].pose = pose;
        builder.buildExactVolume(solids);
        fluid.setGeometry(&builder.cover(), &solids, true);
    }

    void open(int patch, End end)
    {
        const std::vector<int> nodes = patches_[patch].nodes;
        patches_[patch].evaluate = [this, nodes, end](const BoundaryState& s, PatchValues& values)
        {
            values.pressure.assign(nodes.size(), 0.0);
            for (std::size_t k = 0; k < nodes.size() && end == End::Water; ++k)
                values.pressure[k] = density(properties_, controls_, s.alpha[nodes[k]])*g*(level_ - height(nodes[k]));
            values.alpha.assign(nodes.size(), 0.0);
        };
    }

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
    const std::vector<double> load = OpenTank(3, 1, End::Water).beyond(block, centre).load;
    const double up = rho*g*beyond*0.3*0.2, back = rho*g*depth*0.3*0.2;
    CHECK(load[0] == near(-back, 0.01*back));
    CHECK(load[1] == within(0, 1e-9*up));
    CHECK(load[2] == near(up, 0.01*up));
    CHECK(load[3] == within(0, 1e-3*up*beyond));
    CHECK(load[4] == near(-middle*up + rho*g*0.3*std::pow(0.2, 3)/12, 0.02*middle*up));
    CHECK(load[5] == within(0, 1e-3*up*beyond));
    for (const Vec3& inside : {Vec3(0.7, 0.45, 0.3), Vec3(0.749, 0.45, 0.3)})
        for (const double l : OpenTank(3, 1, End::Water).beyond(block, inside).load) CHECK(l == 0);
    OpenTank openAbove(3, 1, End::Water);
    openAbove.turnGravity();
    for (const double l : openAbove.beyond(block, centre).load) CHECK(l == 0);
    for (const double l : OpenTank(3, 1, End::Bar).beyond(block, centre).load) CHECK(l == 0);
}

TEST_CASE("a body moves as much fluid beyond the mesh as an ellipsoid of its extents does, and falls with that which nothing carries")
{
    const Vec3 size(0.5, 0.3, 0.2), centre(1.05, 0.45, 0.3);
    const auto block = makeBox(Vec3::Zero(), size);
    const double beyond = 0.3, displaced = rho*beyond*size[1]*size[2], middle = 1 + beyond/2 - centre[0];
    const OpenTank::Beyond water = OpenTank(3, 1, End::Water).beyond(block, centre), fall = OpenTank(3, 1, End::Overfall).beyond(block, centre);
    const Vec3 slender = size.cwiseInverse();
    for (int k = 0; k < 3; ++k)
        CHECK(water.inertia[7*k] == near(displaced*slender[k]/(slender.sum() - slender[k]), 0.01));
    // about z: of the way along x across the flow, and that along y by the coefficient of x
    const double turned = water.inertia[7]*(middle*middle + beyond*beyond/12) + water.inertia[0]*size[1]*size[1]/12;
    CHECK(water.inertia[35] == near(turned, 0.02));
    CHECK(water.inertia[6*5 + 1] == near(water.inertia[7]*middle, 0.02));
    CHECK(fall.load[0] == within(0, 1e-9*displaced*g));
    CHECK(fall.load[2] == near(-water.inertia[14]*g, 1e-9));
    CHECK(fall.load[4] == near(middle*water.inertia[14]*g, 0.02));
}

TEST_CASE("a light body on its way out accelerates as in the middle of the tank, whatever the end prescribes")
{
    for (const int dim : {2, 3})
        for (const End end : {End::Water, End::Velocity})
        {
            OpenTank tank(dim, 1, end);
            tank.openFarEnd();
            const Vec3 half = dim == 2 ? Vec3(0, 0, 0.5) : Vec3(length/2, 0, 0);
            const auto shape = makeCylinder(-half, half, radius);
            const double arm = dim == 2 ? radius : length;
            const auto accelerations = [&](double x) { Pose pose; pose.position = Vec3(x, 0.5, 0.5); return tank.release(shape, pose, rho/100, arm); };
            const std::vector<Motion> inside = accelerations(0.5);
            double least = 1e300, most = 0, along = 0, turn = 0;
            for (const double x : dim == 2 ? std::vector<double>{0.9, 1.0, 1.05, 1.1} : std::vector<double>{0.8, 1.0, 1.1, 1.2})
            {
                const std::vector<Motion> found = accelerations(x);
                for (std::size_t k = 0; k < found.size(); ++k)
                {
                    const double up = found[k].velocity[dim - 1]/inside[k].velocity[dim - 1];
                    least = std::min(least, up);
                    most = std::max(most, up);
                    along = std::max(along, std::abs(found[k].velocity[0]));
                    turn = std::max(turn, found[k].angularVelocity.norm());
                }
            }
            MESSAGE(dim, "D, ", (end == End::Water ? "prescribed pressure" : "prescribed velocity"), ": up ", least, " to ", most, " of that in the middle; along ", along, " g; rotation ", turn,
                dim == 2 ? " g/radius" : " g/length");
            CHECK(least > 0.4);
            CHECK(most < 1.8);
            CHECK(along < 0.8);
            CHECK(turn < 2.8);
        }
}
