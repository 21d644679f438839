// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/gravity.hpp"

#include "geometry/cover.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

constexpr double sameDensity = 1e-10; // relative spread of nodal densities that counts as constant

/// g.x of the foot of a node on its plane; the foot stays within one element length of the plane's own point, beyond
/// which an inclined plane says nothing about the surface's height.
double footPotential(const SimplexMesh& mesh, const double* g, const InterfacePlanes& planes, int i, double h)
{
    const int dim = mesh.dim;
    const double *c = planes.point(i), *n = planes.normal(i), d = planes.distance(i);
    double t[3], length = 0;
    for (int k = 0; k < dim; ++k)
    {
        t[k] = mesh.x[std::size_t(i)*dim + k] - d*n[k] - c[k];
        length += t[k]*t[k];
    }
    length = std::sqrt(length);
    const double share = length > h ? h/length : 1;
    double result = 0;
    for (int k = 0; k < dim; ++k) result += g[k]*(c[k] + share*t[k]);
    return result;
}

} // namespace

void gravityForce(const SimplexMesh& mesh, const std::array<double, 3>& gravity, const std::vector<double>& rho,
    const InterfacePlanes* planes, const Cover* cover, std::vector<double>& result)
{
    const int dim = mesh.dim, n = dim + 1;
    double g[3];
    for (int d = 0; d < dim; ++d) g[d] = gravity[mesh.axes[d]];
    result.resize(std::size_t(mesh.nElements)*dim);
    for (int e = 0; e < mesh.nElements; ++e)
    {
        const int* nodes = &mesh.elements[std::size_t(e)*n];
        double lightest = rho[nodes[0]], heaviest = lightest, mean = 0;
        bool hasPlanes = planes != nullptr;
        for (int a = 0; a < n; ++a)
        {
            lightest = std::min(lightest, rho[nodes[a]]);
            heaviest = std::max(heaviest, rho[nodes[a]]);
            mean += rho[nodes[a]];
            hasPlanes = hasPlanes && planes->has(nodes[a]);
        }
        double* f = &result[std::size_t(e)*dim];
        if (!hasPlanes || heaviest - lightest <= sameDensity*heaviest)
        {
            if (cover && cover->state[e] == ElementState::Cut && heaviest > lightest)
            {
                const CutElement& cut = cover->cuts[cover->cutIndex[e]];
                mean = 0;
                for (int a = 0; a < n; ++a) mean += n*rho[nodes[a]]*cut.first[a]/cut.volume;
            }
            for (int d = 0; d < dim; ++d) f[d] = mean/n*g[d];
            continue;
        }
        double foot = 0;
        for (int a = 0; a < n; ++a) foot += footPotential(mesh, g, *planes, nodes[a], mesh.h[e])/n;
        std::fill(f, f + dim, 0.0);
        for (int a = 0; a < n; ++a)
        {
            double potential = -foot;
            for (int d = 0; d < dim; ++d) potential += g[d]*mesh.x[std::size_t(nodes[a])*dim + d];
            for (int d = 0; d < dim; ++d)
                f[d] += mesh.gradN[(std::size_t(e)*n + a)*dim + d]*rho[nodes[a]]*potential;
        }
    }
}

} // namespace flotsam
