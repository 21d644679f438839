// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/nodeFaces.hpp"

#include <algorithm>

namespace flotsam
{

void NodeFaces::clear()
{
    for (const Block& block : blocks_) position_[block.node] = -1;
    blocks_.clear();
    rows_.clear();
}

int NodeFaces::find(int node, const Solid& solid)
{
    int last = -1;
    for (int b = position_[node]; b >= 0; b = blocks_[b].next)
    {
        const Block& block = blocks_[b];
        for (int k = 0; k < block.n; ++k)
            if (block.solid[k] == &solid) return block.row[k];
        last = b;
    }
    return add(node, solid, last);
}

/// last: block of the node, -1: it has none.
int NodeFaces::add(int node, const Solid& solid, int last)
{
    if (last < 0 || blocks_[last].n == Block::size)
    {
        (last < 0 ? position_[node] : blocks_[last].next) = static_cast<int>(blocks_.size());
        last = static_cast<int>(blocks_.size());
        blocks_.push_back({{}, {}, node, 0, -1});
    }
    const int row = static_cast<int>(rows_.size());
    for (int part = 0; part < solid.shape->nParts(); ++part) evaluate(rows_.emplace_back(), node, solid, part);
    Block& block = blocks_[last];
    block.solid[block.n] = &solid;
    block.row[block.n++] = row;
    return row;
}

double NodeFaces::distance(int node, const Solid& solid)
{
    const int row = find(node, solid);
    double least = 1e300;
    for (int k = row; k < row + solid.shape->nParts(); ++k) least = std::min(least, *std::max_element(distances(k), distances(k) + nFaces(k)));
    return least;
}

void NodeFaces::evaluate(Row& row, int node, const Solid& solid, int number) const
{
    const SolidPart part(solid, number);
    const auto x = mesh_.spacePoint(node);
    const Vec3 place(x[0], x[1], x[2]);
    row.nFaces = part.faceDistances(place, row.distances);
    if (row.nFaces > 0)
    {
        film_.lift(node, part, row.nFaces, row.distances);
        film_.join(node, part, row.nFaces, row.distances);
    }
    else
    {
        row.nFaces = 1;
        row.distances[0] = film_.joined(node, part, std::max(part.plainDistance(place) - part.offsetAt(place), film_.thickness(node, part)));
    }
    for (int k = 0; k < row.nFaces; ++k) row.distances[k] = snapped(row.distances[k], snap_[node]);
}

} // namespace flotsam
