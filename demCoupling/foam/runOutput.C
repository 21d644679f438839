// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/runOutput.H"

#include "foam/dictionaryChecks.H"
#include "io/fluidRecord.hpp"

#include "OSspecific.H"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

/// Of curved bodies, for the animated surface [m]: large bodies in few facets, slender and flat ones round.
double facetSize(const BodyDefinition& body)
{
    const std::array<Vec3, 2> b = body.shape->bounds();
    return std::min(0.25*(b[1] - b[0]).maxCoeff(), 0.5*body.thinnest);
}

std::vector<HistoryMember> makeMembers(const BodiesInput& input)
{
    std::vector<HistoryMember> members;
    for (const StructureDefinition& s : input.structures)
        members.push_back({s.solid.name, true, 0, s.solid.shape->moments().volume, s.solid.shape->surface(s.facetSize)});
    for (const BodyDefinition& b : input.bodies)
        members.push_back({b.name, false, b.mass, b.volume, b.shape->surface(facetSize(b))});
    return members;
}

std::vector<std::string> structureNames(const BodiesInput& input)
{
    std::vector<std::string> names;
    for (const StructureDefinition& s : input.structures) names.push_back(s.solid.name);
    return names;
}

/// Names as numbers, one a line: a state has nothing but numbers.
std::vector<double> codesOf(const std::vector<HistoryMember>& members)
{
    std::vector<double> codes;
    for (const HistoryMember& m : members)
    {
        for (const char c : m.name) codes.push_back(static_cast<unsigned char>(c));
        codes.push_back('\n');
    }
    return codes;
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

constexpr int descriptionSize = 15;

/// What must not change in a run, one row of numbers for each structure and body: mass, volume, bounds of the shape; of structures also the pose given.
std::vector<double> describe(const BodiesInput& input)
{
    std::vector<double> rows;
    const auto add = [&](double mass, double volume, const Shape& shape, const Pose& pose)
    {
        const std::array<Vec3, 2> b = shape.bounds();
        rows.insert(rows.end(), {mass, volume, b[0][0], b[0][1], b[0][2], b[1][0], b[1][1], b[1][2], pose.position[0], pose.position[1], pose.position[2],
            pose.orientation.w(), pose.orientation.x(), pose.orientation.y(), pose.orientation.z()});
    };
    for (const StructureDefinition& s : input.structures) add(0, s.solid.shape->moments().volume, *s.solid.shape, s.solid.pose);
    for (const BodyDefinition& b : input.bodies) add(b.mass, b.volume, *b.shape, Pose());
    return rows;
}

/// First row that differs by more than what files round, -1: none.
int differingRow(const std::vector<double>& a, const std::vector<double>& b)
{
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
        if (std::abs(a[k] - b[k]) > 1e-9*std::max({1e-3, std::abs(a[k]), std::abs(b[k])})) return int(k)/descriptionSize;
    return -1;
}

} // namespace

RunOutput::RunOutput(const Foam::Time& runTime, const SimplexMesh& mesh, const Halo& halo, const FluidProperties& fluid, const BodiesInput& bodies,
    const PhaseTimers& timers)
:   runTime_(runTime), mesh_(mesh), halo_(halo), fluid_(fluid), timers_(timers), members_(makeMembers(bodies)),
    descriptions_(describe(bodies)),
    files_(runTime, mesh, halo), log_(timers, runTime.value(), runTime.endTime().value()), forces_(structureNames(bodies)),
    nStructures_(int(bodies.structures.size())), firstStart_(runTime.value()), thinnestBody_(thinnestBody(bodies))
{}

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
    FlowState start;
    const bool isNodal = fields.readNodes(start);
    if (!isNodal) fields.readStart(start);
    start.time = state.flow.time;
    step.restore(std::move(start), state.arrays, isNodal ? CoupledStep::Fields::Nodal : CoupledStep::Fields::Cells);
    if (!isNodal) mass_.initial += step.fluid().liquidVolume() - mass_.final; // what reading the cells changes is no error of the run
    Foam::Info<< "continuing from time " << runTime_.timeName() << " on other processes than those that wrote it: bodies, contact and sums exactly; velocity, pressure and "
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
        const int other = described == state.arrays.end() ? -1 : differingRow(described->second, descriptions_);
        if (other >= 0)
            throw std::runtime_error("restart: constant/bodies is not that of the stored state of time " + runTime_.timeName() + ": mass, volume, extent"
                + std::string(members_[other].isStructure ? " or place" : "") + " of '" + members_[other].name + "' differ. Continue with what it was; to start anew from the"
                " fields of this time, with the bodies at their places in constant/bodies, remove its flotsamState.h5 and uniform/flotsamState.h5");
        return;
    }
    const std::vector<std::string> names = namesFrom(stored->second);
    std::size_t first = 0;
    while (first < names.size() && first < members_.size() && names[first] == members_[first].name) ++first;
    const auto quoted = [](bool isThere, const std::string& name) { return isThere ? "'" + name + "'" : std::string("none"); };
    throw std::runtime_error("restart: constant/bodies is not that of the stored state of time " + runTime_.timeName() + ", which has " + std::to_string(names.size())
        + " structures and bodies; now there are " + std::to_string(members_.size()) + ". The first that differs was " + quoted(first < names.size(), first < names.size() ? names[first] : "")
        + ", is " + quoted(first < members_.size(), first < members_.size() ? members_[first].name : "")
        + ". Continue with those of the stored state; to start anew from the fields of this time, with the bodies at their places in constant/bodies, remove its"
        " flotsamState.h5 and uniform/flotsamState.h5");
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

