// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/volumeFlux.hpp"

#include <algorithm>

namespace flotsam
{

VolumeFlux::VolumeFlux(const SimplexMesh& mesh, const NodeGraph& graph)
    : mesh_(mesh), neighbour_(std::size_t(mesh.nElements)*(mesh.dim + 1), -1), atEdge_(mesh.nElements, 0)
{
    const int n = mesh.dim + 1;
    for (const InteriorFace& face : graph.faces)
    {
        for (int side = 0; side < 2; ++side)
        {
            const int* nodes = &mesh.elements[std::size_t(face.element[side])*n];
            const auto corner = std::find(nodes, nodes + n, face.opposite[side]) - nodes;
            neighbour_[std::size_t(face.element[side])*n + corner] = face.element[1 - side];
        }
    }
    for (std::size_t k = 0; k < neighbour_.size(); ++k)
    {
        if (neighbour_[k] < 0)
        {
            atEdge_[k/n] |= char(1 << k%n);
        }
    }
}

double VolumeFlux::row(int e, int corner, const std::vector<double>& u, const std::vector<double>& fineScale, const Cover* cover) const
{
    const int dim = mesh_.dim, n = dim + 1;
    const ElementState state = cover ? cover->state[e] : ElementState::Fluid;
    if (state == ElementState::Solid)
    {
        return 0;
    }
    const CutElement* cut = state == ElementState::Cut ? &cover->cuts[cover->cutIndex[e]] : nullptr;
    const double* g = &mesh_.gradN[(std::size_t(e)*n + corner)*dim];
    double r = 0;
    for (int d = 0; d < dim; ++d)
    {
        double integral = fineScale.empty() ? 0 : fineScale[std::size_t(e)*dim + d]*(cut ? cut->volume : mesh_.volume[e]);
        for (int b = 0; b < n; ++b)
        {
            const double weight = cut ? cut->first[b] : mesh_.volume[e]/n;
            integral += weight*u[std::size_t(mesh_.elements[std::size_t(e)*n + b])*dim + d];
        }
        r -= g[d]*integral;
    }
    return r;
}

/// On a face with area vector S, int N_a u.n minus the flux through the share of a is, for linear u, a difference of
/// nodal values; between nodes a and b of the face it amounts to S.(u_a - u_b)/24 (2D), /54 (3D).
template<int dim>
void VolumeFlux::addOuterFaces(int e, const std::vector<double>& u, const Cover* cover, double* flux) const
{
    using Pairs = CornerPairs<dim>;
    constexpr int n = dim + 1;
    constexpr double factor = dim == 2 ? 1./24 : 1./54;
    for (int c = 0; c < n; ++c)
    {
        if (!isOuterFace(e, c, cover))
        {
            continue;
        }
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        const double* g = &mesh_.gradN[(std::size_t(e)*n + c)*dim];     // S = -dim V grad N_c, out of the element
        for (int k = 0; k < Pairs::count; ++k)
        {
            const int a = Pairs::first[k], b = Pairs::second[k];
            if (a == c || b == c)
            {
                continue;
            }
            double s = 0;
            for (int d = 0; d < dim; ++d)
            {
                s -= g[d]*(u[std::size_t(nodes[a])*dim + d] - u[std::size_t(nodes[b])*dim + d]);
            }
            flux[k] += factor*dim*mesh_.volume[e]*s;
        }
    }
}

template<int dim>
void VolumeFlux::ofElement(int e, const std::vector<double>& u, const std::vector<double>& fineScale, const Cover* cover,
    double* flux) const
{
    using Pairs = CornerPairs<dim>;
    constexpr int n = dim + 1;
    constexpr DualFaceWeights weights = DualFaceWeights::of(dim);
    if (cover && cover->state[e] != ElementState::Fluid)
    {
        double r[n];
        for (int a = 0; a < n; ++a)
        {
            r[a] = row(e, a, u, fineScale, cover);
        }
        for (int k = 0; k < Pairs::count; ++k)
        {
            flux[k] = (r[Pairs::first[k]] - r[Pairs::second[k]])/n;
        }
        return;
    }

    const int* nodes = &mesh_.elements[std::size_t(e)*n];
    const double* g = &mesh_.gradN[std::size_t(e)*n*dim];
    double base[dim];   // part of the velocity that all dual faces share
    for (int d = 0; d < dim; ++d)
    {
        double sum = 0;
        for (int a = 0; a < n; ++a)
        {
            sum += u[std::size_t(nodes[a])*dim + d];
        }
        base[d] = weights.far*sum + (fineScale.empty() ? 0 : fineScale[std::size_t(e)*dim + d]);
    }
    for (int k = 0; k < Pairs::count; ++k)
    {
        const int a = Pairs::first[k], b = Pairs::second[k];
        double s = 0;
        for (int d = 0; d < dim; ++d)
        {
            const double velocity = base[d]
                + (weights.near - weights.far)*(u[std::size_t(nodes[a])*dim + d] + u[std::size_t(nodes[b])*dim + d]);
            s += velocity*(g[b*dim + d] - g[a*dim + d]);
        }
        flux[k] = mesh_.volume[e]/n*s;
    }
    if (cover || atEdge_[e])
    {
        addOuterFaces<dim>(e, u, cover, flux);
    }
}

template void VolumeFlux::ofElement<2>(int, const std::vector<double>&, const std::vector<double>&, const Cover*, double*) const;
template void VolumeFlux::ofElement<3>(int, const std::vector<double>&, const std::vector<double>&, const Cover*, double*) const;

} // namespace flotsam
