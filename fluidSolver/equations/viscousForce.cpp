// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/viscousForce.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

/// Viscous rate over the transient one, mu dt/(2 rho h^2), of the smallest element, up to which the residual does without the viscous force.
constexpr double leastShare = 1e-3;

/// Ratio of densities within an element from which the velocity has a kink there.
constexpr double kinkDensity = 1.01;

bool isFluid(const Cover* cover, int e) { return !cover || cover->state[e] != ElementState::Solid; }

} // namespace

ViscousForce::ViscousForce(const SimplexMesh& mesh, const Halo& halo) : mesh_(mesh), halo_(halo), gradients_(mesh, halo), leastLength_(1e30)
{
    for (double h : mesh.h) leastLength_ = std::min(leastLength_, h);
    leastLength_ = halo.min(leastLength_);
}

bool ViscousForce::find(const std::vector<double>& rho, const std::vector<double>& mu, const std::vector<double>& u, const Cover* cover, double dt)
{
    double nu = 0;
    for (int i = 0; i < mesh_.nNodes; ++i) nu = std::max(nu, mu[i]/rho[i]);
    if (0.5*halo_.max(nu)*dt < leastShare*leastLength_*leastLength_) return false;
    markKinks(rho);
    gradients_.find(u, cover);
    if (mesh_.dim == 2) findForces<2>(mu, cover); else findForces<3>(mu, cover);
    return true;
}

void ViscousForce::markKinks(const std::vector<double>& rho)
{
    const int n = mesh_.dim + 1;
    isKink_.assign(mesh_.nNodes, 0);
    for (int e = 0; e < mesh_.nElements; ++e)
    {
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        double least = rho[nodes[0]], most = least;
        for (int a = 1; a < n; ++a)
        {
            least = std::min(least, rho[nodes[a]]);
            most = std::max(most, rho[nodes[a]]);
        }
        for (int a = 0; a < n && most > kinkDensity*least; ++a) isKink_[nodes[a]] = 1;
    }
    halo_.update(isKink_, 1);
}

template<int D>
void ViscousForce::findForces(const std::vector<double>& mu, const Cover* cover)
{
    constexpr int N = D + 1;
    values_.assign(std::size_t(mesh_.nElements)*D, 0.0);
    for (int e = 0; e < mesh_.nElements; ++e)
    {
        const int* nodes = &mesh_.elements[std::size_t(e)*N];
        if (!isFluid(cover, e) || std::any_of(nodes, nodes + N, [&](int i) { return isKink_[i]; })) continue;
        double force[D] = {};
        for (int a = 0; a < N; ++a)
        {
            const double *ga = &mesh_.gradN[(std::size_t(e)*N + a)*D], *gradient = gradients_.at(nodes[a]);
            for (int k = 0; k < D; ++k)
                for (int l = 0; l < D; ++l) force[k] += mu[nodes[0]]*gradient[k*D + l]*ga[l];
        }
        std::copy(force, force + D, &values_[std::size_t(e)*D]);
    }
}

} // namespace flotsam
