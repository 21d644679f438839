// SPDX-License-Identifier: GPL-3.0-or-later
/// constant/bodies: `variation`, members of different sizes and densities.
#include "demCoupling/core/distribution.hpp"
#include "demCoupling/foam/bodyPlacement.hpp"
#include "support/bodiesScene.H"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace flotsam;

namespace
{

const std::string log_ = "shape { type cylinder; end1 (0 0 -0.05); end2 (0 0 0.15); radius 0.01; } ";
const std::string lengths = "length { type logNormal; mean 0.2; deviation 0.08; minValue 0.08; maxValue 0.35; } ";
const std::string diameters = "diameter { type uniform; minValue 0.01; maxValue 0.03; } ";
const std::string densities = "density { type normal; mean 600; deviation 100; minValue 400; maxValue 900; } ";

std::string randomPlaces(int count) { return "random { count " + std::to_string(count) + "; box ((0.05 0.02 0.02) (1.95 0.98 0.38)); orientation random; } "; }

std::string varied(const std::string& variation, const std::string& rest) { return bodies(rest + "variation { " + variation + "} "); }

struct LogSize { double length, radius, density; };

/// Of cylinders along z of their shape.
std::vector<LogSize> logs(const BodiesInput& input)
{
    std::vector<LogSize> all;
    for (const BodyDefinition& body : input.bodies)
    {
        const auto [lower, upper] = body.shape->bounds();
        all.push_back({upper[2] - lower[2], 0.5*(upper[0] - lower[0]), body.mass/body.volume});
    }
    return all;
}

} // namespace

TEST_CASE("distributions: mean and deviation, bounds, half of the values below the median")
{
    for (const auto kind : {Distribution::Kind::Normal, Distribution::Kind::LogNormal})
    {
        const Distribution wide{kind, 1e-3, 20, 2, 0.5, {}};
        double sum = 0, squares = 0;
        constexpr int n = 20000;
        for (int i = 0; i < n; ++i)
        {
            const double x = wide.quantile((i + 0.5)/n);
            sum += x/n;
            squares += x*x/n;
        }
        CHECK(sum == near(2, 1e-4));
        CHECK(std::sqrt(squares - sum*sum) == near(0.5, 2e-3));
        const Distribution narrow{kind, 1.9, 2.6, 2, 0.5, {}};
        CHECK(narrow.quantile(0) == near(1.9, 1e-12));
        CHECK(narrow.quantile(1 - 1e-16) == near(2.6, 1e-6));
        const double median = narrow.quantile(0.5);
        CHECK(narrow.below(median) - narrow.below(1.9) == near(narrow.below(2.6) - narrow.below(median), 1e-10));
    }
    CHECK(Distribution{Distribution::Kind::Normal, 1, 3, 2, 0.5, {}}.below(2.5) == near(0.841344746, 1e-8));  // one deviation
    CHECK(Distribution{Distribution::Kind::Uniform, 1, 3, 0, 0, {}}.quantile(0.25) == near(1.5, 1e-14));
    const Distribution three{Distribution::Kind::Values, 0, 0, 0, 0, {5, 7, 6}};
    CHECK(three.quantile(0) == 5);
    CHECK(three.quantile(0.5) == 7);
    CHECK(three.quantile(1 - 1e-16) == 6);
}

