// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/liquidPlace.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

constexpr double mostlyLiquid = 0.5;
constexpr double roundOff = 1e-6;       // of the height of the mesh
constexpr double noHeight = 1e-9;       // of that: 0
constexpr double gasBelow = 0.25;       // of it that has no liquid
constexpr double atRest = 1e-3;         // of the speed that the height of the mesh gives what falls

} // namespace

LiquidPlace liquidPlace(const SimplexMesh& mesh, const Halo& halo, const FlowState& state, const std::array<double, 3>& gravity)
{
    const double strength = std::hypot(gravity[0], gravity[1], gravity[2]);
    const int n = mesh.dim + 1;
    std::vector<double> height(mesh.nNodes);
    double low = 1e300, high = -1e300, bottom = 1e300, top = -1e300, fastest = 0;
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        const auto x = mesh.spacePoint(i);
        height[i] = 0.0 - (gravity[0]*x[0] + gravity[1]*x[1] + gravity[2]*x[2])/strength;    // no -0
        bottom = std::min(bottom, height[i]);
        top = std::max(top, height[i]);
        if (state.alpha[i] <= mostlyLiquid) continue;
        low = std::min(low, height[i]);
        high = std::max(high, height[i]);
        double square = 0;
        for (int d = 0; d < mesh.dim; ++d) square += state.u[std::size_t(i)*mesh.dim + d]*state.u[std::size_t(i)*mesh.dim + d];
        fastest = std::max(fastest, std::sqrt(square));
    }
    double sums[5] = {};    // volumes and moments of liquid and gas; the liquid of the start field's cells
    if (!state.startLiquid.volume.empty())
        for (int i = 0; i < mesh.nOwned; ++i) sums[4] += mesh.thickness*state.startLiquid.volume[i];
    const auto surfaceBetween = [&](int wet, int dry)
    {
        const double a = state.alpha[wet], b = state.alpha[dry];
        if (!(a > mostlyLiquid && b <= mostlyLiquid)) return;
        const double h = height[wet] + (height[dry] - height[wet])*(a - mostlyLiquid)/(a - b);
        low = std::min(low, h);
        high = std::max(high, h);
    };
    for (int e = 0; e < mesh.nElements; ++e)
    {
        if (!mesh.isOwnedElement[e]) continue;
        for (int a = 0; a < n; ++a)
        {
            const int i = mesh.elements[std::size_t(e)*n + a];
            const double share = mesh.thickness*mesh.volume[e]/n, liquid = share*state.alpha[i], gas = share - liquid;
            const double parts[4] = {liquid, gas, liquid*height[i], gas*height[i]};
            for (int k = 0; k < 4; ++k) sums[k] += parts[k];
            for (int b = 0; b < n; ++b) surfaceBetween(i, mesh.elements[std::size_t(e)*n + b]);
        }
    }
    halo.sum(sums, 5);
    LiquidPlace place;
    place.liquid = state.startLiquid.volume.empty() ? sums[0] : sums[4];
    place.gas = sums[0] + sums[1] - place.liquid;
    place.lowest = halo.min(low);
    place.highest = halo.max(high);
    place.bottom = halo.min(bottom);
    place.top = halo.max(top);
    for (double* z : {&place.lowest, &place.highest, &place.bottom, &place.top})  // of meshes that stand at an angle
        if (std::abs(*z) < noHeight*(place.top - place.bottom)) *z = 0;
    place.meanLiquid = sums[0] > 0 ? sums[2]/sums[0] : 0;
    place.meanGas = sums[1] > 0 ? sums[3]/sums[1] : 0;
    place.fastest = halo.max(fastest);
    return place;
}

bool hangsFromTop(const LiquidPlace& place, double gravity)
{
    const double height = place.top - place.bottom;
    return place.highest >= place.top - roundOff*height && place.lowest > place.bottom + gasBelow*height && place.meanLiquid > place.meanGas
        && place.fastest <= atRest*std::sqrt(gravity*height);
}

} // namespace flotsam
