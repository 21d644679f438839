// SPDX-License-Identifier: GPL-3.0-or-later
/// Elements that no solid cuts are computed several at once, one in each lane: those that one fluid fills, and those in which the density varies.
#pragma once

#include "equations/elementLoader.hpp"

namespace flotsam
{

/// Elements of a kind may be computed together, unless they are to be alone.
/// Plain: one fluid fills the element at every time level. Carried: the same, but beside elements with two, and the phase field's fluxes carry the momentum.
/// Varying: two fluids. Carried and varying ones are what ElementData calls varying.
enum class ElementKind { Plain, Carried, Varying, Alone };

constexpr int nLaneKinds = int(ElementKind::Alone);

template<int D>
inline ElementKind kindOf(int e, const SimplexMesh& mesh, const FlowStepData& step, const NumericsControls& controls, const NodalData& nodal)
{
    if (step.cover && step.cover->state[e] != ElementState::Fluid) return ElementKind::Alone;
    const int* nodes = &mesh.elements[std::size_t(e)*(D + 1)];
    if (!nodal.film.empty() && filmContinuity(nodes, D + 1, nodal.film) < 1) return ElementKind::Alone;
    bool isOne = nodal.fluid[nodes[0]] != NodalData::Mixed;
    for (int a = 1; a <= D; ++a) isOne &= nodal.fluid[nodes[a]] == nodal.fluid[nodes[0]];
    const bool hasFluxes = step.transport && isCarried(nodes, D + 1, nodal) && step.transport->fluxes(e).total;
    if (isOne) return hasFluxes ? ElementKind::Carried : ElementKind::Plain;
    // of first order all nodes of a steep element are, in this element alone
    return hasFluxes && controls.surfaceTimeOrder == 2 ? ElementKind::Varying : ElementKind::Alone;
}

/// What loadElementData() gives for elements of a kind, a lane for each.
template<int D, class Real>
class ElementLanes
{
public:
    static constexpr int N = D + 1, width = widthOf<Real>;

    ElementLanes(const SimplexMesh& mesh, const FlowStepData& step, const FluidProperties& fluid, const NumericsControls& controls, const NodalData& nodal)
    :   mesh_(mesh), step_(step), fluid_(fluid), controls_(controls), nodal_(nodal), first_(TimeScheme::bdf(1, step.time.dt, 0))
    {}

    /// All that the momentum residual needs.
    void loadResidual(const int* elements, ElementKind kind)
    {
        elements_ = elements;
        data.isVarying = kind != ElementKind::Plain;
        isOneFluid_ = kind != ElementKind::Varying;
        loadShape();
        loadMaterials();
        loadHistory();
        for (int d = 0; d < D; ++d) data.advection[d] = mean([&](int i) { return nodal_.advection[std::size_t(i)*D + d]; });
        Real fineScale[D];
        for (int d = 0; d < D && step_.fineScale; ++d) fineScale[d] = ofElement(*step_.fineScale, d);
        rates_ = addFineScale<D, Real>(step_.fineScale ? fineScale : nullptr, h_, step_.time.dt, controls_, data);
        for (int d = 0; d < D; ++d) data.force[d] = step_.elementForce ? ofElement(*step_.elementForce, d) : Real{};
        for (int d = 0; d < D; ++d) data.viscousForce[d] = step_.viscousForce ? ofElement(*step_.viscousForce, d) : Real{};
        data.prepare();
    }

    /// The rest of what the matrix needs.
    void loadInertia()
    {
        data.streamlineDensity = data.rho;
        if (isOneFluid_) loadOneFluid();
        else loadTwoFluids();
        if (data.isVarying) loadConvection<D, Real>(pairFluxes(), lastFluxShare(step_), fluid_, controls_, data);
        const Real timeShare = gather<Real>([&](int l) { return gradDivTimeShare(nodes_[l], N, controls_, nodal_); });
        loadTauContinuity<D, Real>(rates_, h_, timeShare, step_, controls_, data);
    }

    /// value(node) of corner a.
    template<class Value>
    Real corner(int a, const Value& value) const
    {
        return gather<Real>([&](int l) { return value(nodes_[l][a]); });
    }

    ElementData<D, Real> data;

private:
    void loadShape()
    {
        const double* gradients[width];
        for (int l = 0; l < width; ++l)
        {
            nodes_[l] = &mesh_.elements[std::size_t(elements_[l])*N];
            gradients[l] = &mesh_.gradN[std::size_t(elements_[l])*N*D];
        }
        for (int k = 0; k < N*D; ++k) gradN_[k] = gather<Real>([&](int l) { return gradients[l][k]; });
        data.gradN = gradN_;
        data.volume = gather<Real>([&](int l) { return mesh_.volume[elements_[l]]; });
        h_ = gather<Real>([&](int l) { return mesh_.h[elements_[l]]; });
        for (int a = 0; a < N; ++a) data.first[a] = data.volume*(1.0/N);
    }

