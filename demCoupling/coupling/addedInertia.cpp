// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/addedInertia.hpp"

#include <algorithm>

namespace flotsam
{

double radiusOfInertia(const BodyDefinition& body) { return std::sqrt(body.principalInertia.maxCoeff()/body.mass); }

AddedInertia::AddedInertia(const std::vector<BodyDefinition>& bodies, const CouplingControls& controls)
:   bodies_(bodies), controls_(controls), factors_(bodies.size())
{}

double AddedInertia::expected(int b) const { return 1 + controls_.liquidDensity*bodies_[b].volume/bodies_[b].mass; }

double AddedInertia::largestFactor(int b) const { return 2*expected(b) - 1; }

bool AddedInertia::isLight(int b) const { return expected(b) >= leastFactor; }

InertiaFactor AddedInertia::doubt(int b) const
{
    if (!isLight(b)) return {};
    const double expected = this->expected(b);
    return {std::max(1.0, expected/factors_[b].mass), std::max(1.0, expected/factors_[b].turn)};
}

/// Of a change of load, by what it would change the engine's velocity at the surface: force, moment [m/s^2].
std::array<double, 2> AddedInertia::pull(int b, const Load& change) const
{
    const BodyDefinition& body = bodies_[b];
    return {change.force.norm()/(body.mass*factors_[b].mass), change.moment.norm()/(body.mass*factors_[b].turn*radiusOfInertia(body))};
}

/// What bodies answer to the changes of others spoils the answer, a factor too large diverges: only the largest changes count, and no more
/// added mass than twice the liquid a body displaces. Large is what moves the engine's body much: behind a force that its factor of mass has calmed
/// hides a moment that still turns it as if there were no fluid.
bool AddedInertia::raise(const std::vector<Load>& contactChange, const std::vector<Load>& fluidChange)
{
    std::vector<std::array<double, 2>> pulls;
    double largest = 0;
    for (std::size_t b = 0; b < bodies_.size(); ++b)
    {
        pulls.push_back(pull(int(b), contactChange[b]));
        largest = std::max({largest, pulls[b][0], pulls[b][1]});
    }
    const double least = std::max(0.5*largest, controls_.tolerance*controls_.gravity); // below: answers to others, noise
    bool isRaised = false;
    for (std::size_t b = 0; b < bodies_.size(); ++b)
    {
        const double most = largestFactor(int(b));
        auto raiseOne = [&](double& factor, double pull, const Vec3& change, const Vec3& answer)
        {
            if (pull < least || change.isZero(0)) return;
            const double r = -answer.dot(change)/change.squaredNorm();
            if (r <= 0 || r >= 1) return;
            const double wanted = std::min(1/(1 - r), most);
            while (wanted >= leastFactor && 2*factor <= wanted) { factor *= 2; isRaised = true; }
        };
        raiseOne(factors_[b].mass, pulls[b][0], contactChange[b].force, fluidChange[b].force);
        raiseOne(factors_[b].turn, pulls[b][1], contactChange[b].moment, fluidChange[b].moment);
    }
    return isRaised;
}

std::vector<Load> AddedInertia::engineLoads(const std::vector<Load>& given, const std::vector<Load>& contact) const
{
    std::vector<Load> loads(given);
    for (std::size_t b = 0; b < loads.size(); ++b)
    {
        const InertiaFactor s = factors_[b]; // 1: to the last bit
        if (s.mass != 1) loads[b].force = s.mass*loads[b].force + (s.mass - 1)*contact[b].force;
        if (s.turn != 1) loads[b].moment = s.turn*loads[b].moment + (s.turn - 1)*contact[b].moment;
    }
    return loads;
}

} // namespace flotsam
