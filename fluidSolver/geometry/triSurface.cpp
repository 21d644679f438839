// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/triSurface.hpp"
#include "geometry/faceTriangles.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace flotsam
{

VolumeMoments enclosedMoments(const TriSurface& surface)
{
    VolumeMoments m;
    if (surface.points.empty()) return m;
    const Vec3 origin = surface.points[0]; // near the surface: no cancellation for bodies far from the frame's origin
    Vec3 first = Vec3::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    for (const auto& t : surface.triangles)
    {
        const Vec3 a = surface.points[t[0]] - origin, b = surface.points[t[1]] - origin, c = surface.points[t[2]] - origin;
        const double v = a.dot(b.cross(c)) / 6;
        const Vec3 s = a + b + c;
        m.volume += v;
        first += v / 4 * s;
        second += v / 20 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
    }
    if (m.volume == 0) return m;
    const Vec3 r = first / m.volume;
    second -= m.volume * r * r.transpose();
    m.centroid = origin + r;
    m.inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
    return m;
}

std::array<Vec3, 2> boundsOf(const TriSurface& surface)
{
    std::array<Vec3, 2> bounds{surface.points[0], surface.points[0]};
    for (const Vec3& x : surface.points)
    {
        bounds[0] = bounds[0].cwiseMin(x);
        bounds[1] = bounds[1].cwiseMax(x);
    }
    return bounds;
}

std::vector<Facet> largestFirst(const TriSurface& surface)
{
    std::vector<Facet> facets;
    for (const auto& t : surface.triangles)
    {
        const Vec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
        if (const Vec3 area = (b - a).cross(c - a); !area.isZero(0)) facets.push_back({{a, b, c}, area});
    }
    std::stable_sort(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) { return a.area.squaredNorm() > b.area.squaredNorm(); });
    return facets;
}

double sectionArea(const TriSurface& surface, const Vec3& point, const Vec3& normal)
{
    if (surface.points.empty()) return 0;
    const Vec3 origin = surface.points[0]; // near the section: `point` may be kilometres away in the plane (a body at coordinates of a map, seen from there)
    double area = 0;
    for (const auto& t : surface.triangles)
    {
        double d[3];
        for (int i = 0; i < 3; ++i) d[i] = normal.dot(surface.points[t[i]] - point);
        Vec3 cut[2]; // entering and leaving the upper side, in the triangle's order
        int n = 0;
        for (int i = 0; i < 3; ++i)
        {
            const int j = (i + 1) % 3;
            if ((d[i] >= 0) == (d[j] >= 0)) continue;
            const Vec3& p = surface.points[t[i]];
            cut[d[i] < 0 ? 0 : 1] = p + d[i] / (d[i] - d[j]) * (surface.points[t[j]] - p) - origin;
            ++n;
        }
        if (n == 2) area += 0.5 * normal.dot(cut[1].cross(cut[0]));
    }
    return std::abs(area);
}

double Shape::sectionArea(const Vec3& point, const Vec3& normal) const
{
    const auto [lower, upper] = bounds();
    return flotsam::sectionArea(surface((upper - lower).minCoeff() / 100), point, normal);
}

Vec3 anyNormalTo(const Vec3& axis)
{
    int least = 0;
    axis.cwiseAbs().minCoeff(&least);
    return axis.cross(Vec3::Unit(least)).normalized();
}

int stripPieces(double length, double width)
{
    constexpr double longest = 0.9/needleAngle; // widths
    return width > 0 ? std::max(1, int(std::ceil(length/(longest*width)))) : 1;
}

namespace
{

/// With points between those of parts that are long beside the strips around them.
std::vector<ProfilePoint> withoutNeedles(const std::vector<ProfilePoint>& profile, int nAround)
{
    std::vector<ProfilePoint> result{profile.front()};
    for (std::size_t k = 1; k < profile.size(); ++k)
    {
        const ProfilePoint &a = profile[k - 1], &b = profile[k];
        const double width = 2*std::sin(M_PI/nAround)*std::min(a.radius, b.radius);
        const int n = stripPieces(std::hypot(b.along - a.along, b.radius - a.radius), width);
        for (int i = 1; i < n; ++i) result.push_back({a.along + (b.along - a.along)*i/n, a.radius + (b.radius - a.radius)*i/n});
        result.push_back(b);
    }
    return result;
}

} // namespace

