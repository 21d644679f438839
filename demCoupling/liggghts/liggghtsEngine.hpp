// SPDX-License-Identifier: GPL-3.0-or-later
/// LIGGGHTS in process as a rigid-clump engine. The only interface to LIGGGHTS; no LIGGGHTS type is visible here.
#pragma once

#include "demCoupling/core/rigidBody.hpp"

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
    int nMaterials = 1;
    std::vector<ContactLaw> laws;       ///< nMaterials*nMaterials, symmetric
    std::array<Vec3, 2> box;            ///< region that holds everything; grows if a body leaves it
    double timeStep = 0;                ///< [s]; 0: chosen from stiffness, damping and masses (see contactTimeStep())
    double skin = 0.004;                ///< neighbour list skin [m]
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

    /// Constant loads (fluid force, weight, ...) for the coming advance(s); exact from the first half kick.
    void setLoads(const std::vector<Load>& loads);

    /// Advances all bodies by `duration` [s] with sub-steps of at most timeStep() (of at most `largestStep` when no body is
    /// within reach of another or of a wall during this interval). Contact results below refer to this call.
    void advance(double duration, double largestStep = 1e-4);

    std::vector<BodyState> states() const;
    /// Time-mean contact force and moment of each body over the last advance (momentum balance, exact).
    std::vector<Load> meanContactLoads() const;
    /// Time-mean force on each wall over the last advance [N] (sum over bodies; momentum-consistent within a stated error).
    std::vector<Load> meanWallLoads() const;
    std::vector<Contact> contacts() const;
    bool hasContact() const;            ///< any contact in any sub-step of the last advance
    long subSteps() const;              ///< of the last advance

    /// Held bodies do not move (before their release time); their contact load is still computed.
    void setHeld(const std::vector<char>& isHeld);
    void setStates(const std::vector<BodyState>& states);

    DemState save() const;
    void restore(const DemState& state);    ///< exact: the same advance gives the same bits

    double timeStep() const;            ///< contact sub-step in use [s]

private:
    struct Implementation;
    std::unique_ptr<Implementation> impl_;
};

} // namespace flotsam
