// SPDX-License-Identifier: GPL-3.0-or-later
/// The part of RunOutput that writes the run's state and continues it.
#include "demCoupling/foam/runOutput.H"

#include "demCoupling/foam/continuedContact.H"
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

/// Names as numbers, one a line: a state has nothing but numbers.
std::vector<double> codesOf(const std::vector<std::string>& names)
{
    std::vector<double> codes;
    for (const std::string& name : names)
    {
        for (const char c : name) codes.push_back(static_cast<unsigned char>(c));
        codes.push_back('\n');
    }
    return codes;
}

std::vector<double> codesOf(const std::vector<HistoryMember>& members)
{
    std::vector<std::string> names;
    for (const HistoryMember& m : members) names.push_back(m.name);
    return codesOf(names);
}

std::vector<std::string> namesFrom(const std::vector<double>& codes)
{
    std::vector<std::string> names(1);
    for (const double c : codes)
    {
        if (c == '\n') names.emplace_back();
        else names.back() += char(int(c));
    }
    names.pop_back();
    return names;
}

/// First row of rowSize numbers that differs by more than what files round, -1: none.
int differingRow(const std::vector<double>& a, const std::vector<double>& b, std::size_t rowSize)
{
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
        if (std::abs(a[k] - b[k]) > 1e-9*std::max({1e-3, std::abs(a[k]), std::abs(b[k])})) return int(k/rowSize);
    return -1;
}

/// Ends messages about a constant/bodies that does not fit.
const char* const startAnew = "; to start anew from the fields of this time, with the bodies at their places in constant/bodies, remove its flotsamState.h5 and"
    " uniform/flotsamState.h5";

/// The row of a structure that moves has its place at time 0 last, seven numbers: it may begin elsewhere, see jumpingStructure().
void leaveOutPlace(std::vector<double>& rows, const std::vector<double>& other, std::size_t row, std::size_t rowSize)
{
    constexpr std::size_t place = 7;
    const std::size_t end = (row + 1)*rowSize;
    if (end <= std::min(rows.size(), other.size())) std::copy(other.begin() + (end - place), other.begin() + end, rows.begin() + (end - place));
}

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

bool RunOutput::checkStart() const
{
    const StateFiles::Found found = files_.find();
    if (found == StateFiles::Found::Nothing) checkUnfinished();
    if (found == StateFiles::Found::Foreign) failForeign();
    if (found == StateFiles::Found::Own) checkContinued(files_.readOwn());
    if (found == StateFiles::Found::Shared) checkContinued(files_.readShared());
    Foam::Info<< "Start at time " << runTime_.timeName() << ": " << (found == StateFiles::Found::Own ? "the stored state continues, exactly" : found == StateFiles::Found::Shared
        ? "bodies and sums of the stored state continue, the fluid from the written fields" : "anew from the volume fields") << Foam::nl << Foam::endl;
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
    step.restore(std::move(state.flow), state.arrays, CoupledStep::Fields::Exact);
    Foam::Info<< "continuing the stored state of time " << runTime_.timeName() << Foam::endl;
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
    step.restore(std::move(start), state.arrays, isNodal ? CoupledStep::Fields::Nodal : CoupledStep::Fields::Cells);
    if (!isNodal) warnOtherLiquid(step.fluid().liquidVolume());
    if (!isNodal) mass_.initial += step.fluid().liquidVolume() - mass_.final; // what reading the cells changes is no error of the run
    const bool isRewritten = halo_.size() == 1 && Foam::isFile(runTime_.timePath()/"flotsamState.h5"); // by renumberMesh, foamFormatConvert, or on other processes and then copied
    Foam::Info<< "continuing from time " << runTime_.timeName() << (isRewritten ? " on a mesh that was written anew since (another order or other digits of its points)"
        : " on other processes than those that wrote it") << ": bodies, contact and sums exactly; velocity, pressure and "
        << "phase from " << (isNodal ? "the point fields, as accurate as written (writePrecision)" : "the volume fields, as there are no point fields to them: less accurate")
        << "; the first step is of first order in time" << Foam::endl;
}

/// Solids are stored by their numbers: another order would exchange them. Poses come from the state, so that a structure given elsewhere would stay where it was.
void RunOutput::checkMembers(const RunState& state) const
{
    const auto stored = state.arrays.find("members");
    if (stored == state.arrays.end()) return;
    if (stored->second == codesOf(members_))
    {
        const auto described = state.arrays.find("descriptions");
        if (described == state.arrays.end()) return;
        const std::size_t rowSize = descriptions_.size()/std::max<std::size_t>(members_.size(), 1);
        std::vector<double> rows = described->second;
        for (int s = 0; s < nStructures_; ++s)
            if (bodies_.structures[s].motion) leaveOutPlace(rows, descriptions_, s, rowSize);
        const int other = differingRow(rows, descriptions_, rowSize);
        if (other >= 0)
            throw std::runtime_error("restart: constant/bodies is not that of the stored state of time " + runTime_.timeName() + ": mass, volume, extent"
                + std::string(members_[other].isStructure ? " or place" : "") + " of '" + members_[other].name + "' differ. Continue with what it was" + startAnew);
        return;
    }
    const std::vector<std::string> names = namesFrom(stored->second);
    std::size_t first = 0;
    while (first < names.size() && first < members_.size() && names[first] == members_[first].name) ++first;
    const auto quoted = [](bool isThere, const std::string& name) { return isThere ? "'" + name + "'" : std::string("none"); };
    throw std::runtime_error("restart: constant/bodies is not that of the stored state of time " + runTime_.timeName() + ", which has " + std::to_string(names.size())
        + " structures and bodies; now there are " + std::to_string(members_.size()) + ". The first that differs was " + quoted(first < names.size(), first < names.size() ? names[first] : "")
        + ", is " + quoted(first < members_.size(), first < members_.size() ? members_[first].name : "")
        + ". Continue with those of the stored state" + startAnew);
}

