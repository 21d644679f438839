// SPDX-License-Identifier: GPL-3.0-or-later
/// What the log says of restraints before a run.
#include "demCoupling/foam/restraintReader.H"

#include "demCoupling/liggghts/restraintStep.hpp"
#include "foam/dictionaryChecks.H"

#include <cmath>

namespace flotsam
{

namespace
{

constexpr std::size_t mostLines = 20;

std::string describe(const RestraintEnd& end, const BodiesInput& input)
{
    if (end.body >= 0) return input.bodies[end.body].name;
    const std::string point = text('(', end.place[0], ' ', end.place[1], ' ', end.place[2], ')');
    return end.mover >= 0 ? "structure " + input.movers[end.mover].name : point;
}

std::string describe(const RestraintDefinition& r, const BodiesInput& input, double startTime)
{
    const double length = initialLine(r, input.bodies, input.movers, startTime).norm(), tension = r.tension(length, 0);
    const RestraintPeriod swing = naturalPeriod(r, input.bodies, input.movers, startTime);
    return text(r.name, ": ", r.kind == RestraintDefinition::Kind::Tether ? "tether" : "linear spring", " from ", describe(r.end, input), " to ", describe(r.other, input), ", ", length,
        " m long, unstretched ", r.length, " m: ", tension == 0 && length < r.length ? "slack" : text(tension, " N"), "; dry period ", swing.period, " s, damping ratio ", swing.dampingRatio);
}

/// Of the bodies that a restraint holds, one whose point lies outside.
std::string besideBody(const RestraintDefinition& r, const BodiesInput& input)
{
    constexpr double slight = 0.01; // of its thickness
    for (const RestraintEnd* end : {&r.end, &r.other})
    {
        if (end->body < 0) continue;
        const BodyDefinition& body = input.bodies[end->body];
        const double distance = body.shape->distance(end->place);
        if (distance > slight*body.thinnest) return text("its point on body ", body.name, " is ", distance, " m outside of that: as on a stiff arm without mass");
    }
    return "";
}

/// A point of space that is far away: in other units, or a slip of the pen.
std::string farAnchor(const RestraintDefinition& r, const BodiesInput& input)
{
    if (r.other.body >= 0 || r.other.mover >= 0) return "";
    const Vec3 &low = input.box[0], &high = input.box[1], &point = r.other.place;
    const double away = (point - point.cwiseMax(low).cwiseMin(high)).norm(), diagonal = (high - low).norm();
    return away > diagonal ? text("its anchor is ", away, " m away from the mesh, whose diagonal is ", diagonal, " m. Coordinates are in m") : "";
}

/// Within a step the water's load is constant: it feeds and damps no vibration that is faster.
std::string undamped(const RestraintDefinition& r, const BodiesInput& input, double startTime, double deltaT)
{
    constexpr double little = 0.05, enough = 0.2, steps = 10; // damping ratios; steps a period in which the water damps
    const RestraintPeriod swing = naturalPeriod(r, input.bodies, input.movers, startTime);
    if (swing.period > steps*deltaT || swing.dampingRatio >= little) return "";
    return text("a dry period of ", swing.period, " s, of few steps of the fluid, and a damping ratio of ", swing.dampingRatio, ": what it vibrates by within the steps goes on, and its largest tension is of that."
        " damping ", enough*r.stiffness*swing.period/M_PI, " would be a ratio of ", enough);
}

} // namespace

std::vector<std::string> doubtfulRestraints(const BodiesInput& input, double startTime, double deltaT)
{
    std::vector<std::string> doubts = input.doubts;
    for (const RestraintDefinition& r : input.restraints)
    {
        const std::string beside = besideBody(r, input);
        if (!beside.empty()) doubts.push_back(text("restraint ", r.name, ": ", beside, ". Points are given in space, of the body where constant/bodies puts it"));
        const std::string far = farAnchor(r, input);
        if (!far.empty()) doubts.push_back(text("restraint ", r.name, ": ", far));
        const std::string rings = undamped(r, input, startTime, deltaT);
        if (!rings.empty()) doubts.push_back(text("restraint ", r.name, " has ", rings));
        const double force = std::abs(r.tension(initialLine(r, input.bodies, input.movers, startTime).norm(), 0));
        if (force > r.breakingForce) doubts.push_back(text("restraint ", r.name, " breaks at once: ", force, " N at the start, breakingForce ", r.breakingForce, " N"));
    }
    return doubts;
}

void reportRestraints(const BodiesInput& input, double startTime, double deltaT)
{
    if (input.restraints.empty()) return;
    DemSetup setup;
    setup.bodies = input.bodies;
    setup.restraints = input.restraints;
    Foam::Info<< text("Restraints: ", input.restraints.size(), ", in sub-steps of ", restraintTimeStep(setup), " s at most (deltaT ", deltaT,
        " s). With the bodies where constant/bodies puts them (in water periods are longer):").c_str() << Foam::nl;
    for (std::size_t i = 0; i < std::min(mostLines, input.restraints.size()); ++i)
        Foam::Info<< "    " << describe(input.restraints[i], input, startTime).c_str() << Foam::nl;
    if (input.restraints.size() > mostLines) Foam::Info<< "    and " << input.restraints.size() - mostLines << " more" << Foam::nl;
    for (const std::string& doubt : doubtfulRestraints(input, startTime, deltaT)) Foam::Info<< "Warning: " << doubt.c_str() << Foam::nl;
}

} // namespace flotsam
