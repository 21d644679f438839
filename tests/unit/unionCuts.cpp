// SPDX-License-Identifier: GPL-3.0-or-later
/// Unions are cut part by part: edges and re-entrant corners stay sharp, parts may be thinner than an element.
#include "support/near.hpp"
#include "support/polyhedra.hpp"
#include "support/surfaceHoles.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace flotsam;

namespace
{

using Shapes = std::vector<std::shared_ptr<const Shape>>;

/// A stem of square section with a bar across its end, which share a cube: as long as the stem together; volume and surface (2D: section and outline).
struct Hammer
{
    std::shared_ptr<const Shape> shape;
    double volume, area;
};

Hammer makeHammer(int dim, double thickness, double length, double bar)
{
    const double t = thickness, z = dim == 2 ? 3 : t; // 2D: through the mesh
    const Shapes parts = {makeBox({0, 0.5 * length, 0}, {t, length, z}), makeBox({0, length - 0.5 * t, 0}, {bar, t, z})};
    const double section = t * length + t * (bar - t), outline = 2 * (length + bar);
    return {makeUnion(parts), dim == 2 ? section : section * t, dim == 2 ? outline : 2 * section + outline * t};
}

Eigen::Quaterniond turned(int dim, int k)
{
    const Eigen::AngleAxisd inPlane(0.37 * k, Vec3::UnitZ());
    return dim == 2 ? Eigen::Quaterniond(inPlane) : Eigen::Quaterniond(inPlane * Eigen::AngleAxisd(0.23 * k, Vec3::UnitX()));
}

} // namespace

TEST_CASE("a union of boxes has its exact volume and surface, which is closed, in any place")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 20 : 10;
        CoverScene scene(dim, n);
        CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
        for (const double elements : {0.4, 1.0, 1.55, 2.5})
            for (int k = 0; k < 10; ++k)
            {
                const Hammer hammer = makeHammer(dim, elements * 2 / n, 0.9, 0.75);
                std::vector<Solid> solids = {makeSolid(makePlaced(hammer.shape, Eigen::Quaterniond::Identity(), {0, -0.5, 0}), {0.01 * k, 0.013 * k, 0.02}, k % 2 ? Solid::Kind::Free : Solid::Kind::Fixed)};
                solids[0].pose.orientation = turned(dim, k);
                CAPTURE(elements);
                CAPTURE(k);
                const Cover& cover = builder.buildExactVolume(solids);
                CHECK(solids[0].offset == 0);
                CHECK(cover.solidVolume[0] == near(hammer.volume, 1e-11));
                CHECK(cover.solidArea[0] == near(hammer.area, 1e-11));
                CHECK(largestHole(scene, cover, 2.0 / n) < 1e-11);
            }
    }
}

TEST_CASE("a T-shaped pier on the bed keeps its edges up to the mesh's boundary, with a body beside it or far off")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 16 : 8;
        const double h = 2.0 / n, t = 2.1 * h;
        CoverScene scene(dim, n);
        CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
        for (const Solid::Kind kind : {Solid::Kind::Fixed, Solid::Kind::Prescribed})
            for (int k = 0; k < 12; ++k)
            {
                const double length = 1.2 + 0.02 * k, below = 0.3;  // of the stem, below the bed y = -1
                const Hammer pier = makeHammer(dim, t, length, 0.9);
                std::vector<Solid> solids = {makeSolid(pier.shape, {-0.1 + 0.017 * k, -1 - below, 0.03}, kind),
                    makeSolid(makeBox(Vec3::Zero(), {0.3, 0.25, 0.4}), k % 2 ? Vec3(-0.7, 0.7, 0) : Vec3(-0.1 + 0.017 * k + 0.5 * t + 0.16, -0.6, 0), Solid::Kind::Free)};
                for (Solid& solid : solids) solid.pose.orientation.setIdentity();
                CAPTURE(k);
                const Cover& cover = builder.buildExactVolume(solids);
                CHECK((dim == 2 ? largestHoleWithBoundary<2>(scene, cover, h) : largestHoleWithBoundary<3>(scene, cover, h)) < 1e-9);  // what slivers leave: 2.6e-10 at most
                if (k % 2) CHECK(cover.solidVolume[0] == near(pier.volume - below * t * (dim == 2 ? 1 : t), 1e-11));
            }
    }
}

