// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/contactLaw.hpp"

#include "demCoupling/liggghts/contactModes.hpp"
#include "demCoupling/liggghts/restraintStep.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace flotsam
{

namespace
{

constexpr double pi = 3.14159265358979323846;
/// LIGGGHTS keeps tables of classes x classes; more distinct bodies than this share classes of nearly equal mass.
constexpr int largestClassCount = 32;

const ContactLaw& lawOf(const DemSetup& setup, int materialA, int materialB)
{
    return setup.laws.at(static_cast<size_t>(materialA * setup.nMaterials + materialB));
}

void checkLaws(const DemSetup& setup)
{
    const int n = setup.nMaterials;
    if (n < 1 || setup.laws.size() != static_cast<size_t>(n * n))
        throw DemError("contact laws: " + std::to_string(setup.laws.size()) + " given, nMaterials^2 = "
                       + std::to_string(n * n) + " needed");
    for (const ContactLaw& law : setup.laws)
    {
        if (!(law.stiffness > 0))
            throw DemError("contact law: stiffness " + std::to_string(law.stiffness) + " N/m, must be > 0");
        if (!(law.restitution >= 0.01 && law.restitution <= 1))
            throw DemError("contact law: restitution " + std::to_string(law.restitution)
                           + ", allowed 0.01 to 1 (a linear dashpot without attraction cannot reach 0)");
        if (!(law.frictionAngleDeg >= 0 && law.frictionAngleDeg < 89))
            throw DemError("contact law: friction angle " + std::to_string(law.frictionAngleDeg)
                           + " degrees, allowed 0 to 89");
    }
}

int checkedMaterial(int material, const DemSetup& setup, const std::string& owner)
{
    if (material < 0 || material >= setup.nMaterials)
        throw DemError("'" + owner + "': contact material " + std::to_string(material) + ", allowed 0 to "
                       + std::to_string(setup.nMaterials - 1));
    return material;
}

/// Whether any law of this material shares its numbers over a face.
bool sharesFace(const DemSetup& setup, int material)
{
    for (int other = 0; other < setup.nMaterials; ++other)
        if (lawOf(setup, material, other).perBody)
            return true;
    return false;
}

/// What a body's contacts would be with a class of its own.
struct OwnClasses { ContactClass spheres, corners; };

std::vector<OwnClasses> ownClasses(const DemSetup& setup)
{
    const auto rounded = [](double value) { return 1e-6 * std::round(1e6 * value); };
    std::vector<OwnClasses> all;
    for (const BodyDefinition& body : setup.bodies)
    {
        const int faceCount = sharesFace(setup, body.material) ? flattestFaceCount(body) : 1;
        const double stiffening = rounded(cornerStiffening(body));
        const ContactClass own{false, body.material, body.mass, faceCount, 1, cornersOfFace(body) * stiffening};
        all.push_back({own, own});
        if (!body.corners.empty())
            all.back().corners.stiffening = stiffening;
    }
    return all;
}

/// Material, whether corners, mass, spheres of a face, weight of its corners, stiffening: bodies whose masses are closer than a factor of 1+`tolerance`, and the others' numbers than
/// `coarser` times its logarithm, share a class. The mass makes the restitution, what the others make is how deep spheres sink in.
using Key = std::tuple<int, bool, long, long, long, long>;

Key keyOf(const ContactClass& c, double tolerance)
{
    constexpr double coarser = 4;
    const double width = std::log1p(tolerance);
    const auto step = [&](double value) { return std::lround(std::log(value) / (coarser * width)); };
    return {c.material, c.isCorner(), std::lround(std::log(c.mass) / width), step(c.faceCount), step(1 + c.cornerWeight), step(c.stiffening)};
}

double sharedTolerance(const std::vector<OwnClasses>& all)
{
    for (double tolerance = 1e-6; tolerance < 1; tolerance *= 1.5)
    {
        std::set<Key> distinct;
        for (const OwnClasses& own : all)
            distinct.insert({keyOf(own.spheres, tolerance), keyOf(own.corners, tolerance)});
        if (static_cast<int>(distinct.size()) <= largestClassCount)
            return tolerance;
    }
    return 1;
}

struct SharedClass { int index, fewest, most; }; // spheres of a face

/// The class of the key, made if there is none: of the smallest mass in it, which gives the smaller damping and never a stiffer dashpot, and a middle number of spheres.
int classOf(const ContactClass& own, double tolerance, std::map<Key, SharedClass>& known, ContactTable& table)
{
    const auto [it, isNew] = known.emplace(keyOf(own, tolerance), SharedClass{table.size(), own.faceCount, own.faceCount});
    if (isNew)
        table.classes.push_back(own);
    SharedClass& shared = it->second;
    ContactClass& c = table.classes[static_cast<size_t>(shared.index)];
    shared.fewest = std::min(shared.fewest, own.faceCount);
    shared.most = std::max(shared.most, own.faceCount);
    c.faceCount = static_cast<int>(std::lround(std::sqrt(double(shared.fewest) * shared.most)));
    c.mass = std::min(c.mass, own.mass);
    c.cornerWeight = std::min(c.cornerWeight, own.cornerWeight);
    c.stiffening = std::max(c.stiffening, own.stiffening);
    return shared.index;
}

void addBodyClasses(const DemSetup& setup, ContactTable& table)
{
    const std::vector<OwnClasses> all = ownClasses(setup);
    const double tolerance = sharedTolerance(all);
    std::map<Key, SharedClass> known;
    for (const OwnClasses& own : all)
    {
        table.classOfBody.push_back(classOf(own.spheres, tolerance, known, table));
        table.classOfCorners.push_back(classOf(own.corners, tolerance, known, table));
    }
}

void addWallClasses(const DemSetup& setup, ContactTable& table)
{
    std::map<std::pair<int, bool>, int> classOf;
    for (const WallDefinition& wall : setup.walls)
    {
        const auto [it, isNew] = classOf.emplace(std::pair(checkedMaterial(wall.material, setup, wall.name), wall.isMirror), table.size());
        if (isNew)
            table.classes.push_back({true, wall.material, 0, 1, 1, 0, wall.isMirror});
        table.classOfWall.push_back(it->second);
    }
}

/// Reduced mass of the pair; a wall does not move.
double effectiveMass(const ContactClass& a, const ContactClass& b)
{
    if (a.isWall)
        return b.mass;
    return b.isWall ? a.mass : a.mass * b.mass / (a.mass + b.mass);
}

/// Spheres over which a flat contact of this pair is spread.
int sharedCount(const ContactClass& a, const ContactClass& b)
{
    if (a.isWall)
        return b.faceCount;
    return b.isWall ? a.faceCount : std::min(a.faceCount, b.faceCount);
}

/// Stiffness of a flat landing of this pair over that of one of its spheres, which are no corners.
double sharedWeight(const ContactClass& a, const ContactClass& b)
{
    const bool isAtWall = a.isWall || b.isWall; // corners touch no bodies
    return sharedCount(a, b) + (isAtWall ? a.cornerWeight + b.cornerWeight : 0);
}

/// Held between neighbours on several sides, the partner moving as well: the square of the highest frequency and the largest rate of
/// damping are about this many times those of the body landing on a fixed plane.
constexpr double squeeze = 4;
/// Where the dashpots of a flat landing are more than a sub-step can take, it may rebound with this share of the restitution.
constexpr double flatShare = 0.07;

} // namespace

double restitutionOf(double beta)
{
    // The force k x + c v vanishes before the overlap does; from there on the body flies off. Integrating the
    // oscillator up to that instant (Schwager and Poeschel, Granular Matter 9 (2007) 465) gives
    if (beta <= 0)
        return 1;
    if (std::abs(beta - 1) < 1e-6)
        return std::exp(-2.0);
    if (beta < 1)
    {
        const double omega = std::sqrt(1 - beta * beta);
        return std::exp(-beta / omega * (pi - std::atan2(2 * beta * omega, omega * omega - beta * beta)));
    }
    const double rate = std::sqrt(beta * beta - 1);
    return std::exp(-beta / rate * std::log((beta + rate) * (beta + rate))); // (b+r)/(b-r) = (b+r)^2
}

double dampingRatioFor(double restitution)
{
    double low = 0, high = 10;
    for (int i = 0; i < 200; ++i)
    {
        const double middle = 0.5 * (low + high);
        (restitutionOf(middle) > restitution ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

ContactTable makeContactTable(const DemSetup& setup)
{
    checkLaws(setup);
    for (const BodyDefinition& body : setup.bodies)
        checkedMaterial(body.material, setup, body.name);
    ContactTable table;
    addBodyClasses(setup, table);
    addWallClasses(setup, table);
    for (const ContactClass& a : table.classes)
        for (const ContactClass& b : table.classes)
        {
            const ContactLaw& law = lawOf(setup, a.material, b.material);
            const int n = law.perBody ? sharedCount(a, b) : 1;
            const double mass = a.isWall && b.isWall ? 1 : effectiveMass(a, b); // walls never meet
            const double stiffening = a.stiffening * b.stiffening;
            table.stiffness.push_back(law.stiffness / n * stiffening);
            // one sphere: stiffness K/n needs sqrt(1/n) of the damping for the same ratio; n spheres at once: 1/n
            const double share = law.flatRestitution ? n : std::sqrt(n);
            const double ofCorners = law.perBody && law.flatRestitution ? stiffening * std::sqrt(n / sharedWeight(a, b)) : std::sqrt(stiffening);
            table.damping.push_back(2 * dampingRatioFor(law.restitution) * std::sqrt(law.stiffness * mass) / share * ofCorners);
            table.friction.push_back(a.isMirror || b.isMirror ? 0 : std::tan(law.frictionAngleDeg * pi / 180));
        }
    return table;
}

int DampingLevel::of(double z) { return z > 1 ? static_cast<int>(std::ceil(4 * std::log2(z) - 1e-9)) : 0; }

double DampingLevel::share(int level) { return std::exp2(-0.25 * level); }

double ContactTable::dampingOf(int typeA, int typeB) const
{
    const int level = std::max(typeA - 1, typeB - 1) / size();
    return damping[entryOf(typeA, typeB)] * DampingLevel::share(level);
}

double contactTimeStep(const DemSetup& setup, const ContactTable& table)
{
    constexpr double stepsPerContact = 40;
    constexpr double stepsPerCorner = 20;   // errs by 0.2 % of the restitution (docs/contact.md)
    constexpr double stabilityMargin = 0.8;
    // velocity Verlet with a dashpot that takes the part d of a velocity, half a step late, is stable for omega^2 dt^2 + 2 d < 4
    const double limit = stabilityMargin * std::sqrt(2.0);

    double step = restraintTimeStep(setup);
    const int n = table.size();
    for (size_t b = 0; b < setup.bodies.size(); ++b)
    {
        const ModesOfBody modesOf(setup.bodies[b]);
        for (int other = 0; other < n; ++other)
        {
            const ContactClass& partner = table.classes[static_cast<size_t>(other)];
            if (partner.isCorner())
                continue; // touches walls alone
            const ContactLaw& law = lawOf(setup, setup.bodies[b].material, partner.material);
            const ContactModes& modes = modesOf.of(partner, law);
            const size_t entry = static_cast<size_t>(table.classOfBody[b] * n + other);
            const double k = table.stiffness[entry];
            const double resolved = law.perBody && law.flatRestitution ? modes.face : modes.sphere;
            // a flat landing that stops in one sub-step has the damping ratio 1/(2 omega dt)
            const double stop = 1 / (table.damping[entry] * modes.faceDashpots);
            const double dead = 0.5 / (std::sqrt(k * modes.faceNormal) * dampingRatioFor(flatShare * law.restitution));
            if (modes.corner > 0)
                step = std::min(step, pi / std::sqrt(k * modes.corner) / stepsPerCorner);
            step = std::min({step, pi / std::sqrt(k * resolved) / stepsPerContact, limit / std::sqrt(squeeze * k * modes.face),
                             std::max(stop, dead)});
        }
    }
    return step;
}

void compensateLag(const DemSetup& setup, double step, ContactTable& table)
{
    const size_t n = table.classes.size();
    for (size_t entry = 0; entry < table.damping.size(); ++entry)
    {
        const ContactClass &a = table.classes[entry / n], &b = table.classes[entry % n];
        if (a.isWall && b.isWall)
            continue;
        const ContactLaw& law = lawOf(setup, a.material, b.material);
        // over this one's dashpot, that of the contact for which the restitution is made
        const double together = law.perBody && law.flatRestitution ? sharedWeight(a, b) / (a.stiffening * b.stiffening) : 1;
        const double z = together * table.damping[entry] * step / effectiveMass(a, b);
        // c^2 / (m - c dt/2) is to be what c^2 / m was
        table.damping[entry] /= z / 4 + std::sqrt(1 + z * z / 16);
    }
}

int dampingLevels(const DemSetup& setup, const ContactTable& table, double step)
{
    constexpr double margin = 2; // what is known of a body's rate is a bound from above
    double rate = 0;
    const int n = table.size();
    for (size_t b = 0; b < setup.bodies.size(); ++b)
    {
        const ModesOfBody modesOf(setup.bodies[b]);
        for (int other = 0; other < n; ++other)
        {
            const ContactClass& partner = table.classes[static_cast<size_t>(other)];
            if (partner.isCorner())
                continue; // touches walls alone
            const double dashpots = modesOf.of(partner, lawOf(setup, setup.bodies[b].material, partner.material)).faceDashpots;
            rate = std::max(rate, squeeze * table.damping[static_cast<size_t>(table.classOfBody[b] * n + other)] * dashpots);
        }
    }
    return 1 + DampingLevel::of(margin * rate * step);
}

} // namespace flotsam
