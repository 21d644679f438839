// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/continuedMembers.H"

#include "demCoupling/coupling/scene.hpp"
#include "demCoupling/foam/bodyGroup.H"
#include "demCoupling/foam/continuedMotion.H"
#include "demCoupling/foam/shortList.H"
#include "foam/dictionaryChecks.H"

#include <algorithm>
#include <cmath>
#include <map>

namespace flotsam
{

namespace
{

std::vector<std::string> structureNames(const BodiesInput& input)
{
    std::vector<std::string> names;
    for (const StructureDefinition& s : input.structures) names.push_back(s.solid.name);
    return names;
}

template<class Named>
std::vector<std::string> namesOf(const std::vector<Named>& named)
{
    std::vector<std::string> names;
    for (const Named& n : named) names.push_back(n.name);
    return names;
}

/// Numbers of the names in `now`, -1: not there.
std::vector<int> numbersIn(const std::vector<std::string>& names, const std::vector<std::string>& now)
{
    std::map<std::string, int> numbers;
    for (std::size_t k = 0; k < now.size(); ++k) numbers[now[k]] = int(k);
    std::vector<int> result;
    for (const std::string& name : names) result.push_back(numbers.count(name) ? numbers[name] : -1);
    return result;
}

std::string missing(const std::vector<std::string>& names, const std::vector<int>& numbers)
{
    ShortList lost;
    for (std::size_t k = 0; k < names.size(); ++k)
        if (numbers[k] < 0) lost.add(names[k]);
    return lost.isEmpty() ? "" : lost.text();
}

/// What is stored by numbers would be exchanged.
std::string exchanged(const std::vector<std::string>& names, const std::vector<int>& numbers)
{
    for (std::size_t k = 1; k < numbers.size(); ++k)
        if (numbers[k] < numbers[k - 1]) return text("'", names[k], "' stands before '", names[k - 1], "', and stood behind it. Give those of the state in its order");
    return "";
}

std::string addedNames(const std::vector<std::string>& names, const std::vector<int>& known, const char* one, const char* several)
{
    const std::vector<char> isNew = areNew(known, int(names.size()));
    ShortList added;
    int count = 0;
    for (std::size_t k = 0; k < names.size(); ++k)
        if (isNew[k])
        {
            added.add(names[k]);
            ++count;
        }
    return count == 0 ? "" : text(count, ' ', count == 1 ? one : several, " (", added.text(), ')');
}

/// Shapes with points on them, made for those alone that are near others: members of a group share theirs.
class Samples
{
public:
    ShapeAtPose at(const std::string& name, const std::shared_ptr<const Shape>& shape, double thinnest, const Pose& pose)
    {
        std::shared_ptr<const SampledShape>& sampled = sampled_[shape.get()];
        if (!sampled) sampled = sampleShape(shape, thinnest);
        return {name, sampled, pose};
    }

private:
    std::map<const Shape*, std::shared_ptr<const SampledShape>> sampled_;
};

struct Placed
{
    std::string name;
    std::shared_ptr<const Shape> shape;
    double thinnest;
    Pose pose;

