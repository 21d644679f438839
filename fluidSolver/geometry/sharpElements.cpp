// SPDX-License-Identifier: GPL-3.0-or-later
/// CoverBuilder: elements that are cut one solid after the other, each by the faces of its own parts: around sharp solids (Solid::isSharp: thin ones, unions), of which the distance at the
/// nodes does not tell enough. Structures among them are cut anew with what moves.
#include "geometry/coverBuilder.hpp"

#include <algorithm>

namespace flotsam
{

void CoverBuilder::findSharpParts(const std::vector<Solid>& solids)
{
    for (const SharpPart& part : sharpParts_) firstSharpPart_[part.element] = -1;
    sharpParts_.clear();
    nodeFaces_.clear(); // of the poses before
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
        if (!solids[s].isSharp()) continue;
        const auto add = [&](int e) { if (hasPart(solids[s], e)) sharpParts_.push_back({e, static_cast<int>(s)}); };
        forEachLocalAlone(solids[s], samples_[s], add, [](int) { return true; });
    }
    std::sort(sharpParts_.begin(), sharpParts_.end(), [](const SharpPart& a, const SharpPart& b) { return a.element != b.element ? a.element < b.element : a.solid < b.solid; });
    if (!sharpParts_.empty()) firstSharpPart_.resize(mesh_.nElements, -1);
    for (std::size_t k = sharpParts_.size(); k-- > 0;) firstSharpPart_[sharpParts_[k].element] = static_cast<int>(k);
}

/// Of the solid alone, as visitCutAlone() cuts it. A node as deep inside as that has far more than negligiblePart around it: no need to look.
bool CoverBuilder::hasPart(const Solid& solid, int element)
{
    constexpr double deep = 1e-3;   // over the element length
    const int* nodes = nodesOf(element);
    if (std::any_of(nodes, nodes + mesh_.dim + 1, [&](int i) { return aloneDistance_[i] < -deep * mesh_.h[element]; })) return true;
    return mesh_.dim == 2 ? hasPartBetweenNodes<2>(solid, element) : hasPartBetweenNodes<3>(solid, element);
}

template <int dim>
bool CoverBuilder::hasPartBetweenNodes(const Solid& solid, int element)
{
    double distance[dim + 1];
    const AloneCut how = howCutAlone<dim>(element, distance);
    if (how == AloneCut::ByDistance) return hasSolidPart<dim>(distance, 1);
    if (how != AloneCut::ByFaces) return how == AloneCut::Whole;
    cutting_.clear();
    addCuttingFaces<dim>(solid, element, cutting_);
    for (std::size_t part = 0; part < cutting_.end.size(); ++part)
        if (hasSolidPart<dim>(cutting_.distancesOf(part, dim), cutting_.nFaces(part))) return true;
    return false;
}

/// Of those sorted by element: the first one of this element, or the end.
const CoverBuilder::SharpPart* CoverBuilder::partsIn(int element) const
{
    const int first = firstSharpPart_.empty() ? -1 : firstSharpPart_[element];
    return sharpParts_.data() + (first < 0 ? sharpParts_.size() : first);
}

CoverBuilder::SharpElement CoverBuilder::kindOf(const Cover& cover, const std::vector<Solid>& solids, int element) const
{
    const Others others = othersIn(cover, solids, element);
    if (others.n > 1) return SharpElement::Joined;
    const int *nodes = nodesOf(element), first = cover.nearestSolid[nodes[0]];
    const auto isFirsts = [&](int i) { return cover.nearestSolid[i] == first; };
    const SharpPart* part = partsIn(element);
    const SharpPart* end = sharpParts_.data() + sharpParts_.size();
    bool isAlone = others.n == 0 && std::all_of(nodes, nodes + mesh_.dim + 1, isFirsts);
    for (; part != end && part->element == element; ++part) isAlone = isAlone && part->solid == first;
    return isAlone ? SharpElement::Alone : SharpElement::Apart;
}

