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

/// The same of its corners.
int cornersOfFace(const BodyDefinition& body);

/// Stiffness of a corner over that of another sphere of the body: it bears as much before its centre reaches the wall. 1 without corners.
double cornerStiffening(const BodyDefinition& body);

/// What the contact numbers depend on; LIGGGHTS calls it an atom type.
struct ContactClass
{
    bool isWall = false;
    int material = 0;
    double mass = 0;    ///< of the body [kg]; unused for walls
    int faceCount = 1;  ///< spheres that share the law of the body in a flat landing, corners not counted
    double stiffening = 1;  ///< of corners: of their stiffness over that of the body's other spheres
    double cornerWeight = 0;    ///< sum of the stiffening of the corners that land with the flattest face
    bool isMirror = false;      ///< of walls

    bool isCorner() const { return stiffening != 1; }
};

/// Share of their damping that contacts keep which would take z times a velocity in a sub-step (SphereDamping): 1/z where z exceeds 1, in
/// steps of a factor 2^(-1/4).
struct DampingLevel
{
    static int of(double z);
    static double share(int level);
};

/// Per pair of classes, row-major; numbers per touching sphere.
struct ContactTable
{
    std::vector<ContactClass> classes;
    std::vector<int> classOfBody, classOfCorners, classOfWall; ///< without corners those of the body
    std::vector<double> stiffness;  ///< [N/m]
    std::vector<double> damping;    ///< [N s/m]
    std::vector<double> friction;   ///< tan(angle)
    int levels = 1;                 ///< of damping, see DampingLevel
    int size() const { return static_cast<int>(classes.size()); }

    /// LIGGGHTS' atom types: every class at every level.
    int typeCount() const { return size() * levels; }
    int typeOf(int contactClass, int level) const { return level * size() + contactClass + 1; }
    /// Entry of a table of the classes.
    size_t entryOf(int typeA, int typeB) const { return static_cast<size_t>((typeA - 1) % size() * size() + (typeB - 1) % size()); }
    double dampingOf(int typeA, int typeB) const;
};

ContactTable makeContactTable(const DemSetup& setup);

/// Sub-step [s] for contacts and restraints: accurate where the restitution shall hold, stable for every body landing flat, squeezed from several sides.
double contactTimeStep(const DemSetup& setup, const ContactTable& table);
/// Makes up for dashpots that see the velocity of half a sub-step [s] ago: (m - c dt/2) x'' = -k x - c x' is what is integrated, its restitution
/// too small by the order of c dt/m. Afterwards it is the wanted one to second order, as a mean over the instants of landing within a sub-step.
void compensateLag(const DemSetup& setup, double step, ContactTable& table);
/// Levels of damping that such landings need at this sub-step [s].
int dampingLevels(const DemSetup& setup, const ContactTable& table, double step);

} // namespace flotsam
