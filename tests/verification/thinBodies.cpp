// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies thinner than an element float as deep as others: alone, and in a raft whose logs touch. Bars of racks thinner than an element hold the stream back.
#include "geometry/coverBuilder.hpp"
#include "support/floatingBodies.hpp"
#include "support/flowCases.hpp"
#include "support/near.hpp"

#include <algorithm>
#include <cstdio>

using namespace flotsam;

namespace
{

constexpr int nPlaces = 6;

/// Largest acceleration over gravity of logs side by side that float half immersed, density half of water's.
double largestAcceleration(int dim, double thickness, bool isBox, int nLogs)
{
    const double d = thickness/FloatingBodies::n;
    const double length = dim == 2 ? 1 : 0.5;
    const auto shape = isBox ? makeBox(Vec3::Zero(), dim == 2 ? Vec3(d, d, length) : Vec3(d, length, d))
                             : dim == 2 ? makeCylinder(Vec3(0, 0, -0.5*length), Vec3(0, 0, 0.5*length), 0.5*d) : makeCylinder(Vec3(0, -0.5*length, 0), Vec3(0, 0.5*length, 0), 0.5*d);
    FloatingBodies bodies(dim, shape, 500, 0.5*d);
    double largest = 0;
    for (int k = 0; k < nPlaces; ++k)
    {
        const Vec3 middle = Vec3(0.5, 0.5, 0.5) + (haltonPoint(k) - Vec3::Constant(0.5))/FloatingBodies::n;
        std::vector<Vec3> places;
        for (int j = 0; j < nLogs; ++j) places.push_back(middle + (j - 0.5*(nLogs - 1))*d*Vec3::UnitX());
        for (const Motion& motion : bodies.release(places, middle[dim - 1])) largest = std::max(largest, motion.velocity.norm()/FloatingBodies::gravity);
    }
    std::printf("%dD, %s of %.1f elements, %d side by side: %.1e g\n", dim, isBox ? "planks" : "logs", thickness, nLogs, largest);
    return largest;
}

/// Drag coefficient of a bar across a stream, plane, `thickness` elements thick: a structure, or a body held at rest.
double dragCoefficient(double thickness, bool isBox, bool isStructure, const Vec3& place)
{
    constexpr double speed = 1, density = 1000, h = 0.1, dt = 0.04;
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {40, 20, 1}, {0, 0, 0}, {4, 2, 1}, 0.1);
    const Halo halo(mesh, MPI_COMM_WORLD);
    const NodeGraph graph(mesh);
    using Kind = BoundaryPatch::Velocity;
    std::vector<BoundaryPatch> patches = allPatches(mesh, Kind::Slip);
    patches[0] = makePatch(mesh, 0, Kind::Fixed, [](const double*, double) { return std::array<double, 3>{speed, 0, 0}; });
    patches[1] = makePatch(mesh, 1, Kind::Open);
    Fluid fluid(mesh, halo, oneFluid(density, 1e-3), NumericsControls(), patches);
    FlowState start = restState(mesh);
    for (int i = 0; i < mesh.nNodes; ++i) start.u[std::size_t(i)*2] = speed;
    start.uOld = start.u;
    fluid.start(start, false);
    const double d = thickness*h;
    Solid bar;
    bar.kind = isStructure ? Solid::Kind::Fixed : Solid::Kind::Prescribed;
    bar.isLoose = !isStructure;
    bar.shape = isBox ? makeBox(Vec3::Zero(), {d, d, 1}) : makeCylinder({0, 0, -0.5}, {0, 0, 0.5}, 0.5*d);
    bar.pose.position = place;
    std::vector<Solid> solids = {bar};
    CoverBuilder builder(mesh, graph, halo);
    fluid.setGeometry(&builder.buildExactVolume(solids), &solids, false);
    constexpr int nSteps = 60, nMean = 20;
    double force = 0;
    for (int step = 0; step < nSteps; ++step)
    {
        fluid.beginStep(dt);
        fluid.assemble();
        REQUIRE(fluid.solve({}).hasConverged);
        if (step >= nSteps - nMean) force += fluid.solidLoads()[0].force.x()/nMean;
        fluid.endStep();
    }
    return force/(0.5*density*speed*speed*d);
}

} // namespace

TEST_CASE("bars thinner than an element hold the stream back, as structures the same as bodies held at rest")
{
    usePetsc();
    for (const bool isBox : {false, true})
        for (const double thickness : {0.3, 0.6, 1.0, 1.4})
            for (int k = 0; k < 3; ++k)
            {
                const Vec3 place = Vec3(1.3, 1, 0) + 0.1*(haltonPoint(k) - Vec3::Constant(0.5)).cwiseProduct(Vec3(1, 1, 0));
                const double drag = dragCoefficient(thickness, isBox, true, place);
                std::printf("%s bar of %.1f elements: drag coefficient %.2f\n", isBox ? "square" : "round", thickness, drag);
                CHECK(drag > 1);    // real ones: 1 to 1.2, 2.1; by the distance at the nodes round ones of one element and less have 0 in most places
                CHECK(drag < 3);
                if (k == 0) CHECK(dragCoefficient(thickness, isBox, false, place) == near(drag, 1e-10));
            }
}

TEST_CASE("bodies thinner than an element float")
{
    for (const int dim : {2, 3})
        for (const double thickness : {0.3, 0.6, 1.0, 1.4})
            for (const bool isBox : {false, true})
                for (const int nLogs : {1, 3}) CHECK(largestAcceleration(dim, thickness, isBox, nLogs) < 0.01);   // by the distance at the nodes, with the volume exact, at 1.5 elements: 0.027 to 0.077
}
