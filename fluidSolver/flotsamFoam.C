// SPDX-License-Identifier: GPL-3.0-or-later
/// flotsamFoam: driftwood and debris in a free-surface flow, colliding with structures, piling up and blocking them.
///
/// Stabilised P1 finite cover method on fixed meshes, conservative phase field, rigid bodies by LIGGGHTS in process.
/// This file is the only one that knows the fluid and the bodies: it reads the case, runs the time loop, writes.
#include "demCoupling/coupling/coupledStep.hpp"
#include "demCoupling/foam/bodiesReader.H"
#include "demCoupling/foam/bodyChecks.H"
#include "demCoupling/foam/continuedContact.H"
#include "demCoupling/foam/continuedMembers.H"
#include "demCoupling/foam/continuedMotion.H"
#include "demCoupling/foam/restraintReader.H"
#include "demCoupling/foam/runOutput.H"
#include "demCoupling/foam/runScene.H"
#include "demCoupling/foam/structureChecks.H"
#include "foam/boundaryReader.H"
#include "foam/caseCheck.H"
#include "foam/cellCost.H"
#include "foam/dictionaryChecks.H"
#include "foam/editedControls.H"
#include "foam/endOnErrors.H"
#include "foam/fieldIO.H"
#include "foam/laterTimes.H"
#include "foam/otherInput.H"
#include "foam/patchReport.H"
#include "foam/runEnd.H"
#include "foam/startReport.H"
#include "foam/wallForces.H"
#include "foam/writeTimes.H"

#include "core/bodyWalls.hpp"
#include "core/nextTimeStep.hpp"
#include "io/stopSignal.hpp"

