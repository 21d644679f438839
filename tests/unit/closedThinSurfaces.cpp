// SPDX-License-Identifier: GPL-3.0-or-later
/// Surfaces without holes and exact volumes of solids thinner than an element.
#include "support/near.hpp"
#include "support/polyhedra.hpp"
#include "support/surfaceHoles.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

using namespace flotsam;

TEST_CASE("bodies thinner than an element that touch cut out their volumes, and surfaces are closed")
{
    double largest[2] = {}, missing = 0;
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 24 : 12;
        const double h = 2.0 / n;
        const CoverScene scene(dim, n);
        for (const double thickness : {0.3, 0.7, 1.2})
        {
            CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
            const double d = thickness * h;
            const auto log = dim == 2 ? makeCylinder({0, 0, -0.5}, {0, 0, 0.5}, 0.5 * d) : makeCylinder({-0.3, 0, 0}, {0.3, 0, 0}, 0.5 * d);
            const auto plank = dim == 2 ? makeBox(Vec3::Zero(), {0.4, d, 1}) : makeBox(Vec3::Zero(), {0.5, d, 0.3});
            for (int k = 0; k < 10; ++k)
            {
                // three logs side by side, a plank below them; what is wider than an element beside; overlaps and gaps
                const double by = 0.002 * h * (k % 5 - 2);
                const Vec3 along = dim == 2 ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
                const Vec3 middle(0.05 + 0.017 * k, 0.03 - 0.013 * k, 0.02);
                std::vector<Solid> solids;
                for (int j = -1; j <= 1; ++j) solids.push_back(makeSolid(log, middle + j * (d + by) * along, Solid::Kind::Free));
                solids.push_back(makeSolid(plank, middle - Vec3(0, d + by, 0), Solid::Kind::Free));
                const bool hasOthers = k >= 5;
                if (hasOthers && k % 2) solids.push_back(makeSolid(makeBox(Vec3::Zero(), {0.5, 0.5, 0.5}), middle + (1.5 * d + 0.25 + by) * along, Solid::Kind::Fixed));
                else if (hasOthers) solids.push_back(makeSolid(makeSphere(Vec3::Zero(), 0.3), middle + (0.5 * d + 0.3 + by) * Vec3::UnitY(), Solid::Kind::Free));
                for (Solid& solid : solids) solid.pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.01 * k, Vec3::UnitZ()));
                const Cover& cover = builder.buildExactVolume(solids);
                largest[hasOthers] = std::max(largest[hasOthers], largestHole(scene, cover, h));
                for (int s = 0; s < 4; ++s)
                {
                    const double volume = builder.exactVolume(solids[s]);
                    missing = std::max(missing, closureError(scene, cover, s, volume) / volume);
                }
            }
        }
    }
    std::printf("thin bodies: holes of %.1e alone, %.1e beside others, volumes to %.1e\n", largest[0], largest[1], missing);
    CHECK(largest[0] < 1e-12);
    CHECK(largest[1] < 1e-12);
    CHECK(missing < 1e-10);
}

// What they cover is nothing then, and costs nothing.
TEST_CASE("bodies thinner than an element, several in one, cover something of each other only where they touch")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 24 : 12;
        const double h = 2.0 / n, d = 0.4 * h;
        const CoverScene scene(dim, n);
        CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
        const auto log = dim == 2 ? makeCylinder({0, 0, -0.5}, {0, 0, 0.5}, 0.5 * d) : makeCylinder({-0.3, 0, 0}, {0.3, 0, 0}, 0.5 * d);
        const auto plank = dim == 2 ? makeBox(Vec3::Zero(), {d, d, 1}) : makeBox(Vec3::Zero(), {0.6, d, d});
        for (const auto& shape : {log, plank})
            for (const double gap : {0.3, 1e-3, 1e-6, -1e-6, -1e-3, -0.1})  // of the thickness
            {
                const bool isRound = shape == log;
                const double by = isRound ? 0.1 * (gap > 0 ? 1 : -1) + gap : gap;   // the planes it is cut by reach beyond it, or less far
                std::vector<Solid> solids;
                for (int j = 0; j < 3; ++j) solids.push_back(makeSolid(shape, {0.017, 0.03 + (j - 1) * d * (1 + by), 0.02}, Solid::Kind::Free));
                for (Solid& solid : solids) solid.pose.orientation = Eigen::Quaterniond::Identity();
                const Cover& cover = builder.buildExactVolume(solids);
                CAPTURE(dim);
                CAPTURE(isRound);
                CAPTURE(gap);
                CHECK(scene.halo.any(cover.areSolidsClose));
                CHECK(scene.halo.any(!cover.coveredFacets.empty()) == (gap < 0));
                CHECK(scene.halo.any(!cover.coveredVolumes.empty()) == (gap < 0));
                CHECK(largestHole(scene, cover, h) < (gap == -1e-6 ? 1e-7 : 1e-12));    // of so thin an overlap pieces are negligible
                const double volume = builder.exactVolume(solids[0]);
                for (int s = 0; s < 3; ++s) CHECK(closureError(scene, cover, s, volume) < 1e-11 * volume);
                if (gap > 0) CHECK(cover.solidVolume[0] + cover.solidVolume[1] + cover.solidVolume[2] == near(3 * volume, 1e-11));
            }
    }
}

