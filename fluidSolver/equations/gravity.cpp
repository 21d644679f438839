// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/gravity.hpp"

#include "equations/materials.hpp"
#include "geometry/cover.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

constexpr double leastAlpha = 1e-4;     // that the profile keeps
constexpr double ofMeans = 2;           // widths by which means over dual cells reach farther out than the profile
constexpr double sameDensity = 1e-10; // relative spread of nodal densities that counts as constant

/// g.x of the foot of a point on the plane of node i. The node's own foot stays within the plane's reach, beyond
/// which an inclined plane says nothing about the surface's height.
template<int dim>
double footPotential(const SimplexMesh& mesh, const double* g, const InterfacePlanes& planes, int i, const double* point)
{
    const double *c = planes.point(i), *n = planes.normal(i), *x = &mesh.x[std::size_t(i)*dim], d = planes.distance(i);
    double t[dim], length = 0, along = 0;
    for (int k = 0; k < dim; ++k)
    {
        t[k] = x[k] - d*n[k] - c[k];
        length += t[k]*t[k];
        along += n[k]*(point[k] - x[k]);
    }
    length = std::sqrt(length);
    const double share = length > planes.reach(i) ? planes.reach(i)/length : 1;
    double result = 0;
    for (int k = 0; k < dim; ++k) result += g[k]*(c[k] + share*t[k] + point[k] - x[k] - along*n[k]);
    return result;
}

/// Cosine of the largest angle between the planes of an element's nodes.
template<int dim>
double leastCosine(const InterfacePlanes& planes, const int* nodes)
{
    double least = 1;
    for (int a = 1; a <= dim; ++a)
        for (int b = 0; b < a; ++b)
        {
            double cosine = 0;
            for (int k = 0; k < dim; ++k) cosine += planes.normal(nodes[a])[k]*planes.normal(nodes[b])[k];
            least = std::min(least, cosine);
        }
    return least;
}

/// Mean of the feet of an element's centre on its nodes' planes, each by the cosine between the plane's normal and the density gradient.
template<int dim>
double facingPotential(const SimplexMesh& mesh, const double* g, const InterfacePlanes& planes, int e, const double* gradRho)
{
    constexpr int n = dim + 1;
    const int* nodes = &mesh.elements[std::size_t(e)*n];
    double centre[dim] = {}, facing = 0, sum = 0;
    for (int a = 0; a < n; ++a)
        for (int k = 0; k < dim; ++k) centre[k] += mesh.x[std::size_t(nodes[a])*dim + k]/n;
    for (int a = 0; a < n; ++a)
    {
        double slope = 0;
        for (int k = 0; k < dim; ++k) slope += gradRho[k]*planes.normal(nodes[a])[k];
        if (slope <= 0) continue;
        facing += slope;
        sum += slope*footPotential<dim>(mesh, g, planes, nodes[a], centre);
    }
    if (facing > 0) return sum/facing;
    for (int k = 0; k < dim; ++k) sum += g[k]*centre[k];
    return sum;
}

/// g.x_G of an element: mean over its nodes' feet. In the middle of a sheet a few elements thick nodes have the planes of either side, and that of the
/// other side says nothing about this one's height: the more the planes oppose each other, the more only those count that face as the density grows.
template<int dim>
double elementPotential(const SimplexMesh& mesh, const double* g, const InterfacePlanes& planes, int e, const double* gradRho)
{
    constexpr int n = dim + 1;
    const int* nodes = &mesh.elements[std::size_t(e)*n];
    double mean = 0;
    for (int a = 0; a < n; ++a) mean += footPotential<dim>(mesh, g, planes, nodes[a], &mesh.x[std::size_t(nodes[a])*dim])/n;
    const double opposed = std::max(0.0, -leastCosine<dim>(planes, nodes));
    return opposed > 0 ? (1 - opposed)*mean + opposed*facingPotential<dim>(mesh, g, planes, e, gradRho) : mean;
}

/// Mean over the fluid part of an element.
template<int dim>
double meanOf(const SimplexMesh& mesh, const Cover* cover, int e, const std::vector<double>& value)
{
    constexpr int n = dim + 1;
    const int* nodes = &mesh.elements[std::size_t(e)*n];
    double mean = 0;
    if (cover && cover->state[e] == ElementState::Cut)
    {
        const CutElement& cut = cover->cuts[cover->cutIndex[e]];
        for (int a = 0; a < n; ++a) mean += value[nodes[a]]*cut.first[a]/cut.volume;
        return mean;
    }
    for (int a = 0; a < n; ++a) mean += value[nodes[a]]*(1.0/n);
    return mean;
}

