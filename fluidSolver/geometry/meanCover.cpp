// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/meanCover.hpp"

namespace flotsam
{

namespace
{

void addHalf(const SimplexMesh& mesh, const Cover& cover, int e, CutElement& sum)
{
    const int n = mesh.dim + 1;
    if (cover.state[e] == ElementState::Solid) return;
    if (cover.state[e] == ElementState::Cut)
    {
        const CutElement& cut = cover.cuts[cover.cutIndex[e]];
        sum.volume += 0.5*cut.volume;
        for (int a = 0; a < n; ++a) sum.first[a] += 0.5*cut.first[a];
        for (int k = 0; k < n*n; ++k) sum.second[k] += 0.5*cut.second[k];
        return;
    }
    const double volume = 0.5*mesh.volume[e];
    sum.volume += volume;
    for (int a = 0; a < n; ++a)
    {
        sum.first[a] += volume/n;
        for (int b = 0; b < n; ++b) sum.second[a*n + b] += volume*(a == b ? 2 : 1)/(n*(n + 1));
    }
}

} // namespace

void keepForMean(const Cover& cover, Cover& kept)
{
    kept.distance = cover.distance;
    kept.state = cover.state;
    kept.cutIndex = cover.cutIndex;
    kept.cuts = cover.cuts;
    kept.facets = cover.facets;
    kept.patchFaces = cover.patchFaces;
    kept.isActiveNode = cover.isActiveNode;
}

void setMeanCover(const SimplexMesh& mesh, const Cover& start, const Cover& end, Cover& mean)
{
    mean.start = &start;
    mean.end = &end;
    mean.state = end.state;
    mean.isActiveNode = start.isActiveNode; // the phase field that is moved has values of the fluid there
    mean.cutIndex.assign(mesh.nElements, -1);
    mean.cuts.clear();
    for (int e = 0; e < mesh.nElements; ++e)
    {
        if (start.state[e] == end.state[e] && end.state[e] != ElementState::Cut) continue;
        mean.state[e] = ElementState::Cut;
        mean.cutIndex[e] = static_cast<int>(mean.cuts.size());
        CutElement& cut = mean.cuts.emplace_back();
        cut.element = e;
        addHalf(mesh, start, e, cut);
        addHalf(mesh, end, e, cut);
    }
}

} // namespace flotsam
