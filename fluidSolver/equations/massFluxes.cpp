// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/massFluxes.hpp"

#include <algorithm>

namespace flotsam
{

MassFluxes::MassFluxes(const SimplexMesh& mesh, const FluidProperties& fluid, const NumericsControls& controls)
:   mesh_(mesh), fluid_(fluid), controls_(controls), nPairs_(mesh.dim == 2 ? CornerPairs<2>::count : CornerPairs<3>::count)
{}

void MassFluxes::setShares(const std::vector<double>& alphaOld, const std::vector<double>& alpha)
{
    share_.resize(mesh_.nNodes);
    for (int i = 0; i < mesh_.nNodes; ++i) share_[i] = {liquidShare(controls_, alphaOld[i]), liquidShare(controls_, alpha[i])};
}

bool MassFluxes::isVarying(int element) const
{
    if (fluid_.rhoLiquid == fluid_.rhoGas) return false;
    const int n = mesh_.dim + 1;
    const int* nodes = &mesh_.elements[std::size_t(element)*n];
    const double first = share_[nodes[0]][0];
    return std::any_of(nodes, nodes + n, [&](int i) { return share_[i][0] != first || share_[i][1] != first; });
}

void MassFluxes::clear()
{
    at_.resize(mesh_.nElements, -1);
    for (int e : elements_) at_[e] = -1;
    elements_.clear();
    values_.clear();
}

void MassFluxes::keep(const DualCellTransport& transport, const std::vector<double>& alphaOld, const std::vector<double>& alpha)
{
    clear();
    setShares(alphaOld, alpha);
    for (int e = 0; e < mesh_.nInnerElements; ++e)
    {
        if (!isVarying(e)) continue;
        const DualCellTransport::ElementFluxes fluxes = transport.fluxes(e);
        if (!fluxes.total) continue;
        at_[e] = int(elements_.size());
        elements_.push_back(e);
        for (int p = 0; p < nPairs_; ++p) values_.push_back(massFlux(fluxes.liquid[p], fluxes.total[p], fluid_, controls_));
    }
}

std::vector<double> MassFluxes::records() const
{
    std::vector<double> result;
    result.reserve(elements_.size()*(nPairs_ + 1));
    for (std::size_t k = 0; k < elements_.size(); ++k)
    {
        result.push_back(elements_[k]);
        result.insert(result.end(), &values_[k*nPairs_], &values_[k*nPairs_] + nPairs_);
    }
    return result;
}

void MassFluxes::setRecords(const std::vector<double>& records)
{
    clear();
    for (std::size_t k = 0; k + nPairs_ < records.size(); k += nPairs_ + 1)
    {
        at_[int(records[k])] = int(elements_.size());
        elements_.push_back(int(records[k]));
        values_.insert(values_.end(), &records[k + 1], &records[k + 1] + nPairs_);
    }
}

} // namespace flotsam
