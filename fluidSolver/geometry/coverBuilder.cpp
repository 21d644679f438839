// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/coverBuilder.hpp"

#include "geometry/cutSimplex.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{
namespace
{

// a facet below this, beside a solid part below negligiblePart, comes from nodes that were set just inside a surface
constexpr double negligibleFacet = 1e-11;

/// How far the distance has to be known around each node: an element that a solid touches has all its nodes within
/// its longest edge, and a body's surface may still be moved by largestOffset. The owner's value everywhere, so that all ranks evaluate the same nodes.
std::vector<double> nodeReach(const SimplexMesh& mesh, const Halo& halo)
{
    const int nodesPerElement = mesh.dim + 1;
    std::vector<double> reach(mesh.nNodes, 0);
    for (int e = 0; e < mesh.nElements; ++e)
    {
        const int* n = &mesh.elements[std::size_t(e) * nodesPerElement];
        double longest = 4 * mesh.h[e] * mesh.h[e];
        for (int a = 0; a < nodesPerElement; ++a)
            for (int b = 0; b < a; ++b)
            {
                double square = 0;
                for (int d = 0; d < mesh.dim; ++d)
                    square += std::pow(mesh.x[n[a] * mesh.dim + d] - mesh.x[n[b] * mesh.dim + d], 2);
                longest = std::max(longest, square);
            }
        const double needed = std::sqrt(longest) + largestOffset * mesh.h[e];
        for (int a = 0; a < nodesPerElement; ++a) reach[n[a]] = std::max(reach[n[a]], needed);
    }
    halo.update(reach, 1);
    return reach;
}

std::vector<double> nodeSnap(const SimplexMesh& mesh, const Halo& halo)
{
    std::vector<double> snap(mesh.nNodes, 1e300);
    for (int e = 0; e < mesh.nElements; ++e)
        for (int a = 0; a <= mesh.dim; ++a)
        {
            double& s = snap[mesh.elements[std::size_t(e) * (mesh.dim + 1) + a]];
            s = std::min(s, 1e-12 * mesh.h[e]);
        }
    halo.update(snap, 1);
    return snap;
}

} // namespace

/// Corner 0..dim of element[side] that is not on the face.
static int cornerOf(const SimplexMesh& mesh, const InteriorFace& face, int side)
{
    const int* nodes = &mesh.elements[std::size_t(face.element[side]) * (mesh.dim + 1)];
    return static_cast<int>(std::find(nodes, nodes + mesh.dim + 1, face.opposite[side]) - nodes);
}

CoverBuilder::CoverBuilder(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo)
    : mesh_(mesh), graph_(graph), halo_(halo), bins_(mesh, nodeReach(mesh, halo)), snap_(nodeSnap(mesh, halo)),
      elementFace_(std::size_t(mesh.nElements) * (mesh.dim + 1), -1), isBoundaryNode_(mesh.nNodes, 0),
      elementMark_(mesh.nElements, 0), nodeMark_(mesh.nNodes, 0), aloneDistance_(mesh.nNodes, farDistance)
{
    for (std::size_t f = 0; f < graph.faces.size(); ++f)
        for (int side = 0; side < 2; ++side)
        {
            const InteriorFace& face = graph.faces[f];
            elementFace_[std::size_t(face.element[side]) * (mesh.dim + 1) + cornerOf(mesh, face, side)] = static_cast<int>(f);
        }
    for (const MeshPatch& patch : mesh.patches)
        for (int node : patch.faceNodes) isBoundaryNode_[node] = 1;
}

const Cover& CoverBuilder::build(const std::vector<Solid>& solids)
{
    if (!sameFixedSolids(solids)) cutFixedSolids(solids);
    sampleMovingSolids(solids);
    return cutMovingSolids(solids);
}

const Cover& CoverBuilder::buildExactVolume(std::vector<Solid>& solids)
{
    if (!sameFixedSolids(solids)) cutFixedSolids(solids);
    sampleMovingSolids(solids);
    correctOffsets(solids);
    return cutMovingSolids(solids);
}

// --- distances

void CoverBuilder::sample(const Solid& solid, std::vector<Sample>& samples) const
{
    samples.clear();
    const Eigen::Matrix3d toBody = solid.pose.orientation.toRotationMatrix().transpose();
    const auto [lower, upper] = solid.shape->bounds();
    const Shape& shape = *solid.shape;
    const Vec3 position = solid.pose.position;
    const double outward = std::max(solid.offset, 0.0);
    std::array<Vec3, 2> box = solid.spaceBounds();
    box[0].array() -= outward - solid.offset;
    box[1].array() += outward - solid.offset;
    bins_.forEachNear(box, [&](int node, const Vec3& x)
    {
        const Vec3 y = toBody * (x - position);
        const double outside = (lower - y).cwiseMax(y - upper).cwiseMax(0.0).norm();
        const double limit = bins_.reach(node) + outward;
        if (outside > limit) return;
        const double d = shape.distance(y);
        if (d <= limit) samples.push_back({node, d});
    });
}