namespace
{

/// Bodies of 0.25 to 0.25 + 2 `more` elements at random places and attitudes, close to each other or into each other, every fifth heap with a structure.
std::vector<Solid> heap(int dim, double h, int number, double more)
{
    std::mt19937 generator(1000 * dim + number);
    std::uniform_real_distribution<double> signedUnit(-1, 1);
    const auto random = [&] { return signedUnit(generator); };
    const int nBodies = 2 + number % 9;
    const Vec3 plane(1, 1, dim == 2 ? 0 : 1);
    const Vec3 middle = 0.4 * plane.cwiseProduct(Vec3(random(), random(), random()));
    std::vector<Solid> solids;
    for (int b = 0; b < nBodies; ++b)
    {
        const double d = h * (0.25 + more * (1 + random())), length = h * (2 + 2 * random()) + d, kind = random();
        std::shared_ptr<const Shape> shape;
        if (dim == 2) shape = kind < 0 ? makeCylinder({0, 0, -2}, {0, 0, 2}, 0.5 * d) : makeBox(Vec3::Zero(), {length, d, 4});
        else if (kind < -0.6) shape = makeSphere(Vec3::Zero(), 0.5 * d);
        else if (kind < -0.2) shape = makeCylinder({-0.5 * length, 0, 0}, {0.5 * length, 0, 0}, 0.5 * d);
        else if (kind < 0.2) shape = makeCapsule({-0.5 * length, 0, 0}, {0.5 * length, 0, 0}, 0.5 * d);
        else shape = makeBox(Vec3::Zero(), {length, d, kind < 0.6 ? d : length});
        const Vec3 place = middle + h * std::sqrt(nBodies) * plane.cwiseProduct(Vec3(random(), random(), random()));
        solids.push_back(makeSolid(shape, place, number % 5 == 4 && b == 0 ? Solid::Kind::Fixed : Solid::Kind::Free));
        const Vec3 axis = dim == 2 ? Vec3::UnitZ() : Vec3(random(), random(), 2 + random()).normalized();
        solids.back().pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(number % 4 == 0 ? 0 : random(), axis));
    }
    return solids;
}

struct Holes { int heaps = 0; double largest = 0; };

Holes holesOfHeaps(int dim, double more, int nHeaps)
{
    const int n = dim == 2 ? 24 : 12;
    const double h = 2.0 / n;
    const CoverScene scene(dim, n);
    CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
    Holes holes;
    for (int k = 0; k < nHeaps; ++k)
    {
        std::vector<Solid> solids = heap(dim, h, k, more);
        const double hole = largestHole(scene, builder.buildExactVolume(solids), h);
        holes.heaps += hole > 1e-9;
        holes.largest = std::max(holes.largest, hole);
    }
    std::printf("%dD: bodies of 0.25 to %g elements: %d of %d heaps with holes, at most %.1e\n", dim, 0.25 + 2 * more, holes.heaps, nHeaps, holes.largest);
    return holes;
}

} // namespace

TEST_CASE("random heaps of bodies thinner than an element and a half have closed surfaces")
{
    for (const int dim : {2, 3}) CHECK(holesOfHeaps(dim, 0.5, 60).largest < 1e-9);
}

// The limit of docs/numerics, 3.3: two thick bodies and a thin one in one element.
TEST_CASE("random heaps of thin and thick bodies" * doctest::skip())
{
    for (const int dim : {2, 3}) holesOfHeaps(dim, 0.95, 1000);
}

// Thin bodies hide a thick one from the nodes: it has parts in elements none of whose nodes is nearest to it.
TEST_CASE("a body of several elements among thin ones has a closed surface")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 24 : 12;
        const double h = 2.0 / n, size = 2.6 * h;
        const CoverScene scene(dim, n);
        CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
        for (int k = 0; k < 12; ++k)
        {
            const double thickness = 0.2 * h, by = 0.5 * (size + thickness) + 0.05 * h * (k % 3 - 0.5);     // overlaps and gaps
            const Vec3 middle(0.013 * k, 0.02 - 0.007 * k, 0.01 * k);
            const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.13 * k, dim == 2 ? Vec3::UnitZ() : Vec3(1, 2, 3).normalized()));
            std::vector<Solid> solids = {makeSolid(makeBox(Vec3::Zero(), {size, size, dim == 2 ? 4 : size}), middle, Solid::Kind::Free)};
            for (int side = -1; side <= 1; side += 2)
                for (int j = -1; j <= 1; ++j)
                {
                    const auto bar = makeBox(Vec3::Zero(), {thickness, thickness, dim == 2 ? 4 : 2 * size});
                    solids.push_back(makeSolid(bar, middle + turn * Vec3(side * by, 0.3 * size * j, 0), Solid::Kind::Free));
                }
            for (Solid& solid : solids) solid.pose.orientation = turn;
            const Cover& cover = builder.buildExactVolume(solids);
            for (std::size_t s = 0; s < solids.size(); ++s)
            {
                double covered;
                const Eigen::Matrix<double, 4, 3> moments = surfaceMoments(scene, cover, static_cast<int>(s), covered);
                for (int d = 0; d < dim; ++d) CHECK(moments(0, d) == within(0, 1e-12 * std::pow(h, dim - 1)));
            }
        }
    }
}

