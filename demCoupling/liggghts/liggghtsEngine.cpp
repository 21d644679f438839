// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/liggghtsEngine.hpp"

#include "demCoupling/liggghts/liggghtsCorners.hpp"
#include "demCoupling/liggghts/liggghtsNear.hpp"
#include "demCoupling/liggghts/liggghtsRestraints.hpp"
#include "demCoupling/liggghts/liggghtsSetup.hpp"
#include "demCoupling/liggghts/liggghtsTally.hpp"
#include "demCoupling/liggghts/reach.hpp"

#include <cmath>
#include <optional>

namespace flotsam
{

namespace
{

Vec3 asVec(const double* v) { return Vec3(v[0], v[1], v[2]); }

template <class Values>
Values first(Values values, size_t n)
{
    values.resize(n);
    return values;
}

} // namespace

struct LiggghtsEngine::Implementation
{
    struct Interval { double duration, step; };
    static constexpr int stepsBetweenLooks = 50; ///< whether anything is near: a look costs up to two sub-steps

    explicit Implementation(const DemSetup& given)
        : nBodies(given.bodies.size()), setup(completed(given)), reach(setup.bodies, given.walls, nBodies), isHeld(setup.bodies.size(), 0),
          loads(setup.bodies.size())
    {
        model.firstMover = static_cast<int>(nBodies);
        model.contacts = makeContactTable(setup);
        timeStep = setup.timeStep > 0 ? setup.timeStep : contactTimeStep(setup, model.contacts);
        compensateLag(setup, timeStep, model.contacts);
        model.contacts.levels = dampingLevels(setup, model.contacts, timeStep);
        writeScript(model, setup, timeStep);
        insertBodies(model, setup);
        corners.emplace(model, setup);
        model.tally->sample();
        noteMovers();
        model.restraints->begin(setup, timeStep);
        for (int b = 0; b < model.bodies.count; ++b)
        {
            isHeld[static_cast<size_t>(b)] = model.isGone[static_cast<size_t>(b)];
            applyMobility(b);
        }
    }

    void noteMovers()
    {
        moverStart.clear();
        for (int b = model.firstMover; b < model.bodies.count; ++b)
            moverStart.push_back(asVec(model.bodies.xcm[b]));
    }

    void applyMobility(int body)
    {
        const BodyDefinition& definition = setup.bodies[static_cast<size_t>(body)];
        std::array<bool, 6> isFree;
        isFree.fill(!isHeld[static_cast<size_t>(body)] && body < model.firstMover);
        if (definition.isPlanar)
            for (int axis = 0; axis < 3; ++axis)
            {
                const bool isNormal = axis == definition.planeAxis;
                isFree[static_cast<size_t>(axis)] = isFree[static_cast<size_t>(axis)] && !isNormal;
                isFree[static_cast<size_t>(3 + axis)] = isFree[static_cast<size_t>(3 + axis)] && isNormal;
            }
        setMobility(model, body, isFree);
    }

    Load contactNow(int body) const
    {
        const BodyArrays& b = model.bodies;
        return {asVec(b.fcm[body]) - asVec(b.drag[body]), asVec(b.torque[body]) - asVec(b.hdTorque[body])};
    }

    /// Of all bodies and movers, into memory that is kept.
    const std::vector<BodyState>& states()
    {
        findStates(static_cast<size_t>(model.bodies.count), now);
        return now;
    }

    void findStates(size_t n, std::vector<BodyState>& result) const
    {
        result.resize(n);
        for (size_t b = 0; b < n; ++b)
            result[b] = stateOf(static_cast<int>(b));
    }

    /// What comes next within `left` [s]: free flight for as long as nothing can touch anything, or a while of contact sub-steps.
    Interval nextInterval(double left, double largestStep)
    {
        if (timeStep >= largestStep)
            return {left, largestStep};
        const double shortest = stepsBetweenLooks * timeStep;
        if (!isAnyTouched())
        {
            states();
            for (double t = left; t >= std::min(left, shortest); t *= 0.5)
                if (reach.isFree(now, loads, isHeld, model.isGone, t) && !model.restraints->mayPull(now, loads, isHeld, t))
                    return {t, largestStep};
        }
        return {left < 1.5 * shortest ? left : shortest, timeStep};
    }

