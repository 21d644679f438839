// SPDX-License-Identifier: GPL-3.0-or-later
/// Adds up contact loads in every sub-step, exactly as the integrator uses them, and keeps the choice of spheres and their damping up to date.
#pragma once

#include "demCoupling/liggghts/liggghtsDamping.hpp"
#include "demCoupling/liggghts/liggghtsFacets.hpp"
#include "demCoupling/liggghts/liggghtsMeshTurns.hpp"
#include "demCoupling/liggghts/liggghtsPairs.hpp"

#include <mpi.h>

#include "atom.h"
#include "fix.h"
#include "lammps.h"

namespace flotsam
{

/// A fix of our own in LIGGGHTS' list. Velocity Verlet gives every force half before and half after its sub-step,
/// so the time mean over a call is the trapezoid sum; it equals the change of momentum less the other loads.
class ContactTally : public LAMMPS_NS::Fix
{
public:
    ContactTally(LAMMPS_NS::LAMMPS* lammps, int count, char** arguments, LiggghtsModel& model, const DemSetup& setup)
        : LAMMPS_NS::Fix(lammps, count, arguments), model_(model), damping_(model, setup), meshTurns_(model), facets_(model), pairs_(model), wallGroups_(setup.wallGroups)
    {
        nevery = 1;
    }
    int setmask() override;
    void end_of_step() override;
    void pre_initial_integrate() override { hideSpheres(); }
    void post_integrate() override;
    void setup_pre_neighbor() override { pre_neighbor(); }
    void pre_neighbor() override;
    void pre_force(int) override;
    void post_force(int) override;
    void pre_final_integrate() override;
    /// LIGGGHTS makes its tables for the types in use: all of them, though no body may have some at the start.
    int min_type() override { return 1; }
    int max_type() override { return model_.contacts.typeCount(); }

    static void install(LiggghtsModel& model, const DemSetup& setup);

    /// Forces of the planes on the spheres near them.
    void clearPlanes();

    /// Contact loads on bodies and walls at this instant (after set-up).
    void sample();
    void start();
    /// Before and after sub-steps of equal length [s].
    void startSteps(double step);
    void finishSteps();
    void finish(double duration);

    const std::vector<Load>& meanOnBodies() const { return bodyMean_; }
    const std::vector<Load>& meanOnWalls() const { return wallMean_; }
    /// Force of the sub-step in which it was largest since start().
    const std::vector<Vec3>& peakOnBodies() const { return bodyPeak_; }
    const std::vector<Vec3>& peakOnWalls() const { return wallPeak_; }
    const std::vector<Vec3>& peakOnGroups() const { return groupPeak_; }
    bool hasContact() const { return hasContact_; }
    PairTally& pairs() { return pairs_; }

    /// Loads of the walls at this instant, moments about the origin of space: part of the state.
    std::vector<Load>& wallsNow() { return wallNow_; }

private:
    /// LIGGGHTS moves the bodies and, of their spheres, none: NearSpheres says which are needed.
    void hideSpheres() { lmp->atom->nlocal = 0; }
    void showSpheres() { lmp->atom->nlocal = model_.firstSphere.back(); }
    bool readBodies();
    bool readWalls();
    bool readAll();
    Load planeLoad(size_t wall) const;
    void readMeshes();
    void readSharedMeshForces(const MeshGroup& group);
    void readSharedMeshMoments();
    void add(double weight);
    void clearPeaks();
    void keepPeaks();

    LiggghtsModel& model_;
    SphereDamping damping_;
    MeshTurns meshTurns_;
    FacetChoice facets_;
    PairTally pairs_;
    std::vector<Load> bodyNow_, bodySum_, bodyMean_, wallNow_, wallSum_, wallMean_;
    std::vector<std::vector<int>> wallGroups_;
    std::vector<Vec3> bodyPeak_, wallPeak_, groupPeak_;
    std::vector<std::vector<int>> nearPlane_; ///< per wall: spheres that can touch it before the next rebuild
    std::vector<MeshTouch> touches_;
    bool hasContact_ = false, isRebuilt_ = false;
    double step_ = 0;   ///< [s], 0 between calls
};

/// Before the walls' turn in a sub-step: they go through all spheres up to the last one, each of them, and need only those they may touch.
class WallLimit : public LAMMPS_NS::Fix
{
public:
    WallLimit(LAMMPS_NS::LAMMPS* lammps, int count, char** arguments, LiggghtsModel& model)
        : LAMMPS_NS::Fix(lammps, count, arguments), model_(model)
    {
    }
    int setmask() override { return LAMMPS_NS::FixConst::POST_FORCE; }
    void post_force(int) override;

    static void install(LiggghtsModel& model);

private:
    LiggghtsModel& model_;
};

} // namespace flotsam