void CoverBuilder::sampleMovingSolids(const std::vector<Solid>& solids)
{
    samples_.resize(solids.size());
    for (std::size_t s = 0; s < solids.size(); ++s)
        if (solids[s].kind != Solid::Kind::Fixed) sample(solids[s], samples_[s]);
}

void CoverBuilder::applySamples(Cover& cover, int solid, double offset, const std::vector<Sample>& samples) const
{
    for (const Sample& s : samples)
    {
        const double d = snapped(s.node, s.distance - offset);
        if (d < cover.distance[s.node])
        {
            cover.distance[s.node] = d;
            cover.nearestSolid[s.node] = solid;
        }
    }
}

bool CoverBuilder::firstVisit(std::vector<int>& mark, int i) const
{
    if (mark[i] == mark_) return false;
    mark[i] = mark_;
    return true;
}

/// Elements that the samples may have changed: those with a node inside, and cut ones whose distances changed.
void CoverBuilder::addElementsOf(const std::vector<Sample>& samples, double offset)
{
    for (const Sample& s : samples)
    {
        if (firstVisit(nodeMark_, s.node)) touchedNodes_.push_back(s.node);
        if (snapped(s.node, s.distance - offset) > 0 && !isNearFixedCut_[s.node]) continue;
        for (int k = graph_.nodeElementStart[s.node]; k < graph_.nodeElementStart[s.node + 1]; ++k)
            if (firstVisit(elementMark_, graph_.nodeElement[k])) touchedElements_.push_back(graph_.nodeElement[k]);
    }
}

// --- fixed solids

bool CoverBuilder::sameFixedSolids(const std::vector<Solid>& solids) const
{
    if (!hasFixedCover_ || solids.size() != fixedSolids_.size()) return false;
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
        const Solid &now = solids[s], &then = fixedSolids_[s];
        if (now.kind != then.kind) return false;
        if (now.kind == Solid::Kind::Fixed
            && (now.shape != then.shape || now.offset != then.offset || now.pose.position != then.pose.position
                || now.pose.orientation.coeffs() != then.pose.orientation.coeffs()))
            return false;
    }
    return true;
}

void CoverBuilder::cutFixedSolids(const std::vector<Solid>& solids)
{
    Cover& c = fixedCover_;
    c = Cover();
    c.distance.assign(mesh_.nNodes, farDistance);
    c.nearestSolid.assign(mesh_.nNodes, -1);
    c.state.assign(mesh_.nElements, ElementState::Fluid);
    c.cutIndex.assign(mesh_.nElements, -1);
    c.isActiveNode.assign(mesh_.nNodes, 1);
    touchedNodes_.clear();
    touchedElements_.clear();
    isNearFixedCut_.assign(mesh_.nNodes, 0);
    ++mark_;
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
        if (solids[s].kind != Solid::Kind::Fixed) continue;
        std::vector<Sample> samples;
        sample(solids[s], samples);
        applySamples(c, static_cast<int>(s), solids[s].offset, samples);
        addElementsOf(samples, solids[s].offset);
    }
    std::sort(touchedElements_.begin(), touchedElements_.end());
    fixedTotals_.assign(2 * solids.size() + 1, 0);
    for (int e : touchedElements_)
    {
        cutElement(c, solids, e);
        account(c, e, 1, fixedTotals_);
    }
    findActiveNodes(c, touchedElements_);
    for (const CutElement& cut : c.cuts)
        for (int a = 0; a <= mesh_.dim; ++a) isNearFixedCut_[nodesOf(cut.element)[a]] = 1;
    touchedNodes_.clear();
    touchedElements_.clear();
    fixedSolids_ = solids;
    hasFixedCover_ = true;
    cover_ = c;
}

// --- moving solids

void CoverBuilder::restoreFixedCover()
{
    for (int i : touchedNodes_)
    {
        cover_.distance[i] = fixedCover_.distance[i];
        cover_.nearestSolid[i] = fixedCover_.nearestSolid[i];
    }
    for (int e : touchedElements_)
    {
        cover_.state[e] = fixedCover_.state[e];
        for (int a = 0; a <= mesh_.dim; ++a) cover_.isActiveNode[nodesOf(e)[a]] = fixedCover_.isActiveNode[nodesOf(e)[a]];
    }
    touchedNodes_.clear();
    touchedElements_.clear();
}

const Cover& CoverBuilder::cutMovingSolids(const std::vector<Solid>& solids)
{
    restoreFixedCover();
    ++mark_;
    for (std::size_t s = 0; s < solids.size(); ++s)
        if (solids[s].kind != Solid::Kind::Fixed)
        {
            applySamples(cover_, static_cast<int>(s), solids[s].offset, samples_[s]);
            addElementsOf(samples_[s], solids[s].offset);
        }
    copyFixedCuts();
    std::vector<double> totals = fixedTotals_;
    for (int e : touchedElements_)
    {
        account(fixedCover_, e, -1, totals);
        cutElement(cover_, solids, e);
        account(cover_, e, 1, totals);
    }
    findActiveNodes(cover_, touchedElements_);
    shareActiveNodes(cover_);
    findGhostFaces(cover_);
    sumTotals(cover_, std::move(totals), static_cast<int>(solids.size()));
    return cover_;
}

