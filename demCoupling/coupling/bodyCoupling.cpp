// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/bodyCoupling.hpp"

#include <algorithm>
#include <functional>

namespace flotsam
{

namespace
{

void setDifference(const std::vector<Load>& a, const std::vector<Load>& b, std::vector<Load>& result)
{
    result.resize(a.size());
    for (std::size_t k = 0; k < a.size(); ++k) result[k] = a[k] - b[k];
}

/// With the last load alone what the tolerance lets pass grows faster (docs/contact.md).
Load mean(const Load& a, const Load& b) { return {0.5*(a.force + b.force), 0.5*(a.moment + b.moment)}; }

} // namespace

BodyCoupling::BodyCoupling(const DemSetup& setup, const CouplingControls& controls, MPI_Comm comm)
:   setup_(setup), controls_(controls), comm_(comm), touch_(setup), iteration_(setup.bodies, controls), answer_(setup.bodies, controls),
    probes_(setup.bodies), check_(setup.bodies, setup.walls)
{
    MPI_Comm_rank(comm, &rank_);
    const std::size_t n = setup.bodies.size();
    lastLoads_.resize(n);
    lastChanges_.resize(n);
    newContact_.resize(n);
    contact_.resize(n);
    smoothing_.resize(n);
    isJustReleased_.assign(n, 0);
    for (const BodyDefinition& body : setup.bodies)
    {
        isHeld_.push_back(body.entersAtRelease);
        presence_.push_back(body.entersAtRelease ? Presence::Awaited : Presence::There);
    }
    notePresence();
    states_.resize(n);
    result_.resize(n);
    guarded([&]
    {
        engine_ = std::make_unique<LiggghtsEngine>(setup_);
        demTimeStep_ = engine_->timeStep();
        result_ = engine_->states();
        touch_.restraints = engine_->restraintLoads();
    });
    MPI_Bcast(&demTimeStep_, 1, MPI_DOUBLE, 0, comm_);
    shareResults();
    states_ = predicted_ = result_;
    smooth_ = std::make_unique<SmoothMotion>(setup_.bodies, states_);
}

BodyCoupling::~BodyCoupling() = default;

/// Runs `work` on rank 0; an error there ends on every rank in the same exception.
template<class Work>
void BodyCoupling::guarded(const Work& work) const
{
    std::string message;
    if (rank_ == 0)
    {
        try { work(); }
        catch (const std::exception& error) { message = error.what(); if (message.empty()) message = "unknown DEM error"; }
    }
    int length = int(message.size());
    MPI_Bcast(&length, 1, MPI_INT, 0, comm_);
    if (length == 0) return;
    message.resize(length);
    MPI_Bcast(&message[0], length, MPI_CHAR, 0, comm_);
    throw std::runtime_error("DEM: " + message);
}

void BodyCoupling::shareResults()
{
    const auto passResults = [this](auto& archive)
    {
        passAll(archive, result_, newContact_);
        passSummary(archive, touch_);
    };
    sent_.clear();
    passResults(sent_); // on every rank, for the length
    std::vector<double>& numbers = sent_.numbers();
    MPI_Bcast(numbers.data(), int(numbers.size()), MPI_DOUBLE, 0, comm_);
    NumberReader reader(numbers.data());
    passResults(reader);
}

void BodyCoupling::runEngine(double duration, const std::vector<Load>& loads)
{
    guarded([&]
    {
        engine_->setShares(answer_.known());
        engine_->setLoads(loads);
        engine_->tallyPairs(tallies_);
        engine_->advance(duration);
        engine_->findStates(result_);
        engine_->findMeans(newContact_, touch_.wallLoads);
        engine_->findPeaks(touch_.peaks, touch_.wallPeaks, touch_.groupPeaks);
        touch_.take(engine_->contacts(), setup_);
        touch_.restraints = engine_->restraintLoads();
        if (!engine_->hasContact()) newContact_.assign(newContact_.size(), Load()); // round-off of a free flight
        meanContacts_ = engine_->hasContact() ? engine_->meanContacts() : std::vector<MeanContact>();
    });
    hasMeanContacts_ = tallies_;
    shareResults();
}

/// Beside contact, as it is guessed.
void BodyCoupling::runEngineWith(const std::vector<Load>& given)
{
    setDifference(contactGuess(), smoothing_, contactPart_);
    answer_.findEngineLoads(given, contactPart_, engineLoads_);
    runEngine(dt_, engineLoads_);
}

void BodyCoupling::begin(double time, double dt, double far)
{
    dt_ = dt;
    iteration_.begin(dt);
    sharesAtStart_ = answer_.shares();
    probes_.begin();
    touchAtStart_ = touch_;
    springSpeed_ = largestSpringSpeed();
    holds_ = isHeld_;
    for (int b = 0; b < nBodies(); ++b) holds_[b] = !isDue(b, time) || !isThere(b);
    isAtStart_ = true;
    hold(holds_);
    guessAtStart_ = contactGuess();
    moveTo(time + dt);
    guarded([&] { engine_->save(saved_); });
    for (int b = 0; b < nBodies(); ++b) predicted_[b] = isHeld_[b] ? states_[b] : drifted(b);
    if (!check_.strayBody(states_, predicted_, far).empty()) predictContacts();
}

double BodyCoupling::largestSpringSpeed() const
{
    double speed = 0;
    for (int b = 0; b < nBodies(); ++b)
        speed = std::max(speed, std::sqrt(touch_.largestOverlap*contact_[b].force.norm()/setup_.bodies[b].mass));
    for (std::size_t i = 0; i < setup_.restraints.size(); ++i)
    {
        const RestraintDefinition& r = setup_.restraints[i];
        const RestraintLoad& now = touch_.restraints[i];
        for (const RestraintEnd* end : {&r.end, &r.other})
            if (end->body >= 0 && !now.isBroken) speed = std::max(speed, std::abs(r.stretch(now.length))*std::sqrt(r.stiffness/setup_.bodies[end->body].mass));
    }
    return speed;
}

/// What moves as prescribed, in the coming step.
void BodyCoupling::moveTo(double time)
{
    if (setup_.movers.empty()) return;
    std::vector<Pose> poses;
    for (const MoverDefinition& mover : setup_.movers)
    {
        poses.emplace_back();
        Motion motion;
        mover.motion(time, poses.back(), motion);
    }
    guarded([&] { engine_->moveTo(poses, dt_); });
}

/// Bodies that touch something on their way end where the engine puts them with the last fluid loads.
void BodyCoupling::predictContacts()
{
    runEngineWith(lastLoads_);
    isAtStart_ = false;
    for (int b = 0; b < nBodies(); ++b)
        if (!newContact_[b].isZero()) predicted_[b].pose = result_[b].pose;
}

/// A body that is let go has its velocity at once, for the fluid too. What it was pressed by while it was held, what held it took: an impact would go on in its first step.
void BodyCoupling::hold(const std::vector<char>& isHeld)
{
    if (isHeld == isHeld_) return;
    guarded([&]
    {
        engine_->setHeld(isHeld);
        result_ = engine_->states();
    });
    shareResults();
    std::vector<Load> guess = contactGuess();
    for (int b = 0; b < nBodies(); ++b)
    {
        if (isHeld[b] == isHeld_[b]) continue;
        smooth_->reset(b, states_[b] = result_[b]);
        isJustReleased_[b] = !isHeld[b];
        guess[b] = contact_[b] = smoothing_[b] = Load();
    }
    iteration_.setGuess(guess);
    isHeld_ = isHeld;
}

void BodyCoupling::takeOut(const std::vector<char>& bodies)
{
    std::vector<char> held(isHeld_);
    std::vector<Load> guess = contactGuess();
    for (int b = 0; b < nBodies(); ++b)
    {
        if (!bodies[b] || !isThere(b)) continue;
        presence_[b] = Presence::Left;
        held[b] = 1;
        touch_.counts[b] = 0;
        touch_.peaks[b].setZero();
        guess[b] = lastLoads_[b] = newContact_[b] = contact_[b] = Load();
        answer_.drop(b);
    }
    iteration_.setGuess(guess);
    setDifference(guess, contact_, smoothing_);
    notePresence();
    hold(held);
    guarded([&] { engine_->setGone(areAway()); });
}

void BodyCoupling::letIn(int body)
{
    presence_[body] = Presence::There;
    notePresence();
    guarded([&] { engine_->setGone(areAway()); });
}

void BodyCoupling::notePresence()
{
    areAway_.resize(presence_.size());
    std::transform(presence_.begin(), presence_.end(), areAway_.begin(), [](Presence p) { return p != Presence::There; });
}

/// The body after the step if its smooth motion's last acceleration went on. Its pose is what the fluid is cut with.
BodyState BodyCoupling::drifted(int b) const
{
    BodyState s = smooth_->states()[b];
    const BodyDefinition& body = setup_.bodies[b];
    const Vec3 acceleration = (lastLoads_[b].force + contactGuess()[b].force)/body.mass;
    s.pose.position += dt_*(s.motion.velocity + 0.5*dt_*acceleration);
    const Vec3 turn = dt_*s.motion.angularVelocity;
    if (turn.norm() > 0) s.pose.orientation = (Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()))*s.pose.orientation).normalized();
    return s;
}

