// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/restraintChain.H"

#include "demCoupling/foam/restraintEnds.H"
#include "foam/dictionaryChecks.H"

#include "List.H"
#include "wordRe.H"

#include <algorithm>

namespace flotsam
{

namespace
{

/// An entry that is one value, or a list of values in round brackets; `opening`: brackets that a list begins with (vectors have one of their own).
template<class T>
std::vector<T> readOneOrMany(const Foam::dictionary& dict, const char* keyword, int opening, const std::string& what)
{
    const Foam::ITstream& given = valueOf(dict, keyword, what);
    const auto isBracket = [&](int i) { return i < given.size() && given[i].isPunctuation() && given[i].pToken() == Foam::token::BEGIN_LIST; };
    bool isList = true;
    for (int i = 0; i < opening; ++i) isList = isList && isBracket(i);
    if (!isList) return {readAs<T>(dict, keyword, what)};
    const auto list = readAs<Foam::List<T>>(dict, keyword, what);
    return {list.begin(), list.end()};
}

/// Bodies that an entry of the list means: one, the members of a group, or those whose names (or groups) match a pattern.
std::vector<int> bodiesOf(const Foam::wordRe& given, const Foam::dictionary& dict, const BodiesInput& input)
{
    std::vector<int> found;
    std::vector<std::string> known = input.bodyGroups;
    for (std::size_t i = 0; i < input.bodies.size(); ++i)
    {
        if (given.match(input.bodies[i].name) || given.match(input.bodyGroups[i])) found.push_back(int(i));
        if (input.bodies[i].name != input.bodyGroups[i]) known.push_back(input.bodies[i].name);
    }
    if (!found.empty()) return found;
    if (given.isPattern()) failIn(dict, text("'bodies' has the pattern \"", std::string(given), "\", which no body matches: it is a regular expression, as \"log.*\" or \"log\\.[0-4]\"."));
    std::sort(known.begin(), known.end());
    known.erase(std::unique(known.begin(), known.end()), known.end());
    constexpr std::size_t enough = 12;      // of hundreds of logs
    if (known.size() > enough) known.resize(enough);
    failUnknown(dict, "body or group of bodies", given, known);
}

std::vector<int> readMembers(const Foam::dictionary& dict, const BodiesInput& input)
{
    std::vector<int> bodies;
    for (const Foam::wordRe& given : readOneOrMany<Foam::wordRe>(dict, "bodies", 1, "a group of bodies, or a list of bodies, groups and \"patterns\" in round brackets, in the order of the chain"))
        for (const int body : bodiesOf(given, dict, input))
        {
            if (std::find(bodies.begin(), bodies.end(), body) != bodies.end())
                failIn(dict, text("'bodies' names ", input.bodies[body].name, " twice: a chain goes through each body once. One whose end is its beginning is 'closed yes;'."));
            bodies.push_back(body);
        }
    if (bodies.empty()) failIn(dict, "'bodies' is empty: name those of the chain, in its order.");
    return bodies;
}

/// The ends of one line, by what they are of.
using Line = std::pair<RestraintEnd, RestraintEnd>;

struct ChainEnds { std::vector<RestraintEnd> front, back; };

std::vector<RestraintEnd> readEnds(const Foam::dictionary& dict, const char* keyword, const std::vector<int>& bodies, const SceneFrame& frame, const BodiesInput& input)
{
    const std::vector<Foam::vector> points = readOneOrMany<Foam::vector>(dict, keyword, 2, "a point (x y z) in the frame of the bodies' shape, the same for all, or a list ((x y z) ..) of one for each body");
    if (points.size() != 1 && points.size() != bodies.size())
        failIn(dict, text("'", keyword, "' lists ", points.size(), " points for ", bodies.size(), " bodies: give one for all, or one for each."));
    std::vector<RestraintEnd> ends;
    for (std::size_t i = 0; i < bodies.size(); ++i)
    {
        const Foam::vector& x = points[points.size() == 1 ? 0 : i];
        ends.push_back(bodyEnd(bodies[i], Vec3(x.x(), x.y(), x.z()), frame, input));
    }
    return ends;
}

void checkAnchors(const Foam::dictionary& dict, bool isClosed)
{
    for (const std::string end : {"firstAnchor", "lastAnchor"})
    {
        if (isClosed && dict.found(end)) failIn(dict, text("A chain that is closed has no ends: remove '", end, "', or 'closed'."));
        if (dict.found(end + "Structure") && !dict.found(end))
            failIn(dict, text("'", end, "Structure' goes with '", end, " (x y z)', the point that moves with it."));
    }
}

std::vector<Line> readLines(const Foam::dictionary& dict, const ChainEnds& ends, const SceneFrame& frame, const BodiesInput& input)
{
    const bool isClosed = readFlagOr(dict, "closed", false);
    checkAnchors(dict, isClosed);
    std::vector<Line> lines;
    if (dict.found("firstAnchor")) lines.emplace_back(ends.front.front(), readAnchor(dict, "firstAnchor", "firstAnchorStructure", frame, input));
    for (std::size_t i = 1; i < ends.front.size(); ++i) lines.emplace_back(ends.back[i - 1], ends.front[i]);
    if (dict.found("lastAnchor")) lines.emplace_back(ends.back.back(), readAnchor(dict, "lastAnchor", "lastAnchorStructure", frame, input));
    if (isClosed && ends.front.size() > 1) lines.emplace_back(ends.back.back(), ends.front.front());
    if (lines.empty()) failIn(dict, text("A chain of one body, ", input.bodies[ends.front[0].body].name, ", needs 'firstAnchor' or 'lastAnchor'."));
    return lines;
}

/// One number for all lines, or one for each; empty: not given.
std::vector<double> readPerLine(const Foam::dictionary& dict, const char* keyword, std::size_t nLines, const Range& range)
{
    if (!dict.found(keyword)) return {};
    const auto values = readOneOrMany<Foam::scalar>(dict, keyword, 1, text("a number ", toString(range), ", the same for all lines, or a list of one for each in round brackets"));
    if (values.size() != 1 && values.size() != nLines)
        failIn(dict, text("'", keyword, "' lists ", values.size(), " numbers, and the chain has ", nLines, " lines: give one for all, or one for each, from the first anchor on."));
    for (const double value : values) checkRange(dict, keyword, value, range);
    return values.size() == 1 ? std::vector<double>(nLines, values[0]) : std::vector<double>(values.begin(), values.end());
}

double distance(const Line& line, const BodiesInput& input) { return (placeInSpace(line.first, input) - placeInSpace(line.second, input)).norm(); }

/// Front and back exchanged: lines that go all along both of their bodies. Empty: they are not.
std::string turnedRound(const std::string& name, const ChainEnds& ends, const BodiesInput& input)
{
    double given = 0, turned = 0;
    for (std::size_t i = 1; i < ends.front.size(); ++i)
    {
        given += distance({ends.back[i - 1], ends.front[i]}, input);
        turned += distance({ends.front[i - 1], ends.back[i]}, input);
    }
    if (turned >= 0.5*given) return "";
    return text("chain ", name, ": with front and back exchanged its bodies would be nearer to each other, ", turned, " m of lines between them instead of ", given,
        " m. 'front' faces the body before, 'back' the next of 'bodies'");
}

RestraintDefinition::Kind readKind(const Foam::dictionary& dict)
{
    const std::vector<std::string> known{"tether", "linearSpring"};
    const std::string kind = readWord(dict, "links", known);
    if (std::find(known.begin(), known.end(), kind) == known.end()) failUnknown(dict, "kind of links", kind, known);
    return kind == "tether" ? RestraintDefinition::Kind::Tether : RestraintDefinition::Kind::LinearSpring;
}

} // namespace

std::vector<RestraintDefinition> readChain(const std::string& name, const Foam::dictionary& dict, const SceneFrame& frame, BodiesInput& input)
{
    const RestraintDefinition::Kind kind = readKind(dict);
    checkKeywords(dict, {"type", "links", "bodies", "front", "back", "firstAnchor", "firstAnchorStructure", "lastAnchor", "lastAnchorStructure", "closed",
        lengthOf(kind), "stiffness", "damping", "breakingForce"});
    const std::vector<int> bodies = readMembers(dict, input);
    const ChainEnds ends{readEnds(dict, "front", bodies, frame, input), readEnds(dict, "back", bodies, frame, input)};
    const std::vector<Line> lines = readLines(dict, ends, frame, input);
    if (const std::string turned = turnedRound(name, ends, input); !turned.empty()) input.doubts.push_back(turned);
    for (const char* required : {"stiffness", "damping"})
        if (!dict.found(required)) failIn(dict, text("Entry '", required, "' is missing: it is a number, the same for all lines, or a list of one for each in round brackets."));
    const auto perLine = [&](const char* keyword, const Range& range) { return readPerLine(dict, keyword, lines.size(), range); };
    const std::vector<double> length = perLine(lengthOf(kind), notNegative), stiffness = perLine("stiffness", positive), damping = perLine("damping", notNegative),
        breakingForce = perLine("breakingForce", positive);

    std::vector<RestraintDefinition> chain;
    for (std::size_t i = 0; i < lines.size(); ++i)
    {
        RestraintDefinition r;
        r.name = text(name, '.', i);
        r.kind = kind;
        r.end = lines[i].first;
        r.other = lines[i].second;
        r.length = length.empty() ? distance(lines[i], input) : length[i];
        r.stiffness = stiffness[i];
        r.damping = damping[i];
        if (!breakingForce.empty()) r.breakingForce = breakingForce[i];
        chain.push_back(r);
    }
    return chain;
}

} // namespace flotsam
