// SPDX-License-Identifier: GPL-3.0-or-later
/// The part of RunOutput that writes the run's state and continues it.
#include "demCoupling/foam/runOutput.H"

#include "demCoupling/foam/continuedContact.H"
#include "demCoupling/foam/continuedMembers.H"
#include "demCoupling/foam/continuedMotion.H"
#include "foam/dictionaryChecks.H"
#include "io/fluidRecord.hpp"

#include "OSspecific.H"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

std::vector<double> memberCodes(const std::vector<HistoryMember>& members)
{
    std::vector<std::string> names;
    for (const HistoryMember& m : members) names.push_back(m.name);
    return codesOf(names);
}

/// Ends messages about a constant/bodies that does not fit.
const char* const startAnew = "; to start anew from the fields of this time, with the bodies at their places in constant/bodies, remove its flotsamState.h5 and"
    " uniform/flotsamState.h5";

/// What tells a mesh from others, however many processes share it: number of nodes, means of their coordinates and of the squares of these.
std::vector<double> meshRecord(const SimplexMesh& mesh, const Halo& halo)
{
    std::vector<double> record(1 + 2*mesh.dim, 0.0);
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        for (int d = 0; d < mesh.dim; ++d)
        {
            const double x = mesh.x[std::size_t(i)*mesh.dim + d];
            record[1 + d] += x/mesh.nGlobal;
            record[1 + mesh.dim + d] += x*x/mesh.nGlobal;
        }
    }
    halo.sum(record.data(), int(record.size()));
    record[0] = double(mesh.nGlobal);
    return record;
}

/// By more than round-off of sums and of files.
bool isOtherMesh(const std::vector<double>& a, const std::vector<double>& b)
{
    if (a.size() != b.size() || a[0] != b[0]) return true;
    const std::size_t dim = (a.size() - 1)/2;
    const double square = *std::max_element(b.begin() + 1 + dim, b.end());
    for (std::size_t k = 1; k < a.size(); ++k)
        if (std::abs(a[k] - b[k]) > 1e-7*(k > dim ? square : std::sqrt(square))) return true;
    return false;
}

} // namespace

/// flotsamFoam wrote this time, but its state was left behind.
void RunOutput::warnAnew() const
{
    Foam::Info<< "Warning: time " << runTime_.timeName() << " has fields of flotsamFoam, but no flotsamState.h5, nor one in its folder 'uniform': the run"
        << " does not continue, it starts anew from these fields" << (members_.size() > std::size_t(nStructures_) ? ", with the bodies at their places in constant/bodies" : "")
        << ".\n    To continue, copy that file of the time it was written at to " << runTime_.timeName() << "/uniform.\n" << Foam::endl;
}

void RunOutput::failForeign() const
{
    throw std::runtime_error("restart: flotsamState.h5 of time " + runTime_.timeName() + " was written by other processes, and uniform/flotsamState.h5,"
        " which any number of them can continue from, is missing there. Continue on the processes that wrote it, put that file back"
        " (from the same time of processor0 or of the whole case), or remove all flotsamState.h5 of this time to start anew from its fields");
}

/// Fields alone would begin another run, with the bodies where they once started.
void RunOutput::checkUnfinished() const
{
    if (!halo_.any(Foam::isFile(runTime_.timePath()/"flotsamState.h5.tmp"))) return;
    throw std::runtime_error("restart: the state of time " + runTime_.timeName() + " was not written to its end (flotsamState.h5.tmp; a full disk?). Remove the folder "
        + runTime_.timeName() + " to continue from the time before, or that file to start anew from the fields");
}

bool RunOutput::checkStart()
{
    const StateFiles::Found found = files_.find();
    if (found == StateFiles::Found::Nothing) checkUnfinished();
    if (found == StateFiles::Found::Foreign) failForeign();
    if (found == StateFiles::Found::Own) checkContinued(files_.readOwn());
    if (found == StateFiles::Found::Shared) checkContinued(files_.readShared());
    Foam::Info<< "Start at time " << runTime_.timeName() << ": " << (found == StateFiles::Found::Own ? "the stored state continues, exactly" : found == StateFiles::Found::Shared
        ? "bodies and sums of the stored state continue, the fluid from the written fields" : "anew from the volume fields") << Foam::endl;
    if (found != StateFiles::Found::Nothing) reportAdded();
    Foam::Info<< Foam::endl;
    return found != StateFiles::Found::Nothing;
}

