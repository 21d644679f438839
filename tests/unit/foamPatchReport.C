// SPDX-License-Identifier: GPL-3.0-or-later
/// Discharges and water levels that boundary conditions come to. On 1 and 2 ranks.
#include "equations/patchInflow.hpp"
#include "foam/patchReport.H"
#include "support/boundaryScene.H"
#include "support/near.hpp"

#include <iostream>
#include <sstream>

using namespace flotsam;

namespace
{

/// The channel, 1 m high and 0.1 m thick, with water at rest below `level`.
struct Channel : BoundaryScene
{
    FlowState state;

    Channel(Edits edits, double level) : BoundaryScene(with(std::move(edits), inletOnTwoRanks))
    {
        state.u = velocity;
        for (int i = 0; i < adapter.mesh.nNodes; ++i) alpha[i] = adapter.mesh.x[2*i + 1] < level;
        state.alpha = alpha;
    }
    static Edits with(Edits edits, const FoamCase::Edit& edit) { edits.push_back(edit); return edits; }
    PatchInflow inflow() const { return prescribedInflow(adapter.mesh, halo, patch("inlet"), values("inlet"), state, nullptr); }
    double level(const std::string& name) const
    {
        const std::vector<double> all = outsideLevels(adapter.mesh, halo, patches, controls.fluid, 0);
        for (std::size_t p = 0; p < patches.size(); ++p) if (patches[p].name == name) return all[p];
        return std::nan("");
    }
    std::string report(double endTime = 0) const
    {
        std::ostringstream out;
        auto* screen = std::cout.rdbuf(out.rdbuf());
        reportPatches(controls, adapter, halo, patches, state, nullptr, 0, endTime);
        std::cout.rdbuf(screen);
        return out.str();
    }
};

FoamCase::Edit phaseOfInlet(const std::string& condition) { return {"0/alpha.water", "type variableHeightFlowRate; lowerBound 0.1; upperBound 0.9; value uniform 0;", condition}; }
FoamCase::Edit pressureOfOutlet(const std::string& condition) { return {"0/p_rgh", "outlet { type fixedValue; value uniform 7; }", "outlet { " + condition + " }"}; }

} // namespace

TEST_CASE("what enters, the liquid of it, and gas where liquid stands, each to round-off")
{
    const Channel same({phaseOfInlet("type zeroGradient;")}, 0.55);     // alpha linear from 1 at 0.5 to 0 at 0.6 m: half a metre and half an element
    CHECK(same.inflow().all == near(0.05, 1e-13));
    CHECK(same.inflow().liquid == near(0.05*0.55, 1e-13));
    CHECK(same.inflow().gasAtLiquid == within(0, 1e-15));
    const Channel gas({phaseOfInlet("type fixedValue; value uniform 0;")}, 0.55);
    CHECK(gas.inflow().liquid == within(0, 1e-15));
    CHECK(gas.inflow().gasAtLiquid == near(0.05*0.55, 1e-13));
    const Channel half({phaseOfInlet("type fixedValue; value uniform 0.5;")}, 0.55);
    CHECK(half.inflow().liquid == near(0.025, 1e-13));
    const Channel out({{"0/U", "constant 0.05", "constant -0.05"}, phaseOfInlet("type fixedValue; value uniform 0;")}, 0.55);    // what leaves is what stands there
    CHECK(out.inflow().all == near(-0.05, 1e-13));
    CHECK(out.inflow().liquid == near(-0.05*0.55, 1e-13));
    CHECK(out.inflow().gasAtLiquid == within(0, 1e-15));
}