/// A folder that was given another name is of that time.
double RunOutput::timeOf(const RunState& state) const
{
    return Foam::Time::timeName(state.flow.time) == runTime_.timeName() ? state.flow.time : runTime_.value();
}

/// What is prescribed may change while the run goes on, but not so that a structure is elsewhere at once.
void RunOutput::checkMotions(const RunState& state) const
{
    const auto solids = state.arrays.find("solids");
    if (solids == state.arrays.end()) return;
    const std::string jump = jumpingStructure(bodies_, solids->second, timeOf(state));
    if (!jump.empty())
        throw std::runtime_error("restart: constant/bodies does not go on from the stored state of time " + runTime_.timeName() + ": structure " + jump
            + ". Continue with the motion it had, or with one that has it there then (`position` is that of time 0)" + startAnew);
    const std::string held = bodiesHeldAgain(bodies_, solids->second, timeOf(state));
    if (!held.empty())
        Foam::Info<< "Warning: constant/bodies is not that of the stored state of time " << runTime_.timeName() << ": " << held.c_str() << ".\n" << Foam::endl;
}

/// They are stored by their numbers. What they are made of may change while the run goes on; the state of a run without any takes up new ones.
void RunOutput::checkRestraints(const RunState& state) const
{
    const auto stored = state.arrays.find("restraintNames");
    if (stored == state.arrays.end() || stored->second == codesOf(restraints_.names())) return;
    throw std::runtime_error("restart: constant/bodies is not that of the stored state of time " + runTime_.timeName() + ", whose restraints are " + joined(namesFrom(stored->second))
        + "; now they are " + (bodies_.restraints.empty() ? "none" : joined(restraints_.names())) + ". Continue with those of the stored state, in its order (to let go of a body give its restraint a small"
        " breakingForce)" + startAnew);
}

/// Contact is stored by the numbers of what touches. Where bodies start is of no more consequence: said, as the edit was meant to have one. States of earlier versions know neither.
void RunOutput::checkContact(const RunState& state) const
{
    const std::string begin = "constant/bodies is not that of the stored state of time " + runTime_.timeName() + ": ";
    const auto names = state.arrays.find("contactNames"), sizes = state.arrays.find("contactSizes"), starts = state.arrays.find("bodyStarts");
    if (names != state.arrays.end() && sizes != state.arrays.end())
    {
        const std::string change = changedContact({namesFrom(names->second), sizes->second}, contactParts(bodies_));
        if (!change.empty()) throw std::runtime_error("restart: " + begin + change + ". Continue with what it was (`wallPatches`, `contact`)" + startAnew);
    }
    const std::string moved = starts == state.arrays.end() ? "" : bodiesStartedElsewhere(bodies_, starts->second);
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

void RunOutput::checkContinued(const RunState& state) const
{
    checkMembers(state);
    checkMotions(state);
    checkContact(state);
    checkRestraints(state);
    warnOtherFluid(state);
}

void RunOutput::takeSums(RunState& state)
{
    checkContinued(state);
    state.flow.time = timeOf(state);
    mass_ = {state.scalars["initialLiquid"], state.scalars["inflow"], state.scalars["outflow"], state.scalars["liquid"]};
    steps_ = firstStep_ = long(state.scalars["steps"]);
    redistributed_ = state.scalars["redistributed"];
    timeStep_ = state.scalars["timeStep"];
    lastStep_ = state.flow.dt;
    firstStart_ = state.scalars["firstStart"];
    largestOverlap_ = state.scalars["largestOverlap"];
    forces_.restore(state.arrays["forces"]);
    restraints_.restore(state.arrays["restraints"]);
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
    state.arrays["members"] = codesOf(members_);
    state.arrays["descriptions"] = descriptions_;
    if (!bodies_.bodies.empty())
    {
        const ContactParts parts = contactParts(bodies_);
        state.arrays["contactNames"] = codesOf(parts.names);
        state.arrays["contactSizes"] = parts.sizes;
        state.arrays["bodyStarts"] = bodyStarts(bodies_);
    }
    state.scalars = {{"initialLiquid", mass_.initial}, {"inflow", mass_.inflow}, {"outflow", mass_.outflow}, {"liquid", mass_.final},
        {"steps", double(steps_)}, {"redistributed", redistributed_}, {"timeStep", timeStep}, {"firstStart", firstStart_},
        {"largestOverlap", largestOverlap_}};
    files_.write(std::move(state), names);
    if (!history_) return;
    history_->flush();
    writeScene(step);
}

} // namespace flotsam
