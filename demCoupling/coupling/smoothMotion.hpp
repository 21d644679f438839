// SPDX-License-Identifier: GPL-3.0-or-later
/// The motion of bodies as the fluid is given it.
///
/// The fluid's load is constant over a step, a body on contact springs vibrates within it: spring and fluid exchange impulses at the
/// step's rate, and with the velocity at the step's end the water's inertia feeds the vibration. One degree of freedom, sticking contact without
/// dashpot, added mass a times the mass, converged contact: a step multiplies it by up to 1.8 (a = 1), 3 (a = 2), at any step longer
/// than half the spring's period. Where a body was touched the fluid is therefore given what the mean velocities of the last two steps
/// extrapolate to: no growth for any a, spring and dashpot (docs/contact.md). Untouched bodies: the velocity itself.
#pragma once

#include "demCoupling/core/rigidBody.hpp"

#include <vector>

namespace flotsam
{

class SmoothMotion
{
public:
    SmoothMotion(const std::vector<BodyDefinition>& bodies, const std::vector<BodyState>& states);

    /// From the engine's last run: states before and after, mean contact loads over the step. isAnswered: bodies whose engine has what the fluid
    /// answers (fluidAnswer.hpp). They vibrate together with their water: their end velocity is its velocity as well.
    void find(const std::vector<BodyState>& before, const std::vector<BodyState>& after, const std::vector<Load>& contact, double dt,
        const std::vector<char>& isAnswered = {});

    /// That with fluid and weight leads from states() to what was found; without vibration the contact load [N, N m].
    const std::vector<Load>& drive() const { return drive_; }

    /// inFluid: the motions that the last solve gave the fluid. Touched bodies go on from them, so that what contact did not converge by is caught up;
    /// those marked in isFound from what was found.
    void accept(const std::vector<Motion>& inFluid, const std::vector<char>& isFound);
    void reset(int body, const BodyState& state);   ///< held or let go: no past

    /// At t^n: poses as in the engine, smooth velocities and angular momenta.
    const std::vector<BodyState>& states() const { return states_; }

    /// Sets states() beside the engine's, and back: save() gives 13 numbers a body.
    void restore(const std::vector<BodyState>& engine, const double* data);
    std::vector<double> save() const;
    static constexpr std::size_t perBody = 13;

private:
    struct Step { Motion mean; double dt = 0; };

    std::vector<BodyDefinition> bodies_;
    std::vector<BodyState> states_, engine_, found_;   // the latter: after the engine's last run
    std::vector<Step> last_, foundStep_;    // dt 0: the velocity at the start stands for a mean
    std::vector<Load> drive_;
    std::vector<char> isTouched_;
};

} // namespace flotsam
