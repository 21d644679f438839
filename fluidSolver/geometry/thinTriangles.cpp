// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/thinTriangles.hpp"

#include "geometry/triSurface.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace flotsam
{

double extentOf(const TriSurface& surface)
{
    if (surface.points.empty()) return 0;
    const auto box = boundsOf(surface);
    return (box[1] - box[0]).norm();
}

namespace
{

constexpr double reach = 0.85/needleAngle;  // of a piece, over the smaller of its widths
constexpr double largestSlant = 1;          // of the ends of a strip, over their width
constexpr double roundOff = 3e-7;           // of points of binary STL files, over the extent

/// A triangle seen over its longest edge, from a to b; `share`: of its length, where the foot of c is.
struct OnEdge
{
    int a, b, c;
    double share, width, length;

    OnEdge(const TriSurface& s, const std::array<int, 3>& t)
    {
        int k = 0;
        length = -1;
        for (int i = 0; i < 3; ++i)
            if (const double edge = (s.points[t[(i + 1) % 3]] - s.points[t[i]]).norm(); edge > length) { length = edge; k = i; }
        a = t[k];
        b = t[(k + 1) % 3];
        c = t[(k + 2) % 3];
        const Vec3 along = s.points[b] - s.points[a], up = s.points[c] - s.points[a];
        share = up.dot(along)/(length*length);
        width = along.cross(up).norm()/length;
    }

    /// The corner between two long edges, as an order of the corners from it on; empty: c is not near an end.
    std::vector<int> fromTip() const
    {
        if ((1 - share)*length <= largestSlant*width) return {a, b, c};
        if (share*length <= largestSlant*width) return {b, c, a};
        return {};
    }
};

/// A long strip with the corners first[0], last[0], last[1], first[1] around it; a triangle with its tip at `first` where both of these are one.
struct LongStrip
{
    std::array<int, 2> first, last;
    bool hasTip() const { return first[0] == first[1]; }
    LongStrip reversed() const { return {{last[1], last[0]}, {first[1], first[0]}}; }
};

/// Where a strip of that length, whose width goes from `first` to `last`, never below `narrowest`, is cut across: shares of its length, the last one 1.
std::vector<double> cuts(double length, double first, double last, double narrowest)
{
    std::vector<double> places;
    for (double x = 0; x < length;)
    {
        x += reach*std::max(narrowest, first + (last - first)*x/length);
        places.push_back(x);
    }
    const double end = places.back();
    for (double& x : places) x /= end; // all a little shorter, instead of one that is too short
    return places;
}

class Division
{
public:
    Division(const TriSurface& surface, std::size_t most) : given_(surface), extent_(extentOf(surface)), narrowest_(narrowestWallTriangle*extent_), most_(most) { result_.surface.points = surface.points; }

    DividedSurface run()
    {
        std::vector<int> thin, negligible;
        for (int t = 0; t < int(given_.triangles.size()); ++t)
        {
            const auto& [a, b, c] = given_.triangles[t];
            const ThinTriangle shape(at(a), at(b), at(c));
            if (!shape.isRefused) result_.surface.triangles.push_back(given_.triangles[t]);
            else if (!shape.isNegligible(extent_)) thin.push_back(t);
            else if (shape.width > roundOff*extent_) negligible.push_back(t);
            else ++result_.leftOut;
        }
        for (const int t : besideEachOther(negligible)) thin.push_back(t);
        result_.leftOut += negligible.size();
        result_.divided = thin.size();
        findTips(thin);
        for (const int t : thin)
        {
            if (result_.pieces > most_) break;
            if (!isDone_.count(t)) divide(t);
        }
        return std::move(result_);
    }

private:
    using Edge = std::pair<int, int>;

    const Vec3& at(int point) const { return result_.surface.points[point]; }

    OnEdge onEdge(int triangle) const { return OnEdge(given_, given_.triangles[triangle]); }

    /// Takes those out of the list that others of it lie beside: the cracks that single ones leave would add up, in fans to holes.
    std::vector<int> besideEachOther(std::vector<int>& triangles) const
    {
        std::map<Edge, int> uses;
        const auto edge = [&](int t, int k) { return Edge(std::minmax(given_.triangles[t][k], given_.triangles[t][(k + 1) % 3])); };
        for (const int t : triangles)
            for (int k = 0; k < 3; ++k) ++uses[edge(t, k)];
        const auto isAlone = [&](int t) { return uses[edge(t, 0)] == 1 && uses[edge(t, 1)] == 1 && uses[edge(t, 2)] == 1; };
        const auto first = std::stable_partition(triangles.begin(), triangles.end(), isAlone);
        const std::vector<int> beside(first, triangles.end());
        triangles.erase(first, triangles.end());
        return beside;
    }

    /// Long edges, in the direction they have in a triangle with a tip.
    void findTips(const std::vector<int>& thin)
    {
        for (const int t : thin)
        {
            const std::vector<int> corners = onEdge(t).fromTip();
            if (corners.empty()) continue;
            atLongEdge_[{corners[0], corners[1]}].push_back(t);
            atLongEdge_[{corners[2], corners[0]}].push_back(t);
        }
    }

    void divide(int triangle)
    {
        const OnEdge e = onEdge(triangle);
        const std::vector<int> corners = e.fromTip();
        if (corners.empty())
        {
            const int foot = addPoint(at(e.a) + e.share*(at(e.b) - at(e.a)));
            addStrip({{e.a, e.a}, {foot, e.c}});
            addStrip({{e.b, e.b}, {e.c, foot}});
        }
        else if (!divideWithNeighbour(triangle, corners))
            addStrip({{corners[0], corners[0]}, {corners[1], corners[2]}});
    }

    /// A plane strip that one diagonal divides, as pipes and frames consist of: it has no sharp corners, and fewer pieces.
    bool divideWithNeighbour(int triangle, const std::vector<int>& corners)
    {
        isDone_.insert(triangle);
        const int tip = corners[0], left = corners[1], right = corners[2];
        if (const int other = neighbourWithTip(left, tip); other >= 0 && isPlane({tip, left}, right, other))
            return addStrip({{thirdOf(other, tip, left), tip}, {left, right}}), isDone_.insert(other), true;
        if (const int other = neighbourWithTip(right, tip); other >= 0 && isPlane({right, tip}, left, other))
            return addStrip({{tip, thirdOf(other, right, tip)}, {left, right}}), isDone_.insert(other), true;
        return false;
    }

    /// The only triangle with its tip at the first of two points and a long edge to the other; -1: none, or one that is done.
    int neighbourWithTip(int tip, int other) const
    {
        int found = -1, count = 0;
        for (const Edge& edge : {Edge(tip, other), Edge(other, tip)})
            if (const auto there = atLongEdge_.find(edge); there != atLongEdge_.end())
                for (const int t : there->second)
                    if (onEdge(t).fromTip()[0] == tip) { found = t; ++count; }
        return count == 1 && !isDone_.count(found) ? found : -1;
    }

    int thirdOf(int triangle, int a, int b) const
    {
        for (const int corner : given_.triangles[triangle])
            if (corner != a && corner != b) return corner;
        return -1;
    }

    /// Whether the triangle on the other side of an edge of a triangle, in its sense, lies in the plane of that, turned the same way. opposite: the corner that is not on the edge.
    bool isPlane(const Edge& edge, int opposite, int other) const
    {
        const Vec3 along = at(edge.second) - at(edge.first), up = at(opposite) - at(edge.first), down = at(thirdOf(other, edge.first, edge.second)) - at(edge.first);
        const Vec3 normal = along.cross(up).normalized();
        return std::abs(normal.dot(down)) <= roundOff*extent_ && normal.dot(down.cross(along)) > 0;
    }

    void addStrip(LongStrip strip)
    {
        const auto middle = [&](const std::array<int, 2>& end) -> Vec3 { return 0.5*(at(end[0]) + at(end[1])); };
        const Vec3 axis = middle(strip.last) - middle(strip.first);
        const double length = axis.norm();
        const auto width = [&](const std::array<int, 2>& end) { return (at(end[1]) - at(end[0])).cross(axis).norm()/length; };
        if (width(strip.first) > width(strip.last)) strip = strip.reversed();
        const double first = width(strip.first), last = width(strip.last);
        if (strip.hasTip() && length <= reach*last) return addPiece(strip.first[0], strip.last[0], strip.last[1]); // of a half
        std::array<int, 2> before = strip.first;
        for (const double share : cuts(length, first, last, narrowest_))
        {
            const double widening = std::max(1.0, narrowest_/(first + (last - first)*share));
            const std::array<int, 2> here = share < 1 || widening > 1 ? addCut(strip, share, widening) : strip.last;
            addPiece(before[0], here[0], before[1]);
            addPiece(here[0], here[1], before[1]);
            before = here;
        }
    }

    std::array<int, 2> addCut(const LongStrip& strip, double share, double widening)
    {
        const auto point = [&](int side) -> Vec3 { return at(strip.first[side]) + share*(at(strip.last[side]) - at(strip.first[side])); };
        const Vec3 a = point(0), b = point(1), out = 0.5*(widening - 1)*(b - a);
        const int first = addPoint(a - out);
        return {first, addPoint(b + out)};
    }

    int addPoint(const Vec3& x)
    {
        result_.surface.points.push_back(x);
        return int(result_.surface.points.size()) - 1;
    }

    void addPiece(int a, int b, int c)
    {
        if (a == c) return; // at a tip
        result_.surface.triangles.push_back({a, b, c});
        ++result_.pieces;
    }

    const TriSurface& given_;
    double extent_, narrowest_;
    std::size_t most_;
    DividedSurface result_;
    std::map<Edge, std::vector<int>> atLongEdge_;
    std::set<int> isDone_;  // with a neighbour
};

} // namespace

DividedSurface divideThinTriangles(const TriSurface& surface, std::size_t most)
{
    return Division(surface, most).run();
}

} // namespace flotsam
