// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simplexMesh.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace flotsam
{
namespace
{

// Smaller than this fraction of (longest edge)^dim, round-off decides the sign of a volume.
constexpr double flatTolerance = 1e-13;

double longestEdgeSquared(const double* x, const int* nodes, int dim)
{
    double longest = 0;
    for (int a = 0; a <= dim; ++a)
    {
        for (int b = 0; b < a; ++b)
        {
            double length2 = 0;
            for (int d = 0; d < dim; ++d)
            {
                const double delta = x[nodes[a] * dim + d] - x[nodes[b] * dim + d];
                length2 += delta * delta;
            }
            longest = std::max(longest, length2);
        }
    }
    return longest;
}

/// Twice the signed area; gradN: 3*2, still to be divided by it.
double triangleCofactors(const double* a, const double* b, const double* c, double* gradN)
{
    gradN[0] = b[1] - c[1];
    gradN[1] = c[0] - b[0];
    gradN[2] = c[1] - a[1];
    gradN[3] = a[0] - c[0];
    gradN[4] = a[1] - b[1];
    gradN[5] = b[0] - a[0];
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

void cross(const double* u, const double* v, double* w)
{
    w[0] = u[1] * v[2] - u[2] * v[1];
    w[1] = u[2] * v[0] - u[0] * v[2];
    w[2] = u[0] * v[1] - u[1] * v[0];
}

/// Six times the signed volume; gradN: 4*3, still to be divided by it.
double tetrahedronCofactors(const double* a, const double* b, const double* c, const double* d, double* gradN)
{
    double e1[3], e2[3], e3[3];
    for (int i = 0; i < 3; ++i)
    {
        e1[i] = b[i] - a[i];
        e2[i] = c[i] - a[i];
        e3[i] = d[i] - a[i];
    }
    cross(e2, e3, gradN + 3);
    cross(e3, e1, gradN + 6);
    cross(e1, e2, gradN + 9);
    for (int i = 0; i < 3; ++i)
    {
        gradN[i] = -(gradN[3 + i] + gradN[6 + i] + gradN[9 + i]);
    }
    return e1[0] * gradN[3] + e1[1] * gradN[4] + e1[2] * gradN[5];
}

double cofactors(const double* x, const int* n, int dim, double* gradN)
{
    return dim == 2 ? triangleCofactors(x + 2 * n[0], x + 2 * n[1], x + 2 * n[2], gradN)
                    : tetrahedronCofactors(x + 3 * n[0], x + 3 * n[1], x + 3 * n[2], x + 3 * n[3], gradN);
}

[[noreturn]] void throwFlat(const SimplexMesh& mesh, int e, double volume)
{
    std::ostringstream message;
    message << "element " << e << " of the mesh is flat: volume " << volume << " m^" << mesh.dim << ", nodes";
    for (int a = 0; a <= mesh.dim; ++a)
    {
        const auto p = mesh.spacePoint(mesh.elements[e * (mesh.dim + 1) + a]);
        message << " (" << p[0] << ' ' << p[1] << ' ' << p[2] << ')';
    }
    message << ". Check the mesh there (checkMesh -allGeometry).";
    throw std::runtime_error(message.str());
}

} // namespace

void SimplexMesh::computeGeometry()
{
    const int nodesPerElement = dim + 1;
    const double factorial = dim == 2 ? 2 : 6;
    volume.resize(nElements);
    h.resize(nElements);
    gradN.resize(static_cast<std::size_t>(nElements) * nodesPerElement * dim);
    for (int e = 0; e < nElements; ++e)
    {
        int* nodes = &elements[static_cast<std::size_t>(e) * nodesPerElement];
        double* grad = &gradN[static_cast<std::size_t>(e) * nodesPerElement * dim];
        double jacobian = cofactors(x.data(), nodes, dim, grad);
        if (jacobian < 0)
        {
            std::swap(nodes[dim - 1], nodes[dim]);
            jacobian = cofactors(x.data(), nodes, dim, grad);
        }
        const double edge2 = longestEdgeSquared(x.data(), nodes, dim);
        const double scale = dim == 2 ? edge2 : edge2 * std::sqrt(edge2);
        if (!(jacobian > flatTolerance * scale))
        {
            throwFlat(*this, e, jacobian / factorial);
        }
        for (int i = 0; i < nodesPerElement * dim; ++i)
        {
            grad[i] /= jacobian;
        }
        volume[e] = jacobian / factorial;
        h[e] = dim == 2 ? std::sqrt(jacobian) : std::cbrt(jacobian);
    }
}

std::array<double, 3> SimplexMesh::spacePoint(int i) const
{
    std::array<double, 3> point{0, 0, 0};
    for (int d = 0; d < dim; ++d)
    {
        point[axes[d]] = x[static_cast<std::size_t>(i) * dim + d];
    }
    if (dim == 2)
    {
        point[axes[2]] = planeOffset;
    }
    return point;
}

} // namespace flotsam
