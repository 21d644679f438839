// SPDX-License-Identifier: GPL-3.0-or-later
/// Springs and tethers in the sub-steps of the bodies.
#pragma once

#include "demCoupling/liggghts/liggghtsParts.hpp"

namespace flotsam
{

/// Forces of the restraints join those of contact where the bodies collect these: what they do to a body is tallied, iterated with the fluid and stored
/// as contact is. Their own part is kept beside it.
class Restraints
{
public:
    /// setup: with the movers behind the bodies.
    Restraints(LiggghtsModel& model, const DemSetup& setup);

    /// After set-up; DemError: this sub-step [s] is not for them.
    void begin(const DemSetup& setup, double timeStep);
    /// Adds what pulls in the sub-step [s] that ends here: bodies in their new places, with the velocities of half a sub-step ago.
    void pull(double step);
    /// At an instant, between sub-steps: those that have not pulled yet, though both ends are there, join the bodies' forces.
    void beginNew();
    /// Whether any force may act or change within `duration` [s] while no other than constant loads do. Errs on the safe side only.
    bool mayPull(const std::vector<BodyState>& states, const std::vector<Load>& loads, const std::vector<char>& isHeld, double duration) const;
    /// The force of the instant belongs to another pose of this body.
    void forget(int body);

    void start();
    void startSteps(double step) { add(0.5 * step); }
    void endStep(double step);
    void finishSteps(double step) { add(-0.5 * step); }
    void finish(double duration);
    std::vector<RestraintLoad> loads() const;   ///< of the last advance

    void append(std::vector<double>& data) const;
    /// Returns the position behind what was read; data that ends here is of a run without restraints: they begin.
    size_t read(const std::vector<double>& data, size_t position);
    /// Appends what append() has written of some at the position, as of all: the others have not pulled yet.
    void appendWithNew(const std::vector<double>& data, size_t position, const std::vector<int>& stored, std::vector<double>& all) const;

private:
    struct Line
    {
        Vec3 force = Vec3::Zero();      ///< on the body of `end` [N]
        Vec3 velocity = Vec3::Zero();   ///< of `end` against `other`, half a sub-step ago [m/s]
        double step = notPulled;        ///< that sub-step [s]
        double tension = 0;
        char isBroken = 0;
    };
    struct Sum { Vec3 force = Vec3::Zero(); double tension = 0, largest = 0; };
    struct End { Vec3 place, velocity, arm; };
    static constexpr double notPulled = -1;
    static constexpr size_t lineLength = 9;

    int indexOf(const RestraintEnd& end) const { return end.mover >= 0 ? model_.firstMover + end.mover : end.body; }
    End at(const RestraintEnd& end) const;
    bool isGone(const RestraintEnd& end) const { return indexOf(end) >= 0 && model_.isGone[static_cast<size_t>(indexOf(end))]; }
    void pull(const RestraintDefinition& restraint, Line& line, double step);
    void addTo(const RestraintEnd& end, const Vec3& arm, const Vec3& force);
    void add(double weight);

    LiggghtsModel& model_;
    std::vector<RestraintDefinition> definitions_;
    std::vector<BodyDefinition> bodies_;    ///< with the movers, without what they are made of
    std::vector<Line> lines_;
    std::vector<Sum> sums_, means_;
};

} // namespace flotsam
