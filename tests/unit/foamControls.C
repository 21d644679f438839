// SPDX-License-Identifier: GPL-3.0-or-later
/// Controls: defaults, OpenFOAM's own forms of entries, and one message for every mistake.
#include "foam/controlsReader.H"
#include "foam/dictionaryChecks.H"
#include "foam/editedControls.H"
#include "support/foamCase.H"
#include "support/near.hpp"

#include "OStringStream.H"

#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

bool has(const std::string& s, const std::string& part)
{
    const bool found = s.find(part) != std::string::npos;
    if (!found) MESSAGE("message was: " << s);
    return found;
}

std::string transportMessage(const std::string& contents)
{
    return messageOf([&] { CaseControls c; readTransport(parse(contents), c); });
}

std::string numericsMessage(const std::string& contents)
{
    return messageOf([&] { readNumerics(parse("flotsam { " + contents + " }")); });
}

const std::string water = "water { transportModel Newtonian; nu 1e-06; rho 1000; } ", air = "air { nu [0 2 -1 0 0 0 0] 1.48e-05; rho rho [1 -3 0 0 0 0 0] 1; } ";

}

TEST_CASE("no sub-dictionary flotsam: every number has its default; what is given is taken")
{
    const NumericsControls none = readNumerics(parse("PIMPLE {}")), byDefault;
    CHECK(none.nitscheGamma == byDefault.nitscheGamma);
    CHECK(none.maxIterations == byDefault.maxIterations);
    const NumericsControls given = readNumerics(parse("flotsam { nitsche off; gravityLayers 3; ghostPressure 0.2; }"));
    CHECK_FALSE(given.nitsche);
    CHECK(given.gravityLayers == 3);
    CHECK(given.ghostPressure == 0.2);
    CHECK(given.ghostVelocity == byDefault.ghostVelocity);
}

TEST_CASE("what is printed reads back as the same numbers")
{
    NumericsControls numerics;
    numerics.nitsche = false;
    numerics.densityClip = 0.01;
    numerics.restart = 55;
    CHECK(changedNumerics(NumericsControls()).empty());
    CHECK(changedNumerics(numerics) == "nitsche off, densityClip 0.01, restart 55");
    Foam::OStringStream os;
    writeNumerics(os, numerics);
    CHECK(has(os.str(), "[default " + std::to_string(NumericsControls().restart) + "]"));
    const NumericsControls back = readNumerics(parse(os.str()));
    CHECK(back.nitsche == numerics.nitsche);
    CHECK(back.densityClip == numerics.densityClip);
    CHECK(back.restart == numerics.restart);
    CHECK(back.tolerance == numerics.tolerance);
}

TEST_CASE("misspelt and out of range")
{
    const std::string misspelt = numericsMessage("nitscheGama 5;");
    CHECK(has(misspelt, "nitscheGama"));
    CHECK(has(misspelt, "Did you mean: nitscheGamma"));
    const std::string range = numericsMessage("timeOrder 3;");
    CHECK(has(range, "timeOrder"));
    CHECK(has(range, "is 3"));
    CHECK(has(range, "from 1 to 2"));
    CHECK(has(range, "BDF2"));
    CHECK(has(numericsMessage("tolerance 0;"), "larger than 0"));
    CHECK(has(numericsMessage("restart many;"), "Entry 'restart' is 'many', but must be a whole number from 2 to 1000"));
    CHECK(has(numericsMessage("nitsche maybe;"), "Entry 'nitsche' is 'maybe', but must be on or off"));
}

TEST_CASE("nearest words")
{
    CHECK(editDistance("gravityLayers", "gravityLayer") == 1);
    CHECK(editDistance("tolrenace", "tolerance") > 1);
    CHECK(editDistance("raidus", "radius") == 1);
    CHECK(nearestWords("raidus", {"size", "radius", "end1"}) == std::vector<std::string>{"radius"});
    CHECK(nearestWords("xyzzy", {"size", "radius"}).empty());
}