    void advance(const Interval& interval)
    {
        const long steps = std::max(1L, std::lround(std::ceil(interval.duration / interval.step * (1 - 1e-12))));
        const double step = interval.duration / static_cast<double>(steps);
        setTimeStep(model, step);
        model.tally->startSteps(step);
        run(model, steps);
        model.tally->finishSteps();
        subSteps += steps;
    }

    BodyState stateOf(int body) const
    {
        const BodyArrays& b = model.bodies;
        const double* q = b.quat[body];
        BodyState state;
        state.pose.position = asVec(b.xcm[body]);
        state.pose.orientation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
        if (model.isGone[static_cast<size_t>(body)])
            state.pose = model.exits[static_cast<size_t>(body)];
        state.motion = {asVec(b.vcm[body]), asVec(b.omega[body])};
        state.angularMomentum = asVec(b.angmom[body]);
        return state;
    }

    template <class AnyContact>
    std::vector<AnyContact> withMoversAsWalls(std::vector<AnyContact> contacts) const
    {
        const int n = model.firstMover, walls = static_cast<int>(setup.walls.size());
        for (AnyContact& c : contacts)
            if (c.other >= n) c.other = -1 - (walls + c.other - n);
        return contacts;
    }

    bool isAnyTouched() const
    {
        for (int b = 0; b < model.bodies.count; ++b)
        {
            const Load contact = contactNow(b);
            if (!contact.force.isZero(0) || !contact.moment.isZero(0))
                return true;
        }
        return false;
    }

    void checkMotion() const
    {
        for (int b = 0; b < model.bodies.count; ++b)
            if (!asVec(model.bodies.xcm[b]).allFinite() || !asVec(model.bodies.omega[b]).allFinite())
                throw DemError("body '" + setup.bodies[static_cast<size_t>(b)].name + "': its motion is not a number (time step too large?)");
    }

