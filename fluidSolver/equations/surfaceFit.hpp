// SPDX-License-Identifier: GPL-3.0-or-later
/// What the least-squares fits of the free surface to the means of a dual cell and of its neighbours share (frontFit.hpp, filmFit.hpp):
/// a surface of second degree, s = c + b.z + z.K z/2, with s along a direction near its normal and z across it.
#pragma once

#include <Eigen/Core>

#include <cmath>

namespace flotsam
{

/// Values of four cells, with which the processor computes several at once.
using Lanes = Eigen::Array4d;
/// Cells that a fit can take.
constexpr int maxSamples = 128, nLanes = 4, maxGroups = maxSamples/nLanes;

/// Sum over the cells of n groups.
inline double sumOfProducts(const Lanes* a, const Lanes* b, int n)
{
    Lanes sum = a[0]*b[0];
    for (int g = 1; g < n; ++g)
    {
        sum += a[g]*b[g];
    }
    return sum.sum();
}

/// A dual cell: its centroid in units of the fitted cell's thickness h along the direction, and the mean of a phase.
struct SurfaceSample
{
    double across, along[2];    ///< s and z
    double thickness, growth;   ///< of the slab with the cell's second moment, over delta; exp(thickness/2), for films
    double alpha;
};

/// Unknowns of a surface: c, b, K (upper triangle, row by row).
template<int dim>
struct SurfaceShape
{
    static constexpr int tangents = dim - 1, tilt = 1, curvature = 1 + tangents, size = curvature + tangents*dim/2;

    /// Derivatives of s by the unknowns.
    static void derivatives(const double* along, double* shape)
    {
        shape[0] = 1;
        int k = curvature;
        for (int d = 0; d < tangents; ++d)
        {
            shape[tilt + d] = along[d];
            for (int c = d; c < tangents; ++c)
            {
                shape[k++] = along[d]*along[c]*(c == d ? 0.5 : 1);
            }
        }
    }
};

/// Largest curvature [1/h] that one cell resolves: more is not a surface, but a corner or an end.
constexpr double largestCurvature = 0.25;
/// What the means leave undetermined (curvature, taper) is kept at zero by this much of a cell's weight.
constexpr double surfaceRidge = 1e-3;

/// Elimination without pivots, upper triangle only: the matrix is symmetric and positive definite. Unrolled: most loops are shorter than what it
/// takes to begin them.
template<int n>
void solveSymmetric(double (&a)[n][n], double (&b)[n])
{
#pragma GCC unroll 16
    for (int k = 0; k < n; ++k)
    {
        const double inverse = 1/a[k][k];
#pragma GCC unroll 16
        for (int r = k + 1; r < n; ++r)
        {
            const double factor = a[k][r]*inverse;
#pragma GCC unroll 16
            for (int c = r; c < n; ++c)
            {
                a[r][c] -= factor*a[k][c];
            }
            b[r] -= factor*b[k];
        }
    }
#pragma GCC unroll 16
    for (int k = n - 1; k >= 0; --k)
    {
#pragma GCC unroll 16
        for (int c = k + 1; c < n; ++c)
        {
            b[k] -= a[k][c]*b[c];
        }
        b[k] /= a[k][k];
    }
}

template<int dim>
void normalise(double (&v)[dim])
{
    double square = 1e-300;
    for (const double x : v)
    {
        square += x*x;
    }
    for (double& x : v)
    {
        x /= std::sqrt(square);
    }
}

/// The further axes of an orthonormal frame with the unit vector axes[0].
template<int dim>
void completeAxes(double (&axes)[dim][dim])
{
    const double* m = axes[0];
    if constexpr (dim == 2)
    {
        axes[1][0] = -m[1];
        axes[1][1] = m[0];
    }
    else
    {
        const bool isAlongX = std::abs(m[0]) > 0.6;
        axes[1][0] = isAlongX ? -m[2] : 0;
        axes[1][1] = isAlongX ? 0 : m[2];
        axes[1][2] = isAlongX ? m[0] : -m[1];
        normalise(axes[1]);
        for (int d = 0; d < 3; ++d)
        {
            const int b = (d + 1) % 3, c = (d + 2) % 3;
            axes[2][d] = m[b]*axes[1][c] - m[c]*axes[1][b];
        }
    }
}

} // namespace flotsam
