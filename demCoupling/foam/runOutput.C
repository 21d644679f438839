// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/runOutput.H"

#include "foam/dictionaryChecks.H"

#include "OSspecific.H"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

/// Of the box around a shape in its frame [m].
Vec3 sizeOf(const Shape& shape)
{
    const auto [lower, upper] = shape.bounds();
    return upper - lower;
}

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
        members.push_back({s.solid.name, true, 0, s.solid.shape->moments().volume, s.solid.shape->surface(s.facetSize), sizeOf(*s.solid.shape).maxCoeff(), sizeOf(*s.solid.shape).minCoeff(), s.solid.pose});
    for (const BodyDefinition& b : input.bodies)
        members.push_back({b.name, false, b.mass, b.volume, b.shape->surface(facetSize(b)), sizeOf(*b.shape).maxCoeff(), b.thinnest, b.pose});
    return members;
}

std::vector<std::string> structureNames(const BodiesInput& input)
{
    std::vector<std::string> names;
    for (const StructureDefinition& s : input.structures) names.push_back(s.solid.name);
    return names;
}

} // namespace

RunOutput::RunOutput(const Foam::Time& runTime, const SimplexMesh& mesh, const Halo& halo, const FluidProperties& fluid, const BodiesInput& bodies,
    const PhaseTimers& timers)
:   runTime_(runTime), mesh_(mesh), halo_(halo), fluid_(fluid), bodies_(bodies), timers_(timers), members_(makeMembers(bodies)),
    files_(runTime, mesh, halo), log_(timers, runTime.value(), runTime.endTime().value()), forces_(structureNames(bodies)), restraints_(bodies), contacts_(bodies),
    nStructures_(int(bodies.structures.size())), firstStart_(runTime.value()), thinnestBody_(thinnestBody(bodies))
{}

/// A run that goes on has a record of the time from which it does: without one the records before are those of another run, or some are lost.
void RunOutput::warnHole(double lastRecord) const
{
    const double now = runTime_.value();
    if (!std::isfinite(lastRecord) || now - lastRecord < 1e-6*std::abs(now)) return;
    Foam::Info<< text("Warning: the records of postProcessing/flotsam/bodies.h5 end at ", lastRecord, " s, and the run goes on from ", now,
        " s: between them there are none. Are they of another run?\n    Then rename the file before the start, or remove the times that are not of its run\n").c_str() << Foam::endl;
}

void RunOutput::begin(const CoupledStep& step)
{
    last_ = step.records();
    double volume = 0;
    for (int e = 0; e < mesh_.nElements; ++e) volume += mesh_.isOwnedElement[e] ? mesh_.volume[e] : 0;
    meshVolume_ = mesh_.thickness*halo_.sum(volume);
    mass_.final = step.fluid().liquidVolume();
    if (mass_.initial == 0) mass_.initial = mass_.final;
    restraints_.begin(runTime_);
    if (halo_.rank() == 0)
    {
        const Foam::fileName folder = runTime_.globalPath()/"postProcessing"/"flotsam";
        Foam::mkDir(folder);
        history_ = std::make_unique<BodyHistory>(folder/"bodies.h5", members_, runTime_.value(), restraints_.names(), contacts_.walls());
        warnHole(history_->lastTime());
        history_->append(runTime_.value(), step.records(), scalars(0));
        writeScene(step);
    }
}

/// What ParaView shows of bodies, structures, restraints and contacts.
void RunOutput::writeScene(const CoupledStep& step)
{
    if (!members_.empty()) history_->writeSurface(runTime_.value(), step.records());
    if (!step.coupling()) return;
    const std::vector<BodyRecord> records = step.records();
    history_->writeLines(runTime_.value(), restraints_.lines(records, step.coupling()->restraintLoads()));
    if (const std::vector<MeanContact>* contacts = step.coupling()->meanContacts())
        history_->writeContacts(runTime_.value(), contacts_.records(*contacts, records), records.back().pose.position);
}

double RunOutput::massError() const { return mass_.relativeError(); }