/// Elements that are cut solid by solid: those with parts of sharp solids, and, so that the cut goes on across their faces, those with nodes nearest to one.
void CoverBuilder::addSharpElements(const Cover& cover, const std::vector<Solid>& solids)
{
    for (int e : sharpElements_) sharpElement_[e] = SharpElement::None;
    sharpElements_.clear();
    if (std::none_of(solids.begin(), solids.end(), [](const Solid& solid) { return solid.isSharp(); })) return;
    sharpElement_.resize(mesh_.nElements, SharpElement::None);
    markOthers(solids);
    const auto add = [&](int e)
    {
        if (sharpElement_[e] != SharpElement::None) return;
        sharpElement_[e] = kindOf(cover, solids, e);
        sharpElements_.push_back(e);
        if (firstVisit(elementMark_, e)) touchedElements_.push_back(e);
    };
    for (const SharpPart& part : sharpParts_) add(part.element);
    for (std::size_t s = 0; s < solids.size(); ++s)
        for (std::size_t k = 0; solids[s].isSharp() && k < samples_[s].size(); ++k)
        {
            const int i = samples_[s][k].node;
            for (int j = graph_.nodeElementStart[i]; cover.nearestSolid[i] == static_cast<int>(s) && j < graph_.nodeElementStart[i + 1]; ++j)
                if (isNear(cover.distance, graph_.nodeElement[j])) add(graph_.nodeElement[j]);
        }
}

/// Nodes that moving solids other than sharp ones are near: these may have a part, hidden by a thin body that is nearer, in an element none of whose nodes is nearest to them.
void CoverBuilder::markOthers(const std::vector<Solid>& solids)
{
    isNearOther_.assign(mesh_.nNodes, 0);
    for (std::size_t s = 0; s < solids.size(); ++s)
        for (std::size_t k = 0; !solids[s].isSharp() && !solids[s].isCutOnce() && k < samples_[s].size(); ++k) isNearOther_[samples_[s][k].node] = 1;
}

/// Nothing is cut in the element but sharp solids and structures at rest.
bool CoverBuilder::isOfSharpAlone(const Others& others, int element) const
{
    const int* nodes = nodesOf(element);
    const bool areNone = others.n == 0 || (others.n == 1 && others.solid[0] < 0);
    return areNone && !std::all_of(nodes, nodes + mesh_.dim + 1, [&](int i) { return isNearOther_[i] != 0; });
}

/// Other solids than sharp ones that are nearest to a node of the element; those at rest in the mesh's cover count as one: -1.
CoverBuilder::Others CoverBuilder::othersIn(const Cover& cover, const std::vector<Solid>& solids, int element) const
{
    Others others;
    const int* nodes = nodesOf(element);
    for (int a = 0; a <= mesh_.dim; ++a)
    {
        const int s = cover.nearestSolid[nodes[a]];
        if (s < 0 || solids[s].isSharp() || solids[s].isCutOnce() || std::find(others.solid, others.solid + others.n, s) != others.solid + others.n) continue;
        others.solid[others.n++] = s;
    }
    if (isNear(fixedCover_.distance, element)) others.solid[others.n++] = -1;
    return others;
}

/// Adds one solid by its faces; several, as elsewhere, by the least of their distances.
template <int dim>
void CoverBuilder::facesOf(const Others& others, const std::vector<Solid>& solids, int element, CuttingFaces& faces) const
{
    const int* nodes = nodesOf(element);
    const int fixed = fixedCover_.nearestSolid[nodes[0]];
    const bool isOneFixed = others.solid[0] < 0 && std::all_of(nodes, nodes + dim + 1, [&](int i) { return fixedCover_.nearestSolid[i] == fixed; });
    if (others.n == 1 && (others.solid[0] >= 0 || isOneFixed)) return addCuttingFaces<dim>(solids[isOneFixed ? fixed : others.solid[0]], element, faces);
    double distances[dim + 1];
    int nInside = 0;
    for (int a = 0; a <= dim; ++a)
    {
        double& least = distances[a] = farDistance;
        for (int k = 0; k < others.n; ++k)
        {
            const int s = others.solid[k];
            least = std::min(least, s < 0 ? fixedCover_.distance[nodes[a]] : nodeFaces_.distance(nodes[a], solids[s]));
        }
        nInside += least < 0;
    }
    if (onlyTouches(element, distances, nInside)) return;
    if (nInside <= dim) faces.distances.insert(faces.distances.end(), distances, distances + dim + 1);
    faces.end.push_back(static_cast<int>(faces.distances.size() / (dim + 1)));
}

