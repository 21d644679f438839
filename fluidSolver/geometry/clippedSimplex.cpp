// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/clippedSimplex.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{
namespace
{

/// Corners of the tetrahedron's faces, all seen from the same side.
constexpr int faceCorners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

double valueAt(const double* values, const SimplexPoint<3>& p)
{
    double value = 0;
    for (int a = 0; a < 4; ++a) value += values[a] * p.n[a];
    return value;
}

/// Volume over the whole simplex's: shape functions are its coordinates.
double shareOf(const SimplexPoint<3>& apex, const SimplexPoint<3>& a, const SimplexPoint<3>& b, const SimplexPoint<3>& c)
{
    double x[3][3];
    for (int k = 0; k < 3; ++k)
    {
        x[0][k] = a.n[k + 1] - apex.n[k + 1];
        x[1][k] = b.n[k + 1] - apex.n[k + 1];
        x[2][k] = c.n[k + 1] - apex.n[k + 1];
    }
    return std::abs(x[0][0] * (x[1][1] * x[2][2] - x[1][2] * x[2][1]) - x[0][1] * (x[1][0] * x[2][2] - x[1][2] * x[2][0])
                    + x[0][2] * (x[1][0] * x[2][1] - x[1][1] * x[2][0]));
}

} // namespace

ClippedSimplex::ClippedSimplex() : nPoints_(4), nPolygons_(4)
{
    for (int a = 0; a < 4; ++a)
    {
        points_[a] = {};
        points_[a].n[a] = 1;
        polygons_[a].plane = -1;
        polygons_[a].n = 3;
        std::copy_n(faceCorners[a], 3, polygons_[a].corner);
    }
}

/// At the polyhedron's corners.
void ClippedSimplex::evaluate(const double* values)
{
    std::fill_n(isEvaluated_, nPoints_, false);
    nInside_ = nOutside_ = 0;
    for (int p = 0; p < nPolygons_; ++p)
        for (int k = 0; k < polygons_[p].n; ++k)
        {
            const int i = polygons_[p].corner[k];
            if (isEvaluated_[i]) continue;
            isEvaluated_[i] = true;
            values_[i] = valueAt(values, points_[i]);
            ++(values_[i] > 0 ? nOutside_ : nInside_);
        }
}

bool ClippedSimplex::clip(const double* values, int number)
{
    evaluate(values);
    if (nOutside_ == 0) return true;
    if (nInside_ == 0)
    {
        nPolygons_ = 0;
        return true;
    }
    nEdges_ = nSegments_ = 0;
    int n = 0;
    for (int p = 0; p < nPolygons_; ++p)
    {
        Polygon part;
        if (!clip(polygons_[p], part)) return false;
        if (part.n > 0) polygons_[n++] = part; // n <= p: what stood there is done
    }
    nPolygons_ = n;
    return addCap(number);
}

/// The part of a polygon; false: it is no convex one.
bool ClippedSimplex::clip(const Polygon& whole, Polygon& part)
{
    int left = -1, entered = -1;
    part.plane = whole.plane;
    part.n = 0;
    for (int k = 0; k < whole.n; ++k)
    {
        const int i = whole.corner[k], next = whole.corner[k + 1 < whole.n ? k + 1 : 0];
        const bool isOut = values_[i] > 0;
        if (!isOut) part.corner[part.n++] = i;
        if (isOut == (values_[next] > 0)) continue;
        int& crossing = isOut ? entered : left;
        if (crossing >= 0 || part.n + 2 > maxCorners) return false;
        if ((crossing = pointOn(i, next)) < 0) return false;
        part.corner[part.n++] = crossing;
    }
    if (left < 0) return true;
    if (nSegments_ == maxCorners) return false;
    segments_[nSegments_][0] = entered;
    segments_[nSegments_++][1] = left;
    return true;
}

/// Where the plane cuts an edge: found once, for the two polygons that have it. -1: no room.
int ClippedSimplex::pointOn(int from, int to)
{
    const int low = std::min(from, to), high = std::max(from, to);
    for (int k = 0; k < nEdges_; ++k)
        if (edges_[k].from == low && edges_[k].to == high) return edges_[k].point;
    if (nEdges_ == maxCorners || nPoints_ == maxPoints) return -1;
    edges_[nEdges_++] = {low, high, nPoints_};
    const double a = values_[low], b = values_[high];
    for (int k = 0; k < 4; ++k) points_[nPoints_].n[k] = (points_[low].n[k] * b - points_[high].n[k] * a) / (b - a);
    return nPoints_++;
}

/// The polygon on the plane: its sides, one of each polygon that was cut, in their order.
bool ClippedSimplex::addCap(int number)
{
    if (nSegments_ < 3 || nPolygons_ == maxPolygons) return false;
    Polygon& cap = polygons_[nPolygons_++];
    cap.plane = number;
    cap.n = 0;
    int at = segments_[0][0];
    do
    {
        int next = -1;
        for (int s = 0; s < nSegments_ && next < 0; ++s)
            if (segments_[s][0] == at) next = segments_[s][1];
        if (next < 0 || cap.n == nSegments_) return false;
        cap.corner[cap.n++] = at;
        at = next;
    } while (at != segments_[0][0]);
    return cap.n == nSegments_;
}

/// By tetrahedra between one corner and the polygons that do not have it.
void ClippedSimplex::addTo(SimplexMoments<3>& moments, double elementVolume) const
{
    if (isEmpty()) return;
    const int apex = polygons_[nPolygons_ - 1].corner[0];
    for (int p = 0; p < nPolygons_; ++p)
    {
        const Polygon& polygon = polygons_[p];
        if (std::find(polygon.corner, polygon.corner + polygon.n, apex) != polygon.corner + polygon.n) continue;
        for (int k = 2; k < polygon.n; ++k)
        {
            const Point corners[4] = {points_[apex], points_[polygon.corner[0]], points_[polygon.corner[k - 1]], points_[polygon.corner[k]]};
            addPart<3>(moments, corners, shareOf(corners[0], corners[1], corners[2], corners[3]) * elementVolume, elementVolume);
        }
    }
}

} // namespace flotsam