    size_t nBodies;                     ///< the movers come behind them, as bodies
    DemSetup setup;
    ReachCheck reach;
    std::vector<char> isHeld;
    std::vector<Vec3> moverStart;       ///< of the last advance [m]
    std::vector<Load> loads;            ///< beside contact
    LiggghtsModel model;
    std::optional<CornerSpheres> corners;
    double timeStep = 0;
    long subSteps = 0;
    std::vector<BodyState> now;         ///< see states()
};

LiggghtsEngine::LiggghtsEngine(const DemSetup& setup) : impl_(std::make_unique<Implementation>(setup)) {}

LiggghtsEngine::~LiggghtsEngine() = default;

void LiggghtsEngine::setShares(const std::vector<BodyShare>& shares) { impl_->model.shares = shares; }

void LiggghtsEngine::setLoads(const std::vector<Load>& loads)
{
    const BodyArrays& b = impl_->model.bodies;
    if (loads.size() != impl_->nBodies)
        throw DemError("setLoads: one load per body is needed");
    for (int i = 0; i < impl_->model.firstMover; ++i)
    {
        // fcm and torque hold the last total: exchanging the load there makes the first half kick right
        const Load contact = impl_->contactNow(i), &load = loads[static_cast<size_t>(i)];
        impl_->loads[static_cast<size_t>(i)] = load;
        for (int k = 0; k < 3; ++k)
        {
            b.drag[i][k] = load.force[k];
            b.hdTorque[i][k] = load.moment[k];
            b.fcm[i][k] = contact.force[k];
            b.torque[i][k] = contact.moment[k];
        }
    }
    answerContacts(impl_->model, impl_->loads);
    for (int i = 0; i < impl_->model.firstMover; ++i)
        for (int k = 0; k < 3; ++k)
        {
            b.fcm[i][k] += b.drag[i][k];
            b.torque[i][k] += b.hdTorque[i][k];
        }
    impl_->model.loads = impl_->loads;
}

void LiggghtsEngine::advance(double duration, double largestStep)
{
    if (!(duration > 0) || !(largestStep >= 0))
        throw DemError("advance: duration must be > 0, the largest step >= 0");
    Implementation& d = *impl_;
    d.subSteps = 0;
    if (largestStep == 0)
        largestStep = std::max(d.timeStep, freeFlightStep(d.setup, d.states(), d.loads, d.isHeld, d.model.isGone, duration));
    if (d.setup.hasContactStepsOnly)
        largestStep = d.timeStep;
    if (!d.model.near->isNew())
        rebuildNeighbours(d.model);
    d.model.tally->start();
    d.noteMovers();
    for (double left = duration; left > 1e-12 * duration;)
    {
        const Implementation::Interval next = d.nextInterval(left, largestStep);
        d.advance(next);
        left -= next.duration;
    }
    d.model.tally->finish(duration);
    placeSpheres(d.model);
    d.corners->look();
    d.model.instance.guarded([&] {
        checkBodies(d.model, d.setup);
        d.checkMotion();
    });
}

void LiggghtsEngine::findStates(std::vector<BodyState>& states) const { impl_->findStates(impl_->nBodies, states); }

std::vector<BodyState> LiggghtsEngine::states() const
{
    std::vector<BodyState> result;
    findStates(result);
    return result;
}

std::vector<Load> LiggghtsEngine::meanContactLoads() const { return first(impl_->model.tally->meanOnBodies(), impl_->nBodies); }

std::vector<Load> LiggghtsEngine::meanWallLoads() const
{
    std::vector<Load> onBodies, loads;
    findMeans(onBodies, loads);
    return loads;
}

void LiggghtsEngine::findMeans(std::vector<Load>& onBodies, std::vector<Load>& loads) const
{
    const std::vector<Load>& means = impl_->model.tally->meanOnBodies();
    onBodies.assign(means.begin(), means.begin() + static_cast<std::ptrdiff_t>(impl_->nBodies));
    loads = impl_->model.tally->meanOnWalls();
    for (size_t m = 0; m < impl_->setup.movers.size(); ++m)
    {
        Load load = impl_->model.tally->meanOnBodies()[impl_->nBodies + m];
        load.moment += (0.5 * (impl_->moverStart[m] + asVec(impl_->model.bodies.xcm[impl_->nBodies + m]))).cross(load.force);
        loads.push_back(load);
    }
}

void LiggghtsEngine::findPeaks(std::vector<Vec3>& onBodies, std::vector<Vec3>& onWalls, std::vector<Vec3>& onGroups) const
{
    const ContactTally& tally = *impl_->model.tally;
    const std::vector<Vec3>& bodies = tally.peakOnBodies();
    const auto movers = bodies.begin() + static_cast<std::ptrdiff_t>(impl_->nBodies);
    onBodies.assign(bodies.begin(), movers);
    onWalls = tally.peakOnWalls();
    onWalls.insert(onWalls.end(), movers, bodies.end());
    onGroups = tally.peakOnGroups();
}

std::vector<Vec3> LiggghtsEngine::peakContactForces() const { return first(impl_->model.tally->peakOnBodies(), impl_->nBodies); }
std::vector<Vec3> LiggghtsEngine::peakGroupForces() const { return impl_->model.tally->peakOnGroups(); }

std::vector<Vec3> LiggghtsEngine::peakWallForces() const
{
    std::vector<Vec3> peaks = impl_->model.tally->peakOnWalls();
    const std::vector<Vec3>& bodies = impl_->model.tally->peakOnBodies();
    peaks.insert(peaks.end(), bodies.begin() + static_cast<std::ptrdiff_t>(impl_->nBodies), bodies.end());
    return peaks;
}

void LiggghtsEngine::tallyPairs(bool isOn) { impl_->model.tally->pairs().setOn(isOn); }

std::vector<MeanContact> LiggghtsEngine::meanContacts() const { return impl_->withMoversAsWalls(impl_->model.tally->pairs().means()); }
std::vector<Contact> LiggghtsEngine::contacts() const { return impl_->withMoversAsWalls(listContacts(impl_->model, impl_->setup)); }

void LiggghtsEngine::moveTo(const std::vector<Pose>& movers, double duration)
{
    if (movers.size() != impl_->setup.movers.size())
        throw DemError("moveTo: one pose per mover is needed");
    for (size_t m = 0; m < movers.size(); ++m)
    {
        const int body = impl_->model.firstMover + static_cast<int>(m);
        const Pose now = impl_->stateOf(body).pose;
        const Eigen::AngleAxisd turn(movers[m].orientation * now.orientation.conjugate());
        setMotion(impl_->model, body, {(movers[m].position - now.position) / duration, turn.angle() / duration * turn.axis()});
    }
}

std::vector<RestraintLoad> LiggghtsEngine::restraintLoads() const { return impl_->model.restraints->loads(); }

bool LiggghtsEngine::hasContact() const { return impl_->model.tally->hasContact(); }
long LiggghtsEngine::subSteps() const { return impl_->subSteps; }

void LiggghtsEngine::setHeld(const std::vector<char>& isHeld)
{
    if (isHeld.size() != impl_->nBodies)
        throw DemError("setHeld: one flag per body is needed");
    for (size_t b = 0; b < isHeld.size(); ++b)
    {
        if ((isHeld[b] != 0) == (impl_->isHeld[b] != 0))
            continue;
        impl_->isHeld[b] = isHeld[b];
        setMotion(impl_->model, static_cast<int>(b), isHeld[b] ? Motion() : impl_->setup.bodies[b].motion);
        impl_->applyMobility(static_cast<int>(b));
    }
    placeSpheres(impl_->model);
}

void LiggghtsEngine::setGone(const std::vector<char>& isGone)
{
    if (isGone.size() != impl_->nBodies)
        throw DemError("setGone: one flag per body is needed");
    const std::vector<char> all = first(isGone, impl_->setup.bodies.size());
    if (all != impl_->model.isGone)
        flotsam::setGone(impl_->model, all);
}

void LiggghtsEngine::setStates(const std::vector<BodyState>& states)
{
    LiggghtsModel& model = impl_->model;
    if (states.size() != impl_->nBodies)
        throw DemError("setStates: one state per body is needed");
    for (int b = 0; b < model.firstMover; ++b)
    {
        const BodyState& state = states[static_cast<size_t>(b)];
        if (model.isGone[static_cast<size_t>(b)])
            continue;
        const BodyState old = impl_->stateOf(b);
        const bool hasMoved = old.pose.position != state.pose.position
                              || old.pose.orientation.coeffs() != state.pose.orientation.coeffs();
        if (hasMoved)
        {
            setPose(model, b, state.pose);
            // contact forces belong to the pose they were computed for
            std::copy_n(model.bodies.drag[b], 3, model.bodies.fcm[b]);
            std::copy_n(model.bodies.hdTorque[b], 3, model.bodies.torque[b]);
            model.restraints->forget(b);
        }
        if (hasMoved || old.motion.velocity != state.motion.velocity
            || old.motion.angularVelocity != state.motion.angularVelocity)
            setMotion(model, b, state.motion);
    }
    placeSpheres(model);
}

void LiggghtsEngine::save(DemState& state) const { saveState(impl_->model, state); }

DemState LiggghtsEngine::save() const
{
    DemState state;
    save(state);
    return state;
}
void LiggghtsEngine::restore(const DemState& state) { restoreState(impl_->model, state); }

void LiggghtsEngine::restore(const DemState& state, const StoredMembers& stored)
{
    restoreState(impl_->model, withAdded(impl_->model, state, stored));
    impl_->model.restraints->beginNew();
}

double LiggghtsEngine::timeStep() const { return impl_->timeStep; }

} // namespace flotsam
