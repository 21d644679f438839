// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/controlsReader.H"
#include "foam/dictionaryChecks.H"
#include "foam/otherInput.H"
#include "foam/transportReader.H"

#include "IFstream.H"
#include "IOdictionary.H"
#include "OSspecific.H"
#include "uniformDimensionedFields.H"

#include <algorithm>
#include <memory>
#include <variant>

namespace flotsam
{

namespace
{

using NumericsMember = std::variant<double NumericsControls::*, int NumericsControls::*, bool NumericsControls::*>;

/// One entry of the sub-dictionary.
struct ControlEntry
{
    const char* keyword;
    NumericsMember member;
    Range range;
    const char* meaning; ///< printed beside the value and as the hint of an error
};

const Range anyValue{0, 1};

const std::vector<ControlEntry>& controlsTable()
{
    using N = NumericsControls;
    static const std::vector<ControlEntry> table{
        {"timeOrder", &N::timeOrder, {1, 2}, "1: BDF1, 2: BDF2"},
        {"surfaceTimeOrder", &N::surfaceTimeOrder, {1, 2}, "order in time of the inertia where the surface passes"},
        {"tauFactor", &N::tauFactor, {0, 10, true}, "tau of SUPG and PSPG over Tezduyar's where inertia counts"},
        {"tauContFactor", &N::tauContFactor, {0, 100}, "multiplies the continuity stabilisation"},
        {"penaltyRate", &N::penaltyRate, {0, 1e9}, "largest 1/dt that grad-div and the normal penalty on solids count, over sqrt(g/element length); without gravity a third of it counts, over the largest speed/element length"},
        {"tauContBulk", &N::tauContBulk, {0, 1}, "share of the time step in tau_cont in elements of one density"},
        {"tauContWithTimeStep", &N::tauContWithTimeStep, anyValue, "on: time step within the stabilisation time; off: steady form"},
        {"viscousResidual", &N::viscousResidual, anyValue, "on: viscous force in the residual of SUPG and PSPG; off: without"},
        {"nitsche", &N::nitsche, anyValue, "on: Nitsche condition on solids; off: pure penalty (entry penalty)"},
        {"nitscheGamma", &N::nitscheGamma, {0, 1e6}, "coefficient of mu/h of the Nitsche condition"},
        {"separation", &N::separation, {0, 10}, "no-slip solids take this much of what the pressure takes where an unresolved stream along them slows down"},
        {"wallInflow", &N::wallInflow, {0, 1}, "share of the term that gives fluid which enters through the wall of a solid the velocity of that"},
        {"wallGamma", &N::wallGamma, {0, 1e6}, "the same on no-slip patches where their layer is resolved (0: velocity prescribed at the nodes)"},
        {"wallLaw", &N::wallLaw, anyValue, "on: at least the traction of a turbulent layer on no-slip patches; off: of the resolved flow alone"},
        {"wallRoughness", &N::wallRoughness, {0, 1e3}, "sand roughness of no-slip patches in the wall law [m]"},
        {"mixingDepth", &N::mixingDepth, {0, 1e4}, "depth of a turbulent stream over no-slip patches, for its eddy viscosity; 0: none [m]"},
        {"penalty", &N::penalty, {0, 1e12, true}, "pure penalty coefficient [Pa s/m], used with nitsche off"},
        {"ghostVelocity", &N::ghostVelocity, {0, 100}, "ghost penalty of the velocity, viscous scale"},
        {"ghostConvection", &N::ghostConvection, {0, 100}, "ghost penalty of the velocity, convective scale"},
        {"ghostPressure", &N::ghostPressure, {0, 100}, "ghost penalty of the pressure"},
        {"dualCellTransport", &N::dualCellTransport, anyValue, "on: conservative dual-cell transport of the phase; off: SUPG form"},
        {"interfaceWidth", &N::interfaceWidth, {0.1, 5}, "interface thickness over element length"},
        {"mobility", &N::mobility, {0, 10}, "phase field mobility over the largest speed, optional model flux"},
        {"profileKeeping", &N::profileKeeping, {0, 100}, "rate at which the profile is restored, over sqrt(g/element length); 0: by the flow alone"},
        {"transportCourant", &N::transportCourant, {0, 1, true}, "limit of a transport sub-step: dt outflow/volume"},
        {"densityClip", &N::densityClip, {0, 0.2}, "phase values this near to 0 and 1 count as pure fluid in density and viscosity"},
        {"balancedGravity", &N::balancedGravity, anyValue, "on: gravity exactly balanced at rest; off: element mean density"},
        {"gravityLayers", &N::gravityLayers, {0, 100}, "rings of elements over which interface planes are handed on"},
        {"gasDepth", &N::gasDepth, {0, 1000}, "rings of elements around the water in which the gas is computed; 0: everywhere"},
        {"criticalInlet", &N::criticalInlet, anyValue, "on: a level that floats at an inlet does not fall below the critical one; off: it is that inside"},
        {"tolerance", &N::tolerance, {0, 0.1, true}, "relative residual of the linear solve"},
        {"forceTolerance", &N::forceTolerance, {0, 1, true}, "with solids or wallForces: residual of the linear solve over the forces that change the motion"},
        {"carryRemainder", &N::carryRemainder, anyValue, "on: what a linear solve leaves is carried into the next step; off: forgotten"},
        {"maxIterations", &N::maxIterations, {1, 100000}, "of the linear solve; a step that needs more is repeated smaller"},
        {"restart", &N::restart, {2, 1000}, "Krylov vectors kept at most"},
        {"contactTolerance", &N::contactTolerance, {0, 1, true}, "relative change of the contact impulse that ends the repeats"},
        {"maxContactRepeats", &N::maxContactRepeats, {0, 1000}, "fluid-contact repeats of one step"},
        {"contactTrial", &N::contactTrial, {0, 0.5}, "residual of the solves that a new contact load is likely to follow, over what that changes; 0: the tolerances'"},
        {"demTimeStep", &N::demTimeStep, {0, 1}, "contact sub-step [s]; 0: from stiffness and masses"},
    };
    return table;
}

double numberOf(const NumericsControls& numerics, const NumericsMember& member)
{
    return std::visit([&](auto m) { return static_cast<double>(numerics.*m); }, member);
}

void readEntry(const Foam::dictionary& dict, const ControlEntry& entry, NumericsControls& numerics)
{
    if (auto* number = std::get_if<double NumericsControls::*>(&entry.member))
        numerics.**number = readNumberOr(dict, entry.keyword, numerics.**number, entry.range, entry.meaning);
    else if (auto* count = std::get_if<int NumericsControls::*>(&entry.member))
        numerics.**count = readCountOr(dict, entry.keyword, numerics.**count, entry.range, entry.meaning);
    else
    {
        bool& flag = numerics.*std::get<bool NumericsControls::*>(entry.member);
        flag = readFlagOr(dict, entry.keyword, flag);
    }
}

Foam::IOobject inputFile(const Foam::Time& runTime, const char* name, const Foam::fileName& folder)
{
    return Foam::IOobject(name, folder, runTime, Foam::IOobject::MUST_READ, Foam::IOobject::NO_WRITE, false);
}

bool exists(const Foam::Time& runTime, const char* name)
{
    return Foam::isFile(runTime.path()/runTime.caseConstant()/name) || Foam::isFile(runTime.path()/runTime.constant()/name);
}

/// What is wrong with a uniform field that OpenFOAM could not read; returns where that is something else.
template<class T>
void explain(const Foam::fileName& file, const Foam::dimensionSet& allowed, const std::string& what)
{
    Foam::IFstream stream(file);
    Foam::dictionary dict(stream);
    dict.name() = file;
    readAs<Foam::dimensionSet>(dict, "dimensions", text("dimensions in square brackets, ", toString(allowed)));
    readAs<T>(dict, "value", what);
}

/// A uniform field of the folder constant, in the right dimensions.
template<class T>
T readUniform(const Foam::Time& runTime, const char* name, const Foam::dimensionSet& allowed, const std::string& what)
{
    const Foam::IOobject file = inputFile(runTime, name, runTime.constant());
    const bool didThrow = Foam::FatalIOError.throwExceptions();
    std::unique_ptr<Foam::UniformDimensionedField<T>> field;
    try { field = std::make_unique<Foam::UniformDimensionedField<T>>(file); }
    catch (const Foam::IOerror&)
    {
        Foam::FatalIOError.throwExceptions(didThrow);
        const Foam::fileName own = runTime.path()/runTime.constant()/name, shared = runTime.globalPath()/runTime.constant()/name;
        explain<T>(Foam::isFile(own) ? own : shared, allowed, what);
        throw;
    }
    Foam::FatalIOError.throwExceptions(didThrow);
    if (field->dimensions() != allowed)
        FatalErrorInFunction << "File " << field->objectPath() << ": dimensions " << toString(field->dimensions()).c_str() << "; allowed: "
            << toString(allowed).c_str() << "." << Foam::exit(Foam::FatalError);
    return field->value();
}

void readGravity(const Foam::Time& runTime, CaseControls& controls)
{
    if (!exists(runTime, "g"))
    {
        if (controls.fluid.isTwoPhase)
            FatalErrorInFunction << "File " << runTime.path()/runTime.constant()/"g" << " is missing: two fluids need gravity." << Foam::nl
                << "    Give it as interFoam does: dimensions [0 1 -2 0 0 0 0]; value (0 0 -9.81);" << Foam::exit(Foam::FatalError);
        return;
    }
    const Foam::vector g = readUniform<Foam::vector>(runTime, "g", Foam::dimAcceleration, "a vector in m/s^2, for instance (0 0 -9.81)");
    controls.fluid.gravity = {g.x(), g.y(), g.z()};
    if (!exists(runTime, "hRef")) return;
    const double hRef = readUniform<Foam::scalar>(runTime, "hRef", Foam::dimLength, "a number, the height of a level in m");
    controls.gravityPotentialRef = -Foam::mag(g)*hRef;
}

/// Files that change what interFoam solves and that we have no counterpart for: not even an existing case may lose them silently.
void checkOtherModels(const Foam::Time& runTime)
{
    const Foam::word folders[] = {runTime.constant(), runTime.system()};
    for (const char* name : {"fvOptions", "MRFProperties", "dynamicMeshDict"})
        for (const Foam::word& folder : folders)
        {
            if (!Foam::isFile(runTime.globalPath()/folder/name)) continue;
            checkUnused(name, Foam::IOdictionary(inputFile(runTime, name, folder)));
        }
}

double readReferencePressure(const Foam::dictionary& fvSolution)
{
    for (const char* algorithm : {"PIMPLE", "PISO", "SIMPLE"})
        if (fvSolution.found(algorithm)) return subGroup(fvSolution, algorithm).getOrDefault<Foam::scalar>("pRefValue", 0);
    return 0;
}

/// What OpenFOAM or function objects read is left alone; an entry of ours, or one near it, must not go unnoticed for a slip of the pen.
void warnMisspelt(const Foam::dictionary& dict, const std::string& file, const std::vector<std::string>& known)
{
    for (const auto& [found, meant] : misspeltEntries(dict, known))
        Foam::Info << "Warning: " << file.c_str() << ": nothing reads entry '" << found.c_str() << "'. Did you mean: " << meant.c_str() << " ?" << Foam::nl;
}

/// Entries of `flotsam`, and itself, in the dictionaries beside it. Names that OpenFOAM's solvers know as well are left alone.
void warnMisplaced(const Foam::dictionary& fvSolution)
{
    for (const auto& [place, keyword] : misplacedNumerics(fvSolution))
        Foam::Info<< "Warning: system/fvSolution: nothing reads entry '" << keyword.c_str() << "' in " << place.c_str() << ". It belongs in `flotsam { .. }`, beside PIMPLE and solvers" << Foam::nl;
}

} // namespace

std::vector<std::pair<std::string, std::string>> misplacedNumerics(const Foam::dictionary& fvSolution)
{
    const std::vector<std::string> shared{"tolerance", "maxIterations", "restart", "penalty", "mobility"};
    std::vector<std::string> ours{"flotsam"};
    for (const auto& entry : controlsTable())
        if (std::find(shared.begin(), shared.end(), entry.keyword) == shared.end()) ours.push_back(entry.keyword);
    std::vector<std::pair<std::string, std::string>> found;
    const auto look = [&](const Foam::dictionary& dict, const std::string& place, bool isTop)
    {
        for (const Foam::entry& e : dict)
            if (const std::string keyword(e.keyword()); std::find(ours.begin(), ours.end(), keyword) != ours.end() && !(isTop && keyword == "flotsam")) found.emplace_back(place, keyword);
    };
    look(fvSolution, "the file itself", true);
    for (const Foam::entry& e : fvSolution)
        if (e.isDict() && e.keyword() != "flotsam") look(e.dict(), e.keyword(), false);
    return found;
}

std::vector<std::string> controlDictEntries()
{
    return {"adjustTimeStep", "maxCo", "maxAlphaCo", "maxBodyCo", "maxDeltaT", "minDeltaT", "wallForces",
        // OpenFOAM's
        "application", "startFrom", "startTime", "stopAt", "endTime", "beginTime", "deltaT", "writeControl", "writeInterval", "purgeWrite", "writeFormat",
        "writePrecision", "writeCompression", "writeVersion", "graphFormat", "timeFormat", "timePrecision", "runTimeModifiable", "secondaryWriteControl",
        "secondaryWriteInterval", "libs", "functions", "fileHandler", "profiling", "DebugSwitches", "InfoSwitches", "OptimisationSwitches",
        "DimensionedConstants", "DimensionSets",
        // other solvers': interFoam's relatives
        "maxDi", "maxAcousticCo", "maxFo"};
}

void checkUnused(const std::string& file, const Foam::dictionary& dict)
{
    if (file == "dynamicMeshDict")
    {
        const Foam::word type = dict.getOrDefault<Foam::word>("dynamicFvMesh", "staticFvMesh");
        if (type != "staticFvMesh")
            failIn(dict, text("dynamicFvMesh ", type, " is not available: meshes are fixed; allowed: staticFvMesh.\n    Moving structures are described in "
                "constant/bodies (motion), on a fixed mesh."));
        return;
    }
    for (const Foam::entry& e : dict)
        if (e.isDict() && e.dict().getOrDefault<bool>("active", true))
            failIn(e.dict(), text(file, " is not available: the source or zone '", std::string(e.keyword()), "' would be ignored.\n    Remove it, or set 'active no;'."));
}

void readTransport(const Foam::dictionary& transport, CaseControls& controls)
{
    transport.found("phases") ? readTwoFluids(transport, controls) : readOneFluid(transport, controls);
}

void checkLaminar(const Foam::dictionary& turbulence)
{
    const Foam::word type = turbulence.getOrDefault<Foam::word>("simulationType", "laminar");
    if (type != "laminar")
        failIn(turbulence, text("simulationType ", type, " is not modelled; allowed: laminar.\n    flotsamFoam has no turbulence model: the "
            "stabilised method acts as an implicit large-eddy model on what the mesh resolves. Set 'simulationType laminar;'."));
    if (!turbulence.found("laminar")) return;
    const Foam::dictionary& laminar = subGroup(turbulence, "laminar");
    const Foam::word model = laminar.getOrDefault<Foam::word>("laminarModel", laminar.getOrDefault<Foam::word>("model", "Stokes"));
    if (model != "Stokes") failIn(laminar, text("laminarModel ", model, " is not modelled; allowed: Stokes."));
}

NumericsControls readNumerics(const Foam::dictionary& fvSolution)
{
    NumericsControls numerics;
    if (!fvSolution.found("flotsam")) return numerics;
    const Foam::dictionary& dict = subGroup(fvSolution, "flotsam");
    std::vector<std::string> known;
    for (const auto& entry : controlsTable()) known.push_back(entry.keyword);
    checkKeywords(dict, known);
    for (const auto& entry : controlsTable()) readEntry(dict, entry, numerics);
    if (numerics.mixingDepth > 0 && !numerics.wallLaw)
        failIn(dict, text("mixingDepth ", numerics.mixingDepth, " m: wallLaw is off, the bed would hold next to nothing of the stream. Set wallLaw on, or take mixingDepth out."));
    if (numerics.wallLaw && numerics.wallGamma == 0)
        failIn(dict, text("wallLaw is on and wallGamma is 0, which prescribes the velocity of no-slip patches at the nodes: there is nothing for the law to do.\n"
            "    Give a wallGamma above 0 (default ", NumericsControls().wallGamma, ") or set wallLaw off."));
    return numerics;
}

TimeControls readTimeControls(const Foam::dictionary& controlDict)
{
    TimeControls time;
    time.adjustTimeStep = readFlagOr(controlDict, "adjustTimeStep", false);
    time.deltaT = readNumber(controlDict, "deltaT", positive);
    time.maxCo = readNumberOr(controlDict, "maxCo", time.maxCo, positive);
    time.maxCo = std::min(time.maxCo, readNumberOr(controlDict, "maxAlphaCo", time.maxCo, positive));
    time.maxBodyCo = readNumberOr(controlDict, "maxBodyCo", time.maxBodyCo, positive);
    time.maxDeltaT = readNumberOr(controlDict, "maxDeltaT", time.maxDeltaT, positive);
    time.minDeltaT = readNumberOr(controlDict, "minDeltaT", time.minDeltaT, positive);
    if (time.minDeltaT > time.maxDeltaT)
        failIn(controlDict, text("minDeltaT ", time.minDeltaT, " is larger than maxDeltaT ", time.maxDeltaT, "."));
    return time;
}

Foam::dictionary readControlDict(const Foam::fileName& name)
{
    Foam::dictionary dict;
    dict.name() = name;
    Foam::IFstream file(name);
    if (file.good()) dict.read(file);   // on every rank: code that it may hold (#calc) is compiled together. Time says what is missing
    return dict;
}

namespace
{

bool isWord(const Foam::dictionary& dict, const char* keyword, const std::string& word, bool byDefault)
{
    return dict.found(keyword) ? readWord(dict, keyword) == word : byDefault;
}

} // namespace

void checkTimeEntries(const Foam::dictionary& controlDict)
{
    if (controlDict.empty()) return;    // OpenFOAM says that there is none
    readNumber(controlDict, "deltaT", positive);
    readNumberOr(controlDict, "writeInterval", 1, positive);
    if (isWord(controlDict, "stopAt", "endTime", true)) readAs<Foam::scalar>(controlDict, "endTime", "a number, the time in s at which the run ends");
    if (isWord(controlDict, "startFrom", "startTime", false)) readAs<Foam::scalar>(controlDict, "startTime", "a number, the time in s from which the run goes on");
    readFlagOr(controlDict, "adjustTimeStep", false);
}

std::string doubtfulWriting(const Foam::dictionary& controlDict, double start)
{
    constexpr double most = 1e5;
    const bool isTimed = isWord(controlDict, "writeControl", "adjustableRunTime", false) || isWord(controlDict, "writeControl", "adjustable", false) || isWord(controlDict, "writeControl", "runTime", false);
    if (!isTimed || !controlDict.found("writeInterval") || !controlDict.found("endTime")) return "";
    const double interval = readNumber(controlDict, "writeInterval", positive), end = readAs<Foam::scalar>(controlDict, "endTime", "a number");
    if ((end - start)/interval <= most) return "";
    return text("writeInterval ", interval, " s of system/controlDict makes ", (end - start)/interval, " time folders until endTime, ", end,
        " s, and with writeControl adjustableRunTime no step is longer. It is in s of the run");
}

CaseControls readCaseControls(const Foam::Time& runTime)
{
    CaseControls controls;
    readTransport(Foam::IOdictionary(inputFile(runTime, "transportProperties", runTime.constant())), controls);
    if (exists(runTime, "turbulenceProperties"))
        checkLaminar(Foam::IOdictionary(inputFile(runTime, "turbulenceProperties", runTime.constant())));
    if (exists(runTime, "momentumTransport")) // other OpenFOAM's name of it
        checkLaminar(Foam::IOdictionary(inputFile(runTime, "momentumTransport", runTime.constant())));
    readGravity(runTime, controls);
    checkOtherModels(runTime);
    if (runTime.functionObjects().status() && runTime.controlDict().found("functions")) checkFunctionObjects(subGroup(runTime.controlDict(), "functions"));
    const Foam::IOdictionary fvSolution(inputFile(runTime, "fvSolution", runTime.system()));
    warnMisspelt(fvSolution, "system/fvSolution", {"flotsam", "solvers", "PIMPLE", "PISO", "SIMPLE", "relaxationFactors", "cache", "potentialFlow", "residualControl"});
    warnMisplaced(fvSolution);
    warnMisspelt(runTime.controlDict(), "system/controlDict", controlDictEntries());
    controls.numerics = readNumerics(fvSolution);
    controls.fluid.pRefValue = readReferencePressure(fvSolution);
    controls.time = readTimeControls(runTime.controlDict());
    return controls;
}

std::string changedNumerics(const NumericsControls& numerics)
{
    const NumericsControls byDefault;
    std::vector<std::string> changed;
    for (const auto& entry : controlsTable())
    {
        const double value = numberOf(numerics, entry.member);
        if (value == numberOf(byDefault, entry.member)) continue;
        const bool isFlag = std::holds_alternative<bool NumericsControls::*>(entry.member);
        changed.push_back(text(entry.keyword, ' ', isFlag ? (value != 0 ? "on" : "off") : text(value)));
    }
    return joined(changed);
}

void writeNumerics(Foam::Ostream& os, const NumericsControls& numerics)
{
    const NumericsControls byDefault;
    os << "flotsam" << Foam::nl << "{" << Foam::nl;
    for (const auto& entry : controlsTable())
    {
        const double value = numberOf(numerics, entry.member);
        const bool isFlag = std::holds_alternative<bool NumericsControls::*>(entry.member);
        std::string line = text("    ", entry.keyword, " ");
        line.resize(std::max<std::size_t>(line.size(), 28), ' ');
        line += isFlag ? (value != 0 ? "on;" : "off;") : text(value, ";");
        line.resize(std::max<std::size_t>(line.size(), 40), ' ');
        os << line.c_str() << " // " << entry.meaning;
        if (value != numberOf(byDefault, entry.member))
        {
            const double d = numberOf(byDefault, entry.member);
            os << " [default " << (isFlag ? (d != 0 ? std::string("on") : std::string("off")) : text(d)).c_str() << "]";
        }
        os << Foam::nl;
    }
    os << "}" << Foam::nl;
}

} // namespace flotsam
