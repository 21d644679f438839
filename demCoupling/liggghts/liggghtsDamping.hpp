// SPDX-License-Identifier: GPL-3.0-or-later
/// How much of their dashpots contacts keep, by how strongly they damp a body together.
#pragma once

#include "demCoupling/liggghts/liggghtsFacets.hpp"

namespace flotsam
{

/// A dashpot that sees the velocity of half a sub-step ago takes z = (rate of damping x sub-step) of it: more than there is when many spheres of
/// a body touch at once. Such contacts keep 1/z of their damping, z that of all contacts of the body with the same partner, times the number
/// of partners that damp it as strongly. The many contacts of a bar with the floor thus leave its damping against a bar that lies across it.
/// The share is an atom type of the spheres (DampingLevel in contactLaw.hpp), so that LIGGGHTS' limits of normal and friction force hold for
/// the damped force.
class SphereDamping
{
public:
    SphereDamping(LiggghtsModel& model, const DemSetup& setup);

    /// Before sub-steps of equal length [s].
    void startSteps(double step);
    void finishSteps() { step_ = 0; }
    /// Before the forces of a sub-step; `nearPlane`: per wall, spheres that can touch the plane.
    void beforeForces(const std::vector<std::vector<int>>& nearPlane);

private:
    /// M^-1/2 (damping matrix) M^-1/2 of a body in contact with one partner, which moves as well [1/s].
    using Rates = Eigen::Matrix<double, 6, 6>;
    struct Partner
    {
        int other;      ///< body, or -1 - wall, or -1 - mesh - number of walls
        Rates rates;
        double z;
    };
    using Row = Eigen::Matrix<double, 6, 1>;
    /// One body of a contact; its square is the contact's part of the partner's rates.
    struct Side { int body, partner; Row row; };
    struct Near { int sphere, other; Side side, otherSide; }; ///< other: sphere, or -1; then no other body either
    static constexpr int stepsBetweenLooks = 10;

    void readBodies();
    int partnerOf(int body, int other);
    void addPairs();
    void addPlane(size_t wall, const std::vector<int>& spheres);
    void addMeshes();
    void addWallContact(int sphere, int wallClass, int wall, const Vec3& point);
    Row inverseRoot(int body, const Vec3& arm, const Vec3& normal) const;
    double sharedMobility(int body, const LoadShare& share, const Vec3& normal, const Vec3& turn) const;
    int bodyOf(int sphere) const;
    double damping(int sphere, int otherClass) const;
    Partner& partner(const Side& side);
    void addRates();
    void setLevels();

    LiggghtsModel& model_;
    FacetChoice facets_;
    std::vector<double> margins_;   ///< how far the spheres of each body move until the next look [m]
    std::vector<std::vector<Partner>> partners_; ///< of each body
    std::vector<Near> near_;
    std::vector<double> traces_;    ///< of each body's rates times the sub-step
    std::vector<int> levels_;       ///< of each sphere
    double step_ = 0;               ///< [s], 0 between calls
    int stepsToLook_ = 0;
};

} // namespace flotsam
