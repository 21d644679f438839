// SPDX-License-Identifier: GPL-3.0-or-later
/// Cuts one mesh again and again as solids move. What does not move is cut once; a step costs what is near the
/// moving solids, not mesh size times solids.
#pragma once

#include "geometry/cover.hpp"
#include "geometry/cutSimplex.hpp"
#include "geometry/nodeBins.hpp"
#include "geometry/nodeFaces.hpp"

#include <algorithm>
#include <array>
#include <tuple>

namespace flotsam
{

/// Largest Solid::offset that buildExactVolume sets, over the element length; the share of Solid::offsetSlope comes on top, as large at most.
constexpr double largestOffset = 0.2;
/// In place of the nearest face at a node that several parts of a solid are near: between nodes at one of them another may pass. Elements there are cut part by part.
constexpr int severalParts = -1;
/// Solids thinner than this are cut by plane faces, exactly also between others; over the element length around them.
constexpr double resolvedThickness = 1.5;

class CoverBuilder
{
public:
    /// Keeps references: mesh, graph and halo must outlive the builder. Collective.
    CoverBuilder(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo);

    /// Cuts the mesh with the solids at their poses. Distances are known only within two element lengths (or the
    /// longest edge) of a solid; farDistance beyond. Nodes closer to a surface than 1e-10 of an element length count as solid; parts below
    /// `negligiblePart` are dropped. The result is valid until the next call; copy it to keep it. Collective.
    const Cover& build(const std::vector<Solid>& solids);

    /// Before cutting, moves the surface of every free solid by Newton steps (one, unless it misses much), starting from its current Solid::offset
    /// and offsetSlope, so that the volume it cuts out alone (without neighbours) becomes exactVolume() and its centre the shape's. At most largestOffset.
    /// A free solid that reaches through the boundary of the mesh, or is not in it, keeps its offsets. Plane faces are not moved, but outward with round parts of a union. Fixed slip solids are moved once,
    /// to cut out the volume of their part inside the mesh. Solids thinner than resolvedThickness are marked
    /// Solid::isThin, round ones of them get Solid::planeFaces. Collective.
    const Cover& buildExactVolume(std::vector<Solid>& solids);

    /// What buildExactVolume() begins with: Solid::isThin and planeFaces, by shape, pose and mesh alone; offsets of thin solids become zero, but for unions of round parts. Before build() of solids whose
    /// poses and offsets were stored. Collective.
    void chooseThin(std::vector<Solid>& solids);

    const Cover& cover() const { return cover_; }

    /// 3D: the shape's volume [m^3]. 2D: its section with the mesh's plane [m^2]; if the shape is
    /// prismatic along the empty direction (within 1 %), exactly volume over extent. Kept per shape and direction.
    double exactVolume(const Solid& solid) { return known(solid).volume; }

private:
    /// Distance of one part of a solid at a node near it, without the solid's offsets, the part's number and that of the nearest of its faces. film: how far it
    /// is kept off a wall there at least, filmFace: the nearest face then.
    struct Sample { int node, part, face, filmFace; double distance, film; };

    /// Distances of the faces of a solid's parts at the nodes of one element, without faces that have the whole element inside and parts that have a face with it outside.
    struct CuttingFaces
    {
        std::vector<double> distances;  // by faces, dim+1 each
        std::vector<int> end;           // of each part's faces

        bool isApart() const { return end.empty(); }    // no part in the element
        bool isWhole() const { return !end.empty() && (end[0] == 0 || std::adjacent_find(end.begin(), end.end()) != end.end()); }    // it lies in one part as a whole
        void clear() { distances.clear(); end.clear(); }
        int nFaces(std::size_t part) const { return end[part] - (part == 0 ? 0 : end[part - 1]); }
        const double* distancesOf(std::size_t part, int dim) const { return distances.data() + (part == 0 ? 0 : end[part - 1]) * (dim + 1); }
    };

    /// Element of fixed solids that closeFaces() may have given facets, and the node beyond the face.
    struct ClosedFace { int element, nodeBeyond; };

    /// What one solid alone cuts out: integrals of (1, r) over the volume and of their products over the surface, r from the origin.
    struct OwnCut
    {
        Eigen::Vector4d volume = Eigen::Vector4d::Zero();
        Eigen::Matrix4d surface = Eigen::Matrix4d::Zero();
        double areaTimesH = 0, reachesThrough = 0;
    };

