// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/continuedContact.H"

#include "demCoupling/foam/stateFiles.H"

#include "foam/dictionaryChecks.H"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

/// Numbers of a body in bodyStarts().
constexpr std::size_t startSize = 13;

/// Names of `a` that are not in `b`.
std::vector<std::string> missing(const std::vector<std::string>& a, const std::vector<std::string>& b)
{
    std::vector<std::string> names;
    for (const std::string& name : a)
        if (std::find(b.begin(), b.end(), name) == b.end()) names.push_back(name);
    return names;
}

} // namespace

ContactParts contactParts(const BodiesInput& input)
{
    ContactParts parts;
    const auto add = [&](const std::string& name, std::size_t size, double finest = 0)
    {
        parts.names.push_back(name);
        parts.sizes.push_back(double(size));
        parts.finest.push_back(finest);
    };
    for (const WallDefinition& wall : input.walls)
    {
        if (wall.patch.empty()) add("structure " + wall.name, wall.surface.triangles.size());
        else if (parts.names.empty() || parts.names.back() != "patch " + wall.patch) add("patch " + wall.patch, 0);    // one wall for each of its parts
    }
    for (const MoverDefinition& mover : input.movers) add("structure " + mover.name, mover.spheres.size(), mover.finest);
    for (const BodyDefinition& body : input.bodies) add("body " + body.name, body.spheres.size() + body.corners.size(), body.finest);
    return parts;
}

std::vector<double> codesOf(const std::vector<std::string>& names)
{
    std::vector<double> codes;
    for (const std::string& name : names)
    {
        for (const char c : name) codes.push_back(static_cast<unsigned char>(c));
        codes.push_back('\n');
    }
    return codes;
}

std::vector<std::string> namesFrom(const std::vector<double>& codes)
{
    std::vector<std::string> names(1);
    for (const double c : codes)
    {
        if (c == '\n') names.emplace_back();
        else names.back() += char(int(c));
    }
    names.pop_back();
    return names;
}

StoredFinest readStoredFinest(const Foam::Time& runTime, const SimplexMesh& mesh, const Halo& halo)
{
    const StateFiles files(runTime, mesh, halo);
    const StateFiles::Found found = files.find();
    if (found != StateFiles::Found::Own && found != StateFiles::Found::Shared) return {};
    const RunState state = found == StateFiles::Found::Own ? files.readOwn() : files.readShared();
    const auto names = state.arrays.find("contactNames"), finest = state.arrays.find("contactFinest");
    if (names == state.arrays.end() || finest == state.arrays.end()) return {};
    StoredFinest stored;
    const std::vector<std::string> parts = namesFrom(names->second);
    for (std::size_t k = 0; k < parts.size(); ++k)
        if (finest->second[k] > 0) stored[parts[k]] = finest->second[k];
    return stored;
}

std::string changedContact(const ContactParts& stored, const ContactParts& now)
{
    const std::vector<std::string> lost = missing(stored.names, now.names), got = missing(now.names, stored.names);
    std::string change;
    if (!lost.empty()) change = text("bodies touched ", joined(lost), " and do so no more");
    if (!got.empty()) change += text(change.empty() ? "" : ", and they now touch ", change.empty() ? "bodies now touch " : "", joined(got), change.empty() ? ", which they did not" : "");
    if (!change.empty()) return change;
    if (stored.names != now.names) return "what bodies touch is in another order";
    for (std::size_t k = 0; k < now.sizes.size(); ++k)
        if (stored.sizes[k] != now.sizes[k])
            return text(now.names[k], " had ", stored.sizes[k], " contact spheres or facets (`spheres`, `facetSize`) and now has ", now.sizes[k]);
    return "";
}

std::vector<double> bodyStarts(const BodiesInput& input)
{
    std::vector<double> starts;
    for (const BodyDefinition& b : input.bodies)
    {
        const Eigen::Quaterniond& q = b.pose.orientation;
        for (const Vec3* v : {&b.pose.position, &b.motion.velocity, &b.motion.angularVelocity}) starts.insert(starts.end(), v->data(), v->data() + 3);
        starts.insert(starts.end(), {q.w(), q.x(), q.y(), q.z()});
    }
    return starts;
}

std::string bodiesStartedElsewhere(const BodiesInput& input, const std::vector<double>& stored)
{
    const std::vector<double> now = bodyStarts(input);
    if (stored.size() != now.size()) return "";
    const auto differs = [&](std::size_t k) { return std::abs(now[k] - stored[k]) > 1e-9*std::max({1.0, std::abs(now[k]), std::abs(stored[k])}); };
    std::string name;
    int count = 0;
    for (std::size_t b = 0; b < input.bodies.size(); ++b)
    {
        std::size_t k = b*startSize;
        while (k < (b + 1)*startSize && !differs(k)) ++k;
        if (k < (b + 1)*startSize && ++count == 1) name = input.bodies[b].name;
    }
    return count == 0 ? "" : text("position, orientation or velocity of ", name, count > 1 ? text(" (and ", count - 1, " more)") : "");
}

} // namespace flotsam