TEST_CASE("a film of fluid goes on all around a loose union that lies on a wall with one of its parts or two")
{
    for (const int dim : {2, 3})
    {
        const int n = 10;
        const double h = 2.0 / n;
        CoverScene scene(dim, std::array{2 * n, n, n});
        for (MeshPatch& patch : scene.mesh.patches) patch.type = "wall";
        CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
        for (const double elements : {0.4, 1.3, 2.2})
            for (int k = 0; k < 12; ++k)
            {
                const double t = elements * h, length = 0.8;
                std::vector<Solid> solids = {makeSolid(makeHammer(dim, t, length, 0.7).shape, {-0.3 + 0.017 * k, -1 - 1e-6, 0.03 * (k % 4)}, Solid::Kind::Free)};
                solids[0].isLoose = true;
                solids[0].pose.orientation = Eigen::AngleAxisd(k % 3 ? 0 : M_PI, Vec3::UnitZ());    // upright, on its bar
                if (k % 3 == 0) solids[0].pose.position.y() += length;
                const Cover& cover = builder.buildExactVolume(solids);
                Vec3 sum = Vec3::Zero();
                for (const CutFacet& f : cover.facets)
                    for (int d = 0; d < dim && scene.mesh.isOwnedElement[f.element]; ++d) sum[d] += f.area * f.normal[d];
                scene.halo.sum(sum.data(), 3);
                CHECK(sum.norm() < 1e-9 * std::pow(h, dim - 1));
                CHECK(!cover.filmNodes.empty());
            }
    }
}

TEST_CASE("a fork's prongs are two, however narrow the gap between them")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 20 : 10;
        const double h = 2.0 / n, t = 1.6 * h, gap = 0.3 * h, z = dim == 2 ? 3 : t;
        CoverScene scene(dim, n);
        CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
        const Shapes parts = {makeBox({0, 0.5 * (t - 1), 0}, {2 * t + gap, t, z}), makeBox({0.5 * (gap + t), 0, 0}, {t, 1, z}), makeBox({-0.5 * (gap + t), 0, 0}, {t, 1, z})};
        const double section = 2 * t + gap * t;
        for (int k = 0; k < 10; ++k)
        {
            std::vector<Solid> solids = {makeSolid(makeUnion(parts), {0.01 * k, 0.013 * k, 0.02}, Solid::Kind::Free)};
            solids[0].pose.orientation = turned(dim, k);
            const Cover& cover = builder.buildExactVolume(solids);
            CHECK(cover.solidVolume[0] == near(dim == 2 ? section : section * t, 1e-11));
            CHECK(largestHole(scene, cover, h) < 1e-11);
        }
    }
}

namespace
{

/// What a tree's cut has of its volume, less 1, and how far its centre is from the exact one, over the element length: a trunk with two branches and a root plate.
struct TreeErrors { double volume, centre; };

TreeErrors treeErrors(double trunk, int place)
{
    const int n = 14;
    const double h = 2.0 / n, r = 0.5 * trunk * h;
    static CoverScene scene(3, n);
    CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
    const Shapes parts = {makeCylinder({-0.6, 0, 0}, {0.6, 0, 0}, r), makeCylinder({0.2, 0, 0}, {0.5, 0.4, 0.1}, 0.7 * r), makeCapsule({0, 0, 0}, {0.1, -0.4, 0.2}, 0.7 * r),
        makeCylinder({-0.6, 0, 0}, {-0.6 + 1.5 * r, 0, 0}, 2.5 * r)};
    const auto tree = makeUnion(parts);
    const VolumeMoments exact = tree->moments();
    std::vector<Solid> solids = {makeSolid(makePlaced(tree, Eigen::Quaterniond::Identity(), -exact.centroid), 0.5 * h * Vec3(0.31 * place, 0.47 * place, 0.13 * place), Solid::Kind::Free)};
    solids[0].pose.orientation = turned(3, place);
    for (int pass = 0; pass < 3; ++pass) builder.buildExactVolume(solids);
    const Cover& cover = builder.cover();
    Vec3 first = Vec3::Zero();  // int x over the surface, by its normal: 3 of the volume's
    for (const CutElement& cut : cover.cuts)
        if (scene.mesh.isOwnedElement[cut.element])
            for (int a = 0; a <= 3; ++a)
            {
                const auto x = scene.mesh.spacePoint(scene.mesh.elements[std::size_t(cut.element) * 4 + a]);
                first += (scene.mesh.volume[cut.element] / 4 - cut.first[a]) * Vec3(x[0], x[1], x[2]);
            }
    for (int e = 0; e < scene.mesh.nElements; ++e)
        if (scene.mesh.isOwnedElement[e] && cover.state[e] == ElementState::Solid)
            for (int a = 0; a <= 3; ++a)
            {
                const auto x = scene.mesh.spacePoint(scene.mesh.elements[std::size_t(e) * 4 + a]);
                first += scene.mesh.volume[e] / 4 * Vec3(x[0], x[1], x[2]);
            }
    scene.halo.sum(first.data(), 3);
    CHECK(largestHole(scene, cover, h) < 1e-10);
    return {cover.solidVolume[0] / exact.volume - 1, (first / cover.solidVolume[0] - solids[0].pose.position).norm() / h};
}

} // namespace