#include "argList.H"
#include "fvMesh.H"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace flotsam
{

namespace
{

constexpr double retryFactor = 0.5;     // of the time step after a rejected step
constexpr int maxRetries = 8;

/// Courant numbers of a time step of 1 s; ahead: as in CoupledStep::fastestSolid() [s].
CourantNumbers courantRates(const CoupledStep& step, double ahead)
{
    const CourantRates flow = step.fluid().courantRates();
    return {flow.mean, flow.largest, step.bodyCourantRate(ahead)};
}

/// Ends messages about fluid that has become too fast: what has made it so beside structures that move.
std::string gapAdvice(const CoupledStep& step)
{
    const std::vector<Solid>& solids = step.scene().solids();
    if (std::none_of(solids.begin(), solids.end(), [](const Solid& s) { return s.kind == Solid::Kind::Prescribed; })) return "";
    return ". Does a structure that moves close a gap to a patch there that lets nothing through? That patch must be of type wall in constant/polyMesh/boundary:"
        " then the gap shuts from a hundredth of an element on";
}

/// One step of at most dt, repeated with smaller steps when it fails. Returns the step used and its result.
StepResult advance(CoupledStep& step, const TimeControls& time, const WriteTimes& writeTimes, double& dt, RunOutput& output)
{
    for (int retry = 0;; ++retry)
    {
        step.tallyContacts(writeTimes.mayWriteAfter(dt));
        const StepResult result = step.step(dt);
        if (result.isAccepted) return result;
        output.countRejected(result.failure, dt);
        dt *= retryFactor;
        if (retry == maxRetries || dt < time.minDeltaT)
        {
            const std::string overlap = output.overlapAdvice(step.coupling());
            throw std::runtime_error(text("no step could be made from t = ", step.fluid().state().time, " s: ", result.failure, " down to a step of ", dt/retryFactor, " s. ",
                overlap.empty() ? text("The fastest fluid there: ", step.fluid().describeFastest(), gapAdvice(step)) : "Before it, " + overlap));
        }
    }
}

/// Weights for decomposePar. Bodies and moving structures leave the cells that they cover at the start: they do not count.
void weighCells(const Foam::fvMesh& mesh, const MeshAdapter& adapter, const Halo& halo, const BodiesInput& bodies)
{
    std::vector<Solid> solids;
    for (const StructureDefinition& s : bodies.structures)
        if (!s.motion) solids.push_back(s.solid);
    CellCostReport report;
    if (solids.empty()) report = writeCellCost(mesh, adapter, halo, nullptr);
    else
    {
        const NodeGraph graph(adapter.mesh);
        const Cover cover = cutMeshWithExactVolume(adapter.mesh, graph, halo, solids);
        report = writeCellCost(mesh, adapter, halo, &cover);
    }
    Foam::Info<< "Elements: " << report.fluidElements << " of fluid, " << report.cutElements << " cut by fixed structures, " << report.solidElements
        << " inside them; cost " << report.cost << " cells of fluid" << Foam::nl
        << "Written: " << mesh.time().timeName() << "/cellCost. decomposePar uses it with  weightField cellCost;  in system/decomposeParDict"
        << Foam::endl;
}

/// reportThinStructures() before a run.
void checkThinStructures(const MeshAdapter& adapter, const Halo& halo, const BodiesInput& bodies)
{
    if (bodies.structures.empty()) return;
    std::vector<Solid> solids;
    for (const StructureDefinition& s : bodies.structures) solids.push_back(s.solid);
    const NodeGraph graph(adapter.mesh);
    reportThinStructures(adapter.mesh, graph, halo, cutMesh(adapter.mesh, graph, halo, solids), bodies, solids.size());
}

/// Axis along which gravity acts most; -1: none.
int verticalAxis(const std::array<double, 3>& gravity)
{
    int axis = -1;
    double largest = 0;
    for (int d = 0; d < 3; ++d)
    {
        if (!(std::abs(gravity[d]) > largest)) continue;
        axis = d;
        largest = std::abs(gravity[d]);
    }
    return axis;
}

/// Each would believe that it has the whole mesh.
void checkProcesses()
{
    int size = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    if (size > 1 && !Foam::Pstream::parRun())
        throw std::runtime_error("mpirun has started " + std::to_string(size) + " processes of flotsamFoam without the option -parallel: decompose the case"
            " (decomposePar) and run  mpirun -np " + std::to_string(size) + " flotsamFoam -parallel");
}

/// What a run that begins anew begins with.
void reportAnew(const CaseControls& controls, const SimplexMesh& mesh, const Halo& halo, const BodiesInput& bodies, const FlowState& state)
{
    reportStart(controls, mesh, halo, state, !bodies.structures.empty() || !bodies.bodies.empty());
    const std::string doubt = bodyInStream(bodies, mesh, halo, controls.fluid, state, state.time);
    if (!doubt.empty()) Foam::Info<< "Warning: " << doubt.c_str() << Foam::nl;
    for (const std::string& late : doubtfulStart(bodies, state.time)) Foam::Info<< "Warning: " << late.c_str() << Foam::nl;
}

/// What a run that goes on begins with besides: bodies and structures that its state does not have.
void reportAdded(const CaseControls& controls, const SimplexMesh& mesh, const Halo& halo, const BodiesInput& bodies, const FlowState& state, const StoredMembers& stored)
{
    const BodiesInput added = addedPart(bodies, stored);
    const std::string doubt = bodyInStream(added, mesh, halo, controls.fluid, state, state.time);
    if (!doubt.empty()) Foam::Info<< "Warning: " << doubt.c_str() << Foam::nl;
    for (const std::string& late : doubtfulStart(added, state.time)) Foam::Info<< "Warning: " << late.c_str() << Foam::nl;
}

/// Start of the run, which takes the clock along: the state stored at the start time, or its fields where there is none; report: of these;
/// reportMore: of what the state does not have.
template<class Report, class ReportMore>
void start(CoupledStep& step, RunOutput& output, const FoamFields& fields, Foam::Time& runTime, Report report, ReportMore reportMore)
{
    if (output.readState(step, fields)) reportMore(step.fluid().state());
    else
    {
        FlowState state;
        state.time = runTime.value();
        fields.readStart(state);
        report(state);
        step.start(std::move(state), true);
    }
    runTime.setTime(step.fluid().state().time, runTime.timeIndex()); // OpenFOAM has it from the folder's name
}

/// Steps that end at a write time may be half as long as wanted; what follows grows from this multiple of them at most: BDF2 and the explicit parts bear no jump by 2.4.
constexpr double longestAfterWrite = 1.5;

double firstStep(const Foam::Time& runTime, const CaseControls& controls, const SimplexMesh& mesh, const Halo& halo)
{
    const double given = std::min(runTime.deltaTValue(), controls.time.maxDeltaT);
    if (!controls.fluid.isTwoPhase) return given;
    const auto& g = controls.fluid.gravity;
    const double shortest = halo.min(mesh.h.empty() ? 1e300 : *std::min_element(mesh.h.begin(), mesh.h.end()));
    return firstTimeStep(given, controls.time.maxCo, shortest, std::hypot(g[0], g[1], g[2]));
}

/// A step shorter than this part of the wanted one is said to be so because of the write time at which it ends; others are what the flow, the bodies or maxDeltaT make them.
constexpr double mostlyCut = 0.8;

/// Of what the patches let in.
std::vector<TimeJump> flowJumps(const std::vector<BoundaryPatch>& boundary)
{
    std::vector<TimeJump> jumps;
    for (const BoundaryPatch& patch : boundary) jumps.insert(jumps.end(), patch.jumps.begin(), patch.jumps.end());
    return jumps;
}

/// As OpenFOAM's solvers, the run does not write at its end.
void warnUnwritten(const Foam::Time& runTime, const WriteTimes& writeTimes)
{
    if (writeTimes.comeBy(runTime.endTime().value())) return;
    Foam::Info<< "Warning: nothing will be written for ParaView or to go on from: the first write time, by writeInterval of system/controlDict, is later than endTime, "
        << runTime.endTime().value() << " s" << Foam::nl << Foam::endl;
}

/// limit: word of nextTimeStep(); ahead: as in courantRates().
void checkTimeStep(double wanted, const std::string& limit, const TimeControls& time, const CoupledStep& step, double ahead)
{
    if (wanted >= time.minDeltaT) return;
    const std::string begin = text("the time step falls to ", wanted, " s at t = ", step.fluid().state().time, " s, below minDeltaT of system/controlDict, ", time.minDeltaT, " s: ");
    const auto [solid, speed] = step.fastestSolid(ahead);
    if (limit == "body")
        throw std::runtime_error(text(begin, "the surface of ", solid, " moves with ", speed, " m/s, and it may go maxBodyCo ", time.maxBodyCo,
            " elements in a step. Is that speed meant? Then give a smaller minDeltaT, or a larger maxBodyCo"));
    throw std::runtime_error(text(begin, step.fluid().describeFastest(), ". The solution has become unstable there: look at the last written fields,"
        " reduce maxCo, or refine the mesh", gapAdvice(step)));
}

/// After a step: the fields where someone looks at them, and at a written time the state to restart from. A stop signal makes it the last step.
/// timeStep: before it was cut to meet that time. Returns whether a signal asked to stop.
bool write(Foam::Time& runTime, const Halo& halo, CoupledStep& step, FoamFields& fields, RunOutput& output, PhaseTimers& timers, double timeStep)
{
    const bool isStopping = halo.any(stopRequested());
    const bool writeNow = halo.any(takeWriteRequest());
    if (fields.isNeeded() || isStopping || writeNow)
    {
        PhaseTimer t(timers, Phase::Output);
        fields.update(step.fluid().state(), step.fluid().profileWidth(), step.cover(), step.scene().solids());
    }
    if (isStopping) runTime.writeAndEnd();
    else if (writeNow) runTime.writeNow();
    else runTime.write();
    if (runTime.writeTime() || isStopping || writeNow)
    {
        output.writeState(step, timeStep);
        step.forgetUnwritten();
    }
    return isStopping;
}

enum class Task { Run, Check, WeighCells };

/// False: a signal, or stopAt, has ended the run before its time.
bool run(Foam::Time& runTime, Foam::fvMesh& mesh, Task task)
{
    PetscSession petsc(MPI_COMM_WORLD);
    checkProcesses();
    const CaseControls controls = readCaseControls(runTime);
    MeshAdapter adapter = makeSimplexMesh(mesh, MPI_COMM_WORLD, verticalAxis(controls.fluid.gravity));
    checkGravity(controls.fluid, adapter.mesh);
    const Halo halo(adapter.mesh, MPI_COMM_WORLD);
    std::vector<BoundaryPatch> boundary = readBoundary(mesh, adapter, halo, controls);
    FoamFields fields(mesh, adapter, halo, controls);
    const auto& g = controls.fluid.gravity;
    const Vec3 gravity(g[0], g[1], g[2]);
    const BodiesInput bodies = readBodies(mesh, adapter.mesh, halo, gravity, readStoredFinest(runTime, adapter.mesh, halo));
    checkEntries(bodies, controls.fluid);
    reportBodies(bodies, controls.fluid, mesh.time().endTime().value());
    reportRestraints(bodies, runTime.value(), runTime.deltaTValue());
    for (BoundaryPatch& patch : boundary)
        patch.stopsBodies = std::find(bodies.wallPatches.begin(), bodies.wallPatches.end(), patch.name) != bodies.wallPatches.end();
    takeBodyWalls(adapter.mesh, boundary);
    printCaseCheck(controls, adapter, halo, boundary, countScene(bodies));
    const std::vector<WallForceGroup> wallForces = readWallForces(runTime.controlDict(), mesh.boundaryMesh(), adapter.mesh, boundary);
    reportWallForces(wallForces);
    const auto report = [&](const FlowState& state) { reportAnew(controls, adapter.mesh, halo, bodies, state); };
    PhaseTimers timers;
    if (task == Task::Check)
    {
        warnLaterTimes(runTime);
        RunOutput output(runTime, adapter.mesh, halo, controls.fluid, bodies, timers);
        const bool isContinued = output.checkStart();
        checkThinStructures(adapter, halo, bodies);
        FlowState state;
        fields.readStart(state);
        state.time = runTime.value();
        if (isContinued) reportAdded(controls, adapter.mesh, halo, bodies, state, output.stored());
        else report(state);
        fitFirstStep(runTime, controls.time, !isContinued);
        reportEnded(runTime);
        checkInflow(adapter, halo, boundary, state, nullptr, runTime.value());
        reportPatches(controls, adapter, halo, boundary, state, nullptr, runTime.value(), runTime.endTime().value());
        writeNumerics(Foam::Info, controls.numerics);
    }
    if (task == Task::WeighCells) weighCells(mesh, adapter, halo, bodies);
    if (task != Task::Run) return true;

    const DemSetup dem = makeDemSetup(bodies, wallForces, controls.numerics.demTimeStep, runTime.value());
    CoupledStep step(adapter.mesh, halo, controls.fluid, controls.numerics, boundary, makeScene(bodies, gravity),
        bodies.bodies.empty() ? nullptr : &dem, timers);
    RunOutput output(runTime, adapter.mesh, halo, controls.fluid, bodies, timers);
    start(step, output, fields, runTime, report, [&](const FlowState& state) { reportAdded(controls, adapter.mesh, halo, bodies, state, output.stored()); });
    warnLaterTimes(runTime);
    if (!bodies.structures.empty())
        reportThinStructures(adapter.mesh, step.fluid().graph(), halo, *step.cover(), bodies, step.scene().solids().size());
    reportPatches(controls, adapter, halo, boundary, step.fluid().state(), step.cover(), runTime.value(), runTime.endTime().value());
    const bool isAdjusted = controls.time.adjustTimeStep;
    WriteTimes writeTimes(runTime, output.firstStart(), output.lastStep(), isAdjusted ? motionJumps(bodies) : std::vector<double>(), isAdjusted ? flowJumps(boundary) : std::vector<TimeJump>());
    output.begin(step);
    fields.begin(step.cover());
    WallForceFiles forceFiles(runTime, adapter.mesh, wallForces);
    if (!wallForces.empty()) step.fluid().watchPatches(watchedPatches(wallForces));
    mesh.primitiveMesh::clearAddressing();  // cells, edges and the like that only the start needed; the geometry must stay: fields of the fvMesh are slices of it
    installStopSignals();

    EditedControls edited(controls.time);
    const auto& fvSolution = mesh.lookupObject<Foam::IOdictionary>("fvSolution");  // OpenFOAM's, which reads it again when it is edited
    EditedNumerics numerics(fvSolution);
    fitFirstStep(runTime, controls.time, output.timeStep() <= 0);
    if (!reportEnded(runTime)) warnUnwritten(runTime, writeTimes);
    bool isComplete = true;
    double dt = output.timeStep() > 0 ? output.timeStep() : firstStep(runTime, controls, adapter.mesh, halo)/timeStepGrowth;
    while (runTime.run())
    {
        const std::string change = edited.update(runTime.controlDict());
        if (!change.empty()) Foam::Info<< change.c_str() << Foam::endl;
        const std::string ignored = numerics.update(fvSolution);
        if (!ignored.empty()) Foam::Info<< ignored.c_str() << Foam::endl;
        const TimeControls& time = edited.now();
        const double ahead = timeStepGrowth*dt;
        const CourantNumbers rates = courantRates(step, ahead);
        checkInflow(adapter, halo, boundary, step.fluid().state(), step.cover(), runTime.value());
        auto [wanted, limit] = nextTimeStep(rates.largest, rates.bodies, time, dt);
        checkTimeStep(wanted, limit, time, step, ahead);
        double used = writeTimes.setStep(wanted);
        const double before = used;
        if (used < mostlyCut*wanted) limit = writeTimes.reason();
        const StepResult result = advance(step, time, writeTimes, used, output);
        if (used < before) limit = "retry";
        const bool isCut = used == before && used < 0.999*wanted;
        dt = isCut ? std::min(wanted, longestAfterWrite*used) : used;
        writeTimes.advance(used);
        step.fluid().state().time = runTime.value(); // OpenFOAM's clock, to the last digit

        output.record(step, result, limit, rates*used);
        if (!wallForces.empty()) forceFiles.write(runTime.value(), used, step.fluid().patchForces(), contactForces(dem.wallGroups, step.coupling()));
        if (!time.adjustTimeStep || std::max(time.maxCo, time.maxBodyCo) > RunLog::largeCourant) output.watchCourant(step, courantRates(step, 0)*used, used, time);
        const double endTime = runTime.endTime().value(); // a signal changes it
        if (write(runTime, halo, step, fields, output, timers, dt)) isComplete = runTime.value() > endTime - 0.5*used;
    }
    output.end(step);
    if (!wallForces.empty()) Foam::Info<< forceFiles.summary().c_str() << Foam::endl;
    if (!isComplete)
        Foam::Info<< "Stopped by a signal at " << runTime.timeName() << " s, before endTime. The state is written; the run goes on from it with startFrom latestTime\n"
            << Foam::endl;
    else
        isComplete = !reportStopped(runTime);
    return isComplete;
}

} // namespace

} // namespace flotsam