bool BodyCoupling::hasLightBodies() const
{
    for (int b = 0; b < nBodies(); ++b)
        if (isThere(b) && answer_.mayBeAsked(b)) return true;
    return false;
}

bool BodyCoupling::isFarOff(int b) const
{
    const Vec3 margin = Vec3::Constant((setup_.box[1] - setup_.box[0]).norm()), x = states_[b].pose.position;
    return ((setup_.box[0] - margin - x).array() > 0).any() || ((x - setup_.box[1] - margin).array() > 0).any();
}

/// Speeds are judged where fluid and engine disagree only: what both find is a solution, whatever drives it.
std::string BodyCoupling::brokenContact(double fluidSpeed) const
{
    const double slack = springSpeed_ + 10*controls_.gravity*dt_; // a bubble rises with twice gravity
    const bool hasConverged = mismatch() <= controls_.tolerance;
    const std::string thrown = hasConverged ? "" : check_.thrownBody(states_, result_, newContact_, fluidSpeed, slack);
    if (!thrown.empty()) return "contact throws body '" + thrown + "' faster than anything there is";
    return check_.passage(states_, result_, newContact_, areAway());
}

ContactAnswer BodyCoupling::correct(const std::vector<Load>& loads)
{
    loads_ = loads;
    if (!isAtStart_) guarded([&] { engine_->restore(saved_); });
    isAtStart_ = false;
    runEngineWith(loads_);
    smooth_->find(states_, result_, newContact_, dt_, answer_.areKnown());
    if (chooseProbes()) return ContactAnswer::AsksFluid;
    setDifference(smooth_->drive(), newContact_, smoothing_);
    return iteration_.take(smooth_->drive(), answer_) ? ContactAnswer::Holds : ContactAnswer::Changes;
}

