// SPDX-License-Identifier: GPL-3.0-or-later
/// CoverBuilder: exact volumes of slip solids at rest, which may reach through the mesh's boundary. Their part inside the mesh is integrated once on
/// subdivided elements; the linear cut is then moved to take out as much. Two elements a pipe, it would lose 17 % of it, and widen the openings.
/// No-slip solids keep the linear cut: their drag, too large on coarse meshes, is nearer with it (docs/numerics.md).
#include "geometry/coverBuilder.hpp"
#include "geometry/cutSimplex.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flotsam
{
namespace
{

constexpr int nLevels = 3;          // of subdivision: what the linear cut loses falls 64-fold
constexpr int nNewtonSteps = 6;

/// A simplex in space with the signed distance at its corners.
template <int dim>
struct Piece
{
    std::array<Vec3, dim + 1> x;
    std::array<double, dim + 1> distance;
};

double distanceTo(const Solid& solid, const Vec3& x)
{
    const double d = solid.distance(x);
    return d != 0 ? d : -1e-300;
}

template <int dim>
double longestEdge(const std::array<Vec3, dim + 1>& x)
{
    double square = 0;
    for (int a = 0; a <= dim; ++a)
        for (int b = 0; b < a; ++b) square = std::max(square, (x[a] - x[b]).squaredNorm());
    return std::sqrt(square);
}

/// Red refinement: 2^dim simplices of equal volume, by corner numbers; 0 .. dim: corners, then the edges' middles 01, 02, (03,) 12, (13, 23).
constexpr int trianglesOf[4][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}, {3, 5, 4}};
constexpr int tetrahedraOf[8][4] = {{0, 4, 5, 6}, {4, 1, 7, 8}, {5, 7, 2, 9}, {6, 8, 9, 3}, {4, 9, 5, 6}, {4, 9, 6, 8}, {4, 9, 8, 7}, {4, 9, 7, 5}};

/// Share of the simplex inside the solid (0..1).
template <int dim>
double solidShare(const Solid& solid, const Piece<dim>& piece, int level)
{
    const double longest = longestEdge<dim>(piece.x);
    int nSolid = 0;
    for (const double d : piece.distance)
    {
        if (std::abs(d) >= longest) return d < 0 ? 1 : 0;
        if (d < 0) ++nSolid;
    }
    if (level == 0)
    {
        if (nSolid == 0 || nSolid == dim + 1) return nSolid == 0 ? 0 : 1;
        return 1 - fluidFraction<dim>(piece.distance.data()).value;
    }
    constexpr int nPoints = (dim + 1) * (dim + 2) / 2;
    std::array<Vec3, nPoints> x;
    std::array<double, nPoints> distance; // of each point once, not in every child: it is what this costs
    std::copy(piece.x.begin(), piece.x.end(), x.begin());
    std::copy(piece.distance.begin(), piece.distance.end(), distance.begin());
    int n = dim + 1;
    for (int a = 0; a <= dim; ++a)
        for (int b = a + 1; b <= dim; ++b, ++n)
        {
            x[n] = 0.5 * (piece.x[a] + piece.x[b]);
            distance[n] = distanceTo(solid, x[n]);
        }
    double share = 0;
    constexpr int nChildren = 1 << dim;
    for (int k = 0; k < nChildren; ++k)
    {
        Piece<dim> child;
        for (int a = 0; a <= dim; ++a)
        {
            int point;
            if constexpr (dim == 2) point = trianglesOf[k][a];
            else point = tetrahedraOf[k][a];
            child.x[a] = x[point];
            child.distance[a] = distance[point];
        }
        share += solidShare<dim>(solid, child, level - 1) / nChildren;
    }
    return share;
}

template <int dim>
double solidShareOf(const SimplexMesh& mesh, const Solid& solid, const int* nodes)
{
    Piece<dim> piece;
    for (int a = 0; a <= dim; ++a)
    {
        const auto y = mesh.spacePoint(nodes[a]);
        piece.x[a] = Vec3(y[0], y[1], y[2]);
        piece.distance[a] = distanceTo(solid, piece.x[a]);
    }
    return solidShare<dim>(solid, piece, nLevels);
}

} // namespace

double CoverBuilder::volumeInside(const Solid& solid, const std::vector<Sample>& samples)
{
    double volume = 0;
    ++mark_;
    for (const Sample& s : samples)
        for (int k = graph_.nodeElementStart[s.node]; k < graph_.nodeElementStart[s.node + 1]; ++k)
        {
            const int e = graph_.nodeElement[k];
            if (!mesh_.isOwnedElement[e] || !firstVisit(elementMark_, e)) continue;
            volume += mesh_.volume[e] * (mesh_.dim == 2 ? solidShareOf<2>(mesh_, solid, nodesOf(e)) : solidShareOf<3>(mesh_, solid, nodesOf(e)));
        }
    return volume;
}

void CoverBuilder::correctFixedOffsets(std::vector<Solid>& solids)
{
    struct Moved { Solid* solid; std::vector<Sample> samples; };
    std::vector<Moved> moved;
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
        if (solids[s].kind != Solid::Kind::Fixed || solids[s].wall != Solid::Wall::Slip || !needsOffsets(solids[s])) continue;
        if (hasFixedCover_ && s < fixedSolids_.size() && isSameFixed(solids[s], fixedSolids_[s])) continue;
        solids[s].offset = 0;
        moved.push_back({&solids[s], {}});
        sample(solids[s], moved.back().samples);
    }
    if (moved.empty()) return;
    std::vector<double> exact;
    for (const Moved& m : moved) exact.push_back(volumeInside(*m.solid, m.samples));
    halo_.sum(exact.data(), static_cast<int>(exact.size()));
    for (int step = 0; step < nNewtonSteps; ++step)
    {
        std::vector<double> sums;
        for (const Moved& m : moved)
        {
            const OwnCut own = cutAlone(*m.solid, m.samples);
            sums.insert(sums.end(), {own.volume[0], own.surface(0, 0), own.areaTimesH});
        }
        halo_.sum(sums.data(), static_cast<int>(sums.size()));
        for (std::size_t k = 0; k < moved.size(); ++k)
        {
            const double volume = sums[3 * k], area = sums[3 * k + 1], areaTimesH = sums[3 * k + 2];
            if (!(area > 0)) continue;
            const double limit = largestOffset * areaTimesH / area;
            moved[k].solid->offset = std::clamp(moved[k].solid->offset + (exact[k] - volume) / area, -limit, limit);
        }
    }
}

} // namespace flotsam
