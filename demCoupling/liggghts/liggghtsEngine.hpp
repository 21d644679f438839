// SPDX-License-Identifier: GPL-3.0-or-later
/// LIGGGHTS in process as a rigid-clump engine. The only interface to LIGGGHTS; no LIGGGHTS type is visible here.
#pragma once

#include "demCoupling/core/meanContact.hpp"
#include "demCoupling/core/restraint.hpp"
#include "demCoupling/core/rigidBody.hpp"
#include "demCoupling/core/storedMembers.hpp"

#include <memory>
#include <stdexcept>

namespace flotsam
{

/// Any error LIGGGHTS reports (its own exit/abort calls are turned into this).
struct DemError : std::runtime_error { using std::runtime_error::runtime_error; };

struct DemSetup
{
    std::vector<BodyDefinition> bodies;
    std::vector<WallDefinition> walls;
    std::vector<MoverDefinition> movers;
    std::vector<RestraintDefinition> restraints;
    std::vector<std::vector<int>> wallGroups;   ///< walls whose forces are added up before the largest is kept
    double startTime = 0;               ///< at which the movers begin [s]
    int nMaterials = 1;
    std::vector<ContactLaw> laws;       ///< nMaterials*nMaterials, symmetric
    std::array<Vec3, 2> box;            ///< region that holds everything; grows if a body leaves it
    double timeStep = 0;                ///< contact sub-step [s]; 0: chosen from stiffness, damping, masses, restraints (docs/contact.md)
    bool hasContactStepsOnly = false;   ///< contact sub-steps in free flight as well
    double skin = 0;                    ///< neighbour list skin [m]; 0: chosen from the radii of the spheres (docs/contact.md)
};

/// Everything needed to go on exactly: poses, momenta, loads, contact histories. Plain doubles: write it anywhere.
struct DemState { std::vector<double> data; };

/// Lives on ONE rank (rank 0); the coupling broadcasts. All vectors are indexed by body, in the order of DemSetup.
class LiggghtsEngine
{
public:
    explicit LiggghtsEngine(const DemSetup& setup);
    ~LiggghtsEngine();
    LiggghtsEngine(const LiggghtsEngine&) = delete;
    LiggghtsEngine& operator=(const LiggghtsEngine&) = delete;

    /// Of contact loads during the coming advances, of some bodies: the rest is answered at once by fluid that moves with them. Reset by the next call.
    void setShares(const std::vector<BodyShare>& shares);
    /// Constant loads (fluid force, weight, ...) for the coming advance(s); exact from the first half kick.
    void setLoads(const std::vector<Load>& loads);

    /// Advances all bodies by `duration` [s] with sub-steps of at most timeStep() (of at most `largestStep` when no body is
    /// within reach of another or of a wall during this interval; 0: in which no body turns by more than 0.01 rad, or timeStep() where that is longer). Contact results below refer to this call.
    void advance(double duration, double largestStep = 0);

    std::vector<BodyState> states() const;
    void findStates(std::vector<BodyState>& states) const;     ///< as the following, into memory that is kept
    void findMeans(std::vector<Load>& onBodies, std::vector<Load>& onWalls) const;
    void findPeaks(std::vector<Vec3>& onBodies, std::vector<Vec3>& onWalls, std::vector<Vec3>& onGroups) const;
    /// Time-mean contact force and moment of each body over the last advance (momentum balance, exact).
    std::vector<Load> meanContactLoads() const;
    /// Time-mean load on each wall, then on each mover, over the last advance, added up in every sub-step: the forces on all of them are the
    /// opposite of the sum over the bodies to round-off. Moments are about the origin of SPACE [N m] (mesh walls: to half
    /// the overlap times the friction force; movers: to half their way in the advance times the force).
    std::vector<Load> meanWallLoads() const;
    /// Contact force on each body, and on each wall and mover, in the sub-step of the last advance in which it was largest [N]; zero without contact.
    /// The first force of an advance is the last of the one before and does not count.
    std::vector<Vec3> peakContactForces() const;
    std::vector<Vec3> peakWallForces() const;
    std::vector<Vec3> peakGroupForces() const;  ///< the same of the sums over DemSetup::wallGroups
    /// Whether meanContacts() shall be known of the coming advances; costs a few per cent.
    void tallyPairs(bool isOn);
    /// Of the last advance, which was tallied: forces that add up, over the contacts of a body and with those of its restraints, to its meanContactLoads() to round-off. Movers count as walls behind the walls.
    std::vector<MeanContact> meanContacts() const;
    std::vector<Contact> contacts() const;      ///< movers count as walls behind the walls
    std::vector<RestraintLoad> restraintLoads() const;  ///< of the last advance; forces and moments on bodies and movers are part of their contact loads
    bool hasContact() const;            ///< any force of contact or restraints in any sub-step of the last advance
    long subSteps() const;              ///< of the last advance

    /// Where the movers shall be `duration` [s] from now: they go there evenly, whatever touches them. Before every advance() of that duration.
    void moveTo(const std::vector<Pose>& movers, double duration);
    /// Held bodies do not move (before their release time); their contact load is still computed. Let go, they get the motion of their
    /// definition.
    void setHeld(const std::vector<char>& isHeld);
    /// Bodies that are gone, or have not come yet (at the start those that enter at their release), rest where they are and touch nothing; they
    /// cost a sub-step 0.3 us each. They must be held; one that comes does so at the place it was at, and stays held.
    void setGone(const std::vector<char>& isGone);
    /// Sets pose and motion (the angular momentum follows from the angular velocity). A body whose pose changes loses
    /// its contact force of the instant, that of its restraints included; restore() is the way to go back in time.
    void setStates(const std::vector<BodyState>& states);

    DemState save() const;
    void save(DemState& state) const;      ///< into memory that is kept
    void restore(const DemState& state);    ///< exact: the same advance gives the same bits
    /// Of an engine with fewer bodies and restraints (and the same walls and movers). The others stay as they are: in an engine that has not advanced at their start.
    void restore(const DemState& state, const StoredMembers& stored);

    double timeStep() const;            ///< contact sub-step in use [s]

private:
    struct Implementation;
    std::unique_ptr<Implementation> impl_;
};

} // namespace flotsam
