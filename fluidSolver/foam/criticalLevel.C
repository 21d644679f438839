// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/criticalLevel.H"

#include "equations/faceMoments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flotsam
{

namespace
{

double dot(const double* a, const double* b, int dim)
{
    double sum = 0;
    for (int d = 0; d < dim; ++d) sum += a[d]*b[d];
    return sum;
}

} // namespace

CriticalLevel::CriticalLevel(const PatchNodes& patch, const Halo& halo, const std::array<double, 3>& gravity)
:   patch_(patch), halo_(halo), height_(patch.nodes.size(), 0.0), size_(patch.nodes.size(), 0.0)
{
    const SimplexMesh& mesh = *patch.mesh;
    const int dim = mesh.dim;
    double whole[3], along[4] = {};     // of gravity what lies in the faces, mean over them; their area
    for (int d = 0; d < dim; ++d) whole[d] = gravity[mesh.axes[d]];
    for (std::size_t f = 0; f < patch.faceArea.size(); f += dim)
    {
        const double *faceArea = &patch.faceArea[f], area = std::sqrt(dot(faceArea, faceArea, dim));
        if (area <= 0) continue;
        for (int d = 0; d < dim; ++d) along[d] += area*whole[d] - dot(whole, faceArea, dim)/area*faceArea[d];
        along[3] += area;
    }
    halo.sum(along, 4);
    if (along[3] <= 0) return;
    for (int d = 0; d < dim; ++d) along[d] /= along[3];
    const double inPlane = std::sqrt(dot(along, along, dim)), strength = std::sqrt(dot(whole, whole, dim));
    if (inPlane < 1e-6*strength || strength == 0) return;
    gravity_ = inPlane;
    lowest_ = 1e300;
    highest_ = -1e300;
    for (std::size_t k = 0; k < height_.size(); ++k)
    {
        height_[k] = -dot(&mesh.x[std::size_t(patch.nodes[k])*dim], along, dim)/inPlane;
        lowest_ = std::min(lowest_, height_[k]);
        highest_ = std::max(highest_, height_[k]);
    }
    lowest_ = -halo.max(-lowest_);
    highest_ = halo.max(highest_);
    const std::vector<double> top = patch.largestAround(halo, height_);
    for (std::size_t k = 0; k < height_.size(); ++k) size_[k] = -height_[k];
    const std::vector<double> bottom = patch.largestAround(halo, size_);
    for (std::size_t k = 0; k < height_.size(); ++k) size_[k] = std::max(top[k] - height_[k], bottom[k] + height_[k]);
}

/// Share of the node's part of the patch below a level: linear over the size of its elements, so that the areas of all are linear in the level where their sizes are equal.
double CriticalLevel::below(double level, std::size_t node) const
{
    return std::clamp(0.5 + (level - height_[node])/size_[node], 0.0, 1.0);
}

/// Across the stream, which enters along the normals of the nodes, below equidistant levels from the lowest to the highest node [m^2]. Not across the patch's mean normal: a patch at
/// both ends of a channel has none.
std::array<double, CriticalLevel::nLevels> CriticalLevel::areas(const Cover* cover) const
{
    const int dim = patch_.mesh->dim;
    std::array<double, nLevels> result{};
    const auto addFace = [&](std::size_t f, const double* shares)
    {
        for (int k = 0; k < dim; ++k)
        {
            const std::size_t node = patch_.faceNodes[f*dim + k];
            const double across = dot(&patch_.faceArea[f*dim], &patch_.normal[node*dim], dim);
            for (int m = 0; m < nLevels; ++m) result[m] += across*shares[k]*below(lowest_ + (highest_ - lowest_)*m/(nLevels - 1), node);
        }
    };
    for (std::size_t f = 0; f*dim < patch_.faceNodes.size(); ++f)
    {
        int nodes[3];
        for (int k = 0; k < dim; ++k) nodes[k] = patch_.nodes[patch_.faceNodes[f*dim + k]];
        const SimplexMesh& mesh = *patch_.mesh;
        const int e = patch_.faceElement[f];
        dim == 2 ? addFace(f, FaceMoments<2>(mesh, cover, e, nodes).first) : addFace(f, FaceMoments<3>(mesh, cover, e, nodes).first);
    }
    halo_.sum(result.data(), nLevels);
    return result;
}

/// Height [m] of the critical level: Q^2 dA/dz - g A^3 changes its sign; infinite where the whole patch is too small.
double CriticalLevel::of(double flow, const Cover* cover) const
{
    const auto area = areas(cover);
    const double step = (highest_ - lowest_)/(nLevels - 1);
    const auto excess = [&](int m)
    {
        const int low = std::max(m - 1, 0), high = std::min(m + 1, nLevels - 1);
        return flow*flow*(area[high] - area[low])/((high - low)*step) - gravity_*area[m]*area[m]*area[m];
    };
    int last = nLevels - 1;
    while (last > 0 && excess(last) <= 0) --last;
    if (last == nLevels - 1) return std::numeric_limits<double>::infinity();
    return lowest_ + step*(last + std::clamp(excess(last)/(excess(last) - excess(last + 1)), 0.0, 1.0));
}

bool CriticalLevel::raise(double flow, const Cover* cover, std::vector<double>& alpha) const
{
    if (flow <= 0 || gravity_ == 0) return false;
    const double level = of(flow, cover);
    bool wasLower = false;
    for (std::size_t k = 0; k < alpha.size(); ++k)
    {
        const double least = below(level, k);
        wasLower = wasLower || least > alpha[k] + 0.5;
        alpha[k] = std::max(alpha[k], least);
    }
    return halo_.any(wasLower);
}

} // namespace flotsam