void RunOutput::checkContinued(const RunState& state) const
{
    checkMembers(state);
    warnOtherFluid(state);
}

void RunOutput::takeSums(RunState& state)
{
    checkContinued(state);
    // a folder that was given another name is of that time
    if (Foam::Time::timeName(state.flow.time) != runTime_.timeName()) state.flow.time = runTime_.value();
    mass_ = {state.scalars["initialLiquid"], state.scalars["inflow"], state.scalars["outflow"], state.scalars["liquid"]};
    steps_ = firstStep_ = long(state.scalars["steps"]);
    redistributed_ = state.scalars["redistributed"];
    timeStep_ = state.scalars["timeStep"];
    lastStep_ = state.flow.dt;
    firstStart_ = state.scalars["firstStart"];
    largestOverlap_ = state.scalars["largestOverlap"];
    forces_.restore(state.arrays["forces"]);
}

void RunOutput::begin(const CoupledStep& step)
{
    last_ = step.records();
    double volume = 0;
    for (int e = 0; e < mesh_.nElements; ++e) volume += mesh_.isOwnedElement[e] ? mesh_.volume[e] : 0;
    meshVolume_ = mesh_.thickness*halo_.sum(volume);
    mass_.final = step.fluid().liquidVolume();
    if (mass_.initial == 0) mass_.initial = mass_.final;
    if (halo_.rank() == 0)
    {
        const Foam::fileName folder = runTime_.globalPath()/"postProcessing"/"flotsam";
        Foam::mkDir(folder);
        history_ = std::make_unique<BodyHistory>(folder/"bodies.h5", members_, runTime_.value());
        history_->append(runTime_.value(), step.records(), scalars(0));
        if (!members_.empty()) history_->writeSurface(runTime_.value(), step.records());
    }
}

double RunOutput::massError() const { return mass_.relativeError(); }

std::vector<std::pair<std::string, double>> RunOutput::scalars(double dt) const
{
    return {{"dt", dt}, {"liquidVolume", mass_.final}, {"inflow", mass_.inflow}, {"outflow", mass_.outflow},
        {"massError", massError()}, {"redistributed", redistributed_}, {"largestOverlap", largestOverlap_}};
}

void RunOutput::record(const CoupledStep& step, const StepResult& result, const std::string& limit, const CourantNumbers& courant)
{
    ++steps_;
    mass_.inflow += mesh_.thickness*result.transport.inflow;
    mass_.outflow += mesh_.thickness*result.transport.outflow;
    mass_.final = step.fluid().liquidVolume();
    redistributed_ += mesh_.thickness*std::abs(result.transport.redistributed);
    unbalanced_ += mesh_.thickness*result.unbalancedVolume;
    limitedFaces_ += result.transport.nLimited;
    if (!result.hasConverged) ++notConverged_;
    if (step.coupling())
    {
        if (result.contactMismatch > 0.1) ++unfinishedContacts_;
        largestOverlap_ = std::max(largestOverlap_, step.coupling()->largestOverlap());
    }
    if (step.cover()) sharedElements_ = std::max(sharedElements_, step.cover()->nSharedElements);
    const std::vector<BodyRecord> records = step.records();
    for (int s = 0; s < nStructures_; ++s)
        forces_.add(s, step.fluid().state().dt, records[s].fluidForce.data(), records[s].contactForce.data());
    if (history_) history_->append(runTime_.value(), records, scalars(step.fluid().state().dt));

    StepReport line;
    line.step = steps_;
    line.time = runTime_.value();
    line.dt = step.fluid().state().dt;
    line.limit = limit;
    line.linearIterations = result.linearIterations;
    line.contactRepeats = result.solves - 1;
    line.massError = massError();
    line.bodiesInContact = step.bodiesInContact();
    line.courant = courant;
    const std::string text = log_.stepLine(line);
    Foam::Info<< text.c_str() << Foam::flush;
    reportComings(records);
    reportSqueezed(step);
    reportOverlap(step);
    for (const std::string& waiting : result.waiting) Foam::Info<< waiting.c_str() << Foam::endl;
}

