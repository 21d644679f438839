// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/innerPoints.H"

#include <algorithm>

namespace flotsam
{

/// Those of owned nodes, which see all of their elements; copies get values from their owners.
InnerPoints::InnerPoints(const PatchNodes& patch)
:   mesh_(*patch.mesh), nodes_(patch.nodes), outwards_(patch.normal), points_(nodes_.size()), least_(nodes_.size(), -1e300)
{
    const int corners = mesh_.dim + 1;
    std::vector<int> place(mesh_.nNodes, -1);
    for (std::size_t k = 0; k < nodes_.size(); ++k) place[nodes_[k]] = static_cast<int>(k);
    for (int e = 0; e < mesh_.nElements; ++e)
        for (int a = 0; a < corners; ++a)
            if (const int k = place[mesh_.elements[std::size_t(e)*corners + a]]; k >= 0) find(e, a, k);
    least_.clear();
}

/// The element holds the line if no shape function of its other corners falls along it; of several, where the line runs in a face, any.
void InnerPoints::find(int element, int corner, std::size_t node)
{
    const int dim = mesh_.dim, corners = dim + 1;
    double least = 1e300, sum = 0;
    Point point;
    for (int l = 0, n = 0; l < corners; ++l)
    {
        if (l == corner) continue;
        double slope = 0;
        for (int d = 0; d < dim; ++d) slope -= mesh_.gradN[(std::size_t(element)*corners + l)*dim + d]*outwards_[node*dim + d];
        least = std::min(least, slope);
        point.nodes[n] = mesh_.elements[std::size_t(element)*corners + l];
        point.weights[n++] = std::max(0.0, slope);
        sum += std::max(0.0, slope);
    }
    if (least <= least_[node] || sum <= 0) return;
    least_[node] = least;
    for (double& w : point.weights) w /= sum;
    points_[node] = point;
}

std::vector<double> InnerPoints::values(const Halo& halo, const double* nodal) const
{
    std::vector<double> inside(mesh_.nNodes, 0.0);
    for (std::size_t k = 0; k < nodes_.size(); ++k)
        for (int l = 0; l < mesh_.dim; ++l) inside[nodes_[k]] += points_[k].weights[l]*nodal[points_[k].nodes[l]];
    halo.update(inside, 1);
    std::vector<double> result;
    for (int i : nodes_) result.push_back(inside[i]);
    return result;
}

} // namespace flotsam
