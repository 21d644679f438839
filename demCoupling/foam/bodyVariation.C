// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/bodyVariation.H"

#include "demCoupling/core/distribution.hpp"
#include "demCoupling/foam/bodyPlacement.hpp"
#include "foam/dictionaryChecks.H"

#include "List.H"
#include "messageStream.H"
#include "vector.H"

#include <algorithm>
#include <functional>

namespace flotsam
{

namespace
{

double largestOf(const Foam::vector& v) { return std::max({v.x(), v.y(), v.z()}); }

/// A length of a round shape: its ends move, its middle stays.
void setLength(Foam::dictionary& shape, double length)
{
    const auto end1 = shape.get<Foam::vector>("end1"), end2 = shape.get<Foam::vector>("end2");
    const Foam::vector middle = 0.5*(end1 + end2), half = 0.5*length*(end2 - end1)/Foam::mag(end2 - end1);
    shape.set("end1", Foam::vector(middle - half));
    shape.set("end2", Foam::vector(middle + half));
}

/// The longest side of a box.
void setLongestSide(Foam::dictionary& shape, double length)
{
    auto size = shape.get<Foam::vector>("size");
    for (int d = 0; d < 3; ++d)
        if (size[d] == largestOf(size))
        {
            size[d] = length;
            break;
        }
    shape.set("size", size);
}

/// All lengths times the factor, parts of unions too.
void scale(Foam::dictionary& shape, double factor)
{
    for (const char* keyword : {"size", "centre", "end1", "end2"})
        if (shape.found(keyword)) shape.set(keyword, Foam::vector(factor*shape.get<Foam::vector>(keyword)));
    if (shape.found("radius")) shape.set("radius", factor*shape.get<Foam::scalar>("radius"));
    if (shape.get<Foam::word>("type") == "stl") shape.set("scale", factor*shape.getOrDefault<Foam::scalar>("scale", 1));
    if (!shape.found("parts")) return;
    for (const Foam::entry& part : subGroup(shape, "parts"))
        if (part.isDict()) scale(shape.subDict("parts").subDict(part.keyword()), factor);
}

/// What may be drawn, for which types of shapes (empty: all), and what it changes.
struct Quantity
{
    const char *keyword, *unit;
    std::vector<std::string> types;
    std::function<void(MemberVariation&, double)> apply;
};

const std::vector<Quantity>& quantities()
{
    static const std::vector<Quantity> all{
        {"length", " m", {"cylinder", "capsule", "box"}, [](MemberVariation& m, double value)
            { m.shape.get<Foam::word>("type") == "box" ? setLongestSide(m.shape, value) : setLength(m.shape, value); }},
        {"diameter", " m", {"cylinder", "capsule", "sphere"}, [](MemberVariation& m, double value) { m.shape.set("radius", 0.5*value); }},
        {"scale", "", {}, [](MemberVariation& m, double value) { scale(m.shape, value); }},
        {"density", " kg/m3", {}, [](MemberVariation& m, double value) { m.density = value; }}};
    return all;
}

Distribution readValues(const Foam::dictionary& dict)
{
    checkKeywords(dict, {"type", "values"});
    Distribution d;
    d.kind = Distribution::Kind::Values;
    for (const double value : readAs<Foam::List<Foam::scalar>>(dict, "values", "numbers in round brackets: (0.2 0.25 0.4)"))
    {
        checkRange(dict, "values", value, positive);
        d.values.push_back(value);
    }
    if (d.values.empty()) failIn(dict, "'values' is empty: give at least one.");
    return d;
}

/// uniform { minValue maxValue }   normal, logNormal { mean deviation minValue maxValue }   values { values (..) }
Distribution readDistribution(const Foam::dictionary& dict)
{
    const std::vector<std::string> types{"uniform", "normal", "logNormal", "values"};
    const std::string type = readWord(dict, "type", types);
    if (std::find(types.begin(), types.end(), type) == types.end()) failUnknown(dict, "type", type, types);
    if (type == "values") return readValues(dict);
    Distribution d;
    const bool isUniform = type == "uniform";
    if (isUniform) checkKeywords(dict, {"type", "minValue", "maxValue"});
    else checkKeywords(dict, {"type", "mean", "deviation", "minValue", "maxValue"});
    d.smallest = readNumber(dict, "minValue", positive);
    d.largest = readNumber(dict, "maxValue", {d.smallest, 1e300, true}, text("It must be larger than minValue, ", d.smallest, '.'));
    if (isUniform) return d;
    d.kind = type == "normal" ? Distribution::Kind::Normal : Distribution::Kind::LogNormal;
    d.mean = readNumber(dict, "mean", positive);
    d.deviation = readNumber(dict, "deviation", positive);
    constexpr double least = 1e-3;
    const double within = d.below(d.largest) - d.below(d.smallest);
    if (within < least)
        failIn(dict, text("Of all values of this distribution, with its mean ", d.mean, " and deviation ", d.deviation, ", the share ", within, " lies between minValue ", d.smallest, " and maxValue ",
            d.largest, "; allowed: ", least, " at least.\n    'mean' and 'deviation' have the unit of the values, those of logNormal too, not of their logarithms."));
    return d;
}

void checkFits(const Foam::dictionary& variation, const Quantity& quantity, const std::string& type)
{
    const auto& types = quantity.types;
    if (!types.empty() && std::find(types.begin(), types.end(), type) == types.end())
        failIn(variation, text("'", quantity.keyword, "' may be given for shapes of type ", joined(types), "; here it is ", type, ".\n    'scale', a factor of all lengths, is for any shape."));
}

void report(const Foam::dictionary& group, const Quantity& quantity, const std::vector<double>& drawn)
{
    double sum = 0;
    for (const double value : drawn) sum += value;
    const auto [least, most] = std::minmax_element(drawn.begin(), drawn.end());
    Foam::Info<< text("constant/bodies: ", std::string(group.dictName()), ", ", quantity.keyword, " of ", drawn.size(), " members: ", *least, " to ", *most, quantity.unit, ", mean ",
        sum/static_cast<double>(drawn.size())).c_str() << Foam::nl;
}

} // namespace

std::vector<MemberVariation> drawVariations(const Foam::dictionary& group, int count)
{
    const Foam::dictionary &variation = subGroup(group, "variation"), &shape = subGroup(group, "shape");
    std::vector<std::string> known{"seed"};
    for (const Quantity& q : quantities()) known.push_back(q.keyword);
    checkKeywords(variation, known);
    if (group.found("mass")) failIn(group, "Members of a 'variation' differ in volume: give 'density', of which the masses follow, instead of 'mass'.");
    if (group.found("density") && variation.found("density")) failIn(variation, "The group has a 'density', too, which would do nothing: remove one of the two.");
    const auto seed = static_cast<std::uint64_t>(readCountOr(variation, "seed", 1, {0, 2147483647}));
    const std::string type = readWord(shape, "type");
    std::vector<MemberVariation> members(static_cast<std::size_t>(count), MemberVariation{shape, 0});
    for (std::size_t k = 0; k < quantities().size(); ++k)
    {
        const Quantity& quantity = quantities()[k];
        if (!variation.found(quantity.keyword)) continue;
        checkFits(variation, quantity, type);
        const Distribution distribution = readDistribution(subGroup(variation, quantity.keyword));
        constexpr std::size_t room = 16;    // for quantities that may come: what is drawn stays
        RandomNumbers numbers(seed*room + k);
        std::vector<double> drawn;
        for (MemberVariation& member : members)
        {
            drawn.push_back(distribution.quantile(numbers.uniform()));
            quantity.apply(member, drawn.back());
        }
        report(group, quantity, drawn);
    }
    return members;
}

} // namespace flotsam
