// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies that have left the mesh for good: no part of them lies in an element, nor above one, from where it would fall back.
#pragma once

#include "algebra/halo.hpp"
#include "core/simplexMesh.hpp"
#include "demCoupling/core/rigidBody.hpp"

namespace flotsam
{

class MeshExit
{
public:
    /// gravity: what is above; zero: nothing. References must outlive this.
    MeshExit(const SimplexMesh& mesh, const Halo& halo, const std::vector<BodyDefinition>& bodies, const Vec3& gravity);

    /// Of the bodies marked in mayBe (on every rank alike) those that are outside. Collective when one is marked.
    std::vector<char> findOutside(const std::vector<BodyState>& states, const std::vector<char>& mayBe) const;

private:
    bool isNearElement(std::size_t body, const BodyState& state) const;

    const SimplexMesh& mesh_;
    const Halo& halo_;
    std::vector<BodyDefinition> bodies_;
    std::vector<double> extents_;   // of the bodies about their centres [m]
    int up_ = -1;                   // in-plane axis that gravity acts along most, -1: none
    double upSign_ = 1;
};

} // namespace flotsam