    /// Search for the offsets of one solid.
    struct OffsetSearch
    {
        std::size_t solid;
        double missing = 0, expected = 0, offset = 0;   // volume that the last step missed and expected to gain [m^dim], offset that it began with
        int nSteps = 0;
        double low = -1e300, high = 1e300;              // offsets that are known to be too small, too large, with the slope there is now
        double least = 1e300, bestOffset = 0;           // volume missed at the best place so far
        Vec3 bestSlope = Vec3::Zero();
    };

    struct KnownVolume
    {
        std::shared_ptr<const Shape> shape;
        Vec3 direction;     // of the mesh plane's normal in the body frame
        double height;      // of the mesh plane over the body's origin
        double volume;
        Vec3 centroid;      // in the body frame
        bool hasCentroid;   // 2D: of a prismatic shape
    };

    struct RoundShape
    {
        std::shared_ptr<const Shape> shape;
        std::shared_ptr<const PlaneFaces> faces;    // null: not round
    };

    struct Polyhedron
    {
        std::shared_ptr<const Shape> shape;
        Vec3 across;        // normal of a 2D mesh, in the shape's frame
        double thickness;
    };

    /// A sharp solid has a part in an element.
    struct SharpPart { int element, solid; };

    /// Of elements with parts of sharp solids or nodes nearest to one. Alone: one sharp solid's; Apart: of several solids; Clear: likewise, but each of them has in it what it has alone;
    /// Joined: with several others than sharp ones, which are cut as one.
    enum class SharpElement : char { None, Alone, Apart, Clear, Joined };

    /// How a solid alone cuts an element: not, as a whole, by its faces, by its distance at the nodes.
    enum class AloneCut : char { None, Whole, ByFaces, ByDistance };

    /// In one element: nothing overlaps or touches.
    struct Separation { bool partsApart, solidsApart; };

    /// Solids beside sharp ones in an element.
    struct Others { int solid[5], n = 0; };

