// SPDX-License-Identifier: GPL-3.0-or-later
/// How stiff a body is on the springs of its contact spheres: what bounds the sub-step.
#pragma once

#include "demCoupling/liggghts/contactLaw.hpp"

namespace flotsam
{

/// Stiffest modes of the body on one sphere, one corner, and landing flat on any of its faces: springs act in all directions, dashpots only
/// along the normal.
struct ContactModes { double sphere = 0, corner = 0, face = 0, faceNormal = 0, faceDashpots = 0; };

/// Of a body touching what is no wall, and walls by either way of sharing the law.
class ModesOfBody
{
public:
    explicit ModesOfBody(const BodyDefinition& body);
    const ContactModes& of(const ContactClass& other, const ContactLaw& law) const
    {
        if (!other.isWall)
            return other_;
        return law.perBody && law.flatRestitution ? flatWall_ : wall_;
    }

private:
    ContactModes other_, wall_, flatWall_;
};

} // namespace flotsam
