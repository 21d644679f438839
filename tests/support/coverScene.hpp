// SPDX-License-Identifier: GPL-3.0-or-later
/// A box of moved (or even) nodes, and solids for tests of covers.
#pragma once

#include "geometry/coverBuilder.hpp"
#include "support/boxMesh.hpp"

#include <array>

namespace flotsam
{

/// -1 to 1 in every direction.
struct CoverScene
{
    SimplexMesh mesh;
    NodeGraph graph;
    Halo halo;

    CoverScene(int dim, int n, MPI_Comm comm = MPI_COMM_WORLD) : CoverScene(dim, std::array{n, n, n}, comm) {}

    CoverScene(int dim, std::array<int, 3> n, MPI_Comm comm = MPI_COMM_WORLD, double moved = 0.15)
        : mesh(makeBoxMesh(comm, dim, n, {-1, -1, -1}, {1, 1, 1}, moved, true)), graph(mesh), halo(mesh, comm)
    {
    }
};

inline Solid makeSolid(std::shared_ptr<const Shape> shape, const Vec3& position, Solid::Kind kind)
{
    Solid s;
    s.kind = kind;
    s.shape = std::move(shape);
    s.pose.position = position;
    s.pose.orientation = Eigen::AngleAxisd(0.4, Vec3::UnitZ()) * Eigen::AngleAxisd(kind == Solid::Kind::Fixed ? 0 : 0.2, Vec3::UnitX());
    return s;
}

} // namespace flotsam
