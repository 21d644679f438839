// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/addedInertia.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

constexpr double leastFactor = 8; // below, repeats converge by themselves, and in a jam the factors of neighbours disturb each other

} // namespace

double radiusOfInertia(const BodyDefinition& body) { return std::sqrt(body.principalInertia.maxCoeff()/body.mass); }

AddedInertia::AddedInertia(const std::vector<BodyDefinition>& bodies, const CouplingControls& controls)
:   bodies_(bodies), controls_(controls), factors_(bodies.size(), 1)
{}

double AddedInertia::doubt(int b) const
{
    const double expected = 1 + controls_.liquidDensity*bodies_[b].volume/bodies_[b].mass;
    return expected < leastFactor ? 1 : std::max(1.0, expected/factors_[b]);
}

/// What bodies answer to the changes of others spoils the answer, a factor too large diverges: only the largest changes count, and no more
/// added mass than twice the liquid a body displaces.
bool AddedInertia::raise(const std::vector<Load>& contactChange, const std::vector<Load>& fluidChange)
{
    const std::size_t n = bodies_.size();
    std::vector<Eigen::Matrix<double, 6, 1>> change(n), answer(n);
    double largest = 0;
    for (std::size_t b = 0; b < n; ++b)
    {
        const double arm = radiusOfInertia(bodies_[b]);
        change[b] << contactChange[b].force, contactChange[b].moment/arm;
        answer[b] << fluidChange[b].force, fluidChange[b].moment/arm;
        largest = std::max(largest, change[b].norm());
    }
    bool isRaised = false;
    for (std::size_t b = 0; b < n; ++b)
    {
        const BodyDefinition& body = bodies_[b];
        if (change[b].norm() < 0.5*largest || change[b].norm() <= controls_.tolerance*body.mass*controls_.gravity) continue; // or noise
        const double r = -answer[b].dot(change[b])/change[b].squaredNorm();
        if (r <= 0 || r >= 1) continue;
        const double wanted = std::min(1/(1 - r), 1 + 2*controls_.liquidDensity*body.volume/body.mass);
        while (wanted >= leastFactor && 2*factors_[b] <= wanted) { factors_[b] *= 2; isRaised = true; }
    }
    return isRaised;
}

std::vector<Load> AddedInertia::engineLoads(const std::vector<Load>& given, const std::vector<Load>& contact) const
{
    std::vector<Load> loads(given);
    for (std::size_t b = 0; b < loads.size(); ++b)
    {
        const double s = factors_[b];
        if (s == 1) continue; // to the last bit
        loads[b].force = s*loads[b].force + (s - 1)*contact[b].force;
        loads[b].moment = s*loads[b].moment + (s - 1)*contact[b].moment;
    }
    return loads;
}

} // namespace flotsam