/// Once.
void RunOutput::reportSqueezed(const CoupledStep& step)
{
    constexpr double negligible = 1e-6;     // of the mesh
    if (isSqueezedReported_ || unbalanced_ <= negligible*meshVolume_) return;
    isSqueezedReported_ = true;
    const std::string where = step.fluid().describeSqueezed();
    if (where.empty()) return;
    Foam::Info<< "t = " << runTime_.value() << " s: structure " << where.c_str() << " changes the volume of fluid that nothing lets in or out. Gas makes room, and where"
        " there is none liquid appears elsewhere in the mesh. Was a way out meant? Leave a gap of an element, or an open patch" << Foam::endl;
}

std::string RunOutput::overlapAdvice(const BodyCoupling* bodies) const
{
    if (!bodies || bodies->largestOverlap() <= RunLog::deepOverlap*thinnestBody_ || bodies->deepestPair().empty()) return "";
    const std::string mover = bodies->pressingMover().empty() ? clampedBy_ : bodies->pressingMover();
    return text("the contact surfaces of ", bodies->deepestPair(), " overlap by ", bodies->largestOverlap(), " m, ", std::round(100*bodies->largestOverlap()/thinnestBody_),
        " % of the thinnest body. ", mover.empty() ? "Contact is too soft: give constant/bodies more `stiffness`"
        : "Structure " + mover + " moves as prescribed whatever is in its way, and presses them together: have it end before, by the run's endTime or a motion that"
            " leaves room, or take out of its way what it clamps");
}

/// Said once.
void RunOutput::reportOverlap(const CoupledStep& step)
{
    const std::string advice = overlapAdvice(step.coupling());
    if (advice.empty()) return;
    if (!step.coupling()->pressingMover().empty()) clampedBy_ = step.coupling()->pressingMover(); // forces between bodies this deep in each other say little
    if (isOverlapReported_) return;
    isOverlapReported_ = true;
    Foam::Info<< "Warning: t = " << runTime_.value() << " s: " << advice.c_str() << Foam::endl;
}

void RunOutput::reportComings(const std::vector<BodyRecord>& records)
{
    const auto say = [&](std::size_t s, const char* what)
    {
        const Vec3& x = records[s].pose.position;
        Foam::Info<< "body " << members_[s].name.c_str() << ' ' << what << ", its centre is at " << Foam::vector(x[0], x[1], x[2]) << Foam::endl;
    };
    for (std::size_t s = 0; s < records.size(); ++s)
    {
        if (last_[s].isAwaited && !records[s].isAwaited) say(s, "has come in");
        if (!last_[s].hasLeft && records[s].hasLeft) say(s, "has left the mesh and is taken out");
    }
    last_ = records;
}

void RunOutput::countRejected(const std::string& reason, double dt)
{
    ++rejected_;
    Foam::Info<< "step of " << dt << " s rejected: " << reason.c_str() << "; repeated with half of it" << Foam::endl;
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
    state.arrays["fluid"] = fluidRecord(fluid_);
    state.arrays["members"] = codesOf(members_);
    state.arrays["descriptions"] = descriptions_;
    state.scalars = {{"initialLiquid", mass_.initial}, {"inflow", mass_.inflow}, {"outflow", mass_.outflow}, {"liquid", mass_.final},
        {"steps", double(steps_)}, {"redistributed", redistributed_}, {"timeStep", timeStep}, {"firstStart", firstStart_},
        {"largestOverlap", largestOverlap_}};
    files_.write(std::move(state), names);
    if (!history_) return;
    history_->flush();
    if (!members_.empty()) history_->writeSurface(runTime_.value(), step.records());
}

void RunOutput::end(const CoupledStep& step)
{
    if (history_) history_->flush();
    RunSummary summary;
    summary.bodies = step.scene().nBodies();
    if (const BodyCoupling* bodies = step.coupling())
    {
        summary.bodiesLeft = bodies->count(Presence::Left);
        summary.bodiesAwaited = bodies->count(Presence::Awaited);
    }
    summary.largestOverlap = largestOverlap_;
    summary.thinnestBody = thinnestBody_;
    summary.steps = steps_ - firstStep_;
    summary.repeatedSteps = rejected_;
    summary.nodes = mesh_.nGlobal;
    summary.ranks = halo_.size();
    summary.anomalies = {{"rejected steps", rejected_}, {"non-converged linear solves", notConverged_},
        {"contacts not converged", unfinishedContacts_}, {"limited faces of the phase field", limitedFaces_},
        {"elements shared by two solids (largest)", sharedElements_}};
    summary.mass = mass_;
    summary.unbalancedVolume = unbalanced_;
    summary.structures = forces_.result();
    summary.wall = timers_.wall();
    summary.cpu = timers_.cpu();
    Foam::Info<< RunLog::summary(summary).c_str() << Foam::endl;
}

} // namespace flotsam
