// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/contactSummary.hpp"
#include "demCoupling/coupling/couplingRecord.hpp"

#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

/// Two bodies, a wall and a structure that moves.
DemSetup makeSetup()
{
    DemSetup setup;
    setup.bodies.resize(2);
    setup.bodies[0].name = "log";
    setup.bodies[1].name = "box";
    setup.walls.resize(1);
    setup.walls[0].name = "bed";
    setup.movers.resize(1);
    setup.movers[0].name = "gate";
    return setup;
}

constexpr int bed = -1, gate = -2;

Contact makeContact(int body, int other, double force, double overlap) { return {body, other, Vec3::Zero(), Vec3(0, 0, force), overlap}; }

/// 0, 1, 2, ... wherever the record has a number.
CouplingRecord makeRecord()
{
    CouplingRecord record;
    for (auto* loads : {&record.lastLoads, &record.contact, &record.guess}) loads->resize(2);
    record.wallLoads.resize(3);
    record.lastChanges.resize(2);
    record.shares.resize(2);
    record.smooth.resize(26);
    record.isHeld.resize(2);
    record.presence.resize(2);
    record.counts.resize(2);
    record.wallCounts.resize(3);
    return record;
}

} // namespace

TEST_CASE("what is written of a record is what is read, in the files' order")
{
    std::vector<double> numbers(6*(3 + 4*2) + 2*36 + 26 + 2 + 2 + 2 + 3 + 1);
    for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = 1 + double(k % 100); // flags are characters
    CouplingRecord record = makeRecord();
    NumberReader reader(numbers.data());
    passRecord(reader, record);
    CHECK(numbersOf(record) == numbers);
    CHECK(record.wallLoads[1].moment[0] == 10);
    CHECK(record.lastLoads[0].force[0] == 19);
    CHECK(record.lastChanges[1].angularVelocity[2] == 42);
    CHECK(record.shares[0](1, 0) == 68);
    CHECK(record.largestOverlap == numbers.back());
}

TEST_CASE("a body's state is the same after writing and reading, to the last bit")
{
    BodyState state, read;
    state.pose.position = Vec3(0.1, 0.2, 0.3);
    state.pose.orientation = Eigen::Quaterniond(0.5, -0.5, 0.1, 0.7);
    state.motion = {Vec3(1, 2, 3), Vec3(4, 5, 6)};
    state.angularMomentum = Vec3(7, 8, 9);
    NumberWriter writer;
    pass(writer, state);
    REQUIRE(writer.numbers().size() == 16);
    NumberReader reader(writer.numbers().data());
    pass(reader, read);
    CHECK(read.pose.position == state.pose.position);
    CHECK(read.pose.orientation.coeffs() == state.pose.orientation.coeffs());
    CHECK(read.motion.velocity == state.motion.velocity);
    CHECK(read.motion.angularVelocity == state.motion.angularVelocity);
    CHECK(read.angularMomentum == state.angularMomentum);
}

TEST_CASE("contacts are counted at both sides, and the deepest is named")
{
    const DemSetup setup = makeSetup();
    ContactSummary summary(setup);
    CHECK(summary.deepestPair(setup).empty());
    summary.take({makeContact(0, bed, 5, 1e-4), makeContact(0, 1, 5, 3e-4), makeContact(1, bed, 5, 2e-4)}, setup);
    CHECK(summary.counts == std::vector<int>{2, 2});
    CHECK(summary.wallCounts == std::vector<int>{2, 0});
    CHECK(summary.largestOverlap == 3e-4);
    CHECK(summary.deepestPair(setup) == "body log and body box");
    summary.take({makeContact(1, gate, 5, 1e-4)}, setup);
    CHECK(summary.counts == std::vector<int>{0, 1});
    CHECK(summary.deepestPair(setup) == "body box and structure gate");
}

TEST_CASE("a gate clamps a body that touches something else, with half of the deepest contact's force at least")
{
    const DemSetup setup = makeSetup();
    ContactSummary summary(setup);
    const auto pressing = [&](std::vector<Contact> contacts)
    {
        summary.take(contacts, setup);
        return summary.pressingMover(setup);
    };
    CHECK(pressing({makeContact(0, gate, 60, 1e-4), makeContact(0, bed, 100, 2e-4)}) == "gate");
    CHECK(pressing({makeContact(0, gate, 40, 1e-4), makeContact(0, bed, 100, 2e-4)}).empty());
    CHECK(pressing({makeContact(0, gate, 60, 1e-4), makeContact(1, bed, 100, 2e-4)}).empty());
}
