// SPDX-License-Identifier: GPL-3.0-or-later
/// Convex parts of closed surfaces of few plane faces: boats, open containers, angle sections, steps. By the planes of the faces, one after the other (binary space partition, Thibault & Naylor,
/// Computer Graphics 21 (1987) 153, doi 10.1145/37402.37421): what lies behind a face with no other face in it is in the solid.
#include "geometry/convexParts.hpp"

#include "geometry/planeFaces.hpp"
#include "geometry/triSurface.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace flotsam
{
namespace
{

using Plane = PlaneFaces::Plane;
using Polygon = std::vector<Vec3>;

constexpr std::size_t mostPlanes = 40, mostParts = 32;  // of more the linear cut is cheaper, and likely as good: their surface is a round one
constexpr std::size_t mostTriangles = 200000;           // each is split by each plane: a second
constexpr double sameVolume = 1e-5;
constexpr double smallestFace = 1e-9;                   // twice its area, over the square of the surface's size

struct Face
{
    Polygon polygon;
    int plane;
    bool isAlong;   // its normal is the plane's, not the opposite
};

/// A part's surface, and the planes of its faces.
struct Part
{
    TriSurface surface;
    std::shared_ptr<PlaneFaces> faces = std::make_shared<PlaneFaces>();
};

struct TooMany {};

Plane opposite(const Plane& plane) { return {-plane.normal, -plane.distance}; }
double height(const Plane& plane, const Vec3& x) { return plane.normal.dot(x) - plane.distance; }

/// What of a convex polygon lies behind the plane.
Polygon behind(const Polygon& polygon, const Plane& plane)
{
    Polygon part;
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
        const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double da = height(plane, a), db = height(plane, b);
        if (da <= 0) part.push_back(a);
        if ((da <= 0) != (db <= 0)) part.push_back(a + da / (da - db) * (b - a));
    }
    return part;
}

double twiceArea(const Polygon& polygon)
{
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 2; k < polygon.size(); ++k) sum += (polygon[k - 1] - polygon[0]).cross(polygon[k] - polygon[0]);
    return sum.norm();
}

class Partition
{
public:
    explicit Partition(const TriSurface& surface)
    {
        if (surface.triangles.size() > mostTriangles) throw TooMany();
        const auto [lower, upper] = boundsOf(surface);
        centre_ = 0.5 * (lower + upper);
        size_ = (upper - lower).norm();
        tolerance_ = planeTolerance * size_;
        readFaces(surface);
    }

    std::vector<Part> parts()
    {
        split(faces_, {});
        return std::move(parts_);
    }

private:
    /// Largest triangles first: their planes tell best which others lie in them. Then each becomes the mean of its triangles' planes.
    void readFaces(const TriSurface& surface)
    {
        struct Sum { Vec3 area = Vec3::Zero(); double moment = 0; };    // twice the areas, and that times the distances from the origin
        std::vector<Sum> sums;
        for (const Facet& facet : largestFirst(surface))
        {
            const auto holds = [&](const Plane& plane)
            {
                return std::all_of(facet.corners.begin(), facet.corners.end(), [&](const Vec3& x) { return std::abs(height(plane, x)) < tolerance_; });
            };
            auto plane = std::find_if(planes_.begin(), planes_.end(), holds);
            if (plane == planes_.end())
            {
                if (planes_.size() == mostPlanes) throw TooMany();
                const Vec3 normal = facet.area.normalized();
                plane = planes_.insert(planes_.end(), Plane{normal, normal.dot(facet.corners[0])});
                sums.emplace_back();
            }
            const Face& face = faces_.emplace_back(Face{{facet.corners.begin(), facet.corners.end()}, static_cast<int>(plane - planes_.begin()), plane->normal.dot(facet.area) > 0});
            const Vec3 along = face.isAlong ? facet.area : Vec3(-facet.area);
            sums[face.plane].area += along;
            sums[face.plane].moment += along.dot(facet.corners[0] + facet.corners[1] + facet.corners[2]) / 3;
        }
        for (std::size_t p = 0; p < planes_.size(); ++p) planes_[p] = {sums[p].area.normalized(), sums[p].moment / sums[p].area.norm()};
    }

    struct Sides { std::vector<Face> back, front; int nSplit = 0; };

    /// Of a plane; faces on it are on neither.
    Sides sidesOf(const std::vector<Face>& faces, int number) const
    {
        Sides sides;
        for (const Face& face : faces)
        {
            if (face.plane == number) continue;
            double low = 0, high = 0;
            for (const Vec3& x : face.polygon)
            {
                low = std::min(low, height(planes_[number], x));
                high = std::max(high, height(planes_[number], x));
            }
            const bool isBehind = low < -tolerance_, isBefore = high > tolerance_;
            sides.nSplit += isBehind && isBefore;
            if (isBehind) sides.back.push_back({isBefore ? behind(face.polygon, planes_[number]) : face.polygon, face.plane, face.isAlong});
            if (isBefore) sides.front.push_back({isBehind ? behind(face.polygon, opposite(planes_[number])) : face.polygon, face.plane, face.isAlong});
        }
        return sides;
    }