namespace
{

struct Polyhedron { const char* name; std::shared_ptr<const Shape> shape; double volume; };

/// Triangulated surfaces, not convex: extruded sections and an open box.
std::vector<Polyhedron> makePolyhedra()
{
    const double z = 0.7;
    const auto joined = [](std::vector<TriSurface> parts)
    {
        TriSurface all;
        for (const TriSurface& part : parts)
        {
            const int first = static_cast<int>(all.points.size());
            all.points.insert(all.points.end(), part.points.begin(), part.points.end());
            for (const auto& t : part.triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        }
        return all;
    };
    const auto cavity = [](TriSurface s)
    {
        for (auto& t : s.triangles) std::swap(t[0], t[1]);
        return s;
    };
    const TriSurface box = makeBox({0, 0, 0}, {0.9, 0.6, 0.7})->surface(1);
    return {{"angle", makeClosedSurface(extruded({{-0.4, -0.4}, {0.4, -0.4}, {0.4, -0.22}, {-0.2, -0.22}, {-0.2, 0.4}, {-0.4, 0.4}}, z)), (0.8 * 0.18 + 0.62 * 0.2) * z},
        {"channel", makeClosedSurface(extruded({{-0.4, -0.3}, {0.4, -0.3}, {0.4, 0.4}, {0.15, 0.4}, {0.15, -0.1}, {-0.2, -0.1}, {-0.2, 0.4}, {-0.4, 0.4}}, z)), (0.8 * 0.2 + 0.25 * 0.5 + 0.2 * 0.5) * z},
        {"arrow", makeClosedSurface(extruded({{0, -0.45}, {0.4, 0.4}, {0, 0.1}, {-0.4, 0.4}}, z)), 0.5 * 0.8 * (0.85 - 0.3) * z},
        {"hollow box", makeClosedSurface(joined({box, cavity(makeBox({0.05, 0, 0}, {0.4, 0.2, 0.3})->surface(1))})), 0.9 * 0.6 * 0.7 - 0.4 * 0.2 * 0.3},
        {"boxes that touch", makeClosedSurface(joined({makeBox({-0.2, 0, 0}, {0.4, 0.6, 0.5})->surface(1), makeBox({0.15, 0.1, 0}, {0.3, 0.25, 0.3})->surface(1)})), 0.4 * 0.6 * 0.5 + 0.3 * 0.25 * 0.3}};
}

} // namespace

TEST_CASE("polyhedra from STL files that are not convex have their exact volume, and closed surfaces")
{
    const int n = 10;
    CoverScene scene(3, n);
    CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
    for (const Polyhedron& polyhedron : makePolyhedra())
    {
        CAPTURE(polyhedron.name);
        CHECK(polyhedron.shape->nParts() > 1);
        for (int k = 0; k < 10; ++k)
        {
            std::vector<Solid> solids = {makeSolid(polyhedron.shape, {0.01 * k, 0.013 * k, 0.02}, k % 2 ? Solid::Kind::Free : Solid::Kind::Fixed)};
            solids[0].pose.orientation = turned(3, k);
            const Cover& cover = builder.buildExactVolume(solids);
            CHECK(cover.solidVolume[0] == near(polyhedron.volume, 1e-10));
            CHECK(largestHole(scene, cover, 2.0 / n) < 1e-9);
        }
    }
}

namespace
{

/// From a file with coordinates of so many digits, which lie in no planes: steps of 60 by 80 mm, turned in space.
TriSurface staircase(int nSteps, int nDigits)
{
    std::vector<std::array<double, 2>> section = {{-0.6, -0.5}, {-0.6 + 0.08 * nSteps, -0.5}};
    for (int i = nSteps; i > 0; --i)
    {
        section.push_back({-0.6 + 0.08 * i, -0.5 + 0.06 * (nSteps + 1 - i)});
        section.push_back({-0.6 + 0.08 * (i - 1), -0.5 + 0.06 * (nSteps + 1 - i)});
    }
    TriSurface steps = extruded(section, 0.7);
    for (Vec3& x : steps.points)
    {
        x = Eigen::AngleAxisd(0.7, Vec3(0.3, 0.5, 0.9).normalized()) * x;
        for (double& coordinate : x)
        {
            const double last = std::pow(10, std::floor(std::log10(std::abs(coordinate))) + 1 - nDigits);
            coordinate = std::round(coordinate / last) * last;
        }
    }
    return steps;
}

} // namespace

TEST_CASE("parts of a polyhedron from a file of few digits meet in one plane: no slits between them, no holes")
{
    const int n = 10;
    CoverScene scene(3, n);
    CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
    for (const int nDigits : {5, 6, 7})
    {
        const auto shape = makeClosedSurface(staircase(15, nDigits));
        CAPTURE(nDigits);
        REQUIRE(shape->nParts() == 15);
        for (int k = 0; k < 6; ++k)
        {
            std::vector<Solid> solids = {makeSolid(shape, {0.01 * k, 0.013 * k, 0.02}, k % 2 ? Solid::Kind::Free : Solid::Kind::Fixed)};
            solids[0].pose.orientation = turned(3, k);
            const Cover& cover = builder.buildExactVolume(solids);
            CHECK(cover.solidVolume[0] == near(shape->moments().volume, 1e-5));
            CHECK(largestHole(scene, cover, 2.0 / n) < 1e-12);
        }
    }
}

TEST_CASE("parts that meet to round-off leave no holes: beside each other, and lapped with sides in one plane, shifted or turned by little")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 20 : 10;
        CoverScene scene(dim, n);
        CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
        const Vec3 size(0.4, 0.6, dim == 2 ? 3 : 0.5), axis = dim == 2 ? Vec3(0, 0, 1) : Vec3(0.3, 0.5, 0.8).normalized();
        double worst = 0;
        for (const double little : {1e-5, 1e-8, 1e-10, 1e-12, 1e-13, 1e-14, 1e-16})
        {
            const Eigen::Quaterniond byLittle(Eigen::AngleAxisd(little, axis));
            for (const auto& second : Shapes{makeBox({0.2 + little, 0, 0}, size), makePlaced(makeBox({0.2, 0, 0}, size), byLittle, Vec3::Zero()), makePlaced(makeBox({-0.1, 0, 0}, size), byLittle, Vec3::Zero())})
                for (int k = 0; k < 10; ++k)
                {
                    std::vector<Solid> solids = {makeSolid(makeUnion({makeBox({-0.2, 0, 0}, size), second}), {0.01 * k, 0.013 * k, 0.02}, Solid::Kind::Free)};
                    solids[0].pose.orientation = turned(dim, k);
                    worst = std::max(worst, largestHole(scene, builder.buildExactVolume(solids), 2.0 / n));
                }
        }
        std::printf("parts that meet to round-off, %dD: holes of %.0e faces\n", dim, worst);
        CHECK(worst < 1e-6);
    }
}

