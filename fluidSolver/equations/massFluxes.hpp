// SPDX-License-Identifier: GPL-3.0-or-later
/// Mass fluxes of the last time step. BDF2 of a density that the transport moves is balanced by fluxes at the end of the step, extrapolated from
/// the means over this step and the last: c0 m^(n+1) + c1 m^n + c2 m^(n-1) = -(1 + x) sum F^(n+1/2) + x sum F^(n-1/2), x = dt/(dt + dtOld).
#pragma once

#include "core/simplexMesh.hpp"
#include "equations/dualCellTransport.hpp"
#include "equations/materials.hpp"

#include <array>
#include <vector>

namespace flotsam
{

/// Mean over the step of the mass that flows between two nodes of an element [kg/s per thickness]: what flows has the density of its share of liquid.
template<class Real = double>
inline Real massFlux(const typename AsGiven<Real>::Type& liquidFlux, const typename AsGiven<Real>::Type& totalFlux, const FluidProperties& fluid, const NumericsControls& controls)
{
    // fluxes may be as small as 1e-310: the quotient only where it is below 1
    const Real liquid = absolute<Real>(liquidFlux), total = absolute<Real>(totalFlux), one = Real{} + 1;
    const Real quotient = liquid < total ? liquid/(liquid < total ? total : one) : one;
    const Real alpha = (liquidFlux > 0) == (totalFlux > 0) ? quotient : Real{};
    return density<Real>(fluid, controls, alpha)*totalFlux;
}

class MassFluxes
{
public:
    MassFluxes(const SimplexMesh& mesh, const FluidProperties& fluid, const NumericsControls& controls);

    /// Keeps those of the transport's last step in elements in which the density varied at its start or end. alphaOld, alpha: nNodes, both levels.
    void keep(const DualCellTransport& transport, const std::vector<double>& alphaOld, const std::vector<double>& alpha);

    /// Of the pairs of an element's corners in the order of CornerPairs; null where the density did not vary.
    const double* of(int element) const { return at_.empty() || at_[element] < 0 ? nullptr : &values_[std::size_t(at_[element])*nPairs_]; }

    /// Those of elements for which isVoid(element) count no more.
    template<class IsVoid>
    void drop(IsVoid isVoid)
    {
        std::vector<double> left;
        const std::vector<double> all = records();
        const std::size_t length = nPairs_ + 1;
        for (auto at = all.begin(); at != all.end(); at += std::ptrdiff_t(length))
            if (!isVoid(int(*at))) left.insert(left.end(), at, at + std::ptrdiff_t(length));
        setRecords(left);
    }

    /// Part of a run's state: element and fluxes of every element kept.
    std::vector<double> records() const;
    void setRecords(const std::vector<double>& records);

private:
    void setShares(const std::vector<double>& alphaOld, const std::vector<double>& alpha);
    bool isVarying(int element) const;
    void clear();

    const SimplexMesh& mesh_;
    const FluidProperties& fluid_;
    const NumericsControls& controls_;
    const int nPairs_;
    std::vector<int> at_;           // per element: its place among those kept, -1
    std::vector<int> elements_;     // those kept
    std::vector<double> values_;
    std::vector<std::array<double, 2>> share_;  // nNodes: the liquid's, as densities could be those of both fluids; at the start and at the end of the step that keep() is about
};

} // namespace flotsam
