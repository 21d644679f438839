// SPDX-License-Identifier: GPL-3.0-or-later
/// A stream whose level at the inlet floats (variableHeightFlowRate, variableHeightFlowRateInletVelocity): it stays as uniform as it begins, rises with what dams it, and does not fall
/// below its critical depth (docs/numerics/2-momentum.md, 2.8).
#include "equations/fluid.hpp"
#include "foam/boundaryReader.H"
#include "geometry/coverBuilder.hpp"
#include "support/foamCase.H"
#include "support/near.hpp"
#include "support/waterAtRest.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>

using namespace flotsam;

namespace
{

constexpr double gravity = 10, depth = 0.55, speed = 1, thickness = 0.1, cell = 0.05;   // of the channel in tests/cases/foamChannel, 2 x 1 m; Froude number 0.43

std::vector<FoamCase::Edit> streamCase(const std::vector<FoamCase::Edit>& more)
{
    std::vector<FoamCase::Edit> edits{{"system/blockMeshDict", "(20 10 1)", "(40 20 1)"}, {"system/decomposeParDict", "n (2 1 1)", "n (1 2 1)"},
        {"system/fvSolution", "flotsam { timeOrder 1; dualCellTransport off; tolerance 1e-7; }", "flotsam {}"}, {"constant/hRef", "value 0", "value 0.55"},
        {"0/U", "type flowRateInletVelocity; volumetricFlowRate constant 0.05;", "type variableHeightFlowRateInletVelocity; alpha alpha.water; flowRate 0.055;"},
        {"0/U", "outlet { type zeroGradient; }", "outlet { type pressureInletOutletVelocity; value uniform (0 0 0); }"}, {"0/U", "floor { type noSlip; }", "floor { type slip; }"},
        {"0/p_rgh", "outlet { type fixedValue; value uniform 7; }", "outlet { type fixedValue; value uniform 0; }"}, {"0/p_rgh", "p0 uniform 3", "p0 uniform 0"},
        {"0/alpha.water", "lowerBound 0.1; upperBound 0.9", "lowerBound 0; upperBound 0.99"},
        {"0/alpha.water", "outlet { type zeroGradient; }", "outlet { type inletOutlet; inletValue uniform 0; value uniform 0; }"}};
    edits.insert(edits.end(), more.begin(), more.end());
    return edits;
}

class Stream
{
public:
    /// sill: height of a broad-crested one across the bed [m], 0: none.
    explicit Stream(double sill, const std::vector<FoamCase::Edit>& edits = {})
    :   foam_("foamChannel", streamCase(edits)), controls_(readCaseControls(foam_.time())), adapter_(makeSimplexMesh(foam_.mesh(), MPI_COMM_WORLD)), halo_(adapter_.mesh, MPI_COMM_WORLD),
        graph_(adapter_.mesh), builder_(adapter_.mesh, graph_, halo_),
        fluid_(adapter_.mesh, halo_, controls_.fluid, controls_.numerics, readBoundary(foam_.mesh(), adapter_, halo_, controls_))
    {
        FlowState start = waterAtRest(fluid_, depth);
        for (int i = 0; i < adapter_.mesh.nNodes; ++i) start.u[std::size_t(i)*2] = speed;
        start.uOld = start.u;
        fluid_.start(start, false);
        if (sill <= 0) return;
        Solid solid;
        solid.name = "sill";
        solid.kind = Solid::Kind::Fixed;
        solid.wall = Solid::Wall::Slip;
        solid.shape = makeBox(Vec3::Zero(), Vec3(0.4, 2*sill, 2));
        solid.pose.position = Vec3(1.3, 0, 0);
        solids_ = {solid};
        fluid_.setGeometry(&builder_.build(solids_), &solids_, false);
    }

    void advance(double duration)
    {
        constexpr double dt = 0.0125;
        for (int step = 0; step < std::lround(duration/dt); ++step)
        {
            const TransportReport report = fluid_.beginStep(dt);
            entered += report.inflow*thickness;
            fluid_.assemble();
            REQUIRE(fluid_.solve({}).hasConverged);
            fluid_.endStep();
        }
    }