    std::shared_ptr<const PlaneFaces> facesOfRound(const std::shared_ptr<const Shape>& shape);
    double thicknessOfPolyhedron(const std::shared_ptr<const Shape>& shape, const Vec3& across);
    double partThickness(const Solid& solid, const std::shared_ptr<const Shape>& part);
    double thickness(const Solid& solid);
    void findSharpParts(const std::vector<Solid>& solids);
    const SharpPart* partsIn(int element) const;
    SharpElement kindOf(const Cover& cover, const std::vector<Solid>& solids, int element) const;
    void addSharpElements(const Cover& cover, const std::vector<Solid>& solids);
    bool hasPart(const Solid& solid, int element);
    template <int dim> bool hasPartBetweenNodes(const Solid& solid, int element);
    bool isAmongSharp(int element) const { return !sharpElements_.empty() && sharpElement_[element] != SharpElement::None; }
    void markOthers(const std::vector<Solid>& solids);
    bool isOfSharpAlone(const Others& others, int element) const;
    Others othersIn(const Cover& cover, const std::vector<Solid>& solids, int element) const;
    template <int dim> void facesOf(const Others& others, const std::vector<Solid>& solids, int element, CuttingFaces& faces) const;
    template <int dim> bool overlap(std::size_t part, std::size_t other, int element) const;
    template <int dim> Separation separation(const std::vector<int>& solidOf, int element) const;
    template <int dim> void cutElementOfSolids(Cover& cover, const std::vector<Solid>& solids, int element) const;
    template <int dim> void cutPatchFaces(Cover& cover, int element, const CuttingFaces& faces) const;
    unsigned facesBeyond(const Solid& solid, int part) const;
    static bool needsOffsets(const Solid& solid);
    static bool isSameFixed(const Solid& now, const Solid& then);
    bool sameFixedSolids(const std::vector<Solid>& solids) const;
    bool isAsBefore(const std::vector<Solid>& solids) const;
    void cutFixedSolids(const std::vector<Solid>& solids);
    void sampleMovingSolids(const std::vector<Solid>& solids);
    void sample(const Solid& solid, std::vector<Sample>& samples) const;
    void samplePart(const Solid& solid, int part, std::vector<Sample>& samples) const;
    void correctOffsets(std::vector<Solid>& solids);
    void correctFixedOffsets(std::vector<Solid>& solids);
    double volumeInside(const Solid& solid, const std::vector<Sample>& samples);
    const KnownVolume& known(const Solid& solid);
    OwnCut cutAlone(const Solid& solid, const std::vector<Sample>& samples);
    template <int dim> void addAlone(OwnCut& own, const Solid& solid, int element) const;
    template <class Visit, class Accept> void forEachLocalAlone(const Solid& solid, const std::vector<Sample>& samples, Visit visit, Accept accept);
    template <class Visit, class Accept> void forEachElementAlone(const Solid& solid, const std::vector<Sample>& samples, Visit visit, Accept accept);
    template <int dim> AloneCut howCutAlone(int element, double* distance) const;
    template <int dim, class Visit> void visitCutAlone(const Solid& solid, int element, Visit visit) const;
    void findCovered(Cover& cover, const std::vector<Solid>& solids);
    void findSharedNodes(Cover& cover);
    template <int nCorners>
    void addCovered(Cover& cover, int solid, int element, double area, const double* normal, int nPoints, const double (*shape)[nCorners]) const;
    template <int dim> void addAlone(Cover& cover, const std::vector<Solid>& solids, int solid, int element);
    void subtractCut(Cover& cover, const std::vector<Solid>& solids, const CutElement& cut);
    void subtractSolidPart(const Cover& cover, CoveredVolume& volume) const;
    void addSolidPart(double sign, const double* second, CoveredVolume& volume) const;
    CoveredVolume& coveredVolume(Cover& cover, int element);
    bool isShared(const Cover& cover, int solid, int element) const;
    Vec3 pointIn(int element, const double* shape) const;
    bool moveSurface(OffsetSearch& search, Solid& solid, const OwnCut& own);
    void takeNewtonStep(OffsetSearch& search, Solid& solid, const Eigen::Vector4d& missing, const OwnCut& own, bool hasCentroid) const;
    bool bracketSurface(OffsetSearch& search, Solid& solid, double missing, const OwnCut& own) const;
    double offsetLimit(const OwnCut& own) const { return largestOffset * own.areaTimesH / own.surface(0, 0); }
    const Cover& cutMovingSolids(const std::vector<Solid>& solids);

    void applySamples(Cover& cover, const std::vector<Solid>& solids, int solid, const std::vector<Sample>& samples);
    double cutDistance(const Solid& solid, const Sample& sample) const;
    int cutFace(const Sample& sample, double cutDistance) const { return cutDistance > sample.film ? sample.face : sample.filmFace; }
    template <class Visit> void forEachElementOf(const Sample& sample, double distance, const std::vector<int>& face, Visit visit) const;
    bool isNear(const std::vector<double>& distance, int element) const;
    bool isAtEdge(const std::vector<int>& face, int element) const;
    bool hasSeveralParts(const std::vector<int>& face, int element) const;
    bool isDeepIn(const std::vector<double>& distance, int element) const;
    bool isOnBoundary(int element) const;
    void restoreFixedCover();
    void cutFarElements(const std::vector<Solid>& solids);
    void findClosedFaces(const Cover& cover);
    void addClosedFaces();
    void addElementsOf(const Cover& cover, const std::vector<Solid>& solids, int solid, const std::vector<Sample>& samples);
    void cutElement(Cover& cover, const std::vector<Solid>& solids, int element) const;
    bool onlyTouches(int element, const double* distance, int nInside) const;
    bool isAtEdgeOfOne(const Cover& cover, int element) const;
    bool endsAtEdge(const Cover& cover, int element) const;
    bool endsAtEdge(const Cover& cover, int element, int corner) const;
    template <int dim>
    void closeFaces(const Cover& cover, const std::vector<Solid>& solids, int element, const double* distance, std::vector<SimplexFacet<dim>>& facets) const;
    template <int dim> void cutElementAtEdge(Cover& cover, const std::vector<Solid>& solids, int element, const double* distance) const;
    template <int dim> void cutElementOf(Cover& cover, const std::vector<Solid>& solids, int element, const double* distance) const;
    template <int dim>
    void storeCut(Cover& cover, const std::vector<Solid>& solids, int element, const SimplexMoments<dim>& cut,
        const SimplexFacet<dim>* facets, int nFacets, const int* solidOf = nullptr) const; // solidOf: of SimplexFacet::solid, -1: by the place
    template <int dim> std::array<double, (dim + 1) * dim> verticesOf(int element) const;
    template <int dim> void addCuttingFaces(const Solid& solid, int element, CuttingFaces& faces) const;
    /// Valid until the next one.
    template <int dim> const EdgeCut<dim>& cutAtEdge(const CuttingFaces& faces, int element, bool areApart = false) const;
    int solidAt(const Cover& cover, const std::vector<Solid>& solids, int element, const double* shape) const;
    void copyFixedCuts();
    void findGhostFaces(Cover& cover) const;
    void findActiveNodes(Cover& cover, const std::vector<int>& elements);
    void shareActiveNodes(Cover& cover) const;
    void account(const Cover& cover, int element, double sign, std::vector<double>& totals) const;
    void sumTotals(Cover& cover, std::vector<double> totals, int nSolids) const;