bool RunOutput::readState(CoupledStep& step, const FoamFields& fields)
{
    switch (files_.find())
    {
        case StateFiles::Found::Nothing:
            checkUnfinished();
            if (halo_.any(Foam::isFile(runTime_.timePath()/"pointU"))) warnAnew();
            return false;
        case StateFiles::Found::Foreign: failForeign();
        case StateFiles::Found::Own: continueOwn(step, fields); break;
        case StateFiles::Found::Shared: continueShared(step, fields); break;
    }
    return true;
}

void RunOutput::continueOwn(CoupledStep& step, const FoamFields& fields)
{
    RunState state = files_.readOwn();
    takeSums(state);
    if (!fields.agreesWithCells(state.flow))
        Foam::Info<< "Warning: the volume fields of time " << runTime_.timeName() << " were changed since flotsamFoam wrote them. The changes do not count: the run"
            << " continues its stored state.\n    To have them count, remove " << runTime_.timeName() << "/flotsamState.h5 (in parallel of every processor*).\n" << Foam::endl;
    step.restore(std::move(state.flow), state.arrays, CoupledStep::Fields::Exact, stored_);
    Foam::Info<< "continuing the stored state of time " << runTime_.timeName() << Foam::endl;
    takeDisplaced(step);
}

/// Solids, contact and sums as stored, the fluid from the written fields.
void RunOutput::continueShared(CoupledStep& step, const FoamFields& fields)
{
    RunState state = files_.readShared();
    takeSums(state);
    warnOtherMesh(state);
    FlowState start;
    const bool isNodal = fields.readNodes(start);
    if (!isNodal) fields.readStart(start);
    start.time = state.flow.time;
    step.restore(std::move(start), state.arrays, isNodal ? CoupledStep::Fields::Nodal : CoupledStep::Fields::Cells, stored_);
    const double read = step.fluid().liquidVolume() + step.displaced();
    if (!isNodal) warnOtherLiquid(read);
    if (!isNodal) mass_.initial += read - mass_.final; // what reading the cells changes is no error of the run
    const bool isRewritten = halo_.size() == 1 && Foam::isFile(runTime_.timePath()/"flotsamState.h5"); // by renumberMesh, foamFormatConvert, or on other processes and then copied
    Foam::Info<< "continuing from time " << runTime_.timeName() << (isRewritten ? " on a mesh that was written anew since (another order or other digits of its points)"
        : " on other processes than those that wrote it") << ": bodies, contact and sums exactly; velocity, pressure and "
        << "phase from " << (isNodal ? "the point fields, as accurate as written (writePrecision)" : "the volume fields, as there are no point fields to them: less accurate")
        << "; the first step is of first order in time" << Foam::endl;
    takeDisplaced(step);
}

void RunOutput::failToContinue(const std::string& reason) const
{
    throw std::runtime_error("restart: constant/bodies does not go on from the stored state of time " + runTime_.timeName() + ": " + reason + startAnew);
}

/// Solids and restraints are stored by their numbers: their names tell which are meant.
void RunOutput::findMembers(const RunState& state)
{
    const auto names = state.arrays.find("members"), restraints = state.arrays.find("restraintNames"), described = state.arrays.find("descriptions");
    stored_ = {};
    if (names != state.arrays.end())
    {
        const int nStructures = described == state.arrays.end() ? nStructures_ : describedStructures(described->second);
        const MatchedMembers match = matchMembers(namesFrom(names->second), nStructures, bodies_);
        if (!match.refusal.empty()) failToContinue(match.refusal);
        stored_ = match.stored;
    }
    if (restraints == state.arrays.end()) return;
    const std::string refusal = matchRestraints(namesFrom(restraints->second), bodies_, stored_);
    if (!refusal.empty()) failToContinue(refusal);
}

/// Poses come from the state, so that a structure given elsewhere would stay where it was.
void RunOutput::checkDescriptions(const RunState& state, const BodiesInput& part) const
{
    const auto described = state.arrays.find("descriptions");
    if (described == state.arrays.end()) return;
    const std::string other = otherDescription(described->second, part);
    if (!other.empty())
        throw std::runtime_error("restart: constant/bodies is not that of the stored state of time " + runTime_.timeName() + ": " + other + ". Continue with what it was" + startAnew);
}

