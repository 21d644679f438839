// SPDX-License-Identifier: GPL-3.0-or-later
/// CoverBuilder: solids thinner than an element or little more. Of a round one the linear cut sees what nodes lie inside, and between several solids it sees none without nodes inside:
/// a log of half an element would weigh, but not float, and a rack of such bars would hold nothing back. They are cut by plane faces, and the elements that they share one solid after
/// the other. Structures among them are cut anew with what moves.
#include "geometry/coverBuilder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flotsam
{

namespace
{

constexpr double unknownThickness = std::numeric_limits<double>::infinity();

std::shared_ptr<const Shape> partOf(const Solid& solid, int number) { return {solid.shape, &solid.shape->part(number)}; }

} // namespace

/// Null: not round. Kept per shape.
std::shared_ptr<const PlaneFaces> CoverBuilder::facesOfRound(const std::shared_ptr<const Shape>& shape)
{
    for (const RoundShape& round : roundShapes_)
        if (round.shape == shape) return round.faces;
    return roundShapes_.emplace_back(RoundShape{shape, makePlaneFaces(*shape)}).faces;
}

/// Kept per shape: a body in a 2D mesh turns about the mesh's normal, which is the same to it.
double CoverBuilder::thicknessOfPolyhedron(const std::shared_ptr<const Shape>& shape, const Vec3& across)
{
    constexpr double tolerance = 1e-6;
    for (const Polyhedron& known : polyhedra_)
        if (known.shape == shape && (known.across - across).norm() < tolerance) return known.thickness;
    return polyhedra_.emplace_back(Polyhedron{shape, across, planeThickness(*shape, across)}).thickness;
}

/// Of what can be cut by plane faces [m]; infinite: others. In 2D what is round must stand across the plane: the polyhedron's section is the shape's then.
double CoverBuilder::partThickness(const Solid& solid, const std::shared_ptr<const Shape>& part)
{
    const Vec3 across = mesh_.dim == 2 ? Vec3(solid.pose.orientation.conjugate() * Vec3::Unit(mesh_.axes[2])) : Vec3(Vec3::Zero());
    if (part->hasPlaneFaces()) return thicknessOfPolyhedron(part, across);
    const bool isAlongPlane = mesh_.dim == 2 && std::abs(across.dot(part->symmetry().axis)) < 1 - 1e-9;
    return facesOfRound(part) && !isAlongPlane ? roundThickness(*part) : unknownThickness;
}

/// Of its thinnest part, if all can be cut by plane faces.
double CoverBuilder::thickness(const Solid& solid)
{
    double least = unknownThickness;
    for (int k = 0; k < solid.shape->nParts(); ++k)
    {
        const double ofPart = partThickness(solid, partOf(solid, k));
        if (ofPart == unknownThickness) return unknownThickness;
        least = std::min(least, ofPart);
    }
    return least;
}

void CoverBuilder::chooseThin(std::vector<Solid>& solids)
{
    std::vector<double> lengths; // of each candidate: number of elements at nodes near it, sum of their lengths
    std::vector<std::size_t> candidates;
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
        solids[s].isThin = false;
        if (thickness(solids[s]) < resolvedThickness * longest_) candidates.push_back(s);
        else solids[s].planeFaces.clear();
    }
    if (candidates.empty()) return;
    for (const std::size_t s : candidates)
    {
        double count = 0, sum = 0;
        Solid plain = solids[s]; // whether it is thin decides about the offsets: it must not depend on them
        plain.offset = 0;
        plain.offsetSlope.setZero();
        bins_.forEachNear(plain.spaceBounds(), [&](int node, const Vec3&)
        {
            if (node >= mesh_.nOwned) return;
            for (int k = graph_.nodeElementStart[node]; k < graph_.nodeElementStart[node + 1]; ++k) sum += mesh_.h[graph_.nodeElement[k]];
            count += graph_.nodeElementStart[node + 1] - graph_.nodeElementStart[node];
        });
        lengths.insert(lengths.end(), {count, sum});
    }
    halo_.sum(lengths.data(), static_cast<int>(lengths.size()));
    for (std::size_t k = 0; k < candidates.size(); ++k)
    {
        Solid& solid = solids[candidates[k]];
        solid.isThin = thickness(solid) * lengths[2 * k] < resolvedThickness * lengths[2 * k + 1];
        solid.planeFaces.clear();
        if (!solid.isThin) continue;
        for (int part = 0; part < solid.shape->nParts(); ++part) solid.planeFaces.push_back(facesOfRound(partOf(solid, part)));
        if (needsOffsets(solid)) continue;
        solid.offset = 0; // their volume is exact
        solid.offsetSlope.setZero();
    }
}

