// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/bodyChecks.H"

#include "demCoupling/foam/continuedMotion.H"
#include "demCoupling/foam/motionChecks.H"
#include "foam/dictionaryChecks.H"
#include "io/runLog.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

const std::string& nameOf(const BodyDefinition& body) { return body.name; }
const std::string& nameOf(const StructureDefinition& structure) { return structure.solid.name; }

/// The first body or structure that is meant, and " and n more"; empty: there is none.
template<class Member, class IsMeant>
std::pair<const Member*, std::string> firstOf(const std::vector<Member>& members, IsMeant isMeant)
{
    const auto first = std::find_if(members.begin(), members.end(), isMeant);
    if (first == members.end()) return {nullptr, ""};
    const auto others = std::count_if(first + 1, members.end(), isMeant);
    return {&*first, others > 0 ? text(nameOf(*first), " (and ", others, " more)") : nameOf(*first)};
}

/// Of the contacts of this material the stiffest that is the body's own, not its spheres'; 0: some is the spheres', whose number is unknown here.
double largestStiffness(const BodiesInput& input, int material)
{
    double largest = 0;
    const std::size_t n = input.materials.size();
    for (std::size_t other = 0; other < n; ++other)
    {
        const ContactLaw& law = input.laws[material*n + other];
        if (!law.perBody) return 0;
        largest = std::max(largest, law.stiffness);
    }
    return largest;
}

struct Stream { Vec3 velocity = Vec3::Zero(); bool isThere = false; };

/// Mean of the liquid at the nodes in the box around a body; where there are none, within `around` of it.
Stream streamAt(const BodyDefinition& body, const SimplexMesh& mesh, const Halo& halo, const FlowState& state, double around)
{
    const std::array<Vec3, 2> own = body.shape->bounds();
    const Vec3 centre = body.pose.position + body.pose.orientation*(0.5*(own[0] + own[1])),
        half = body.pose.orientation.toRotationMatrix().cwiseAbs()*(0.5*(own[1] - own[0]));
    for (const double margin : {0.0, around})
    {
        double sums[4] = {};    // of alpha u, and of alpha
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            const auto x = mesh.spacePoint(i);
            if (((Vec3(x[0], x[1], x[2]) - centre).cwiseAbs() - half).maxCoeff() > margin) continue;
            for (int d = 0; d < mesh.dim; ++d) sums[mesh.axes[d]] += state.alpha[i]*state.u[std::size_t(i)*mesh.dim + d];
            sums[3] += state.alpha[i];
        }
        halo.sum(sums, 4);
        if (sums[3] > 0) return {Vec3(sums[0], sums[1], sums[2])/sums[3], true};
    }
    return {};
}

bool isRestrained(int body, const BodiesInput& input)
{
    const auto holds = [&](const RestraintDefinition& r) { return r.end.body == body || r.other.body == body; };
    return std::any_of(input.restraints.begin(), input.restraints.end(), holds);
}

} // namespace

std::string bodyInStream(const BodiesInput& input, const SimplexMesh& mesh, const Halo& halo, const FluidProperties& fluid, const FlowState& state, double time)
{
    constexpr double slow = 0.1;        // speed over sqrt(g times a body's thickness)
    constexpr int mostBodies = 50;      // that are looked at: those of a group are in the same stream
    const double gravity = std::hypot(fluid.gravity[0], fluid.gravity[1], fluid.gravity[2]);
    if (gravity == 0) return "";        // nothing to compare a speed with
    double fastest = 0;
    for (const double u : state.u) fastest = std::max(fastest, std::abs(u));
    if (halo.max(fastest) == 0) return "";
    const double shortest = halo.min(mesh.h.empty() ? 1e300 : *std::min_element(mesh.h.begin(), mesh.h.end()));
    int looked = 0;
    for (const BodyDefinition& body : input.bodies)
    {
        const bool isAtRest = body.motion.velocity.isZero(0) && body.motion.angularVelocity.isZero(0);
        if (body.entersAtRelease || body.releaseTime > time || !isAtRest) continue;
        if (++looked > mostBodies) break;
        const Stream stream = streamAt(body, mesh, halo, state, shortest);
        const Vec3& u = stream.velocity;
        if (!stream.isThere || u.norm() <= slow*std::sqrt(gravity*body.thinnest)) continue;
        const std::string doubt = text("body ", body.name, " is let go at rest in a stream of ", u.norm(), " m/s that is there from the start: the first step throws it along with a good part of that speed");
        if (isRestrained(int(&body - input.bodies.data()), input)) return doubt + ", and its restraints stop it with a jerk. Hold it until the stream has found its way around it, `releaseTime`";
        return text(doubt, ". Let it move with the stream, `velocity (", u[0], ' ', u[1], ' ', u[2], ");`, or hold it until the stream has found its way around it, `releaseTime`");
    }
    return "";
}

namespace
{

/// Bodies whose edges, rounded in contact, are wider than others are thick: these sink into them and slide off. Empty: none.
std::string roundedEdges(const BodiesInput& input)
{
    const double thinnest = thinnestBody(input);
    const auto isRounded = [&](const BodyDefinition& b) { return b.shape->hasPlaneFaces() && b.spheres.front().radius > thinnest; };
    const auto [body, who] = firstOf(input.bodies, isRounded);
    if (!body) return "";
    const double radius = body->spheres.front().radius;
    return text("body ", who, " is thick beside others, of ", thinnest, " m: in contact its edges are rounded by the radius of its spheres, ", radius,
        " m, and those sink into them and slide off. Where that matters give it `spheres { radius ", thinnest, "; }`");
}

} // namespace

