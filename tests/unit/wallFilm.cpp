// SPDX-License-Identifier: GPL-3.0-or-later
/// The cut keeps a loose solid a film's thickness off the mesh's walls, and nothing else.
#include "geometry/coverBuilder.hpp"
#include "support/boxMesh.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

constexpr double h = 0.1, film = filmThickness*h;

/// A box of 1 m with walls all around.
struct Room
{
    SimplexMesh mesh;
    NodeGraph graph;
    Halo halo;

    Room(int dim, bool alternate)
    :   mesh(withWalls(makeBoxMesh(MPI_COMM_WORLD, dim, {10, 10, 10}, {0, 0, 0}, {1, 1, 1}, 0, alternate))), graph(mesh), halo(mesh, MPI_COMM_WORLD)
    {}

    static SimplexMesh withWalls(SimplexMesh mesh)
    {
        for (MeshPatch& patch : mesh.patches) patch.type = "wall";
        return mesh;
    }

    Cover cut(const Solid& solid) const { return cutMesh(mesh, graph, halo, {solid}); }
};

/// Height of the cut over the floor of a face `gap` over it: lifted at the floor's nodes alone.
double bottomOf(double gap) { return gap < film ? film*h/(h + film - gap) : gap; }

Solid looseBox(const Vec3& lower, const Vec3& upper)
{
    Solid solid;
    solid.kind = Solid::Kind::Free;
    solid.isLoose = true;
    solid.shape = makeBox(Vec3::Zero(), upper - lower);
    solid.pose.position = 0.5*(lower + upper);
    return solid;
}

/// Sum over a solid's facets of area and normal: 0 for a closed surface.
Vec3 closure(const Room& room, const Cover& cover)
{
    double sum[3] = {};
    for (const CutFacet& facet : cover.facets)
        for (int d = 0; d < room.mesh.dim && room.mesh.isOwnedElement[facet.element]; ++d) sum[d] += facet.area*facet.normal[d];
    room.halo.sum(sum, 3);
    return Vec3(sum[0], sum[1], sum[2]);
}

} // namespace

// Volumes of boxes with faces on nodes are exact but for these, which count as inside by 1e-10 of an element.
TEST_CASE("a box on the floor, flush with the mesh or not, loses the film and keeps a closed surface")
{
    for (const int dim : {2, 3})
        for (const bool alternate : {false, true})
            for (const double x : {0.3, 0.3 + 1e-9, 0.3 - 1e-9, 0.303, 0.337})
                for (const double gap : {-1e-4, -1e-9, 0.0, 1e-9, 0.2*film, film, 2*film, 0.7*h})
                {
                    CAPTURE(dim);
                    CAPTURE(x);
                    CAPTURE(gap);
                    const Room room(dim, alternate);
                    const double depth = dim == 2 ? 1 : 0.37;
                    const Cover cover = room.cut(looseBox(Vec3(x, gap, 0.31), Vec3(x + 0.4, gap + 0.35, 0.31 + depth)));
                    CHECK(cover.solidVolume[0] == near(0.4*depth*(gap + 0.35 - bottomOf(gap)), 2e-10));
                    CHECK(closure(room, cover).norm() < 1e-7);
                    CHECK(cover.filmNodes.empty() == false);
                }
}

// Until it is let go it is a solid that moves as prescribed, not at all: its load must not jump then.
TEST_CASE("a body that is held on the floor is cut as it is when it is free")
{
    for (const int dim : {2, 3})
        for (const double x : {0.3, 0.337})
            for (const double gap : {-1e-4, 0.0, 0.2*film, 2*film})
            {
                CAPTURE(dim);
                CAPTURE(x);
                CAPTURE(gap);
                const Room room(dim, true);
                Solid box = looseBox(Vec3(x, gap, 0.31), Vec3(x + 0.4, gap + 0.35, 0.31 + (dim == 2 ? 1 : 0.37)));
                const Cover free = room.cut(box);
                box.kind = Solid::Kind::Prescribed;
                const Cover held = room.cut(box);
                CHECK(held.solidVolume[0] == free.solidVolume[0]);
                CHECK(held.facets.size() == free.facets.size());
            }
}

