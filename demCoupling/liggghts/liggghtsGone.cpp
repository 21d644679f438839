// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies that take part in nothing, any more or yet, and movers, which touch nothing but the bodies. LIGGGHTS cannot delete one without renumbering the others: their spheres stay, in a group whose
/// pairs are never listed, and outside of the group that the walls look at. They are spread over the box: where all lie at the place they left at,
/// looking through the bins would cost the square of their number.
#include "demCoupling/liggghts/liggghtsHistory.hpp"
#include "demCoupling/liggghts/liggghtsRestraints.hpp"
#include "demCoupling/liggghts/liggghtsTally.hpp"

#include "atom.h"
#include "group.h"
#include "lammps.h"

namespace flotsam
{

namespace
{

// Two groups for spheres that no pair is listed of, and for those (all) that it would be with: LIGGGHTS asks every exclusion of every pair of spheres in neighbouring bins, which is most of what its lists cost.
const char *const singleGroup = "single", *const anyGroup = "any", *const moverGroup = "movers";
constexpr int everything = 1; // bit of LIGGGHTS' group "all"

/// Numbers of a Halton sequence, 0..1: evenly spread, however many are taken.
double halton(int index, int base)
{
    double value = 0, share = 1;
    for (; index > 0; index /= base)
    {
        share /= base;
        value += share * (index % base);
    }
    return value;
}

Vec3 parkingPlace(const std::array<Vec3, 2>& box, int body)
{
    const Vec3 share(halton(body + 1, 2), halton(body + 1, 3), halton(body + 1, 5));
    return box[0] + share.cwiseProduct(box[1] - box[0]);
}

void park(LiggghtsModel& model, int body)
{
    const double* q = model.bodies.quat[body];
    Pose& exit = model.exits[static_cast<size_t>(body)];
    exit = {Vec3::Map(model.bodies.xcm[body]), Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
    setPose(model, body, {parkingPlace(model.parking, body), exit.orientation});
    for (int i = model.firstSphere[static_cast<size_t>(body)]; i < model.firstSphere[static_cast<size_t>(body) + 1]; ++i)
    {
        forgetWallContacts(model, i);
        model.isRetreated[static_cast<size_t>(i)] = 0;
    }
}

} // namespace

std::vector<BodyDefinition> placedAtStart(const DemSetup& setup)
{
    std::vector<BodyDefinition> bodies = setup.bodies;
    for (size_t b = 0; b < bodies.size(); ++b)
    {
        if (!bodies[b].entersAtRelease)
            continue;
        bodies[b].pose.position = parkingPlace(setup.box, static_cast<int>(b));
        bodies[b].motion = Motion();
    }
    return bodies;
}

void excludePairs(LiggghtsModel& model)
{
    for (const std::string name : {singleGroup, anyGroup, moverGroup}) model.instance.command("group " + name + " id 0"); // of no sphere: they count from 1
    const auto exclude = [&](const std::string& a, const std::string& b) { model.instance.command("neigh_modify exclude group " + a + " " + b); };
    exclude(singleGroup, anyGroup);
    exclude(moverGroup, moverGroup);
}

void setGone(LiggghtsModel& model, const std::vector<char>& isGone)
{
    const BodyArrays& bodies = model.bodies;
    for (size_t b = 0; b < isGone.size(); ++b)
    {
        if (isGone[b] == model.isGone[b])
            continue;
        const int body = static_cast<int>(b);
        if (isGone[b])
            park(model, body);
        else
            setPose(model, body, model.exits[b]);
        setMotion(model, body, Motion());
        std::copy_n(bodies.drag[b], 3, bodies.fcm[b]);
        std::copy_n(bodies.hdTorque[b], 3, bodies.torque[b]);
    }
    markGone(model, isGone);
    model.tally->pairs().leaveWalls(isGone, model.tally->wallsNow());
    placeSpheres(model);
    rebuildNeighbours(model); // without the pairs of those that are gone
    model.restraints->beginNew();
}

void markGone(LiggghtsModel& model, const std::vector<char>& isGone)
{
    const LAMMPS_NS::LAMMPS& dem = model.instance.lammps();
    const auto bitOf = [&](const char* name) { return dem.group->bitmask[dem.group->find(name)]; };
    const int any = bitOf(anyGroup), mover = any | bitOf(moverGroup), single = any | bitOf(singleGroup);
    for (size_t b = 0; b < isGone.size(); ++b)
    {
        const int body = isGone[b] ? single : static_cast<int>(b) < model.firstMover ? any | everything : mover;
        std::fill(dem.atom->mask + model.firstSphere[b], dem.atom->mask + model.firstCorner[b], body);
        for (int i = model.firstCorner[b]; i < model.firstSphere[b + 1]; ++i)
            dem.atom->mask[i] = isGone[b] || model.isRetreated[static_cast<size_t>(i)] ? single : single | everything;
    }
    model.isGone = isGone;
}

} // namespace flotsam