std::vector<std::string> doubtfulBodies(const BodiesInput& input, const FluidProperties& fluid, double endTime)
{
    std::vector<std::string> doubts;
    const auto isBalloon = [&](const BodyDefinition& b) { return fluid.isTwoPhase && b.mass < fluid.rhoGas*b.volume; };
    if (const auto [body, who] = firstOf(input.bodies, isBalloon); body)
        doubts.push_back(text("body ", who, " is lighter than the gas (density ", body->mass/body->volume, ", gas ", fluid.rhoGas,
            " kg/m^3) and rises in it. Densities are in kg/m^3, not over water's"));
    constexpr double densest = 22600;   // osmium [kg/m^3]
    const auto isImpossible = [&](const BodyDefinition& b) { return b.mass > densest*b.volume; };
    if (const auto [body, who] = firstOf(input.bodies, isImpossible); body)
        doubts.push_back(text("body ", who, " has density ", body->mass/body->volume, " kg/m^3, more than any matter: mass ", body->mass, " kg in ", body->volume,
            " m^3. Is `mass` in kg, `density` in kg/m^3, the shape in m? In 2D the mass is that of the mesh's thickness"));

    const auto& g = fluid.gravity;
    const double gravity = std::hypot(g[0], g[1], g[2]);
    const auto depth = [&](const BodyDefinition& b)
    {
        const double stiffness = largestStiffness(input, b.material);
        return stiffness > 0 ? b.mass*gravity/stiffness : 0;
    };
    const auto isSoft = [&](const BodyDefinition& b) { return depth(b) > RunLog::deepOverlap*b.thinnest; };
    if (const auto [body, who] = firstOf(input.bodies, isSoft); body)
        doubts.push_back(text("contact is too soft for body ", who, ": its weight alone (", body->mass*gravity, " N) presses it ", depth(*body), " m, ",
            std::round(100*depth(*body)/body->thinnest), " % of its thickness, into what it lies on. Give constant/bodies more `stiffness`, ",
            body->mass*gravity/(0.005*body->thinnest), " N/m for half a per cent"));

    constexpr double smoothest = 1.5;   // degrees; steel slides on ice with about 1
    const auto isCoefficient = [](const ContactLaw& law) { return law.frictionAngleDeg > 0 && law.frictionAngleDeg < smoothest; };
    if (const auto law = std::find_if(input.laws.begin(), input.laws.end(), isCoefficient); law != input.laws.end())
        doubts.push_back(text("frictionAngle ", law->frictionAngleDeg, " of constant/bodies is in degrees, a friction coefficient of ", std::tan(law->frictionAngleDeg*M_PI/180),
            ": for a coefficient of ", law->frictionAngleDeg, " give ", std::atan(law->frictionAngleDeg)*180/M_PI));

    for (const std::string& doubt : doubtfulMotions(input, gravity, endTime)) doubts.push_back(doubt);

    if (const std::string edges = roundedEdges(input); !edges.empty()) doubts.push_back(edges);

    const auto staysHeld = [&](const BodyDefinition& b) { return b.releaseTime > 0 && b.releaseTime >= endTime; };
    if (const auto [body, who] = firstOf(input.bodies, staysHeld); body)
        doubts.push_back(text("body ", who, body->entersAtRelease ? " does not enter" : " is held all the time", ": its release, at ", body->releaseTime, " s, is not before endTime, ", endTime,
            " s"));
    const auto staysStill = [&](const StructureDefinition& s) { return s.motion && s.clock.start > 0 && s.clock.start >= endTime; };
    if (const auto [structure, who] = firstOf(input.structures, staysStill); structure)
        doubts.push_back(text("structure ", who, " does not move: the timeStart of its motion, ", structure->clock.start, " s, is not before endTime, ", endTime, " s"));
    return doubts;
}

std::vector<std::string> doubtfulStart(const BodiesInput& input, double time)
{
    std::vector<std::string> doubts;
    const auto isOver = [&](const BodyDefinition& b) { return b.releaseTime > 0 && b.releaseTime < time; };
    if (const auto [body, who] = firstOf(input.bodies, isOver); body)
        doubts.push_back(text("body ", who, body->entersAtRelease ? " enters" : " is let go", " at once: its release, at ", body->releaseTime, " s, is before the start, at ", time,
            " s. Times count from 0, not from the start"));
    const auto hasMoved = [&](const StructureDefinition& s) { return isElsewhere(s, poseAt(s, 0), poseAt(s, time)); };
    if (const auto [structure, who] = firstOf(input.structures, hasMoved); structure)
    {
        const Vec3 x = poseAt(*structure, time).position;
        doubts.push_back(text("structure ", who, " begins where ", time, " s of its motion have brought it, at (", x[0], ' ', x[1], ' ', x[2], "): `position` is that of time 0, not of the start"));
    }
    return doubts;
}

void reportBodies(const BodiesInput& input, const FluidProperties& fluid, double endTime)
{
    for (const std::string& doubt : doubtfulBodies(input, fluid, endTime)) Foam::Info<< "Warning: " << doubt.c_str() << Foam::nl;
}

} // namespace flotsam
