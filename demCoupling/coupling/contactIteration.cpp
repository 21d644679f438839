// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/contactIteration.hpp"

namespace flotsam
{

ContactIteration::ContactIteration(const std::vector<BodyDefinition>& bodies, const CouplingControls& controls)
:   controls_(controls), guess_(bodies.size()), guessBefore_(bodies.size())
{
    for (const BodyDefinition& body : bodies)
    {
        masses_.push_back(body.mass);
        arms_.push_back(radiusOfInertia(body));
    }
}

void ContactIteration::begin(double dt)
{
    dt_ = dt;
    repeats_ = 0;
    isNewGuess_ = false;
    anderson_.reset();
}

bool ContactIteration::take(const std::vector<Load>& loads, const AddedInertia& inertia)
{
    const std::vector<InertiaFactor>& factors = inertia.factors();
    const Eigen::VectorXd used = scaled(guess_, factors), found = scaled(loads, factors);
    if (found.size() == 0) return true;
    double change = 0;
    for (std::size_t b = 0; b < loads.size(); ++b)
    {
        const InertiaFactor doubt = inertia.doubt(int(b));
        change = std::max(change, doubt.mass*(found - used).segment<3>(6*b).cwiseAbs().maxCoeff());
        change = std::max(change, doubt.turn*(found - used).segment<3>(6*b + 3).cwiseAbs().maxCoeff());
    }
    const double scale = found.cwiseAbs().maxCoeff() + controls_.gravity*dt_, before = mismatch_;
    mismatch_ = scale > 0 ? change/scale : 0;
    if (repeats_ > 0 && mismatch_ > before) anderson_.reset(); // contacts that open or close: a plain step converges
    isNewGuess_ = mismatch_ > controls_.tolerance && repeats_ < controls_.maxRepeats;
    if (!isNewGuess_) return true;
    ++repeats_;
    guessBefore_ = guess_;
    guess_ = unscaled(anderson_.next(used, found), factors);
    return false;
}

std::vector<Load> ContactIteration::lastChange() const
{
    std::vector<Load> change(guess_.size());
    for (std::size_t b = 0; b < guess_.size(); ++b) change[b] = guess_[b] - guessBefore_[b];
    return change;
}

/// Contact loads as the velocity changes they make in one step [m/s].
Eigen::VectorXd ContactIteration::scaled(const std::vector<Load>& loads, const std::vector<InertiaFactor>& factors) const
{
    Eigen::VectorXd v(6*loads.size());
    for (std::size_t b = 0; b < loads.size(); ++b)
    {
        v.segment<3>(6*b) = loads[b].force*(dt_/(masses_[b]*factors[b].mass));
        v.segment<3>(6*b + 3) = loads[b].moment*(dt_/(masses_[b]*factors[b].turn*arms_[b]));
    }
    return v;
}

std::vector<Load> ContactIteration::unscaled(const Eigen::VectorXd& values, const std::vector<InertiaFactor>& factors) const
{
    std::vector<Load> loads(masses_.size());
    for (std::size_t b = 0; b < loads.size(); ++b)
    {
        loads[b].force = values.segment<3>(6*b)*(masses_[b]*factors[b].mass/dt_);
        loads[b].moment = values.segment<3>(6*b + 3)*(masses_[b]*factors[b].turn*arms_[b]/dt_);
    }
    return loads;
}

} // namespace flotsam
