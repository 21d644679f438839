// SPDX-License-Identifier: GPL-3.0-or-later
/// Everything the future of the bodies depends on, as plain doubles.
///
/// Exactness rests on three things. The neighbour lists, whose order is the order of all sums, are rebuilt before
/// the first sub-step of every advance, so that they depend on this state alone. Forces are part of the state: computing
/// them anew would use full-step instead of half-step velocities. Springs are keyed by tags.
#include "demCoupling/liggghts/liggghtsState.hpp"

#include "demCoupling/liggghts/liggghtsRestraints.hpp"
#include "demCoupling/liggghts/liggghtsTally.hpp"

#include "fix_multisphere.h"

namespace flotsam
{

namespace
{

constexpr size_t springsPerBody = 40;   // room for some

std::array<double**, 11> vectorsOf(const BodyArrays& b)
{
    return {b.xcm, b.vcm, b.fcm, b.torque, b.drag, b.hdTorque, b.angmom, b.omega, b.ex, b.ey, b.ez};
}

void writeBodies(LiggghtsModel& model, const double* data)
{
    const auto vectors = vectorsOf(model.bodies);
    std::vector<char> isGone;
    for (int b = 0; b < model.bodies.count; ++b)
    {
        for (double** v : vectors)
        {
            std::copy_n(data, 3, v[b]);
            data += 3;
        }
        std::copy_n(data, 4, model.bodies.quat[b]);
        const double* exit = data + 5;
        isGone.push_back(data[4] != 0);
        model.exits[static_cast<size_t>(b)] = {Vec3(exit[0], exit[1], exit[2]), Eigen::Quaterniond(exit[3], exit[4], exit[5], exit[6])};
        data += 12;
    }
    markGone(model, isGone);
}

/// Of all corners.
void readRetreated(LiggghtsModel& model, const double* data)
{
    for (size_t b = 0; b < model.firstCorner.size(); ++b)
        for (int i = model.firstCorner[b]; i < model.firstSphere[b + 1]; ++i)
            model.isRetreated[static_cast<size_t>(i)] = *data++ != 0;
}

} // namespace

void saveState(const LiggghtsModel& model, DemState& state)
{
    std::vector<double>& data = state.data;
    data.reserve(stateHeaderLength + static_cast<size_t>(model.bodies.count) * (stateBodyLength + springsPerBody) + model.walls.size() * stateWallLength);
    data = {stateFormat, static_cast<double>(model.bodies.count), static_cast<double>(model.walls.size()),
            static_cast<double>(model.firstSphere.back())};
    const auto vectors = vectorsOf(model.bodies);
    for (int b = 0; b < model.bodies.count; ++b)
    {
        for (double** v : vectors)
            data.insert(data.end(), v[b], v[b] + 3);
        data.insert(data.end(), model.bodies.quat[b], model.bodies.quat[b] + 4);
        const Pose& exit = model.exits[static_cast<size_t>(b)];
        const Eigen::Quaterniond& q = exit.orientation;
        data.push_back(model.isGone[static_cast<size_t>(b)]);
        data.insert(data.end(), exit.position.data(), exit.position.data() + 3);
        data.insert(data.end(), {q.w(), q.x(), q.y(), q.z()});
    }
    for (const Load& load : model.tally->wallsNow())
    {
        data.insert(data.end(), load.force.data(), load.force.data() + 3);
        data.insert(data.end(), load.moment.data(), load.moment.data() + 3);
    }
    for (size_t b = 0; b < model.firstCorner.size(); ++b)
        data.insert(data.end(), model.isRetreated.begin() + model.firstCorner[b], model.isRetreated.begin() + model.firstSphere[b + 1]);
    appendHistories(model, data);
    model.tally->pairs().append(data);
    model.restraints->append(data);
}

void restoreState(LiggghtsModel& model, const DemState& state)
{
    const std::vector<double>& data = state.data;
    const size_t bodyEnd = stateHeaderLength + static_cast<size_t>(model.bodies.count) * stateBodyLength;
    const size_t wallEnd = bodyEnd + model.walls.size() * stateWallLength;
    size_t cornerEnd = wallEnd;
    for (size_t b = 0; b < model.firstCorner.size(); ++b)
        cornerEnd += static_cast<size_t>(model.firstSphere[b + 1] - model.firstCorner[b]);
    if (data.size() < cornerEnd || (data[0] != stateFormat && data[0] != stateFormatWithoutPairs) || data[1] != model.bodies.count
        || data[2] != static_cast<double>(model.walls.size()) || data[3] != model.firstSphere.back())
        throw DemError("DEM state: it belongs to another case (number of bodies, walls or DEM spheres differs), or was written before boxes had spheres in their corners");

    readRetreated(model, data.data() + wallEnd);
    writeBodies(model, data.data() + stateHeaderLength);
    placeSpheres(model);
    if (!model.near->takeListsAgain())
        rebuildNeighbours(model);
    for (size_t w = 0; w < model.walls.size(); ++w)
    {
        const double* load = data.data() + bodyEnd + w * stateWallLength;
        model.tally->wallsNow()[w] = {Vec3(load[0], load[1], load[2]), Vec3(load[3], load[4], load[5])};
    }
    size_t position = readHistories(model, data, cornerEnd);
    model.tally->pairs().forget();
    if (data[0] == stateFormat)
        position = model.tally->pairs().read(data, position);
    if (model.restraints->read(data, position) != data.size())
        throw DemError("DEM state: more data than this case needs");
}

} // namespace flotsam
