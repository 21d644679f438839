// SPDX-License-Identifier: GPL-3.0-or-later
/// Whether a body that comes in at its release finds its place free. It must come in through the gas: fluid that it takes the place of is not pushed
/// aside, which of gas nothing feels, and of liquid would be lost.
#pragma once

#include "algebra/halo.hpp"
#include "core/simplexMesh.hpp"
#include "demCoupling/core/rigidBody.hpp"

#include <optional>

namespace flotsam
{

/// What is in the way of a body that is to come in.
struct Obstacle
{
    std::string name;       ///< in words; empty: nothing
    bool isLiquid = false;  ///< it may stay for ever; other bodies go on

    bool isThere() const { return !name.empty(); }
};

class EntryCheck
{
public:
    /// References must outlive this.
    EntryCheck(const SimplexMesh& mesh, const Halo& halo, const std::vector<BodyDefinition>& bodies);

    /// At the pose of the definition of `body`. alpha: of all nodes, liquid 1; states: of all bodies,
    /// of which those marked in isAway do not count; structures: those with prescribed motion count, where they are now. Collective; every rank gives the same.
    Obstacle obstacle(int body, const std::vector<double>& alpha, const std::vector<BodyState>& states, const std::vector<char>& isAway,
        const std::vector<Solid>& structures);

private:
    bool touches(int body, int other, const Pose& pose) const;
    bool touches(int body, const Solid& structure) const;
    const std::vector<int>& nodesAt(int body);

    const SimplexMesh& mesh_;
    const Halo& halo_;
    std::vector<BodyDefinition> bodies_;
    std::vector<double> extents_;                        // of their contact spheres, from the centre [m]
    std::vector<std::optional<std::vector<int>>> nodes_; // per body that has asked: of the elements that it would touch
};

} // namespace flotsam
