// SPDX-License-Identifier: GPL-3.0-or-later
/// The mathematical mesh: conforming triangles (dim 2) or tetrahedra (dim 3), one rank's share of it.
///
/// Distribution ("complete rows"): a rank owns nodes 0..nOwned-1 and holds every element within two node
/// rings of them, so that every matrix row, dual cell and ghost-penalty face of an owned node is assembled
/// without sending a matrix entry. Values at the nodes nOwned..nNodes-1 are refreshed by algebra/halo.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace flotsam
{

/// One boundary patch of the mesh: its boundary simplices (edges in 2D, triangles in 3D).
struct MeshPatch
{
    std::string name;
    std::string type;               ///< OpenFOAM's patch type: patch, wall, symmetryPlane, symmetry
    std::vector<int> faceNodes;     ///< dim local nodes per face; normal by right-hand rule points OUT of the domain (2D: edge (p,q), normal (dy,-dx))
    std::vector<int> faceElement;   ///< local element behind each face
    std::vector<char> isOwnedFace;  ///< 1 on exactly one rank per face: use it for global sums
};

struct SimplexMesh
{
    int dim = 3;
    int nOwned = 0;     ///< nodes owned by this rank: local numbers 0..nOwned-1
    int nNodes = 0;     ///< owned and halo nodes
    int nElements = 0;  ///< elements held: every element within two node rings of an owned node
    int nInnerElements = 0; ///< the first of them have an owned node (first ring); the rest are second ring

    std::vector<double> x;          ///< nNodes*dim, in-plane coordinates [m]
    std::vector<int> elements;      ///< nElements*(dim+1) local nodes, positive volume
    std::vector<char> isOwnedElement; ///< 1 on exactly one rank per element, one that owns a node of it: use it for global sums
    std::vector<std::int64_t> globalNode;   ///< nNodes; contiguous per rank for owned nodes: firstGlobal + i
    std::vector<std::int64_t> originalNode; ///< nNodes; 0..nGlobal-1, does not depend on the decomposition
    std::vector<int> nodeOwner;     ///< nNodes; rank that owns the node
    std::int64_t firstGlobal = 0;   ///< global number of local node 0
    std::int64_t nGlobal = 0;       ///< nodes of all ranks

    std::vector<MeshPatch> patches; ///< without empty and processor patches; same list and order on every rank

    // 2D scenes: plane of the mesh in space. 3D: axes 0,1,2, thickness 1.
    std::array<int, 3> axes{0, 1, 2};   ///< space component of in-plane component 0..dim-1; axes[2] = empty direction in 2D; always right-handed (empty y: 2 0 1)
    double planeOffset = 0;             ///< coordinate of the mid-plane along axes[2] (2D) [m]
    double thickness = 1;               ///< extent of the domain along axes[2] (2D) [m]; integrals times this are 3D values

    // derived, filled by computeGeometry()
    std::vector<double> volume;     ///< nElements, area in 2D [m^dim]
    std::vector<double> gradN;      ///< nElements*(dim+1)*dim: gradient of shape function a, component d at [(e*(dim+1)+a)*dim+d] [1/m]
    std::vector<double> h;          ///< nElements, element length (dim! * volume)^(1/dim) [m]

    /// Fills volume, gradN, h. Swaps two nodes of an inverted element; throws std::runtime_error for a flat one.
    void computeGeometry();

    /// Position of local node i in space [m] (2D: on the mid-plane).
    std::array<double, 3> spacePoint(int i) const;
};

} // namespace flotsam
