// SPDX-License-Identifier: GPL-3.0-or-later
/// What planes leave of a tetrahedron, as a polyhedron: one polygon a face instead of the many pieces that a division into simplices makes of it. Private to geometry.
#pragma once

#include "geometry/simplexDivision.hpp"

namespace flotsam
{

class ClippedSimplex
{
public:
    ClippedSimplex();

    /// Keeps the part where a linear function (by its values at the tetrahedron's corners, none zero) is negative. False: of what is left the corners' signs make no convex body, by round-off,
    /// or it has too many faces; it is void then. number: of the plane.
    bool clip(const double* values, int number);

    bool isEmpty() const { return nPolygons_ == 0; }

    /// Adds the moments; elementVolume: of the tetrahedron.
    void addTo(SimplexMoments<3>& moments, double elementVolume) const;

    /// visit(three corners, number of the plane) of triangles of the polygons on the planes.
    template <class Visit>
    void forFacets(Visit visit) const
    {
        for (int p = 0; p < nPolygons_; ++p)
        {
            const Polygon& polygon = polygons_[p];
            for (int k = 2; k < polygon.n && polygon.plane >= 0; ++k)
            {
                const Point corners[3] = {points_[polygon.corner[0]], points_[polygon.corner[k - 1]], points_[polygon.corner[k]]};
                visit(corners, polygon.plane);
            }
        }
    }

private:
    using Point = SimplexPoint<3>;
    static constexpr int maxPoints = 160, maxPolygons = 20, maxCorners = 20;

    /// Corners in cyclic order, seen from outside counterclockwise or clockwise as those of all others.
    struct Polygon
    {
        int plane;  // -1: a face of the tetrahedron
        int n;
        int corner[maxCorners];
    };
    /// What the plane at hand cuts.
    struct CutEdge { int from, to, point; };

    bool clip(const Polygon& whole, Polygon& part);
    int pointOn(int from, int to);
    bool addCap(int number);
    void evaluate(const double* values);

    int nPoints_, nPolygons_, nEdges_ = 0, nSegments_ = 0, nInside_ = 0, nOutside_ = 0;
    Point points_[maxPoints];
    double values_[maxPoints];      // of the function at hand
    bool isEvaluated_[maxPoints];
    Polygon polygons_[maxPolygons];
    CutEdge edges_[maxCorners];
    int segments_[maxCorners][2];   // sides of the new polygon, as this has them
};

} // namespace flotsam
