// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/patchReport.H"

#include "equations/patchInflow.hpp"
#include "foam/dictionaryChecks.H"

#include <cmath>

namespace flotsam
{

namespace
{

constexpr double muchWind = 2;      // of the pressure difference that a free overfall makes
constexpr int nLooksAhead = 20;     // at tables of pressures
constexpr double muchGas = 0.1;     // of what enters: where a surface is smeared over elements some enters below it

void say(const std::string& line) { Foam::Info << line.c_str() << Foam::nl; }

void reportInflow(const CaseControls& controls, const BoundaryPatch& patch, const PatchInflow& in)
{
    if (in.all == 0) return;
    const std::string& liquid = controls.liquidName;
    say(text("Patch ", patch.name, ": ", std::abs(in.all), in.all > 0 ? " m^3/s enter" : " m^3/s leave",
        controls.fluid.isTwoPhase ? text(", ", std::abs(in.liquid), " of them ", liquid) : ""));
    if (in.gasAtLiquid <= muchGas*std::abs(in.all)) return;
    say(text("Warning: patch ", patch.name, " lets in ", in.gasAtLiquid, " m^3/s of gas where ", liquid, " stands at it. Give ", controls.alphaName,
        " there: variableHeightFlowRate, zeroGradient, or fixedValue 1 below the level (docs/dictionaries.md, Boundary conditions)"));
}

void reportLevel(const CaseControls& controls, const BoundaryPatch& patch, double level)
{
    say(text("Patch ", patch.name, ": ", std::isinf(level) ? text("no ", controls.liquidName, " outside")
                                                           : text("pressure of ", controls.liquidName, " outside up to a height of ", level, " m")));
}

bool isWindy(const GasPressures& gas) { return gas.spread > muchWind*gas.ofHeight; }

void reportWind(const FluidProperties& fluid, const GasPressures& gas)
{
    say(text("Warning: the pressures that patches give to gas differ by ", gas.spread, " Pa from those of gas at rest: it will blow with up to ", std::sqrt(2*gas.spread/fluid.rhoGas),
        " m/s. Where that is not meant: constant/hRef is a height within the mesh (patches with p_rgh and with prghTotalPressure, a full pressure, fit together only then), and p0 is the same everywhere"));
}

void reportLaterWind(const FluidProperties& fluid, const GasPressures& gas, double time)
{
    say(text("Warning: at t = ", time, " s the pressures that patches give to gas will differ by ", gas.spread, " Pa from those of gas at rest: it will blow with up to ", std::sqrt(2*gas.spread/fluid.rhoGas),
        " m/s. A pressure that changes (a level outside that rises or falls) must act on liquid alone: through a patch of its own below the lowest level, with a wall above it"
        " (docs/dictionaries.md, Outflow with a water level that changes)"));
}

/// At the start, else at the worst of some later times: pressures may be tables.
void checkWind(const CaseControls& controls, const SimplexMesh& mesh, const Halo& halo, const std::vector<BoundaryPatch>& patches, const std::vector<double>& alpha,
    double time, double endTime)
{
    const FluidProperties& fluid = controls.fluid;
    if (fluid.rhoGas <= 0) return;
    GasPressures worst = gasPressures(mesh, halo, patches, fluid, alpha, time);
    if (isWindy(worst)) return reportWind(fluid, worst);
    double when = time;
    for (int k = 1; k <= nLooksAhead; ++k)
    {
        const double later = time + k*(endTime - time)/nLooksAhead;
        const GasPressures gas = gasPressures(mesh, halo, patches, fluid, alpha, later);
        if (gas.spread <= worst.spread) continue;
        worst = gas;
        when = later;
    }
    if (isWindy(worst)) reportLaterWind(fluid, worst, when);
}

} // namespace

void reportPatches(const CaseControls& controls, const MeshAdapter& adapter, const Halo& halo, const std::vector<BoundaryPatch>& patches, const FlowState& state,
    const Cover* cover, double time, double endTime)
{
    const SimplexMesh& mesh = adapter.mesh;
    for (const BoundaryPatch& patch : patches)
    {
        if (patch.velocity != BoundaryPatch::Velocity::Fixed || !patch.evaluate) continue;
        PatchValues values;
        patch.evaluate({time, state.u.data(), state.alpha.data(), cover}, values);
        if (!halo.any(!values.velocity.empty())) continue;
        reportInflow(controls, patch, prescribedInflow(mesh, halo, patch, values, state, cover));
    }
    const auto& g = controls.fluid.gravity;
    if (controls.fluid.rhoLiquid > controls.fluid.rhoGas && std::hypot(g[0], g[1], g[2]) > 0) // else there is no level
    {
        const std::vector<double> levels = outsideLevels(mesh, halo, patches, controls.fluid, time);
        for (std::size_t p = 0; p < patches.size(); ++p)
            if (patches[p].pressure != BoundaryPatch::Pressure::Natural) reportLevel(controls, patches[p], levels[p]);
        checkWind(controls, mesh, halo, patches, state.alpha, time, endTime);
    }
    Foam::Info << Foam::endl;
}

} // namespace flotsam
