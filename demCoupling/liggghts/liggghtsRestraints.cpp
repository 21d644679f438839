// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/liggghtsRestraints.hpp"

#include "demCoupling/liggghts/reach.hpp"
#include "demCoupling/liggghts/restraintStep.hpp"

#include <cmath>

namespace flotsam
{

Restraints::Restraints(LiggghtsModel& model, const DemSetup& setup)
    : model_(model), definitions_(setup.restraints), bodies_(setup.bodies), lines_(setup.restraints.size()), sums_(lines_.size()), means_(lines_.size())
{
    for (BodyDefinition& body : bodies_)
    {
        body.spheres.clear();
        body.corners.clear();
    }
}

void Restraints::begin(const DemSetup& setup, double timeStep)
{
    if (!lines_.empty())
        checkRestraintStep(setup, timeStep);
    beginNew();
}

Restraints::End Restraints::at(const RestraintEnd& end) const
{
    const int body = indexOf(end);
    if (body < 0)
        return {end.place, Vec3::Zero(), Vec3::Zero()};
    const BodyArrays& b = model_.bodies;
    const Vec3 arm = Vec3::Map(b.ex[body]) * end.place[0] + Vec3::Map(b.ey[body]) * end.place[1] + Vec3::Map(b.ez[body]) * end.place[2];
    return {Vec3::Map(b.xcm[body]) + arm, Vec3::Map(b.vcm[body]) + Vec3::Map(b.omega[body]).cross(arm), arm};
}

void Restraints::addTo(const RestraintEnd& end, const Vec3& arm, const Vec3& force)
{
    const int body = indexOf(end);
    if (body < 0)
        return;
    Vec3::Map(model_.bodies.fcm[body]) += force;
    Vec3::Map(model_.bodies.torque[body]) += arm.cross(force);
}

/// The dashpot needs the velocity at the end of the sub-step, known there is that of its middle: the line through the last two is of second order, as all the rest
/// is. A dashpot that took the older velocity would damp as one of a lighter body, (m - c dt/2).
void Restraints::pull(const RestraintDefinition& restraint, Line& line, double step)
{
    line.force.setZero();
    line.tension = 0;
    if (line.isBroken)
        return;
    if (isGone(restraint.end) || isGone(restraint.other))
    {
        line.step = notPulled;
        return;
    }
    const End end = at(restraint.end), other = at(restraint.other);
    const Vec3 apart = end.place - other.place, velocity = end.velocity - other.velocity;
    Vec3 atEnd = velocity;
    if (line.step != notPulled && step > 0)
        atEnd += step / (step + line.step) * (velocity - line.velocity);
    line.velocity = velocity;
    line.step = step;
    const double length = apart.norm();
    if (length == 0)
        return; // no direction
    const Vec3 direction = apart / length;
    const double tension = restraint.tension(length, atEnd.dot(direction));
    line.isBroken = std::abs(tension) > restraint.breakingForce;
    if (line.isBroken || tension == 0)
        return;
    line.tension = tension;
    line.force = -tension * direction;
    addTo(restraint.end, end.arm, line.force);
    addTo(restraint.other, other.arm, -line.force);
}

void Restraints::pull(double step)
{
    for (size_t i = 0; i < lines_.size(); ++i)
        pull(definitions_[i], lines_[i], step);
}

void Restraints::beginNew()
{
    for (size_t i = 0; i < lines_.size(); ++i)
        if (lines_[i].step == notPulled)
            pull(definitions_[i], lines_[i], 0);
}

bool Restraints::mayPull(const std::vector<BodyState>& states, const std::vector<Load>& loads, const std::vector<char>& isHeld, double duration) const
{
    for (size_t i = 0; i < lines_.size(); ++i)
    {
        const RestraintDefinition& restraint = definitions_[i];
        if (lines_[i].isBroken || isGone(restraint.end) || isGone(restraint.other))
            continue;
        double way = 0;
        bool isFree = false;
        for (const RestraintEnd* end : {&restraint.end, &restraint.other})
        {
            const int body = indexOf(*end);
            if (body < 0 || isHeld[static_cast<size_t>(body)])
                continue;
            const size_t b = static_cast<size_t>(body);
            isFree = true;
            way += largestWay(bodies_[b], end->place, states[b], loads[b], duration);
        }
        if (!isFree)
            continue;
        if (restraint.kind == RestraintDefinition::Kind::LinearSpring || (at(restraint.end).place - at(restraint.other).place).norm() + way >= restraint.length)
            return true;
    }
    return false;
}

void Restraints::forget(int body)
{
    for (size_t i = 0; i < lines_.size(); ++i)
        if (indexOf(definitions_[i].end) == body || indexOf(definitions_[i].other) == body)
        {
            lines_[i].force.setZero();
            lines_[i].tension = 0;
        }
}

void Restraints::start() { sums_.assign(lines_.size(), {}); }

void Restraints::add(double weight)
{
    for (size_t i = 0; i < lines_.size(); ++i)
    {
        sums_[i].force += weight * lines_[i].force;
        sums_[i].tension += weight * lines_[i].tension;
    }
}

void Restraints::endStep(double step)
{
    add(step);
    for (size_t i = 0; i < lines_.size(); ++i)
        if (std::abs(lines_[i].tension) > std::abs(sums_[i].largest))
            sums_[i].largest = lines_[i].tension;
}

void Restraints::finish(double duration)
{
    for (size_t i = 0; i < sums_.size(); ++i)
        means_[i] = {sums_[i].force / duration, sums_[i].tension / duration, sums_[i].largest};
}

std::vector<RestraintLoad> Restraints::loads() const
{
    std::vector<RestraintLoad> result;
    for (size_t i = 0; i < lines_.size(); ++i)
    {
        const bool isThere = !isGone(definitions_[i].end) && !isGone(definitions_[i].other);
        const double length = isThere ? (at(definitions_[i].end).place - at(definitions_[i].other).place).norm() : 0;
        result.push_back({means_[i].force, means_[i].tension, means_[i].largest, length, lines_[i].isBroken});
    }
    return result;
}

void Restraints::append(std::vector<double>& data) const
{
    for (const Line& line : lines_)
    {
        data.insert(data.end(), line.force.data(), line.force.data() + 3);
        data.insert(data.end(), line.velocity.data(), line.velocity.data() + 3);
        data.insert(data.end(), {line.step, line.tension, static_cast<double>(line.isBroken)});
    }
}

void Restraints::appendWithNew(const std::vector<double>& data, size_t position, const std::vector<int>& stored, std::vector<double>& all) const
{
    if (data.size() != position + stored.size() * lineLength)
        throw DemError("DEM state: it belongs to another case (number of restraints differs)");
    if (stored.empty())
        return; // as a state without any: all begin
    const size_t begin = all.size();
    for (size_t i = 0; i < lines_.size(); ++i)
    {
        all.resize(all.size() + lineLength, 0.0);
        all[all.size() - 3] = notPulled;
    }
    for (size_t k = 0; k < stored.size(); ++k)
        std::copy_n(&data[position + k * lineLength], lineLength, &all[begin + static_cast<size_t>(stored[k]) * lineLength]);
}

size_t Restraints::read(const std::vector<double>& data, size_t position)
{
    if (position == data.size())
    {
        lines_.assign(lines_.size(), {});
        beginNew();
        return position;
    }
    if (data.size() < position + lines_.size() * lineLength)
        throw DemError("DEM state: it belongs to another case (number of restraints differs)");
    for (Line& line : lines_)
    {
        const double* v = data.data() + position;
        line = {Vec3(v[0], v[1], v[2]), Vec3(v[3], v[4], v[5]), v[6], v[7], static_cast<char>(v[8] != 0)};
        position += lineLength;
    }
    return position;
}

} // namespace flotsam
