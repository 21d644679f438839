// SPDX-License-Identifier: GPL-3.0-or-later
/// Predict - solve - correct between contact (microseconds, LIGGGHTS) and flow (milliseconds, one linear system).
///
///   begin(dt)      DEM state saved; poses predicted from the last velocities and net forces, contact loads from the last step. Where a body goes far:
///                  poses of touched bodies from a run of the DEM with the last fluid loads
///   [fluid solved with contactGuess() on the bodies' rows]
///   correct(load)  DEM restored and run with the new load; holds when the contact loads it gives are the ones the fluid was
///                  solved with. Otherwise contactGuess() holds the next guess: solve again
///   accept() or reject()
///
/// Without contact before and after the step the first correct() holds: exactly one solve a step. A prediction by DEM
/// sub-steps costs one more DEM run: only steps in which a body that contact stops would end far from its drift have it.
/// The repeats: contactIteration.hpp; velocities of touched bodies: smoothMotion.hpp; light bodies: fluidAnswer.hpp; steps that must not be accepted: motionCheck.hpp.
/// Bodies that have left the mesh are taken out: they rest where they left, and touch nothing; so do those to come (BodyDefinition::entersAtRelease)
/// until they are let in. Rank 0 owns the engine; every rank holds the same states.
#pragma once

#include "demCoupling/coupling/contactIteration.hpp"
#include "demCoupling/coupling/contactSummary.hpp"
#include "demCoupling/coupling/couplingRecord.hpp"
#include "demCoupling/coupling/fluidProbes.hpp"
#include "demCoupling/coupling/motionCheck.hpp"
#include "demCoupling/coupling/smoothMotion.hpp"
#include "demCoupling/liggghts/liggghtsEngine.hpp"

#include <mpi.h>

#include <algorithm>
#include <functional>

namespace flotsam
{

enum class ContactAnswer
{
    Holds,      ///< contactGuess() was right
    Changes,    ///< contactGuess() is another now: solve again
    AsksFluid   ///< first solve for each of the probes, then correct() again with the same loads
};

class BodyCoupling
{
public:
    /// Collective. Throws std::runtime_error on every rank when the engine reports an error.
    BodyCoupling(const DemSetup& setup, const CouplingControls& controls, MPI_Comm comm);
    ~BodyCoupling();

    /// far: way of a body in the step [m] from which on its contacts count for the prediction.
    void begin(double time, double dt, double far);
    ContactAnswer correct(const std::vector<Load>& loads); ///< loads: fluid and weight, constant over the step
    int nProbes() const { return probes_.count(); }
    void startProbe(int probe) { iteration_.setGuess(probes_.guess(probe)); }   ///< contactGuess() is the one to solve with
    void takeProbe(int probe, const std::vector<Load>& loads) { probes_.take(probe, loads); } ///< as correct() would be given them
    void finishProbes();
    /// Name of a body whose surface the last correct() put farther than `distance` [m] from where it was predicted; empty: none.
    std::string strayBody(double distance) const { return check_.strayBody(predicted_, result_, distance); }
    /// What no contact can do but the last correct() did, in words; empty: nothing. fluidSpeed: the largest there was [m/s].
    std::string brokenContact(double fluidSpeed) const;
    void accept(const std::vector<Motion>& inFluid);    ///< the bodies' motions in the last solve
    void reject();

    int nBodies() const { return int(setup_.bodies.size()); }
    const BodyDefinition& definition(int body) const { return setup_.bodies[body]; }
    int nWalls() const { return int(setup_.walls.size() + setup_.movers.size()); }   ///< the movers come behind the walls

    const std::vector<BodyState>& states() const { return states_; }        ///< at t^n (after accept(): the new time)
    const std::vector<BodyState>& predicted() const { return predicted_; }  ///< at t^(n+1), pose to cut with
    const std::vector<BodyState>& smoothStates() const { return smooth_->states(); } ///< at t^n, as the fluid is given them: smoothMotion.hpp
    const std::vector<Load>& contactGuess() const { return iteration_.guess(); } ///< to solve the fluid with, from smoothStates()
    const std::vector<Load>& contactLoads() const { return contact_; } ///< mean over the last accepted step
    const std::vector<Load>& lastLoads() const { return lastLoads_; }       ///< fluid and weight, mean over the last accepted step; held bodies: 0
    const std::vector<Motion>& lastChanges() const { return lastChanges_; } ///< of smoothStates() in the last accepted step's solve, over the step
    const std::vector<Load>& wallLoads() const { return touch_.wallLoads; }       ///< time means of the last DEM run, moments about the origin of space
    const std::vector<Vec3>& contactPeaks() const { return touch_.peaks; }        ///< force in the sub-step of the last DEM run in which it was largest [N]
    const std::vector<Vec3>& wallPeaks() const { return touch_.wallPeaks; }
    const std::vector<Vec3>& groupPeaks() const { return touch_.groupPeaks; }    ///< of DemSetup::wallGroups
    const std::vector<int>& contactCounts() const { return touch_.counts; }
    const std::vector<int>& wallContactCounts() const { return touch_.wallCounts; } ///< bodies that touch each wall
    /// Whether meanContacts() of the coming steps will be asked for.
    void tallyContacts(bool isOn) { tallies_ = isOn; }
    /// Of the last step; null: it was not tallied. Rank 0 alone has them. Of a body taken out at its end those of the step are left.
    const std::vector<MeanContact>* meanContacts() const { return hasMeanContacts_ ? &meanContacts_ : nullptr; }
    const std::vector<RestraintLoad>& restraintLoads() const { return touch_.restraints; } ///< of the last DEM run; part of the contact loads
    bool isHeld(int body) const { return isHeld_[body]; }
    /// Of the step's mean fluid load and weight, lastLoads() the rest; share: Fluid::newLoadShare(). In its first step a body that was let go has only the new.
    double newLoadShare(int body, double share) const { return isJustReleased_[body] ? 1 : share; }

