// SPDX-License-Identifier: GPL-3.0-or-later
/// What the balanced form of gravity leaves of the fluid's weight where the surface is steep, thin or curved.
#include "equations/gravity.hpp"
#include "equations/initialProfile.hpp"
#include "equations/materials.hpp"
#include "core/nodeGraph.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <functional>

using namespace flotsam;

namespace
{

struct Defect
{
    double sum;     ///< |sum V (f - rho g)| / (g * (jump of density) * h * area of the surface)
    double patch;   ///< the same of balls of radius 3 h, rms
    double element; ///< of single elements, rms
    double weight;  ///< sum / weight of the fluid in the band
};

using Level = std::function<double(const double*)>;

Defect defectOf(int dim, int n, const Level& level)
{
    const double h = 1.0/n;
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {0, 0, 0}, {1, 1, 1}, 0.19);
    const Halo halo(mesh, MPI_COMM_WORLD);
    const NodeGraph graph(mesh);
    const FluidProperties fluid;
    const NumericsControls controls;
    const std::vector<double> width = interfaceWidth(mesh, graph, halo, controls.interfaceWidth);
    std::vector<double> alpha(mesh.nNodes), rho(mesh.nNodes), f;
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        alpha[i] = 1/(1 + std::exp(-level(&mesh.x[std::size_t(i)*dim])/width[i]));
        rho[i] = density(fluid, controls, alpha[i]);
    }
    InterfacePlanes planes;
    propagateInterfacePlanes(mesh, graph, halo, alpha, width, controls.gravityLayers, planes);
    std::array<double, 3> g{};
    g[mesh.axes[dim - 1]] = -9.81;
    gravityForce(mesh, g, rho, &planes, nullptr, f);
    const double jump = density(fluid, controls, 1) - density(fluid, controls, 0);
    double sum[3] = {}, area = 0, square = 0, squareArea = 0, band = 0;
    const int nb = n/4;     // patches: blocks of 4 h
    std::vector<double> block(std::size_t(nb)*nb*(dim == 3 ? nb : 1)*4, 0.0);
    for (int e = 0; e < mesh.nElements; ++e)
    {
        const int* nodes = &mesh.elements[std::size_t(e)*(dim + 1)];
        double x[3] = {}, d[3] = {}, grad[3] = {}, ip[3] = {}, mean = 0;
        for (int a = 0; a <= dim; ++a)
        {
            const double* xa = &mesh.x[std::size_t(nodes[a])*dim];
            for (int k = 0; k < dim; ++k)
            {
                const double gn = mesh.gradN[(std::size_t(e)*(dim + 1) + a)*dim + k];
                x[k] += xa[k]/(dim + 1);
                grad[k] += gn*rho[nodes[a]];
                ip[k] += gn*rho[nodes[a]]*(-9.81)*xa[dim - 1];
            }
            mean += rho[nodes[a]]/(dim + 1);
        }
        const double steep = std::sqrt(grad[0]*grad[0] + grad[1]*grad[1] + grad[2]*grad[2]);
        if (steep*h < 1e-6*jump) continue;
        // inner part: (phi_e - phi_G) grad rho; what interpolation leaves on the box's faces is left out
        const double v = mesh.volume[e];
        for (int k = 0; k < dim; ++k) d[k] = v*(-9.81*x[dim - 1]*grad[k] - (ip[k] - f[std::size_t(e)*dim + k]));
        for (int k = 0; k < dim; ++k) sum[k] += d[k];
        area += v*steep/jump;
        band += v*mean*9.81;
        double s = 0;
        for (int k = 0; k < dim; ++k) s += d[k]*d[k];
        if (v*steep > 0) { square += s/(v*steep/jump); squareArea += v*steep/jump; }
        std::size_t at = 0;
        for (int k = 0; k < dim; ++k) at = at*nb + std::min(nb - 1, int(x[k]*nb));
        for (int k = 0; k < dim; ++k) block[4*at + k] += d[k];
        block[4*at + 3] += v*steep/jump;
    }
    double patches = 0;
    for (std::size_t b = 0; b < block.size()/4; ++b)
        if (block[4*b + 3] > 0)
            patches += (block[4*b]*block[4*b] + block[4*b + 1]*block[4*b + 1] + block[4*b + 2]*block[4*b + 2])/block[4*b + 3];
    const double unit = 9.81*jump*h, total = std::sqrt(sum[0]*sum[0] + sum[1]*sum[1] + sum[2]*sum[2]);
    return {total/(unit*area), std::sqrt(patches/area)/unit, std::sqrt(square/area)/unit, total/band};
}

void print(int dim, const char* name, double angle, const Defect& d)
{
    std::printf("| %dD %-22s | %2.0f | %.4f | %.4f | %.4f | %.4f |\n", dim, name, angle, d.sum, d.patch, d.element, d.weight);
}

} // namespace

TEST_CASE("weight of the fluid in the balanced form")
{
    std::printf("| field | angle | sum | patch | element | sum/weight of the band |\n");
    for (int dim : {2, 3})
    {
        const int n = dim == 2 ? 40 : 20;
        const double h = 1.0/n;
        const auto slab = [&](double degrees, double half) -> Level
        {
            const double c = std::cos(degrees*M_PI/180), s = std::sin(degrees*M_PI/180);
            return [=](const double* x)
            {
                const double d = (x[dim - 1] - 0.513 - 0.37*h)*c + (x[0] - 0.507)*s + (dim == 3 ? 0.2*s*(x[1] - 0.5) : 0);
                return half > 0 ? half - std::abs(d) : -d;
            };
        };
        for (double angle : {0., 10., 20., 40., 60., 80., 90.}) print(dim, "plane", angle, defectOf(dim, n, slab(angle, 0)));
        for (double thick : {2., 3., 5.})
            for (double angle : {0., 40., 80., 90.}) print(dim, ("sheet " + std::to_string(int(thick)) + " h").c_str(), angle, defectOf(dim, n, slab(angle, 0.5*thick*h)));
        for (double radius : {2., 3., 5.})
        {
            const Level drop = [&](const double* x)
            {
                double s = 0;
                for (int d = 0; d < dim; ++d) s += (x[d] - 0.5 - 0.011*d)*(x[d] - 0.5 - 0.011*d);
                return radius*h - std::sqrt(s);
            };
            print(dim, ("drop " + std::to_string(int(radius)) + " h").c_str(), 0, defectOf(dim, n, drop));
        }
        const Level column = [&](const double* x) { const double a = 0.3 + 0.3*h - x[0], b = 0.6 + 0.37*h - x[dim - 1]; return std::min(a, b); };
        print(dim, "column", 0, defectOf(dim, n, column));
        const Level wave = [&](const double* x) { return 0.5 + 0.1*std::cos(2*M_PI*x[0]) - x[dim - 1]; };
        print(dim, "wave, steepness 32 deg", 0, defectOf(dim, n, wave));
    }
}
