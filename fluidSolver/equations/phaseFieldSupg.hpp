// SPDX-License-Identifier: GPL-3.0-or-later
/// The phase field by SUPG finite elements: conservative Allen-Cahn (Furusato et al., eqs 6-10), kept for comparison.
///
/// BDF2, advection in conservative form with exact quadrature, SUPG with tau = [(2/dt)^2 + (2|u|/h)^2]^(-1/2), and the
/// model flux gamma delta grad alpha (1 - c), c = min(2, 1/|grad psi|), psi = delta ln(alpha/(1-alpha)), which vanishes in
/// the equilibrium profile and equals the paper's gamma (delta grad alpha - alpha(1-alpha) grad alpha/|grad alpha|) in the
/// continuum; c falls to 0 where alpha leaves [0,1] by 1e-4 to 2e-4, and is 0 in the bulk. Conservative, not bounded
/// (reversed vortex: some 1e-4 beyond [0,1]).
#pragma once

#include "core/boundary.hpp"
#include "core/controls.hpp"
#include "equations/transportBoundary.hpp"
#include "equations/transportReport.hpp"

namespace flotsam
{

class PhaseFieldSupg
{
public:
    /// controls.interfaceWidth: 0.75 recommended with this form; controls.mobility: gamma over |u|max, 0 means 1 here
    /// (without the model flux the profile spreads).
    PhaseFieldSupg(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const NumericsControls& controls,
        const std::array<double, 3>& gravity = {});

    /// As DualCellTransport::advance(); one implicit step. Throws std::runtime_error when the linear solver fails.
    TransportReport advance(std::vector<double>& alpha, double dt, const std::vector<double>& u,
        const std::vector<double>& fineScale, const Cover* cover, const std::vector<BoundaryPatch>& patches,
        const std::vector<PatchValues>& values, const std::vector<char>& isPressureFixed,
        const std::vector<PairFlux>& pairFlux = {}, const Cover* atEnd = nullptr);

    const std::vector<double>& width() const { return width_; }
    const std::vector<double>& dualVolume() const { return dualVolume_; }

    /// alpha at t - dtOld and dtOld [s], kept from step to step: set them when a step is repeated or restarted (dtOld 0:
    /// there is none, the next step is BDF1).
    const std::vector<double>& alphaOld() const { return alphaOld_; }
    double dtOld() const { return dtOld_; }
    void setHistory(const std::vector<double>& alphaOld, double dtOld) { alphaOld_ = alphaOld; dtOld_ = dtOld; }

    /// As DualCellTransport.
    double liquidVolume() const { return liquidVolume_; }
    void setLiquidVolume(double volume) { liquidVolume_ = volume; }

private:
    struct TimeLevels { double c0, c1, c2, extrapolation; };
    template<int dim> void assemble(const std::vector<double>& alpha, const TimeLevels& levels, double dt, double gamma,
        const std::vector<double>& u, const std::vector<double>& fineScale, const Cover* cover);
    template<int dim> double compressionFactor(const int* nodes, const double* gradN, const std::vector<double>& extrapolated) const;
    void addBoundary(const std::vector<double>& alpha, const std::vector<PairFlux>& pairFlux);
    void removeDivergence(const std::vector<double>& alpha);
    void countBoundary(const std::vector<double>& alpha, double dt, TransportReport& report) const;

    const SimplexMesh& mesh_;
    const NodeGraph& graph_;
    const Halo& halo_;
    const NumericsControls& controls_;
    std::vector<double> width_, dualVolume_;
    VolumeFlux volumeFlux_;
    TransportBoundary boundary_;
    std::vector<double> matrix_, rhs_, rowBalance_; // CSR values on graph_'s rows; continuity row of every node
    std::vector<double> alphaOld_, extrapolated_;
    double dtOld_ = 0;
    double liquidVolume_;
};

} // namespace flotsam
