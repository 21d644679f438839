// SPDX-License-Identifier: GPL-3.0-or-later
/// Meshes of boxes for tests: simplices on a regular grid, distributed as SimplexMesh demands.
#pragma once

#include "core/simplexMesh.hpp"

#include <mpi.h>

#include <array>

namespace flotsam
{

/// Collective. Two triangles (dim 2) or six Kuhn tetrahedra (dim 3) a cell, geometry computed. Patches xMin xMax yMin
/// yMax (zMin zMax) of type patch. Ranks own slabs of node planes x = const; needs cells[0]+1 >= ranks.
/// originalNode: lexicographic, x fastest: i + (nx+1)(j + (ny+1)k); it differs from globalNode on more than one rank.
/// dim 2: axes 0 1 2, planeOffset and thickness from lower[2], upper[2] when they differ, else 0 and 1; cells[2] is ignored.
/// perturbation: largest displacement of the interior nodes as a fraction of the cell size in each direction (keep it
/// below 0.2), from a hash of originalNode and seed: the same mesh on any number of ranks.
/// alternateDiagonals: mirrors every second cell in each direction (no preferred diagonal; still conforming).
SimplexMesh makeBoxMesh(MPI_Comm comm, int dim, std::array<int, 3> cells, std::array<double, 3> lower,
    std::array<double, 3> upper, double perturbation = 0, bool alternateDiagonals = false, int seed = 0);

} // namespace flotsam
