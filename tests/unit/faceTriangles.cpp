// SPDX-License-Identifier: GPL-3.0-or-later
/// Faces of polyhedral cells as triangles.
#include "geometry/faceTriangles.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <algorithm>

using namespace flotsam;

namespace
{

/// Sum of the areas along z, and the flattest of the triangles.
struct Division
{
    std::size_t count = 0;
    double area = 0, flattest = 1e300;
};

Division divided(const std::vector<Vec3>& corners)
{
    Division d;
    for (const auto& t : faceTriangles(corners))
    {
        const Vec3 &a = corners[t[0]], &b = corners[t[1]], &c = corners[t[2]];
        ++d.count;
        d.area += 0.5*(b - a).cross(c - a)[2];
        d.flattest = std::min(d.flattest, flatness(a, b, c));
    }
    return d;
}

} // namespace

TEST_CASE("quadrangles are divided at their first corner")
{
    const std::vector<std::array<int, 3>> fan{{0, 1, 2}, {0, 2, 3}};
    CHECK(faceTriangles({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}) == fan);
}

TEST_CASE("hanging points in any edges of a face leave no slivers, whichever corner is the first, exact or to round-off")
{
    for (int edges = 1; edges < 16; ++edges)
        for (double noise : {0.0, 1e-9})
        {
            const Vec3 square[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
            std::vector<Vec3> corners;
            for (int k = 0; k < 4; ++k)
            {
                corners.push_back(square[k]);
                if (edges & 1 << k) corners.push_back(0.5*(square[k] + square[(k + 1) % 4]) + noise*Vec3(k - 1, 1 - k, k));
            }
            for (std::size_t first = 0; first < corners.size(); ++first)
            {
                const Division d = divided(corners);
                CHECK(d.count == corners.size() - 2);
                CHECK(d.area == within(1, 1e-8));
                CHECK(d.flattest > 0.15);
                std::rotate(corners.begin(), corners.begin() + 1, corners.end());
            }
        }
}

TEST_CASE("a face with a re-entrant corner is covered once")
{
    std::vector<Vec3> corners{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
    for (int first = 0; first < 6; ++first)
    {
        double sum = 0;
        for (const auto& t : faceTriangles(corners)) sum += 0.5*std::abs((corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]])[2]);
        CHECK(sum == near(3, 1e-14));
        std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    }
}
