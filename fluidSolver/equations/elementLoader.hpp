// SPDX-License-Identifier: GPL-3.0-or-later
/// Gathers what the volume terms of one element need from the nodal arrays.
#pragma once

#include "equations/elementTerms.hpp"
#include "equations/flowStep.hpp"
#include "equations/stabilisation.hpp"

#include <cmath>

namespace flotsam
{

/// False for an element without a fluid part. Sizes as in FlowEquation.
template<int D>
inline bool loadElementData(int e, const SimplexMesh& mesh, const FlowStepData& step, const NumericsControls& controls,
    const std::vector<double>& rho, const std::vector<double>& mu, const std::vector<double>& rhoRate,
    const std::vector<double>& advection, const std::vector<double>& history, ElementData<D>& data)
{
    constexpr int N = D + 1;
    const CutElement* cut = nullptr;
    if (step.cover)
    {
        const ElementState state = step.cover->state[e];
        if (state == ElementState::Solid) return false;
        if (state == ElementState::Cut) cut = &step.cover->cuts[step.cover->cutIndex[e]];
    }
    if (cut)
    {
        data.volume = cut->volume;
        for (int a = 0; a < N; ++a) data.first[a] = cut->first[a];
        for (int k = 0; k < N*N; ++k) data.second[k] = cut->second[k];
    }
    else
    {
        data.volume = mesh.volume[e];
        const double first = data.volume/N, off = data.volume/(N*(N + 1));
        for (int a = 0; a < N; ++a) data.first[a] = first;
        for (int k = 0; k < N*N; ++k) data.second[k] = off;
        for (int a = 0; a < N; ++a) data.second[a*(N + 1)] = 2*off;
    }
    const int* nodes = &mesh.elements[std::size_t(e)*N];
    data.gradN = &mesh.gradN[std::size_t(e)*N*D];
    data.rho = data.mu = data.rhoRate = 0;
    for (int d = 0; d < D; ++d) data.advection[d] = 0;
    const double inverse = 1/data.volume;
    for (int a = 0; a < N; ++a)
    {
        const int i = nodes[a];
        const double w = data.first[a]*inverse;
        data.rho += w*rho[i];
        data.mu += w*mu[i];
        data.rhoRate += w*rhoRate[i];
        for (int d = 0; d < D; ++d)
        {
            data.advection[d] += w*advection[std::size_t(i)*D + d];
            data.history[a*D + d] = history[std::size_t(i)*D + d];
        }
    }
    double speed = 0;
    for (int d = 0; d < D; ++d) speed += data.advection[d]*data.advection[d];
    speed = std::sqrt(speed);
    const double h = mesh.h[e], nu = data.mu/data.rho;
    data.tau = tauMomentum(step.time.dt, speed, h, nu);
    data.tauCont = controls.tauContFactor*tauContinuity(controls.tauContWithTimeStep, data.rho, speed, h, nu, data.tau);
    for (int d = 0; d < D; ++d)
        data.force[d] = step.elementForce ? (*step.elementForce)[std::size_t(e)*D + d] : 0;
    data.prepare();
    return true;
}

} // namespace flotsam