TEST_CASE("in a corner of walls the film is on both")
{
    for (const int dim : {2, 3})
        for (const bool alternate : {false, true})
        {
            CAPTURE(dim);
            CAPTURE(alternate);
            const Room room(dim, alternate);
            const double depth = dim == 2 ? 1 : 0.37;
            for (const bool isLeft : {true, false})
            {
                const double x = isLeft ? 0 : 0.6;
                const Cover cover = room.cut(looseBox(Vec3(x, 0, 0.31), Vec3(x + 0.4, 0.35, 0.31 + depth)));
                CHECK(cover.solidVolume[0] == near((0.4 - bottomOf(0))*(0.35 - bottomOf(0))*depth, 1e-3));
                CHECK(closure(room, cover).norm() < 1e-7);
            }
        }
}

TEST_CASE("bodies that lie on the upper edge of a high step keep closed surfaces: most of the wall at the edge is the step's side")
{
    const double top = 0.5;
    for (const int dim : {2, 3})
    {
        Room room(dim, true);
        SimplexMesh& mesh = room.mesh;
        for (int i = 0; i < mesh.nNodes; ++i)     // the floor rises between x = 0.5 and 0.6
        {
            double* x = &mesh.x[std::size_t(i)*dim];
            if (x[0] > 0.55) x[1] += top*(1 - x[1]);
        }
        mesh.computeGeometry();
        for (const double x : {0.6, 0.57, 0.62, 0.68})
            for (const double gap : {-1e-3, -1e-9, 1e-3})
            {
                CAPTURE(dim);
                CAPTURE(x);
                CAPTURE(gap);
                CHECK(closure(room, room.cut(looseBox(Vec3(x - 0.13, top + gap, 0.31), Vec3(x + 0.12, top + gap + 0.25, dim == 2 ? 1.31 : 0.68)))).norm() < 1e-7);
                Solid log = looseBox(Vec3::Zero(), Vec3::Ones());
                log.shape = dim == 2 ? makeCylinder(Vec3(0, 0, -1), Vec3(0, 0, 1), 0.15) : makeCylinder(Vec3(0, 0, -0.2), Vec3(0, 0, 0.2), 0.15);
                log.pose.position = Vec3(x, top + gap + 0.15, 0.52);
                CHECK(closure(room, room.cut(log)).norm() < 1e-7);
                log.shape = dim == 2 ? makeCylinder(Vec3(0, 0, -1), Vec3(0, 0, 1), 0.13) : makeSphere(Vec3::Zero(), 0.13);
                log.pose.position = Vec3(x, top + gap + 0.13, 0.52);
                CHECK(closure(room, room.cut(log)).norm() < 1e-7);
            }
    }
}

TEST_CASE("round bodies keep their volume, structures and bodies away from walls are cut as they are")
{
    Room room(2, true);
    CoverBuilder builder(room.mesh, room.graph, room.halo);
    std::vector<Solid> solids(1);
    solids[0].kind = Solid::Kind::Free;
    solids[0].isLoose = true;
    solids[0].shape = makeCylinder(Vec3(0, 0, -1), Vec3(0, 0, 1), 0.2);
    solids[0].pose.position = Vec3(0.47, 0.199, 0);
    for (int k = 0; k < 7; ++k) builder.buildExactVolume(solids);    // over the film the surface does not move: each leaves 0.44 of what is missing
    CHECK(builder.cover().solidVolume[0] == near(M_PI*0.04, 2e-5));
    CHECK(closure(room, builder.cover()).norm() < 1e-7);

    const auto boxOnFloor = [&](Solid::Kind kind, bool isLoose)
    {
        Solid box = looseBox(Vec3(0.3, 0, 0), Vec3(0.7, 0.35, 1));
        box.kind = kind;
        box.isLoose = isLoose;
        return room.cut(box);
    };
    for (const Solid::Kind kind : {Solid::Kind::Fixed, Solid::Kind::Prescribed, Solid::Kind::Free})
    {
        const Cover joined = boxOnFloor(kind, false);
        CHECK(joined.filmNodes.empty());
        for (MeshPatch& patch : room.mesh.patches) patch.type = "patch";
        const double loose = boxOnFloor(kind, true).solidVolume[0];     // held bodies (prescribed) are sharp, structures that move are not where they are at the boundary
        CHECK(loose == near(0.4*0.35, 2e-10));
        if (kind != Solid::Kind::Prescribed) CHECK(loose == joined.solidVolume[0]);
        for (MeshPatch& patch : room.mesh.patches) patch.type = "wall";
    }
    const Cover away = room.cut(looseBox(Vec3(0.3, 0.13, 0), Vec3(0.7, 0.5, 1)));
    CHECK(away.solidVolume[0] == near(0.4*0.37, 3e-10));
    CHECK(away.filmNodes.empty());

    for (MeshPatch& patch : room.mesh.patches) patch.type = "patch"; // open: a body on its way out
    const Cover leaving = room.cut(looseBox(Vec3(0.8, 0, 0), Vec3(1.2, 0.35, 1)));
    CHECK(leaving.solidVolume[0] == near(0.2*0.35, 2e-10));
}

