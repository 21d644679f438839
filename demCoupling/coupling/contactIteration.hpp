// SPDX-License-Identifier: GPL-3.0-or-later
/// The repeats of a step: contact loads J with J = G(J), G = fluid solved with J, then the engine run with the fluid's loads.
///
/// The contraction of G is (added mass)/(mass + added mass), 0.5 to 0.7 for driftwood, hence Anderson acceleration; light bodies need
/// addedInertia.hpp besides.
#pragma once

#include "demCoupling/coupling/addedInertia.hpp"
#include "demCoupling/coupling/anderson.hpp"

namespace flotsam
{

class ContactIteration
{
public:
    ContactIteration(const std::vector<BodyDefinition>& bodies, const CouplingControls& controls);

    void begin(double dt);
    /// `found`: what the engine answers to guess(), with that inertia. True when that is the guess, or the repeats
    /// are spent; otherwise guess() is the next one.
    bool take(const std::vector<Load>& found, const AddedInertia& inertia);
    void forget() { anderson_.reset(); }            ///< G has changed

    const std::vector<Load>& guess() const { return guess_; }
    void setGuess(const std::vector<Load>& loads) { guess_ = loads; }
    std::vector<Load> lastChange() const;           ///< of the guess, within this step

    int repeats() const { return repeats_; }
    bool isNewGuess() const { return isNewGuess_; } ///< of the last take()
    double mismatch() const { return mismatch_; }   ///< of the last take(), as CouplingControls::tolerance

private:
    Eigen::VectorXd scaled(const std::vector<Load>& loads, const std::vector<InertiaFactor>& factors) const;
    std::vector<Load> unscaled(const Eigen::VectorXd& values, const std::vector<InertiaFactor>& factors) const;

    CouplingControls controls_;
    std::vector<double> masses_, arms_;
    std::vector<Load> guess_, guessBefore_;
    Anderson anderson_;
    double dt_ = 0, mismatch_ = 0;
    int repeats_ = 0;
    bool isNewGuess_ = false;
};

} // namespace flotsam
