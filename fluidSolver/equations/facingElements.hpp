// SPDX-License-Identifier: GPL-3.0-or-later
/// Elements near the free surface, with a say in its direction at their nodes.
#pragma once

#include "algebra/halo.hpp"
#include "geometry/cover.hpp"

namespace flotsam
{

/// Limits of alpha beyond which it says nothing about the level. As far out as nodes of cut elements lie: up to 1.1 h from the surface on slanted triangles, 1.7 h in
/// tetrahedra, farther beside smaller elements, whose size is in the tetrahedra, and a level cut off there tilts the element's plane.
constexpr double lowestOfBand = 1e-5, highestOfBand = 1 - lowestOfBand;

/// Its lists keep their memory from step to step.
template<int D>
class FacingElements
{
public:
    FacingElements(const SimplexMesh& mesh, const Halo& halo) : mesh_(mesh), halo_(halo) {}

    /// Of a phase field. Solid elements of the cover (null: none) have no say. work: what it needs for each node, void before and after. Collective.
    void find(const std::vector<double>& alpha, const Cover* cover, std::vector<double>& work);

    const std::vector<int>& nodes() const { return node_; } ///< of the elements; their order is that of places
    const std::vector<int>& band() const { return band_; }  ///< owned ones whose level is sought
    int place(int node) const { return local_[node]; }      ///< of a node of the elements

    /// Whether a node's surroundings were summed last.
    bool isWanted(int place) const { return isWanted_[place]; }
    /// Around a wanted node: weighted gradients of the level, D, and their lengths.
    double* sum(int place) { return &sums_[std::size_t(place)*N]; }
    void sumGradients(const std::vector<double>& level);
    /// From now on those are wanted that have one of the nodes that moved (places) in an element: in spray a few nodes never come to rest, and from the
    /// sixth repeat on a tenth of the elements acts and less.
    void wantNeighbours(const std::vector<int>& moved);

private:
    static constexpr int N = D + 1;
    struct Element { const double* gradN; double weight; int node[N], local[N]; };

    void findCandidates(const std::vector<double>& alpha, const Cover* cover);
    void markNearSurface(const std::vector<double>& alpha, std::vector<double>& isNear) const;
    void addElement(int e, const std::vector<double>& alpha, const Cover* cover);
    void findElements(const std::vector<double>& alpha, const Cover* cover, const std::vector<double>& isNear);
    void wantBand();
    void want(int place) { if (!isWanted_[place]) { isWanted_[place] = 1; wanted_.push_back(place); } }
    void listElementsAround();

    const SimplexMesh& mesh_;
    const Halo& halo_;
    std::vector<int> candidates_;       // elements with nodes in the band
    std::vector<Element> elements_;
    std::vector<int> local_;            // per mesh node: its place, -1: none
    std::vector<int> node_, band_;
    std::vector<double> sums_;
    std::vector<char> isWanted_;        // per place
    std::vector<int> wanted_;           // places
    std::vector<int> acting_;           // elements with wanted nodes, ascending: sums are the same to the last bit whoever else acts
    std::vector<char> isActing_;        // per element
    std::vector<int> start_, around_;   // elements of each place, from the second repeat on
    bool areAroundListed_ = false;
};

} // namespace flotsam
