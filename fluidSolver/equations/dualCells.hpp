// SPDX-License-Identifier: GPL-3.0-or-later
/// Median dual cells of a simplex mesh: around every node, the part of each element that is nearest to the node in
/// barycentric coordinates. Bounded by the planes through edge midpoints, face centroids and element centroids.
#pragma once

#include "core/nodeGraph.hpp"

#include <vector>

namespace flotsam
{

class Halo;
struct Cover;

/// Mean over the share of corner a in a simplex of the barycentric coordinates of the OTHER corners b, c.
/// The same for every simplex of the dimension.
struct ShareMoments
{
    double first;   ///< mean of lambda_b
    double square;  ///< mean of lambda_b^2
    double mixed;   ///< mean of lambda_b lambda_c, b != c

    static ShareMoments of(int dim);
};

/// Weights of the corners at the centroid of the dual face between corners a and b:
/// dual face = segment (2D) from the edge's midpoint to the element's centroid, or plane quadrilateral (3D).
struct DualFaceWeights
{
    double near;    ///< of a and of b
    double far;     ///< of the other corners

    static constexpr DualFaceWeights of(int dim)
    {
        return dim == 2 ? DualFaceWeights{5./12, 2./12} : DualFaceWeights{13./36, 5./36};
    }
};

/// Fluid volume of the dual cell of every local node [m^dim]: int of its shape function over the fluid part.
/// Complete for owned and first-ring nodes. cover may be null (no solids).
std::vector<double> dualVolumes(const SimplexMesh& mesh, const Cover* cover);
void findDualVolumes(const SimplexMesh& mesh, const Cover* cover, std::vector<double>& volume);

/// Centroid and second moments of the whole dual cells (solids ignored), for owned and first-ring nodes;
/// after complete() for all local nodes.
class DualCells
{
public:
    explicit DualCells(const SimplexMesh& mesh);

    /// Collective.
    void complete(const Halo& halo);

    int dim() const { return dim_; }
    double volume(int i) const { return volume_[i]; }                           ///< [m^dim]
    const double* centroid(int i) const { return &centroid_[std::size_t(i)*dim_]; }  ///< relative to the node, dim [m]

    /// Half the thickness of the slab normal to the unit vector n with the cell's second moment [m].
    double halfWidth(int i, const double* n) const;

    /// Mean over the cell of x.K x/2, x from its centroid; K symmetric: xx yy xy, in 3D xx yy zz xy xz yz.
    double meanBend(int i, const double* K) const;

private:
    int dim_;
    std::vector<double> volume_, centroid_;
    std::vector<double> second_;    // nNodes * {xx, yy, xy} or {xx, yy, zz, xy, xz, yz}: mean of products about the centroid [m^2]
};

} // namespace flotsam
