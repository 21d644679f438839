// SPDX-License-Identifier: GPL-3.0-or-later
/// Volume fluxes of the dual cells through the boundary of the mesh.
#pragma once

#include "core/boundary.hpp"
#include "equations/volumeFlux.hpp"

namespace flotsam
{

/// Flux of one owned node through one patch.
struct BoundaryFlux
{
    int node;
    double flux;        ///< out of the domain [m^dim/s]
    double alphaIn;     ///< of fluid that enters; negative: the node's own
};

class TransportBoundary
{
public:
    TransportBoundary(const SimplexMesh& mesh, const NodeGraph& graph, const VolumeFlux& volumeFlux);

    /// Patches with given velocity: int N_i u.n over the fluid part of their faces (slip: none). Nodes of open patches and nodes with fixed
    /// pressure, where the solver has no continuity row: what closes the balance of the dual cell.
    void evaluate(const std::vector<double>& u, const std::vector<double>& fineScale, const Cover* cover,
        const std::vector<BoundaryPatch>& patches, const std::vector<PatchValues>& values,
        const std::vector<char>& isPressureFixed, const std::vector<PairFlux>& pairFlux);

    const std::vector<BoundaryFlux>& fluxes() const { return fluxes_; }

private:
    template<int D> void addFaces(const MeshPatch& patch, const std::vector<double>& u, const Cover* cover);
    void addGivenVelocity(const std::vector<double>& u, const Cover* cover, const std::vector<BoundaryPatch>& patches, const std::vector<PatchValues>& values);
    void markClosingNodes(const std::vector<BoundaryPatch>& patches, const std::vector<PatchValues>& values, const std::vector<char>& isPressureFixed);
    void close(const std::vector<double>& u, const std::vector<double>& fineScale, const Cover* cover, const std::vector<PairFlux>& pairFlux);

    const SimplexMesh& mesh_;
    const NodeGraph& graph_;
    const VolumeFlux& volumeFlux_;
    std::vector<BoundaryFlux> fluxes_;
    std::vector<double> nodal_;         // nNodes: work, zero outside the calls
    std::vector<int> closing_;          // owned nodes whose balance is closed here
    std::vector<int> closingIndex_;     // nNodes: position in closing_, -1
    std::vector<double> closingAlpha_, closingSum_;
};

} // namespace flotsam
