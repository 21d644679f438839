// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/contactIteration.hpp"

namespace flotsam
{

ContactIteration::ContactIteration(const std::vector<BodyDefinition>& bodies, const CouplingControls& controls)
:   controls_(controls), changes_(bodies.size()), guess_(bodies.size())
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
    anderson_.reset();
}

/// As the velocity that the load makes in one step, of turning at the radius of inertia [m/s].
Vector6 ContactIteration::scaled(int b, const Load& load) const
{
    Vector6 v;
    v << load.force*(dt_/masses_[b]), load.moment*(dt_/(masses_[b]*arms_[b]));
    return v;
}

Load ContactIteration::unscaled(int b, const Vector6& v) const
{
    return {v.head<3>()*(masses_[b]/dt_), v.tail<3>()*(masses_[b]*arms_[b]/dt_)};
}

/// The same, with what the fluid answers to the load.
Vector6 ContactIteration::velocity(int b, const Load& load, const FluidAnswer& answer) const
{
    return scaled(b, answer.isKnown(b) ? asLoad(answer.shares()[b]*asVector(load)) : load);
}

double ContactIteration::change(int b, const std::vector<Load>& found, const FluidAnswer& answer) const
{
    return answer.doubt(b)*(velocity(b, found[b], answer) - velocity(b, guess_[b], answer)).cwiseAbs().maxCoeff();
}

double ContactIteration::scale(const std::vector<Load>& found, const FluidAnswer& answer) const
{
    double largest = 0;
    for (int b = 0; b < int(found.size()); ++b) largest = std::max(largest, velocity(b, found[b], answer).cwiseAbs().maxCoeff());
    return largest + controls_.gravity*dt_;
}

bool ContactIteration::agrees(int b, const std::vector<Load>& found, const FluidAnswer& answer) const
{
    return change(b, found, answer) <= controls_.tolerance*scale(found, answer);
}

bool ContactIteration::isSlow(int b, const std::vector<Load>& found, const FluidAnswer& answer) const
{
    return repeats_ > 0 && change(b, found, answer) > 0.5*changes_[b];
}

bool ContactIteration::take(const std::vector<Load>& found, const FluidAnswer& answer)
{
    const double before = mismatch_, scale = this->scale(found, answer);
    double largest = 0;
    for (int b = 0; b < int(found.size()); ++b) largest = std::max(largest, changes_[b] = change(b, found, answer));
    mismatch_ = scale > 0 ? largest/scale : largest > 0; // without gravity and contact: whether one was expected
    if (repeats_ > 0 && mismatch_ > before) anderson_.reset(); // contacts that open or close: a plain step converges
    if (!(mismatch_ > controls_.tolerance) || !mayRepeat()) return true;
    ++repeats_;
    Eigen::VectorXd image(6*found.size()), residual(6*found.size());
    for (int b = 0; b < int(found.size()); ++b)
    {
        image.segment<6>(6*b) = scaled(b, found[b]);
        residual.segment<6>(6*b) = velocity(b, found[b], answer) - velocity(b, guess_[b], answer);
    }
    const Eigen::VectorXd next = anderson_.next(image, residual);
    for (int b = 0; b < int(found.size()); ++b) guess_[b] = unscaled(b, next.segment<6>(6*b));
    return false;
}

} // namespace flotsam