std::vector<std::pair<std::string, double>> RunOutput::scalars(double dt) const
{
    std::vector<std::pair<std::string, double>> all{{"dt", dt}, {"liquidVolume", mass_.final}, {"inflow", mass_.inflow}, {"outflow", mass_.outflow},
        {"massError", massError()}, {"redistributed", redistributed_}, {"largestOverlap", largestOverlap_}};
    if (mass_.displaced != 0) all.emplace_back("displaced", mass_.displaced);
    return all;
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
        if (step.coupling()->largestOverlap() > largestOverlap_)
        {
            largestOverlap_ = step.coupling()->largestOverlap();
            deepestPressedBy_ = step.coupling()->pressingMover();
        }
    }
    if (step.cover()) sharedElements_ = std::max(sharedElements_, step.cover()->nSharedElements);
    const std::vector<BodyRecord> records = step.records();
    for (int s = 0; s < nStructures_; ++s)
        forces_.add(s, step.fluid().state().dt, records[s].fluidForce.data(), records[s].contactForce.data(),
            records[s].peakContactForce.data());
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
    if (step.coupling()) restraints_.record(runTime_.value(), step.coupling()->restraintLoads());
    reportSqueezed(step);
    reportOverlap(step);
    for (const std::string& waiting : result.waiting) Foam::Info<< waiting.c_str() << Foam::endl;
}

void RunOutput::watchCourant(const CoupledStep& step, const CourantNumbers& courant, double dt, const TimeControls& time)
{
    const double largest = std::max(courant.largest, courant.bodies);
    if (largest <= RunLog::largeCourant || ++longSteps_ > 1) return;
    const auto [solid, speed] = step.fastestSolid(0);
    const std::string fastest = courant.bodies > courant.largest ? text("the surface of ", solid, " moves with ", speed, " m/s") : step.fluid().describeFastest();
    const std::string given = time.adjustTimeStep ? text("allowed by maxCo ", time.maxCo, " and maxBodyCo ", time.maxBodyCo) : "given by deltaT with adjustTimeStep no",
        advice = time.adjustTimeStep ? text("Set maxCo and maxBodyCo ", TimeControls().maxCo, " in system/controlDict")
            : text("Set adjustTimeStep yes (maxCo ", TimeControls().maxCo, ") in system/controlDict, or a deltaT of ", RunLog::largeCourant*dt/largest, " s at most");
    Foam::Info<< text("Warning: t = ", runTime_.value(), " s: the step of ", dt, " s, ", given, ", has a Courant number of ", largest, ": ", fastest,
        ". A dam break with such steps is wrong by a tenth and more (docs/resolution.md). ", advice).c_str() << Foam::endl;
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
        : "Structure " + mover + " moves as prescribed whatever is in its way, and presses them together: let it stop before (timeEnd of its motion, or a last row of its table), move it where"
            " it leaves room, or take out of its way what it clamps");
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
    summary.overlapPressedBy = deepestPressedBy_;
    summary.thinnestBody = thinnestBody_;
    summary.steps = steps_ - firstStep_;
    summary.repeatedSteps = rejected_;
    summary.nodes = mesh_.nGlobal;
    summary.ranks = halo_.size();
    summary.anomalies = {{"rejected steps", rejected_}, {"non-converged linear solves", notConverged_},
        {"contacts not converged", unfinishedContacts_}, {"limited faces of the phase field", limitedFaces_},
        {"elements shared by two solids (largest)", sharedElements_}};
    if (longSteps_ > 0) summary.anomalies.emplace_back(text("steps of a Courant number above ", RunLog::largeCourant), longSteps_);
    summary.isTwoPhase = fluid_.isTwoPhase;
    summary.mass = mass_;
    summary.unbalancedVolume = unbalanced_;
    summary.structures = forces_.result();
    summary.wall = timers_.wall();
    summary.cpu = timers_.cpu();
    Foam::Info<< RunLog::summary(summary).c_str() << restraints_.summary().c_str() << Foam::endl;
}

} // namespace flotsam