/// The bodies of the state have moved since constant/bodies had them at their start.
void RunOutput::checkPlaces(const RunState& state) const
{
    const auto solids = state.arrays.find("solids");
    const std::string conflict = addedInPlaceOfOthers(bodies_, stored_, solids == state.arrays.end() ? std::vector<double>() : solids->second, timeOf(state));
    if (!conflict.empty()) failToContinue(conflict);
}

void RunOutput::reportAdded() const
{
    const std::string added = addedMembers(bodies_, stored_);
    if (!added.empty()) Foam::Info<< "New in constant/bodies, not in the stored state: " << added.c_str() << ". They begin now, where constant/bodies has them" << Foam::endl;
}

/// As at the start of a run, liquid that lies in solids is none: what gives way is neither lost nor comes up elsewhere.
void RunOutput::takeDisplaced(const CoupledStep& step)
{
    reportAdded();
    constexpr double negligible = 1e-9; // of the liquid: traces in the gas
    mass_.displaced += step.displaced();
    if (!(step.displaced() > negligible*mass_.final)) return;
    Foam::Info<< text(step.displaced(), fluid_.isTwoPhase ? " m^3 of liquid" : " m^3 of fluid", " gave way to what is new, of ", mass_.final, ": gone, as liquid that lies in bodies at a start").c_str() << Foam::endl;
}

/// A folder that was given another name is of that time.
double RunOutput::timeOf(const RunState& state) const
{
    return Foam::Time::timeName(state.flow.time) == runTime_.timeName() ? state.flow.time : runTime_.value();
}

/// What is prescribed may change while the run goes on, but not so that a structure is elsewhere at once.
void RunOutput::checkMotions(const RunState& state, const BodiesInput& part) const
{
    const auto solids = state.arrays.find("solids");
    if (solids == state.arrays.end()) return;
    const std::string jump = jumpingStructure(part, solids->second, timeOf(state));
    if (!jump.empty())
        failToContinue("structure " + jump + ". Continue with the motion it had, or with one that has it there then (`position` is that of time 0)");
    const std::string held = bodiesHeldAgain(part, solids->second, timeOf(state));
    if (!held.empty())
        Foam::Info<< "Warning: constant/bodies is not that of the stored state of time " << runTime_.timeName() << ": " << held.c_str() << ".\n" << Foam::endl;
}

/// Contact is stored by the numbers of what touches. Where bodies start is of no more consequence: said, as the edit was meant to have one. States of earlier versions know neither.
void RunOutput::checkContact(const RunState& state, const BodiesInput& part) const
{
    const std::string begin = "constant/bodies is not that of the stored state of time " + runTime_.timeName() + ": ";
    const auto names = state.arrays.find("contactNames"), sizes = state.arrays.find("contactSizes"), starts = state.arrays.find("bodyStarts");
    if (names != state.arrays.end() && sizes != state.arrays.end())
    {
        const std::string change = changedContact({namesFrom(names->second), sizes->second, {}}, contactParts(part));
        if (!change.empty()) throw std::runtime_error("restart: " + begin + change + ". Continue with what it was (`wallPatches`, `contact`)" + startAnew);
    }
    const std::string moved = starts == state.arrays.end() ? "" : bodiesStartedElsewhere(part, starts->second);
    if (!moved.empty()) Foam::Info<< "Warning: " << begin.c_str() << moved.c_str() << ". The change does not count: bodies go on from where the state has them.\n" << Foam::endl;
}

/// The state's own properties are in its pressure, velocities and loads alone: it goes on with others, which may be meant.
void RunOutput::warnOtherFluid(const RunState& state) const
{
    const auto stored = state.arrays.find("fluid");
    const std::string changes = stored == state.arrays.end() ? "" : changedFluid(stored->second, fluid_);
    if (changes.empty()) return;
    Foam::Info<< "Warning: the stored state of time " << runTime_.timeName() << " was computed with other properties: " << changes.c_str()
        << ".\n    The run goes on with those of constant/transportProperties and constant/g as they are now; pressure and loads change with the first step\n" << Foam::endl;
}

