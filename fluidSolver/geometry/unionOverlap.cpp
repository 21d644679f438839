// SPDX-License-Identifier: GPL-3.0-or-later
/// What shapes have in common, by halving cells: distances change by at most the way, so most cells are seen to lie inside or outside of a shape as a whole.
/// The others are cut by the shapes' faces, linear in each of six tetrahedra (two triangles). That is exact for plane faces, at edges and corners too; round
/// ones are moved by the mean error of their linear function, which leaves errors of the fourth order.
#include "geometry/unionOverlap.hpp"
#include "geometry/simplexDivision.hpp"
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
constexpr double kinkError = 2e-5;      // of the volume: that of cells along an edge which the distance alone shows
constexpr double onFace = 1e-13;        // over the side of the cell: faces in one plane

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

/// Tetrahedra of a cube, triangles of a square: from the lowest corner to the highest one along its edges. Corners by bits.
template <int dim>
std::vector<std::array<int, dim + 1>> cellSimplices()
{
    std::array<int, dim> order;
    for (int d = 0; d < dim; ++d) order[d] = d;
    std::vector<std::array<int, dim + 1>> simplices;
    do
    {
        auto& corners = simplices.emplace_back();
        corners[0] = 0;
        for (int d = 0; d < dim; ++d) corners[d + 1] = corners[d] | 1 << order[d];
    } while (std::next_permutation(order.begin(), order.end()));
    return simplices;
}

template <int dim>
class OverlapCells
{
public:
    /// axes: unit vectors of the cells' edges.
    OverlapCells(const Shapes& shapes, const std::array<Vec3, dim>& axes, const Vec3& origin, double volume)
        : axes_(axes), simplices_(cellSimplices<dim>()), volume_(volume)
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
        Cell cell{0.5 * (box.lower + box.upper), 0, 0, {}};
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
    using Point = SimplexPoint<dim>;
    static constexpr int nCorners = 1 << dim;

    struct Part
    {
        const Shape* shape;
        double depth;
        double largestError;    // of linear distances [m]; that of the volume goes with its square, and small parts have little of it
        bool isPlane;
    };

    struct Cell
    {
        Vec3 centre;
        double half;                // of its side
        int nAround;                // parts that it lies in as a whole
        std::vector<int> parts;     // that it may lie in in part
    };

    /// A face that may pass through the cell.
    struct Face { int part, number; };

    struct CellFaces
    {
        std::vector<Face> faces;    // of one part after the other
        std::vector<int> end;       // of each part's faces
    };

    static int nFaces(const Part& part, const Vec3& x, double* distances)
    {
        if (const int n = part.shape->faceDistances(x, distances); n > 0) return n;
        distances[0] = part.shape->distance(x);
        return 1;
    }

    Vec3 corner(const Cell& cell, int c) const
    {
        Vec3 x = cell.centre;
        for (int d = 0; d < dim; ++d) x += (c >> d & 1 ? cell.half : -cell.half) * axes_[d];
        return x;
    }

    void visit(Cell& cell)
    {
        const CellFaces faces = findFaces(cell);
        if (cell.nAround + cell.parts.size() < 2) return;
        if (cell.parts.empty()) return addCell(cell);
        if (isCut(cell, faces)) return;
        Cell child{Vec3::Zero(), 0.5 * cell.half, 0, {}};
        for (int c = 0; c < nCorners; ++c)
        {
            child.centre = 0.5 * (cell.centre + corner(cell, c));
            child.nAround = cell.nAround;
            child.parts = cell.parts;
            visit(child);
        }
    }

    /// Leaves the parts whose surface may pass through the cell.
    CellFaces findFaces(Cell& cell) const
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

    bool isCut(const Cell& cell, const CellFaces& faces)
    {
        const double side = 2 * cell.half;
        bool isPlane = true, isSmall = true;
        for (const int i : cell.parts)
        {
            isPlane = isPlane && parts_[i].isPlane;
            if (!parts_[i].isPlane && side > parts_[i].depth) return false;
            isSmall = isSmall && side < smallestCell * parts_[i].depth;
        }
        findCornerValues(cell, faces);
        if (!isSmall && nDifferent(faces) > fewFaces) return false;
        findErrors(cell, faces, isPlane);
        if (!isPlane && !isLinear(cell, faces)) return false;
        cutCell(cell, faces);
        return true;
    }

    void readFaces(const CellFaces& faces, const Vec3& x, double* values) const
    {
        double distances[maxFaces];
        int of = -1;
        for (std::size_t f = 0; f < faces.faces.size(); ++f)
        {
            if (faces.faces[f].part != of) nFaces(parts_[of = faces.faces[f].part], x, distances);
            values[f] = distances[faces.faces[f].number];
        }
    }

