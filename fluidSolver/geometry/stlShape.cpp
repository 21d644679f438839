// SPDX-License-Identifier: GPL-3.0-or-later
/// Closed triangulated surface as a shape. Sign of the distance by angle-weighted pseudo-normals: Baerentzen and Aanaes,
/// IEEE Trans. Vis. Comput. Graph. 11 (2005) 243-253, doi:10.1109/TVCG.2005.49.
#include "geometry/convexParts.hpp"
#include "geometry/planeFaces.hpp"
#include "geometry/stlReader.hpp"
#include "geometry/triSurface.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace flotsam
{
namespace
{

/// Nearest point of a triangle and the feature it lies on: 0-2 corner, 3-5 edge k to k+1, 6 face.
struct Nearest
{
    Vec3 point;
    int feature;
};

/// By the regions of the triangle's corners and edges (Ericson, Real-Time Collision Detection, 2005, ch. 5.1.5).
Nearest nearestPoint(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c)
{
    const Vec3 ab = b - a, ac = c - a, ax = x - a, bx = x - b, cx = x - c;
    const double d1 = ab.dot(ax), d2 = ac.dot(ax);
    if (d1 <= 0 && d2 <= 0) return {a, 0};
    const double d3 = ab.dot(bx), d4 = ac.dot(bx);
    if (d3 >= 0 && d4 <= d3) return {b, 1};
    const double onAb = d1 * d4 - d3 * d2;
    if (onAb <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, 3};
    const double d5 = ab.dot(cx), d6 = ac.dot(cx);
    if (d6 >= 0 && d5 <= d6) return {c, 2};
    const double onCa = d5 * d2 - d1 * d6;
    if (onCa <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, 5};
    const double onBc = d3 * d6 - d5 * d4;
    if (onBc <= 0 && d4 >= d3 && d5 >= d6) return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), 4};
    const double w = 1 / (onAb + onBc + onCa);
    return {a + onCa * w * ab + onAb * w * ac, 6};
}

struct Triangle
{
    Vec3 corner[3];
    Vec3 normal[7];     // per feature of Nearest; length does not matter
};

class StlShape : public Shape
{
public:
    explicit StlShape(TriSurface surface);
    double distance(const Vec3& x) const override;
    int faceDistances(const Vec3& x, double* distances) const override { return faces_ ? faces_->distances(x, distances) : 0; }
    bool hasPlaneFaces() const override { return faces_ != nullptr; }
    int nParts() const override { return std::max(1, static_cast<int>(parts_.size())); }
    const Shape& part(int number) const override { return parts_.empty() ? *this : *parts_[number]; }
    std::array<Vec3, 2> bounds() const override { return {tree_[0].lower, tree_[0].upper}; }
    VolumeMoments moments() const override { return enclosedMoments(surface_); }
    TriSurface surface(double) const override { return surface_; }

private:
    static constexpr int leafSize = 4;

    struct Branch
    {
        Vec3 lower, upper;
        int first = 0, count = 0;   // triangles of a leaf; count 0: branch with children child, child+1
        int child = 0;

        double squaredDistance(const Vec3& x) const { return (lower - x).cwiseMax(x - upper).cwiseMax(0.0).squaredNorm(); }
    };

    std::vector<Triangle> makeTriangles() const;
    void grow(int branch, int first, int last, std::vector<Triangle>& triangles);

    TriSurface surface_;
    std::shared_ptr<const PlaneFaces> faces_;   // of a convex polyhedron, else null
    std::vector<std::shared_ptr<const Shape>> parts_;   // of one that is not
    std::vector<Triangle> triangles_;   // in the order of the leaves
    std::vector<Branch> tree_;
};

StlShape::StlShape(TriSurface surface) : surface_(std::move(surface)), faces_(convexFaces(surface_))
{
    if (!faces_) parts_ = convexParts(surface_);
    triangles_ = makeTriangles();
    tree_.reserve(2 * triangles_.size());
    tree_.emplace_back();
    grow(0, 0, static_cast<int>(triangles_.size()), triangles_);
}

