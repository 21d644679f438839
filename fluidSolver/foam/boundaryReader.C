// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/boundaryReader.H"
#include "foam/dictionaryChecks.H"
#include "foam/fieldEntry.H"
#include "foam/otherInput.H"

#include "Time.H"
#include "localIOdictionary.H"
#include "vector.H"

namespace flotsam
{

namespace
{

/// A field file as it stands, without making the field: conditions unknown to OpenFOAM's libraries can be named too.
class RawField
{
public:
    RawField(const Foam::polyMesh& mesh, const std::string& name, const Foam::word& type)
    :
        mesh_(mesh),
        dict_(Foam::IOobject(name, mesh.time().timeName(), mesh, Foam::IOobject::MUST_READ, Foam::IOobject::NO_WRITE, false), type)
    {
        type == "volVectorField" ? checkFieldEntry<Foam::vector>(dict_, "internalField", mesh.nCells(), "cells of the mesh")
                                 : checkFieldEntry<Foam::scalar>(dict_, "internalField", mesh.nCells(), "cells of the mesh");
        const auto strays = strayPatches(subGroup(dict_, "boundaryField"), mesh.boundaryMesh());
        if (!strays.empty())
            Foam::Info<< "Warning: " << mesh.time().timeName() << '/' << name.c_str() << " has conditions for what is no patch of the mesh: " << describeStray(strays, mesh.boundaryMesh()).c_str()
                << ". They are not used" << Foam::nl;
    }

    /// Entry of a patch by name, then group (last wins), then pattern: the order in which OpenFOAM reads fields.
    const Foam::dictionary& patch(const Foam::polyPatch& patch) const
    {
        const Foam::dictionary& boundary = subGroup(dict_, "boundaryField");
        if (boundary.found(patch.name(), Foam::keyType::LITERAL)) return subGroup(boundary, patch.name());
        for (auto entry = boundary.crbegin(); entry != boundary.crend(); ++entry)
            if (entry->isDict() && entry->keyword().isLiteral() && patch.inGroups().found(entry->keyword())) return entry->dict();
        if (!boundary.found(patch.name()))
        {
            const auto strays = strayPatches(boundary, mesh_.boundaryMesh());
            failIn(boundary, text("Patch '", patch.name(), "' of the mesh has no condition.", strays.empty() ? "" : text("\n    Not of the mesh: ", describeStray(strays, mesh_.boundaryMesh()))));
        }
        return subGroup(boundary, patch.name());
    }

