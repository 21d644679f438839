// SPDX-License-Identifier: GPL-3.0-or-later
/// A run that goes on with more bodies than its state has: what the state stores by numbers of bodies, spheres and restraints gets those of the run.
#include "demCoupling/liggghts/liggghtsPairs.hpp"
#include "demCoupling/liggghts/liggghtsRestraints.hpp"
#include "demCoupling/liggghts/liggghtsState.hpp"

namespace flotsam
{

namespace
{

/// Numbers in LIGGGHTS of the bodies that the state has; the movers are behind them.
std::vector<int> storedBodies(const LiggghtsModel& model, const StoredMembers& stored)
{
    std::vector<int> numbers = stored.bodies;
    for (int b = model.firstMover; b < model.bodies.count; ++b)
        numbers.push_back(b);
    return numbers;
}

/// Tag of a sphere in the run by that in the state; both count from 1.
std::vector<int> tagsOf(const LiggghtsModel& model, const std::vector<int>& bodies)
{
    std::vector<int> tags{0};
    for (const int b : bodies)
        for (int s = model.firstSphere[static_cast<size_t>(b)]; s < model.firstSphere[static_cast<size_t>(b) + 1]; ++s)
            tags.push_back(s + 1);
    return tags;
}

size_t cornersOf(const LiggghtsModel& model, int body)
{
    const size_t b = static_cast<size_t>(body);
    return static_cast<size_t>(model.firstSphere[b + 1] - model.firstCorner[b]);
}

/// What touched a body where it was put in is no force of this instant.
void leaveOutContact(double* body)
{
    constexpr int total = 6, given = 12, length = 6; // force and torque
    std::copy_n(body + given, length, body + total);
}

/// Whether they have retreated, of all bodies. position: in the state's data, then behind what was read.
void appendCorners(const LiggghtsModel& model, const std::vector<char>& isNew, const std::vector<double>& now, const std::vector<double>& data, size_t& position, std::vector<double>& all)
{
    size_t atNow = stateHeaderLength + isNew.size() * stateBodyLength + model.walls.size() * stateWallLength;
    for (size_t b = 0; b < isNew.size(); ++b)
    {
        const size_t n = cornersOf(model, static_cast<int>(b));
        const double* first = isNew[b] ? now.data() + atNow : data.data() + position;
        all.insert(all.end(), first, first + n);
        atNow += n;
        position += isNew[b] ? 0 : n;
    }
}

void checkStored(const LiggghtsModel& model, const std::vector<double>& data, size_t nBodies, size_t nSpheres, size_t least)
{
    if (data.size() < least || (data[0] != stateFormat && data[0] != stateFormatWithoutPairs) || data[1] != static_cast<double>(nBodies)
        || data[2] != static_cast<double>(model.walls.size()) || data[3] != static_cast<double>(nSpheres))
        throw DemError("DEM state: it belongs to another case (number of bodies, walls or DEM spheres differs)");
}

} // namespace

DemState withAdded(const LiggghtsModel& model, const DemState& state, const StoredMembers& stored)
{
    const std::vector<int> bodies = storedBodies(model, stored), tags = tagsOf(model, bodies);
    DemState present;
    saveState(model, present);
    const std::vector<double> &data = state.data, &now = present.data;
    size_t nCorners = 0;
    for (const int b : bodies)
        nCorners += cornersOf(model, b);
    const size_t nAll = static_cast<size_t>(model.bodies.count), bodyEnd = stateHeaderLength + bodies.size() * stateBodyLength,
                 wallEnd = bodyEnd + model.walls.size() * stateWallLength;
    checkStored(model, data, bodies.size(), tags.size() - 1, wallEnd + nCorners);

    std::vector<double> all(now.begin(), now.begin() + static_cast<std::ptrdiff_t>(stateHeaderLength + nAll * stateBodyLength));
    all[0] = data[0];
    for (size_t b = 0; b < nAll; ++b)
        leaveOutContact(&all[stateHeaderLength + b * stateBodyLength]);
    for (size_t k = 0; k < bodies.size(); ++k)
        std::copy_n(&data[stateHeaderLength + k * stateBodyLength], stateBodyLength, &all[stateHeaderLength + static_cast<size_t>(bodies[k]) * stateBodyLength]);
    all.insert(all.end(), data.begin() + static_cast<std::ptrdiff_t>(bodyEnd), data.begin() + static_cast<std::ptrdiff_t>(wallEnd));

    size_t position = wallEnd;
    appendCorners(model, areNew(bodies, model.bodies.count), now, data, position, all);
    position = renumberHistories(model, data, position, tags, all);
    if (data[0] == stateFormat)
        position = PairTally::renumber(data, position, bodies, all);
    model.restraints->appendWithNew(data, position, stored.restraints, all);
    return {all};
}

} // namespace flotsam
