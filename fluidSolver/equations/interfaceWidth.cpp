// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/interfaceWidth.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

/// Extent of an element along the unit vector `direction` (dim) [m].
double extentAlong(const SimplexMesh& mesh, int e, const double* direction)
{
    const int nCorners = mesh.dim + 1, *nodes = &mesh.elements[std::size_t(e)*nCorners];
    double least = 0, most = 0;     // from the first corner
    for (int a = 1; a < nCorners; ++a)
    {
        double along = 0;
        for (int d = 0; d < mesh.dim; ++d)
            along += direction[d]*(mesh.x[std::size_t(nodes[a])*mesh.dim + d] - mesh.x[std::size_t(nodes[0])*mesh.dim + d]);
        least = std::min(least, along);
        most = std::max(most, along);
    }
    return most - least;
}

} // namespace

std::vector<double> interfaceWidth(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, double factor, const std::array<double, 3>& gravity)
{
    double down[3] = {};
    const double size = std::hypot(gravity[0], gravity[1], gravity[2]);
    for (int d = 0; d < mesh.dim && size > 0; ++d) down[d] = gravity[mesh.axes[d]]/size;
    std::vector<double> width(mesh.nNodes, 0);
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        const int begin = graph.nodeElementStart[i], end = graph.nodeElementStart[i + 1];
        double length = 0, tallest = 0;
        for (int k = begin; k < end; ++k)
        {
            const int e = graph.nodeElement[k];
            length += mesh.h[e];
            tallest = std::max(tallest, extentAlong(mesh, e, down));
        }
        length /= end - begin;
        width[i] = factor*std::max(length, tallest - length);
    }
    halo.update(width, 1);
    return width;
}

} // namespace flotsam