/// Without the part of a face that is in solids.
template <int dim>
void CoverBuilder::cutPatchFaces(Cover& cover, int element, const CuttingFaces& faces) const
{
    constexpr int n = dim + 1;
    for (int corner = 0; corner < n; ++corner)
    {
        if (elementFace_[std::size_t(element) * n + corner] >= 0) continue;
        const double* g = &mesh_.gradN[(std::size_t(element) * n + corner) * dim];
        const double area = dim * mesh_.volume[element] * Eigen::Map<const Eigen::Matrix<double, dim, 1>>(g).norm();
        CutPatchFace& face = cover.patchFaces.emplace_back(CutPatchFace{element, corner, {}});
        for (int a = 0; a < n; ++a)
            for (int b = 0; b < n; ++b)
                if (a != corner && b != corner) face.second[a * n + b] = (a == b ? 2. : 1.) / (dim * n);
        std::vector<SimplexFacet<dim>> parts;
        addFacePart<dim>(corner, faces.distances.data(), faces.end, mesh_.volume[element], verticesOf<dim>(element).data(), &mesh_.gradN[std::size_t(element) * n * dim], parts);
        for (const SimplexFacet<dim>& part : parts)
            for (int q = 0; q < dim; ++q)
                for (int ab = 0; ab < n * n; ++ab) face.second[ab] -= part.weight[q] / area * part.shape[q][ab / n] * part.shape[q][ab % n];
    }
}
template void CoverBuilder::cutPatchFaces<2>(Cover&, int, const CuttingFaces&) const;
template void CoverBuilder::cutPatchFaces<3>(Cover&, int, const CuttingFaces&) const;

/// Two parts of `cutting_` have anything in common, or less than `touching` between them.
template <int dim>
bool CoverBuilder::overlap(std::size_t part, std::size_t other, int element) const
{
    constexpr double touching = 1e-8;   // over the element length: a hundred times what nodes count as solid by
    joined_.clear();
    for (std::size_t p : {other, part}) joined_.insert(joined_.end(), cutting_.distancesOf(p, dim), cutting_.distancesOf(p, dim) + cutting_.nFaces(p) * (dim + 1));
    for (double& distance : joined_) distance -= touching * mesh_.h[element];
    return hasSolidPart<dim>(joined_.data(), cutting_.nFaces(other) + cutting_.nFaces(part), 0);
}

/// Of all parts of `cutting_`, and of those of different solids. solidOf: of the parts.
template <int dim>
CoverBuilder::Separation CoverBuilder::separation(const std::vector<int>& solidOf, int element) const
{
    Separation are{true, true};
    for (std::size_t part = 0; part < solidOf.size() && are.solidsApart; ++part)
        for (std::size_t other = 0; other < part; ++other)
        {
            if (!overlap<dim>(part, other, element)) continue;
            are.partsApart = false;
            are.solidsApart = are.solidsApart && solidOf[part] == solidOf[other];
        }
    return are;
}

template <int dim>
void CoverBuilder::cutElementOfSolids(Cover& cover, const std::vector<Solid>& solids, int element) const
{
    cover.cutIndex[element] = -1;
    cover.state[element] = isDeepIn(cover.distance, element) ? ElementState::Solid : ElementState::Fluid;
    if (cover.state[element] == ElementState::Solid) return;
    cutting_.clear();
    std::vector<int>& solidOf = solidOfPart_;
    solidOf.clear();
    const SharpPart* end = sharpParts_.data() + sharpParts_.size();
    for (const SharpPart* part = partsIn(element); part != end && part->element == element; ++part)
    {
        addCuttingFaces<dim>(solids[part->solid], element, cutting_);
        solidOf.resize(cutting_.end.size(), part->solid);
    }
    const Others others = othersIn(cover, solids, element);
    if (others.n > 0) facesOf<dim>(others, solids, element, cutting_);
    solidOf.resize(cutting_.end.size(), others.n == 1 ? others.solid[0] : -1);
    const Separation are = separation<dim>(solidOf, element);
    if (sharpElement_[element] == SharpElement::Apart && are.solidsApart && isOfSharpAlone(others, element)) sharpElement_[element] = SharpElement::Clear;
    if (cutting_.isApart()) return;
    cutPatchFaces<dim>(cover, element, cutting_);
    const EdgeCut<dim>& cut = cutAtEdge<dim>(cutting_, element, are.partsApart);
    storeCut<dim>(cover, solids, element, cut, cut.facets.data(), static_cast<int>(cut.facets.size()), solidOf.data());
}
template void CoverBuilder::cutElementOfSolids<2>(Cover&, const std::vector<Solid>&, int) const;
template void CoverBuilder::cutElementOfSolids<3>(Cover&, const std::vector<Solid>&, int) const;

} // namespace flotsam