/// OpenFOAM takes fields of any mesh with as many cells.
void RunOutput::warnOtherMesh(const RunState& state) const
{
    const auto stored = state.arrays.find("mesh");
    if (stored == state.arrays.end() || !isOtherMesh(stored->second, meshRecord(mesh_, halo_))) return;
    Foam::Info<< "Warning: the mesh is not that of the stored state of time " << runTime_.timeName() << ": its points lie elsewhere. Each keeps its values, as if the water had moved along"
        << ".\n    Where that is not meant: put the mesh back, or start anew on the new one from mapped fields (mapFields)\n" << Foam::endl;
}

/// Volume fields of another order of the cells pass for ones that were changed.
void RunOutput::warnOtherLiquid(double volume) const
{
    constexpr double ofReading = 0.02;  // what taking cells for nodes may change, and more
    if (std::abs(volume - mass_.final) <= ofReading*mass_.final) return;
    Foam::Info<< text("Warning: the fields of time ", std::string(runTime_.timeName()), " hold ", volume, " m^3 of liquid, the stored state ", mass_.final, " m^3. Where they were not changed on purpose (setFields),"
        " the mesh was written anew in another order than theirs (renumberMesh renumbers the fields of one time alone): put the mesh back.\n").c_str() << Foam::endl;
}

void RunOutput::checkContinued(const RunState& state)
{
    findMembers(state);
    const BodiesInput part = storedPart(bodies_, stored_);
    checkDescriptions(state, part);
    checkMotions(state, part);
    checkContact(state, part);
    checkPlaces(state);
    warnOtherFluid(state);
}

void RunOutput::takeSums(RunState& state)
{
    checkContinued(state);
    state.flow.time = timeOf(state);
    mass_ = {state.scalars["initialLiquid"], state.scalars["inflow"], state.scalars["outflow"], state.scalars["liquid"], state.scalars["displaced"]};
    steps_ = firstStep_ = long(state.scalars["steps"]);
    redistributed_ = state.scalars["redistributed"];
    timeStep_ = state.scalars["timeStep"];
    lastStep_ = state.flow.dt;
    firstStart_ = state.scalars["firstStart"];
    largestOverlap_ = state.scalars["largestOverlap"];
    forces_.restore(rowsWith(stored_.structures, state.arrays["forces"], forces_.values()));
    restraints_.restore(rowsWith(stored_.restraints, state.arrays["restraints"], restraints_.values()));
}

void RunOutput::writeState(const CoupledStep& step, double timeStep)
{
    RunState state;
    state.flow = step.fluid().state();
    state.arrays = step.save();
    const std::map<std::string, std::vector<double>> ofProcess = step.saveOfProcess();
    std::vector<std::string> names;
    for (const auto& array : ofProcess) names.push_back(array.first);
    state.arrays.insert(ofProcess.begin(), ofProcess.end());
    state.arrays["forces"] = forces_.values();
    if (!bodies_.restraints.empty())
    {
        state.arrays["restraints"] = restraints_.values();
        state.arrays["restraintNames"] = codesOf(restraints_.names());
    }
    state.arrays["fluid"] = fluidRecord(fluid_);
    state.arrays["mesh"] = meshRecord(mesh_, halo_);
    state.arrays["members"] = memberCodes(members_);
    state.arrays["descriptions"] = describe(bodies_);
    if (!bodies_.bodies.empty())
    {
        const ContactParts parts = contactParts(bodies_);
        state.arrays["contactNames"] = codesOf(parts.names);
        state.arrays["contactSizes"] = parts.sizes;
        state.arrays["contactFinest"] = parts.finest;
        state.arrays["bodyStarts"] = bodyStarts(bodies_);
    }
    state.scalars = {{"initialLiquid", mass_.initial}, {"inflow", mass_.inflow}, {"outflow", mass_.outflow}, {"liquid", mass_.final},
        {"steps", double(steps_)}, {"redistributed", redistributed_}, {"timeStep", timeStep}, {"firstStart", firstStart_},
        {"largestOverlap", largestOverlap_}, {"displaced", mass_.displaced}};
    files_.write(std::move(state), names);
    if (!history_) return;
    history_->flush();
    writeScene(step);
}

} // namespace flotsam
