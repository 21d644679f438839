// SPDX-License-Identifier: GPL-3.0-or-later
/// The repeats of a step: contact loads J with J = G(J), G = fluid solved with J, then the engine run with the fluid's loads.
///
/// The contraction of G is (added mass)/(mass + added mass), 0.5 to 0.7 for driftwood, hence Anderson acceleration; light bodies need
/// fluidAnswer.hpp besides.
#pragma once

#include "demCoupling/coupling/anderson.hpp"
#include "demCoupling/coupling/fluidAnswer.hpp"

namespace flotsam
{

class ContactIteration
{
public:
    ContactIteration(const std::vector<BodyDefinition>& bodies, const CouplingControls& controls);

    void begin(double dt);
    /// Whether `found`, what the engine answers to guess(), is the guess for this body.
    bool agrees(int body, const std::vector<Load>& found, const FluidAnswer& answer) const;
    /// Whether the last repeat of this step has left more than half of what fluid and engine differed by for this body.
    bool isSlow(int body, const std::vector<Load>& found, const FluidAnswer& answer) const;
    /// True when it is, or the repeats are spent; otherwise guess() is the next one.
    bool take(const std::vector<Load>& found, const FluidAnswer& answer);
    bool mayRepeat() const { return repeats_ < controls_.maxRepeats; }
    void forget() { anderson_.reset(); }            ///< G has changed

    const std::vector<Load>& guess() const { return guess_; }
    void setGuess(const std::vector<Load>& loads) { guess_ = loads; }

    int repeats() const { return repeats_; }
    double mismatch() const { return mismatch_; }   ///< of the last take(), as CouplingControls::tolerance

private:
    double change(int body, const std::vector<Load>& found, const FluidAnswer& answer) const;
    double scale(const std::vector<Load>& found, const FluidAnswer& answer) const;
    Vector6 scaled(int body, const Load& load) const;
    Load unscaled(int body, const Vector6& velocity) const;
    Vector6 velocity(int body, const Load& load, const FluidAnswer& answer) const;

    CouplingControls controls_;
    std::vector<double> masses_, arms_, changes_;
    std::vector<Load> guess_;
    Anderson anderson_;
    double dt_ = 0, mismatch_ = 0;
    int repeats_ = 0;
};

} // namespace flotsam