std::vector<Triangle> StlShape::makeTriangles() const
{
    const auto& points = surface_.points;
    std::vector<Vec3> face, corner(points.size(), Vec3::Zero());
    std::map<std::pair<int, int>, Vec3> edge;
    for (const auto& t : surface_.triangles)
    {
        const Vec3 n = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).normalized();
        face.push_back(n);
        for (int k = 0; k < 3; ++k)
        {
            const int i = t[k], j = t[(k + 1) % 3];
            const Vec3 u = points[j] - points[i], v = points[t[(k + 2) % 3]] - points[i];
            corner[i] += std::atan2(u.cross(v).norm(), u.dot(v)) * n;
            edge.emplace(std::minmax(i, j), Vec3::Zero()).first->second += n;
        }
    }
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i < face.size(); ++i)
    {
        const auto& t = surface_.triangles[i];
        Triangle& out = triangles.emplace_back();
        out.normal[6] = face[i];
        for (int k = 0; k < 3; ++k)
        {
            out.corner[k] = points[t[k]];
            out.normal[k] = corner[t[k]];
            out.normal[3 + k] = edge.at(std::minmax(t[k], t[(k + 1) % 3]));
        }
    }
    return triangles;
}

void StlShape::grow(int branch, int first, int last, std::vector<Triangle>& triangles)
{
    Vec3 lower = Vec3::Constant(1e300), upper = Vec3::Constant(-1e300);
    for (int i = first; i < last; ++i)
        for (const Vec3& x : triangles[i].corner)
        {
            lower = lower.cwiseMin(x);
            upper = upper.cwiseMax(x);
        }
    tree_[branch].lower = lower;
    tree_[branch].upper = upper;
    if (last - first <= leafSize)
    {
        tree_[branch].first = first;
        tree_[branch].count = last - first;
        return;
    }
    // where the centres are far apart: the box of long triangles side by side is longest along them, where they cannot be told apart
    const auto centre = [](const Triangle& t) -> Vec3 { return t.corner[0] + t.corner[1] + t.corner[2]; };
    Vec3 least = Vec3::Constant(1e300), most = Vec3::Constant(-1e300);
    for (int i = first; i < last; ++i)
    {
        least = least.cwiseMin(centre(triangles[i]));
        most = most.cwiseMax(centre(triangles[i]));
    }
    int d = 0;
    (most - least).maxCoeff(&d);
    const int middle = (first + last) / 2;
    std::nth_element(triangles.begin() + first, triangles.begin() + middle, triangles.begin() + last,
                     [&](const Triangle& a, const Triangle& b) { return centre(a)[d] < centre(b)[d]; });
    const int child = static_cast<int>(tree_.size());
    tree_[branch].child = child;
    tree_.resize(tree_.size() + 2);
    grow(child, first, middle, triangles);
    grow(child + 1, middle, last, triangles);
}

double StlShape::distance(const Vec3& x) const
{
    struct Entry { int branch; double square; };
    Entry stack[128];
    int n = 0;
    stack[n++] = {0, tree_[0].squaredDistance(x)};
    double best = 1e300, side = 1;
    while (n > 0)
    {
        const Entry entry = stack[--n];
        if (entry.square > best) continue;
        const Branch& branch = tree_[entry.branch];
        for (int i = branch.first; i < branch.first + branch.count; ++i)
        {
            const Triangle& t = triangles_[i];
            const Nearest near = nearestPoint(x, t.corner[0], t.corner[1], t.corner[2]);
            const Vec3 r = x - near.point;
            const double square = r.squaredNorm();
            if (square >= best) continue;
            best = square;
            side = r.dot(t.normal[near.feature]);
        }
        if (branch.count > 0) continue;
        Entry a{branch.child, tree_[branch.child].squaredDistance(x)};
        Entry b{branch.child + 1, tree_[branch.child + 1].squaredDistance(x)};
        if (a.square < b.square) std::swap(a, b);
        if (a.square <= best) stack[n++] = a; // the nearer one is looked at first
        if (b.square <= best) stack[n++] = b;
    }
    return std::copysign(std::sqrt(best), side);
}

} // namespace

std::shared_ptr<const Shape> makeClosedSurface(TriSurface surface)
{
    return std::make_shared<StlShape>(std::move(surface));
}

std::shared_ptr<const Shape> makeStl(const std::string& file, double scale)
{
    TriSurface surface = readClosedStl(file, scale);
    requireSeparateParts(file, surface);
    return makeClosedSurface(std::move(surface));
}

} // namespace flotsam
