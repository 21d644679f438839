// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/smoothMotion.hpp"

namespace flotsam
{

namespace
{

constexpr double pull = 0.25;   // of the fluid's motion towards the engine's in a step, where contact has not quite converged

Motion meanMotion(const BodyState& before, const BodyState& after, double dt)
{
    const Eigen::AngleAxisd turn(after.pose.orientation*before.pose.orientation.conjugate());
    return {(after.pose.position - before.pose.position)/dt, turn.axis()*(turn.angle()/dt)};
}

/// The engine's state with another motion. One expression wherever it is needed: a restored run goes on the same to the last bit.
BodyState withMotion(const BodyDefinition& body, const BodyState& engine, const Motion& motion)
{
    BodyState state = engine;
    state.motion = motion;
    const Vec3 change = motion.angularVelocity - engine.motion.angularVelocity;
    const Eigen::Quaterniond& q = engine.pose.orientation;
    if (!change.isZero(0)) state.angularMomentum += q*(body.principalInertia.cwiseProduct(q.conjugate()*change));
    return state;
}

} // namespace

SmoothMotion::SmoothMotion(const std::vector<BodyDefinition>& bodies, const std::vector<BodyState>& states)
:   bodies_(bodies), states_(states), engine_(states), found_(states), last_(states.size()), foundStep_(states.size()), drive_(states.size()), isTouched_(states.size(), 0)
{
    for (std::size_t b = 0; b < states.size(); ++b) last_[b].mean = states[b].motion;
}

void SmoothMotion::find(const std::vector<BodyState>& before, const std::vector<BodyState>& after, const std::vector<Load>& contact, double dt,
    const std::vector<char>& isAnswered)
{
    for (std::size_t b = 0; b < bodies_.size(); ++b)
    {
        const Motion mean = meanMotion(before[b], after[b], dt);
        foundStep_[b] = {mean, dt};
        engine_[b] = found_[b] = after[b];
        drive_[b] = contact[b];
        isTouched_[b] = !contact[b].isZero();
        if (isTouched_[b] && (isAnswered.empty() || !isAnswered[b]))
        {
            const double share = dt/(dt + last_[b].dt);
            const Motion& last = last_[b].mean;
            found_[b] = withMotion(bodies_[b], after[b], {mean.velocity + share*(mean.velocity - last.velocity),
                mean.angularVelocity + share*(mean.angularVelocity - last.angularVelocity)});
        }
        // zero, to the last bit, where nothing touched
        drive_[b].force += bodies_[b].mass/dt*((found_[b].motion.velocity - after[b].motion.velocity) - (states_[b].motion.velocity - before[b].motion.velocity));
        drive_[b].moment += ((found_[b].angularMomentum - after[b].angularMomentum) - (states_[b].angularMomentum - before[b].angularMomentum))/dt;
    }
}

void SmoothMotion::accept(const std::vector<Motion>& inFluid, const std::vector<char>& isFound)
{
    for (std::size_t b = 0; b < bodies_.size(); ++b)
    {
        const bool goesOnInFluid = isTouched_[b] && !isFound[b];
        const Motion &fluid = inFluid[b], &found = found_[b].motion;
        states_[b] = goesOnInFluid ? withMotion(bodies_[b], engine_[b], {fluid.velocity + pull*(found.velocity - fluid.velocity),
                                                                         fluid.angularVelocity + pull*(found.angularVelocity - fluid.angularVelocity)})
                                   : found_[b];
    }
    last_ = foundStep_;
}

void SmoothMotion::reset(int body, const BodyState& state)
{
    states_[body] = state;
    last_[body] = {state.motion, 0};
}

std::vector<double> SmoothMotion::save() const
{
    std::vector<double> data;
    for (std::size_t b = 0; b < bodies_.size(); ++b)
    {
        for (const Vec3& v : {states_[b].motion.velocity, states_[b].motion.angularVelocity, last_[b].mean.velocity, last_[b].mean.angularVelocity})
            data.insert(data.end(), v.data(), v.data() + 3);
        data.push_back(last_[b].dt);
    }
    return data;
}

void SmoothMotion::restore(const std::vector<BodyState>& engine, const double* data)
{
    for (std::size_t b = 0; b < bodies_.size(); ++b, data += perBody)
    {
        auto at = [data](int k) { return Vec3(data[3*k], data[3*k + 1], data[3*k + 2]); };
        states_[b] = withMotion(bodies_[b], engine[b], {at(0), at(1)});
        last_[b] = {{at(2), at(3)}, data[12]};
    }
}

} // namespace flotsam
