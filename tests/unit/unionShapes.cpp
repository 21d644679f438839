// SPDX-License-Identifier: GPL-3.0-or-later
/// Unions count what their parts share once: volumes, centroids, inertia, plane sections.
#include "geometry/triSurface.hpp"
#include "support/coverScene.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

using Shapes = std::vector<std::shared_ptr<const Shape>>;

constexpr double roundOff = 1e-12;
constexpr double accuracy = 1e-5;   // of round parts

std::shared_ptr<const Shape> boxFrom(const Vec3& lower, const Vec3& upper) { return makeBox(0.5 * (lower + upper), upper - lower); }

/// Boxes with nothing in common that are the union.
struct Joined
{
    const char* name;
    Shapes parts;
    Shapes apart;
};

std::vector<Joined> joinedBoxes()
{
    const auto plank = boxFrom({-0.2, -0.02, 0}, {0.2, 0.02, 0.05});
    std::vector<Joined> cases;
    for (const double lap : {1e-6, 0.002, 0.01, 0.039})
        cases.push_back({"planks lapped along a side", {boxFrom({-0.2, -0.02, 0}, {0.2, 0, 0.05}), boxFrom({-0.2, -lap, 0}, {0.2, 0.02, 0.05})},
                         {boxFrom({-0.2, std::min(-0.02, -lap), 0}, {0.2, 0.02, 0.05})}});
    cases.push_back({"planks lapped at their ends", {boxFrom({-0.2, -0.02, 0}, {0.05, 0.02, 0.05}), boxFrom({-0.05, -0.02, 0}, {0.2, 0.02, 0.05})}, {plank}});
    cases.push_back({"twice the same", {plank, plank}, {plank}});
    cases.push_back({"ten times the same", Shapes(10, plank), {plank}});
    cases.push_back({"one in the other", {plank, boxFrom({-0.1, -0.01, 0.01}, {0.1, 0.01, 0.02})}, {plank}});
    cases.push_back({"side by side", {boxFrom({-0.2, -0.02, 0}, {0.2, 0, 0.05}), boxFrom({-0.2, 0, 0}, {0.2, 0.02, 0.05})}, {plank}});
    cases.push_back({"T", {plank, boxFrom({-0.2, -0.1, 0}, {-0.15, 0.1, 0.05})},
                     {plank, boxFrom({-0.2, -0.1, 0}, {-0.15, -0.02, 0.05}), boxFrom({-0.2, 0.02, 0}, {-0.15, 0.1, 0.05})}});
    cases.push_back({"cross of three", {plank, boxFrom({-0.05, -0.1, 0.01}, {0.02, 0.1, 0.03}), boxFrom({-0.03, -0.01, -0.1}, {0.01, 0.01, 0.1})},
                     {plank, boxFrom({-0.05, -0.1, 0.01}, {0.02, -0.02, 0.03}), boxFrom({-0.05, 0.02, 0.01}, {0.02, 0.1, 0.03}),
                      boxFrom({-0.03, -0.01, -0.1}, {0.01, 0.01, 0}), boxFrom({-0.03, -0.01, 0.05}, {0.01, 0.01, 0.1})}});
    cases.push_back({"far apart", {boxFrom({-5, -0.1, 0}, {5, 0.1, 0.2}), boxFrom({-5, -1, 0}, {-4.99, 1, 0.2}), boxFrom({4.99, -1, 0}, {5, 1, 0.2})},
                     {boxFrom({-4.99, -0.1, 0}, {4.99, 0.1, 0.2}), boxFrom({-5, -1, 0}, {-4.99, 1, 0.2}), boxFrom({4.99, -1, 0}, {5, 1, 0.2})}});
    return cases;
}

/// Each part turned and moved, from inside the union.
Shapes placed(const Shapes& shapes, const Eigen::Quaterniond& q, const Vec3& translation)
{
    Shapes result;
    for (const auto& shape : shapes) result.push_back(makePlaced(shape, q, translation));
    return result;
}

VolumeMoments sumOf(const Shapes& apart)
{
    VolumeMoments sum;
    for (const auto& shape : apart)
    {
        const VolumeMoments m = shape->moments();
        sum.volume += m.volume;
        sum.centroid += m.volume * m.centroid;
    }
    sum.centroid /= sum.volume;
    for (const auto& shape : apart)
    {
        const VolumeMoments m = shape->moments();
        const Vec3 r = m.centroid - sum.centroid;
        sum.inertia += m.inertia + m.volume * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
    }
    return sum;
}

