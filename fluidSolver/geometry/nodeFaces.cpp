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
    int& position = position_[node];
    if (position >= 0 && rows_[position].solid == &solid) return position;
    position = static_cast<int>(rows_.size());
    evaluate(rows_.emplace_back(Row{&solid, node, 0, {}}));
    return position;
}

void NodeFaces::evaluate(Row& row) const
{
    const auto x = mesh_.spacePoint(row.node);
    const Vec3 place(x[0], x[1], x[2]);
    row.nFaces = row.solid->faceDistances(place, row.distances);
    if (row.nFaces > 0)
    {
        film_.lift(row.node, *row.solid, row.nFaces, row.distances);
        film_.join(row.node, *row.solid, row.nFaces, row.distances);
    }
    else
    {
        row.nFaces = 1;
        row.distances[0] = film_.joined(row.node, *row.solid, std::max(row.solid->distance(place), film_.thickness(row.node, *row.solid)));
    }
    for (int k = 0; k < row.nFaces; ++k) row.distances[k] = snapped(row.distances[k], snap_[row.node]);
}

} // namespace flotsam
