// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/velocityChoice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flotsam
{

namespace
{

constexpr double leastNumber = 0.3; // below, cycles save less than they cost even in a moving start
constexpr double firstNumber = 1;   // from there on they are the first choice: a moving start does not converge without them
constexpr double cycleCost = 2.2;   // of an iteration with cycles over one with diagonal blocks, 2D and 3D
constexpr int memory = 4;           // solves in the running mean

} // namespace

void VelocityChoice::choose(bool cycles)
{
    if (usesCycles_ && nSolves_ > 0) costOfCycles_ = cost_;
    usesCycles_ = cycles;
    nSolves_ = 0;
}

/// What a solve with diagonal blocks may cost.
double VelocityChoice::worth() const
{
    return costOfCycles_ > 0 ? costOfCycles_ : patience_;
}

void VelocityChoice::beginStep(double viscousNumber)
{
    canPay_ = viscousNumber >= leastNumber;
    const bool isFirst = std::exchange(isFirst_, false);
    if (isFirst) choose(viscousNumber >= firstNumber);
    else if (usesCycles_ && !canPay_) choose(false);
    else if (usesCycles_ && nSolves_ >= wait_)
    {
        choose(false);
        wait_ *= 2;
    }
    else if (!usesCycles_ && canPay_ && nSolves_ > 0 && cost_ > worth()) choose(true);
}

int VelocityChoice::limit() const
{
    if (usesCycles_ || !canPay_) return 0;
    const double few = nSolves_ > 0 ? 2 : 1; // a trial is not worth more than what it is to save
    return int(std::ceil(few*worth()));
}

void VelocityChoice::giveUpDiagonal()
{
    choose(true);
}

void VelocityChoice::count(int iterations)
{
    const double cost = iterations*(usesCycles_ ? cycleCost : 1);
    ++nSolves_;
    cost_ = nSolves_ == 1 ? cost : cost_ + (cost - cost_)/std::min(nSolves_, memory);
}

} // namespace flotsam