TEST_CASE("lengths, diameters and densities are drawn, masses follow; all lie apart in the box")
{
    BodiesScene s;
    const BodiesInput input = s.read(varied(lengths + diameters + densities, log_ + randomPlaces(60)));
    const std::vector<LogSize> all = logs(input);
    REQUIRE(all.size() == 60);
    const Distribution length{Distribution::Kind::LogNormal, 0.08, 0.35, 0.2, 0.08, {}};
    const double below = length.below(0.08), within = length.below(0.35) - below;
    std::vector<double> shares[2];
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        const auto& [l, r, density] = all[i];
        const BodyDefinition& body = input.bodies[i];
        CHECK(l >= 0.08);
        CHECK(l <= 0.35);
        CHECK(density >= 400);
        CHECK(density <= 900);
        CHECK(body.volume == near(M_PI*r*r*l, 1e-12));
        CHECK(body.principalInertia[2] == near(0.5*body.mass*r*r, 1e-12));
        CHECK(body.thinnest == near(2*r, 1e-12));
        for (const SurfaceSphere& sphere : body.spheres) CHECK(body.shape->distance(sphere.centre) <= -sphere.radius + 1e-3*r);
        shares[0].push_back((length.below(l) - below)/within);
        shares[1].push_back((r - 0.005)/0.01);
    }
    for (auto& share : shares) // Kolmogorov: of 60 draws one in a million is off by more than 2.7/sqrt(60)
    {
        std::sort(share.begin(), share.end());
        for (std::size_t i = 0; i < share.size(); ++i) CHECK(std::abs(share[i] - (double(i) + 0.5)/60) < 2.7/std::sqrt(60));
    }
    std::vector<std::shared_ptr<const SampledShape>> sampled;
    for (const BodyDefinition& body : input.bodies) sampled.push_back(std::make_shared<SampledShape>(body.shape, 0.01));
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        const ShapeAtPose a{"", sampled[i], input.bodies[i].pose};
        CHECK(a.spaceBounds()[0][1] >= 0.02 - 1e-12);
        CHECK(a.spaceBounds()[1][1] <= 0.98 + 1e-12);
        for (std::size_t j = 0; j < i; ++j) CHECK(gap(a, {"", sampled[j], input.bodies[j].pose}, 0.01) >= -1e-4);
    }
}

TEST_CASE("each quantity has its own random numbers: the same members with more of them, or with another quantity")
{
    BodiesScene s;
    const auto read = [&](const std::string& variation, int count) { return logs(s.read(varied(variation, log_ + (variation.find("density") == std::string::npos ? "density 600; " : "") + randomPlaces(count)))); };
    const auto few = read(lengths, 5), more = read(lengths, 12), both = read(lengths + densities, 12), other = read("seed 2; " + lengths, 5);
    for (std::size_t i = 0; i < few.size(); ++i)
    {
        CHECK(few[i].length == more[i].length);
        CHECK(few[i].length == both[i].length);
        CHECK(few[i].length != other[i].length);
        CHECK(few[i].density == near(600, 1e-12));
        CHECK(few[i].radius == near(0.01, 1e-12));
    }
    CHECK(both[3].density != both[4].density);
}

TEST_CASE("arrays, lists of poses; boxes by their longest side, the others' sides stay")
{
    BodiesScene s;
    const std::string values = "length { type values; values (0.1 0.15); } ";
    for (const char* places : {"array { count (1 3 2); spacing (0 0.2 0.1); } position (0.5 0.2 0.1); ",
             "poses ( { position (0.3 0.2 0.1); } { position (0.6 0.2 0.1); } { position (0.9 0.2 0.1); } { position (1.2 0.2 0.1); } { position (1.5 0.2 0.1); } { position (1.8 0.2 0.1); } ); "})
    {
        const BodiesInput input = s.read(varied(values, bar + places));
        REQUIRE(input.bodies.size() == 6);
        int nShort = 0;
        for (const BodyDefinition& body : input.bodies)
        {
            const auto [lower, upper] = body.shape->bounds();
            nShort += upper[0] - lower[0] == near(0.1, 1e-12);
            CHECK((upper[0] - lower[0] == near(0.1, 1e-12) || upper[0] - lower[0] == near(0.15, 1e-12)));
            CHECK(upper[1] - lower[1] == near(0.02, 1e-12));
            CHECK(upper[2] - lower[2] == near(0.04, 1e-12));
        }
        CHECK(nShort > 0);
        CHECK(nShort < 6);
    }
}

