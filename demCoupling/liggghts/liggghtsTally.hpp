// SPDX-License-Identifier: GPL-3.0-or-later
/// Adds up contact loads in every sub-step, exactly as the integrator uses them, and keeps the damping of the spheres up to date.
#pragma once

#include "demCoupling/liggghts/liggghtsDamping.hpp"

#include <mpi.h>

#include "fix.h"

namespace flotsam
{

/// A fix of our own in LIGGGHTS' list. Velocity Verlet gives every force half before and half after its sub-step,
/// so the time mean over a call is the trapezoid sum; it equals the change of momentum less the other loads.
class ContactTally : public LAMMPS_NS::Fix
{
public:
    ContactTally(LAMMPS_NS::LAMMPS* lammps, int count, char** arguments, LiggghtsModel& model, const DemSetup& setup)
        : LAMMPS_NS::Fix(lammps, count, arguments), model_(model), damping_(model, setup)
    {
        nevery = 1;
    }
    int setmask() override;
    void end_of_step() override;
    void setup_pre_neighbor() override { pre_neighbor(); }
    void pre_neighbor() override;
    void pre_force(int) override { damping_.beforeForces(nearPlane_); }
    /// LIGGGHTS makes its tables for the types in use: all of them, though no body may have some at the start.
    int min_type() override { return 1; }
    int max_type() override { return model_.contacts.typeCount(); }

    /// Puts a tally in place of a fix without effect: LIGGGHTS makes fixes only of styles it was compiled with.
    static void install(LiggghtsModel& model, const DemSetup& setup);

    /// Contact loads on bodies and walls at this instant (after set-up).
    void sample();
    void start();
    /// Before and after sub-steps of equal length [s].
    void startSteps(double step);
    void finishSteps();
    void finish(double duration);

    const std::vector<Load>& meanOnBodies() const { return bodyMean_; }
    const std::vector<Load>& meanOnWalls() const { return wallMean_; }
    bool hasContact() const { return hasContact_; }

    /// Loads of the walls at this instant, moments about the origin of space: part of the state.
    std::vector<Load>& wallsNow() { return wallNow_; }

private:
    bool readBodies();
    bool readWalls();
    bool readAll();
    Load planeLoad(size_t wall) const;
    void readMeshes();
    void readSharedMeshForces(const MeshGroup& group);
    void readSharedMeshMoments();
    void add(double weight);

    LiggghtsModel& model_;
    SphereDamping damping_;
    std::vector<Load> bodyNow_, bodySum_, bodyMean_, wallNow_, wallSum_, wallMean_;
    std::vector<std::vector<int>> nearPlane_; ///< per wall: spheres that can touch it before the next rebuild
    std::vector<MeshTouch> touches_;
    bool hasContact_ = false;
    double step_ = 0;   ///< [s]
};

} // namespace flotsam
