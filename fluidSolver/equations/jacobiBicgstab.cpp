// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/jacobiBicgstab.hpp"

#include <cmath>

namespace flotsam
{

namespace
{

using Vector = std::vector<double>;

/// image = rows of the matrix, each over its diagonal, times v, whose halo is brought up to date.
void multiplyScaled(const NodeGraph& graph, const Halo& halo, const Vector& matrix, Vector& v, Vector& image)
{
    halo.update(v, 1);
    for (int i = 0; i < int(image.size()); ++i)
    {
        double s = 0;
        for (int k = graph.rowStart[i]; k < graph.rowStart[i + 1]; ++k)
        {
            s += matrix[k]*v[graph.column[k]];
        }
        image[i] = s/matrix[graph.diagonal[i]];
    }
}

} // namespace

int solveJacobiBicgstab(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const std::vector<double>& matrix,
    const std::vector<double>& rhs, std::vector<double>& x, double tolerance, int maxIterations)
{
    const int n = mesh.nOwned;
    const auto dots = [&](const Vector& a, const Vector& b, const Vector& c, double* result) {  // {a.b, c.c}
        result[0] = result[1] = 0;
        for (int i = 0; i < n; ++i)
        {
            result[0] += a[i]*b[i];
            result[1] += c[i]*c[i];
        }
        halo.sum(result, 2);
    };

    Vector r(n), v(n), t(n), p(mesh.nNodes), s(mesh.nNodes);
    multiplyScaled(graph, halo, matrix, x, v);
    double size = 0, pair[2];
    for (int i = 0; i < n; ++i)
    {
        const double b = rhs[i]/matrix[graph.diagonal[i]];
        r[i] = p[i] = b - v[i];
        size += b*b;
    }
    const double target = tolerance*tolerance*halo.sum(size);
    const Vector shadow(r);
    dots(r, shadow, r, pair);
    double rho = pair[0];
    for (int iteration = 0; iteration <= maxIterations; ++iteration)
    {
        if (pair[1] <= target)
        {
            halo.update(x, 1);
            return iteration;
        }
        multiplyScaled(graph, halo, matrix, p, v);
        dots(v, shadow, v, pair);
        const double step = rho/pair[0];
        for (int i = 0; i < n; ++i)
        {
            s[i] = r[i] - step*v[i];
        }
        multiplyScaled(graph, halo, matrix, s, t);
        dots(t, s, t, pair);
        const double omega = pair[1] > 0 ? pair[0]/pair[1] : 0;
        for (int i = 0; i < n; ++i)
        {
            x[i] += step*p[i] + omega*s[i];
            r[i] = s[i] - omega*t[i];
        }
        dots(r, shadow, r, pair);
        const double beta = omega != 0 ? pair[0]/rho*step/omega : 0;
        rho = pair[0];
        for (int i = 0; i < n; ++i)
        {
            p[i] = r[i] + beta*(p[i] - omega*v[i]);
        }
        if (!std::isfinite(pair[1]))
        {
            return -1;
        }
    }
    return -1;
}

} // namespace flotsam
