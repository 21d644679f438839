// SPDX-License-Identifier: GPL-3.0-or-later
/// From materials to the numbers of the contact law: damping for a wanted restitution, contact classes, time step.
/// Nothing here knows LIGGGHTS.
#pragma once

#include "demCoupling/liggghts/liggghtsEngine.hpp"

namespace flotsam
{

/// Restitution of m x'' = -k x - c x', force never attractive, damping ratio beta = c/(2 sqrt(k m)).
double restitutionOf(double dampingRatio);
/// The inverse; restitution in [0.01, 1].
double dampingRatioFor(double restitution);

/// Largest number of spheres that touch one plane at once, over the six principal directions of the body.
int flattestFaceCount(const BodyDefinition& body);

/// What the contact numbers depend on; LIGGGHTS calls it an atom type.
struct ContactClass
{
    bool isWall = false;
    int material = 0;
    double mass = 0;    ///< of the body [kg]; unused for walls
    int faceCount = 1;  ///< spheres that share the law of the body in a flat landing
};

/// Per pair of classes, row-major; numbers per touching sphere.
struct ContactTable
{
    std::vector<ContactClass> classes;
    std::vector<int> classOfBody, classOfWall;
    std::vector<double> stiffness;  ///< [N/m]
    std::vector<double> damping;    ///< [N s/m]
    std::vector<double> friction;   ///< tan(angle)
    int size() const { return static_cast<int>(classes.size()); }
};

ContactTable makeContactTable(const DemSetup& setup);

/// Sub-step [s] for contacts: accurate and stable for every body landing flat, squeezed from several sides.
double contactTimeStep(const DemSetup& setup, const ContactTable& table);

} // namespace flotsam