void checkMoments(const VolumeMoments& m, const VolumeMoments& exact, double tolerance)
{
    CHECK(m.volume == near(exact.volume, tolerance));
    CHECK((m.centroid - exact.centroid).norm() < tolerance * std::sqrt(exact.inertia.trace() / exact.volume));
    CHECK((m.inertia - exact.inertia).norm() < tolerance * exact.inertia.norm());
}

double capVolume(double r, double height) { return M_PI * height * height * (3 * r - height) / 3; }

/// About its axis: int pi/2 (r^2 - z^2)^2 dz.
double capInertia(double r, double height)
{
    const auto integral = [r](double z) { return std::pow(r, 4) * z - 2 * r * r * std::pow(z, 3) / 3 + std::pow(z, 5) / 5; };
    return M_PI / 2 * (integral(r) - integral(r - height));
}

double segmentArea(double r, double height) { return r * r * std::acos(1 - height / r) - (r - height) * std::sqrt(2 * r * height - height * height); }

/// Height of a sphere's or circle's cap beyond the plane of the common points with another one at distance d.
double capHeight(double r, double other, double d) { return r - (d * d + r * r - other * other) / (2 * d); }

const Vec3 tilted = Vec3(1, 2, -0.5).normalized();

} // namespace

TEST_CASE("unions of boxes have exact moments: lapped, in the same place, in each other, crossed; turned as well")
{
    const Eigen::Quaterniond turns[] = {Eigen::Quaterniond::Identity(), Eigen::Quaterniond(Eigen::AngleAxisd(0.7, tilted))};
    for (const Joined& joined : joinedBoxes())
        for (const Eigen::Quaterniond& q : turns)
        {
            CAPTURE(joined.name);
            const Vec3 translation(0.3, -20, 1);
            checkMoments(makeUnion(placed(joined.parts, q, translation))->moments(), sumOf(placed(joined.apart, q, translation)), 1e-11);
        }
}

TEST_CASE("parts that touch in faces are their exact sum, whatever their shape")
{
    const auto rod = [](double from, double to) { return makeCylinder(from * tilted, to * tilted, 0.1); };
    checkMoments(makeUnion({rod(-0.5, 0.2), rod(0.2, 0.5)})->moments(), rod(-0.5, 0.5)->moments(), roundOff);
    const Shapes post = {boxFrom({-1, -1, -0.3}, {1, 1, 0}), makeCylinder({0.2, 0.1, 0}, {0.2, 0.1, 2}, 0.1)};
    checkMoments(makeUnion(post)->moments(), sumOf(post), roundOff);
}

TEST_CASE("two spheres: the lens counts once")
{
    const double r = 0.3, d = 0.3;
    for (const double other : {0.1, 0.2, 0.3, 0.35})
        for (const Vec3& direction : {Vec3(Vec3::UnitX()), tilted})
        {
            CAPTURE(other);
            const double lens = capVolume(r, capHeight(r, other, d)) + capVolume(other, capHeight(other, r, d));
            const VolumeMoments m = makeUnion({makeSphere(Vec3::Zero(), r), makeSphere(d * direction, other)})->moments();
            const double volume = 4 * M_PI / 3 * (r * r * r + other * other * other) - lens;
            CHECK(m.volume == near(volume, accuracy));
            const double about = 8 * M_PI / 15 * (std::pow(r, 5) + std::pow(other, 5)) - capInertia(r, capHeight(r, other, d)) - capInertia(other, capHeight(other, r, d));
            CHECK(direction.dot(m.inertia * direction) == near(about, accuracy));
            if (other == r) CHECK((m.centroid - 0.5 * d * direction).norm() < accuracy * d);
        }
    const auto ball = makeSphere({1, 2, 3}, 0.2);
    checkMoments(makeUnion({ball, ball, makeSphere({1, 2.01, 3}, 0.15)})->moments(), ball->moments(), accuracy);
}