/// Light bodies that contact has not converged for.
bool BodyCoupling::chooseProbes()
{
    if (!iteration_.mayRepeat()) return false;
    std::vector<int> bodies;
    for (int b = 0; b < nBodies(); ++b)
    {
        if (isHeld_[b] || !answer_.mayBeAsked(b) || iteration_.agrees(b, smooth_->drive(), answer_)) continue;
        if (!answer_.isKnown(b) || iteration_.isSlow(b, smooth_->drive(), answer_)) bodies.push_back(b);
    }
    return !bodies.empty() && probes_.choose(bodies, {contactGuess(), loads_, smooth_->drive()}, answer_);
}

void BodyCoupling::finishProbes()
{
    iteration_.setGuess(probes_.guessBefore());
    iteration_.forget();
    probes_.finish(predicted_, answer_);
}

void BodyCoupling::accept(const std::vector<Motion>& inFluid)
{
    newGuess_.assign(states_.size(), Load());
    isFound_.assign(states_.size(), 0);
    for (int b = 0; b < nBodies(); ++b)
    {
        const Motion& before = smooth_->states()[b].motion;
        lastChanges_[b] = {(inFluid[b].velocity - before.velocity)/dt_, (inFluid[b].angularVelocity - before.angularVelocity)/dt_};
        lastLoads_[b] = isHeld_[b] ? Load() : loads_[b]; // what holds a body takes its loads
        isFound_[b] = answer_.isLight(b) && !answer_.isKnown(b);
        if (newContact_[b].isZero()) answer_.drop(b);
        else if (answer_.isKnown(b)) newGuess_[b] = newContact_[b];
        else newGuess_[b] = isFound_[b] ? smooth_->drive()[b] : mean(newContact_[b], contact_[b]);
    }
    setDifference(newGuess_, newContact_, smoothing_);
    isJustReleased_.assign(isJustReleased_.size(), 0);
    states_ = result_;
    contact_ = newContact_;
    smooth_->accept(inFluid, isFound_);
    iteration_.setGuess(newGuess_);
}

