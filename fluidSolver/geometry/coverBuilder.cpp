// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/coverBuilder.hpp"

#include "algebra/needlessWork.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{
namespace
{

/// How far the distance has to be known around each node: an element that a solid touches has all its nodes within
/// its longest edge, and a body's surface may still be moved by twice largestOffset. The owner's value everywhere, so that all
/// ranks evaluate the same nodes.
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
        const double needed = std::sqrt(longest) + 2 * largestOffset * mesh.h[e];
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
            s = std::min(s, 1e-10 * mesh.h[e]);
        }
    halo.update(snap, 1);
    return snap;
}

/// Corner 0..dim of element[side] that is not on the face.
int cornerOf(const SimplexMesh& mesh, const InteriorFace& face, int side)
{
    const int* nodes = &mesh.elements[std::size_t(face.element[side]) * (mesh.dim + 1)];
    return static_cast<int>(std::find(nodes, nodes + mesh.dim + 1, face.opposite[side]) - nodes);
}

} // namespace

CoverBuilder::CoverBuilder(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo)
    : mesh_(mesh), graph_(graph), halo_(halo), bins_(mesh, nodeReach(mesh, halo)), film_(mesh, halo), snap_(nodeSnap(mesh, halo)),
      nodeFaces_(mesh, film_, snap_), elementFace_(std::size_t(mesh.nElements) * (mesh.dim + 1), -1), isBoundaryNode_(mesh.nNodes, 0),
      elementMark_(mesh.nElements, 0), nodeMark_(mesh.nNodes, 0), face_(mesh.nNodes, 0), aloneDistance_(mesh.nNodes, farDistance),
      aloneFace_(mesh.nNodes, 0), partsAt_(mesh.nNodes, 0), isSharedNode_(mesh.nNodes, 0), isNeedless_(doesNeedless("cut"))
{
    for (std::size_t f = 0; f < graph.faces.size(); ++f)
        for (int side = 0; side < 2; ++side)
        {
            const InteriorFace& face = graph.faces[f];
            elementFace_[std::size_t(face.element[side]) * (mesh.dim + 1) + cornerOf(mesh, face, side)] = static_cast<int>(f);
        }
    for (const MeshPatch& patch : mesh.patches)
        for (int node : patch.faceNodes) isBoundaryNode_[node] = 1;
    for (int d = 0; d < mesh.dim; ++d)
    {
        lower_[d] = upper_[d] = -1e300;
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            lower_[d] = std::max(lower_[d], -mesh.x[std::size_t(i) * mesh.dim + d]);
            upper_[d] = std::max(upper_[d], mesh.x[std::size_t(i) * mesh.dim + d]);
        }
        lower_[d] = -halo.max(lower_[d]);
        upper_[d] = halo.max(upper_[d]);
    }
    longest_ = halo.max(mesh.h.empty() ? 0 : *std::max_element(mesh.h.begin(), mesh.h.end()));
}

const Cover& CoverBuilder::build(const std::vector<Solid>& solids)
{
    lastSolids_.clear();
    if (isNeedless_ || !sameFixedSolids(solids)) cutFixedSolids(solids);
    sampleMovingSolids(solids);
    return cutMovingSolids(solids);
}

const Cover& CoverBuilder::buildExactVolume(std::vector<Solid>& solids)
{
    if (isAsBefore(solids)) return cover_;
    chooseThin(solids);
    const bool isNew = !sameFixedSolids(solids);
    if (isNew) correctFixedOffsets(solids);
    if (isNew || isNeedless_) cutFixedSolids(solids);
    sampleMovingSolids(solids);
    correctOffsets(solids);
    const auto isFree = [](const Solid& s) { return s.kind == Solid::Kind::Free; };
    lastSolids_ = std::any_of(solids.begin(), solids.end(), isFree) ? std::vector<Solid>() : solids;
    return cutMovingSolids(solids);
}