void CoverBuilder::copyFixedCuts()
{
    for (const CutElement& cut : cover_.cuts) cover_.cutIndex[cut.element] = -1;
    cover_.cuts.clear();
    cover_.facets.clear();
    for (const CutElement& cut : fixedCover_.cuts)
    {
        if (elementMark_[cut.element] == mark_) continue; // near a moving solid: cut anew
        cover_.cutIndex[cut.element] = static_cast<int>(cover_.cuts.size());
        cover_.cuts.push_back(cut);
        cover_.cuts.back().facetStart = static_cast<int>(cover_.facets.size());
        cover_.facets.insert(cover_.facets.end(), fixedCover_.facets.begin() + cut.facetStart, fixedCover_.facets.begin() + cut.facetEnd);
        cover_.cuts.back().facetEnd = static_cast<int>(cover_.facets.size());
    }
}

// --- elements

void CoverBuilder::cutElement(Cover& cover, const std::vector<Solid>& solids, int element) const
{
    double distance[4];
    int nSolid = 0;
    for (int a = 0; a <= mesh_.dim; ++a)
    {
        distance[a] = cover.distance[nodesOf(element)[a]];
        if (distance[a] < 0) ++nSolid;
    }
    cover.cutIndex[element] = -1;
    if (nSolid == 0) cover.state[element] = ElementState::Fluid;
    else if (nSolid == mesh_.dim + 1) cover.state[element] = ElementState::Solid;
    else if (mesh_.dim == 2) cutElementOf<2>(cover, solids, element, distance);
    else cutElementOf<3>(cover, solids, element, distance);
}

template <int dim>
void CoverBuilder::cutElementOf(Cover& cover, const std::vector<Solid>& solids, int element, const double* distance) const
{
    const double volume = mesh_.volume[element];
    double vertices[(dim + 1) * dim];
    for (int a = 0; a <= dim; ++a)
        for (int d = 0; d < dim; ++d) vertices[a * dim + d] = mesh_.x[nodesOf(element)[a] * dim + d];
    const SimplexCut<dim> cut =
        cutSimplex<dim>(distance, volume, vertices, &mesh_.gradN[std::size_t(element) * (dim + 1) * dim]);

    double area = 0;
    for (int f = 0; f < cut.nFacets; ++f) area += cut.facets[f].area;
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
    for (int k = 0; k < cut.nFacets; ++k)
    {
        CutFacet& f = cover.facets.emplace_back();
        f.element = element;
        f.area = cut.facets[k].area;
        f.nPoints = dim;
        std::copy(cut.normal, cut.normal + dim, f.normal);
        double centroid[dim + 1] = {};
        for (int q = 0; q < dim; ++q)
        {
            f.weight[q] = cut.facets[k].weight[q];
            for (int a = 0; a <= dim; ++a)
            {
                f.shape[q][a] = cut.facets[k].shape[q][a];
                centroid[a] += f.shape[q][a] / dim;
            }
        }
        f.solid = solidAt(cover, solids, element, centroid);
    }
    c.facetEnd = static_cast<int>(cover.facets.size());
}

int CoverBuilder::solidAt(const Cover& cover, const std::vector<Solid>& solids, int element, const double* shape) const
{
    const int* nodes = nodesOf(element);
    int nearest = cover.nearestSolid[nodes[0]];
    bool isSame = true;
    for (int a = 1; a <= mesh_.dim; ++a) isSame = isSame && cover.nearestSolid[nodes[a]] == nearest;
    if (isSame) return nearest;

    Vec3 x = Vec3::Zero();
    for (int a = 0; a <= mesh_.dim; ++a)
    {
        const auto y = mesh_.spacePoint(nodes[a]);
        x += shape[a] * Vec3(y[0], y[1], y[2]);
    }
    double least = 2 * farDistance;
    for (int a = 0; a <= mesh_.dim; ++a)
    {
        const int s = cover.nearestSolid[nodes[a]];
        if (s < 0) continue;
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
            GhostFace& ghost = cover.ghostFaces.emplace_back(GhostFace{f, 0, {0, 0, 0}});
            const double* g = &mesh_.gradN[(std::size_t(face.element[0]) * (dim + 1) + cornerOf(mesh_, face, 0)) * dim];
            double length = 0;
            for (int d = 0; d < dim; ++d) length += g[d] * g[d];
            length = std::sqrt(length);
            ghost.area = dim * mesh_.volume[face.element[0]] * length;
            for (int d = 0; d < dim; ++d) ghost.normal[d] = -g[d] / length;
        }
}

// --- sums

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