TEST_CASE("scale: all lengths of any shape; after length")
{
    BodiesScene s;
    const std::string twice = "scale { type values; values (2); } ", place = "density 600; position (1 0.5 0.2); ";
    const std::string tree = "type union; parts { trunk { type cylinder; end1 (0 0 0); end2 (0.1 0 0); radius 0.01; } wad { type sphere; centre (0.1 0 0); radius 0.02; } block { type box; size (0.03 0.03 0.03); centre (0.02 0 0); } }";
    for (const std::string& shape : {tree, std::string("type box; size (0.1 0.05 0.04);"), std::string("type capsule; end1 (0 0 0); end2 (0.1 0 0); radius 0.02;")})
    {
        const BodiesInput one = s.read(bodies("shape { " + shape + " } " + place)), two = s.read(varied(twice, "shape { " + shape + " } " + place));
        const BodyDefinition &a = one.bodies[0], &b = two.bodies[0];
        CHECK(b.volume == near(8*a.volume, 1e-6));
        CHECK(b.principalInertia.maxCoeff() == near(32*a.principalInertia.maxCoeff(), 1e-4));
        CHECK((b.shape->bounds()[1] - 2*a.shape->bounds()[1]).norm() < 1e-4*b.thinnest);
    }
    const BodiesInput both = s.read(varied("length { type values; values (0.15); } " + twice, "shape { type cylinder; end1 (0 0 0); end2 (0.1 0 0); radius 0.02; } " + place));
    CHECK(both.bodies[0].volume == near(M_PI*0.04*0.04*0.3, 1e-10));
}

TEST_CASE("2D: diameters differ in the plane; what would leave the mesh's thickness is refused")
{
    BodiesScene s(false);
    const auto disc = [](const std::string& variation)
    { return varied(variation, "shape { type cylinder; end1 (0 0 0); end2 (0 0 0.1); radius 0.02; } density 600; array { count (3 1 1); spacing (0.3 0 0); } position (0.5 0.5 0); "); };
    const BodiesInput input = s.read(disc(diameters));
    REQUIRE(input.bodies.size() == 3);
    for (const BodyDefinition& body : input.bodies) CHECK(body.mass == near(600*0.1*M_PI*0.25*body.thinnest*body.thinnest, 1e-9));
    CHECK(input.bodies[0].thinnest != input.bodies[1].thinnest);
    for (const char* variation : {"scale { type values; values (2); } ", "length { type values; values (0.08); } "})
        CHECK(has(s.message(disc(variation)), "must reach through the mesh from front to back"));
}

TEST_CASE("what is wrong with a variation is said")
{
    BodiesScene s;
    const auto message = [&](const std::string& variation, const std::string& rest = log_ + "density 600; " + randomPlaces(3)) { return s.message(varied(variation, rest)); };
    CHECK(has(message("lenght { type uniform; minValue 1; maxValue 2; } "), "length"));
    CHECK(has(message("length { type uniform; minValue 0.3; maxValue 0.2; } "), "larger than minValue, 0.3"));
    CHECK(has(message("length { type gaussian; minValue 0.1; maxValue 0.2; } "), "uniform, normal, logNormal, values"));
    CHECK(has(message("length { type uniform; mean 0.1; minValue 0.1; maxValue 0.2; } "), "mean"));
    CHECK(has(message("length { type normal; mean 20; deviation 1; minValue 0.1; maxValue 0.2; } "), "lies between minValue 0.1 and maxValue 0.2"));
    CHECK(has(message("length { type values; values (); } "), "'values' is empty"));
    CHECK(has(message("length { type values; values (0.1 -1); } "), "-1"));
    CHECK(has(message(densities), "The group has a 'density', too"));
    CHECK(has(message(lengths, log_ + "mass 1; " + randomPlaces(3)), "give 'density', of which the masses follow"));
    CHECK(has(message(lengths, "shape { type sphere; radius 0.05; } density 600; " + randomPlaces(3)), "'length' may be given for shapes of type cylinder, capsule, box; here it is sphere"));
    CHECK(has(message(diameters, log_ + "density 600; spheres { radius 0.011; } " + randomPlaces(3)), "smallest extent"));
}

TEST_CASE("contact spheres: those given are of the shape given, members' in proportion to their thickness")
{
    BodiesScene s;
    const BodiesInput input = s.read(varied(diameters, log_ + "density 600; spheres { radius 0.01; spacing 0.008; } " + randomPlaces(8)));
    for (const BodyDefinition& body : input.bodies)
        for (const SurfaceSphere& sphere : body.spheres) CHECK(sphere.radius == near(0.5*body.thinnest, 1e-9));
}