/// Nothing is to be cut: every solid is where it was at the last call, and none is free (those get better offsets in every call).
bool CoverBuilder::isAsBefore(const std::vector<Solid>& solids) const
{
    const auto isSame = [](const Solid& now, const Solid& then)
    {
        return now.kind == then.kind && isSameFixed(now, then) && now.isThin == then.isThin && now.planeFaces == then.planeFaces;
    };
    return !isNeedless_ && !solids.empty() && std::equal(solids.begin(), solids.end(), lastSolids_.begin(), lastSolids_.end(), isSame);
}

// --- elements near solids

/// False: nothing is known of a solid at some node, and none has a part in the element.
bool CoverBuilder::isNear(const std::vector<double>& distance, int element) const
{
    const int* nodes = nodesOf(element);
    return std::all_of(nodes, nodes + mesh_.dim + 1, [&](int i) { return distance[i] < farDistance; });
}

bool CoverBuilder::hasSeveralParts(const std::vector<int>& face, int element) const
{
    const int* nodes = nodesOf(element);
    return std::any_of(nodes, nodes + mesh_.dim + 1, [&](int i) { return face[i] == severalParts; });
}

/// As a whole in one part of a solid: a node is farther from all of its faces than the element is long.
bool CoverBuilder::isDeepIn(const std::vector<double>& distance, int element) const
{
    const int* nodes = nodesOf(element);
    return std::any_of(nodes, nodes + mesh_.dim + 1, [&](int i) { return distance[i] < -bins_.reach(i); });
}

/// Cut by the faces of the solid, not by its distance alone.
bool CoverBuilder::isAtEdge(const std::vector<int>& face, int element) const
{
    const int* nodes = nodesOf(element);
    if (face[nodes[0]] == severalParts) return true;
    for (int a = 1; a <= mesh_.dim; ++a)
        if (face[nodes[a]] != face[nodes[0]]) return true;
    return false;
}

/// With a face on the mesh's boundary (of elements at the rim of the halo: or on theirs).
bool CoverBuilder::isOnBoundary(int element) const
{
    const int* faces = &elementFace_[std::size_t(element) * (mesh_.dim + 1)];
    return std::any_of(faces, faces + mesh_.dim + 1, [](int f) { return f < 0; });
}

bool CoverBuilder::firstVisit(std::vector<int>& mark, int i) const
{
    if (mark[i] == mark_) return false;
    mark[i] = mark_;
    return true;
}

/// Elements that the samples may have changed: those that the solid may cut, and cut ones whose distances changed.
void CoverBuilder::addElementsOf(const Cover& cover, const std::vector<Solid>& solids, int solid, const std::vector<Sample>& samples)
{
    const auto add = [this](int element) { if (firstVisit(elementMark_, element)) touchedElements_.push_back(element); };
    const auto addNear = [&](int element) { if (isNear(cover.distance, element)) add(element); };
    for (const Sample& s : samples)
    {
        if (firstVisit(nodeMark_, s.node)) touchedNodes_.push_back(s.node);
        if (!isNearFixedCut_[s.node]) forEachElementOf(s, cutDistance(solids[solid], s), face_, addNear);
        else
            for (int k = graph_.nodeElementStart[s.node]; k < graph_.nodeElementStart[s.node + 1]; ++k) add(graph_.nodeElement[k]);
    }
}

// --- fixed solids

bool CoverBuilder::isSameFixed(const Solid& now, const Solid& then)
{
    return now.shape == then.shape && now.offset == then.offset && now.pose.position == then.pose.position
        && now.pose.orientation.coeffs() == then.pose.orientation.coeffs();
}