TEST_CASE("controlDict: what looks like a known entry that is not there is found, everything else left alone")
{
    const auto found = [](const std::string& dict) { return misspeltEntries(parse(dict), controlDictEntries()); };
    using Pairs = std::vector<std::pair<std::string, std::string>>;
    CHECK(found("maxBodyC0 0.2;") == Pairs{{"maxBodyC0", "maxBodyCo"}});
    CHECK(found("maxbodyco 0.2;") == Pairs{{"maxbodyco", "maxBodyCo"}});
    CHECK(found("maxBodyCourant 0.2;") == Pairs{{"maxBodyCourant", "maxBodyCo"}});
    CHECK(found("adjustTimestep yes;") == Pairs{{"adjustTimestep", "adjustTimeStep"}});
    CHECK(found("adjustableTimeStep yes; function { a { type probes; } }") == Pairs{{"function", "functions"}});
    CHECK(found("deltaT 1; deltaT2 1; endTime 3; endTimeLong 4; maxDi 2; h 0.1; U0 1; co 3; \"max.*\" 1; functions { maxco { type probes; } }").empty());
}

TEST_CASE("fvSolution: entries of flotsam that stand elsewhere are found, those of OpenFOAM left alone")
{
    using Pairs = std::vector<std::pair<std::string, std::string>>;
    CHECK(misplacedNumerics(parse("PIMPLE { nCorrectors 3; flotsam { nitsche off; } } solvers { p { tolerance 1e-6; maxIter 3; } } flotsam { nitsche off; }")) == Pairs{{"PIMPLE", "flotsam"}});
    CHECK(misplacedNumerics(parse("nitscheGamma 3; PISO { timeOrder 1; }")) == Pairs{{"the file itself", "nitscheGamma"}, {"PISO", "timeOrder"}});
    CHECK(misplacedNumerics(parse("tolerance 1; solvers { \".*\" { tolerance 1e-6; restart 3; } } PIMPLE { maxIterations 4; } flotsam { timeOrder 1; }")).empty());
}

TEST_CASE("two fluids as interFoam: the first phase is the liquid, entries with and without dimensions")
{
    CaseControls c;
    readTransport(parse("phases (water air); " + water + air + "sigma 0.07;"), c);
    CHECK(c.fluid.isTwoPhase);
    CHECK(c.alphaName == "alpha.water");
    CHECK(c.fluid.rhoLiquid == 1000);
    CHECK(c.fluid.rhoGas == 1);
    CHECK(c.fluid.muLiquid == near(1e-3, 1e-14));
    CHECK(c.fluid.muGas == near(1.48e-5, 1e-14));
    CHECK(c.fluid.sigma == 0.07);
}

TEST_CASE("one fluid as icoFoam")
{
    CaseControls c;
    readTransport(parse("nu [0 2 -1 0 0 0 0] 0.01;"), c);
    CHECK_FALSE(c.fluid.isTwoPhase);
    CHECK_FALSE(c.hasDensity);
    CHECK(c.alphaName.empty());
    CHECK(c.fluid.rhoLiquid == 1);
    CHECK(c.fluid.muLiquid == 0.01);
    readTransport(parse("nu 1e-6; rho 1000;"), c);
    CHECK(c.hasDensity);
    CHECK(c.fluid.muLiquid == near(1e-3, 1e-14));
}