void CoverBuilder::findThinParts(const std::vector<Solid>& solids)
{
    thinParts_.clear();
    nodeFaces_.clear(); // of the poses before
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
        if (!solids[s].isSharp()) continue;
        const auto add = [&](int e) { if (hasPart(solids[s], e)) thinParts_.push_back({e, static_cast<int>(s)}); };
        forEachLocalAlone(solids[s], samples_[s], add, [](int) { return true; });
    }
    std::sort(thinParts_.begin(), thinParts_.end(), [](const ThinPart& a, const ThinPart& b) { return a.element != b.element ? a.element < b.element : a.solid < b.solid; });
}

/// Of the solid alone, see visitCutAlone().
bool CoverBuilder::hasPart(const Solid& solid, int element)
{
    bool has = false;
    const auto look = [&](const auto& fluid, const auto*, int) { has = mesh_.volume[element] - fluid.volume > negligiblePart * mesh_.volume[element]; };
    mesh_.dim == 2 ? visitCutAlone<2>(solid, element, look) : visitCutAlone<3>(solid, element, look);
    return has;
}

/// Of those sorted by element: the first one of this element or after it, or the end.
const CoverBuilder::ThinPart* CoverBuilder::partsIn(int element) const
{
    return std::lower_bound(thinParts_.data(), thinParts_.data() + thinParts_.size(), element, [](const ThinPart& p, int e) { return p.element < e; });
}

CoverBuilder::ThinElement CoverBuilder::kindOf(const Cover& cover, const std::vector<Solid>& solids, int element) const
{
    const Others others = othersIn(cover, solids, element);
    if (others.n > 1) return ThinElement::Joined;
    const int *nodes = nodesOf(element), first = cover.nearestSolid[nodes[0]];
    const auto isFirsts = [&](int i) { return cover.nearestSolid[i] == first; };
    const ThinPart* part = partsIn(element);
    const ThinPart* end = thinParts_.data() + thinParts_.size();
    bool isAlone = others.n == 0 && std::all_of(nodes, nodes + mesh_.dim + 1, isFirsts);
    for (; part != end && part->element == element; ++part) isAlone = isAlone && part->solid == first;
    return isAlone ? ThinElement::Alone : ThinElement::Apart;
}

/// Elements that are cut solid by solid: those with parts of thin bodies, and, so that the cut goes on across their faces, those with nodes nearest to one.
void CoverBuilder::addThinElements(const Cover& cover, const std::vector<Solid>& solids)
{
    for (int e : thinElements_) thinElement_[e] = ThinElement::None;
    thinElements_.clear();
    if (std::none_of(solids.begin(), solids.end(), [](const Solid& solid) { return solid.isSharp(); })) return;
    thinElement_.resize(mesh_.nElements, ThinElement::None);
    const auto add = [&](int e)
    {
        if (thinElement_[e] != ThinElement::None) return;
        thinElement_[e] = kindOf(cover, solids, e);
        thinElements_.push_back(e);
        if (firstVisit(elementMark_, e)) touchedElements_.push_back(e);
    };
    for (const ThinPart& part : thinParts_) add(part.element);
    for (std::size_t s = 0; s < solids.size(); ++s)
        for (std::size_t k = 0; solids[s].isSharp() && k < samples_[s].size(); ++k)
        {
            const int i = samples_[s][k].node;
            for (int j = graph_.nodeElementStart[i]; cover.nearestSolid[i] == static_cast<int>(s) && j < graph_.nodeElementStart[i + 1]; ++j)
                if (isNear(cover.distance, graph_.nodeElement[j])) add(graph_.nodeElement[j]);
        }
}

/// Other solids than thin bodies that are nearest to a node of the element; those at rest in the mesh's cover count as one: -1.
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

template <int dim>
void CoverBuilder::cutElementOfSolids(Cover& cover, const std::vector<Solid>& solids, int element) const
{
    cover.cutIndex[element] = -1;
    cover.state[element] = isDeepIn(cover.distance, element) ? ElementState::Solid : ElementState::Fluid;
    if (cover.state[element] == ElementState::Solid) return;
    cutting_.clear();
    std::vector<int> solidOf; // of the parts
    const ThinPart* end = thinParts_.data() + thinParts_.size();
    for (const ThinPart* part = partsIn(element); part != end && part->element == element; ++part)
    {
        addCuttingFaces<dim>(solids[part->solid], element, cutting_);
        solidOf.resize(cutting_.end.size(), part->solid);
    }
    const Others others = othersIn(cover, solids, element);
    if (others.n > 0) facesOf<dim>(others, solids, element, cutting_);
    solidOf.resize(cutting_.end.size(), others.n == 1 ? others.solid[0] : -1);
    if (cutting_.isApart()) return;
    cutPatchFaces<dim>(cover, element, cutting_);
    const EdgeCut<dim> cut = cutAtEdge<dim>(cutting_, element);
    storeCut<dim>(cover, solids, element, cut, cut.facets.data(), static_cast<int>(cut.facets.size()), solidOf.data());
}
template void CoverBuilder::cutElementOfSolids<2>(Cover&, const std::vector<Solid>&, int) const;
template void CoverBuilder::cutElementOfSolids<3>(Cover&, const std::vector<Solid>&, int) const;

} // namespace flotsam
