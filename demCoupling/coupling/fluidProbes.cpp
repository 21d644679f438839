// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/fluidProbes.hpp"

namespace flotsam
{

namespace
{

/// As a force: of its moment at this arm.
double sizeOf(const Load& load, double arm) { return std::max(load.force.norm(), load.moment.norm()/arm); }

} // namespace

bool FluidProbes::choose(const std::vector<int>& bodies, const Solved& solved, const FluidAnswer& answer)
{
    guess_ = solved.guess;
    loads_ = solved.loads;
    measured_.assign(bodies_.size(), LoadShare::Identity());
    for (const int b : bodies)
    {
        const double arm = radiusOfInertia(bodies_[b]), force = std::max(sizeOf(solved.found[b], arm), sizeOf(solved.guess[b], arm));
        if (isAsked_[b] || force == 0) continue;
        isAsked_[b] = 1;
        for (const int k : answer.components(b)) probes_.push_back({b, k, k < 3 ? force : force*arm});
    }
    return !probes_.empty();
}

std::vector<Load> FluidProbes::guess(int probe) const
{
    const Probe& p = probes_[probe];
    std::vector<Load> guess = guess_;
    (p.component < 3 ? guess[p.body].force : guess[p.body].moment)[p.component % 3] += p.size;
    return guess;
}

void FluidProbes::take(int probe, const std::vector<Load>& loads)
{
    const Probe& p = probes_[probe];
    measured_[p.body].col(p.component) += asVector(loads[p.body] - loads_[p.body])/p.size;
}

void FluidProbes::finish(const std::vector<BodyState>& predicted, FluidAnswer& answer)
{
    for (const Probe& p : probes_) answer.set(p.body, measured_[p.body], predicted[p.body].pose.orientation);
    probes_.clear();
}

} // namespace flotsam