bool CoverBuilder::sameFixedSolids(const std::vector<Solid>& solids) const
{
    if (!hasFixedCover_ || solids.size() != fixedSolids_.size()) return false;
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
        if (solids[s].isCutOnce() != fixedSolids_[s].isCutOnce()) return false;
        if (solids[s].isCutOnce() && !isSameFixed(solids[s], fixedSolids_[s])) return false;
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
    for (int e : sharpElements_) sharpElement_[e] = SharpElement::None;
    sharpElements_.clear();
    isNearFixedCut_.assign(mesh_.nNodes, 0);
    face_.assign(mesh_.nNodes, 0);
    ++mark_;
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
        if (!solids[s].isCutOnce()) continue;
        std::vector<Sample> samples;
        sample(solids[s], samples);
        const auto isInside = [&](const Sample& k) { return cutDistance(solids[s], k) < 0; };
        if (!halo_.any(std::any_of(samples.begin(), samples.end(), isInside))) continue; // beside the mesh: nearest to its nodes, it would hide bodies from them
        applySamples(c, solids, static_cast<int>(s), samples);
        addElementsOf(c, solids, static_cast<int>(s), samples);
    }
    std::sort(touchedElements_.begin(), touchedElements_.end());
    nodeFaces_.clear();
    fixedTotals_.assign(2 * solids.size() + 1, 0);
    for (int e : touchedElements_)
    {
        cutElement(c, solids, e);
        account(c, e, 1, fixedTotals_);
    }
    findActiveNodes(c, touchedElements_);
    findClosedFaces(c);
    for (const CutElement& cut : c.cuts)
        for (int a = 0; a <= mesh_.dim; ++a) isNearFixedCut_[nodesOf(cut.element)[a]] = 1;
    touchedNodes_.clear();
    touchedElements_.clear();
    fixedFace_ = face_;
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
        face_[i] = fixedFace_[i];
    }
    for (int e : touchedElements_)
    {
        cover_.state[e] = fixedCover_.state[e];
        for (int a = 0; a <= mesh_.dim; ++a) cover_.isActiveNode[nodesOf(e)[a]] = fixedCover_.isActiveNode[nodesOf(e)[a]];
    }
    cover_.filmNodes.clear();
    cover_.patchFaces.clear();
    touchedNodes_.clear();
    touchedElements_.clear();
}

const Cover& CoverBuilder::cutMovingSolids(const std::vector<Solid>& solids)
{
    restoreFixedCover();
    findSharpParts(solids);
    ++mark_;
    for (std::size_t s = 0; s < solids.size(); ++s)
        if (!solids[s].isCutOnce())
        {
            applySamples(cover_, solids, static_cast<int>(s), samples_[s]);
            addElementsOf(cover_, solids, static_cast<int>(s), samples_[s]);
        }
    addSharpElements(cover_, solids);
    addClosedFaces();
    copyFixedCuts();
    std::vector<double> totals = fixedTotals_;
    for (int e : touchedElements_)
    {
        account(fixedCover_, e, -1, totals);
        cutElement(cover_, solids, e);
        account(cover_, e, 1, totals);
    }
    if (isNeedless_) cutFarElements(solids);
    std::sort(cover_.patchFaces.begin(), cover_.patchFaces.end(), [](const CutPatchFace& a, const CutPatchFace& b) { return a.element < b.element; });
    findActiveNodes(cover_, touchedElements_);
    shareActiveNodes(cover_);
    findGhostFaces(cover_);
    findCovered(cover_, solids);
    sumTotals(cover_, std::move(totals), static_cast<int>(solids.size()));
    return cover_;
}

/// Needless: no moving solid is near them, and they were cut with the fixed ones.
void CoverBuilder::cutFarElements(const std::vector<Solid>& solids)
{
    for (int e = 0; e < mesh_.nElements; ++e)
        if (elementMark_[e] != mark_ && fixedCover_.state[e] != ElementState::Cut) cutElement(cover_, solids, e);
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
    for (const CutPatchFace& face : fixedCover_.patchFaces)
        if (elementMark_[face.element] != mark_) cover_.patchFaces.push_back(face);
}

} // namespace flotsam