TEST_CASE("transport: what is not modelled or contradictory is said")
{
    CHECK(has(transportMessage("phases (water air); water { transportModel CrossPowerLaw; nu 1; rho 1; }" + air), "CrossPowerLaw is not modelled"));
    CHECK(has(transportMessage("phases (air water); " + water + air), "list the liquid first"));
    CHECK(has(transportMessage("phases (water air oil); " + water + air), "give two"));
    CHECK(has(transportMessage("phases (liquid air); " + water + air), "names liquid, of which there is no dictionary"));
    CHECK(has(transportMessage("phases (water air); " + water + "air { nu 1e-5; rho -1; }"), "rho"));
    CHECK(has(transportMessage("phases (water air); water { nu 1e-6; } " + air), "Entry 'rho' is missing: it must be a number larger than 0"));
    CHECK(has(transportMessage("phases (water air); water { nu 1e-6; rho heavy; } " + air), "Entry 'rho' is 'heavy', but must be a number"));
    CHECK(has(transportMessage("phases water; " + water + air), "Entry 'phases' is 'water', but must be a list of words"));
    CHECK(has(transportMessage("sigma 0;"), "Neither 'phases' nor 'nu'"));
    CHECK(has(messageOf([] { checkLaminar(parse("simulationType RAS;")); }), "allowed: laminar"));
    CHECK(has(messageOf([] { checkLaminar(parse("simulationType laminar; laminar { laminarModel Maxwell; }")); }), "allowed: Stokes"));
    CHECK(messageOf([] { checkLaminar(parse("simulationType laminar;")); }).empty());
}

TEST_CASE("time controls: the smaller of maxCo and maxAlphaCo counts; a fixed step stays fixed")
{
    const TimeControls t = readTimeControls(parse("deltaT 0.01; adjustTimeStep yes; maxCo 0.4; maxAlphaCo 0.2; maxDeltaT 0.05;"));
    CHECK(t.adjustTimeStep);
    CHECK(t.maxCo == 0.2);
    CHECK(t.maxDeltaT == 0.05);
    CHECK_FALSE(readTimeControls(parse("deltaT 0.01;")).adjustTimeStep);
    CHECK(has(messageOf([] { readTimeControls(parse("deltaT 0.01; maxCo -1;")); }), "larger than 0"));
    CHECK(has(messageOf([] { readTimeControls(parse("deltaT 0.01; maxCo half;")); }), "Entry 'maxCo' is 'half', but must be a number larger than 0"));
    CHECK(has(messageOf([] { readTimeControls(parse("deltaT 0.01; adjustTimeStep maybe;")); }), "Entry 'adjustTimeStep' is 'maybe', but must be on or off"));
    CHECK(has(messageOf([] { readTimeControls(parse("maxCo 0.5;")); }), "Entry 'deltaT' is missing: it must be a number larger than 0"));
    CHECK(has(messageOf([] { readTimeControls(parse("deltaT 0.01; minDeltaT 1; maxDeltaT 0.1;")); }), "larger than maxDeltaT"));
}

TEST_CASE("a whole case")
{
    FoamCase scene("foamChannel");
    const CaseControls c = readCaseControls(scene.time());
    CHECK(c.fluid.gravity[1] == -10);
    CHECK(c.numerics.timeOrder == 1);
    CHECK_FALSE(c.numerics.dualCellTransport);
    CHECK(c.time.maxCo == 0.3);
    CHECK(c.fluid.pRefValue == 5);
    CHECK(has(messageOf([] { checkUnused("dynamicMeshDict", parse("dynamicFvMesh dynamicMotionSolverFvMesh;")); }), "allowed: staticFvMesh"));
    CHECK(has(messageOf([] { checkUnused("fvOptions", parse("porous { type explicitPorositySource; }")); }), "fvOptions is not available"));
    CHECK(messageOf([] { checkUnused("fvOptions", parse("porous { active no; }")); }).empty());
    scene.edit({"constant/turbulenceProperties", "laminar", "LES"});
    CHECK(has(messageOf([&] { readCaseControls(scene.time()); }), "LES is not modelled"));
}

