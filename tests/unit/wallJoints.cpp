// SPDX-License-Identifier: GPL-3.0-or-later
/// A structure that moves and has come within a hundredth of an element of a wall of the mesh has come to the wall. On 1 and 2 ranks.
#include "geometry/coverBuilder.hpp"
#include "support/boxMesh.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

constexpr double h = 0.1;

/// A box of 1 m; the last side (y in 2D, z in 3D) is open.
struct Room
{
    SimplexMesh mesh;
    NodeGraph graph;
    Halo halo;

    /// type: of the other sides.
    Room(int dim, bool alternate, const char* type = "wall")
    :   mesh(withSides(makeBoxMesh(MPI_COMM_WORLD, dim, {10, 10, 10}, {0, 0, 0}, {1, 1, 1}, 0, alternate), type)), graph(mesh), halo(mesh, MPI_COMM_WORLD)
    {}

    static SimplexMesh withSides(SimplexMesh mesh, const char* type)
    {
        for (std::size_t p = 0; p < mesh.patches.size(); ++p) mesh.patches[p].type = p + 1 < mesh.patches.size() ? type : "patch";
        return mesh;
    }

    Cover cut(const Solid& solid) const { return cutMesh(mesh, graph, halo, {solid}); }
};

Solid structure(const Vec3& lower, const Vec3& upper, Solid::Kind kind = Solid::Kind::Prescribed)
{
    Solid solid;
    solid.kind = kind;
    solid.shape = makeBox(Vec3::Zero(), upper - lower);
    solid.pose.position = 0.5*(lower + upper);
    return solid;
}

} // namespace

TEST_CASE("a box that nears a wall leaves the gap as it is down to a hundredth of an element, and none below")
{
    for (const int dim : {2, 3})
        for (const bool alternate : {false, true})
            for (const double at : {0.2, 0.237})
                for (const double gap : {1e-6, 0.003*h, 0.0099*h, 0.0101*h, 0.2*h})
                {
                    CAPTURE(dim);
                    CAPTURE(at);
                    CAPTURE(gap);
                    const Room room(dim, alternate);
                    const double depth = dim == 2 ? 1 : 0.6;
                    const Cover cover = room.cut(structure(Vec3(at, gap, 0.2), Vec3(at + 0.5, gap + 0.35, 0.2 + depth)));
                    const double whole = 0.5*depth*0.35, volume = cover.solidVolume[0];
                    CHECK(volume == near(whole + (gap < 0.01*h ? 0.5*depth*gap : 0), 1e-9));    // 3D: nodes in the box are 1e-6 h below the floor
                }
}

TEST_CASE("a piston through the open side joins the wall beside it from end to end, into the corner")
{
    for (const int dim : {2, 3})
        for (const double gap : {0.002*h, 0.009*h})
        {
            CAPTURE(dim);
            CAPTURE(gap);
            const Room room(dim, true);
            const Cover cover = room.cut(structure(Vec3(gap, -0.1, -0.1), Vec3(0.4, 1.2, 1.2))); // through floor and sides as well
            CHECK(cover.solidVolume[0] == near(0.4, 1e-6));
        }
}

TEST_CASE("nothing else is moved: structures at rest, tilted ones, sides that stand on the wall, open sides")
{
    const Room room(2, true), open(2, true, "patch");
    const auto check = [&](const Solid& solid)
    {
        const Cover cover = room.cut(solid), without = open.cut(solid);
        CHECK(cover.distance == without.distance);
        CHECK(cover.solidVolume == without.solidVolume);
    };
    const double gap = 0.005*h;
    check(structure(Vec3(0.237, gap, -1), Vec3(0.737, 0.35, 2), Solid::Kind::Fixed));
    check(structure(Vec3(0.237, 0.6, -1), Vec3(0.737, 1 - gap, 2)));
    for (const double x : {0.3 - gap, 0.3 + gap})   // a side passes nodes of the floor
        for (const double bottom : {-0.2, 0.0, 0.3*h}) check(structure(Vec3(x, bottom, -1), Vec3(0.737, 0.35, 2)));
    for (const double angle : {0.05, 0.1, 0.7})
    {
        Solid tilted = structure(Vec3(0, 0, -1), Vec3(0.5, 0.35, 2));
        tilted.pose.orientation = Eigen::AngleAxisd(angle, Vec3::UnitZ());
        tilted.pose.position = tilted.pose.orientation*Vec3(0.25, 0.175, 0) + Vec3(0.4, gap, 0);    // its corner is over a node
        check(tilted);
    }
}