    /// The cell behind `walls`, with faces in it: by the plane that has them all on one side if there is one, else by that which splits the fewest.
    void split(const std::vector<Face>& faces, const std::vector<Plane>& walls)
    {
        std::optional<Sides> best;
        const Face* chosen = nullptr;
        std::vector<char> isKnown(planes_.size(), 0);
        for (const Face& face : faces)
        {
            if (isKnown[face.plane]) continue;
            isKnown[face.plane] = 1;
            Sides sides = sidesOf(faces, face.plane);
            const bool isOutermost = (face.isAlong ? sides.front : sides.back).empty();
            if (best && !isOutermost && sides.nSplit >= best->nSplit) continue;
            best = std::move(sides);
            chosen = &face;
            if (isOutermost) break;
        }
        const Plane& plane = planes_[chosen->plane];
        const auto go = [&](const std::vector<Face>& rest, const Plane& wall, bool isInside)
        {
            std::vector<Plane> all = walls;
            all.push_back(wall);
            if (!rest.empty()) split(rest, all);
            else if (isInside) addPart(all);
        };
        // parts that touch have faces on both sides of their common plane
        const auto isAny = [&](bool isAlong) { return std::any_of(faces.begin(), faces.end(), [&](const Face& f) { return f.plane == chosen->plane && f.isAlong == isAlong; }); };
        const bool isBackInside = isAny(true), isFrontInside = isAny(false);
        go(best->back, plane, isBackInside);
        go(best->front, opposite(plane), isFrontInside);
    }

    /// Its faces are the planes themselves: the part on the other side of one has the same, to the last bit, so that there is no slit between the two.
    void addPart(const std::vector<Plane>& walls)
    {
        Part part;
        TriSurface& surface = part.surface;
        for (std::size_t f = 0; f < walls.size(); ++f)
        {
            Polygon polygon = largeSquare(walls[f]);
            for (std::size_t g = 0; g < walls.size() && polygon.size() > 2; ++g)
                if (g != f) polygon = behind(polygon, walls[g]);
            if (polygon.size() < 3 || twiceArea(polygon) < smallestFace * size_ * size_) continue; // the plane touches an edge
            const int first = static_cast<int>(surface.points.size());
            surface.points.insert(surface.points.end(), polygon.begin(), polygon.end());
            for (int k = 2; k < static_cast<int>(polygon.size()); ++k) surface.triangles.push_back({first, first + k - 1, first + k});
            part.faces->planes.push_back(walls[f]);
        }
        const std::size_t nFaces = part.faces->planes.size();
        if (nFaces > maxFaces || parts_.size() == mostParts) throw TooMany();
        if (nFaces > 3) parts_.push_back(std::move(part));
    }

    /// Around the whole surface, counter-clockwise about the normal.
    Polygon largeSquare(const Plane& plane) const
    {
        const Vec3 middle = centre_ - height(plane, centre_) * plane.normal, u = anyNormalTo(plane.normal), v = plane.normal.cross(u);
        return {middle + size_ * (u + v), middle + size_ * (v - u), middle - size_ * (u + v), middle + size_ * (u - v)};
    }

    Vec3 centre_;
    double size_ = 0, tolerance_ = 0;
    std::vector<Plane> planes_;
    std::vector<Face> faces_;
    std::vector<Part> parts_;
};

/// A part: what lies behind all of its faces.
class Polyhedron : public Shape
{
public:
    explicit Polyhedron(Part part) : surface_(std::move(part.surface)), faces_(std::move(part.faces)) {}

    /// The largest of the faces'.
    double distance(const Vec3& x) const override
    {
        double distances[maxFaces];
        return *std::max_element(distances, distances + faces_->distances(x, distances));
    }
    int faceDistances(const Vec3& x, double* distances) const override { return faces_->distances(x, distances); }
    bool hasPlaneFaces() const override { return true; }
    std::array<Vec3, 2> bounds() const override { return boundsOf(surface_); }
    VolumeMoments moments() const override { return enclosedMoments(surface_); }
    TriSurface surface(double) const override { return surface_; }

private:
    TriSurface surface_;
    std::shared_ptr<const PlaneFaces> faces_;
};

} // namespace

std::vector<std::shared_ptr<const Shape>> convexParts(const TriSurface& surface)
{
    std::vector<std::shared_ptr<const Shape>> parts;
    double missing = enclosedMoments(surface).volume;
    const double allowed = sameVolume * missing;
    try
    {
        for (Part& part : Partition(surface).parts())
        {
            missing -= enclosedMoments(part.surface).volume;
            parts.push_back(std::make_shared<Polyhedron>(std::move(part)));
        }
    }
    catch (const TooMany&)
    {
        return {};
    }
    return std::abs(missing) < allowed ? parts : std::vector<std::shared_ptr<const Shape>>();
}

} // namespace flotsam
