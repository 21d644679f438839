// SPDX-License-Identifier: GPL-3.0-or-later
/// Boxes that move and reach through the mesh's boundary: what they cut out, of the mesh and of its boundary, is theirs at any place, and changes by what their surface sweeps.
/// On 1 and 2 ranks.
#include "core/patchFaces.hpp"
#include "equations/faceMoments.hpp"
#include "support/coverScene.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <functional>

using namespace flotsam;

namespace
{

using Polygon = std::vector<Eigen::Vector2d>;

/// The part of a polygon of the x-y plane that is in the mesh, -1 < x, y < 1.
Polygon inMesh(Polygon polygon)
{
    for (int side = 0; side < 4; ++side)
    {
        const auto depth = [&](const Eigen::Vector2d& p) { return 1 - (side % 2 ? 1 : -1) * p[side / 2]; };
        Polygon part;
        for (std::size_t i = 0; i < polygon.size(); ++i)
        {
            const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
            const double ofA = depth(a), ofB = depth(b);
            if (ofA > 0) part.push_back(a);
            if (ofA * ofB < 0) part.push_back(a + ofA / (ofA - ofB) * (b - a));
        }
        polygon.swap(part);
    }
    return polygon;
}

double area(const Polygon& p)
{
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) sum += 0.5 * (p[i][0] * p[(i + 1) % p.size()][1] - p[(i + 1) % p.size()][0] * p[i][1]);
    return sum;
}

/// Length of the polygon's edges on the sides of the mesh.
double lengthOnSides(const Polygon& p)
{
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i)
    {
        const Eigen::Vector2d &a = p[i], &b = p[(i + 1) % p.size()];
        for (int d = 0; d < 2; ++d) sum += std::abs(a[d]) > 1 - 1e-12 && std::abs(b[d]) > 1 - 1e-12 && a[d] * b[d] > 0 ? (b - a).norm() : 0;
    }
    return sum;
}

/// A box with z along its own axis z, in x-y a rectangle that moves; in 3D through one wall or both walls z = -1, 1.
struct Structure
{
    const char* name;
    Eigen::Vector2d lower, upper;   // in the body frame
    std::function<Pose(double)> pose;
    Motion motion;
    bool isThroughBoth = true;

    Solid at(double time) const
    {
        const double low = -1.2, high = isThroughBoth ? 1.2 : 0.137;
        Solid solid;
        solid.kind = Solid::Kind::Prescribed;
        solid.shape = makeBox(Vec3(0.5 * (lower[0] + upper[0]), 0.5 * (lower[1] + upper[1]), 0.5 * (low + high)), Vec3(upper[0] - lower[0], upper[1] - lower[1], high - low));
        solid.pose = pose(time);
        solid.motion = motion;
        return solid;
    }
    Polygon section(double time) const
    {
        const Pose p = pose(time);
        Polygon corners;
        for (const Eigen::Vector2d& c : {lower, Eigen::Vector2d(upper[0], lower[1]), upper, Eigen::Vector2d(lower[0], upper[1])})
            corners.push_back((p.position + p.orientation * Vec3(c[0], c[1], 0)).head<2>());
        return inMesh(corners);
    }
    double width(int dim) const { return dim == 2 ? 1 : isThroughBoth ? 2 : 1.137; }
    double volume(int dim, double time) const { return area(section(time)) * width(dim); }
    double areaOnBoundary(int dim, double time) const
    {
        return lengthOnSides(section(time)) * width(dim) + (dim == 2 ? 0 : (isThroughBoth ? 2 : 1) * area(section(time)));
    }
};

Pose placeAt(double x, double y)
{
    Pose pose;
    pose.position = Vec3(x, y, 0);
    return pose;
}

/// Thickness d.
std::vector<Structure> structures(double d)
{
    const double speed = 0.37, turn = 0.29, x = 0.013;
    const auto lifted = [=](double t) { return placeAt(x, speed * t); };
    const auto pushed = [=](double t) { return placeAt(-0.2 + speed * t, 0); };
    const auto turned = [=](double t)
    {
        Pose pose = placeAt(x, -1);
        pose.orientation = Eigen::AngleAxisd(0.4 - turn * t, Vec3::UnitZ());
        return pose;
    };
    const Motion up{Vec3(0, speed, 0), Vec3::Zero()}, along{Vec3(speed, 0, 0), Vec3::Zero()}, around{Vec3::Zero(), Vec3(0, 0, -turn)};
    return {{"lift gate, through the lid", {-0.5 * d, -0.6}, {0.5 * d, 1.7}, lifted, up}, {"lift gate, through one wall", {-0.5 * d, -0.6}, {0.5 * d, 1.7}, lifted, up, false},
        {"plate, through the bed", {-0.5 * d, -1.2}, {0.5 * d, 0.31}, pushed, along}, {"beam from wall to wall", {-0.5 * d, -0.5 * d}, {0.5 * d, 0.5 * d}, pushed, along},
        {"flap, hinged at the bed", {-0.5 * d, -0.7}, {0.5 * d, 0.9}, turned, around}};
}

