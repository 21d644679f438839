// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/restraintStep.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace flotsam
{

namespace
{

constexpr double pi = 3.14159265358979323846;
constexpr double stepsPerSwing = 40;    // half a period: as a contact lasts
constexpr double dampedPart = 0.25;     // of a velocity that dashpots may take in a sub-step
// a given sub-step: velocity Verlet is stable below omega dt = 2, with the extrapolated dashpot below a rate of 1/dt
constexpr double largestPhase = 1, largestPart = 0.5;
constexpr double shortest = 1e-8;       // sub-step [s]

double mobilityOf(const RestraintEnd& end, const DemSetup& setup)
{
    return end.body < 0 ? 0 : largestMobility(setup.bodies[static_cast<size_t>(end.body)], end.place);
}

/// Of the point along a direction of space.
double mobilityAlong(const BodyDefinition& body, const Vec3& place, const Vec3& direction)
{
    const Vec3 turn = place.cross(body.pose.orientation.conjugate() * direction);
    return 1 / body.mass + turn.cwiseAbs2().cwiseQuotient(body.principalInertia).sum();
}

Vec3 placeOf(const RestraintEnd& end, const std::vector<BodyDefinition>& bodies, const std::vector<MoverDefinition>& movers, double startTime)
{
    Pose pose;
    Motion motion;
    if (end.body >= 0)
        pose = bodies[static_cast<size_t>(end.body)].pose;
    else if (end.mover >= 0)
        movers[static_cast<size_t>(end.mover)].motion(startTime, pose, motion);
    return pose.position + pose.orientation * end.place;
}

} // namespace

double largestMobility(const BodyDefinition& body, const Vec3& place)
{
    if (body.isPlanar)
    {
        const Vec3 normal = body.pose.orientation.conjugate() * Vec3::Unit(body.planeAxis);
        const double inertia = normal.cwiseAbs2().dot(body.principalInertia);
        return 1 / body.mass + place.cross(normal).squaredNorm() / inertia;
    }
    Eigen::Matrix3d turns; // column k: place x axis k
    for (int k = 0; k < 3; ++k)
        turns.col(k) = place.cross(Vec3::Unit(k));
    Eigen::Matrix3d mobility = turns.transpose() * body.principalInertia.cwiseInverse().asDiagonal() * turns;
    mobility.diagonal().array() += 1 / body.mass;
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(mobility, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

/// Between bodies (a - b)^2 <= (1 + s) a^2 + (1 + 1/s) b^2 with s the ratio of their mobilities, as SphereDamping does it: exact for a single
/// restraint and for a long chain of equal ones.
RestraintRates restraintRates(const DemSetup& setup)
{
    std::vector<RestraintRates> ofBodies(setup.bodies.size());
    for (const RestraintDefinition& r : setup.restraints)
    {
        const double mobility = mobilityOf(r.end, setup) + mobilityOf(r.other, setup);
        for (const RestraintEnd* end : {&r.end, &r.other})
        {
            if (end->body < 0)
                continue;
            RestraintRates& rates = ofBodies[static_cast<size_t>(end->body)];
            rates.stiffness += r.stiffness * mobility;
            rates.damping += r.damping * mobility;
        }
    }
    RestraintRates largest;
    for (const RestraintRates& rates : ofBodies)
        largest = {std::max(largest.stiffness, rates.stiffness), std::max(largest.damping, rates.damping)};
    return largest;
}

double restraintTimeStep(const DemSetup& setup)
{
    const RestraintRates rates = restraintRates(setup);
    double step = 1e300;
    if (rates.stiffness > 0)
        step = pi / std::sqrt(rates.stiffness) / stepsPerSwing;
    if (rates.damping > 0)
        step = std::min(step, dampedPart / rates.damping);
    return step;
}

void checkRestraintStep(const DemSetup& setup, double step)
{
    const RestraintRates rates = restraintRates(setup);
    const double phase = step * std::sqrt(rates.stiffness), part = step * rates.damping;
    std::ostringstream message;
    if (phase > largestPhase || part > largestPart)
        message << "the given sub-step of " << step << " s (demTimeStep of system/fvSolution) does not resolve the restraints: "
                << std::min(largestPhase / std::sqrt(std::max(rates.stiffness, 1e-300)), largestPart / std::max(rates.damping, 1e-300))
                << " s at most. Leave it out (it is then chosen), or give the restraints of constant/bodies less stiffness or damping";
    else if (step < shortest)
        message << "the restraints need a sub-step of " << step << " s, less than " << shortest << " s: too many for any run. Give those of the lightest body in constant/bodies less stiffness ("
                << rates.stiffness << " 1/s^2 over its mass) or damping (" << rates.damping << " 1/s over its mass)";
    if (!message.str().empty())
        throw DemError(message.str());
}

Vec3 initialLine(const RestraintDefinition& restraint, const std::vector<BodyDefinition>& bodies, const std::vector<MoverDefinition>& movers, double startTime)
{
    return placeOf(restraint.end, bodies, movers, startTime) - placeOf(restraint.other, bodies, movers, startTime);
}

RestraintPeriod naturalPeriod(const RestraintDefinition& r, const std::vector<BodyDefinition>& bodies, const std::vector<MoverDefinition>& movers, double startTime)
{
    const Vec3 line = initialLine(r, bodies, movers, startTime);
    double mobility = 0;
    for (const RestraintEnd* end : {&r.end, &r.other})
        if (end->body >= 0)
        {
            const BodyDefinition& body = bodies[static_cast<size_t>(end->body)];
            mobility += line.isZero(0) ? 1 / body.mass : mobilityAlong(body, end->place, line.normalized());
        }
    const double omega = std::sqrt(r.stiffness * mobility);
    return {2 * pi / omega, 0.5 * r.damping * mobility / omega};
}

} // namespace flotsam
