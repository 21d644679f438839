// SPDX-License-Identifier: GPL-3.0-or-later
/// Distances of the faces of solids at nodes, evaluated once: the many elements at an edge share them.
#pragma once

#include "geometry/wallFilm.hpp"

#include <array>
#include <cmath>

namespace flotsam
{

/// A node nearer to a surface than `snap` counts as solid.
inline double snapped(double distance, double snap) { return std::abs(distance) < snap ? -snap : distance; }

class NodeFaces
{
public:
    /// Keeps references. snap: nNodes, distance that counts as solid [m].
    NodeFaces(const SimplexMesh& mesh, const WallFilm& film, const std::vector<double>& snap)
        : mesh_(mesh), film_(film), snap_(snap), position_(mesh.nNodes, -1) {}

    /// To be called when solids have moved.
    void clear();

    /// Row of a solid's first part at a node, those of the other parts follow; valid until clear().
    int find(int node, const Solid& solid);

    /// As the cut sees them: SolidPart::faceDistances, of shapes without faces their distance, off the walls, never 0. Valid until find().
    const double* distances(int row) const { return rows_[row].distances; }
    int nFaces(int row) const { return rows_[row].nFaces; }

    /// Of the solid: the largest distance of the faces of the part where that is least.
    double distance(int node, const Solid& solid);

private:
    struct Row { int nFaces; double distances[maxFaces]; };
    /// Solids at a node and their rows, side by side: most of a search in many bodies would be the way to rows that are not wanted.
    struct alignas(64) Block
    {
        static constexpr int size = 4;
        std::array<const Solid*, size> solid;
        std::array<int, size> row;
        int node, n, next;      // next: block that goes on, -1: none
    };

    int add(int node, const Solid& solid, int last);
    void evaluate(Row& row, int node, const Solid& solid, int part) const;

    const SimplexMesh& mesh_;
    const WallFilm& film_;
    const std::vector<double>& snap_;
    std::vector<int> position_;     // nNodes: of the first block, -1: none
    std::vector<Block> blocks_;
    std::vector<Row> rows_;
};

} // namespace flotsam
