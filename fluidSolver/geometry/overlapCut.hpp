// SPDX-License-Identifier: GPL-3.0-or-later
/// Cells of space that several shapes may have in common, and the cut of one by their faces; private to geometry.
#pragma once

#include "geometry/simplexDivision.hpp"
#include "geometry/unionOverlap.hpp"

#include <array>
#include <vector>

namespace flotsam
{

struct OverlapPart
{
    const Shape* shape;
    double depth;           // about half of its thickness
    double largestError;    // of linear distances [m]; that of the volume goes with its square, and small parts have little of it
    bool isPlane;
};

struct OverlapCell
{
    Vec3 centre;
    double half;                // of its side
    int nAround;                // parts that it lies in as a whole
    std::vector<int> parts;     // that it may lie in in part
};

/// Faces that may pass through a cell.
struct CellFaces
{
    struct Face { int part, number; };

    std::vector<Face> faces;    // of one part after the other
    std::vector<int> end;       // of each part's faces
};

/// The cut of one cell after the other: the faces' distances are linear in each of its simplices, those of round faces moved by their mean error.
template <int dim>
class OverlapCut
{
public:
    static constexpr int nCorners = 1 << dim;

    /// axes: unit vectors of the cells' edges; volume: of all parts, 2D: area; extent: of all cells together. References are kept.
    OverlapCut(const std::vector<OverlapPart>& parts, const std::array<Vec3, dim>& axes, double volume, RawMoments& sum);

    Vec3 corner(const OverlapCell& cell, int c) const;

    /// The cell that the next calls are about.
    void set(const OverlapCell& cell, const CellFaces& faces);

    /// Faces without those in the same place (of boxes).
    int nDifferentFaces() const;

    /// Round faces bend little in the cell. Edges that the distance alone shows (STL) never do: there the volume in doubt decides.
    bool isLinear(double extent);

    /// Adds n - 1 times what lies in n > 1 parts to the sum.
    void add();

private:
    using Point = SimplexPoint<dim>;
    using Simplex = std::array<int, dim + 1>;

    void readFaces(const Vec3& x, double* values) const;
    void findErrors();
    void moveOntoSurface(const CellFaces::Face& face, double* values) const;
    void addMeanDistance(const CellFaces::Face& face, const Vec3* x, double& area, double& sum) const;
    Vec3 toSpace(const Point& p) const;
    void nextPart(const Point* corners, double volume, std::size_t part, int nAround);
    double valueAt(int face, const Point& p) const;
    void cutPiece(const Point* corners, double volume, std::size_t part, int face, int nAround);
    template <class Visit>
    static void forPieces(const Point* corners, double volume, const double* values, Visit visit);
    void addPiece(const Point* corners, double volume, int times);

    const std::vector<OverlapPart>& parts_;
    std::array<Vec3, dim> axes_;
    std::vector<Simplex> simplices_;
    double volume_;
    RawMoments& sum_;

    // of the cell
    const OverlapCell* cell_ = nullptr;
    const CellFaces* faces_ = nullptr;
    bool isPlane_ = true;
    double onFace_ = 0;
    std::vector<double> values_;            // corner by corner
    std::vector<double> errors_;            // simplex by simplex
    std::vector<double> simplexValues_;     // face by face
    Vec3 corners_[dim + 1];                 // of the simplex, from the origin of the sums
    double simplexVolume_ = 0;
};

} // namespace flotsam