    const int* nodesOf(int element) const { return &mesh_.elements[std::size_t(element) * (mesh_.dim + 1)]; }
    bool firstVisit(std::vector<int>& mark, int i) const;

    const SimplexMesh& mesh_;
    const NodeGraph& graph_;
    const Halo& halo_;
    NodeBins bins_;
    WallFilm film_;
    std::vector<double> snap_;          // nNodes: distance that counts as solid [m]
    mutable std::tuple<EdgeCut<2>, EdgeCut<3>> edgeCut_, partCut_;
    mutable std::vector<int> solidOfPart_;  // of the element at hand
    mutable NodeFaces nodeFaces_;
    mutable CuttingFaces cutting_;      // scratch
    mutable std::vector<double> joined_;    // scratch
    std::vector<int> elementFace_;      // nElements*(dim+1): position in graph.faces, -1 at the boundary
    std::vector<char> isBoundaryNode_;
    std::array<double, 3> lower_{}, upper_{};   // of the whole mesh, in its plane

    std::vector<Solid> lastSolids_;     // of the last buildExactVolume() without free ones, else empty
    bool hasFixedCover_ = false;
    std::vector<Solid> fixedSolids_;    // those (with gaps for the others) that fixedCover_ was cut with
    Cover fixedCover_;                  // the fixed solids alone
    std::vector<int> fixedFace_;        // nNodes: face_ of fixedCover_
    std::vector<char> isNearFixedCut_;  // nNodes: node of an element that the fixed solids cut
    std::vector<ClosedFace> closedFaces_;
    std::vector<double> fixedTotals_;   // volume, area per solid and shared elements of fixedCover_, this rank