TriSurface boxSurface(const Vec3& lower, const Vec3& upper)
{
    const Vec3 size = upper - lower;
    std::array<int, 3> n;
    for (int d = 0; d < 3; ++d) n[d] = std::max(stripPieces(size[d], size[(d + 1) % 3]), stripPieces(size[d], size[(d + 2) % 3]));
    TriSurface s;
    std::map<std::array<int, 3>, int> numbers;
    const auto point = [&](const std::array<int, 3>& at)
    {
        const auto [found, isNew] = numbers.insert({at, int(s.points.size())});
        const Vec3 share(double(at[0])/n[0], double(at[1])/n[1], double(at[2])/n[2]);
        if (isNew) s.points.push_back((Vec3::Ones() - share).cwiseProduct(lower) + share.cwiseProduct(upper));
        return found->second;
    };
    for (int i = 0; i < 8; ++i) point({i & 1 ? n[0] : 0, i & 2 ? n[1] : 0, i & 4 ? n[2] : 0});
    for (int d = 2; d >= 0; --d)
        for (const int side : {0, n[d]})
        {
            // u, v and d are right-handed where the normal goes up along d
            const int u = (d + (side ? 1 : 2)) % 3, v = (d + (side ? 2 : 1)) % 3;
            for (int i = 0; i < n[u]; ++i)
                for (int j = 0; j < n[v]; ++j)
                {
                    const auto corner = [&](int k, int l) { std::array<int, 3> at; at[d] = side; at[u] = i + k; at[v] = j + l; return point(at); };
                    s.triangles.push_back({corner(0, 0), corner(1, 0), corner(1, 1)});
                    s.triangles.push_back({corner(0, 0), corner(1, 1), corner(0, 1)});
                }
        }
    return s;
}

TriSurface surfaceOfRevolution(const Vec3& origin, const Vec3& axis, const std::vector<ProfilePoint>& given, int nAround)
{
    const std::vector<ProfilePoint> profile = withoutNeedles(given, nAround);
    const Vec3 u = anyNormalTo(axis), v = axis.cross(u);
    TriSurface s;
    std::vector<int> ringStart;
    for (const ProfilePoint& p : profile)
    {
        ringStart.push_back(static_cast<int>(s.points.size()));
        const int n = p.radius > 0 ? nAround : 1;
        for (int i = 0; i < n; ++i)
        {
            const double angle = 2 * M_PI * i / nAround;
            s.points.push_back(origin + p.along * axis + p.radius * (std::cos(angle) * u + std::sin(angle) * v));
        }
    }
    for (std::size_t k = 0; k + 1 < profile.size(); ++k)
    {
        const bool isLowerPole = !(profile[k].radius > 0), isUpperPole = !(profile[k + 1].radius > 0);
        for (int i = 0; i < nAround; ++i)
        {
            const int j = (i + 1) % nAround, lower = ringStart[k], upper = ringStart[k + 1];
            if (isLowerPole) s.triangles.push_back({lower, upper + j, upper + i});
            else if (isUpperPole) s.triangles.push_back({lower + i, lower + j, upper});
            else
            {
                s.triangles.push_back({lower + i, lower + j, upper + j});
                s.triangles.push_back({lower + i, upper + j, upper + i});
            }
        }
    }
    return s;
}

Strip::Strip(const Vec3& a, const Vec3& b, const Vec3& c) : corners_{a, b, c}
{
    const std::array<double, 3> lengths{(b - a).norm(), (c - b).norm(), (a - c).norm()};
    const auto shortest = std::min_element(lengths.begin(), lengths.end());
    std::rotate(corners_.begin(), corners_.begin() + (shortest - lengths.begin()), corners_.end());
    longest_ = *std::max_element(lengths.begin(), lengths.end());
    narrowness_ = *shortest / longest_;
}

int Strip::rows(double spacing) const { return std::max(1, static_cast<int>(std::ceil(longest_ / spacing))); }

std::array<Vec3, 2> Strip::row(double share) const
{
    return {corners_[0] + share * (corners_[2] - corners_[0]), corners_[1] + share * (corners_[2] - corners_[1])};
}

namespace
{

void addPointsOfStrip(std::vector<SurfacePoint>& points, const Strip& strip, const Vec3& normal, double spacing)
{
    const int n = strip.rows(spacing);
    for (int i = 0; i < n; ++i)
    {
        const auto [begin, end] = strip.row((i + 0.5) / n);
        const int m = std::max(1, static_cast<int>(std::ceil((end - begin).norm() / spacing)));
        for (int j = 0; j < m; ++j) points.push_back({begin + (j + 0.5) / m * (end - begin), normal});
    }
}

} // namespace

std::vector<SurfacePoint> samplePoints(const TriSurface& surface, double spacing)
{
    std::vector<SurfacePoint> points;
    for (const auto& t : surface.triangles)
    {
        const Vec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
        const Vec3 normal = (b - a).cross(c - a).normalized();
        if (const Strip strip(a, b, c); strip.isNarrow())
        {
            addPointsOfStrip(points, strip, normal, spacing);
            continue;
        }
        const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
        const int n = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
        // centroids of the n*n parts of the triangle
        for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j)
            {
                points.push_back({a + ((i + 1.0 / 3) * (b - a) + (j + 1.0 / 3) * (c - a)) / n, normal});
                if (i + j + 1 < n) points.push_back({a + ((i + 2.0 / 3) * (b - a) + (j + 2.0 / 3) * (c - a)) / n, normal});
            }
    }
    return points;
}

} // namespace flotsam
