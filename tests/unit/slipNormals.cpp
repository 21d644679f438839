// SPDX-License-Identifier: GPL-3.0-or-later
/// Which directions slip patches prescribe at a node where they meet.
#include "equations/slipNormals.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace flotsam;

namespace
{

/// A face with outward normal n whose centre lies at p from the node.
struct Face
{
    double n[3], p[3];
};

SlipNormals normalsOf(const std::vector<Face>& faces, int dim)
{
    SlipNormals normals;
    for (const Face& face : faces) normals.addFace(face.n, face.p, dim);
    normals.findWalls();
    return normals;
}

} // namespace

TEST_CASE("walls of a tank hold the velocity in each of their normals")
{
    const SlipNormals edge = normalsOf({{{0, -1}, {1, 0}}, {{-1, 0}, {0, 1}}}, 2);
    CHECK(!edge.hasEdge());
    CHECK(edge.constraint(7, 2).nDirections == 2);
    CHECK(edge.constraint(7, 2).node == 7);
    const SlipNormals corner = normalsOf({{{0, 0, -1}, {1, 1, 0}}, {{-1, 0, 0}, {0, 1, 1}}, {{0, -1, 0}, {1, 0, 1}}}, 3);
    CHECK(!corner.hasEdge());
    CHECK(corner.constraint(0, 3).nDirections == 3);
}

TEST_CASE("the rim of a box holds nothing, its foot only what the floor holds")
{
    const Face top{{0, 0, -1}, {-1, 0, 0}}, front{{-1, 0, 0}, {0, 0, -1}};
    CHECK(normalsOf({top, front}, 3).hasEdge());
    CHECK(normalsOf({top, front}, 3).constraint(0, 3).nDirections == 0);
    const Face side{{0, -1, 0}, {-1, 0, -1}}, frontBesideSide{{-1, 0, 0}, {0, -1, -1}}, topBehind{{0, 0, -1}, {-1, -1, 0}};
    CHECK(normalsOf({side, frontBesideSide, topBehind}, 3).constraint(0, 3).nDirections == 0);
    const Face floor{{0, 0, -1}, {1, 0, 0}}, frontUp{{-1, 0, 0}, {0, -1, 1}}, sideUp{{0, -1, 0}, {-1, 0, 1}};
    const NodeConstraint foot = normalsOf({floor, frontUp, sideUp}, 3).constraint(0, 3);
    CHECK(foot.nDirections == 1);
    CHECK(foot.direction[0][2] == near(-1, 1e-14));
    // of the three walls at the foot the floor is at no re-entrant edge
    const std::vector<std::array<double, 3>> atEdge = normalsOf({floor, Face{{-2, 0, 0}, {0, -1, 1}}, sideUp}, 3).edgeNormals();
    REQUIRE(atEdge.size() == 2);
    CHECK(atEdge[0] == std::array<double, 3>{-1, 0, 0});
    CHECK(atEdge[1] == std::array<double, 3>{0, -1, 0});
}

TEST_CASE("the walls at a node do not depend on the order of their faces")
{
    // a bed, a bank of 60 degrees and the rounded toe between them, in steps of 20 degrees: each is near enough to the next to be one wall with it
    std::vector<Face> faces;
    for (int k = 0; k < 4; ++k)
    {
        const double angle = 0.35*k;
        faces.push_back({{std::sin(angle), 0.1*k, -std::cos(angle)}, {std::cos(angle), 0, std::sin(angle)}});
        faces.push_back({{std::sin(angle), -0.1*k, -std::cos(angle)}, {std::cos(angle), 0.1, std::sin(angle)}});
    }
    std::vector<int> order(faces.size());
    std::iota(order.begin(), order.end(), 0);
    const NodeConstraint expected = normalsOf(faces, 3).constraint(0, 3);
    CHECK(expected.nDirections > 1);
    do
    {
        std::vector<Face> turned;
        for (const int k : order) turned.push_back(faces[k]);
        const NodeConstraint found = normalsOf(turned, 3).constraint(0, 3);
        REQUIRE(found.nDirections == expected.nDirections);
        for (int k = 0; k < found.nDirections; ++k)
            for (int d = 0; d < 3; ++d) REQUIRE(found.direction[k][d] == within(expected.direction[k][d], 1e-12));
    }
    while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("faces of one smooth wall have one normal, its sides too")
{
    const double c = std::cos(0.2), s = std::sin(0.2);
    const SlipNormals pipe = normalsOf({{{s, c}, {-1, 0.1}}, {{-s, c}, {1, 0.1}}}, 2);
    CHECK(!pipe.hasEdge());
    CHECK(pipe.constraint(0, 2).nDirections == 1);
    CHECK(std::abs(pipe.constraint(0, 2).direction[0][0]) < 1e-15);
    CHECK(pipe.isBent());
    const SlipNormals baffle = normalsOf({{{0, 1}, {1, 1e-17}}, {{0, -1}, {-1, -1e-17}}}, 2);
    CHECK(!baffle.hasEdge());
    CHECK(baffle.constraint(0, 2).nDirections == 1);
    const SlipNormals plane = normalsOf({{{0.3*s, 0.3*c}, {-1, 0.1}}, {{0.7*s, 0.7*c}, {1, -0.1}}}, 2), corner = normalsOf({{{0, -1}, {1, 0}}, {{-1, 0}, {0, 1}}}, 2);
    CHECK(!plane.isBent());
    CHECK(!corner.isBent());
}