    std::array<Vec3, 2> box() const
    {
        Solid solid;
        solid.shape = shape;
        solid.pose = pose;
        return solid.spaceBounds();
    }
};

/// What new bodies meet that constant/bodies does not know of: it has the bodies of the state where they began, and moving structures where they were at time 0.
std::vector<Placed> movedMembers(const BodiesInput& input, const StoredMembers& stored, const std::vector<Solid>& solids, double time)
{
    std::vector<Placed> placed;
    for (const StructureDefinition& s : input.structures)
    {
        const auto [lower, upper] = s.solid.shape->bounds();
        if (s.motion) placed.push_back({"structure " + s.solid.name, s.solid.shape, (upper - lower).minCoeff(), poseAt(s, time)});
    }
    for (std::size_t k = 0; k < stored.bodies.size(); ++k)
    {
        const BodyDefinition& body = input.bodies[stored.bodies[k]];
        placed.push_back({"body " + body.name, body.shape, body.thinnest, solids[stored.structures.size() + k].pose});
    }
    return placed;
}

constexpr std::size_t descriptionSize = 15, placeSize = 7;  // numbers in a row of describe(), and of a pose

/// First row that differs by more than what files round, -1: none.
int differingRow(const std::vector<double>& a, const std::vector<double>& b)
{
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
        if (std::abs(a[k] - b[k]) > 1e-9*std::max({1e-3, std::abs(a[k]), std::abs(b[k])})) return int(k/descriptionSize);
    return -1;
}

/// The row of a structure that moves has its place at time 0 last.
void leaveOutPlace(std::vector<double>& rows, const std::vector<double>& other, std::size_t row)
{
    const std::size_t end = (row + 1)*descriptionSize;
    if (end <= std::min(rows.size(), other.size())) std::copy(other.begin() + (end - placeSize), other.begin() + end, rows.begin() + (end - placeSize));
}

} // namespace

MatchedMembers matchMembers(const std::vector<std::string>& names, int nStructures, const BodiesInput& input)
{
    const std::vector<std::string> structures(names.begin(), names.begin() + nStructures), bodies(names.begin() + nStructures, names.end());
    MatchedMembers result;
    result.stored.structures = numbersIn(structures, structureNames(input));
    result.stored.bodies = numbersIn(bodies, namesOf(input.bodies));
    const std::string noStructures = missing(structures, result.stored.structures), noBodies = missing(bodies, result.stored.bodies);
    const std::string lost = (noStructures.empty() ? "" : "structures " + noStructures) + (noStructures.empty() || noBodies.empty() ? "" : ", ") + (noBodies.empty() ? "" : "bodies " + noBodies);
    if (!lost.empty())
        result.refusal = text(lost, " are missing, which the state has (", names.size(), " structures and bodies; now there are ", input.structures.size() + input.bodies.size(),
            "). Others may be added, but those of the state must be there, with the names they had: put them back");
    for (const auto& [list, numbers] : {std::pair(structures, result.stored.structures), std::pair(bodies, result.stored.bodies)})
        if (result.refusal.empty()) result.refusal = exchanged(list, numbers);
    const std::string added = addedNames(structureNames(input), result.stored.structures, "structure", "structures");
    if (result.refusal.empty() && !added.empty() && !bodies.empty())
        result.refusal = text("it has ", added, " more than the state, which has bodies: structures can be added to the state of a run without bodies alone, bodies to any. Leave them out");
    return result;
}

std::string matchRestraints(const std::vector<std::string>& names, const BodiesInput& input, StoredMembers& stored)
{
    const std::vector<std::string> now = namesOf(input.restraints);
    stored.restraints = numbersIn(names, now);
    const std::string exchange = exchanged(names, stored.restraints);
    if (missing(names, stored.restraints).empty() && exchange.empty()) return "";
    return text("it is of a run whose restraints are ", joined(names), "; now they are ", now.empty() ? "none" : joined(now), ". Others may be added, but those of the state must be there, in its order"
        " (to let go of a body give its restraint a small breakingForce)");
}

BodiesInput partOf(const BodiesInput& input, const std::vector<int>& structures, const std::vector<int>& bodies)
{
    BodiesInput part = input;
    part.structures.clear();
    part.bodies.clear();
    for (const int s : structures) part.structures.push_back(input.structures[s]);
    std::vector<int> numbers(input.bodies.size(), -1);
    for (const int b : bodies)
    {
        numbers[b] = int(part.bodies.size());
        part.bodies.push_back(input.bodies[b]);
    }
    for (RestraintDefinition& r : part.restraints)
        for (RestraintEnd* end : {&r.end, &r.other})
            if (end->body >= 0) end->body = numbers[end->body];
    return part;
}

BodiesInput storedPart(const BodiesInput& input, const StoredMembers& stored) { return partOf(input, stored.structures, stored.bodies); }

BodiesInput addedPart(const BodiesInput& input, const StoredMembers& stored)
{
    const auto others = [](const std::vector<int>& known, std::size_t n)
    {
        const std::vector<char> isNew = areNew(known, int(n));
        std::vector<int> numbers;
        for (std::size_t k = 0; k < n; ++k)
            if (isNew[k]) numbers.push_back(int(k));
        return numbers;
    };
    return partOf(input, others(stored.structures, input.structures.size()), others(stored.bodies, input.bodies.size()));
}

std::string addedMembers(const BodiesInput& input, const StoredMembers& stored)
{
    std::string all;
    for (const std::string& added : {addedNames(structureNames(input), stored.structures, "structure", "structures"), addedNames(namesOf(input.bodies), stored.bodies, "body", "bodies"),
             addedNames(namesOf(input.restraints), stored.restraints, "restraint", "restraints")})
        if (!added.empty()) all += (all.empty() ? "" : ", ") + added;
    return all;
}

std::string addedInPlaceOfOthers(const BodiesInput& input, const StoredMembers& stored, const std::vector<double>& solids, double time)
{
    constexpr double allowed = 1e-3;    // of the thickness, as at a start
    const std::vector<Placed> others = movedMembers(input, stored, Scene::stored(solids), time);
    const std::vector<char> isNew = areNew(stored.bodies, int(input.bodies.size()));
    Samples samples;
    for (std::size_t b = 0; b < input.bodies.size(); ++b)
    {
        const BodyDefinition& body = input.bodies[b];
        if (!isNew[b] || body.entersAtRelease) continue;
        const auto [lower, upper] = Placed{body.name, body.shape, body.thinnest, body.pose}.box();
        for (const Placed& other : others)
        {
            const auto [otherLower, otherUpper] = other.box();
            if (((lower - otherUpper).array() > 0).any() || ((otherLower - upper).array() > 0).any()) continue;
            const double overlap = -gap(samples.at(body.name, body.shape, body.thinnest, body.pose), samples.at(other.name, other.shape, other.thinnest, other.pose), 1e-6);
            if (overlap <= allowed*body.thinnest) continue;
            const Vec3& x = body.pose.position;
            return text("body ", body.name, ", which is new, reaches ", 1000*overlap, " mm into ", other.name, " at ", time, " s. Its centre is at (", x[0], ' ', x[1], ' ', x[2],
                "). Move it (of `random` take another `seed` or `box`), or let it come in when its place is free (beforeRelease absent)");
        }
    }
    return "";
}

std::vector<double> describe(const BodiesInput& input)
{
    std::vector<double> rows;
    const auto add = [&](double mass, double volume, const Shape& shape, const Pose& pose)
    {
        const std::array<Vec3, 2> b = shape.bounds();
        rows.insert(rows.end(), {mass, volume, b[0][0], b[0][1], b[0][2], b[1][0], b[1][1], b[1][2], pose.position[0], pose.position[1], pose.position[2],
            pose.orientation.w(), pose.orientation.x(), pose.orientation.y(), pose.orientation.z()});
    };
    for (const StructureDefinition& s : input.structures) add(0, s.solid.shape->moments().volume, *s.solid.shape, s.solid.pose);
    for (const BodyDefinition& b : input.bodies) add(b.mass, b.volume, *b.shape, Pose());
    return rows;
}

int describedStructures(const std::vector<double>& rows)
{
    int count = 0;
    for (std::size_t k = 0; k < rows.size(); k += descriptionSize) count += rows[k] == 0;   // bodies have mass
    return count;
}

std::string otherDescription(const std::vector<double>& stored, const BodiesInput& input)
{
    const std::vector<double> now = describe(input);
    std::vector<double> rows = stored;
    for (std::size_t s = 0; s < input.structures.size(); ++s)
        if (input.structures[s].motion) leaveOutPlace(rows, now, s);
    const int other = differingRow(rows, now);
    if (other < 0) return "";
    const bool isStructure = other < int(input.structures.size());
    return text("mass, volume, extent", isStructure ? " or place" : "", " of '", isStructure ? input.structures[other].solid.name : input.bodies[other - int(input.structures.size())].name, "' differ");
}

std::vector<double> rowsWith(const std::vector<int>& known, const std::vector<double>& some, std::vector<double> all)
{
    const std::size_t rowSize = known.empty() ? 0 : some.size()/known.size();
    for (std::size_t k = 0; k < known.size(); ++k)
        if ((known[k] + 1)*rowSize <= all.size()) std::copy_n(some.begin() + std::ptrdiff_t(k*rowSize), rowSize, all.begin() + std::ptrdiff_t(known[k]*rowSize));
    return all;
}

} // namespace flotsam