TEST_CASE("round bodies and polyhedra thinner than an element have their volume and centre, whatever frame they are given in")
{
    const CoverScene scene(3, 12);
    CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
    const double r = 0.3 * 2 / 12;
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
    TriSurface plank = makeBox(Vec3::Zero(), {1.2 * r, 0.4, 0.3})->surface(1);  // thin by its faces only: its bounds are not
    for (Vec3& x : plank.points) x = turned * x;
    for (const auto& shape : {makeClosedSurface(plank), makeSphere(Vec3::Zero(), r), makeCapsule({-0.2, 0, 0}, {0.2, 0, 0}, r), makeCylinder({0, -0.2, 0}, {0, 0.2, 0}, r),
             makePlaced(makeCylinder({0.1, 0, -0.2}, {0.1, 0, 0.2}, r), turned, -(turned * Vec3(0.1, 0, 0)))})
    {
        std::vector<Solid> solids = {makeSolid(shape, {0.03, -0.02, 0.04}, Solid::Kind::Free)};
        const Cover& cover = builder.buildExactVolume(solids);
        CHECK(solids[0].isThin);
        const double volume = shape->moments().volume;
        CHECK(closureError(scene, cover, 0, volume) < 1e-12 * volume / r);
        CHECK(cover.solidVolume[0] == near(volume, 1e-12));
    }
}

// Bars of a rack from bed to lid, upright and inclined; logs of half an element and bodies of several elements against them.
TEST_CASE("structures thinner than an element are cut as bodies are, also where they reach through the mesh")
{
    double largest = 0;
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 24 : 12;
        const double h = 2.0 / n;
        const CoverScene scene(dim, n);
        for (const double thickness : {0.3, 0.7, 1.2})
            for (int k = 0; k < 8; ++k)
            {
                CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
                const double d = thickness * h, by = 0.002 * h * (k % 2 ? 1 : -1), reach = dim == 2 ? 0.5 : 1.5;
                const bool isRound = k % 2 == 0, isUpright = dim == 2 || k < 6;
                const auto bar = isRound ? makeCylinder({0, 0, -reach}, {0, 0, reach}, 0.5 * d) : makeBox(Vec3::Zero(), {d, 0.8 * d, 2 * reach});
                std::vector<Solid> solids;
                for (int j = 0; j < 2; ++j) solids.push_back(makeSolid(bar, {0.05 + 0.017 * k, 0.03 - 0.013 * k + 3.3 * h * j, 0}, Solid::Kind::Fixed));
                if (!isUpright) for (Solid& solid : solids) solid.pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Vec3::UnitY()));
                if (k > 1) solids.push_back(makeSolid(makeCylinder({0, 0, -0.4}, {0, 0, 0.4}, 0.25 * h), solids[0].pose.position - Vec3(0.5 * d + 0.25 * h + by, 0, 0), Solid::Kind::Free));
                // its edges away from the bars: docs/numerics, 3.3, Limits
                const Vec3 beside = 0.5 * (solids[0].pose.position + solids[1].pose.position) - Vec3(0.5 * d + by, 0, 0);
                if (k > 2 && dim == 2) solids.push_back(makeSolid(makeBox(Vec3::Zero(), {0.5, 6.3 * h, 1}), beside - Vec3(0.25, 0, 0), Solid::Kind::Free));
                if (k > 2 && dim == 3) solids.push_back(makeSolid(makeSphere(Vec3::Zero(), 0.4), beside - Vec3(0.2, 0, 0), Solid::Kind::Free));
                for (std::size_t s = 2; s < solids.size(); ++s) solids[s].pose.orientation = solids[0].pose.orientation;
                const Cover& cover = builder.buildExactVolume(solids);
                largest = std::max(largest, largestHole(scene, cover, h));
                const double area = isRound ? M_PI * 0.25 * d * d : 0.8 * d * d;
                for (int s = 0; s < 2; ++s)
                {
                    CHECK(solids[s].isThin);
                    if (isUpright && k < 2) CHECK(cover.solidVolume[s] == near(area * (dim == 2 ? 1 : 2), 1e-10));
                }
                // the same beside what has moved meanwhile, but for what is moved by its volume
                const std::vector<double> volumes = cover.solidVolume;
                std::vector<Solid> moved = solids;
                for (Solid& solid : moved) solid.pose.position.x() += solid.kind == Solid::Kind::Free ? -0.01 : 0;
                largest = std::max(largest, largestHole(scene, builder.buildExactVolume(moved), h));
                const Cover& again = builder.buildExactVolume(solids);
                for (std::size_t s = 0; s < volumes.size() && (k < 3 || dim == 2); ++s) CHECK(again.solidVolume[s] == volumes[s]);
            }
    }
    std::printf("thin structures: holes of %.1e\n", largest);
    CHECK(largest < 1e-9);
}
