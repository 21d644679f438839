// SPDX-License-Identifier: GPL-3.0-or-later
/// Fluid that bodies and walls shut in within gaps of an element or less.
///
/// A pocket has no node with whole elements all around, and no node outside the solids joins it to other fluid. It has a pressure level of its own, which nothing fixes but
/// the solids around: their motion must keep the pocket's volume to the last bit, at any time step. Among structures alone that has no solution, beside bodies
/// none that iterations find. Nor has the flow in a pocket of that size a meaning: gaps below the mesh carry what the mesh can carry.
///
/// So pockets are not solved for. What acts on the solids is the pressure of the nearest other fluid, taken through the solids. It balances neither weight nor
/// motion within the pocket (at the corners of a pocket around a single node, a hundredth of an element deep, 0.05 became 16 m/s in a step): the fluid of a
/// pocket moves with the nearest solid. Nodes in solids that a pocket shares with other fluid belong to that fluid and do not join the two: pockets that
/// they joined have had 1e5 Pa and 110 m/s.
///
/// Gaps between solids of less than a fiftieth of an element are pockets, too, open at their ends or not: the thinner the gap, the faster the fluid that solids press out
/// of it when they move against each other, and the friction that would hold it back is not resolved.
/// Among the surfaces that solids cover of each other the pockets' pressures are unknowns of the layer there (flowLayers.cpp).
#pragma once

#include "equations/basins.hpp"

#include <array>

namespace flotsam
{

class ShutPockets
{
public:
    ShutPockets(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo);

    /// Finds them in the cover. isPressureFixed (nNodes): by a boundary. Collective.
    void find(const Cover& cover, const std::vector<char>& isPressureFixed);

    /// Their pressures: p (nNodes) of the fluid nearest around, through the solids, with the weight of the density rho (nNodes) from there. gravity: in
    /// the mesh's axes. After find(), where there are any. Collective.
    void setPressures(const std::vector<double>& p, const std::vector<double>& rho, const std::array<double, 3>& gravity);

    bool areAny() const { return !isIn_.empty(); }      ///< on any rank
    bool isNode(int i) const { return !isIn_.empty() && isIn_[i]; }     ///< of pockets alone
    double pressure(int i) const { return pressure_[i]; }               ///< [Pa]

private:
    void findLeftOut(const Cover& cover);
    void findOpen(const Cover& cover, const std::vector<char>& isPressureFixed);
    double fluidShare(const Cover& cover, int i) const;
    void addNodesInSolids(const Cover& cover);

    const SimplexMesh& mesh_;
    const NodeGraph& graph_;
    const Halo& halo_;
    Basins fluids_;                     // joined by nodes outside solids and their thinnest gaps
    std::vector<char> isBoundaryNode_;  // nNodes: of the mesh
    std::vector<int> isIn_;             // nNodes; empty: no pockets on any rank
    std::vector<char> isOutside_;       // nNodes: in fluid that is none
    std::vector<double> pressure_;
    std::vector<int> isLeftOut_;        // work of find(): nNodes
    std::vector<char> isKnown_, isOpen_, isBasinOutside_;   // likewise; the last one per basin
};

} // namespace flotsam