/// Of the mesh's boundary what the solid covers [m^(dim-1)].
template <int dim>
double coveredBoundary(const CoverScene& scene, const Cover& cover)
{
    double covered = 0;
    for (const MeshPatch& patch : scene.mesh.patches)
        for (std::size_t f = 0; f < patch.faceElement.size(); ++f)
        {
            if (!scene.mesh.isOwnedElement[patch.faceElement[f]]) continue;
            const FaceMoments<dim> moments(scene.mesh, &cover, patch.faceElement[f], &patch.faceNodes[f * dim]);
            double out[dim], square = 0, share = 1;
            outwardVector(scene.mesh, patch, f, out);
            for (int d = 0; d < dim; ++d) square += out[d] * out[d];
            for (int k = 0; k < dim; ++k) share -= moments.first[k];
            covered += share * std::sqrt(square);
        }
    return scene.halo.sum(covered);
}

/// Of fluid by the surface's velocity [m^dim/s].
double displaced(const CoverScene& scene, const Cover& cover, const Solid& solid)
{
    double sum = 0;
    const int dim = scene.mesh.dim;
    for (const CutFacet& f : cover.facets)
        for (int q = 0; q < f.nPoints && scene.mesh.isOwnedElement[f.element]; ++q)
        {
            Vec3 x = Vec3::Zero();
            for (int a = 0; a <= dim; ++a)
            {
                const auto y = scene.mesh.spacePoint(scene.mesh.elements[std::size_t(f.element) * (dim + 1) + a]);
                x += f.shape[q][a] * Vec3(y[0], y[1], y[2]);
            }
            const Vec3 velocity = solid.velocityAt(x);
            for (int d = 0; d < dim; ++d) sum -= f.weight[q] * f.normal[d] * velocity[d];
        }
    return scene.halo.sum(sum);
}

} // namespace

TEST_CASE("structures that move through the mesh's boundary cut out their volume and their part of the boundary, and displace what the volume grows by")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 20 : 10, nPlaces = dim == 2 ? 25 : 9;
        const double h = 2.0 / n, dt = 1e-4;
        CoverScene scene(dim, n);
        CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
        for (const double thickness : {1.2, 2.1, 3.0, 4.0, 6.0})
            for (const Structure& structure : structures(thickness * h))
            {
                if (dim == 2 && (!structure.isThroughBoth || structure.name[0] == 'b')) continue;
                const auto cut = [&](double time) -> const Cover&
                {
                    std::vector<Solid> solids = {structure.at(time)};
                    return builder.buildExactVolume(solids);
                };
                double least = 1e300, most = 0, ofArea = 0, ofRate = 0, ofFlux = 0;
                for (int k = 0; k < nPlaces; ++k)
                {
                    const double time = 2.0 * h * k / nPlaces / 0.37, volume = structure.volume(dim, time);
                    const double before = cut(time - dt).solidVolume[0], after = cut(time + dt).solidVolume[0];
                    const Cover& cover = cut(time);
                    const double boundary = dim == 2 ? coveredBoundary<2>(scene, cover) : coveredBoundary<3>(scene, cover);
                    const double swept = thickness * h * structure.width(dim) * 0.37, rate = (structure.volume(dim, time + dt) - structure.volume(dim, time - dt)) / (2 * dt);
                    least = std::min(least, cover.solidVolume[0] / volume);
                    most = std::max(most, cover.solidVolume[0] / volume);
                    ofArea = std::max(ofArea, std::abs(boundary / structure.areaOnBoundary(dim, time) - 1));
                    ofRate = std::max(ofRate, std::abs((after - before) / (2 * dt) - rate) / swept);
                    ofFlux = std::max(ofFlux, std::abs(displaced(scene, cover, structure.at(time)) - rate) / swept);
                }
                if (scene.halo.rank() == 0) std::printf("%dD %-27s %.1f elements: volume %.4f to %.4f, part of the boundary to %.1e, rate of the volume %.1e, displaced %.1e\n", dim, structure.name, thickness, least, most, ofArea, ofRate, ofFlux);
                CAPTURE(dim);
                CAPTURE(structure.name);
                CAPTURE(thickness);
                CHECK(least == near(1, 1e-11));   // linear: 0.25 to 0.998
                CHECK(most == near(1, 1e-11));
                CHECK(ofArea < 1e-9);    // nodes within 1e-10 of an element are in it; linear: up to 0.71
                CHECK(ofRate < 1e-8);  // linear: 0.1 to 12
                CHECK(ofFlux < 1e-8);
            }
    }
}