    void loadMaterials()
    {
        const auto rho = [&](int i) { return nodal_.rho[i]; };
        const auto mu = [&](int i) { return nodal_.mu[i]; };
        data.rho = isOneFluid_ ? corner(0, rho) : mean(rho);
        data.mu = isOneFluid_ && nodal_.eddy.empty() ? corner(0, mu) : mean(mu);
    }

    /// First order where the density is steep.
    void loadHistory()
    {
        const double* history[width];
        for (int l = 0; l < width; ++l)
        {
            const bool isFirst = !isOneFluid_ && std::any_of(nodes_[l], nodes_[l] + N, [&](int i) { return nodal_.own[i].isSteep; });
            time_[l] = isFirst ? &first_ : &step_.time;
            history[l] = isFirst ? step_.state->u.data() : nodal_.history.data();
        }
        data.c0 = gather<Real>([&](int l) { return time_[l]->c0; });
        const Real factor = gather<Real>([&](int l) { return time_[l] == &first_ ? -first_.c1 : 1; });
        for (int a = 0; a < N; ++a)
            for (int d = 0; d < D; ++d)
                data.history[a*D + d] = factor*gather<Real>([&](int l) { return history[l][std::size_t(nodes_[l][a])*D + d]; });
    }

    void loadOneFluid()
    {
        rhoOld_ = data.rho;
        data.inertia = data.c0*data.rho;    // c0 + c1 + c2 = 0
        for (int a = 0; a < N; ++a)
        {
            data.isSecondOrder[a] = Real{} + 1;
            data.nodalInertia[a] = data.inertia;
            data.densityRate[a] = data.forceShare[a] = Real{};
        }
        for (int k = 0; k < N*D; ++k) data.momentumHistory[k] = data.rho*data.history[k];
    }

    void loadTwoFluids()
    {
        rhoOld_ = mean([&](int i) { return nodal_.rhoOld[i]; });
        const Real rhoOlder = mean([&](int i) { return nodal_.rhoOlder[i]; });
        const Real c1 = gather<Real>([&](int l) { return time_[l]->c1; }), c2 = gather<Real>([&](int l) { return time_[l]->c2; });
        data.inertia = 0.5*(data.c0*data.rho - c1*rhoOld_ - c2*rhoOlder);
        Real least = data.inertia;
        for (int a = 0; a < N; ++a)
        {
            data.isSecondOrder[a] = corner(a, [&](int i) { return nodal_.own[i].isSecondOrder; });
            data.nodalInertia[a] = corner(a, [&](int i) { return nodal_.own[i].inertia; });
            data.densityRate[a] = corner(a, [&](int i) { return nodal_.own[i].densityRate; });
            data.forceShare[a] = corner(a, [&](int i) { return nodal_.rho[i]; })/data.rho - 1;
            for (int d = 0; d < D; ++d) data.momentumHistory[a*D + d] = corner(a, [&](int i) { return nodal_.own[i].momentumHistory[d]; });
            least = smaller<Real>(least, data.nodalInertia[a]);
        }
        data.streamlineDensity *= least/data.inertia;
    }

    PairFluxes<D, Real> pairFluxes() const
    {
        DualCellTransport::ElementFluxes of[width];
        const double* last[width];  // kept mass fluxes, or volume fluxes
        bool isKept[width];
        for (int l = 0; l < width; ++l)
        {
            of[l] = step_.transport->fluxes(elements_[l]);
            const double* kept = step_.massFluxes ? step_.massFluxes->of(elements_[l]) : nullptr;
            isKept[l] = kept;
            last[l] = kept ? kept : of[l].total;
        }
        const Real factor = gather<Real>([&](int l) { return isKept[l] ? 1 : lane(rhoOld_, l); });
        PairFluxes<D, Real> fluxes;
        fluxes.unkeptDensity = gather<Real>([&](int l) { return isKept[l] ? 0 : lane(rhoOld_, l); });
        for (int p = 0; p < fluxes.count; ++p)
        {
            fluxes.total[p] = gather<Real>([&](int l) { return of[l].total[p]; });
            fluxes.liquid[p] = gather<Real>([&](int l) { return of[l].liquid[p]; });
            fluxes.lastMass[p] = factor*gather<Real>([&](int l) { return last[l][p]; });
        }
        return fluxes;
    }

    template<class Value>
    Real mean(const Value& value) const
    {
        Real sum{};
        for (int a = 0; a < N; ++a) sum += (1.0/N)*corner(a, value);
        return sum;
    }

    Real ofElement(const std::vector<double>& values, int d) const
    {
        return gather<Real>([&](int l) { return values[std::size_t(elements_[l])*D + d]; });
    }

    const SimplexMesh& mesh_;
    const FlowStepData& step_;
    const FluidProperties& fluid_;
    const NumericsControls& controls_;
    const NodalData& nodal_;
    const TimeScheme first_;            // BDF1 of the step

    const int* elements_ = nullptr;
    const int* nodes_[width];
    const TimeScheme* time_[width];     // of the residual
    ElementRates<Real> rates_;
    bool isOneFluid_ = true;
    Real h_, rhoOld_, gradN_[N*D];
};

} // namespace flotsam
