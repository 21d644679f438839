// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/bodyChecks.H"

#include "foam/dictionaryChecks.H"
#include "io/runLog.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

/// The first body that is meant, and " and n more"; empty: there is none.
template<class IsMeant>
std::pair<const BodyDefinition*, std::string> firstOf(const BodiesInput& input, IsMeant isMeant)
{
    const auto first = std::find_if(input.bodies.begin(), input.bodies.end(), isMeant);
    if (first == input.bodies.end()) return {nullptr, ""};
    const auto others = std::count_if(first + 1, input.bodies.end(), isMeant);
    return {&*first, others > 0 ? text(first->name, " (and ", others, " more)") : first->name};
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

} // namespace

std::vector<std::string> doubtfulBodies(const BodiesInput& input, const FluidProperties& fluid, double endTime)
{
    std::vector<std::string> doubts;
    const auto isBalloon = [&](const BodyDefinition& b) { return fluid.isTwoPhase && b.mass < fluid.rhoGas*b.volume; };
    if (const auto [body, who] = firstOf(input, isBalloon); body)
        doubts.push_back(text("body ", who, " is lighter than the gas (density ", body->mass/body->volume, ", gas ", fluid.rhoGas,
            " kg/m^3) and rises in it. Densities are in kg/m^3, not over water's"));

    const auto& g = fluid.gravity;
    const double gravity = std::hypot(g[0], g[1], g[2]);
    const auto depth = [&](const BodyDefinition& b)
    {
        const double stiffness = largestStiffness(input, b.material);
        return stiffness > 0 ? b.mass*gravity/stiffness : 0;
    };
    const auto isSoft = [&](const BodyDefinition& b) { return depth(b) > RunLog::deepOverlap*b.thinnest; };
    if (const auto [body, who] = firstOf(input, isSoft); body)
        doubts.push_back(text("contact is too soft for body ", who, ": its weight alone (", body->mass*gravity, " N) presses it ", depth(*body), " m, ",
            std::round(100*depth(*body)/body->thinnest), " % of its thickness, into what it lies on. Give constant/bodies more `stiffness`, ",
            body->mass*gravity/(0.005*body->thinnest), " N/m for half a per cent"));

    const auto staysHeld = [&](const BodyDefinition& b) { return b.releaseTime >= endTime; };
    if (const auto [body, who] = firstOf(input, staysHeld); body)
        doubts.push_back(text("body ", who, body->entersAtRelease ? " does not enter" : " is held all the time", ": its release, at ", body->releaseTime, " s, is not before endTime, ", endTime,
            " s"));
    return doubts;
}

void reportBodies(const BodiesInput& input, const FluidProperties& fluid, double endTime)
{
    for (const std::string& doubt : doubtfulBodies(input, fluid, endTime)) Foam::Info<< "Warning: " << doubt.c_str() << Foam::nl;
}

} // namespace flotsam