TEST_CASE("a mistake in controlDict while the run goes on is told once and changes nothing")
{
    EditedControls edited(readTimeControls(parse("deltaT 0.01; maxCo 0.5;")));
    CHECK(edited.update(parse("deltaT 0.01; maxCo 0.5;")).empty());
    CHECK(has(edited.update(parse("deltaT 0.01; maxCo 0.7; adjustTimeStep yes;")), "system/controlDict was changed: time step adaptive"));
    CHECK(edited.now().maxCo == 0.7);
    const std::string told = edited.update(parse("deltaT 0.01; maxCo half; adjustTimeStep no;"));
    CHECK(has(told, "Warning: system/controlDict was changed, to what cannot be used: Entry 'maxCo' is 'half', but must be a number larger than 0.\nThe time step stays adaptive"));
    CHECK(edited.now().maxCo == 0.7);
    CHECK(edited.now().adjustTimeStep);
    CHECK(edited.update(parse("deltaT 0.01; maxCo half; adjustTimeStep no;")).empty());
    CHECK(has(edited.update(parse("deltaT 0.01; maxCo -1;")), "'maxCo' is -1"));
    CHECK(edited.update(parse("deltaT 0.01; maxCo 0.7; adjustTimeStep yes;")).empty());     // what it was
    CHECK(has(edited.update(parse("deltaT 0.01; maxCo half;")), "'maxCo' is 'half'"));
}

TEST_CASE("fvSolution edited while the run goes on: that `flotsam` stays what it was is said once")
{
    EditedNumerics numerics(parse("flotsam { tolerance 1e-4; } solvers { }"));
    CHECK(numerics.update(parse("flotsam { tolerance 1e-4; } solvers { p { tolerance 1; } }")).empty());
    CHECK(has(numerics.update(parse("flotsam { tolerance 1e-6; }")), "`flotsam` of system/fvSolution was changed. This run keeps what it has started with"));
    CHECK(numerics.update(parse("flotsam { tolerance 1e-6; }")).empty());
    CHECK(numerics.update(parse("flotsam { tolerance 1e-4; }")).empty());
    CHECK_FALSE(numerics.update(parse("")).empty());
}

TEST_CASE("controlDict: times that are no numbers, and far more time folders than meant")
{
    const auto message = [](const std::string& contents) { return messageOf([&] { checkTimeEntries(parse(contents)); }); };
    const auto has = [](const std::string& s, const std::string& part) { return s.find(part) != std::string::npos; };
    CHECK(message("").empty());
    CHECK(message("deltaT 0.01; endTime 4;").empty());
    CHECK(message("deltaT 0.01; stopAt writeNow;").empty());
    CHECK(has(message("endTime 4;"), "'deltaT' is missing: it must be a number larger than 0"));
    CHECK(has(message("deltaT small; endTime 4;"), "'deltaT' is 'small', but must be a number larger than 0"));
    CHECK(has(message("deltaT 0; endTime 4;"), "'deltaT' is 0: it must be larger than 0"));
    CHECK(has(message("deltaT 0.01; endTime late;"), "'endTime' is 'late', but must be a number, the time in s at which the run ends"));
    CHECK(has(message("deltaT 0.01;"), "'endTime' is missing"));
    CHECK(has(message("deltaT 0.01; stopAt endTime;"), "'endTime' is missing"));
    CHECK(has(message("deltaT 0.01; endTime 4; startFrom startTime;"), "'startTime' is missing"));
    CHECK(has(message("deltaT 0.01; endTime 4; adjustTimeStep maybe;"), "'adjustTimeStep' is 'maybe', but must be on or off"));
    CHECK(has(message("deltaT 0.01; endTime 4; writeInterval 0;"), "'writeInterval' is 0"));
    const auto doubt = [](const std::string& contents, double start = 0) { return doubtfulWriting(parse("endTime 4; " + contents), start); };
    CHECK(doubt("writeControl adjustableRunTime; writeInterval 0.001;").empty());
    CHECK(doubt("writeControl timeStep; writeInterval 1;").empty());
    CHECK(has(doubt("writeControl adjustableRunTime; writeInterval 1e-7;"), "writeInterval 1e-07 s of system/controlDict makes 4e+07 time folders"));
    CHECK(doubt("writeControl adjustableRunTime; writeInterval 1e-7;", 3.9999).empty());     // whatever startTime says: startFrom latestTime
}
