// SPDX-License-Identifier: GPL-3.0-or-later
/// Matrix of the fluid unknowns on the node graph: per entry a velocity block, gradient column, divergence row and pressure value,
/// each kind in an array of its own, so that the preconditioner's products with the gradient or the divergence alone read only those.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace flotsam
{

struct BlockMatrix
{
    std::vector<double> velocity;   ///< entries*dim*dim, row-major
    std::vector<double> gradient;   ///< entries*dim: momentum rows, pressure column
    std::vector<double> divergence; ///< entries*dim: continuity row, velocity columns
    std::vector<double> pressure;   ///< entries

    void resize(std::size_t entries, int dim)
    {
        velocity.resize(entries*dim*dim);
        gradient.resize(entries*dim);
        divergence.resize(entries*dim);
        pressure.resize(entries);
    }

    /// Entries begin to end - 1.
    void setZero(std::size_t begin, std::size_t end, int dim)
    {
        const auto fill = [&](std::vector<double>& a, std::size_t width) { std::fill(a.begin() + begin*width, a.begin() + end*width, 0.0); };
        fill(velocity, std::size_t(dim)*dim);
        fill(gradient, dim);
        fill(divergence, dim);
        fill(pressure, 1);
    }

    /// Adds a block of (D+1)^2 values, row-major, velocity first.
    template<int D> void add(std::size_t entry, const double* block)
    {
        constexpr int B = D + 1;
        double *k = &velocity[entry*D*D], *g = &gradient[entry*D], *d = &divergence[entry*D];
        for (int r = 0; r < D; ++r)
        {
            for (int c = 0; c < D; ++c) k[r*D + c] += block[r*B + c];
            g[r] += block[r*B + D];
            d[r] += block[D*B + r];
        }
        pressure[entry] += block[D*B + D];
    }
};

} // namespace flotsam
