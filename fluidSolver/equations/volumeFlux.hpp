// SPDX-License-Identifier: GPL-3.0-or-later
/// Volume fluxes through the faces of the median dual cells.
///
/// In a fluid element F_ab = (u(x_f) + u').S_ab, exact for the linear velocity. Summed over a dual cell this is
/// int N_a div u - int grad N_a.u', the continuity row of the stabilised P1/P1 scheme, up to the difference between
/// int N_a u.n and the flux through the node's own share of the faces that bound the region of fluid elements;
/// that difference is added between the nodes of those faces. In a cut element F_ab = (r_a - r_b)/(dim+1) with the row's
/// own r_a = -grad N_a . int_{fluid part}(u + u'), whose sum over b is r_a because sum r_a = 0.
#pragma once

#include "core/nodeGraph.hpp"
#include "equations/dualCells.hpp"
#include "geometry/cover.hpp"

#include <algorithm>

namespace flotsam
{

/// Volume flux from node a to node b [m^dim/s].
struct PairFlux { int a, b; double flux; };

/// Pairs of corners in the order of all loops: 01 02 (03) 12 (13 23).
template<int dim> struct CornerPairs;
template<> struct CornerPairs<2>
{
    static constexpr int count = 3;
    static constexpr int first[3] = {0, 0, 1}, second[3] = {1, 2, 2};
};
template<> struct CornerPairs<3>
{
    static constexpr int count = 6;
    static constexpr int first[6] = {0, 0, 0, 1, 1, 2}, second[6] = {1, 2, 3, 2, 3, 3};
};

/// What the fluxes of an element's pairs bring to each corner and take from it, both >= 0.
template<int dim> struct CornerSums
{
    double in[dim + 1] = {}, out[dim + 1] = {};

    explicit CornerSums(const double* flux)
    {
        using Pairs = CornerPairs<dim>;
        for (int p = 0; p < Pairs::count; ++p)
        {
            const double forward = std::max(flux[p], 0.), backward = std::max(-flux[p], 0.);
            in[Pairs::second[p]] += forward;
            out[Pairs::first[p]] += forward;
            in[Pairs::first[p]] += backward;
            out[Pairs::second[p]] += backward;
        }
    }
};

class VolumeFlux
{
public:
    VolumeFlux(const SimplexMesh& mesh, const NodeGraph& graph);

    /// No cover will ever be given: what only covers need is freed.
    void forgetNeighbours() { std::vector<int>().swap(neighbour_); }

    /// Fluxes a -> b of all pairs of corners of element e [m^dim/s]; zero in a solid element.
    /// fineScale may be empty, cover null.
    template<int dim> void ofElement(int e, const std::vector<double>& u, const std::vector<double>& fineScale,
        const Cover* cover, double* flux) const;

    /// r_a of one corner of element e: its share of the continuity row without boundary terms [m^dim/s].
    double row(int e, int corner, const std::vector<double>& u, const std::vector<double>& fineScale, const Cover* cover) const;

private:
    template<int dim> void addOuterFaces(int e, const std::vector<double>& u, const Cover* cover, double* flux) const;

    bool isOuterFace(int e, int corner, const Cover* cover) const
    {
        return (atEdge_[e] >> corner & 1) || (cover && cover->state[neighbour_[std::size_t(e)*(mesh_.dim + 1) + corner]] != ElementState::Fluid);
    }

    const SimplexMesh& mesh_;
    std::vector<int> neighbour_;    // nElements*(dim+1): element across the face opposite to a corner, -1 none
    std::vector<char> atEdge_;      // nElements, a bit per corner: no element across the face opposite to it
};

} // namespace flotsam