TEST_CASE("round logs: lapped, crossed (two cylinders share 16/3 r^3), through a box")
{
    const double r = 0.1;
    const auto rod = [&](double from, double to) { return makeCylinder(from * tilted, to * tilted, r); };
    checkMoments(makeUnion({rod(-0.5, 0.1), rod(0, 0.5)})->moments(), rod(-0.5, 0.5)->moments(), accuracy);
    const auto capsule = [&](double from, double to) { return makeCapsule(from * tilted, to * tilted, r); };
    checkMoments(makeUnion({capsule(-0.5, 0.1), capsule(0, 0.5)})->moments(), capsule(-0.5, 0.5)->moments(), accuracy);

    const Vec3 across = tilted.cross(Vec3::UnitZ()).normalized();
    const VolumeMoments cross = makeUnion({rod(-0.5, 0.5), makeCylinder(-0.5 * across, 0.5 * across, r)})->moments();
    CHECK(cross.volume == near(2 * M_PI * r * r - 16.0 / 3 * r * r * r, accuracy));
    CHECK(cross.centroid.norm() < accuracy);

    const auto plate = boxFrom({-1, -1, -0.1}, {1, 1, 0.1});
    checkMoments(makeUnion({plate, makeCylinder({0.2, 0.1, -0.5}, {0.2, 0.1, 1}, r)})->moments(),
                 sumOf({plate, makeCylinder({0.2, 0.1, -0.5}, {0.2, 0.1, -0.1}, r), makeCylinder({0.2, 0.1, 0.1}, {0.2, 0.1, 1}, r)}), accuracy);
}

TEST_CASE("a union in a union counts once what its parts share with other ones")
{
    const auto plank = boxFrom({-0.2, -0.02, 0}, {0.2, 0.02, 0.05});
    const auto inner = makeUnion({boxFrom({-0.2, -0.02, 0}, {0.05, 0.02, 0.05}), boxFrom({-0.05, -0.02, 0}, {0.2, 0.02, 0.05})});
    checkMoments(makeUnion({inner, inner})->moments(), plank->moments(), 1e-11);
    checkMoments(makeUnion({plank, makePlaced(inner, Eigen::Quaterniond::Identity(), Vec3::Zero())})->moments(), plank->moments(), accuracy);
}

TEST_CASE("plane sections count once what the parts share")
{
    const Eigen::Quaterniond q(Eigen::AngleAxisd(0.7, tilted));
    const Vec3 normal = q * Vec3::UnitZ();
    for (const Joined& joined : joinedBoxes())
    {
        CAPTURE(joined.name);
        for (const double z : {0.005, 0.022, 0.06})
        {
            double area = 0;
            for (const auto& box : joined.apart) area += sectionArea(box->surface(1), {0, 0, z}, Vec3::UnitZ());
            CHECK(makeUnion(joined.parts)->sectionArea({0, 0, z}, Vec3::UnitZ()) == near(area, roundOff));
            const auto turned = makePlaced(makeUnion(placed(joined.parts, q, {1, 0, 0})), Eigen::Quaterniond::Identity(), {0, 0, 2});
            CHECK(turned->sectionArea(q * Vec3(0, 0, z) + Vec3(1, 0, 2), normal) == near(area, 1e-11));
        }
    }
    const double r = 0.3, d = 0.35;
    const auto balls = makeUnion({makeSphere(Vec3::Zero(), r), makeSphere({d, 0, 0}, r)});
    for (const double z : {-0.1, 0.0, 0.2})
    {
        const double circle = std::sqrt(r * r - z * z);
        CHECK(balls->sectionArea({0, 0, z}, Vec3::UnitZ()) == near(2 * (M_PI * circle * circle - segmentArea(circle, capHeight(circle, circle, d))), 1e-4));
    }
    CHECK(balls->sectionArea({0, 0, 0.31}, Vec3::UnitZ()) == 0);
}

TEST_CASE("2D: the volume that a union displaces is its own")
{
    const CoverScene scene(2, 16);
    CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
    for (const Joined& joined : joinedBoxes())
    {
        CAPTURE(joined.name);
        double area = 0;
        for (const auto& box : joined.apart) area += sectionArea(box->surface(1), {0, 0, 0.02}, Vec3::UnitZ());
        CHECK(builder.exactVolume(makeSolid(makeUnion(joined.parts), {0.1, 0.05, -0.02}, Solid::Kind::Fixed)) == near(area, 1e-11));
    }
    const double r = 0.05, d = 0.06;
    const auto disc = [&](double x) { return makeCylinder({x, 0, -0.5}, {x, 0, 0.5}, r); };
    CHECK(builder.exactVolume(makeSolid(makeUnion({disc(0), disc(d)}), Vec3::Zero(), Solid::Kind::Fixed))
          == near(2 * (M_PI * r * r - segmentArea(r, capHeight(r, r, d))), accuracy));
}
