// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/phaseFieldSupg.hpp"

#include "equations/interfaceWidth.hpp"
#include "equations/jacobiBicgstab.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace flotsam
{

namespace
{

constexpr double solverTolerance = 1e-10;
constexpr int solverIterations = 200;
constexpr double runaway = 1;       // beyond 0 and 1; overshoots of this form are some tenths

/// The fluid part of an element and what the flow carries in it.
template<int dim>
struct CarryingElement
{
    static constexpr int n = dim + 1;
    double volume, first[n], mass[n][n];        // int N_a, int N_a N_b
    double carried[n][dim], mean[dim] = {};     // int N_a (u + u'); mean velocity

    CarryingElement(const SimplexMesh& mesh, int e, const CutElement* cut, const std::vector<double>& u, const std::vector<double>& fineScale)
    {
        volume = cut ? cut->volume : mesh.volume[e];
        for (int a = 0; a < n; ++a)
        {
            first[a] = cut ? cut->first[a] : volume/n;
            for (int b = 0; b < n; ++b)
            {
                mass[a][b] = cut ? cut->second[a*n + b] : volume*(a == b ? 2 : 1)/(n*(n + 1));
            }
        }
        const int* nodes = &mesh.elements[std::size_t(e)*n];
        for (int a = 0; a < n; ++a)
        {
            for (int d = 0; d < dim; ++d)
            {
                carried[a][d] = fineScale.empty() ? 0 : first[a]*fineScale[std::size_t(e)*dim + d];
                for (int b = 0; b < n; ++b)
                {
                    carried[a][d] += mass[a][b]*u[std::size_t(nodes[b])*dim + d];
                }
                mean[d] += carried[a][d]/volume;
            }
        }
    }
};

} // namespace

PhaseFieldSupg::PhaseFieldSupg(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const NumericsControls& controls,
    const std::array<double, 3>& gravity)
    : mesh_(mesh), graph_(graph), halo_(halo), controls_(controls),
      width_(interfaceWidth(mesh, graph, halo, controls.interfaceWidth, gravity)), dualVolume_(dualVolumes(mesh, nullptr)),
      volumeFlux_(mesh, graph), boundary_(mesh, graph, volumeFlux_), matrix_(graph.column.size()), rhs_(mesh.nOwned),
      rowBalance_(mesh.nOwned), extrapolated_(mesh.nNodes), liquidVolume_(std::numeric_limits<double>::quiet_NaN())
{
}

/// c of the ratio flux: 1 where the profile has its equilibrium slope; 0 switches the compression off.
template<int dim>
double PhaseFieldSupg::compressionFactor(const int* nodes, const double* gradN, const std::vector<double>& extrapolated) const
{
    constexpr double regular = 1e-6, outside = 1e-4, bulk = 1e-5;
    double gradient[dim] = {};
    double beyond = 0;      // how far alpha leaves [0,1]
    bool isBand = false;
    for (int a = 0; a <= dim; ++a)
    {
        const double q = extrapolated[nodes[a]];
        beyond = std::max({beyond, -q, q - 1});
        isBand = isBand || (q > bulk && q < 1 - bulk);
        const double bounded = std::clamp(q, 0., 1.);
        const double psi = width_[nodes[a]]*std::log((bounded + regular)/(1 - bounded + regular));
        for (int d = 0; d < dim; ++d)
        {
            gradient[d] += psi*gradN[a*dim + d];
        }
    }
    double length = 0;
    for (int d = 0; d < dim; ++d)
    {
        length += gradient[d]*gradient[d];
    }
    // off between one and two times `outside`, gradually: a sudden switch makes the result depend on round-off
    const double share = std::clamp(2 - beyond/outside, 0., 1.);
    return isBand ? share*std::min(2., 1/std::sqrt(std::max(length, 1e-30))) : 0;
}

template<int dim>
void PhaseFieldSupg::assemble(const std::vector<double>& alpha, const TimeLevels& levels, double dt, double gamma,
    const std::vector<double>& u, const std::vector<double>& fineScale, const Cover* cover)
{
    constexpr int n = dim + 1;
    std::fill(matrix_.begin(), matrix_.end(), 0);
    std::fill(rhs_.begin(), rhs_.end(), 0);
    std::fill(rowBalance_.begin(), rowBalance_.end(), 0);
    for (int e = 0; e < mesh_.nInnerElements; ++e)
    {
        if (cover && cover->state[e] == ElementState::Solid)
        {
            continue;
        }
        const CutElement* cut = cover && cover->state[e] == ElementState::Cut ? &cover->cuts[cover->cutIndex[e]] : nullptr;
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        const double* g = &mesh_.gradN[std::size_t(e)*n*dim];
        const CarryingElement<dim> element(mesh_, e, cut, u, fineScale);
        double squaredSpeed = 0, width = 0, along[n] = {};  // along = mean velocity . grad N
        for (int d = 0; d < dim; ++d)
        {
            squaredSpeed += element.mean[d]*element.mean[d];
        }
        for (int a = 0; a < n; ++a)
        {
            width += width_[nodes[a]]/n;
            for (int d = 0; d < dim; ++d)
            {
                along[a] += element.mean[d]*g[a*dim + d];
            }
        }
        const double tau = 1/std::sqrt(4/(dt*dt) + 4*squaredSpeed/(mesh_.h[e]*mesh_.h[e]));
        const double diffusion = gamma*width*element.volume, compression = compressionFactor<dim>(nodes, g, extrapolated_);

        for (int a = 0; a < n; ++a)
        {
            const int i = nodes[a];
            if (i >= mesh_.nOwned)
            {
                continue;
            }
            for (int b = 0; b < n; ++b)
            {
                const int j = nodes[b];
                double advection = 0, stiffness = 0;
                for (int d = 0; d < dim; ++d)
                {
                    advection -= g[a*dim + d]*element.carried[b][d];
                    stiffness += g[a*dim + d]*g[b*dim + d];
                }
                const double inertia = element.mass[a][b] + tau*along[a]*element.first[b];
                matrix_[graph_.slot(i, (std::size_t(e)*n + a)*n + b)] += levels.c0*inertia + advection
                    + tau*element.volume*along[a]*along[b] + diffusion*stiffness;
                rhs_[i] -= inertia*(levels.c1*alpha[j] + levels.c2*alphaOld_[j]) - diffusion*compression*stiffness*extrapolated_[j];
                rowBalance_[i] += advection;
            }
        }
    }
}

void PhaseFieldSupg::addBoundary(const std::vector<double>& alpha, const std::vector<PairFlux>& pairFlux)
{
    for (const BoundaryFlux& b : boundary_.fluxes())
    {
        rowBalance_[b.node] += b.flux;
        if (b.flux < 0 && b.alphaIn >= 0)
        {
            rhs_[b.node] -= b.flux*b.alphaIn;
        }
        else
        {
            matrix_[graph_.diagonal[b.node]] += b.flux;
        }
    }
    for (const PairFlux& pair : pairFlux)   // upwind, explicit: the two nodes need not share a matrix entry
    {
        const double carried = pair.flux*alpha[pair.flux > 0 ? pair.a : pair.b];
        if (pair.a < mesh_.nOwned)
        {
            rowBalance_[pair.a] += pair.flux;
            rhs_[pair.a] -= carried;
        }
        if (pair.b < mesh_.nOwned)
        {
            rowBalance_[pair.b] -= pair.flux;
            rhs_[pair.b] += carried;
        }
    }
}

/// What the flow solver left of the continuity row, and the change of volume of cut dual cells, must not change alpha. Rows
/// without fluid keep their value.
void PhaseFieldSupg::removeDivergence(const std::vector<double>& alpha)
{
    for (int i = 0; i < mesh_.nOwned; ++i)
    {
        double& diagonal = matrix_[graph_.diagonal[i]];
        if (diagonal == 0)
        {
            diagonal = 1;
            rhs_[i] = alpha[i];
            continue;
        }
        rhs_[i] += rowBalance_[i]*alpha[i];
    }
}

void PhaseFieldSupg::countBoundary(const std::vector<double>& alpha, double dt, TransportReport& report) const
{
    for (const BoundaryFlux& b : boundary_.fluxes())
    {
        const double value = b.flux < 0 && b.alphaIn >= 0 ? b.alphaIn : alpha[b.node];
        (b.flux > 0 ? report.outflow : report.inflow) += dt*std::abs(b.flux)*value;
    }
    double sums[2] = {report.inflow, report.outflow};
    halo_.sum(sums, 2);
    report.inflow = sums[0];
    report.outflow = sums[1];
}

TransportReport PhaseFieldSupg::advance(std::vector<double>& alpha, double dt, const std::vector<double>& u,
    const std::vector<double>& fineScale, const Cover* cover, const std::vector<BoundaryPatch>& patches,
    const std::vector<PatchValues>& values, const std::vector<char>& isPressureFixed, const std::vector<PairFlux>& pairFlux, const Cover* atEnd)
{
    TransportReport report;
    report.subSteps = 1;
    dualVolume_ = dualVolumes(mesh_, atEnd ? atEnd : cover);
    const double measured = halo_.sum(liquidOf(mesh_, dualVolume_, alpha));
    report.liquidBefore = cover && std::isfinite(liquidVolume_) ? liquidVolume_ : measured;

    const bool hasOld = controls_.timeOrder > 1 && dtOld_ > 0 && alphaOld_.size() == alpha.size();
    if (!hasOld)
    {
        alphaOld_ = alpha;
    }
    const double r = hasOld ? dt/dtOld_ : 0;    // variable-step BDF2; r = 0 is BDF1
    const TimeLevels levels{(1 + 2*r)/(1 + r)/dt, -(1 + r)/dt, r*r/(1 + r)/dt, r};
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        extrapolated_[i] = alpha[i] + levels.extrapolation*(alpha[i] - alphaOld_[i]);
    }
    const double gamma = (controls_.mobility > 0 ? controls_.mobility : 1)*largestSpeed(mesh_, halo_, u);
    boundary_.evaluate(u, fineScale, cover, patches, values, isPressureFixed, pairFlux);
    if (mesh_.dim == 2)
    {
        assemble<2>(alpha, levels, dt, gamma, u, fineScale, cover);
    }
    else
    {
        assemble<3>(alpha, levels, dt, gamma, u, fineScale, cover);
    }
    addBoundary(alpha, pairFlux);
    removeDivergence(alpha);

    alphaOld_ = alpha;
    dtOld_ = dt;
    if (solveJacobiBicgstab(mesh_, graph_, halo_, matrix_, rhs_, alpha, solverTolerance, solverIterations) < 0)
    {
        throw std::runtime_error("phase field (SUPG): " + std::to_string(solverIterations)
            + " BiCGStab iterations did not reach a relative residual of 1e-10: the velocity is wrong or the step too long");
    }
    countBoundary(alpha, dt, report);
    restoreLiquid(mesh_, halo_, dualVolume_, alpha, report);
    for (int i = 0; i < mesh_.nOwned; ++i)
    {
        report.minAlpha = std::min(report.minAlpha, alpha[i]);
        report.maxAlpha = std::max(report.maxAlpha, alpha[i]);
    }
    report.minAlpha = halo_.min(report.minAlpha);
    report.maxAlpha = halo_.max(report.maxAlpha);
    if (report.minAlpha < -runaway || report.maxAlpha > 1 + runaway)
    {
        throw std::runtime_error("phase field (SUPG): alpha from " + std::to_string(report.minAlpha) + " to " + std::to_string(report.maxAlpha)
            + ": this form has become unstable; dualCellTransport yes keeps alpha between 0 and 1");
    }
    if (cover)
    {
        liquidVolume_ = report.liquidAfter;
    }
    return report;
}

} // namespace flotsam
