// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/contactSummary.hpp"

#include <algorithm>

namespace flotsam
{

ContactSummary::ContactSummary(const DemSetup& setup)
:   wallLoads(setup.walls.size() + setup.movers.size()), peaks(setup.bodies.size(), Vec3::Zero()), wallPeaks(wallLoads.size(), Vec3::Zero()),
    groupPeaks(setup.wallGroups.size(), Vec3::Zero()), counts(setup.bodies.size(), 0), wallCounts(wallLoads.size(), 0), restraints(setup.restraints.size()) {}

std::string ContactSummary::deepestPair(const DemSetup& setup) const
{
    if (deepestBody < 0) return "";
    const int other = deepestOther, wall = -1 - other;
    const int mover = wall - int(setup.walls.size());
    const std::string name = other >= 0 ? "body " + setup.bodies[other].name : mover >= 0 ? "structure " + setup.movers[mover].name : setup.walls[wall].name;
    return "body " + setup.bodies[deepestBody].name + " and " + name;
}

std::string ContactSummary::pressingMover(const DemSetup& setup) const { return pressing < 0 ? "" : setup.movers[pressing].name; }

void ContactSummary::take(const std::vector<Contact>& contacts, const DemSetup& setup)
{
    std::fill(counts.begin(), counts.end(), 0);
    std::fill(wallCounts.begin(), wallCounts.end(), 0);
    largestOverlap = 0;
    deepestBody = pressing = -1;
    double force = 0; // half of the deepest's, then of the movers'
    for (const Contact& c : contacts)
    {
        ++counts[c.body];
        ++(c.other >= 0 ? counts[c.other] : wallCounts[-1 - c.other]);
        if (c.overlap <= largestOverlap) continue;
        largestOverlap = c.overlap;
        deepestBody = c.body;
        deepestOther = c.other;
        force = 0.5*c.force.norm();
    }
    for (const Contact& c : contacts)
    {
        const int mover = -1 - c.other - int(setup.walls.size());
        if (mover < 0 || counts[c.body] < 2 || !(c.force.norm() > force)) continue; // alone it pushes its body on
        force = c.force.norm();
        pressing = mover;
    }
}

} // namespace flotsam
