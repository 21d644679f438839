// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/stlReader.hpp"

#include "geometry/triSurface.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <unordered_map>

namespace flotsam
{
namespace
{

/// Three corners per triangle, as in the file.
using Corners = std::vector<Vec3>;

[[noreturn]] void fail(const std::string& file, const std::string& what)
{
    throw std::runtime_error("STL file \"" + file + "\": " + what);
}

std::string text(const Vec3& x)
{
    std::ostringstream s;
    s.precision(9);
    s << '(' << x[0] << ' ' << x[1] << ' ' << x[2] << ')';
    return s.str();
}

constexpr std::size_t binaryHeader = 84, binaryTriangle = 50;

bool isBinary(const std::string& data)
{
    if (data.size() < binaryHeader) return false;
    std::uint32_t n = 0;
    std::memcpy(&n, data.data() + 80, 4);
    return data.size() == binaryHeader + binaryTriangle * n;
}

Corners readBinary(const std::string& data)
{
    Corners corners;
    for (std::size_t at = binaryHeader; at + binaryTriangle <= data.size(); at += binaryTriangle)
    {
        float values[9];
        std::memcpy(values, data.data() + at + 12, sizeof values); // 12 bytes of normal first
        for (int i = 0; i < 3; ++i) corners.emplace_back(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
    }
    return corners;
}

/// Some programs write them in capitals.
bool isKeyword(std::string word, const char* keyword)
{
    for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return word == keyword;
}

Corners readAscii(const std::string& file, const std::string& data)
{
    std::istringstream in(data);
    std::string word;
    if (!(in >> word) || !isKeyword(word, "solid"))
        fail(file, "neither binary (its length does not fit the number of triangles) nor ASCII (it does not start with 'solid')");
    Corners corners;
    while (in >> word)
    {
        if (!isKeyword(word, "vertex")) continue;
        double x[3];
        if (!(in >> x[0] >> x[1] >> x[2])) fail(file, "vertex number " + std::to_string(corners.size() + 1) + " is not three numbers");
        corners.emplace_back(x[0], x[1], x[2]);
    }
    if (corners.size() % 3 != 0) fail(file, "found " + std::to_string(corners.size()) + " vertices, not a multiple of 3");
    return corners;
}

Corners readCorners(const std::string& file)
{
    std::ifstream in(file, std::ios::binary);
    if (!in) fail(file, "cannot be opened");
    const std::string data((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    Corners corners = isBinary(data) ? readBinary(data) : readAscii(file, data);
    if (corners.empty()) fail(file, "holds no triangles");
    for (const Vec3& x : corners)
        if (!x.allFinite()) fail(file, "holds a vertex that is not a finite number");
    return corners;
}

/// Numbers points; points closer than the tolerance get the same number. A grid of cells finds them.
class PointMerger
{
public:
    explicit PointMerger(double tolerance) : tolerance_(tolerance) {}

    int add(const Vec3& x, std::vector<Vec3>& points)
    {
        const Vec3 scaled = x / (4 * tolerance_), cell = scaled.array().floor();
        for (int k = 0; k < 27; ++k)
        {
            const Vec3 step(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
            if (!isNear(scaled - cell, step)) continue;
            const auto found = cells_.find(key(cell + step));
            if (found == cells_.end()) continue;
            for (int i : found->second)
                if ((points[i] - x).norm() <= tolerance_) return i;
        }
        const int i = static_cast<int>(points.size());
        cells_[key(cell)].push_back(i);
        points.push_back(x);
        return i;
    }

private:
    /// Whether the neighbouring cell can hold a point within the tolerance, a quarter of a cell, of one at `place` in its own cell: a look is what a point costs.
    static bool isNear(const Vec3& place, const Vec3& step)
    {
        constexpr double reach = 0.26; // with round-off
        for (int d = 0; d < 3; ++d)
            if ((step[d] < 0 && place[d] > reach) || (step[d] > 0 && place[d] < 1 - reach)) return false;
        return true;
    }

    static std::uint64_t key(const Vec3& cell)
    {
        std::uint64_t k = 0; // collisions only cost time: the distance decides
        for (int d = 0; d < 3; ++d) k = (k ^ static_cast<std::uint64_t>(std::llround(cell[d]))) * 0x9E3779B97F4A7C15ull;
        return k;
    }

    double tolerance_;
    std::unordered_map<std::uint64_t, std::vector<int>> cells_;
};

TriSurface merge(const Corners& corners)
{
    Vec3 lower = corners[0], upper = corners[0];
    for (const Vec3& x : corners)
    {
        lower = lower.cwiseMin(x);
        upper = upper.cwiseMax(x);
    }
    TriSurface s;
    PointMerger merger(1e-7 * std::max((upper - lower).norm(), 1e-300));
    for (std::size_t i = 0; i < corners.size(); i += 3)
    {
        std::array<int, 3> t;
        for (int k = 0; k < 3; ++k) t[k] = merger.add(corners[i + k] - lower, s.points); // small numbers in the grid
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) s.triangles.push_back(t);
    }
    for (Vec3& x : s.points) x += lower;
    return s;
}

/// How often each directed edge is used.
using EdgeUses = std::map<std::pair<int, int>, int>;

int count(const EdgeUses& uses, int a, int b)
{
    const auto found = uses.find({a, b});
    return found == uses.end() ? 0 : found->second;
}

/// Of an open edge: another one that runs beside it the other way closes it, where their points were written as different ones.
std::string openEdgeCure(const TriSurface& s, const EdgeUses& uses, int a, int b)
{
    constexpr double beside = 0.01; // of the edge's length
    double apart = beside * (s.points[b] - s.points[a]).norm();
    bool isFound = false;
    for (const auto& [edge, n] : uses)
    {
        const auto [c, d] = edge;
        if ((c == a && d == b) || count(uses, d, c) > 0) continue;
        const double gap = std::max((s.points[c] - s.points[b]).norm(), (s.points[d] - s.points[a]).norm());
        if (gap > apart) continue;
        apart = gap;
        isFound = true;
    }
    if (!isFound) return "; a body needs a closed surface: surfaceCheck finds its holes, also where a point lies in the middle of an edge; close them in the CAD program (terrain needs sides and a bottom)";
    std::ostringstream cure;
    cure << "; another open edge is beside it, " << apart << " m away, and would close it: surfacePointMerge makes points that are nearer than a given distance one";
    return cure.str();
}

/// The same corners in the same sense; the other way round it is the face between two parts.
bool hasTwin(const TriSurface& s, std::array<int, 3> t)
{
    const auto turned = [](std::array<int, 3> corners)
    {
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        return corners;
    };
    return std::count_if(s.triangles.begin(), s.triangles.end(), [&](const std::array<int, 3>& other) { return turned(other) == turned(t); }) > 1;
}

/// Of triangles at an edge with more than two.
std::string sharedEdgeCure(const TriSurface& s, int a, int b)
{
    for (const auto& t : s.triangles)
        if (std::count(t.begin(), t.end(), a) + std::count(t.begin(), t.end(), b) == 2 && hasTwin(s, t))
            return "; one of them is there twice: surfaceClean takes the second one out";
    return "; parts with a common edge or face: unite them in the CAD program (boolean union), or write each to a file of its own and give a 'union' of these";
}

/// Ends messages about surfaces whose points may have been rounded together: coordinates of a map in single precision, which binary files have and many programs write.
std::string roundingCure(const TriSurface& s)
{
    constexpr double singlePrecision = 1.2e-7, harmless = 1e-4; // of the farthest coordinate, of the surface's extent
    Vec3 lower = s.points[0], upper = s.points[0];
    for (const Vec3& x : s.points)
    {
        lower = lower.cwiseMin(x);
        upper = upper.cwiseMax(x);
    }
    const double farthest = std::max(lower.cwiseAbs().maxCoeff(), upper.cwiseAbs().maxCoeff());
    if (singlePrecision * farthest < harmless * (upper - lower).norm()) return "";
    std::ostringstream cure;
    cure << "; its coordinates reach " << farthest << " m, where the single precision of STL files knows steps of " << singlePrecision * farthest
         << " m: export it near its origin, and give its place as 'position'";
    return cure.str();
}

/// Every directed edge once and its reverse once.
void requireClosed(const std::string& file, const TriSurface& s)
{
    const std::string orientationCure = "; a body needs a surface that is outwards all over: surfaceOrient turns them";
    EdgeUses uses;
    for (const auto& t : s.triangles)
        for (int k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
    for (const auto& [directed, forward] : uses)
    {
        const auto [a, b] = directed;
        const int backward = count(uses, b, a);
        if (forward == 1 && backward == 1) continue;
        const std::string rounding = roundingCure(s), edge = "the edge " + text(s.points[a]) + " - " + text(s.points[b]);
        if (forward + backward == 1) fail(file, "the surface is open: " + edge + " belongs to one triangle only" + (rounding.empty() ? openEdgeCure(s, uses, a, b) : rounding));
        if (forward + backward == 2)
            fail(file, edge + " lies between triangles of opposite orientation" + (rounding.empty() ? orientationCure : rounding));
        fail(file, edge + " belongs to " + std::to_string(forward + backward) + " triangles, wanted 2" + (rounding.empty() ? sharedEdgeCure(s, a, b) : rounding));
    }
}

} // namespace

TriSurface readClosedStl(const std::string& file, double scale)
{
    if (!(scale > 0)) fail(file, "scale must be positive, found " + std::to_string(scale));
    TriSurface s = merge(readCorners(file));
    for (Vec3& x : s.points) x *= scale;
    requireClosed(file, s);
    const double volume = enclosedMoments(s).volume;
    if (volume == 0) fail(file, "the surface encloses no volume" + roundingCure(s));
    if (volume < 0)
        for (auto& t : s.triangles) std::swap(t[1], t[2]);
    return s;
}

} // namespace flotsam
