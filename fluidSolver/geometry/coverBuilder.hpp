// SPDX-License-Identifier: GPL-3.0-or-later
/// Largest Solid::offset that buildExactVolume sets, over the element length.
constexpr double largestOffset = 0.2;

/// Cuts one mesh again and again as solids move. What does not move is cut once; a step costs what is near the
/// moving solids, not mesh size times solids.
#pragma once

#include "geometry/cover.hpp"
#include "geometry/nodeBins.hpp"

#include <cmath>

namespace flotsam
{

class CoverBuilder
{
public:
    /// Keeps references: mesh, graph and halo must outlive the builder. Collective.
    CoverBuilder(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo);

    /// Cuts the mesh with the solids at their poses. Distances are known only within two element lengths (or the
    /// longest edge) of a solid; farDistance beyond. Nodes closer to a surface than 1e-12 of an element length count as solid; parts below
    /// `negligiblePart` are dropped. The result is valid until the next call; copy it to keep it. Collective.
    const Cover& build(const std::vector<Solid>& solids);

    /// Before cutting, moves the surface of every free solid by one Newton step, starting from its current Solid::offset, so
    /// that the volume it cuts out alone (without neighbours) becomes exactVolume(). At most largestOffset.
    /// A free solid that reaches through the boundary of the mesh, or is not in it, keeps its offset. Fixed slip solids are moved once,
    /// to cut out the volume of their part inside the mesh. Collective.
    const Cover& buildExactVolume(std::vector<Solid>& solids);

    const Cover& cover() const { return cover_; }

    /// 3D: the shape's volume [m^3]. 2D: its section with the mesh's plane [m^2]; if the shape is
    /// prismatic along the empty direction (within 1 %), exactly volume over extent. Kept per shape and direction.
    double exactVolume(const Solid& solid);

private:
    /// Distances of one moving solid at the nodes near it, without the solid's offset.
    struct Sample { int node; double distance; };

    /// Volume and surface that one solid alone cuts out, this rank's share.
    struct OwnCut { double volume = 0, area = 0, areaTimesH = 0, reachesThrough = 0; };

    struct KnownVolume
    {
        std::shared_ptr<const Shape> shape;
        Vec3 direction;     // of the mesh plane's normal in the body frame
        double height;      // of the mesh plane over the body's origin
        double volume;
    };

    static bool isSameFixed(const Solid& now, const Solid& then);
    bool sameFixedSolids(const std::vector<Solid>& solids) const;
    void cutFixedSolids(const std::vector<Solid>& solids);
    void sampleMovingSolids(const std::vector<Solid>& solids);
    void sample(const Solid& solid, std::vector<Sample>& samples) const;
    void correctOffsets(std::vector<Solid>& solids);
    void correctFixedOffsets(std::vector<Solid>& solids);
    double volumeInside(const Solid& solid, const std::vector<Sample>& samples);
    OwnCut cutAlone(const Solid& solid, const std::vector<Sample>& samples);
    const Cover& cutMovingSolids(const std::vector<Solid>& solids);

    void applySamples(Cover& cover, int solid, double offset, const std::vector<Sample>& samples) const;
    void restoreFixedCover();
    void addElementsOf(const std::vector<Sample>& samples, double offset);
    void cutElement(Cover& cover, const std::vector<Solid>& solids, int element) const;
    template <int dim> void cutElementOf(Cover& cover, const std::vector<Solid>& solids, int element, const double* distance) const;
    int solidAt(const Cover& cover, const std::vector<Solid>& solids, int element, const double* shape) const;
    void copyFixedCuts();
    void findGhostFaces(Cover& cover) const;
    void findActiveNodes(Cover& cover, const std::vector<int>& elements);
    void shareActiveNodes(Cover& cover) const;
    void account(const Cover& cover, int element, double sign, std::vector<double>& totals) const;
    void sumTotals(Cover& cover, std::vector<double> totals, int nSolids) const;

    const int* nodesOf(int element) const { return &mesh_.elements[std::size_t(element) * (mesh_.dim + 1)]; }
    double snapped(int node, double distance) const { return std::abs(distance) < snap_[node] ? -snap_[node] : distance; }
    bool firstVisit(std::vector<int>& mark, int i) const;

    const SimplexMesh& mesh_;
    const NodeGraph& graph_;
    const Halo& halo_;
    NodeBins bins_;
    std::vector<double> snap_;          // nNodes: distance that counts as solid [m]
    std::vector<int> elementFace_;      // nElements*(dim+1): position in graph.faces, -1 at the boundary
    std::vector<char> isBoundaryNode_;

    bool hasFixedCover_ = false;
    std::vector<Solid> fixedSolids_;    // those (with gaps for the others) that fixedCover_ was cut with
    Cover fixedCover_;                  // the fixed solids alone
    std::vector<char> isNearFixedCut_;  // nNodes: node of an element that the fixed solids cut
    std::vector<double> fixedTotals_;   // volume, area per solid and shared elements of fixedCover_, this rank

    Cover cover_;
    std::vector<std::vector<Sample>> samples_;  // per solid
    std::vector<int> touchedNodes_, touchedElements_;   // where cover_ may differ from fixedCover_
    mutable std::vector<int> elementMark_, nodeMark_;
    mutable int mark_ = 0;
    std::vector<double> aloneDistance_; // nNodes, scratch
    std::vector<KnownVolume> knownVolumes_;
};

} // namespace flotsam