void BodyCoupling::reject()
{
    guarded([&] { engine_->restore(saved_); });
    iteration_.setGuess(guessAtStart_); // that of the failed step would spoil the next prediction
    setDifference(guessAtStart_, contact_, smoothing_);
    answer_.setShares(sharesAtStart_);
    touch_ = touchAtStart_;
    hasMeanContacts_ = false;
}

CouplingRecord BodyCoupling::record() const
{
    return {touch_.wallLoads, lastLoads_, lastChanges_, contact_, contactGuess(), answer_.shares(), smooth_->save(), isHeld_, presence_, touch_.counts, touch_.wallCounts,
            touch_.largestOverlap, touch_.peaks, touch_.wallPeaks};
}

std::vector<double> BodyCoupling::save() const
{
    std::vector<double> data;
    guarded([&] { data = engine_->save().data; });
    unsigned long size = data.size();
    MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG, 0, comm_);
    data.resize(size);
    MPI_Bcast(data.data(), int(size), MPI_DOUBLE, 0, comm_);
    const std::vector<double> numbers = numbersOf(record());
    data.insert(data.end(), numbers.begin(), numbers.end());
    return data;
}

void BodyCoupling::restore(const std::vector<double>& data, const StoredMembers& known)
{
    isJustReleased_ = areNew(known.bodies, nBodies()); // no load of theirs has been before
    if (known.bodies.empty()) return;
    const CouplingRecord fresh = record();
    CouplingRecord stored = recordOf(known.bodies, fresh);  // for the lengths
    const std::size_t tail = numbersOf(stored).size();
    if (data.size() < tail) throw std::runtime_error("restart: the stored state of the bodies is too short for this case");
    const std::size_t engineSize = data.size() - tail;
    NumberReader reader(data.data() + engineSize);
    passRecord(reader, stored);
    const DemState engine{std::vector<double>(data.begin(), data.begin() + std::ptrdiff_t(engineSize))};
    const bool areAllKnown = int(known.bodies.size()) == nBodies() && known.restraints.size() == setup_.restraints.size();
    restore(recordWith(known.bodies, stored, fresh), [&] { areAllKnown ? engine_->restore(engine) : engine_->restore(engine, known); });
}

void BodyCoupling::restore(const CouplingRecord& stored, const std::function<void()>& restoreEngine)
{
    lastLoads_ = stored.lastLoads;
    lastChanges_ = stored.lastChanges;
    contact_ = stored.contact;
    iteration_.setGuess(stored.guess);
    setDifference(stored.guess, contact_, smoothing_);
    answer_.setShares(stored.shares);
    isHeld_ = stored.isHeld;
    presence_ = stored.presence;
    notePresence();
    guarded([&]
    {
        engine_->setHeld(isHeld_);
        restoreEngine();
        result_ = engine_->states();
        touch_.restraints = engine_->restraintLoads();
        newContact_.assign(newContact_.size(), Load());
    });
    shareResults();
    hasMeanContacts_ = false;
    touch_.wallLoads = stored.wallLoads;
    touch_.counts = stored.counts;
    touch_.wallCounts = stored.wallCounts;
    touch_.largestOverlap = stored.largestOverlap;
    touch_.peaks = stored.peaks;
    touch_.wallPeaks = stored.wallPeaks;
    states_ = predicted_ = result_;
    smooth_->restore(states_, stored.smooth.data());
}

} // namespace flotsam
