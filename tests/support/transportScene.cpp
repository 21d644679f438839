// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/transportScene.hpp"

#include "support/flowCases.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace flotsam
{

namespace
{

double processSeconds()
{
    return double(std::clock())/CLOCKS_PER_SEC;
}

/// Calls act(lambda) for equally spaced points of a simplex.
void forSamples(int dim, int count, const std::function<void(const double*)>& act)
{
    double lambda[4] = {};
    const double total = count + (dim + 1)/3.;
    for (int i = 0; i <= count; ++i)
    {
        for (int j = 0; i + j <= count; ++j)
        {
            for (int k = 0; k <= (dim == 3 ? count - i - j : 0); ++k)
            {
                lambda[0] = (i + 1./3)/total;
                lambda[1] = (j + 1./3)/total;
                lambda[2] = (dim == 3 ? k + 1./3 : count - i - j + 1./3)/total;
                lambda[3] = 1 - lambda[0] - lambda[1] - lambda[2];
                act(lambda);
            }
        }
    }
}

/// image_a = sum_e int grad N_a . grad q, whole at the owned nodes. q: halo up to date.
void multiplyStiffness(const SimplexMesh& mesh, const std::vector<double>& q, std::vector<double>& image)
{
    const int dim = mesh.dim, n = dim + 1;
    std::fill(image.begin(), image.end(), 0);
    for (int e = 0; e < mesh.nInnerElements; ++e)
    {
        const int* nodes = &mesh.elements[std::size_t(e)*n];
        const double* g = &mesh.gradN[std::size_t(e)*n*dim];
        double gradient[3] = {};
        for (int a = 0; a < n; ++a)
        {
            for (int d = 0; d < dim; ++d)
            {
                gradient[d] += q[nodes[a]]*g[a*dim + d];
            }
        }
        for (int a = 0; a < n; ++a)
        {
            for (int d = 0; d < dim; ++d)
            {
                image[nodes[a]] += mesh.volume[e]*gradient[d]*g[a*dim + d];
            }
        }
    }
}

} // namespace

TransportScene::TransportScene(MPI_Comm comm, int dim, int n, double width, const VelocityField& field, int seed)
    : controls([width] { NumericsControls c; c.interfaceWidth = width; return c; }()),
      mesh(makeBoxMesh(comm, dim, {n, n, n}, {0, 0, 0}, {1, 1, 1}, 0.15, false, seed)), graph(mesh), halo(mesh, comm),
      transport(mesh, graph, halo, controls), volume(dualVolumes(mesh, nullptr)), velocity(std::size_t(mesh.nNodes)*dim),
      fineScale(std::size_t(mesh.nElements)*dim, 0), alpha(mesh.nNodes, 0)
{
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        const Point u = field(point(i));
        fastest = std::max(fastest, std::sqrt(u[0]*u[0] + u[1]*u[1] + (dim == 3 ? u[2]*u[2] : 0)));
        std::copy_n(u.begin(), dim, &velocity[std::size_t(i)*dim]);
    }
    fastest = halo.max(fastest);
    for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    {
        patches.push_back(makePatch(mesh, int(p), BoundaryPatch::Velocity::Fixed));
        patches.back().phase = BoundaryPatch::Phase::Inflow;
        values.emplace_back();
        values.back().alpha.assign(patches.back().nodes.size(), 0);
    }
    makeDivergenceFree();
}

Point TransportScene::point(int i) const
{
    Point x{0, 0, 0};
    std::copy_n(&mesh.x[std::size_t(i)*mesh.dim], mesh.dim, x.begin());
    return x;
}

