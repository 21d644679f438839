// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/faceTriangles.hpp"

#include <algorithm>
#include <functional>

namespace flotsam
{

namespace
{

using Triangles = std::vector<std::array<int, 3>>;

Triangles fanOf(int n)
{
    Triangles fan;
    for (int k = 1; k + 1 < n; ++k) fan.push_back({0, k, k + 1});
    return fan;
}

Vec3 areaVector(const std::vector<Vec3>& x)
{
    Vec3 area = Vec3::Zero();
    for (const auto& t : fanOf(int(x.size()))) area += (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
    return area;
}

/// Flatness, negative where the triangle is turned against the face.
double signedFlatness(const std::vector<Vec3>& x, const std::array<int, 3>& t, const Vec3& area)
{
    const double size = flatness(x[t[0]], x[t[1]], x[t[2]]);
    return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).dot(area) < 0 ? -size : size;
}

/// Of the polygons between two corners the division whose flattest triangle is best, from shorter to longer ones.
Triangles bestDivision(const std::vector<Vec3>& x, const Vec3& area)
{
    const int n = int(x.size());
    std::vector<double> best(std::size_t(n)*n, 1e300);
    std::vector<int> apex(std::size_t(n)*n, -1);
    for (int width = 2; width < n; ++width)
        for (int i = 0; i + width < n; ++i)
        {
            const int j = i + width, here = i*n + j;
            best[here] = -1e300;
            for (int k = i + 1; k < j; ++k)
            {
                const double flattest = std::min({best[i*n + k], best[k*n + j], signedFlatness(x, {i, k, j}, area)});
                if (flattest > best[here]) { best[here] = flattest; apex[here] = k; }
            }
        }
    Triangles division;
    const std::function<void(int, int)> collect = [&](int i, int j)
    {
        const int k = apex[i*n + j];
        if (k < 0) return;
        division.push_back({i, k, j});
        collect(i, k);
        collect(k, j);
    };
    collect(0, n - 1);
    return division;
}

} // namespace

double flatness(const Vec3& a, const Vec3& b, const Vec3& c)
{
    const double square = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return square > 0 ? (b - a).cross(c - a).norm()/square : 0;
}

std::vector<std::array<int, 3>> faceTriangles(const std::vector<Vec3>& corners)
{
    const Triangles fan = fanOf(int(corners.size()));
    const Vec3 area = areaVector(corners);
    const bool hasSliver = std::any_of(fan.begin(), fan.end(), [&](const auto& t) { return signedFlatness(corners, t, area) < needleAngle; });
    return hasSliver ? bestDivision(corners, area) : fan;
}

} // namespace flotsam