int main(int argc, char* argv[])
{
    flotsam::checkCasePath(argc, argv);
    Foam::argList::addNote
    (
        "Driftwood and debris in a free-surface flow: stabilised P1 finite cover method with LIGGGHTS rigid bodies.\n"
        "A case is an interFoam case plus constant/bodies."
    );
    Foam::argList::addBoolOption("dry-run", "check the whole case, print what will be solved and skipped, memory and time; do not run");
    Foam::argList::addBoolOption("cell-cost", "write what every cell costs, for decomposePar (weightField cellCost), into the start time; do not run");
    Foam::argList args(argc, argv);
    if (!args.checkRootCase()) Foam::FatalError.exit();

    flotsam::endOnErrors();
    flotsam::checkFileHandler(args.rootPath()/args.globalCaseName());
    const Foam::dictionary controlDict = flotsam::readControlDict(args.rootPath()/args.globalCaseName()/"system"/Foam::Time::controlDictName);
    flotsam::checkTimeEntries(controlDict);
    flotsam::checkLatestTimes(args.path(), controlDict);
    Foam::Time runTime(Foam::Time::controlDictName, args);
    if (const std::string doubt = flotsam::doubtfulWriting(controlDict, runTime.value()); !doubt.empty()) Foam::Info<< "Warning: " << doubt.c_str() << Foam::nl;
    flotsam::checkMesh(runTime);
    Foam::fvMesh mesh
    (
        Foam::IOobject(Foam::fvMesh::defaultRegion, runTime.timeName(), runTime, Foam::IOobject::MUST_READ)
    );
    using flotsam::Task;
    if (flotsam::run(runTime, mesh, args.found("dry-run") ? Task::Check : args.found("cell-cost") ? Task::WeighCells : Task::Run))
        Foam::Info<< "End\n" << Foam::endl;
    return 0;
}
