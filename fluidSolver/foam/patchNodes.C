// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/patchNodes.H"

#include "core/patchFaces.hpp"
#include "equations/faceMoments.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

/// Owned nodes know all faces of the patch that hold them; the halo copies learn it from their owners.
std::vector<int> nodesOf(const SimplexMesh& mesh, const Halo& halo, const MeshPatch& patch)
{
    std::vector<int> flag(mesh.nNodes, 0);
    for (int n : patch.faceNodes) flag[n] = 1;
    halo.update(flag, 1);
    std::vector<int> nodes;
    for (int i = 0; i < mesh.nNodes; ++i)
        if (flag[i]) nodes.push_back(i);
    return nodes;
}

std::vector<double> normalsOf(const SimplexMesh& mesh, const Halo& halo, const MeshPatch& patch, const std::vector<int>& nodes)
{
    const int dim = mesh.dim;
    std::vector<double> sum(static_cast<std::size_t>(mesh.nNodes)*dim, 0.0);
    for (std::size_t f = 0; f < patch.faceElement.size(); ++f)
    {
        double a[3];
        outwardVector(mesh, patch, f, a);
        for (int k = 0; k < dim; ++k)
            for (int d = 0; d < dim; ++d) sum[patch.faceNodes[f*dim + k]*dim + d] += a[d];
    }
    halo.update(sum, dim);
    std::vector<double> normal;
    for (int i : nodes)
    {
        double length = 0;
        for (int d = 0; d < dim; ++d) length += sum[i*dim + d]*sum[i*dim + d];
        length = std::sqrt(length);
        for (int d = 0; d < dim; ++d) normal.push_back(length > 0 ? sum[i*dim + d]/length : 0);
    }
    return normal;
}

/// int share u.n over the fluid part of face f.
template<int D>
double faceOutflow(const PatchNodes& patch, std::size_t f, const std::vector<double>& velocity, const std::vector<double>& share, const Cover* cover)
{
    const int* corners = &patch.faceNodes[f*D];
    int nodes[D];
    for (int k = 0; k < D; ++k) nodes[k] = patch.nodes[corners[k]];
    const FaceMoments<D> moments(*patch.mesh, cover, patch.faceElement[f], nodes);
    double sum = 0;
    for (int ab = 0; ab < D*D; ++ab)
        for (int d = 0; d < D; ++d) sum += share[corners[ab/D]]*moments.second[ab]*velocity[std::size_t(corners[ab%D])*D + d]*patch.faceArea[f*D + d];
    return sum;
}

} // namespace

PatchNodes makePatchNodes(const SimplexMesh& mesh, const Halo& halo, const MeshPatch& patch)
{
    PatchNodes result;
    result.mesh = &mesh;
    result.nodes = nodesOf(mesh, halo, patch);
    result.normal = normalsOf(mesh, halo, patch, result.nodes);
    for (std::size_t f = 0; f < patch.faceElement.size(); ++f)
    {
        int corners[3];
        for (int k = 0; k < mesh.dim; ++k)
            corners[k] = static_cast<int>(std::lower_bound(result.nodes.begin(), result.nodes.end(), patch.faceNodes[f*mesh.dim + k]) - result.nodes.begin());
        result.facesAtNodes.insert(result.facesAtNodes.end(), corners, corners + mesh.dim);
        if (!patch.isOwnedFace[f]) continue;
        result.faceElement.push_back(patch.faceElement[f]);
        result.faceNodes.insert(result.faceNodes.end(), corners, corners + mesh.dim);
        double a[3];
        outwardVector(mesh, patch, f, a);
        for (int d = 0; d < mesh.dim; ++d) result.faceArea.push_back(a[d]*(mesh.dim == 2 ? mesh.thickness : 1.0));
    }
    return result;
}

std::vector<double> PatchNodes::largestAround(const Halo& halo, const std::vector<double>& values) const
{
    const std::size_t dim = mesh->dim;
    std::vector<double> largest(mesh->nNodes, 0.0);
    for (std::size_t k = 0; k < nodes.size(); ++k) largest[nodes[k]] = values[k];
    for (std::size_t f = 0; f*dim < facesAtNodes.size(); ++f)
        for (std::size_t k = 0; k < dim*dim; ++k)
        {
            double& l = largest[nodes[facesAtNodes[f*dim + k/dim]]];
            l = std::max(l, values[facesAtNodes[f*dim + k%dim]]);
        }
    halo.update(largest, 1);
    std::vector<double> result;
    for (int i : nodes) result.push_back(largest[i]);
    return result;
}

double PatchNodes::outflow(const std::vector<double>& velocity, const std::vector<double>& share, const Cover* cover) const
{
    double sum = 0;
    for (std::size_t f = 0; f*mesh->dim < faceNodes.size(); ++f)
        sum += mesh->dim == 2 ? faceOutflow<2>(*this, f, velocity, share, cover) : faceOutflow<3>(*this, f, velocity, share, cover);
    return sum;
}

double PatchNodes::area() const
{
    const int dim = mesh->dim;
    double sum = 0;
    for (std::size_t f = 0; f*dim < faceArea.size(); ++f)
    {
        double square = 0;
        for (int d = 0; d < dim; ++d) square += faceArea[f*dim + d]*faceArea[f*dim + d];
        sum += std::sqrt(square);
    }
    return sum;
}

} // namespace flotsam
