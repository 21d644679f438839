// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/cellMeans.H"

#include <algorithm>

namespace flotsam
{

bool cellMean(const MeshAdapter& adapter, const Cover* cover, const std::vector<double>& nodal, int width, int cell, double* mean)
{
    const SimplexMesh& mesh = adapter.mesh;
    const int n = mesh.dim + 1;
    for (const bool fluidOnly : {true, false})
    {
        double volume = 0;
        std::fill_n(mean, width, 0.0);
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
                const double* v = &nodal[static_cast<std::size_t>(mesh.elements[e*n + a])*width];
                for (int j = 0; j < width; ++j) mean[j] += weight*v[j];
            }
        }
        if (volume <= 0) continue;
        for (int j = 0; j < width; ++j) mean[j] /= volume;
        return fluidOnly;
    }
    return false;
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
