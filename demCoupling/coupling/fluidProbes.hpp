// SPDX-License-Identifier: GPL-3.0-or-later
/// Loads on light bodies for which the fluid is solved to see what it answers to them (fluidAnswer.hpp).
#pragma once

#include "demCoupling/coupling/fluidAnswer.hpp"

namespace flotsam
{

class FluidProbes
{
public:
    explicit FluidProbes(const std::vector<BodyDefinition>& bodies) : bodies_(bodies), isAsked_(bodies.size(), 0) {}

    void begin() { isAsked_.assign(isAsked_.size(), 0); }   ///< of a step

    /// Contact loads that the fluid was solved with, its loads, and the contact that these lead to: the probes are of that size.
    struct Solved { const std::vector<Load>&guess, &loads, &found; };
    /// All components of load on these bodies, but for those asked in this step already. True: there are some.
    bool choose(const std::vector<int>& bodies, const Solved& solved, const FluidAnswer& answer);
    int count() const { return int(probes_.size()); }
    std::vector<Load> guess(int probe) const;               ///< to solve the fluid with
    void take(int probe, const std::vector<Load>& loads);   ///< that it gave
    void finish(const std::vector<BodyState>& predicted, FluidAnswer& answer);

    const std::vector<Load>& guessBefore() const { return guess_; }
    const std::vector<char>& isAsked() const { return isAsked_; } ///< bodies, in this step

private:
    struct Probe { int body, component; double size; };

    std::vector<BodyDefinition> bodies_;
    std::vector<char> isAsked_;
    std::vector<Probe> probes_;
    std::vector<Load> guess_, loads_;
    std::vector<LoadShare> measured_;
};

} // namespace flotsam