TEST_CASE("offsets of a union with round parts open no slits between plane parts that lie on each other")
{
    const int n = 16;
    const double h = 2.0 / n;
    CoverScene scene(3, n);
    const Vec3 size(0.4, 0.5, 0.5);
    const Shapes parts = {makeBox({-0.2, 0, 0}, size), makeBox({0.2, 0, 0}, size), makeCylinder({0.3, 0, 0}, {0.3, 0.5, 0.1}, 0.4 * h)};
    for (const bool isLarger : {true, false})
    {
        std::vector<Solid> solids = {makeSolid(makeUnion(parts), {0.01, 0.013, 0.02}, Solid::Kind::Prescribed)};
        solids[0].offset = isLarger ? 1e-4 * h : -1e-4 * h;     // stays
        CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
        const Cover& cover = builder.build(solids);
        int nCutInside = 0;
        for (const CutElement& cut : cover.cuts)
        {
            const int* nodes = &scene.mesh.elements[std::size_t(cut.element) * 4];
            nCutInside += std::all_of(nodes, nodes + 4, [&](int i) { return cover.distance[i] < 0; });
        }
        CHECK(scene.halo.sum(double(nCutInside)) == 0);
        CHECK(largestHole(scene, cover, h) < 1e-9);
    }
}

TEST_CASE("a union of one part is that part, also placed")
{
    const auto box = makeBox(Vec3::Zero(), {0.8, 0.6, 0.7});
    CHECK(makePlaced(makeUnion({box}), Eigen::Quaterniond::Identity(), Vec3(0.1, 0, 0))->hasPlaneFaces());
    CHECK(makeUnion({makeUnion({box})}) == box);
}

TEST_CASE("a tree with branches and a root plate has its volume and centre, also thinner than an element")
{
    for (const double trunk : {0.5, 1.0, 1.4, 2.2, 3.0})
    {
        TreeErrors worst{0, 0};
        for (int place = 0; place < 8; ++place)
        {
            const TreeErrors errors = treeErrors(trunk, place);
            worst = {std::max(worst.volume, std::abs(errors.volume)), std::max(worst.centre, errors.centre)};
        }
        std::printf("tree with a trunk of %.1f elements: volume %.1e, centre %.1e elements\n", trunk, worst.volume, worst.centre);
        CHECK(worst.volume < 1e-3);
        CHECK(worst.centre < 0.01);
    }
}
