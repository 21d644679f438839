// SPDX-License-Identifier: GPL-3.0-or-later
/// Whether diagonal blocks (velocityBlock.hpp) or V-cycles (viscousBlock.hpp) precondition the velocities: what has cost less. Cost is counted in iterations, not by
/// clocks, so that a run can be repeated. The viscous number alone does not tell: at 1 diagonal blocks take many times the iterations of cycles in a moving
/// start, hardly more in a smooth flow.
#pragma once

namespace flotsam
{

class VelocityChoice
{
public:
    /// patience: iterations of diagonal blocks that are too many while the cost of cycles is not known.
    explicit VelocityChoice(int patience) : patience_(patience) {}

    /// A new step's system; viscousNumber: FlowSystem::viscousNumber.
    void beginStep(double viscousNumber);
    bool usesCycles() const { return usesCycles_; }

    /// Iterations after which a solve with diagonal blocks goes on with cycles; 0: never.
    int limit() const;
    /// A solve has reached the limit: cycles from now on.
    void giveUpDiagonal();
    /// Iterations that the first solve of a step took with the present choice.
    void count(int iterations);

    /// What comes depends on the next system alone.
    void forget() { *this = VelocityChoice(patience_); }

private:
    void choose(bool cycles);
    double worth() const;

    int patience_;
    bool canPay_ = false;       // whether cycles can, at the present viscous number
    bool usesCycles_ = false;
    bool isFirst_ = true;       // no system seen
    int nSolves_ = 0;           // counted with the present choice
    double cost_ = 0;           // their running mean, in iterations with diagonal blocks
    double costOfCycles_ = 0;   // the last one known; 0: none
    int wait_ = 4;              // solves with cycles before diagonal blocks are tried; doubled by every trial
};

} // namespace flotsam
