// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/transportReader.H"

#include "foam/dictionaryChecks.H"

#include "dimensionedTypes.H"

#include <optional>

namespace flotsam
{

namespace
{

/// A number, also with dimensions before it. meaning: of the entry, where they are others.
double readDimensioned(const Foam::dictionary& dict, const char* keyword, const Foam::dimensionSet& dims, const char* meaning, const Range& range = positive)
{
    const std::string what = text("a number ", toString(range));
    const Foam::ITstream& given = valueOf(dict, keyword, what);
    if (given.empty() || !given.last().isNumber()) failValue(dict, keyword, what);
    const bool didThrow = Foam::FatalIOError.throwExceptions();
    std::optional<double> value;
    try { value = Foam::dimensionedScalar(keyword, dims, dict).value(); }
    catch (const Foam::IOerror&) {}
    Foam::FatalIOError.throwExceptions(didThrow);
    if (!value) failValue(dict, keyword, text(what, ", alone or behind the dimensions ", toString(dims), ": it is ", meaning));
    checkRange(dict, keyword, *value, range);
    return *value;
}

double readDensity(const Foam::dictionary& dict) { return readDimensioned(dict, "rho", Foam::dimDensity, "the density in kg/m^3"); }

double readViscosity(const Foam::dictionary& dict) { return readDimensioned(dict, "nu", Foam::dimViscosity, "the kinematic viscosity in m^2/s, the dynamic one over rho"); }

void checkNewtonian(const Foam::dictionary& dict)
{
    const std::string model = readWordOr(dict, "transportModel", "Newtonian");
    if (model != "Newtonian")
        failIn(dict, text("transportModel ", model, " is not modelled; allowed: Newtonian. Give a constant nu."));
}

void warnSurfaceTension(double sigma)
{
    Foam::Info << "Warning: surface tension sigma = " << sigma << " N/m is ignored: not modelled "
               << "(negligible when waves and bodies are much larger than some millimetres)" << Foam::nl;
}

} // namespace

void readTwoFluids(const Foam::dictionary& transport, CaseControls& controls)
{
    const std::vector<std::string> phases = readWords(transport, "phases");
    if (phases.size() != 2)
        failIn(transport, text("Entry 'phases' lists ", phases.size(), " names; give two: (liquid gas), the liquid first."));
    FluidProperties& fluid = controls.fluid;
    double* rho[2] = {&fluid.rhoLiquid, &fluid.rhoGas};
    double* mu[2] = {&fluid.muLiquid, &fluid.muGas};
    for (int i = 0; i < 2; ++i)
    {
        if (!transport.isDict(phases[i])) failIn(transport, text("Entry 'phases' names ", phases[i], ", of which there is no dictionary: ", phases[i], " { transportModel Newtonian; nu ..; rho ..; }"));
        const Foam::dictionary& phase = subGroup(transport, phases[i]);
        checkNewtonian(phase);
        *rho[i] = readDensity(phase);
        *mu[i] = *rho[i]*readViscosity(phase);
    }
    if (fluid.rhoLiquid < fluid.rhoGas)
        failIn(transport, text("The first of 'phases', ", phases[0], " (rho ", fluid.rhoLiquid, "), is lighter than ", phases[1],
            " (rho ", fluid.rhoGas, "): list the liquid first, and set alpha.", phases[1], " accordingly."));
    fluid.isTwoPhase = true;
    controls.liquidName = phases[0];
    controls.alphaName = "alpha." + phases[0];
    fluid.sigma = transport.found("sigma") ? readDimensioned(transport, "sigma", Foam::dimensionSet(1, 0, -2, 0, 0), "the surface tension in N/m", notNegative) : 0;
    if (fluid.sigma != 0) warnSurfaceTension(fluid.sigma);
}

void readOneFluid(const Foam::dictionary& transport, CaseControls& controls)
{
    checkNewtonian(transport);
    if (!transport.found("nu"))
        failIn(transport, "Neither 'phases' nor 'nu' is given: use 'phases (water air)' with their sub-dictionaries (as interFoam), "
            "or 'nu' and 'rho' of a single fluid.");
    FluidProperties& fluid = controls.fluid;
    controls.hasDensity = transport.found("rho");
    fluid.rhoLiquid = controls.hasDensity ? readDensity(transport) : 1;
    fluid.muLiquid = fluid.rhoLiquid*readViscosity(transport);
    fluid.isTwoPhase = false;
    fluid.rhoGas = fluid.rhoLiquid;
    fluid.muGas = fluid.muLiquid;
    if (!controls.hasDensity)
        Foam::Info << "transportProperties gives no rho: density 1 kg/m^3, pressures are kinematic (as icoFoam)" << Foam::nl;
}

} // namespace flotsam