    void findCornerValues(const Cell& cell, const CellFaces& faces)
    {
        const std::size_t n = faces.faces.size();
        values_.resize(n * nCorners);
        for (int c = 0; c < nCorners; ++c) readFaces(faces, corner(cell, c), &values_[c * n]);
        onFace_ = onFace * cell.half;
    }

    /// Faces of boxes in the same place are one.
    int nDifferent(const CellFaces& faces) const
    {
        const int n = static_cast<int>(faces.faces.size());
        int different = 0;
        for (int f = 0; f < n; ++f)
        {
            const auto isSame = [&](int g)
            {
                for (int c = 0; c < nCorners; ++c)
                    if (std::abs(values_[c * n + f] - values_[c * n + g]) > onFace_) return false;
                return true;
            };
            int g = 0;
            while (g < f && !isSame(g)) ++g;
            different += g == f;
        }
        return different;
    }

    /// By how much the faces' linear functions are too large in the mean of each simplex.
    void findErrors(const Cell& cell, const CellFaces& faces, bool isPlane)
    {
        const std::size_t n = faces.faces.size();
        errors_.assign(n * simplices_.size(), 0);
        if (isPlane) return;
        for (std::size_t s = 0; s < simplices_.size(); ++s)
        {
            Vec3 middle = Vec3::Zero();
            for (const int c : simplices_[s]) middle += corner(cell, c) / (dim + 1);
            double* errors = &errors_[s * n];
            readFaces(faces, middle, errors);
            for (std::size_t f = 0; f < n; ++f)
            {
                double mean = 0;
                for (const int c : simplices_[s]) mean += values_[c * n + f] / (dim + 1);
                errors[f] = (dim + 1.0) / (dim + 2) * (mean - errors[f]); // a quadratic function's mean error over that in the middle
                if (std::abs(errors[f]) < onFace_) errors[f] = 0;
            }
        }
    }

    /// Round faces bend little in the cell. Edges that the distance alone shows (STL) never do: there the volume in doubt decides.
    bool isLinear(const Cell& cell, const CellFaces& faces) const
    {
        const double side = 2 * cell.half;
        const std::size_t n = faces.faces.size();
        for (std::size_t i = 0; i < errors_.size(); ++i)
        {
            const double error = std::abs(errors_[i]);
            if (error > parts_[faces.faces[i % n].part].largestError && error * side * (dim == 2 ? 1 : extent_) > kinkError * volume_) return false;
        }
        return true;
    }

    void cutCell(const Cell& cell, const CellFaces& faces)
    {
        const std::size_t n = faces.faces.size();
        faces_ = &faces;
        simplexValues_.resize(n * (dim + 1));
        double volume = 1;
        for (int d = 0; d < dim; ++d) volume *= 2 * cell.half / (d + 1);
        Point whole[dim + 1] = {};
        for (int a = 0; a <= dim; ++a) whole[a].n[a] = 1;
        for (std::size_t s = 0; s < simplices_.size(); ++s)
        {
            for (int a = 0; a <= dim; ++a)
            {
                corners_[a] = corner(cell, simplices_[s][a]) - sum_.origin;
                for (std::size_t f = 0; f < n; ++f) simplexValues_[f * (dim + 1) + a] = values_[simplices_[s][a] * n + f] - errors_[s * n + f];
            }
            simplexVolume_ = volume;
            for (std::size_t f = 0; f < n; ++f)
                if (errors_[s * n + f] != 0) moveOntoSurface(faces.faces[f], &simplexValues_[f * (dim + 1)]);
            nextPart(whole, volume, 0, cell.nAround);
        }
    }

    /// Of a round face: adds to the linear function what the face's own distance is in the mean of its zero, so that volumes on both sides are right.
    void moveOntoSurface(const Face& face, double* values) const
    {
        int nPositive = 0;
        for (int a = 0; a <= dim; ++a) nPositive += values[a] > 0;
        if (nPositive == 0 || nPositive == dim + 1) return;
        const SimplexDivision<dim> division = divideSimplex<dim>(values);
        double area = 0, sum = 0;
        for (int k = 0; k < division.nFacets; ++k)
        {
            Vec3 x[dim];
            for (int i = 0; i < dim; ++i) x[i] = toSpace(division.facets[k].corner[i]) + sum_.origin;
            addMeanDistance(face, x, area, sum);
        }
        for (int a = 0; a <= dim && area > 0; ++a) values[a] += sum / area;
    }

