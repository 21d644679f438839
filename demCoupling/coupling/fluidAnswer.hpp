// SPDX-License-Identifier: GPL-3.0-or-later
/// What the fluid answers to contact loads on light bodies, given to the engine with them.
///
/// Contact is the fixed point J = G(J) of fluid and engine (contactIteration.hpp). Within a step the fluid is linear: of a change of J the body keeps
/// the share P = M C, C = (M + A)^-1 the mobility of body and added mass A, and the fluid answers (P - 1) times the change. An engine that knows
/// only M contracts by the eigenvalues of 1 - P; where these approach 1 (light bodies, water shut in between body and wall) any J is nearly a fixed point. So the
/// engine gives such a body the load F + J + P (contact - J): where the contact is J the path is the solved one, for any P, and with the fluid's own P the
/// engine finds at once the contact that the fluid agrees with. An engine with P' contracts by 1 - P'^-1 P and diverges where P' is less than half of P, in any
/// direction. P is therefore neither guessed nor one number: each light body that touches something is asked for, the fluid solved with unit loads on it.
#pragma once

#include "demCoupling/core/rigidBody.hpp"
#include "demCoupling/coupling/couplingControls.hpp"

namespace flotsam
{

double radiusOfInertia(const BodyDefinition& body); ///< the largest [m]: turns moments into forces

class FluidAnswer
{
public:
    FluidAnswer(const std::vector<BodyDefinition>& bodies, const CouplingControls& controls);

    /// 1 where the fluid has not been asked.
    const std::vector<LoadShare>& shares() const { return shares_; }
    void setShares(const std::vector<LoadShare>& shares);
    bool isKnown(int body) const { return areKnown_[body]; }
    const std::vector<char>& areKnown() const { return areKnown_; }    ///< per body
    void drop(int body);
    /// What is left of the loads in the columns; orientation: of the body when it was measured. Mobility is symmetric and takes energy: what the solves leave of
    /// errors is taken out, or springs in the engine gained energy from it.
    void set(int body, const LoadShare& measured, const Eigen::Quaterniond& orientation);
    /// Components of load that a body can be asked for: 0 to 2 force, 3 to 5 moment.
    std::vector<int> components(int body) const;

    /// So light that repeats do not converge without a share.
    bool isLight(int body) const;
    /// So light that the fluid is asked where they do not.
    bool mayBeAsked(int body) const { return 2*expected(body) - 1 >= leastRatio; }

    /// Error of a body's contact load over its last change: what contracts by r a time is still off by change/(1 - r). From the liquid the body
    /// displaces: it must be known before there are changes. 1 for bodies that are not light, or whose share is known.
    double doubt(int body) const { return isLight(body) && !isKnown(body) ? expected(body) : 1; }

    std::vector<BodyShare> known() const;   ///< for the engine
    /// Loads for the engine beside those shares: fluid and weight given, contact as the fluid was solved with.
    void findEngineLoads(const std::vector<Load>& given, const std::vector<Load>& contact, std::vector<Load>& loads) const;

private:
    static constexpr double leastRatio = 8; // of (mass + added mass)/mass: below, repeats converge by themselves

    double expected(int body) const;        ///< (mass + displaced liquid)/mass

    std::vector<BodyDefinition> bodies_;
    CouplingControls controls_;
    std::vector<LoadShare> shares_;
    std::vector<char> areKnown_;
};

Vector6 asVector(const Load& load);
Load asLoad(const Vector6& v);

} // namespace flotsam
