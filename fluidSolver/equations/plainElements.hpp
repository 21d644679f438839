// SPDX-License-Identifier: GPL-3.0-or-later
/// Plain elements, most of all: no solid cuts them, one fluid fills them at every time level. They are computed several at once, one in each lane.
#pragma once

#include "equations/elementLoader.hpp"

namespace flotsam
{

/// Whether the element may be computed with others. What elementLoader.hpp distinguishes does not arise in it.
template<int D>
inline bool isPlain(int e, const SimplexMesh& mesh, const FlowStepData& step, const NodalData& nodal)
{
    if (step.cover && step.cover->state[e] != ElementState::Fluid) return false;
    if (step.transport && step.transport->fluxes(e).total) return false;
    const int* nodes = &mesh.elements[std::size_t(e)*(D + 1)];
    bool isOne = nodal.fluid[nodes[0]] != NodalData::Mixed;
    for (int a = 1; a <= D; ++a) isOne &= nodal.fluid[nodes[a]] == nodal.fluid[nodes[0]];
    return isOne;
}

/// What loadElementData() gives for plain elements, a lane for each.
template<int D, class Real>
struct PlainElements
{
    static constexpr int N = D + 1, width = widthOf<Real>;

    ElementData<D, Real> data;
    ElementRates<Real> rates;
    Real h, gradN[N*D];
    const int* nodes[width];

    /// All that the momentum residual needs.
    void loadResidual(const int* elements, const SimplexMesh& mesh, const FlowStepData& step, const NumericsControls& controls, const NodalData& nodal)
    {
        const double* gradients[width];
        for (int l = 0; l < width; ++l)
        {
            nodes[l] = &mesh.elements[std::size_t(elements[l])*N];
            gradients[l] = &mesh.gradN[std::size_t(elements[l])*N*D];
        }
        for (int k = 0; k < N*D; ++k) gradN[k] = gather<Real>([&](int l) { return gradients[l][k]; });
        data.gradN = gradN;
        data.volume = gather<Real>([&](int l) { return mesh.volume[elements[l]]; });
        data.rho = ofNode(nodal.rho.data(), 1, 0, 0);
        data.mu = ofNode(nodal.mu.data(), 1, 0, 0);
        data.c0 = step.time.c0;
        h = gather<Real>([&](int l) { return mesh.h[elements[l]]; });
        for (int d = 0; d < D; ++d) data.advection[d] = Real{};
        for (int a = 0; a < N; ++a)
        {
            data.first[a] = data.volume*(1.0/N);
            for (int d = 0; d < D; ++d)
            {
                data.advection[d] += (1.0/N)*ofNode(nodal.advection.data(), D, a, d);
                data.history[a*D + d] = ofNode(nodal.history.data(), D, a, d);
            }
        }
        Real fineScale[D];
        for (int d = 0; d < D && step.fineScale; ++d) fineScale[d] = ofElement(*step.fineScale, elements, d);
        rates = addFineScale<D, Real>(step.fineScale ? fineScale : nullptr, h, step.time.dt, controls, data);
        for (int d = 0; d < D; ++d) data.force[d] = step.elementForce ? ofElement(*step.elementForce, elements, d) : Real{};
        for (int d = 0; d < D; ++d) data.viscousForce[d] = step.viscousForce ? ofElement(*step.viscousForce, elements, d) : Real{};
        data.prepare();
    }

    /// The rest of what the matrix needs.
    void loadInertia(const NumericsControls& controls)
    {
        data.inertia = data.c0*data.rho;    // c0 + c1 + c2 = 0
        data.streamlineDensity = data.rho;
        for (int a = 0; a < N; ++a) data.densityRate[a] = Real{};
        for (int k = 0; k < N*D; ++k) data.momentumHistory[k] = data.rho*data.history[k];
        loadTauContinuity<D, Real>(rates, h, controls, data);
    }

    /// Component d of corner a of an array with `stride` numbers for each node.
    Real ofNode(const double* values, int stride, int a, int d) const
    {
        return gather<Real>([&](int l) { return values[std::size_t(nodes[l][a])*stride + d]; });
    }

    static Real ofElement(const std::vector<double>& values, const int* elements, int d)
    {
        return gather<Real>([&](int l) { return values[std::size_t(elements[l])*D + d]; });
    }
};

} // namespace flotsam
