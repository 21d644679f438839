// SPDX-License-Identifier: GPL-3.0-or-later
/// Inertia of the fluid that moves with light bodies, given to the engine with them.
///
/// Contact is the fixed point J = G(J) of fluid and engine (contactIteration.hpp); its contraction is r = (added mass)/(mass + added mass).
/// Where r approaches 1 (light bodies, water shut in between body and wall) any J is nearly a fixed point: a load that presses the body into
/// the wall is answered by the wall. So the engine is then given the body with s times its mass and the load s (F + J) - J, which is the fluid's
/// answer for an added mass of (s - 1) m: without a change of J the path is the solved one, with s between (m + added mass)/(2 m) and twice
/// that the contraction is a half at most. r is seen from what the fluid answers to a change of J, of force and moment apart: a disc takes much
/// water along but turns in it freely, and a factor far too large diverges.
#pragma once

#include "demCoupling/core/rigidBody.hpp"
#include "demCoupling/coupling/couplingControls.hpp"

#include <array>

namespace flotsam
{

double radiusOfInertia(const BodyDefinition& body); ///< the largest [m]: turns moments into forces

class AddedInertia
{
public:
    AddedInertia(const std::vector<BodyDefinition>& bodies, const CouplingControls& controls);

    const std::vector<InertiaFactor>& factors() const { return factors_; } ///< s of each body
    void setFactors(const std::vector<InertiaFactor>& factors) { factors_ = factors; }
    void drop(int body) { factors_[body] = InertiaFactor(); }

    /// So light that a factor is due from the start.
    bool isLight(int body) const;
    /// So light that raise() may give it one.
    bool mayNeedFactor(int body) const { return largestFactor(body) >= leastFactor; }

    /// Error of a body's contact load over its last change: what contracts by r a time is still off by change/(1 - r). From the liquid the body
    /// displaces, over its factors: it must be known before there are changes. 1 for bodies that need no factor.
    InertiaFactor doubt(int body) const;

    /// From the answer of the fluid's loads to a change of the contact loads. True when a factor was raised: G is another.
    bool raise(const std::vector<Load>& contactChange, const std::vector<Load>& fluidChange);

    /// Loads for bodies of s times the mass: fluid and weight given, contact as the fluid was solved with.
    std::vector<Load> engineLoads(const std::vector<Load>& loads, const std::vector<Load>& contact) const;

private:
    static constexpr double leastFactor = 8;    // below, repeats converge by themselves, and in a jam the factors of neighbours disturb each other

    double expected(int body) const;        ///< (mass + displaced liquid)/mass
    double largestFactor(int body) const;   ///< the same, with twice the liquid
    std::array<double, 2> pull(int body, const Load& change) const;

    std::vector<BodyDefinition> bodies_;
    CouplingControls controls_;
    std::vector<InertiaFactor> factors_;
};

} // namespace flotsam
