// SPDX-License-Identifier: GPL-3.0-or-later
/// What touches at the end of an engine's run: numbers of contacts, loads on walls, the deepest contact; what restraints have done in it.
#pragma once

#include "demCoupling/coupling/numberArchive.hpp"
#include "demCoupling/liggghts/liggghtsEngine.hpp"

#include <string>

namespace flotsam
{

struct ContactSummary
{
    std::vector<Load> wallLoads;        ///< walls, then movers: time means of the run, moments about the origin of space
    std::vector<Vec3> peaks, wallPeaks; ///< contact force in the sub-step in which it was largest: of bodies; of walls, then movers [N]
    std::vector<Vec3> groupPeaks;       ///< the same of DemSetup::wallGroups; not stored: they are of a step just made
    std::vector<int> counts, wallCounts; ///< contacts of each body; bodies that touch each wall
    std::vector<RestraintLoad> restraints;
    double largestOverlap = 0;          ///< of DEM surfaces [m]
    int deepestBody = -1, deepestOther = 0, pressing = -1; ///< as in Contact; a mover. Not stored: they only serve messages

    ContactSummary() = default;
    explicit ContactSummary(const DemSetup& setup);

    /// All but the loads of walls and restraints.
    void take(const std::vector<Contact>& contacts, const DemSetup& setup);

    /// Names of the pair that overlaps most, empty when nothing does and after a restart.
    std::string deepestPair(const DemSetup& setup) const;
    /// Name of a structure that moves and presses half as hard at least as the deepest contact on a body that touches something else, too, empty without:
    /// nothing stops it, it clamps the body.
    std::string pressingMover(const DemSetup& setup) const;
};

/// What ranks share after a run.
template <class Archive, class Summary>
void passSummary(Archive& archive, Summary& summary)
{
    passAll(archive, summary.wallLoads, summary.peaks, summary.wallPeaks, summary.groupPeaks, summary.counts, summary.wallCounts, summary.restraints,
        summary.largestOverlap, summary.deepestBody, summary.deepestOther, summary.pressing);
}

} // namespace flotsam
