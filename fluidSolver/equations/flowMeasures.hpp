// SPDX-License-Identifier: GPL-3.0-or-later
/// Figures of a flow state that steer a run or are reported. All collective; cover may be null: no solids.
#pragma once

#include "core/flowState.hpp"
#include "core/simplexMesh.hpp"
#include "algebra/halo.hpp"
#include "geometry/cover.hpp"

#include <string>
#include <vector>

namespace flotsam
{

constexpr double gasOnly = 0.01;    ///< largest alpha of gas without liquid that matters

/// |u|/h over the active elements, u: mean over the fluid part [1/s]. (Nodes inside solids that only slivers of fluid determine may have many times the velocity of these.)
struct CourantRates
{
    double mean = 0;    ///< over the fluid's volume
    /// Elements with little liquid count by twice their largest alpha, at least a quarter: the implicit scheme is stable, and gas and
    /// spray are not what is asked for.
    double largest = 0;
};
CourantRates courantRates(const SimplexMesh& mesh, const Halo& halo, const Cover* cover, const FlowState& state);

/// Largest way of a node with liquid in the last time step, in widths (one per node [m]).
double longestWay(const SimplexMesh& mesh, const Halo& halo, const std::vector<double>& width, const FlowState& state);

/// The fastest place, for messages: "|u| = 12 m/s at (0.1 0.2 0), alpha 0.01, 0.002 m from 'gate'". cover: null without solids, else of the solids; they are named where they
/// are near. Collective.
std::string describeFastest(const SimplexMesh& mesh, const Halo& halo, const FlowState& state, const Cover* cover, const std::vector<Solid>* solids);

/// int alpha over the fluid part [m^3], of a 2D mesh by its thickness.
double liquidVolume(const SimplexMesh& mesh, const Halo& halo, const Cover* cover, const std::vector<double>& alpha);

/// Liquid share of every solid's surface, 0..1; one value per solid.
void findWetFractions(const SimplexMesh& mesh, const Halo& halo, const Cover* cover, std::size_t nSolids,
    const std::vector<double>& alpha, std::vector<double>& result);

} // namespace flotsam