template<int dim>
void gravityForceT(const SimplexMesh& mesh, const std::array<double, 3>& gravity, const std::vector<double>& rho,
    const InterfacePlanes* planes, const std::vector<double>& ofSurface, const Cover* cover, std::vector<double>& result)
{
    constexpr int n = dim + 1;
    double g[dim];
    for (int d = 0; d < dim; ++d) g[d] = gravity[mesh.axes[d]];
    result.resize(std::size_t(mesh.nElements)*dim);
    for (int e = 0; e < mesh.nElements; ++e)
    {
        double potential[n];
        const bool isBalanced = planes && balancedPotentials<dim>(mesh, g, *planes, ofSurface, e, potential);
        double* f = &result[std::size_t(e)*dim];
        const double weight = meanOf<dim>(mesh, cover, e, rho) - (isBalanced ? meanOf<dim>(mesh, cover, e, ofSurface) : 0);
        for (int d = 0; d < dim; ++d) f[d] = weight*g[d];
        for (int a = 0; isBalanced && a < n; ++a)
            for (int d = 0; d < dim; ++d)
                f[d] += mesh.gradN[(std::size_t(e)*n + a)*dim + d]*ofSurface[mesh.elements[std::size_t(e)*n + a]]*potential[a];
    }
}

} // namespace

template<int dim>
bool balancedPotentials(const SimplexMesh& mesh, const double* g, const InterfacePlanes& planes, const std::vector<double>& ofSurface, int e, double* potential)
{
    constexpr int n = dim + 1;
    const int* nodes = &mesh.elements[std::size_t(e)*n];
    if (!std::all_of(nodes, nodes + n, [&](int i) { return planes.has(i); })) return false;
    const auto [lightest, heaviest] = std::minmax_element(nodes, nodes + n, [&](int i, int j) { return ofSurface[i] < ofSurface[j]; });
    if (ofSurface[*heaviest] - ofSurface[*lightest] <= sameDensity*ofSurface[*heaviest]) return false;
    double gradRho[dim] = {};
    for (int a = 0; a < n; ++a)
        for (int d = 0; d < dim; ++d) gradRho[d] += mesh.gradN[(std::size_t(e)*n + a)*dim + d]*ofSurface[nodes[a]];
    const double foot = elementPotential<dim>(mesh, g, planes, e, gradRho);
    for (int a = 0; a < n; ++a)
    {
        potential[a] = -foot;
        for (int d = 0; d < dim; ++d) potential[a] += g[d]*mesh.x[std::size_t(nodes[a])*dim + d];
    }
    return true;
}

template bool balancedPotentials<2>(const SimplexMesh&, const double*, const InterfacePlanes&, const std::vector<double>&, int, double*);
template bool balancedPotentials<3>(const SimplexMesh&, const double*, const InterfacePlanes&, const std::vector<double>&, int, double*);

double profilePressure(const SimplexMesh& mesh, const FluidProperties& fluid, const InterfacePlanes& planes, const std::vector<double>& ofSurface, int i, double sharp)
{
    const double* x = &mesh.x[std::size_t(i)*mesh.dim];
    double g[3], potential = 0;
    for (int d = 0; d < mesh.dim; ++d)
    {
        g[d] = fluid.gravity[mesh.axes[d]];
        potential += g[d]*x[d];
    }
    potential -= mesh.dim == 2 ? footPotential<2>(mesh, g, planes, i, x) : footPotential<3>(mesh, g, planes, i, x);
    return (ofSurface[i] - (sharp > 0.5 ? fluid.rhoLiquid : fluid.rhoGas))*potential;
}

void surfaceDensity(const SimplexMesh& mesh, const FluidProperties& fluid, const NumericsControls& controls, const InterfacePlanes& planes,
    const Cover* cover, const std::vector<double>& width, const std::vector<double>& alpha, std::vector<double>& result)
{
    result.resize(mesh.nNodes);
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        double most = 1;    // share of the other fluid
        const double inFluid = cover ? cover->distance[i] : farDistance;
        if (planes.has(i) && inFluid >= 0)
        {
            const double h = width[i]/controls.interfaceWidth;
            const double distance = inFluid < h ? std::abs(planes.distance(i)) : planes.distanceFromSurface(mesh, i);
            most = 1/(1 + std::exp((distance - h)/width[i]));
        }
        result[i] = density(fluid, controls, alpha[i] < 0.5 ? std::min(alpha[i], most) : std::max(alpha[i], 1 - most));
    }
}

InterfacePlanes::Extent planesExtent(const NumericsControls& controls, const std::vector<double>& width)
{
    return {controls.gravityLayers, &width, ofMeans - std::log(std::max(controls.densityClip, leastAlpha))};
}

void gravityForce(const SimplexMesh& mesh, const std::array<double, 3>& gravity, const std::vector<double>& rho,
    const InterfacePlanes* planes, const std::vector<double>& ofSurface, const Cover* cover, std::vector<double>& result)
{
    if (mesh.dim == 2) gravityForceT<2>(mesh, gravity, rho, planes, ofSurface, cover, result);
    else gravityForceT<3>(mesh, gravity, rho, planes, ofSurface, cover, result);
}

} // namespace flotsam
