// SPDX-License-Identifier: GPL-3.0-or-later
/// Where the free surface is, from a phase field whose values are means over dual cells.
#pragma once

#include "algebra/halo.hpp"
#include "equations/dualCells.hpp"

#include <memory>

namespace flotsam
{

/// A dual cell as a slab along the surface's normal, in widths of the profile: distance of its middle from the surface, thickness.
struct ProfileSlab
{
    double middle, thickness;

    double mean() const;    ///< of 1/(1+exp(-psi)) over the slab
    double slope() const;   ///< of mean() by middle
};

/// cells null: the profile's value at the node. distance: of the node from the surface [m]; normal: unit, into the liquid.
ProfileSlab profileSlab(const DualCells* cells, int i, const double* normal, double distance, double width);

class SurfaceLevel
{
public:
    /// gravity: space axes, any size; zero: none.
    SurfaceLevel(const SimplexMesh& mesh, const Halo& halo, const std::array<double, 3>& gravity = {});
    ~SurfaceLevel();

    /// level: distance of every node from the surface [m], positive in the liquid: width ln(alpha/(1-alpha)), alpha limited to [1e-5, 1 - 1e-5], as if alpha were
    /// the profile's value at the node. With cells alpha is its mean over the dual cell, as the transport moves it: the value at the node would let the
    /// surface lag behind or run ahead of what has flowed, by its place between the nodes (docs/numerics.md, section 2). The mean depends on the
    /// surface's direction, the gradient of the result: found by repetition near the surface, at most 12 times (at planes each leaves a quarter), until nothing changes by
    /// more than `tolerance` widths where alpha is 1/2, elsewhere by as much of alpha; nodes that do not converge are not waited for. It begins with the values at the
    /// nodes, in dual cells twice as tall along gravity as the cube of their volume and taller with those of a level surface. cells, cover: may be null.
    /// work: memory for nNodes, void before and after. Collective.
    void find(const std::vector<double>& alpha, const std::vector<double>& width, const DualCells* cells, const Cover* cover, double tolerance,
        std::vector<double>& work, std::vector<double>& level);

private:
    struct Arguments
    {
        const std::vector<double> &alpha, &width;
        const DualCells& cells;
        const Cover* cover;
        double tolerance;
    };
    struct Repeats;
    template<int D> class RepeatsIn;

    const SimplexMesh& mesh_;
    std::unique_ptr<Repeats> repeats_;
};

} // namespace flotsam