TEST_CASE("tilted boxes over the floor are cut as they are until they touch it")
{
    for (const double angle : {0.5, 0.785, 1.1})
        for (const double gap : {0.2*h, 0.6*h})
        {
            CAPTURE(angle);
            CAPTURE(gap);
            Room room(2, true);
            Solid box = looseBox(Vec3(0.3, 0, 0), Vec3(0.6, 0.2, 1));
            box.pose.orientation = Eigen::AngleAxisd(angle, Vec3::UnitZ());
            box.pose.position[1] = gap + 0.15*std::sin(angle) + 0.1*std::cos(angle);
            CHECK(room.cut(box).solidVolume[0] == near(0.3*0.2, 1e-14));
        }
}

TEST_CASE("between walls one element apart there is no room for films")
{
    Room room(3, false);
    room.mesh = Room::withWalls(makeBoxMesh(MPI_COMM_WORLD, 3, {10, 10, 1}, {0, 0, 0}, {1, 1, 0.1}));
    const NodeGraph graph(room.mesh);
    const Halo halo(room.mesh, MPI_COMM_WORLD);
    Solid solid = looseBox(Vec3(0.3, 0.3, 0), Vec3(0.7, 0.65, 0.1));
    CHECK(cutMesh(room.mesh, graph, halo, {solid}).solidVolume[0] == near(0.4*0.35*0.1, 3e-10));
    solid.shape = makeSphere(Vec3::Zero(), 0.2);
    const double volume = cutMesh(room.mesh, graph, halo, {solid}).solidVolume[0];
    solid.isLoose = false;
    CHECK(volume == cutMesh(room.mesh, graph, halo, {solid}).solidVolume[0]);
}

TEST_CASE("the surface of a box is closed that has an edge in the floor, between its nodes or not")
{
    for (const int dim : {2, 3})
        for (const bool alternate : {false, true})
            for (const double degrees : {10., 20., 40., 50., 60., 75.})
                for (const double depth : {0.01, 0.1, 0.3, 0.45})
                {
                    CAPTURE(dim);
                    CAPTURE(degrees);
                    CAPTURE(depth);
                    const Room room(dim, alternate);
                    double worst = 0;
                    const int nPlaces = dim == 2 ? 40 : 6;
                    for (int k = 0; k < nPlaces; ++k)
                    {
                        Solid box = looseBox(Vec3::Zero(), Vec3(0.5, 0.3, dim == 2 ? 1 : 0.43));
                        const double angle = degrees*M_PI/180;
                        box.pose.orientation = Eigen::AngleAxisd(angle, Vec3::UnitZ());
                        box.pose.position = Vec3(0.5 + h*(k + 0.37)/nPlaces, 0.25*std::sin(angle) + 0.15*std::cos(angle) - depth*h, 0.513);
                        worst = std::max(worst, closure(room, room.cut(box)).norm());
                    }
                    CHECK(worst < 1e-8);
                }
}

TEST_CASE("what an edge that comes down to the floor loses grows with its way, without a jump")
{
    const Room room(2, true);
    constexpr double angle = 0.8;
    for (const double x : {0.5, 0.52, 0.57})
    {
        double before = -1;
        for (double height = 0.3*h; height > -0.3*h; height -= 0.002*h)
        {
            Solid box = looseBox(Vec3::Zero(), Vec3(0.5, 0.3, 1));
            box.pose.orientation = Eigen::AngleAxisd(angle, Vec3::UnitZ());
            box.pose.position = Vec3(x, height + 0.25*std::sin(angle) + 0.15*std::cos(angle), 0.5);
            const double volume = room.cut(box).solidVolume[0];
            if (before >= 0) CHECK(std::abs(volume - before) < 0.012*h*h);    // 0.0084; lifted all at once 0.093
            before = volume;
        }
    }
}