    /// Between steps: these are taken out, for good. Collective; every rank gives the same.
    void takeOut(const std::vector<char>& bodies);
    /// Between steps: an awaited body is there from now on, held until a step begins at its release time or later. Collective.
    void letIn(int body);
    Presence presence(int body) const { return presence_[body]; }
    bool isThere(int body) const { return presence_[body] == Presence::There; }
    const std::vector<char>& areAway() const { return areAway_; }  ///< per body: has left, or is to come
    int count(Presence p) const { return int(std::count(presence_.begin(), presence_.end(), p)); }
    bool isDue(int body, double time) const { return time >= setup_.bodies[body].releaseTime - 1e-9; }
    /// Beyond the mesh's bounding box by its diagonal: wherever it flies, it has left.
    bool isFarOff(int body) const;

    /// Whether there are bodies so light that the fluid may be asked what it answers to contact on them (fluidAnswer.hpp).
    bool hasLightBodies() const;
    int repeats() const { return iteration_.repeats(); } ///< further solves needed in this step
    double mismatch() const { return iteration_.mismatch(); } ///< of the accepted contact, as CouplingControls::tolerance
    double largestOverlap() const { return touch_.largestOverlap; } ///< of DEM surfaces at the end of the last run [m]
    std::string deepestPair() const { return touch_.deepestPair(setup_); }         ///< names, empty after a restart
    std::string pressingMover() const { return touch_.pressingMover(setup_); }     ///< name of a structure that clamps a body, empty: none
    double demTimeStep() const { return demTimeStep_; }

    /// Everything that continues the run exactly, and back. Collective; the same on every rank.
    std::vector<double> save() const;
    /// known: those that the state has (none: data is not read); the others begin, in an object that has not made a step.
    void restore(const std::vector<double>& data, const StoredMembers& known);

private:
    void runEngine(double duration, const std::vector<Load>& loads);
    void runEngineWith(const std::vector<Load>& given);
    void notePresence();
    void shareResults();
    CouplingRecord record() const;
    void restore(const CouplingRecord& stored, const std::function<void()>& restoreEngine);
    BodyState drifted(int body) const;
    double largestSpringSpeed() const;
    void predictContacts();
    bool chooseProbes();
    void hold(const std::vector<char>& isHeld);
    void moveTo(double time);
    template<class Work> void guarded(const Work& work) const;

    DemSetup setup_;
    CouplingControls controls_;
    MPI_Comm comm_;
    int rank_ = 0;
    std::unique_ptr<LiggghtsEngine> engine_;    // rank 0
    DemState saved_;                            // rank 0
    bool isAtStart_ = false;                    // the engine is in the state saved_: no restore, which rebuilds the neighbour lists
    std::vector<BodyState> states_, predicted_, result_;
    std::vector<Load> lastLoads_, loads_, newContact_, contact_;
    std::vector<Motion> lastChanges_;
    std::vector<Load> smoothing_, guessAtStart_; // smoothing_: of the guess, what is not contact
    std::vector<LoadShare> sharesAtStart_;
    NumberWriter sent_;                         // results of the engine, to all ranks
    ContactSummary touch_, touchAtStart_;       // of the engine's last run
    std::vector<MeanContact> meanContacts_;     // rank 0
    bool tallies_ = false, hasMeanContacts_ = true; // before the first step there are none
    std::vector<char> isHeld_, isJustReleased_;
    std::vector<Presence> presence_;
    std::vector<char> areAway_;                 // by presence_
    std::vector<Load> contactPart_, engineLoads_, newGuess_;    // work, as the next two
    std::vector<char> holds_, isFound_;
    ContactIteration iteration_;
    FluidAnswer answer_;
    FluidProbes probes_;
    MotionCheck check_;
    std::unique_ptr<SmoothMotion> smooth_;
    double dt_ = 0, demTimeStep_ = 0;
    double springSpeed_ = 0;    // what the springs can add to a body's speed in this step [m/s]
};

} // namespace flotsam
