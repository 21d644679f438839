// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/startReport.H"

#include "equations/liquidPlace.hpp"
#include "foam/dictionaryChecks.H"

#include <cmath>

namespace flotsam
{

namespace
{

constexpr double lightestLiquid = 50;   // hydrogen: 71 kg/m^3
constexpr double thinnestLiquid = 5e-5; // [Pa s]: carbon dioxide under pressure 7e-5
constexpr double thickGas = 10;         // viscosity over the liquid's: more than dense vapours have

std::string vectorText(const std::array<double, 3>& v, double factor)
{
    return text('(', factor*v[0] + 0.0, ' ', factor*v[1] + 0.0, ' ', factor*v[2] + 0.0, ')');   // + 0: no -0
}

} // namespace

std::vector<std::string> doubtfulFluids(const CaseControls& controls)
{
    const FluidProperties& f = controls.fluid;
    std::vector<std::string> doubts;
    if (!f.isTwoPhase) return doubts;
    if (f.rhoLiquid == f.rhoGas)
        doubts.push_back(text("both fluids have the density ", f.rhoLiquid, " kg/m^3: gravity keeps no surface between them. Is that meant? Water has rho 1000, air 1.2"));
    else if (f.rhoLiquid < lightestLiquid)
        doubts.push_back(text("rho of ", controls.liquidName, " is ", f.rhoLiquid, " kg/m^3, less than that of any liquid. Densities are in kg/m^3, not in g/cm^3 or over water's: water has 1000, air 1.2"));
    else if (f.muLiquid < thinnestLiquid)
        doubts.push_back(text("rho nu of ", controls.liquidName, " is ", f.muLiquid, " Pa s, less than that of any liquid. Is `nu` in m^2/s? Water has 1e-6, which makes 1e-3 Pa s"));
    if (f.muGas > thickGas*f.muLiquid)
        doubts.push_back(text("the gas is far more viscous than ", controls.liquidName, ": rho nu is ", f.muGas, " and ", f.muLiquid, " Pa s. Is `nu` kinematic, in m^2/s? Air has 1.5e-5, water 1e-6"));
    return doubts;
}

void reportStart(const CaseControls& controls, const SimplexMesh& mesh, const Halo& halo, const FlowState& state, bool hasSolids)
{
    const auto& g = controls.fluid.gravity;
    const double strength = std::hypot(g[0], g[1], g[2]);
    if (!controls.fluid.isTwoPhase || strength == 0) return;
    const LiquidPlace place = liquidPlace(mesh, halo, state, g);
    if (place.lowest > place.highest) return;   // none
    Foam::Info<< text("Start: ", place.liquid, " m^3 of ", controls.liquidName, ", ", std::round(1000*place.liquid/(place.liquid + place.gas))/10, " % of the mesh, at heights from ",
        place.lowest, " to ", place.highest, " m of ", place.bottom, " to ", place.top, " m",
        hasSolids ? " (where structures and bodies are, too)" : "").c_str() << Foam::nl;
    if (!hangsFromTop(place, strength)) return;
    Foam::Info<< text("Warning: ", controls.liquidName, " hangs at rest from the top of the mesh, with gas below it: it will fall. Does constant/g, ", vectorText(g, 1),
        ", point downwards? The opposite is ", vectorText(g, -1)).c_str() << Foam::nl;
}

} // namespace flotsam
