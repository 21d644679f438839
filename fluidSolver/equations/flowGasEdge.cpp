// SPDX-License-Identifier: GPL-3.0-or-later
/// Edge of the gas that is computed, when gas far from the water is left out: open to gas at rest.
#include "equations/flowEquation.hpp"

#include "equations/gasRegion.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

constexpr double noLevel = 1e300;  // no boundary with a given pressure

} // namespace

double FlowEquation::gasPressure(int i) const
{
    double p = gasLevel_;
    for (int d = 0; d < mesh_.dim; ++d) p += fluid_.rhoGas*fluid_.gravity[mesh_.axes[d]]*mesh_.x[std::size_t(i)*mesh_.dim + d];
    return p;
}

/// Level of the pressures at the edge of the gas that is computed: those of gas at rest under the boundaries with a given pressure. Of these nodes that hold
/// the least liquid count (a given p_rgh means another p where water has reached the boundary), then the lowest.
void FlowEquation::fixGasEdge()
{
    if (!step_.gas) return;
    gasLevel_ = 0;
    const auto forNodes = [&](const auto& visit)
    {
        for (std::size_t p = 0; p < patches_.size(); ++p)
            for (std::size_t k = 0; patches_[p].pressure != BoundaryPatch::Pressure::Natural && k < patches_[p].nodes.size(); ++k)
                visit(patches_[p].nodes[k], (*step_.patchValues)[p].pressure[k]);
    };
    double leastLiquid = 1, level = noLevel;
    forNodes([&](int i, double) { leastLiquid = std::min(leastLiquid, step_.state->alpha[i]); });
    leastLiquid = halo_.min(leastLiquid);
    forNodes([&](int i, double pressure) { if (step_.state->alpha[i] <= leastLiquid) level = std::min(level, pressure - gasPressure(i)); });
    level = halo_.min(level);
    gasLevel_ = level < noLevel ? level : 0;
}

/// Terms of an open boundary on the faces between what is computed and what is left out.
template<int D>
void FlowEquation::assembleGasEdge()
{
    if (!step_.gas) return;
    double first[D], second[D*D];
    for (int k = 0; k < D; ++k) first[k] = 1./D;
    for (int k = 0; k < D*D; ++k) second[k] = (k % (D + 1) == 0 ? 2. : 1.)/(D*(D + 1));
    for (const InteriorFace& face : graph_.faces)
    {
        for (int side = 0; side < 2; ++side)
        {
            const int e = face.element[side], other = face.element[1 - side];
            const bool isOut = step_.gas->isLeftOut(other) && step_.cover->state[other] == ElementState::Solid;
            if (!isOut || step_.cover->state[e] == ElementState::Solid) continue;
            int nodes[D], count = 0;
            double v[D] = {}, pressure[D];
            for (int a = 0; a <= D; ++a)
            {
                const int i = mesh_.elements[std::size_t(e)*(D + 1) + a];
                if (i != face.opposite[side])
                {
                    pressure[count] = gasPressure(i);
                    nodes[count++] = i;
                }
                else
                    for (int d = 0; d < D; ++d) v[d] = -D*mesh_.volume[e]*mesh_.gradN[(std::size_t(e)*(D + 1) + a)*D + d];
            }
            addOpenFace<D>(nodes, v, first, second, pressure);
        }
    }
}

/// Gas that is left out is at rest.
void FlowEquation::applyGasEdge(std::vector<double>& x) const
{
    const int dim = mesh_.dim, B = dim + 1;
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        const bool isOut = !step_.cover->isActiveNode[i] && step_.cover->nearestSolid[i] < 0;
        if (isOut) std::fill_n(&x[std::size_t(i)*B], dim, 0.0);
        if (isOut || step_.gas->isEdge()[i]) x[std::size_t(i)*B + dim] = gasPressure(i);
    }
}

template void FlowEquation::assembleGasEdge<2>();
template void FlowEquation::assembleGasEdge<3>();

} // namespace flotsam
