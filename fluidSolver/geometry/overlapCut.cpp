// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/overlapCut.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{
namespace
{

constexpr double kinkError = 2e-5;      // of the volume: that of cells along an edge which the distance alone shows
constexpr double onFace = 1e-13;        // over the side of the cell: faces in one plane

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

/// The part's distance where it has no plane faces.
void findFaceDistances(const Shape& shape, const Vec3& x, double* distances)
{
    if (shape.faceDistances(x, distances) == 0) distances[0] = shape.distance(x);
}

} // namespace

template <int dim>
OverlapCut<dim>::OverlapCut(const std::vector<OverlapPart>& parts, const std::array<Vec3, dim>& axes, double volume, RawMoments& sum)
    : parts_(parts), axes_(axes), simplices_(cellSimplices<dim>()), volume_(volume), sum_(sum)
{
}

template <int dim>
Vec3 OverlapCut<dim>::corner(const OverlapCell& cell, int c) const
{
    Vec3 x = cell.centre;
    for (int d = 0; d < dim; ++d) x += (c >> d & 1 ? cell.half : -cell.half) * axes_[d];
    return x;
}

template <int dim>
void OverlapCut<dim>::readFaces(const Vec3& x, double* values) const
{
    double distances[maxFaces];
    int of = -1;
    for (std::size_t f = 0; f < faces_->faces.size(); ++f)
    {
        const auto [part, number] = faces_->faces[f];
        if (part != of) findFaceDistances(*parts_[of = part].shape, x, distances);
        values[f] = distances[number];
    }
}

template <int dim>
void OverlapCut<dim>::set(const OverlapCell& cell, const CellFaces& faces)
{
    cell_ = &cell;
    faces_ = &faces;
    isPlane_ = std::all_of(cell.parts.begin(), cell.parts.end(), [&](int i) { return parts_[i].isPlane; });
    const std::size_t n = faces.faces.size();
    values_.resize(n * nCorners);
    for (int c = 0; c < nCorners; ++c) readFaces(corner(cell, c), &values_[c * n]);
    errors_.assign(n * simplices_.size(), 0);
    onFace_ = onFace * cell.half;
}

template <int dim>
int OverlapCut<dim>::nDifferentFaces() const
{
    const int n = static_cast<int>(faces_->faces.size());
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
template <int dim>
void OverlapCut<dim>::findErrors()
{
    const std::size_t n = faces_->faces.size();
    for (std::size_t s = 0; s < simplices_.size(); ++s)
    {
        Vec3 middle = Vec3::Zero();
        for (const int c : simplices_[s]) middle += corner(*cell_, c) / (dim + 1);
        double* errors = &errors_[s * n];
        readFaces(middle, errors);
        for (std::size_t f = 0; f < n; ++f)
        {
            double mean = 0;
            for (const int c : simplices_[s]) mean += values_[c * n + f] / (dim + 1);
            errors[f] = (dim + 1.0) / (dim + 2) * (mean - errors[f]); // a quadratic function's mean error over that in the middle
            if (std::abs(errors[f]) < onFace_) errors[f] = 0;
        }
    }
}

template <int dim>
bool OverlapCut<dim>::isLinear(double extent)
{
    if (isPlane_) return true;
    findErrors();
    const double side = 2 * cell_->half;
    const std::size_t n = faces_->faces.size();
    for (std::size_t i = 0; i < errors_.size(); ++i)
    {
        const double error = std::abs(errors_[i]);
        if (error > parts_[faces_->faces[i % n].part].largestError && error * side * (dim == 2 ? 1 : extent) > kinkError * volume_) return false;
    }
    return true;
}

template <int dim>
void OverlapCut<dim>::add()
{
    const std::size_t n = faces_->faces.size();
    simplexValues_.resize(n * (dim + 1));
    double volume = 1;
    for (int d = 0; d < dim; ++d) volume *= 2 * cell_->half / (d + 1);
    Point whole[dim + 1] = {};
    for (int a = 0; a <= dim; ++a) whole[a].n[a] = 1;
    for (std::size_t s = 0; s < simplices_.size(); ++s)
    {
        for (int a = 0; a <= dim; ++a)
        {
            corners_[a] = corner(*cell_, simplices_[s][a]) - sum_.origin;
            for (std::size_t f = 0; f < n; ++f) simplexValues_[f * (dim + 1) + a] = values_[simplices_[s][a] * n + f] - errors_[s * n + f];
        }
        simplexVolume_ = volume;
        for (std::size_t f = 0; f < n; ++f)
            if (errors_[s * n + f] != 0) moveOntoSurface(faces_->faces[f], &simplexValues_[f * (dim + 1)]);
        nextPart(whole, volume, 0, cell_->nAround);
    }
}

/// Of a round face: adds to the linear function what the face's own distance is in the mean of its zero, so that volumes on both sides are right.
template <int dim>
void OverlapCut<dim>::moveOntoSurface(const CellFaces::Face& face, double* values) const
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
template <int dim>
void OverlapCut<dim>::addMeanDistance(const CellFaces::Face& face, const Vec3* x, double& area, double& sum) const
{
    const double own = dim == 2 ? ownCornerWeight<2> : 0.5;
    const double size = dim == 2 ? (x[1] - x[0]).norm() : 0.5 * (x[1] - x[0]).cross(x[dim - 1] - x[0]).norm();
    area += size;
    for (int i = 0; i < dim; ++i)
    {
        double distances[maxFaces];
        findFaceDistances(*parts_[face.part].shape, own * x[i] + (1 - own) * x[(i + 1) % dim], distances);
        sum += size / dim * distances[face.number];
    }
}

template <int dim>
Vec3 OverlapCut<dim>::toSpace(const Point& p) const
{
    Vec3 x = Vec3::Zero();
    for (int a = 0; a <= dim; ++a) x += p.n[a] * corners_[a];
    return x;
}

/// A piece of the simplex, in `nAround` of the parts before `part`.
template <int dim>
void OverlapCut<dim>::nextPart(const Point* corners, double volume, std::size_t part, int nAround)
{
    if (nAround + faces_->end.size() - part < 2) return;
    if (part == faces_->end.size()) return addPiece(corners, volume, nAround - 1);
    cutPiece(corners, volume, part, part == 0 ? 0 : faces_->end[part - 1], nAround);
}

template <int dim>
double OverlapCut<dim>::valueAt(int face, const Point& p) const
{
    double value = 0;
    for (int a = 0; a <= dim; ++a) value += simplexValues_[face * (dim + 1) + a] * p.n[a];
    return std::abs(value) > onFace_ ? value : -1e-300;
}

/// A piece inside of all faces of the part before `face`.
template <int dim>
void OverlapCut<dim>::cutPiece(const Point* corners, double volume, std::size_t part, int face, int nAround)
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
template <int dim>
template <class Visit>
void OverlapCut<dim>::forPieces(const Point* corners, double volume, const double* values, Visit visit)
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

template <int dim>
void OverlapCut<dim>::addPiece(const Point* corners, double volume, int times)
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

template class OverlapCut<2>;
template class OverlapCut<3>;

} // namespace flotsam
