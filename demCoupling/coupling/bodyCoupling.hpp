// SPDX-License-Identifier: GPL-3.0-or-later
/// Predict - solve - correct between contact (microseconds, LIGGGHTS) and flow (milliseconds, one linear system).
///
///   begin(dt)      DEM state saved; poses predicted from the last velocities and net forces, contact loads from the last step
///   [fluid solved with contactLoads() on the bodies' rows]
///   correct(load)  DEM restored and run with the new load; true when the contact loads it gives are the ones the fluid was
///                  solved with. Otherwise contactLoads() holds the next guess: solve again
///   accept() or reject()
///
/// Without contact before and after the step the first correct() returns true: exactly one solve a step. A prediction by DEM
/// sub-steps would cost one more DEM run in every step.
/// The contact is the fixed point J = G(J); its contraction is r = (added mass)/(mass + added mass), 0.5 to 0.7 for
/// driftwood, hence Anderson acceleration. Where r approaches 1 (light bodies, water shut in between body and wall) any J is nearly a
/// fixed point: a load that presses the body into the wall is answered by the wall. So the engine is then given the body with s times its
/// mass and the load s (F + J) - J, which is the fluid's answer for an added mass of (s - 1) m: without a change of J the path is the solved
/// one, with s between (m + added mass)/(2 m) and twice that the contraction is a half at most. r is seen from what the fluid answers to a change of J.
/// Bodies that have left the mesh by its diagonal are held where they are. Rank 0 owns the engine; every rank holds the same states.
#pragma once

#include "demCoupling/coupling/anderson.hpp"
#include "demCoupling/liggghts/liggghtsEngine.hpp"

#include <mpi.h>

#include <functional>

namespace flotsam
{

struct CouplingControls
{
    double tolerance = 1e-2;    ///< change of contact acceleration over contact acceleration plus gravity that ends the repeats
    int maxRepeats = 8;
    double gravity = 9.81;      ///< |g| [m/s^2]
    double liquidDensity = 1000; ///< [kg/m^3]
};

class BodyCoupling
{
public:
    /// Collective. Throws std::runtime_error on every rank when the engine reports an error.
    BodyCoupling(const DemSetup& setup, const CouplingControls& controls, MPI_Comm comm);
    ~BodyCoupling();

    void begin(double time, double dt);
    bool correct(const std::vector<Load>& loads); ///< loads: fluid and weight, constant over the step
    /// Name of a body whose surface the last correct() put farther than `distance` [m] from where it was predicted; empty: none.
    std::string strayBody(double distance) const;
    void accept();
    void reject();

    int nBodies() const { return int(setup_.bodies.size()); }
    const BodyDefinition& definition(int body) const { return setup_.bodies[body]; }
    const WallDefinition& wall(int w) const { return setup_.walls[w]; }
    int nWalls() const { return int(setup_.walls.size()); }

    const std::vector<BodyState>& states() const { return states_; }        ///< at t^n (after accept(): the new time)
    const std::vector<BodyState>& predicted() const { return predicted_; }  ///< at t^(n+1), pose to cut with
    const std::vector<Load>& contactLoads() const { return contact_; }      ///< to solve the fluid with; after accept(): what acted
    const std::vector<Load>& lastLoads() const { return lastLoads_; }       ///< fluid and weight, mean over the last accepted step; held bodies: 0
    const std::vector<Load>& wallLoads() const { return wallLoads_; }       ///< time means of the last DEM run, moments about the origin of space
    const std::vector<int>& contactCounts() const { return contactCounts_; }
    const std::vector<int>& wallContactCounts() const { return wallContactCounts_; } ///< bodies that touch each wall
    bool isHeld(int body) const { return isHeld_[body]; }

    int repeats() const { return repeats_; }            ///< further solves needed in this step
    double mismatch() const { return mismatch_; }       ///< of the accepted contact, as CouplingControls::tolerance
    double largestOverlap() const { return largestOverlap_; } ///< of DEM surfaces at the end of the last run [m]
    double demTimeStep() const { return demTimeStep_; }

    /// Everything that continues the run exactly, and back. Collective; the same on every rank.
    std::vector<double> save() const;
    void restore(const std::vector<double>& data);

private:
    void runEngine(double duration, const std::vector<Load>& loads);
    void shareResults();
    BodyState drifted(int body) const;
    bool hasLeft(int body) const;
    double radiusOfInertia(int body) const;
    void raiseFactors(const std::vector<Load>& loads);
    std::vector<Load> engineLoads() const;
    void guarded(const std::function<void()>& work) const;
    Eigen::VectorXd scaled(const std::vector<Load>& loads) const;
    std::vector<Load> unscaled(const Eigen::VectorXd& values) const;

    DemSetup setup_;
    CouplingControls controls_;
    MPI_Comm comm_;
    int rank_ = 0;
    std::unique_ptr<LiggghtsEngine> engine_;    // rank 0
    DemState saved_;                            // rank 0
    bool isAtStart_ = false;                    // the engine is in the state saved_: no restore, which rebuilds the neighbour lists
    std::vector<BodyState> states_, predicted_, result_;
    std::vector<Load> lastLoads_, loads_, contact_, newContact_, wallLoads_, contactBefore_;
    std::vector<double> factors_;
    std::vector<int> contactCounts_, wallContactCounts_;
    std::vector<char> isHeld_;
    Anderson anderson_;
    double dt_ = 0, mismatch_ = 0, largestOverlap_ = 0, demTimeStep_ = 0;
    int repeats_ = 0;
};

} // namespace flotsam