    Cover cover_;
    std::vector<std::vector<Sample>> samples_;  // per solid
    std::vector<int> touchedNodes_, touchedElements_;   // where cover_ may differ from fixedCover_
    mutable std::vector<int> elementMark_, nodeMark_;
    mutable int mark_ = 0;
    std::vector<int> face_;             // nNodes: face of the nearest solid, of cover_
    std::vector<double> aloneDistance_; // nNodes, scratch
    std::vector<int> aloneFace_;        // nNodes, scratch
    mutable std::vector<char> partsAt_; // nNodes, scratch: parts of one solid that are near
    std::vector<KnownVolume> knownVolumes_;
    std::vector<RoundShape> roundShapes_;
    std::vector<Polyhedron> polyhedra_;
    double longest_ = 0;                // element length of the whole mesh
    std::vector<SharpPart> sharpParts_;   // by element
    std::vector<int> firstSharpPart_;   // nElements, empty at first: of an element, -1: it has none
    std::vector<int> sharpElements_;    // with sharp parts or nodes nearest to sharp solids
    mutable std::vector<SharpElement> sharpElement_;  // nElements, empty while there are none; which are clear is found as they are cut
    std::vector<char> isNearOther_;     // nNodes, see markOthers()
    std::vector<int> coveredVolumeOf_;  // nElements, empty at first: position in cover_.coveredVolumes, -1 outside of findCovered()
    std::vector<int> sharedNodes_;      // of elements with nodes of several solids
    std::vector<char> isSharedNode_;    // nNodes
    const bool isNeedless_;             // see algebra/needlessWork.hpp
};

/// Elements without mark that a solid at `distance` from the node may cut: all of a node inside. Of a node outside those where an edge of the solid may pass
/// between the nodes: then one of them is nearer than 3/4 of the longest edge.
template <class Visit>
void CoverBuilder::forEachElementOf(const Sample& sample, double distance, const std::vector<int>& face, Visit visit) const
{
    if (distance > 0.75 * bins_.reach(sample.node)) return;
    for (int k = graph_.nodeElementStart[sample.node]; k < graph_.nodeElementStart[sample.node + 1]; ++k)
        if (const int e = graph_.nodeElement[k]; elementMark_[e] != mark_ && (distance < 0 || isAtEdge(face, e))) visit(e);
}

/// Elements that the solid alone may cut, halo elements too; aloneDistance_ and aloneFace_ are its own meanwhile. accept: nodes whose elements count.
template <class Visit, class Accept>
void CoverBuilder::forEachLocalAlone(const Solid& solid, const std::vector<Sample>& samples, Visit visit, Accept accept)
{
    for (const Sample& s : samples)
    {
        const double distance = cutDistance(solid, s);
        if (distance >= aloneDistance_[s.node]) continue; // of another part
        aloneDistance_[s.node] = distance;
        aloneFace_[s.node] = cutFace(s, distance);
    }
    ++mark_;
    for (const Sample& s : samples)
    {
        if (!accept(s.node)) continue;
        forEachElementOf(s, aloneDistance_[s.node], aloneFace_, [&](int e)
        {
            elementMark_[e] = mark_;
            visit(e);
        });
    }
    for (const Sample& s : samples)
    {
        aloneDistance_[s.node] = farDistance;
        aloneFace_[s.node] = 0;
    }
}

/// Those of them that are inner.
template <class Visit, class Accept>
void CoverBuilder::forEachElementAlone(const Solid& solid, const std::vector<Sample>& samples, Visit visit, Accept accept)
{
    forEachLocalAlone(solid, samples, [&](int e) { if (e < mesh_.nInnerElements) visit(e); }, accept);
}

/// distance: dim+1, of the nodes, within forEachLocalAlone().
template <int dim>
CoverBuilder::AloneCut CoverBuilder::howCutAlone(int element, double* distance) const
{
    for (int a = 0; a <= dim; ++a) distance[a] = aloneDistance_[nodesOf(element)[a]];
    const auto nInside = std::count_if(distance, distance + dim + 1, [](double d) { return d < 0; });
    const bool isByFaces = isAtEdge(aloneFace_, element);
    if (!isNear(aloneDistance_, element)) return AloneCut::None;
    if (nInside == dim + 1 && (!isByFaces || !hasSeveralParts(aloneFace_, element) || isDeepIn(aloneDistance_, element))) return AloneCut::Whole;
    return isByFaces ? AloneCut::ByFaces : nInside > 0 ? AloneCut::ByDistance : AloneCut::None;
}

/// visit(moments of the fluid part, facets, their number) of an element that the solid has a part in, within forEachElementAlone().
template <int dim, class Visit>
void CoverBuilder::visitCutAlone(const Solid& solid, int element, Visit visit) const
{
    double distance[dim + 1];
    const AloneCut how = howCutAlone<dim>(element, distance);
    const SimplexFacet<dim>* none = nullptr;
    if (how == AloneCut::Whole) visit(SimplexMoments<dim>{}, none, 0);
    else if (how == AloneCut::ByFaces)
    {
        cutting_.clear();
        addCuttingFaces<dim>(solid, element, cutting_);
        if (cutting_.isApart()) return;
        const EdgeCut<dim>& cut = cutAtEdge<dim>(cutting_, element);
        visit(cut, cut.facets.data(), static_cast<int>(cut.facets.size()));
    }
    else if (how == AloneCut::ByDistance)
    {
        const SimplexCut<dim> cut = cutSimplex<dim>(distance, mesh_.volume[element], verticesOf<dim>(element).data(),
            &mesh_.gradN[std::size_t(element) * (dim + 1) * dim]);
        visit(cut, cut.facets, cut.nFacets);
    }
}

} // namespace flotsam
