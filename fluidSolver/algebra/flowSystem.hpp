// SPDX-License-Identifier: GPL-3.0-or-later
/// The linear system of one step: fluid unknowns (u, p) at the nodes and velocities of the solids.
///
/// Fluid block: on the node graph (owned rows, complete). The couplings that leave the
/// graph or are of low rank are kept apart: ghost penalty faces (rank one each) and the solids' rows and columns.
#pragma once

#include "algebra/blockMatrix.hpp"
#include "core/nodeGraph.hpp"

#include <vector>

namespace flotsam
{

/// Ghost penalty of one face: velocity c_u [dn u_k][dn w_k], pressure c_p [dn p/rho][dn q/rho]; rank one per component.
struct GhostTerm
{
    int node[5];            ///< dim+2 local nodes: the face's, then the two opposite ones
    double jumpVelocity[5]; ///< [dn N_j] [1/m]
    double jumpPressure[5]; ///< [dn N_j/rho]
    double velocityFactor;  ///< c_u times face area
    double pressureFactor;
    double pressureSource;  ///< [f.n/rho]: the hydrostatic part, not penalised
};

/// Coupling of one solid with the nodes around its surface. nDof = 3 (2D: Vx Vy omega) or 6 (V, omega), space frame.
struct SolidCoupling
{
    std::vector<int> node;      ///< local nodes touched by the solid's cut elements
    std::vector<double> column; ///< node.size()*(dim+1)*nDof: rows of the node, columns of the solid
    std::vector<double> row;    ///< node.size()*nDof*(dim+1): rows of the solid; only this rank's own elements
    std::vector<double> block;  ///< nDof*nDof solid-solid; only this rank's own elements
    std::vector<double> load;   ///< nDof: of the fluid besides the rows; all ranks' elements
    bool isFree = false;
    std::vector<double> inertia; ///< nDof*nDof mass matrix / dt (free solids; same on every rank)
    std::vector<double> rhs;     ///< nDof: history, weight, contact (free solids; same on every rank)

    /// Of the nodes, which keep their memory.
    void clear()
    {
        node.clear();
        for (std::vector<double>* v : {&column, &row, &block, &inertia, &rhs}) v->clear();
    }
};

/// Directions in which the velocity of a node is prescribed.
struct NodeConstraint
{
    int node;
    int nDirections;
    double direction[3][3]; ///< orthonormal; nDirections == dim: the whole vector
};

/// All of the velocity of a node.
inline NodeConstraint wholeVelocity(int node, int dim)
{
    NodeConstraint c{};
    c.node = node;
    c.nDirections = dim;
    for (int d = 0; d < dim; ++d) c.direction[d][d] = 1;
    return c;
}

struct FlowSystem
{
    int dim = 3, nDof = 6;
    BlockMatrix matrix;             ///< graph.column.size() entries
    std::vector<double> schur;      ///< graph.column.size(): scalar pressure Schur approximation
    std::vector<double> pressureMass; ///< nOwned: sum of V/(mu + tau_c), the viscous part of the Schur complement
    std::vector<double> rhs;        ///< nOwned*(dim+1)
    std::vector<GhostTerm> ghosts;
    std::vector<SolidCoupling> solids;
    std::vector<NodeConstraint> constraints;    ///< owned nodes
    std::vector<char> isPressureFixed;          ///< nNodes
    std::vector<char> isActive;                 ///< nNodes: has a fluid element
    std::vector<char> isLight;                  ///< nOwned: beside elements far denser than the node itself (gas beside water)
    std::vector<double> inertia;                ///< nOwned: of the fluid around the node, over the time step [kg/s; 2D: kg/(m s)]
    std::vector<double> dualVolume;             ///< nOwned: fluid part [m^dim]
    int nLevels = 0;                            ///< groups of basins without a prescribed pressure that share one mean (all ranks)
    std::vector<int> level;                     ///< nNodes: the group of a node, -1: its pressure has no mean to keep; empty: no groups
    std::vector<double> levelWeight;            ///< nOwned, sum 1 over the nodes of a group (all ranks): the mean that a solve keeps; empty: no groups
    double viscousNumber = 0;                   ///< mean of mu dt/(rho h^2) over the elements with fluid (all ranks)
    bool areForcesAsked = false;                ///< those on patches of the mesh: solved as exactly as with solids
    bool isFirst = false;                       ///< of a run: nothing is known of the solution
    bool isNewMatrix = true;                    ///< assembled since the last solve; else only right-hand sides of solids have changed
};

inline bool isFreePressure(const FlowSystem& system, int i) { return system.isActive[i] && !system.isPressureFixed[i]; }

inline double schurDiagonal(const FlowSystem& system, const NodeGraph& graph, int i)
{
    const double d = system.schur[graph.diagonal[i]];
    return d > 0 ? d : 1;
}

} // namespace flotsam
