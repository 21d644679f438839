// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/cellMeans.H"

namespace flotsam
{

namespace
{

/// n: corners of an element. For every cell in every step that function objects look at: loops whose lengths the compiler knows.
template<int n>
bool cellMeanT(const MeshAdapter& adapter, const Cover* cover, const std::vector<double>& nodal, int cell, double* mean)
{
    constexpr int width = nodalWidth;
    const SimplexMesh& mesh = adapter.mesh;
    for (const bool fluidOnly : {true, false})
    {
        double volume = 0;
        double sum[width] = {};
        for (int k = adapter.cellStart[cell]; k < adapter.cellStart[cell + 1]; ++k)
        {
            const int e = adapter.cellElements[k];
            const ElementState state = cover && fluidOnly ? cover->state[e] : ElementState::Fluid;
            if (state == ElementState::Solid) continue;
            const CutElement* cut = state == ElementState::Cut ? &cover->cuts[cover->cutIndex[e]] : nullptr;
            volume += cut ? cut->volume : mesh.volume[e];
            for (int a = 0; a < n; ++a)
            {
                const double weight = cut ? cut->first[a] : mesh.volume[e]/n;
                const double* v = &nodal[static_cast<std::size_t>(mesh.elements[std::size_t(e)*n + a])*width];
                for (int j = 0; j < width; ++j) sum[j] += weight*v[j];
            }
        }
        for (int j = 0; j < width; ++j) mean[j] = volume > 0 ? sum[j]/volume : 0;
        if (volume > 0) return fluidOnly;
    }
    return false;
}

} // namespace

bool cellMean(const MeshAdapter& adapter, const Cover* cover, const std::vector<double>& nodal, int cell, double* mean)
{
    return adapter.mesh.dim == 2 ? cellMeanT<3>(adapter, cover, nodal, cell, mean) : cellMeanT<4>(adapter, cover, nodal, cell, mean);
}

double liquidFraction(const MeshAdapter& adapter, const Cover* cover, const std::vector<double>& shares, int cell, double otherwise)
{
    const SimplexMesh& mesh = adapter.mesh;
    const int n = mesh.dim + 1;
    double liquid = 0, volume = 0;
    for (int k = adapter.cellStart[cell]; k < adapter.cellStart[cell + 1]; ++k)
    {
        const std::size_t e = adapter.cellElements[k];
        if (cover && cover->state[e] == ElementState::Solid) continue;
        volume += fluidVolume(mesh, cover, int(e));
        for (int a = 0; a < n; ++a) liquid += shares[e*n + a];
    }
    return volume > 0 ? liquid/volume : otherwise;
}

} // namespace flotsam
