// SPDX-License-Identifier: GPL-3.0-or-later
/// The free surface as planes: one plane per element that the surface cuts, handed on to the nodes around it.
/// Only nodes near the surface are touched; the storage is reused from call to call.
#pragma once

#include "algebra/halo.hpp"
#include "core/nodeGraph.hpp"

namespace flotsam
{

class DualCells;
struct Cover;

/// The nearest surface plane of every node near the surface.
class InterfacePlanes
{
public:
    bool has(int node) const { return !data_.empty() && at(node)[2*dim_] > 0; }
    const double* point(int node) const { return at(node); }             ///< dim: on the surface, inside the cut element [m]
    const double* normal(int node) const { return at(node) + dim_; }     ///< dim: unit, into the liquid
    /// How far beside the plane's own point it speaks for the surface: length of the cut element, in stretched ones its longest edge over sqrt(dim) [m].
    double reach(int node) const { return at(node)[2*dim_]; }
    double distance(int node) const { return distance_[node]; }          ///< normal.(x - point): positive in the liquid [m]
    double distanceFromSurface(const SimplexMesh& mesh, int node) const;  ///< from the part of the plane within its reach [m], positive
    const std::vector<int>& nodes() const { return nodes_; }             ///< local nodes that have a plane, no order

    /// How far planes are handed on: over so many rings of nodes, and from there over nodes within so many profile widths (nNodes [m]) of the surface.
    struct Extent
    {
        int rings;
        const std::vector<double>* width = nullptr; ///< null: over the rings alone
        double widths = 0;
        bool throughSolids = false;                 ///< inside solids as far as these go beside the surface: between logs of a raft there is none of its own
    };

    /// Planes of the zero level of `level` (nNodes, halo up to date, positive in the liquid), handed on; a node takes the plane with the nearest point.
    /// Elements that `cover` calls solid are left out. hasMeanNormals: normals are means over the neighbouring cut elements.
    /// Collective; the result does not depend on the number of ranks.
    void propagate(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const std::vector<double>& level, const Extent& extent,
        const Cover* cover = nullptr, bool hasMeanNormals = false);

private:
    const double* at(int node) const { return &data_[static_cast<std::size_t>(node)*width_]; }
    double* at(int node) { return &data_[static_cast<std::size_t>(node)*width_]; }
    void clear(const SimplexMesh& mesh);
    void planesOfCutElements(const SimplexMesh& mesh, const std::vector<double>& level, const Cover* cover);
    void alignNormals(const SimplexMesh& mesh);
    template<int dim> void offerCutPlanes(const SimplexMesh& mesh);
    template<int dim> void offer(const SimplexMesh& mesh, int node, const double* plane);
    template<int dim> void sweep(const SimplexMesh& mesh, const NodeGraph& graph);
    void commit();
    double alongNormal(const SimplexMesh& mesh, int node) const;
    bool keepNear(const SimplexMesh& mesh, const Halo& halo, const Extent& extent);
    void handOnThroughSolids(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const Extent& extent, const Cover& cover);
    void exchange(const SimplexMesh& mesh, const Halo& halo);

    int dim_ = 0, width_ = 0;
    std::vector<double> data_;      // nNodes*width_: point, normal, reach; without a plane 0
    std::vector<double> next_;      // the same, during a sweep
    std::vector<double> nearest_;   // squared distance of a node from the point of its plane in next_ [m^2]; infinite: it has none
    std::vector<double> distance_;
    std::vector<int> nodes_, changed_, offered_;
    std::vector<char> isOffered_;
    std::vector<int> cutElements_;
    std::vector<double> cutPlanes_;     // per cut element: point, normal, reach
    std::vector<double> normalSum_;     // per node of cut elements: normals times volume, volume
    std::vector<double> before_;    // halo entries before an exchange
};

} // namespace flotsam
