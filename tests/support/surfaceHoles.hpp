// SPDX-License-Identifier: GPL-3.0-or-later
/// Holes in the surfaces of covers: of the fluid's, and of a body's with what others cover of it.
#pragma once

#include "core/patchFaces.hpp"
#include "equations/faceMoments.hpp"
#include "support/coverScene.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

/// Force of a uniform pressure on every node's row, but for that on the mesh's boundary, over the pressure.
inline std::vector<double> forceOfUniformPressure(const SimplexMesh& mesh, const Cover& cover)
{
    const int dim = mesh.dim;
    std::vector<double> force(std::size_t(mesh.nNodes) * dim, 0.0);
    for (int e = 0; e < mesh.nElements; ++e)
        for (int a = 0; a <= dim; ++a)
            for (int d = 0; d < dim; ++d)
                force[std::size_t(mesh.elements[std::size_t(e) * (dim + 1) + a]) * dim + d] += fluidVolume(mesh, &cover, e) * mesh.gradN[(std::size_t(e) * (dim + 1) + a) * dim + d];
    for (const CutFacet& f : cover.facets)
        for (int a = 0; a <= dim; ++a)
            for (int d = 0; d < dim; ++d)
                for (int q = 0; q < f.nPoints; ++q) force[std::size_t(mesh.elements[std::size_t(f.element) * (dim + 1) + a]) * dim + d] -= f.weight[q] * f.shape[q][a] * f.normal[d];
    return force;
}

/// Of the owned nodes where `counts`, over the mesh size.
template <class Counts>
double largestOwned(const CoverScene& scene, const std::vector<double>& force, double h, Counts counts)
{
    const int dim = scene.mesh.dim;
    double largest = 0;
    for (int i = 0; i < scene.mesh.nOwned; ++i)
        for (int d = 0; d < dim && counts(i); ++d) largest = std::max(largest, std::abs(force[std::size_t(i) * dim + d]) / std::pow(h, dim - 1));
    return scene.halo.max(largest);
}

/// On the rows of the nodes off the mesh's boundary: the fluid's surface is closed if there is none.
inline double largestHole(const CoverScene& scene, const Cover& cover, double h)
{
    std::vector<char> isBoundary(scene.mesh.nNodes, 0);
    for (const MeshPatch& patch : scene.mesh.patches)
        for (int i : patch.faceNodes) isBoundary[i] = 1;
    return largestOwned(scene, forceOfUniformPressure(scene.mesh, cover), h, [&](int i) { return !isBoundary[i]; });
}

/// On all rows, with what is fluid of the mesh's boundary.
template <int dim>
double largestHoleWithBoundary(const CoverScene& scene, const Cover& cover, double h)
{
    const SimplexMesh& mesh = scene.mesh;
    std::vector<double> force = forceOfUniformPressure(mesh, cover);
    for (const MeshPatch& patch : mesh.patches)
        for (std::size_t f = 0; f < patch.faceElement.size(); ++f)
        {
            const int* nodes = &patch.faceNodes[f * dim];
            const FaceMoments<dim> moments(mesh, &cover, patch.faceElement[f], nodes);
            double out[dim];
            outwardVector(mesh, patch, f, out);
            for (int k = 0; k < dim; ++k)
                for (int d = 0; d < dim; ++d) force[std::size_t(nodes[k]) * dim + d] -= moments.first[k] * out[d];
        }
    return largestOwned(scene, force, h, [](int) { return true; });
}

/// Integrals of (1, x) over a body's surface and what others cover of it, into the body [m^(dim-1), m^dim]; covered: sum of what is.
inline Eigen::Matrix<double, 4, 3> surfaceMoments(const CoverScene& scene, const Cover& cover, int solid, double& covered)
{
    const int dim = scene.mesh.dim;
    Eigen::Matrix<double, 4, 3> moments = Eigen::Matrix<double, 4, 3>::Zero(); // of (1, x) over the surface
    covered = 0;
    const auto add = [&](int element, const double* shape, const double* area)
    {
        Eigen::Vector4d place(1, 0, 0, 0);
        for (int a = 0; a <= dim; ++a)
            for (int d = 0; d < dim; ++d) place[1 + d] += shape[a] * scene.mesh.x[std::size_t(scene.mesh.elements[std::size_t(element) * (dim + 1) + a]) * dim + d];
        for (int d = 0; d < dim; ++d) moments.col(d) += area[d] * place;
    };
    for (const CutFacet& f : cover.facets)
    {
        if (f.solid != solid || !scene.mesh.isOwnedElement[f.element]) continue;
        double shape[4] = {}, area[3];
        for (int q = 0; q < f.nPoints; ++q)
            for (int a = 0; a <= dim; ++a) shape[a] += f.weight[q] / f.area * f.shape[q][a];
        for (int d = 0; d < dim; ++d) area[d] = f.area * f.normal[d];
        add(f.element, shape, area);
    }
    for (const CoveredFacet& f : cover.coveredFacets)
    {
        if (f.solid != solid || !scene.mesh.isOwnedElement[f.element]) continue;
        for (int q = 0; q < f.nPoints; ++q) add(f.element, f.shape[q], f.area);
        covered += f.nPoints * std::abs(f.area[0]);
    }
    scene.halo.sum(moments.data(), 12);
    covered = scene.halo.sum(covered);
    return moments;
}

/// How far the body's surface and what others cover of it are from a closed one around this volume [m^(dim-1), m^dim].
inline double closureError(const CoverScene& scene, const Cover& cover, int solid, double volume)
{
    double covered, error = 0;
    const Eigen::Matrix<double, 4, 3> moments = surfaceMoments(scene, cover, solid, covered);
    for (int d = 0; d < scene.mesh.dim; ++d)
        for (int k = 0; k <= scene.mesh.dim; ++k) error = std::max(error, std::abs(moments(k, d) + (k == d + 1 ? volume : 0)));
    return error;
}

} // namespace flotsam
