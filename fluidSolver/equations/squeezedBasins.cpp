// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/squeezedBasins.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace flotsam
{

namespace
{

constexpr int nSums = 4;    // of a solid: what it sweeps [m^dim/s], and its products with the place

Vec3 pointOf(const SimplexMesh& mesh, const CutFacet& facet, int q)
{
    Vec3 x = Vec3::Zero();
    for (int a = 0; a <= mesh.dim; ++a)
    {
        const std::array<double, 3> corner = mesh.spacePoint(mesh.elements[std::size_t(facet.element)*(mesh.dim + 1) + a]);
        for (int d = 0; d < 3; ++d) x[d] += facet.shape[q][a]*corner[d];
    }
    return x;
}

void add(const SimplexMesh& mesh, const CutFacet& facet, const Solid& solid, double* sums)
{
    for (int q = 0; q < facet.nPoints; ++q)
    {
        const Vec3 x = pointOf(mesh, facet, q), v = solid.velocityAt(x);
        double swept = 0;
        for (int d = 0; d < mesh.dim; ++d) swept += facet.weight[q]*facet.normal[d]*v[mesh.axes[d]];
        sums[0] += std::abs(swept);
        for (int d = 0; d < 3; ++d) sums[1 + d] += std::abs(swept)*x[d];
    }
}

} // namespace

std::string describeSqueezed(const SimplexMesh& mesh, const Halo& halo, const Cover& cover, const std::vector<Solid>& solids, const std::vector<int>& level)
{
    std::vector<double> sums(nSums*solids.size(), 0.0);
    for (const CutFacet& facet : cover.facets)
    {
        const int* nodes = &mesh.elements[std::size_t(facet.element)*(mesh.dim + 1)];
        if (level.empty() || !mesh.isOwnedElement[facet.element] || solids[facet.solid].kind != Solid::Kind::Prescribed) continue;
        if (std::any_of(nodes, nodes + mesh.dim + 1, [&](int i) { return level[i] >= 0; })) add(mesh, facet, solids[facet.solid], &sums[nSums*facet.solid]);
    }
    if (!solids.empty()) halo.sum(sums.data(), int(sums.size()));
    std::size_t most = 0;
    for (std::size_t s = 1; s < solids.size(); ++s)
        if (sums[nSums*s] > sums[nSums*most]) most = s;
    if (solids.empty() || sums[nSums*most] == 0) return "";
    const double* of = &sums[nSums*most];
    std::ostringstream text;
    text << '\'' << solids[most].name << "' about (" << of[1]/of[0] << ' ' << of[2]/of[0] << ' ' << of[3]/of[0] << ')';
    return text.str();
}

} // namespace flotsam
