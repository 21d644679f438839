// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/patchNodes.H"

#include "core/patchFaces.hpp"

#include "SubField.H"
#include "polyPatch.H"

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

} // namespace

PatchNodes makePatchNodes(const SimplexMesh& mesh, const Halo& halo, const MeshPatch& patch)
{
    PatchNodes result;
    result.mesh = &mesh;
    result.nodes = nodesOf(mesh, halo, patch);
    result.normal = normalsOf(mesh, halo, patch, result.nodes);
    for (std::size_t f = 0; f < patch.faceElement.size(); ++f)
    {
        if (!patch.isOwnedFace[f]) continue;
        double a[3];
        outwardVector(mesh, patch, f, a);
        for (int d = 0; d < mesh.dim; ++d) result.faceArea.push_back(a[d]*(mesh.dim == 2 ? mesh.thickness : 1.0));
        for (int k = 0; k < mesh.dim; ++k)
        {
            const auto at = std::lower_bound(result.nodes.begin(), result.nodes.end(), patch.faceNodes[f*mesh.dim + k]);
            result.faceNodes.push_back(static_cast<int>(at - result.nodes.begin()));
        }
    }
    return result;
}

double PatchNodes::outflow(const std::vector<double>& weight) const
{
    const int dim = mesh->dim;
    double sum = 0;
    for (std::size_t k = 0; k < faceNodes.size(); ++k)
    {
        const double* a = &faceArea[k/dim*dim];
        const double* n = &normal[static_cast<std::size_t>(faceNodes[k])*dim];
        for (int d = 0; d < dim; ++d) sum += weight[faceNodes[k]]*n[d]*a[d]/dim;
    }
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

std::vector<double> averageToNodes(const Foam::polyPatch& patch, const MeshAdapter& adapter, const Halo& halo,
    const std::vector<int>& nodes, const std::vector<double>& faceValues, int width)
{
    // deviations from one value, the same on every rank, so that uniform values come back unchanged
    std::vector<double> reference(width);
    for (int k = 0; k < width; ++k)
        reference[k] = halo.max(patch.size() ? faceValues[k] : -1e300);

    const SimplexMesh& mesh = adapter.mesh;
    std::vector<double> sum(static_cast<std::size_t>(mesh.nNodes)*(width + 1), 0.0);
    for (Foam::label f = 0; f < patch.size(); ++f)
    {
        const double area = Foam::mag(patch.faceAreas()[f]);
        for (const Foam::label point : patch[f])
        {
            double* s = &sum[static_cast<std::size_t>(adapter.pointNode[point])*(width + 1)];
            for (int k = 0; k < width; ++k) s[k] += area*(faceValues[f*width + k] - reference[k]);
            s[width] += area;
        }
    }
    halo.sumToOwners(sum, width + 1);
    halo.update(sum, width + 1);

    std::vector<double> result;
    result.reserve(nodes.size()*width);
    for (int i : nodes)
    {
        const double* s = &sum[static_cast<std::size_t>(i)*(width + 1)];
        for (int k = 0; k < width; ++k) result.push_back(reference[k] + (s[width] > 0 ? s[k]/s[width] : 0));
    }
    return result;
}

} // namespace flotsam
