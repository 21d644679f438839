// SPDX-License-Identifier: GPL-3.0-or-later
/// CoverBuilder: the part that works element by element, and what follows from the elements' states.
#include "geometry/coverBuilder.hpp"
#include "geometry/simplexDivision.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace flotsam
{
namespace
{

// a facet below this, beside a solid part below negligiblePart, comes from nodes that were set just inside a surface: ten times what their depth (nodeSnap) times an edge makes
constexpr double negligibleFacet = 1e-8;

// times nodeSnap: what is that far outside; a hole that is left is that much smaller than a face
constexpr double clearance = 1e7;

template <int dim>
SimplexCut<dim> wholeSimplex(double volume)
{
    SimplexCut<dim> whole{};
    SimplexPoint<dim> corners[dim + 1] = {};
    for (int a = 0; a <= dim; ++a) corners[a].n[a] = 1;
    addPart<dim>(whole, corners, volume, volume);
    return whole;
}

} // namespace

/// isPlain: near one solid alone, a union that is not thin. Where one part of it is near it is cut as other solids are, else part by part.
void CoverBuilder::cutElement(Cover& cover, const std::vector<Solid>& solids, int element) const
{
    const bool isPlain = isAmongSharp(element) && sharpElement_[element] == SharpElement::Alone && !solids[cover.nearestSolid[nodesOf(element)[0]]].isThin;
    if (isAmongSharp(element) && !isPlain) return mesh_.dim == 2 ? cutElementOfSolids<2>(cover, solids, element) : cutElementOfSolids<3>(cover, solids, element);
    double distance[4];
    int nSolid = 0;
    for (int a = 0; a <= mesh_.dim; ++a)
    {
        distance[a] = cover.distance[nodesOf(element)[a]];
        if (distance[a] < 0) ++nSolid;
    }
    if (onlyTouches(element, distance, nSolid)) nSolid = 0;
    cover.cutIndex[element] = -1;
    if (nSolid == mesh_.dim + 1 && !(isPlain && hasSeveralParts(face_, element))) cover.state[element] = ElementState::Solid;
    else if (nSolid == 0 && !isAtEdgeOfOne(cover, element) && !endsAtEdge(cover, element)) cover.state[element] = ElementState::Fluid;
    else if (mesh_.dim == 2) cutElementOf<2>(cover, solids, element, distance);
    else cutElementOf<3>(cover, solids, element, distance);
}

/// A corner or an edge of the element lies on a surface to round-off, the rest clearly outside: a matter of which nodes, not of how small a part their snapped distances cut
/// off. With a node of the rest as near as that to the surface a face of the element lies on it in part, which the element beyond the face has cut off, too: without this
/// element's part the surface had a hole as large as the face. nInside: nodes inside of the distance.
bool CoverBuilder::onlyTouches(int element, const double* distance, int nInside) const
{
    if (nInside == 0) return true;
    if (nInside >= mesh_.dim) return false;
    for (int a = 0; a <= mesh_.dim; ++a)
        if (distance[a] < (distance[a] < 0 ? -1 : clearance) * snap_[nodesOf(element)[a]]) return false;
    return true;
}

/// Between two solids the least of the distances is cut: linear.
bool CoverBuilder::isAtEdgeOfOne(const Cover& cover, int element) const
{
    const int* nodes = nodesOf(element);
    if (cover.nearestSolid[nodes[0]] < 0 || !isAtEdge(face_, element)) return false;
    for (int a = 1; a <= mesh_.dim; ++a)
        if (cover.nearestSolid[nodes[a]] != cover.nearestSolid[nodes[0]]) return false;
    return true;
}

/// An element of several solids, at the face opposite to `corner`: an edge of one of them passes through the face, and is cut beyond it.
bool CoverBuilder::endsAtEdge(const Cover& cover, int element, int corner) const
{
    const int f = elementFace_[std::size_t(element) * (mesh_.dim + 1) + corner], *nodes = nodesOf(element), first = corner == 0;
    if (f < 0) return false;
    bool isMixed = false;
    for (int a = 0; a <= mesh_.dim; ++a)
    {
        if (a == corner) continue;
        if (cover.nearestSolid[nodes[a]] != cover.nearestSolid[nodes[first]]) return false;
        isMixed = isMixed || face_[nodes[a]] != face_[nodes[first]];
    }
    const int* sides = graph_.faces[f].element;
    const int beyond = sides[sides[0] == element];
    return isMixed && (isAmongSharp(beyond) ? sharpElement_[beyond] != SharpElement::Joined : isAtEdgeOfOne(cover, beyond));
}

bool CoverBuilder::endsAtEdge(const Cover& cover, int element) const
{
    if (!isAtEdge(face_, element)) return false;
    for (int corner = 0; corner <= mesh_.dim; ++corner)
        if (endsAtEdge(cover, element, corner)) return true;
    return false;
}

template <int dim>
std::array<double, (dim + 1) * dim> CoverBuilder::verticesOf(int element) const
{
    std::array<double, (dim + 1) * dim> vertices;
    for (int a = 0; a <= dim; ++a)
        for (int d = 0; d < dim; ++d) vertices[a * dim + d] = mesh_.x[nodesOf(element)[a] * dim + d];
    return vertices;
}
template std::array<double, 6> CoverBuilder::verticesOf<2>(int) const;
template std::array<double, 12> CoverBuilder::verticesOf<3>(int) const;

template <int dim>
void CoverBuilder::addCuttingFaces(const Solid& solid, int element, CuttingFaces& faces) const
{
    int rows[dim + 1];
    for (int a = 0; a <= dim; ++a) rows[a] = nodeFaces_.find(nodesOf(element)[a], solid);
    for (int part = 0; part < solid.shape->nParts(); ++part)
    {
        const std::size_t before = faces.distances.size();
        bool isApart = false;
        for (int k = 0; k < nodeFaces_.nFaces(rows[0] + part) && !isApart; ++k)
        {
            double values[dim + 1];
            int nInside = 0;
            for (int a = 0; a <= dim; ++a)
            {
                values[a] = nodeFaces_.distances(rows[a] + part)[k];
                nInside += values[a] < 0;
            }
            isApart = onlyTouches(element, values, nInside);
            if (nInside <= dim) faces.distances.insert(faces.distances.end(), values, values + dim + 1);
        }
        if (isApart) faces.distances.resize(before);
        else faces.end.push_back(static_cast<int>(faces.distances.size() / (dim + 1)));
    }
}
template void CoverBuilder::addCuttingFaces<2>(const Solid&, int, CuttingFaces&) const;
template void CoverBuilder::addCuttingFaces<3>(const Solid&, int, CuttingFaces&) const;

/// areApart: no two parts overlap or touch in the element.
template <int dim>
const EdgeCut<dim>& CoverBuilder::cutAtEdge(const CuttingFaces& faces, int element, bool areApart) const
{
    const auto vertices = verticesOf<dim>(element);
    const double* gradN = &mesh_.gradN[std::size_t(element) * (dim + 1) * dim];
    const double *distances = faces.distances.data(), volume = mesh_.volume[element];
    EdgeCut<dim>& cut = std::get<EdgeCut<dim>>(edgeCut_);
    if (faces.isWhole()) cut.clear();
    else if (faces.end.size() == 1 && faces.end[0] == 1) cut = cutSimplex<dim>(distances, volume, vertices.data(), gradN);
    else if (faces.end.size() == 1) cutSimplexAtEdge<dim>(distances, faces.end[0], volume, vertices.data(), gradN, cut);
    else if (areApart) cutSimplexOfApartSolids<dim>(distances, faces.end, volume, vertices.data(), gradN, cut, std::get<EdgeCut<dim>>(partCut_));
    else cutSimplexOfSolids<dim>(distances, faces.end, volume, vertices.data(), gradN, cut);
    return cut;
}
template const EdgeCut<2>& CoverBuilder::cutAtEdge<2>(const CuttingFaces&, int, bool) const;
template const EdgeCut<3>& CoverBuilder::cutAtEdge<3>(const CuttingFaces&, int, bool) const;

template <int dim>
void CoverBuilder::cutElementAtEdge(Cover& cover, const std::vector<Solid>& solids, int element, const double* distance) const
{
    cover.state[element] = ElementState::Fluid;
    const Solid& solid = solids[cover.nearestSolid[nodesOf(element)[0]]];
    cutting_.clear();
    addCuttingFaces<dim>(solid, element, cutting_);
    if (cutting_.isApart()) return;
    const bool isBody = solid.kind == Solid::Kind::Free || solid.isLoose; // held or not: its cut must not jump as it is let go
    if (!isBody && isOnBoundary(element)) cutPatchFaces<dim>(cover, element, cutting_);
    const EdgeCut<dim>& cut = cutAtEdge<dim>(cutting_, element);
    if (cut.facets.empty() && *std::min_element(distance, distance + dim + 1) > 0) return;
    storeCut<dim>(cover, solids, element, cut, cut.facets.data(), static_cast<int>(cut.facets.size()));
}

template <int dim>
void CoverBuilder::cutElementOf(Cover& cover, const std::vector<Solid>& solids, int element, const double* distance) const
{
    if (isAtEdgeOfOne(cover, element)) return cutElementAtEdge<dim>(cover, solids, element, distance);
    const bool isCut = !onlyTouches(element, distance, static_cast<int>(std::count_if(distance, distance + dim + 1, [](double d) { return d < 0; })));
    const SimplexCut<dim> cut = isCut ? cutSimplex<dim>(distance, mesh_.volume[element], verticesOf<dim>(element).data(), &mesh_.gradN[std::size_t(element) * (dim + 1) * dim])
                                      : wholeSimplex<dim>(mesh_.volume[element]);
    if (!endsAtEdge(cover, element)) return storeCut<dim>(cover, solids, element, cut, cut.facets, cut.nFacets);
    std::vector<SimplexFacet<dim>> facets(cut.facets, cut.facets + cut.nFacets);
    closeFaces<dim>(cover, solids, element, distance, facets);
    storeCut<dim>(cover, solids, element, cut, facets.data(), static_cast<int>(facets.size()));
}

/// Between two solids the cut is linear, in the next element it may be that of an edge of one of them: what is fluid here and inside the solid there, on the face between, is
/// surface of the solid. Without it the fluid's surface would not be closed, and a pressure all around would drive what is beside the hole.
template <int dim>
void CoverBuilder::closeFaces(const Cover& cover, const std::vector<Solid>& solids, int element, const double* distance, std::vector<SimplexFacet<dim>>& facets) const
{
    for (int corner = 0; corner <= dim; ++corner)
    {
        if (!endsAtEdge(cover, element, corner)) continue;
        const Solid& solid = solids[cover.nearestSolid[nodesOf(element)[corner == 0]]];
        cutting_.clear();
        addCuttingFaces<dim>(solid, element, cutting_);
        double inFluid[dim + 1];
        std::transform(distance, distance + dim + 1, inFluid, std::negate<>());
        for (std::size_t part = 0; part < cutting_.end.size(); ++part)
        {
            cutting_.end[part] += static_cast<int>(part + 1);
            cutting_.distances.insert(cutting_.distances.begin() + (cutting_.end[part] - 1) * (dim + 1), inFluid, inFluid + dim + 1);
        }
        addFacePart<dim>(corner, cutting_.distances.data(), cutting_.end, mesh_.volume[element], verticesOf<dim>(element).data(),
            &mesh_.gradN[std::size_t(element) * (dim + 1) * dim], facets);
    }
}

void CoverBuilder::findClosedFaces(const Cover& cover)
{
    closedFaces_.clear();
    for (const CutElement& cut : cover.cuts)
        for (int corner = 0; corner <= mesh_.dim; ++corner)
        {
            if (!endsAtEdge(cover, cut.element, corner)) continue;
            const InteriorFace& face = graph_.faces[elementFace_[std::size_t(cut.element) * (mesh_.dim + 1) + corner]];
            closedFaces_.push_back({cut.element, face.opposite[face.element[0] == cut.element]});
        }
}

/// What closes a face is of the cut beyond it: that is linear, too, where a moving solid is nearest to the node there, however far it is from the element itself.
void CoverBuilder::addClosedFaces()
{
    for (const ClosedFace& closed : closedFaces_)
        if (cover_.nearestSolid[closed.nodeBeyond] != fixedCover_.nearestSolid[closed.nodeBeyond] && firstVisit(elementMark_, closed.element))
            touchedElements_.push_back(closed.element);
}

template <int dim>
void CoverBuilder::storeCut(Cover& cover, const std::vector<Solid>& solids, int element, const SimplexMoments<dim>& cut,
    const SimplexFacet<dim>* facets, int nFacets, const int* solidOf) const
{
    const double volume = mesh_.volume[element];
    double area = 0;
    for (int f = 0; f < nFacets; ++f) area += facets[f].area;
    const double noArea = negligibleFacet * volume / mesh_.h[element];
    const bool isFluid = volume - cut.volume < negligiblePart * volume && area < noArea;
    const bool isSolid = cut.volume < negligiblePart * volume;
    cover.state[element] = isFluid ? ElementState::Fluid : isSolid ? ElementState::Solid : ElementState::Cut;
    if (isFluid || isSolid) return;

    cover.cutIndex[element] = static_cast<int>(cover.cuts.size());
    CutElement& c = cover.cuts.emplace_back();
    c.element = element;
    c.volume = cut.volume;
    std::copy(cut.first, cut.first + dim + 1, c.first);
    std::copy(cut.second, cut.second + (dim + 1) * (dim + 1), c.second);
    c.facetStart = static_cast<int>(cover.facets.size());
    for (int k = 0; k < nFacets; ++k)
    {
        CutFacet& f = cover.facets.emplace_back();
        f.element = element;
        f.area = facets[k].area;
        f.nPoints = dim;
        std::copy(facets[k].normal, facets[k].normal + dim, f.normal);
        double centroid[dim + 1] = {};
        for (int q = 0; q < dim; ++q)
        {
            f.weight[q] = facets[k].weight[q];
            for (int a = 0; a <= dim; ++a)
            {
                f.shape[q][a] = facets[k].shape[q][a];
                centroid[a] += f.shape[q][a] / dim;
            }
        }
        const int known = solidOf ? solidOf[facets[k].solid] : -1;
        f.solid = known >= 0 ? known : solidAt(cover, solids, element, centroid);
    }
    c.facetEnd = static_cast<int>(cover.facets.size());
}

template void CoverBuilder::storeCut<2>(Cover&, const std::vector<Solid>&, int, const SimplexMoments<2>&, const SimplexFacet<2>*, int, const int*) const;
template void CoverBuilder::storeCut<3>(Cover&, const std::vector<Solid>&, int, const SimplexMoments<3>&, const SimplexFacet<3>*, int, const int*) const;

/// In space.
Vec3 CoverBuilder::pointIn(int element, const double* shape) const
{
    Vec3 x = Vec3::Zero();
    for (int a = 0; a <= mesh_.dim; ++a)
    {
        const auto y = mesh_.spacePoint(nodesOf(element)[a]);
        x += shape[a] * Vec3(y[0], y[1], y[2]);
    }
    return x;
}

int CoverBuilder::solidAt(const Cover& cover, const std::vector<Solid>& solids, int element, const double* shape) const
{
    const int* nodes = nodesOf(element);
    int nearest = cover.nearestSolid[nodes[0]];
    bool isSame = true;
    for (int a = 1; a <= mesh_.dim; ++a) isSame = isSame && cover.nearestSolid[nodes[a]] == nearest;
    if (isSame) return nearest;

    const auto isOneOf = [&](int s, int n) { return std::any_of(nodes, nodes + n, [&](int i) { return cover.nearestSolid[i] == s; }); };
    const Vec3 x = pointIn(element, shape);
    double least = 2 * farDistance;
    for (int a = 0; a <= mesh_.dim; ++a)
    {
        const int s = cover.nearestSolid[nodes[a]];
        if (s < 0 || isOneOf(s, a)) continue;
        const double d = solids[s].distance(x);
        if (d < least || (d == least && s < nearest))
        {
            least = d;
            nearest = s;
        }
    }
    return nearest;
}

void CoverBuilder::findActiveNodes(Cover& cover, const std::vector<int>& elements)
{
    ++mark_;
    for (int e : elements)
        for (int a = 0; a <= mesh_.dim; ++a)
        {
            const int i = nodesOf(e)[a];
            if (!firstVisit(nodeMark_, i)) continue;
            bool isActive = false;
            for (int k = graph_.nodeElementStart[i]; k < graph_.nodeElementStart[i + 1] && !isActive; ++k)
                isActive = cover.state[graph_.nodeElement[k]] != ElementState::Solid;
            cover.isActiveNode[i] = isActive;
        }
}

/// Halo nodes of the outermost ring do not have all their elements here: the owner knows.
void CoverBuilder::shareActiveNodes(Cover& cover) const
{
    if (halo_.size() == 1) return;
    std::vector<int> active(cover.isActiveNode.begin(), cover.isActiveNode.end());
    halo_.update(active, 1);
    for (int i = mesh_.nOwned; i < mesh_.nNodes; ++i) cover.isActiveNode[i] = static_cast<char>(active[i]);
}

void CoverBuilder::findGhostFaces(Cover& cover) const
{
    const int dim = mesh_.dim;
    cover.ghostFaces.clear();
    for (const CutElement& cut : cover.cuts)
        for (int a = 0; a <= dim; ++a)
        {
            const int f = elementFace_[std::size_t(cut.element) * (dim + 1) + a];
            if (f < 0) continue;
            const InteriorFace& face = graph_.faces[f];
            const int other = face.element[face.element[0] == cut.element ? 1 : 0];
            if (cover.state[other] == ElementState::Solid) continue;
            if (cover.state[other] == ElementState::Cut && other < cut.element) continue; // seen from there
            // corner a of the cut element is opposite to the face: -grad N_a points out of the element
            const double* g = &mesh_.gradN[(std::size_t(cut.element) * (dim + 1) + a) * dim];
            const double sign = face.element[0] == cut.element ? -1 : 1;
            double length = 0;
            for (int d = 0; d < dim; ++d) length += g[d] * g[d];
            length = std::sqrt(length);
            GhostFace& ghost = cover.ghostFaces.emplace_back(GhostFace{f, dim * mesh_.volume[cut.element] * length, {0, 0, 0}});
            for (int d = 0; d < dim; ++d) ghost.normal[d] = sign * g[d] / length;
        }
}

/// totals: volume per solid, area per solid, shared elements. An element's solid part goes to the solid nearest to
/// (or deepest at) one of its nodes.
void CoverBuilder::account(const Cover& cover, int element, double sign, std::vector<double>& totals) const
{
    if (!mesh_.isOwnedElement[element] || cover.state[element] == ElementState::Fluid) return;
    const int* nodes = nodesOf(element);
    const int nSolids = static_cast<int>(totals.size() / 2);
    int deepest = 0, inside = -1;
    bool isShared = false;
    for (int a = 0; a <= mesh_.dim; ++a)
    {
        if (cover.distance[nodes[a]] < cover.distance[nodes[deepest]]) deepest = a;
        if (cover.distance[nodes[a]] > 0) continue;
        isShared = isShared || (inside >= 0 && cover.nearestSolid[nodes[a]] != inside);
        inside = cover.nearestSolid[nodes[a]];
    }
    double volume = mesh_.volume[element];
    if (cover.state[element] == ElementState::Cut)
    {
        const CutElement& cut = cover.cuts[cover.cutIndex[element]];
        volume -= cut.volume;
        for (int f = cut.facetStart; f < cut.facetEnd; ++f) totals[nSolids + cover.facets[f].solid] += sign * cover.facets[f].area;
        if (isShared) totals[2 * nSolids] += sign;
    }
    totals[cover.nearestSolid[nodes[deepest]]] += sign * volume;
}

void CoverBuilder::sumTotals(Cover& cover, std::vector<double> totals, int nSolids) const
{
    halo_.sum(totals.data(), static_cast<int>(totals.size()));
    cover.solidVolume.assign(totals.begin(), totals.begin() + nSolids);
    cover.solidArea.assign(totals.begin() + nSolids, totals.begin() + 2 * nSolids);
    cover.nSharedElements = std::lround(totals[2 * nSolids]);
}

} // namespace flotsam