/// What the velocity leaves of every node's balance, sum_e grad N_a.int u - int_boundary N_a u.n; size: sum of the squares of its elements' parts.
std::vector<double> TransportScene::imbalance(double& size) const
{
    const int n = mesh.dim + 1;
    const VolumeFlux flux(mesh, graph);
    TransportBoundary boundary(mesh, graph, flux);
    boundary.evaluate(velocity, {}, nullptr, patches, values, {}, {});
    std::vector<double> r(mesh.nNodes, 0);
    for (const BoundaryFlux& b : boundary.fluxes())
    {
        r[b.node] -= b.flux;
    }
    size = 0;
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        for (int k = graph.nodeElementStart[i]; k < graph.nodeElementStart[i + 1]; ++k)
        {
            const int* nodes = &mesh.elements[std::size_t(graph.nodeElement[k])*n];
            const double row = flux.row(graph.nodeElement[k], static_cast<int>(std::find(nodes, nodes + n, i) - nodes), velocity, {}, nullptr);
            r[i] -= row;
            size += row*row;
        }
    }
    size = halo.sum(size);
    return r;
}

/// u' = -grad q in every element so that sum_e -grad N_a.(int u + V u') + int_boundary N_a u.n = 0 for every node:
/// what the pressure of the stabilised scheme does. Conjugate gradients.
void TransportScene::makeDivergenceFree()
{
    double size;
    std::vector<double> q(mesh.nNodes, 0), r = imbalance(size), direction, image(mesh.nNodes);
    const auto dot = [this](const std::vector<double>& a, const std::vector<double>& b) {
        double s = 0;
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            s += a[i]*b[i];
        }
        return halo.sum(s);
    };
    double rr = dot(r, r);
    const double target = 1e-28*size;  // not lower: stagnation lets the constant part grow
    direction = r;
    for (int iteration = 0; iteration < 2000 && rr > target; ++iteration)
    {
        halo.update(direction, 1);
        multiplyStiffness(mesh, direction, image);
        const double step = rr/dot(direction, image);
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            q[i] += step*direction[i];
            r[i] -= step*image[i];
        }
        const double next = dot(r, r);
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            direction[i] = r[i] + next/rr*direction[i];
        }
        rr = next;
    }
    halo.update(q, 1);
    const int dim = mesh.dim, n = dim + 1;
    for (int e = 0; e < mesh.nElements; ++e)
    {
        for (int a = 0; a < n; ++a)
        {
            for (int d = 0; d < dim; ++d)
            {
                fineScale[std::size_t(e)*dim + d] -= q[mesh.elements[std::size_t(e)*n + a]]*mesh.gradN[(std::size_t(e)*n + a)*dim + d];
            }
        }
    }
}

void TransportScene::fill(const LiquidShape& shape)
{
    const int dim = mesh.dim, n = dim + 1, count = dim == 2 ? 12 : 7;
    std::vector<double> weight(mesh.nNodes, 0);
    std::fill(alpha.begin(), alpha.end(), 0);
    for (int e = 0; e < mesh.nElements; ++e)
    {
        const int* nodes = &mesh.elements[std::size_t(e)*n];
        const double width = transport.width()[nodes[0]], atCorner = shape(point(nodes[0]));
        if (std::abs(atCorner) > 2*mesh.h[e] + 36*width)
        {
            for (int a = 0; a < n; ++a)
            {
                weight[nodes[a]] += mesh.volume[e];
                alpha[nodes[a]] += mesh.volume[e]*(atCorner < 0);
            }
            continue;
        }
        double sum[4] = {}, samples[4] = {};
        forSamples(dim, count, [&](const double* lambda) {
            Point x{0, 0, 0};
            int nearest = 0;
            double at = 0;
            for (int a = 0; a < n; ++a)
            {
                nearest = lambda[a] > lambda[nearest] ? a : nearest;
                at += lambda[a]*transport.width()[nodes[a]];
                for (int d = 0; d < dim; ++d)
                {
                    x[d] += lambda[a]*mesh.x[std::size_t(nodes[a])*dim + d];
                }
            }
            sum[nearest] += 1/(1 + std::exp(std::min(shape(x)/at, 700.)));
            samples[nearest] += 1;
        });
        for (int a = 0; a < n; ++a)
        {
            weight[nodes[a]] += mesh.volume[e];
            alpha[nodes[a]] += mesh.volume[e]*sum[a]/samples[a];
        }
    }
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        alpha[i] /= weight[i];
    }
    halo.update(alpha, 1);
}

