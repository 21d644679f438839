// SPDX-License-Identifier: GPL-3.0-or-later
/// The closed parts of a surface, and whether they reach into each other. Outside of an outer surface there must be no other part, around a cavity exactly one.
#include "geometry/stlReader.hpp"
#include "geometry/triSurface.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace flotsam
{
namespace
{

constexpr double touch = 1e-4;              // over the smallest extent of the smaller part: parts that touch
constexpr double singlePrecision = 1e-6;    // of coordinates

struct Part
{
    TriSurface surface;
    bool isCavity = false;
    std::shared_ptr<const Shape> shape;     // what it encloses, made when needed
    std::array<Vec3, 2> bounds;

    double thickness() const { return (bounds[1] - bounds[0]).minCoeff(); }

    const Shape& solid()
    {
        if (shape) return *shape;
        TriSurface outward = surface;
        if (isCavity)
            for (auto& t : outward.triangles) std::swap(t[1], t[2]);
        shape = makeClosedSurface(std::move(outward));
        return *shape;
    }
};

/// Triangles that hang together by edges: numbers of the parts.
std::vector<int> partNumbers(const TriSurface& s)
{
    std::vector<int> root(s.triangles.size());
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](int t)
    {
        while (root[t] != t) t = root[t] = root[root[t]];
        return t;
    };
    std::map<std::pair<int, int>, int> firstAt;
    for (std::size_t t = 0; t < s.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k)
        {
            const std::pair<int, int> edge = std::minmax(s.triangles[t][k], s.triangles[t][(k + 1) % 3]);
            root[find(static_cast<int>(t))] = find(firstAt.emplace(edge, static_cast<int>(t)).first->second);
        }
    std::map<int, int> number;
    for (std::size_t t = 0; t < root.size(); ++t) number.emplace(find(static_cast<int>(t)), static_cast<int>(number.size()));
    std::vector<int> numbers;
    for (std::size_t t = 0; t < root.size(); ++t) numbers.push_back(number.at(find(static_cast<int>(t))));
    return numbers;
}

std::vector<Part> findParts(const TriSurface& s)
{
    const std::vector<int> numbers = partNumbers(s);
    std::vector<Part> parts(*std::max_element(numbers.begin(), numbers.end()) + 1);
    if (parts.size() == 1) return parts;
    std::map<std::pair<int, int>, int> point; // of a part and of the whole
    for (std::size_t t = 0; t < numbers.size(); ++t)
    {
        TriSurface& part = parts[numbers[t]].surface;
        auto& corners = part.triangles.emplace_back();
        for (int k = 0; k < 3; ++k)
        {
            const int i = s.triangles[t][k];
            const auto [found, isNew] = point.emplace(std::pair(numbers[t], i), static_cast<int>(part.points.size()));
            if (isNew) part.points.push_back(s.points[i]);
            corners[k] = found->second;
        }
    }
    for (Part& part : parts)
    {
        part.isCavity = enclosedMoments(part.surface).volume < 0;
        part.bounds = {part.surface.points[0], part.surface.points[0]};
        for (const Vec3& x : part.surface.points) part.bounds = {part.bounds[0].cwiseMin(x), part.bounds[1].cwiseMax(x)};
    }
    return parts;
}

class PartChecker
{
public:
    PartChecker(const std::string& file, const TriSurface& surface) : file_(file), parts_(findParts(surface)) {}

    void check()
    {
        if (parts_.size() == 1) return;
        for (std::size_t i = 0; i < parts_.size(); ++i)
        {
            if (parts_[i].isCavity) checkCavity(i);
            for (std::size_t j = 0; j < parts_.size(); ++j)
                if (j != i) checkPair(i, j);
        }
    }

private:
    static std::array<Vec3, 2> commonBox(const Part& a, const Part& b)
    {
        return {a.bounds[0].cwiseMax(b.bounds[0]), a.bounds[1].cwiseMin(b.bounds[1])};
    }

    static double tolerance(const Part& a, const Part& b)
    {
        const double largest = std::max(a.bounds[0].cwiseAbs().maxCoeff(), a.bounds[1].cwiseAbs().maxCoeff());
        return touch * std::min(a.thickness(), b.thickness()) + singlePrecision * largest;
    }

    /// Whether a point of part i's surface lies in the wrong number of other parts; not where it touches one.
    bool isWrong(std::size_t i, const Vec3& x)
    {
        int nAround = 0;
        for (std::size_t j = 0; j < parts_.size(); ++j)
        {
            Part& other = parts_[j];
            const double near = tolerance(parts_[i], other);
            if (j == i || (x - other.bounds[1]).maxCoeff() > near || (other.bounds[0] - x).maxCoeff() > near) continue;
            const double distance = other.solid().distance(x);
            if (std::abs(distance) <= near) return false;
            if (distance < 0) nAround += other.isCavity ? -1 : 1;
        }
        return nAround != (parts_[i].isCavity ? 1 : 0);
    }

    void checkCavity(std::size_t i)
    {
        const TriSurface& s = parts_[i].surface;
        for (const auto& t : s.triangles)
        {
            const Vec3 x = (s.points[t[0]] + s.points[t[1]] + s.points[t[2]]) / 3;
            for (std::size_t j = 0; j < parts_.size(); ++j)
                if (j != i && !parts_[j].isCavity && parts_[j].solid().distance(x) < tolerance(parts_[i], parts_[j])) return; // the pairs are checked next
            fail("one of its " + std::to_string(parts_.size()) + " closed parts is oriented inwards, as a cavity is, but lies in no other part, at " + text(x)
                 + ": turn it (surfaceOrient)");
        }
    }

    /// Where i reaches into j, and to no more parts than it should.
    void checkPair(std::size_t i, std::size_t j)
    {
        const auto [lower, upper] = commonBox(parts_[i], parts_[j]);
        const Vec3 extent = upper - lower;
        const double near = tolerance(parts_[i], parts_[j]);
        if (extent.minCoeff() <= near) return;
        smallest_ = std::max(extent.minCoeff() / 8, extent.maxCoeff() / 64);
        knownDistance_ = 0;
        const TriSurface& s = parts_[i].surface;
        for (const auto& t : s.triangles) checkTriangle(i, j, near, {s.points[t[0]], s.points[t[1]], s.points[t[2]]});
    }

    /// By halves where the other part's surface may pass.
    void checkTriangle(std::size_t i, std::size_t j, double near, const std::array<Vec3, 3>& corners)
    {
        const auto& [lower, upper] = parts_[j].bounds;
        if ((corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]) - upper).maxCoeff() > 0) return;
        if ((lower - corners[0].cwiseMax(corners[1]).cwiseMax(corners[2])).maxCoeff() > 0) return;
        const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3;
        double radius = 0, longest = 0;
        int k = 0;
        for (int c = 0; c < 3; ++c)
        {
            radius = std::max(radius, (corners[c] - middle).norm());
            const double length = (corners[(c + 1) % 3] - corners[c]).norm();
            if (length > longest) k = c;
            longest = std::max(longest, length);
        }
        if ((middle - known_).norm() + radius < std::abs(knownDistance_) - near) return; // on the same side as the last one, which was right
        const double distance = parts_[j].solid().distance(middle);
        known_ = middle;
        knownDistance_ = distance;
        if (distance >= radius) return;
        if (distance < -near && isWrong(i, middle))
            fail("its " + std::to_string(parts_.size()) + " closed parts reach into each other, by " + text(-distance) + " m at " + text(middle)
                 + "; what they share would count twice: unite them in the CAD program (boolean union), or write each to a file of its own and give a 'union' of these");
        if (distance <= -radius || longest <= smallest_) return;
        const Vec3 &a = corners[k], &b = corners[(k + 1) % 3], &c = corners[(k + 2) % 3];
        const Vec3 half = 0.5 * (a + b);
        checkTriangle(i, j, near, {a, half, c});
        checkTriangle(i, j, near, {half, b, c});
    }

    static std::string text(double value)
    {
        std::ostringstream s;
        s << value;
        return s.str();
    }

    static std::string text(const Vec3& x) { return "(" + text(x[0]) + ' ' + text(x[1]) + ' ' + text(x[2]) + ")"; }

    [[noreturn]] void fail(const std::string& what) const { throw std::runtime_error("STL file \"" + file_ + "\": " + what); }

    std::string file_;
    std::vector<Part> parts_;
    // of the pair that is checked
    double smallest_ = 0;       // side of the pieces of triangles
    Vec3 known_ = Vec3::Zero(); // last point of i, and its distance from j
    double knownDistance_ = 0;
};

} // namespace

void requireSeparateParts(const std::string& file, const TriSurface& surface)
{
    PartChecker(file, surface).check();
}

} // namespace flotsam