    Foam::dimensionSet dimensions() const { return readAs<Foam::dimensionSet>(dict_, "dimensions", "dimensions in square brackets, for instance [0 1 -1 0 0 0 0] of a velocity"); }
    const Foam::dictionary& dict() const { return dict_; }

private:
    const Foam::polyMesh& mesh_;
    Foam::localIOdictionary dict_;
};

bool hasField(const Foam::polyMesh& mesh, const Foam::word& name)
{
    Foam::IOobject io(name, mesh.time().timeName(), mesh, Foam::IOobject::MUST_READ, Foam::IOobject::NO_WRITE, false);
    return io.typeHeaderOk<Foam::localIOdictionary>(false);
}

void checkDimensions(const RawField& field, const std::string& name, const Foam::dimensionSet& allowed)
{
    if (field.dimensions() != allowed)
        failIn(field.dict(), text(name, " has dimensions ", toString(field.dimensions()), "; allowed: ", toString(allowed), "."));
}

/// Factor that makes the file's pressures Pa (kinematic pressures of a single fluid: its density).
double pressureScale(const RawField& field, const CaseControls& controls)
{
    if (field.dimensions() == Foam::dimPressure) return 1;
    if (field.dimensions() == Foam::dimPressure/Foam::dimDensity && !controls.fluid.isTwoPhase) return controls.fluid.rhoLiquid;
    failIn(field.dict(), text("The pressure has dimensions ", toString(field.dimensions()), "; allowed: [1 -1 -2 0 0 0 0] (Pa)",
        controls.fluid.isTwoPhase ? "." : " or [0 2 -2 0 0 0 0] (kinematic, single fluid)."));
}

void checkCombination(const BoundaryPatch& patch, const Foam::dictionary& velocity, const Foam::dictionary& pressure, const std::string& pressureName)
{
    if (patch.velocity == BoundaryPatch::Velocity::Open || patch.pressure == BoundaryPatch::Pressure::Natural) return;
    failIn(pressure, text("Patch ", patch.name, ": U is '", velocity.get<Foam::word>("type"), "' and ", pressureName, " is '",
        pressure.get<Foam::word>("type"), "': both are prescribed.\n    Where the velocity is prescribed use fixedFluxPressure or zeroGradient for ",
        pressureName, ";\n    where the pressure is prescribed use pressureInletOutletVelocity, inletOutlet or zeroGradient for U."));
}

/// All conditions of a patch sit behind one function: values of the three fields. The phase first: flow rates of the liquid depend on what enters.
std::function<void(const BoundaryState&, PatchValues&)> evaluator(const VelocityCondition& velocity, NodalValues pressure, NodalValues phase)
{
    return [=](const BoundaryState& state, PatchValues& values)
    {
        BoundaryState known = state;
        known.liquidInflow = velocity.liquidInflow ? velocity.liquidInflow(state.time) : 0;
        phase ? phase(known, values.alpha) : values.alpha.clear();
        known.entering = phase ? values.alpha.data() : nullptr;
        velocity.values ? velocity.values(known, values.velocity) : values.velocity.clear();
        pressure ? pressure(state, values.pressure) : values.pressure.clear();
    };
}

struct PatchSource { const Foam::polyPatch* patch; std::shared_ptr<const PatchNodes> nodes; };

std::vector<PatchSource> patchSources(const Foam::polyMesh& mesh, const MeshAdapter& adapter, const Halo& halo)
{
    std::vector<PatchSource> sources;
    for (const MeshPatch& meshPatch : adapter.mesh.patches)
    {
        const Foam::label id = mesh.boundaryMesh().findPatchID(meshPatch.name);
        if (id < 0) FatalErrorInFunction << "No patch " << meshPatch.name.c_str() << " in the mesh." << Foam::exit(Foam::FatalError);
        sources.push_back({&mesh.boundaryMesh()[id], std::make_shared<PatchNodes>(makePatchNodes(adapter.mesh, halo, meshPatch))});
    }
    return sources;
}

/// Ranks without a face of the patch must not say no.
bool isNoSlipWallAnywhere(const PatchSource& source, const RawField& velocity, const Halo& halo)
{
    return !halo.any(!isNoSlipWall(velocity.patch(*source.patch), *source.patch));
}

/// Folder of the start time, whatever its number is written like (0 with timeFormat scientific); empty: there is none.
Foam::fileName startFolder(const Foam::Time& runTime)
{
    if (Foam::isDir(runTime.timePath())) return runTime.timePath();
    for (const Foam::instant& time : runTime.times())
        if (time.name() != runTime.constant() && time.equal(runTime.value())) return runTime.path()/time.name();
    return {};
}

/// startTime may name a time that is not there.
void checkTimeFolder(const Foam::Time& runTime)
{
    if (!startFolder(runTime).empty()) return;
    std::string there;
    for (const Foam::instant& time : runTime.times())
        if (time.name() != runTime.constant()) there += ' ' + time.name();
    FatalErrorInFunction << "Time folder " << runTime.timePath() << " is missing; there are:" << (there.empty() ? " none" : there.c_str()) << Foam::nl
        << "    Set startFrom and startTime in system/controlDict, or copy 0.orig to 0." << Foam::exit(Foam::FatalError);
}

/// A serial run that takes its latest time while processor folders hold later ones would run them once more and write over their histories.
void checkProcessorTimes(const Foam::Time& runTime)
{
    if (Foam::Pstream::parRun() || runTime.controlDict().getOrDefault<Foam::word>("startFrom", "latestTime") != "latestTime") return;
    const Foam::instantList times = Foam::Time::findTimes(runTime.path()/"processor0", runTime.constant());
    if (times.empty() || times.last().value() <= runTime.value() + 1e-12*std::abs(times.last().value())) return;
    FatalErrorInFunction << "Folder " << runTime.path()/"processor0" << " holds time " << times.last().name() << ", later than the latest time here, " << runTime.timeName()
        << ": this run would compute what is there once more, over the histories in postProcessing." << Foam::nl
        << "    reconstructPar -latestTime brings that time here; remove the processor folders, or set startFrom startTime, to begin again at " << runTime.timeName() << '.'
        << Foam::exit(Foam::FatalError);
}

/// Latest time before the start time with a file of that name; empty: none. Function objects leave folders with what they write alone.
Foam::word earlierTimeWith(const Foam::Time& runTime, const std::string& name)
{
    Foam::word found;
    for (const Foam::instant& time : runTime.times())
    {
        const Foam::fileName file = runTime.path()/time.name()/name;
        if (time.name() != runTime.constant() && time.value() < runTime.value() && (Foam::isFile(file) || Foam::isFile(file + ".gz"))) found = time.name();
    }
    return found;
}

/// The field's file, and what it is for.
void checkPhaseFile(const Foam::polyMesh& mesh, const std::string& name)
{
    const Foam::fileName folder = startFolder(mesh.time());
    if (Foam::isFile(folder/name) || Foam::isFile(folder/(name + ".gz"))) return;
    if (const Foam::word earlier = earlierTimeWith(mesh.time(), name); !earlier.empty())
        FatalErrorInFunction << "Time " << mesh.time().timeName() << " has no " << name.c_str() << ", time " << earlier << " has: is it a function object's folder?" << Foam::nl
            << "    Set startFrom startTime; startTime " << earlier << "; in system/controlDict, or remove folder " << mesh.time().timePath() << '.' << Foam::exit(Foam::FatalError);
    FatalErrorInFunction << "File " << mesh.time().timePath()/name << " is missing: the volume fraction of the liquid, first of phases in transportProperties." << Foam::nl
        << "    Give it as interFoam does, e.g. dimensions [0 0 0 0 0 0 0]; internalField uniform 0; and fill it with setFields, setExprFields or setAlphaField."
        << Foam::exit(Foam::FatalError);
}

} // namespace

std::string pressureFieldName(const Foam::polyMesh& mesh, const CaseControls& controls)
{
    checkTimeFolder(mesh.time());
    checkProcessorTimes(mesh.time());
    if (controls.fluid.isTwoPhase) checkPhaseFile(mesh, controls.alphaName);
    if (hasField(mesh, "p_rgh")) return "p_rgh";
    if (controls.fluid.isTwoPhase)
        FatalErrorInFunction << "File " << mesh.time().timePath()/"p_rgh" << " is missing: two fluids are solved as in interFoam, "
            << "with p_rgh = p - rho g.x as pressure field." << Foam::exit(Foam::FatalError);
    return "p";
}

std::vector<BoundaryPatch> readBoundary(const Foam::polyMesh& mesh, const MeshAdapter& adapter, const Halo& halo, const CaseControls& controls)
{
    const std::string pressureName = pressureFieldName(mesh, controls);
    const RawField velocity(mesh, "U", "volVectorField");
    const RawField pressure(mesh, pressureName, "volScalarField");
    std::unique_ptr<RawField> phase;
    if (controls.fluid.isTwoPhase) phase = std::make_unique<RawField>(mesh, controls.alphaName, "volScalarField");
    checkDimensions(velocity, "U", Foam::dimVelocity);
    if (phase) checkDimensions(*phase, controls.alphaName, Foam::dimless);
    const double scale = pressureScale(pressure, controls);

    const auto sources = patchSources(mesh, adapter, halo);
    std::vector<BoundaryPatch> result;
    for (std::size_t i = 0; i < sources.size(); ++i)
    {
        const Foam::polyPatch& patch = *sources[i].patch;
        const auto input = [&](const RawField& field, const std::string& name, double factor)
        {
            return ConditionInput{field.patch(patch), patch, adapter, halo, controls, sources[i].nodes, name, factor};
        };
        const bool isNoSlip = isNoSlipWallAnywhere(sources[i], velocity, halo);   // before values are read
        const auto u = makeVelocityCondition(input(velocity, "U", 1));
        const auto p = makePressureCondition(input(pressure, pressureName, scale));
        const auto a = phase ? makePhaseCondition(input(*phase, controls.alphaName, 1)) : PhaseCondition();

        BoundaryPatch out;
        out.name = patch.name();
        out.isNoSlipWall = isNoSlip;
        out.meshPatch = static_cast<int>(i);
        out.velocity = isNoSlip && controls.numerics.wallGamma > 0 ? BoundaryPatch::Velocity::NoSlip : u.kind;
        out.pressure = p.kind;
        out.phase = a.kind;
        out.nodes = sources[i].nodes->nodes;
        out.jumps = u.jumps;
        out.evaluate = evaluator(u, p.values, a.values);
        checkCombination(out, velocity.patch(patch), pressure.patch(patch), pressureName);
        result.push_back(std::move(out));
    }
    return result;
}

std::string describe(const BoundaryPatch& patch, bool isTwoPhase)
{
    static const char* velocity[] = {"prescribed", "slip", "no-slip", "open"};
    static const char* pressure[] = {"from the flow", "prescribed", "total pressure where fluid enters"};
    static const char* phase[] = {"from the flow", "prescribed where fluid enters"};
    return text(patch.name, ": velocity ", patch.isNoSlipWall && patch.velocity == BoundaryPatch::Velocity::Fixed ? "no-slip at the nodes" : velocity[static_cast<int>(patch.velocity)],
        ", pressure ", pressure[static_cast<int>(patch.pressure)], isTwoPhase ? text(", phase ", phase[static_cast<int>(patch.phase)]) : "");
}

} // namespace flotsam