TEST_CASE("the level outside is that of hRef and of what is given above the air's pressure")
{
    const FoamCase::Edit hRef{"constant/hRef", "value 0;", "value 0.6;"};
    const auto level = [&](const std::string& outlet) { return Channel({hRef, pressureOfOutlet(outlet)}, 0.55).level("outlet"); };
    CHECK(level("type fixedValue; value uniform 3;") == near(0.6, 1e-9));       // the air above has 3 Pa
    CHECK(level("type fixedValue; value uniform 1003;") == near(0.7, 1e-9));    // 1000 Pa/(1000 kg/m^3 10 m/s^2)
    CHECK(level("type prghPressure; p uniform 1003;") == near(1.1, 1e-9));      // as much at the top of the patch, at 1 m
    CHECK(std::isinf(level("type prghTotalPressure; p0 uniform 3;")));          // a free overfall
    CHECK(std::isinf(Channel({pressureOfOutlet("type fixedValue; value uniform 3;")}, 0.55).level("outlet")));   // hRef 0, the bed
    CHECK(std::isinf(Channel({hRef}, 0.55).level("top")));
    CHECK(std::isinf(Channel({hRef}, 0.55).level("inlet")));
}

TEST_CASE("report: discharges, levels, a warning of gas that enters below the surface")
{
    const Channel right({{"constant/hRef", "value 0;", "value 0.6;"}, pressureOfOutlet("type fixedValue; value uniform 3;"), phaseOfInlet("type zeroGradient;")}, 0.55);
    const Channel wrong({pressureOfOutlet("type fixedValue; value uniform 3;"), phaseOfInlet("type inletOutlet; inletValue uniform 0;")}, 0.55);
    const std::string good = right.report(), bad = wrong.report();
    if (!isSerial()) return;    // Info prints on the first rank alone
    CHECK(has(good, "inlet: 0.05 m^3/s enter, 0.0275 of them water"));
    CHECK(has(good, "outlet: pressure of water outside up to a height of 0.6 m"));
    CHECK(has(good, "top: no water outside"));
    CHECK(!has(good, "Warning"));
    CHECK(has(bad, "Warning: patch inlet lets in 0.0275 m^3/s of gas where water stands at it"));
    CHECK(has(bad, "outlet: no water outside"));
}

TEST_CASE("gas that the given pressures blow through the mesh is warned of, not that of a free overfall")
{
    const auto reportOf = [](const char* hRef) { return Channel({{"constant/hRef", "value 0;", hRef}, pressureOfOutlet("type prghTotalPressure; p0 uniform 3;")}, 0.55).report(); };
    const std::string bed = reportOf("value 0;"), top = reportOf("value 1;"), far = reportOf("value -4;");
    if (!isSerial()) return;
    CHECK(!has(bed, "Warning"));
    CHECK(!has(top, "Warning"));
    CHECK(has(far, "Warning: the pressures that patches give to gas differ by 50 Pa"));   // 1 kg/m^3, 10 m/s^2, of 4 m below the bed and of 1 m of the outlet
    CHECK(has(far, "it will blow with up to 10 m/s"));
}

TEST_CASE("a table that will blow the gas through the mesh is warned of, for the time of its largest pressure")
{
    const Channel rising({pressureOfOutlet("type uniformFixedValue; uniformValue table ((0 3) (8 803) (16 3)); value uniform 3;")}, 0.55);
    const std::string before = rising.report(0.1), all = rising.report(16), longRun = rising.report(160);
    if (!isSerial()) return;
    CHECK(!has(before, "Warning"));     // 10 Pa, a free overfall's
    CHECK(has(all, "Warning: at t = 8 s the pressures that patches give to gas will differ by 800 Pa"));
    CHECK(has(all, "it will blow with up to 40 m/s"));
    CHECK(has(longRun, "Warning: at t = 8 s"));
}

TEST_CASE("the pressure of water outside blows no gas: at a patch below the level, and where water enters")
{
    const FoamCase::Edit rising = pressureOfOutlet("type uniformFixedValue; uniformValue table ((0 803) (8 1603)); value uniform 3;");
    const auto reportOf = [&](const char* entering, double level) { return Channel({rising, {"0/alpha.water", "outlet { type zeroGradient; }", entering}}, level).report(8); };
    const std::string below = reportOf("outlet { type zeroGradient; }", 2), enters = reportOf("outlet { type fixedValue; value uniform 1; }", 0.55), gas = reportOf("outlet { type zeroGradient; }", 0.55);
    if (!isSerial()) return;
    CHECK(!has(below, "Warning"));
    CHECK(!has(enters, "Warning"));
    CHECK(has(gas, "Warning: the pressures that patches give to gas differ by 800 Pa"));
}