    /// By quadrature of the second degree: two points of Gauss, the middles of three sides.
    void addMeanDistance(const Face& face, const Vec3* x, double& area, double& sum) const
    {
        const double own = dim == 2 ? ownCornerWeight<2> : 0.5;
        const double size = dim == 2 ? (x[1] - x[0]).norm() : 0.5 * (x[1] - x[0]).cross(x[dim - 1] - x[0]).norm();
        area += size;
        for (int i = 0; i < dim; ++i)
        {
            double distances[maxFaces];
            nFaces(parts_[face.part], own * x[i] + (1 - own) * x[(i + 1) % dim], distances);
            sum += size / dim * distances[face.number];
        }
    }

    Vec3 toSpace(const Point& p) const
    {
        Vec3 x = Vec3::Zero();
        for (int a = 0; a <= dim; ++a) x += p.n[a] * corners_[a];
        return x;
    }

    /// A piece of the simplex, in `nAround` of the parts before `part`.
    void nextPart(const Point* corners, double volume, std::size_t part, int nAround)
    {
        if (nAround + faces_->end.size() - part < 2) return;
        if (part == faces_->end.size()) return addPiece(corners, volume, nAround - 1);
        cutPiece(corners, volume, part, part == 0 ? 0 : faces_->end[part - 1], nAround);
    }

    double valueAt(int face, const Point& p) const
    {
        double value = 0;
        for (int a = 0; a <= dim; ++a) value += simplexValues_[face * (dim + 1) + a] * p.n[a];
        return std::abs(value) > onFace_ ? value : -1e-300;
    }

    /// A piece inside of all faces of the part before `face`.
    void cutPiece(const Point* corners, double volume, std::size_t part, int face, int nAround)
    {
        if (volume < negligiblePart * simplexVolume_) return;
        if (face == faces_->end[part]) return nextPart(corners, volume, part + 1, nAround + 1);
        double values[dim + 1];
        int nPositive = 0;
        for (int a = 0; a <= dim; ++a) nPositive += (values[a] = valueAt(face, corners[a])) > 0;
        if (nPositive == 0) return cutPiece(corners, volume, part, face + 1, nAround);
        if (nPositive == dim + 1) return nextPart(corners, volume, part + 1, nAround);
        forPieces(corners, volume, values, [&](const Point* piece, double v) { nextPart(piece, v, part + 1, nAround); });
        for (double& v : values) v = -v;
        forPieces(corners, volume, values, [&](const Point* piece, double v) { cutPiece(piece, v, part, face + 1, nAround); });
    }

    /// Where the values are positive.
    template <class Visit>
    static void forPieces(const Point* corners, double volume, const double* values, Visit visit)
    {
        const SimplexDivision<dim> division = divideSimplex<dim>(values);
        for (int k = 0; k < division.nParts; ++k)
        {
            Point piece[dim + 1] = {};
            for (int i = 0; i <= dim; ++i)
                for (int j = 0; j <= dim; ++j)
                    for (int a = 0; a <= dim; ++a) piece[i].n[a] += division.parts[k].corner[i].n[j] * corners[j].n[a];
            visit(piece, division.parts[k].share * volume);
        }
    }

    void addPiece(const Point* corners, double volume, int times)
    {
        Vec3 total = Vec3::Zero();
        Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
        for (int i = 0; i <= dim; ++i)
        {
            const Vec3 x = toSpace(corners[i]);
            total += x;
            squares += x * x.transpose();
        }
        sum_.volume += times * volume;
        sum_.first += times * volume / (dim + 1) * total;
        sum_.second += times * volume / ((dim + 1) * (dim + 2)) * (squares + total * total.transpose());
    }

    void addCell(const Cell& cell)
    {
        const Vec3 r = cell.centre - sum_.origin;
        const double volume = (cell.nAround - 1) * std::pow(2 * cell.half, dim);
        sum_.volume += volume;
        sum_.first += volume * r;
        sum_.second += volume * r * r.transpose();
        for (const Vec3& axis : axes_) sum_.second += volume * cell.half * cell.half / 3 * axis * axis.transpose();
    }

    std::vector<Part> parts_;
    std::array<Vec3, dim> axes_;
    std::vector<std::array<int, dim + 1>> simplices_;
    double volume_;         // of all shapes, 2D: area
    double extent_ = 0;     // of all cells
    RawMoments sum_;

    // of the cell that is cut
    std::vector<double> values_;            // corner by corner
    std::vector<double> errors_;            // simplex by simplex
    const CellFaces* faces_ = nullptr;
    std::vector<double> simplexValues_;     // face by face
    Vec3 corners_[dim + 1];                 // from the origin of the sums
    double simplexVolume_ = 0, onFace_ = 0;
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
