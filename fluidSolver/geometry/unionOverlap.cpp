// SPDX-License-Identifier: GPL-3.0-or-later
/// What shapes have in common, by halving cells: distances change by at most the way, so most cells are seen to lie inside or outside of a shape as a whole.
/// The others are cut by the shapes' faces, linear in each of six tetrahedra (two triangles). That is exact for plane faces, at edges and corners too; round
/// ones are moved by the mean error of their linear function, which leaves errors of the fourth order.
#include "geometry/overlapCut.hpp"
#include "geometry/triSurface.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{
namespace
{

constexpr int fewFaces = 12;            // of all shapes in a cell: they are cut; more are separated first
constexpr double smallestCell = 0.25;   // over half of the thickness: faces that cannot be separated
template <int dim>
constexpr double roundError = dim == 2 ? 1e-4 : 3e-3;   // of a linear distance, over half of the thickness of the shape

struct Bounds
{
    Vec3 lower = Vec3::Constant(1e300), upper = Vec3::Constant(-1e300);

    bool isEmpty() const { return (upper - lower).minCoeff() <= 0; }
    void include(const Bounds& b)
    {
        lower = lower.cwiseMin(b.lower);
        upper = upper.cwiseMax(b.upper);
    }
};

/// Around all places where the boxes of two shapes overlap.
Bounds commonBounds(const Shapes& shapes)
{
    std::vector<Bounds> boxes;
    Bounds all;
    for (const auto& shape : shapes)
    {
        const auto [lower, upper] = shape->bounds();
        for (const Bounds& b : boxes)
            if (const Bounds common{lower.cwiseMax(b.lower), upper.cwiseMin(b.upper)}; !common.isEmpty()) all.include(common);
        boxes.push_back({lower, upper});
    }
    return all;
}

/// About half of the shape's thickness: twice the volume over the surface, the radius of a rod [m].
double depth(const Shape& shape)
{
    const auto [lower, upper] = shape.bounds();
    const TriSurface surface = shape.surface(0.5 * (upper - lower).minCoeff());
    double area = 0;
    for (const auto& t : surface.triangles)
        area += 0.5 * (surface.points[t[1]] - surface.points[t[0]]).cross(surface.points[t[2]] - surface.points[t[0]]).norm();
    return 2 * shape.moments().volume / area;
}

template <int dim>
class OverlapCells
{
public:
    /// axes: unit vectors of the cells' edges.
    OverlapCells(const Shapes& shapes, const std::array<Vec3, dim>& axes, const Vec3& origin, double volume) : axes_(axes), cut_(parts_, axes, volume, sum_)
    {
        sum_.origin = origin;
        double total = 0;
        for (const auto& shape : shapes) total += shape->moments().volume;
        for (const auto& shape : shapes)
        {
            const double half = depth(*shape), share = shape->moments().volume / total;
            parts_.push_back({shape.get(), half, roundError<dim> * half / std::sqrt(share), shape->hasPlaneFaces()});
        }
    }

    RawMoments integrate(const Bounds& box)
    {
        const Vec3 half = 0.5 * (box.upper - box.lower);
        OverlapCell cell{0.5 * (box.lower + box.upper), 0, 0, {}};
        for (const Vec3& axis : axes_) cell.half = std::max(cell.half, axis.cwiseAbs().dot(half));
        if constexpr (dim == 2)
        {
            const Vec3 normal = axes_[0].cross(axes_[1]);
            cell.centre -= normal.dot(cell.centre - sum_.origin) * normal;
        }
        for (std::size_t i = 0; i < parts_.size(); ++i) cell.parts.push_back(static_cast<int>(i));
        extent_ = 2 * cell.half;
        visit(cell);
        return sum_;
    }

private:
    void visit(OverlapCell& cell)
    {
        const CellFaces faces = findFaces(cell);
        if (cell.nAround + cell.parts.size() < 2) return;
        if (cell.parts.empty()) return addWhole(cell);
        if (isCut(cell, faces)) return;
        OverlapCell child{Vec3::Zero(), 0.5 * cell.half, 0, {}};
        for (int c = 0; c < OverlapCut<dim>::nCorners; ++c)
        {
            child.centre = 0.5 * (cell.centre + cut_.corner(cell, c));
            child.nAround = cell.nAround;
            child.parts = cell.parts;
            visit(child);
        }
    }

    /// Leaves the parts whose surface may pass through the cell.
    CellFaces findFaces(OverlapCell& cell) const
    {
        const double radius = cell.half * std::sqrt(double(dim));
        CellFaces result;
        std::size_t kept = 0;
        for (const int i : cell.parts)
        {
            double distances[maxFaces] = {parts_[i].shape->distance(cell.centre)};
            if (distances[0] >= radius) continue;
            const int n = std::max(1, parts_[i].shape->faceDistances(cell.centre, distances));
            const std::size_t before = result.faces.size();
            for (int f = 0; f < n; ++f)
                if (distances[f] > -radius) result.faces.push_back({i, f});
            if (result.faces.size() == before) ++cell.nAround;
            else
            {
                cell.parts[kept++] = i;
                result.end.push_back(static_cast<int>(result.faces.size()));
            }
        }
        cell.parts.resize(kept);
        return result;
    }

    bool isCut(const OverlapCell& cell, const CellFaces& faces)
    {
        const double side = 2 * cell.half;
        bool isSmall = true;
        for (const int i : cell.parts)
        {
            if (!parts_[i].isPlane && side > parts_[i].depth) return false;
            isSmall = isSmall && side < smallestCell * parts_[i].depth;
        }
        cut_.set(cell, faces);
        if (!isSmall && cut_.nDifferentFaces() > fewFaces) return false;
        if (!cut_.isLinear(extent_)) return false;
        cut_.add();
        return true;
    }

    void addWhole(const OverlapCell& cell)
    {
        const Vec3 r = cell.centre - sum_.origin;
        const double volume = (cell.nAround - 1) * std::pow(2 * cell.half, dim);
        sum_.volume += volume;
        sum_.first += volume * r;
        sum_.second += volume * r * r.transpose();
        for (const Vec3& axis : axes_) sum_.second += volume * cell.half * cell.half / 3 * axis * axis.transpose();
    }

    std::vector<OverlapPart> parts_;
    std::array<Vec3, dim> axes_;
    RawMoments sum_;
    OverlapCut<dim> cut_;
    double extent_ = 0;     // of all cells
};

} // namespace

RawMoments overlapMoments(const Shapes& shapes, const Vec3& origin, double volume)
{
    RawMoments none;
    none.origin = origin;
    const Bounds box = commonBounds(shapes);
    if (box.isEmpty()) return none;
    return OverlapCells<3>(shapes, {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}, origin, volume).integrate(box);
}

double overlapArea(const Shapes& shapes, const Vec3& point, const Vec3& normal, double area)
{
    const Bounds box = commonBounds(shapes);
    if (box.isEmpty()) return 0;
    const Vec3 u = anyNormalTo(normal);
    return OverlapCells<2>(shapes, {u, normal.cross(u)}, point, area).integrate(box).volume;
}

} // namespace flotsam
