// SPDX-License-Identifier: GPL-3.0-or-later
/// Who pushes whom, and how much: the force of every pair of bodies, and of body and wall, added up over an advance.
#pragma once

#include "demCoupling/core/meanContact.hpp"
#include "demCoupling/liggghts/liggghtsParts.hpp"

#include <map>

namespace flotsam
{

/// LIGGGHTS keeps the sum of all forces on a sphere. Of pairs of spheres the law is evaluated once more, with the places, velocities and springs the forces were
/// computed with, so that the sum over a body's contacts is the force it felt to round-off. Walls have their forces by spheres. It costs about as much as the forces: only advances
/// that someone looks at are added up; of others the last sub-step alone is kept, half of which is the next advance's.
class PairTally
{
public:
    explicit PairTally(LiggghtsModel& model) : model_(model) {}

    /// Of the coming advances.
    void setOn(bool isOn) { isOn_ = isOn; }
    /// Whether the present sub-step is one to look at.
    bool isDue() const;
    /// After the forces of a sub-step, before its velocities change.
    void readPairs();
    /// The rest of the same sub-step. nearPlane: per wall, spheres that can touch the plane.
    void readWalls(const std::vector<std::vector<int>>& nearPlane);

    void start() { sums_.clear(); }
    void add(double weight);
    void finish(double duration);
    /// Over the last advance, if it was looked at. Movers are bodies here.
    const std::vector<MeanContact>& means() const { return means_; }

    void append(std::vector<double>& data) const;
    /// Returns the position behind what was read.
    size_t read(const std::vector<double>& data, size_t position);
    void forget() { now_.clear(); }
    /// Appends what append() has written at the position, with other numbers of the bodies (bodies[old]), and returns the position behind it.
    static size_t renumber(const std::vector<double>& data, size_t position, const std::vector<int>& bodies, std::vector<double>& renumbered);
    /// Bodies that are gone touch no wall any more; takes their part of the walls' loads at this instant. What they did to other bodies is in these' forces until the next sub-step.
    void leaveWalls(const std::vector<char>& isGone, std::vector<Load>& wallsNow);

private:
    /// Forces on the first of two, added up.
    struct Sum
    {
        Vec3 force = Vec3::Zero(), weightedPoint = Vec3::Zero();
        double weight = 0, overlap = 0;
        int spheres = 0;
        void add(const Vec3& f, const Vec3& point, double depth);
        void add(double times, const Sum& other);
    };
    using Sums = std::map<std::pair<int, int>, Sum>;    ///< body, and body of a larger number or -1 - wall
    static constexpr size_t entryLength = 11;

    static size_t countAt(const std::vector<double>& data, size_t position);
    int bodyOf(int sphere) const;
    void addPair(int i, int j, const double* spring);
    void readPlane(size_t wall, const std::vector<int>& spheres);
    void readMeshes(int sphere);
    void findTouches(int sphere);

    LiggghtsModel& model_;
    bool isOn_ = false;
    Sums now_, sums_;
    std::vector<MeanContact> means_;
    std::vector<MeshTouch> touches_;
};

} // namespace flotsam
