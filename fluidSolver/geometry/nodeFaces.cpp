// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/nodeFaces.hpp"

#include <algorithm>

namespace flotsam
{

void NodeFaces::clear()
{
    for (const Row& row : rows_) position_[row.node] = -1;
    rows_.clear();
}

int NodeFaces::find(int node, const Solid& solid)
{
    for (int row = position_[node]; row >= 0; row = rows_[row].next)
        if (rows_[row].solid == &solid) return row;
    const int newest = static_cast<int>(rows_.size());
    for (int part = 0; part < solid.shape->nParts(); ++part) evaluate(rows_.emplace_back(Row{&solid, node, position_[node], 0, {}}), part);
    return position_[node] = newest;
}

double NodeFaces::distance(int node, const Solid& solid)
{
    const int row = find(node, solid);
    double least = 1e300;
    for (int k = row; k < row + solid.shape->nParts(); ++k) least = std::min(least, *std::max_element(distances(k), distances(k) + nFaces(k)));
    return least;
}

void NodeFaces::evaluate(Row& row, int number) const
{
    const SolidPart part(*row.solid, number);
    const auto x = mesh_.spacePoint(row.node);
    const Vec3 place(x[0], x[1], x[2]);
    row.nFaces = part.faceDistances(place, row.distances);
    if (row.nFaces > 0)
    {
        film_.lift(row.node, part, row.nFaces, row.distances);
        film_.join(row.node, part, row.nFaces, row.distances);
    }
    else
    {
        row.nFaces = 1;
        row.distances[0] = film_.joined(row.node, part, std::max(part.plainDistance(place) - part.offsetAt(place), film_.thickness(row.node, part)));
    }
    for (int k = 0; k < row.nFaces; ++k) row.distances[k] = snapped(row.distances[k], snap_[row.node]);
}

} // namespace flotsam
