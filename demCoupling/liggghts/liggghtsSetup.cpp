// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/liggghtsSetup.hpp"

#include "demCoupling/liggghts/reach.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

const DemSetup& checked(const DemSetup& setup)
{
    if (setup.bodies.empty())
        throw DemError("the DEM engine needs at least one body");
    if (!((setup.box[1] - setup.box[0]).minCoeff() > 0))
        throw DemError("the DEM box is empty: its upper corner must lie above its lower corner");
    if (!(setup.skin >= 0) || !(setup.timeStep >= 0))
        throw DemError("DEM: skin and timeStep must be >= 0 (0: chosen)");
    return setup;
}

/// Wide lists are rebuilt rarely and, thinned by NearSpheres, cost little: for spheres of millimetres they are wider. Where all spheres are far smaller, they must not hold whole scenes.
double chosenSkin(const DemSetup& setup)
{
    double smallest = 1e300;
    for (const BodyDefinition& body : setup.bodies)
        for (const SurfaceSphere& s : body.spheres)
            smallest = std::min(smallest, s.radius);
    constexpr double wide = 0.004; // [m]
    return std::max(1.6 * smallest, std::min(wide, 4 * smallest));
}

/// Movers are bodies on which no force acts, of the same inertia about any axis: LIGGGHTS keeps their velocities. Much heavier than the bodies, they do not give way in the
/// contact law either.
DemSetup withMovers(DemSetup setup)
{
    constexpr double heavier = 1e6;
    double heaviest = 0;
    for (const BodyDefinition& body : setup.bodies)
        heaviest = std::max(heaviest, body.mass);
    for (const MoverDefinition& mover : setup.movers)
    {
        BodyDefinition body;
        body.name = mover.name;
        body.spheres = mover.spheres;
        body.material = mover.material;
        mover.motion(setup.startTime, body.pose, body.motion);
        body.mass = heavier * heaviest;
        body.principalInertia.setConstant(body.mass * std::pow(outerRadius(body), 2));
        setup.bodies.push_back(std::move(body));
    }
    return setup;
}

} // namespace

DemSetup completed(const DemSetup& given)
{
    DemSetup setup = withMovers(checked(given));
    if (setup.skin == 0)
        setup.skin = chosenSkin(setup);
    return setup;
}

double freeFlightStep(const DemSetup& setup, const std::vector<BodyState>& states, const std::vector<Load>& loads, const std::vector<char>& isHeld,
                      const std::vector<char>& isGone, double duration)
{
    constexpr double largestAngle = 0.01; // [rad]: docs/contact.md has the table
    double fastest = 0;
    for (size_t b = 0; b < setup.bodies.size(); ++b)
    {
        if (isHeld[b] || isGone[b])
            continue;
        const double gained = loads[b].moment.norm() / setup.bodies[b].principalInertia.minCoeff() * duration;
        fastest = std::max(fastest, states[b].motion.angularVelocity.norm() + gained);
    }
    return fastest * duration > largestAngle ? largestAngle / fastest : duration;
}

} // namespace flotsam