    /// Depth of the water at the column of nodes at x [m].
    double depthAt(double x) const
    {
        const SimplexMesh& mesh = adapter_.mesh;
        double sum = 0;
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            const double y = mesh.x[2*i + 1];
            if (std::abs(mesh.x[2*i] - x) < 0.01*cell) sum += cell*(y < 1e-9 || y > 1 - 1e-9 ? 0.5 : 1)*fluid_.state().alpha[i];
        }
        return halo_.sum(sum);
    }

    double entered = 0;     ///< [m^3]

private:
    FoamCase foam_;
    CaseControls controls_;
    MeshAdapter adapter_;
    Halo halo_;
    NodeGraph graph_;
    CoverBuilder builder_;
    Fluid fluid_;
    std::vector<Solid> solids_;
};

} // namespace

// With the phase of the patch's own nodes and velocities weighed by it the depth at the inlet was 0.39 to 0.56 m after these times.
TEST_CASE("a uniform stream stays uniform")
{
    usePetsc();
    Stream stream(0);
    stream.advance(1);
    double most = 0;
    for (int k = 0; k < 6; ++k)
    {
        stream.advance(1);
        for (double x = 0; x < 1.99; x += 5*cell) most = std::max(most, std::abs(stream.depthAt(x) - depth));
    }
    MESSAGE("largest change of the depth ", most/depth, " of it, entered ", stream.entered, " m^3");
    CHECK(most < 0.01*depth);
    CHECK(stream.entered == near(7*depth*speed*thickness, 1e-3));
}

TEST_CASE("the level at the inlet rises with the water that a sill holds back")
{
    usePetsc();
    constexpr double sill = 0.25, discharge = depth*speed;
    Stream stream(sill);
    stream.advance(8);
    double least = 1, most = 0, mean = 0;
    constexpr int n = 16;
    for (int k = 0; k < n; ++k)
    {
        stream.advance(0.25);
        const double h = stream.depthAt(0);
        least = std::min(least, h);
        most = std::max(most, h);
        mean += h/n;
    }
    // critical depth on the crest, no loss upstream of it: head above the bed
    const double head = sill + 1.5*std::cbrt(discharge*discharge/gravity), measured = mean + discharge*discharge/(2*gravity*mean*mean);
    MESSAGE("head at the inlet ", measured, " m, of the sill ", head, "; depth ", least, " to ", most);
    CHECK(measured == near(head, 0.03));
    CHECK(most - least < 0.03*mean);
    CHECK(stream.entered == near(12*discharge*thickness, 1e-3));
}

// Without a bound the level at the inlet falls for good: nothing from inside reaches a stream that is faster than its waves (0.22 m after these times).
TEST_CASE("on a steep bed a stream enters at its critical depth")
{
    usePetsc();
    constexpr double slope = 0.1, discharge = depth*speed;
    Stream stream(0, {{"constant/g", "value (0 -10 0)", "value (1 -10 0)"}, {"constant/hRef", "value 0.55", "value 0"}, {"0/p_rgh", "outlet { type fixedValue; value uniform 0; }", "outlet { type prghTotalPressure; p0 uniform 0; value uniform 0; }"}});
    stream.advance(10);
    const double critical = std::cbrt(discharge*discharge/gravity), x = 1.5, h = stream.depthAt(x), head = h + discharge*discharge/(2*gravity*h*h);
    MESSAGE("depth at the inlet ", stream.depthAt(0), " m, critical ", critical, "; ", x, " m behind it ", h, ", head ", head, ", of the inlet ", 1.5*critical + slope*x);
    CHECK(stream.depthAt(0) == near(critical, 0.02));
    CHECK(head == near(1.5*critical + slope*x, 0.07));    // four elements over the depth
    CHECK(stream.entered == near(10*discharge*thickness, 1e-3));
}