TransportReport TransportScene::advance(double dt, double amplitude)
{
    scaledVelocity_ = velocity;
    scaledFineScale_ = fineScale;
    for (double& v : scaledVelocity_)
    {
        v *= amplitude;
    }
    for (double& v : scaledFineScale_)
    {
        v *= amplitude;
    }
    return transport.advance(alpha, dt, scaledVelocity_, scaledFineScale_, nullptr, patches, values, {});
}

double TransportScene::distanceTo(const std::vector<double>& reference) const
{
    double sums[2] = {0, 0};
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        sums[0] += volume[i]*std::abs(alpha[i] - reference[i]);
        sums[1] += volume[i]*reference[i];
    }
    halo.sum(sums, 2);
    return sums[0]/sums[1];
}

TransportResult runPeriod(TransportScene& scene, double period, double courant, const std::function<double(double)>& amplitude)
{
    const double h = 1/std::round(std::pow(double(scene.mesh.nGlobal), 1./scene.mesh.dim) - 1);
    TransportResult result;
    result.steps = 2*static_cast<int>(std::ceil(0.5*period*scene.fastest/(courant*h)));   // even: some fields are reversed half-way
    const double dt = period/result.steps;
    const std::vector<double> start = scene.alpha;
    double volumeAtStart = 0, volumeAtEnd = 0, entered = 0, band = 0, roofs = 0;
    const double began = processSeconds();
    for (int s = 0; s < result.steps; ++s)
    {
        const TransportReport report = scene.advance(dt, amplitude((s + 0.5)*dt));
        volumeAtStart = s == 0 ? report.liquidBefore : volumeAtStart;
        result.redistributed = std::max(result.redistributed, std::abs(report.redistributed)/volumeAtStart);
        result.lowest = std::min(result.lowest, report.minAlpha);
        result.highest = std::max(result.highest, report.maxAlpha);
        result.limited += report.nLimited;
        entered += report.inflow - report.outflow;
        band += report.nBand;
        roofs += report.nRoof;
    }
    result.secondsPerNodeStep = (processSeconds() - began)/(double(result.steps)*scene.mesh.nNodes);
    for (int i = 0; i < scene.mesh.nOwned; ++i)
    {
        volumeAtEnd += scene.volume[i]*scene.alpha[i];
    }
    result.massError = (scene.halo.sum(volumeAtEnd) - entered)/volumeAtStart - 1;
    result.error = scene.distanceTo(start);
    result.bandShare = band/(double(result.steps)*double(scene.mesh.nGlobal));
    result.roofShare = band > 0 ? roofs/band : 0;
    return result;
}

VelocityField vortexField()
{
    return [](const Point& x) {
        const double a = std::sin(M_PI*x[0]), b = std::sin(M_PI*x[1]);
        return Point{-a*a*std::sin(2*M_PI*x[1]), b*b*std::sin(2*M_PI*x[0]), 0};
    };
}

VelocityField rotationField()
{
    return [](const Point& x) { return Point{0.5 - x[1], x[0] - 0.5, 0}; };
}

VelocityField deformationField()
{
    return [](const Point& x) {
        const double a = std::sin(M_PI*x[0]), b = std::sin(M_PI*x[1]), c = std::sin(M_PI*x[2]);
        const double a2 = std::sin(2*M_PI*x[0]), b2 = std::sin(2*M_PI*x[1]), c2 = std::sin(2*M_PI*x[2]);
        return Point{2*a*a*b2*c2, -a2*b*b*c2, -a2*b2*c*c};
    };
}

LiquidShape disc(const Point& centre, double radius, int dim)
{
    return [=](const Point& x) {
        double s = 0;
        for (int d = 0; d < dim; ++d)
        {
            s += (x[d] - centre[d])*(x[d] - centre[d]);
        }
        return std::sqrt(s) - radius;
    };
}

LiquidShape slottedDisc()
{
    return [](const Point& x) {
        const double d = std::hypot(x[0] - 0.5, x[1] - 0.75) - 0.15;
        return std::max(d, -std::max(std::abs(x[0] - 0.5) - 0.025, x[1] - 0.85));
    };
}

} // namespace flotsam
