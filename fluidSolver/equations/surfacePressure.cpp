// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/surfacePressure.hpp"

#include "core/patchFaces.hpp"
#include "equations/gravity.hpp"
#include "geometry/cutSimplex.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flotsam
{

namespace
{

/// A corner of a facet by the shape functions of its element.
template<int D>
struct Corner { double n[D + 1]; };

/// From a facet's symmetric points of quadrature (CutFacet), each weighed `own` at a corner of its own.
template<int D>
std::array<Corner<D>, D> cornersOf(const double (*shape)[4])
{
    constexpr double own = ownCornerWeight<D>, other = (1 - own)/(D - 1);
    std::array<Corner<D>, D> corners;
    for (int a = 0; a <= D; ++a)
    {
        double sum = 0;
        for (int q = 0; q < D; ++q) sum += shape[q][a];
        for (int q = 0; q < D; ++q) corners[q].n[a] = (shape[q][a] - other*sum)/(own - other);
    }
    return corners;
}

template<int D>
double valueAt(const Corner<D>& corner, const double* nodal)
{
    double value = 0;
    for (int a = 0; a <= D; ++a) value += corner.n[a]*nodal[a];
    return value;
}

template<int D>
Corner<D> zeroBetween(const Corner<D>& p, const Corner<D>& q, double atP, double atQ)
{
    Corner<D> result;
    for (int a = 0; a <= D; ++a) result.n[a] = (atP*q.n[a] - atQ*p.n[a])/(atP - atQ);
    return result;
}

/// Adds `factor` int N_a v over a piece of a facet, v linear (nodal). Exact.
template<int D>
void integrate(const std::array<Corner<D>, D>& corners, double area, const double* v, double factor, double* first)
{
    double sum = 0, at[D];
    for (int i = 0; i < D; ++i) sum += at[i] = valueAt<D>(corners[i], v);
    const double w = factor*area/(D*(D + 1));
    for (int i = 0; i < D; ++i)
        for (int a = 0; a <= D; ++a) first[a] += w*corners[i].n[a]*(sum + at[i]);
}

/// integrate() over the part where `level`, linear, is positive.
template<int D>
void integrateWet(std::array<Corner<D>, D> corners, double area, const double* level, const double* v, double factor, double* first)
{
    const auto isWet = [&](const Corner<D>& c) { return valueAt<D>(c, level) > 0; };
    const int nWet = int(std::partition(corners.begin(), corners.end(), isWet) - corners.begin());
    if (nWet == D) return integrate<D>(corners, area, v, factor, first);
    if (nWet == 0) return;
    if (nWet > 1)   // a triangle but for its dry corner
    {
        integrate<D>(corners, area, v, factor, first);
        std::reverse(corners.begin(), corners.end());
        factor = -factor;
    }
    const double alone = valueAt<D>(corners[0], level);
    for (int i = 1; i < D; ++i)
    {
        const double there = valueAt<D>(corners[i], level);
        corners[i] = zeroBetween<D>(corners[0], corners[i], alone, there);
        area *= alone/(alone - there);
    }
    integrate<D>(corners, area, v, factor, first);
}

/// Nodal values of an element with a profile.
template<int D>
struct ProfileElement
{
    double potential[D + 1], pressure[D + 1], level[D + 1]; // g.(x_k - x_G), rho_k times that, of the surface
    bool isAny;

    ProfileElement() = default;
    ProfileElement(const SimplexMesh& mesh, const FluidProperties& fluid, const InterfacePlanes& planes, const std::vector<double>& ofSurface,
        const std::vector<double>& levels, int e)
    {
        double g[D];
        for (int d = 0; d < D; ++d) g[d] = fluid.gravity[mesh.axes[d]];
        isAny = balancedPotentials<D>(mesh, g, planes, ofSurface, e, potential);
        for (int a = 0; isAny && a <= D; ++a)
        {
            const int i = mesh.elements[std::size_t(e)*(D + 1) + a];
            pressure[a] = ofSurface[i]*potential[a];
            level[a] = levels[i];
            // a level that the surface does not account for (spray, sheets) has no sharp surface
            if ((level[a] > 0) != (ofSurface[i] > 0.5*(fluid.rhoLiquid + fluid.rhoGas)) && std::abs(level[a]) > 0.25*mesh.h[e]) isAny = false;
        }
    }
};

/// Adds the difference on one facet; p: what is known of it but `first`.
template<int D>
void addDifference(const ProfileElement<D>& profile, const FluidProperties& fluid, double area, const std::array<Corner<D>, D>& corners, FacetPressure p,
    std::vector<FacetPressure>& result)
{
    integrate<D>(corners, area, profile.pressure, -1, p.first);
    integrate<D>(corners, area, profile.potential, fluid.rhoGas, p.first);
    integrateWet<D>(corners, area, profile.level, profile.potential, fluid.rhoLiquid - fluid.rhoGas, p.first);
    result.push_back(p);
}

template<int D>
void addSurfacePressureT(const SimplexMesh& mesh, const FluidProperties& fluid, const InterfacePlanes& planes, const std::vector<double>& ofSurface,
    const std::vector<double>& levels, const Cover& cover, std::vector<FacetPressure>& result)
{
    for (const CutElement& cut : cover.cuts)
    {
        if (cut.facetStart == cut.facetEnd) continue;
        const ProfileElement<D> profile(mesh, fluid, planes, ofSurface, levels, cut.element);
        for (int f = cut.facetStart; profile.isAny && f < cut.facetEnd; ++f)
        {
            const CutFacet& facet = cover.facets[f];
            FacetPressure p{cut.element, facet.solid, {}, {}, false};
            std::copy_n(facet.normal, D, p.normal);
            addDifference<D>(profile, fluid, facet.area, cornersOf<D>(facet.shape), p, result);
        }
    }
    int element = -1;   // that `profile` is of: pieces in one element follow each other
    ProfileElement<D> profile;
    for (const CoveredFacet& facet : cover.coveredFacets)
    {
        const double area = std::hypot(facet.area[0], facet.area[1], D == 3 ? facet.area[2] : 0.0);
        if (facet.element != element) profile = ProfileElement<D>(mesh, fluid, planes, ofSurface, levels, element = facet.element);
        if (!profile.isAny || area == 0) continue;
        FacetPressure p{facet.element, facet.solid, {}, {}, true};
        for (int d = 0; d < D; ++d) p.normal[d] = facet.area[d]/area;
        addDifference<D>(profile, fluid, facet.nPoints*area, cornersOf<D>(facet.shape), p, result);
    }
}

template<int D>
void addOnPatch(const SimplexMesh& mesh, const FluidProperties& fluid, const InterfacePlanes& planes, const std::vector<double>& ofSurface,
    const std::vector<double>& levels, const Cover* cover, const MeshPatch& patch, std::vector<FacetPressure>& result)
{
    for (std::size_t f = 0; f < patch.faceElement.size(); ++f)
    {
        const int e = patch.faceElement[f], *face = &patch.faceNodes[f*D], *nodes = &mesh.elements[std::size_t(e)*(D + 1)];
        const auto isInSolid = [&](int i) { return cover && cover->distance[i] < 0; };
        if (!patch.isOwnedFace[f] || std::any_of(face, face + D, isInSolid)) continue;
        const ProfileElement<D> profile(mesh, fluid, planes, ofSurface, levels, e);
        if (!profile.isAny) continue;
        std::array<Corner<D>, D> corners{};
        for (int k = 0; k < D; ++k) corners[k].n[std::find(nodes, nodes + D + 1, face[k]) - nodes] = 1;
        FacetPressure p{e, -1, {}, {}, false};
        outwardVector(mesh, patch, f, p.normal);
        const double area = std::hypot(p.normal[0], p.normal[1], D == 3 ? p.normal[2] : 0.0);
        for (int d = 0; d < D; ++d) p.normal[d] /= area;
        addDifference<D>(profile, fluid, area, corners, p, result);
    }
}

} // namespace

void addSurfacePressure(const SimplexMesh& mesh, const FluidProperties& fluid, const InterfacePlanes& planes, const std::vector<double>& ofSurface,
    const std::vector<double>& level, const Cover* cover, const MeshPatch& patch, std::vector<FacetPressure>& result)
{
    if (mesh.dim == 2) addOnPatch<2>(mesh, fluid, planes, ofSurface, level, cover, patch, result);
    else addOnPatch<3>(mesh, fluid, planes, ofSurface, level, cover, patch, result);
}

void addSurfacePressure(const SimplexMesh& mesh, const FluidProperties& fluid, const InterfacePlanes& planes, const std::vector<double>& ofSurface,
    const std::vector<double>& level, const Cover& cover, std::vector<FacetPressure>& result)
{
    if (mesh.dim == 2) addSurfacePressureT<2>(mesh, fluid, planes, ofSurface, level, cover, result);
    else addSurfacePressureT<3>(mesh, fluid, planes, ofSurface, level, cover, result);
}

} // namespace flotsam
