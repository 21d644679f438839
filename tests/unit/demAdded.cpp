// SPDX-License-Identifier: GPL-3.0-or-later
/// The state of an engine in one with more bodies and restraints.
#include "unit/demSupport.hpp"

#include <doctest/doctest.h>

using namespace flotsam;
using namespace demTest;

namespace
{

/// A heap whose second bar is tied to a point; above it, in front, within and behind its bars in the list, some more, two tied to each other.
struct Scenes
{
    DemSetup few, more;
    StoredMembers stored{{}, {1, 2, 4, 5, 6, 7}, {1}};

    explicit Scenes(bool hasMeshes) : few(heap(6, hasMeshes))
    {
        few.restraints = {line("tie", {1, -1, Vec3(0.05, 0, 0)}, {-1, -1, few.bodies[1].pose.position + Vec3(0.05, 0, 0.12)})};
        more = few;
        more.bodies.insert(more.bodies.begin(), debris(Vec3(0, -0.05, 0.47)));
        more.bodies.insert(more.bodies.begin() + 3, debris(Vec3(0, 0, 0.47)));
        more.bodies.push_back(debris(Vec3(0, 0.05, 0.47)));
        more.restraints = {line("among", {0, -1, Vec3::Zero()}, {3, -1, Vec3::Zero()}), few.restraints[0]};
        more.restraints[0].length = 0.01;
        more.restraints[1].end.body = 2;
    }

    static RestraintDefinition line(const std::string& name, const RestraintEnd& end, const RestraintEnd& other)
    {
        RestraintDefinition r;
        r.name = name;
        r.end = end;
        r.other = other;
        r.length = 0.1;
        r.stiffness = 50;
        r.damping = 0.1;
        return r;
    }
};

/// They touch nothing.
void holdAdded(LiggghtsEngine& engine, const StoredMembers& stored, int n) { engine.setHeld(areNew(stored.bodies, n)); }

} // namespace

TEST_CASE("bodies of the state go on with the same bits in an engine with more, their contacts, springs and restraints with them")
{
    for (const bool hasMeshes : {false, true})
    {
        CAPTURE(hasMeshes);
        const Scenes scenes(hasMeshes);
        LiggghtsEngine few(scenes.few), more(scenes.more);
        REQUIRE(few.timeStep() == more.timeStep());
        few.setLoads(weights(scenes.few));
        for (int k = 0; k < 400; ++k) few.advance(2e-3);
        REQUIRE(few.hasContact());
        holdAdded(more, scenes.stored, int(scenes.more.bodies.size()));
        more.restore(few.save(), scenes.stored);
        CHECK(more.states()[3].pose.position == scenes.more.bodies[3].pose.position);
        const double all = few.timeStep();
        for (LiggghtsEngine* engine : {&few, &more}) engine->tallyPairs(true);
        few.setLoads(weights(scenes.few));
        more.setLoads(weights(scenes.more));
        for (int k = 0; k < 20; ++k)
            for (LiggghtsEngine* engine : {&few, &more}) engine->advance(2e-3, all);
        REQUIRE(few.contacts().size() > 3);
        REQUIRE(more.contacts().size() == few.contacts().size());
        for (std::size_t k = 0; k < scenes.stored.bodies.size(); ++k)
        {
            const std::size_t b = std::size_t(scenes.stored.bodies[k]);
            CAPTURE(b);
            CHECK(more.states()[b].pose.position == few.states()[k].pose.position);
            CHECK(more.states()[b].pose.orientation.coeffs() == few.states()[k].pose.orientation.coeffs());
            CHECK(more.states()[b].angularMomentum == few.states()[k].angularMomentum);
            CHECK(more.meanContactLoads()[b].force == few.meanContactLoads()[k].force);
        }
        for (std::size_t w = 0; w < scenes.few.walls.size(); ++w) CHECK(more.meanWallLoads()[w].force == few.meanWallLoads()[w].force);
        REQUIRE(few.restraintLoads()[0].tension > 0);
        CHECK(more.restraintLoads()[1].tension == few.restraintLoads()[0].tension);
        CHECK(more.restraintLoads()[0].tension > 0);
        REQUIRE(more.meanContacts().size() == few.meanContacts().size());
        for (std::size_t k = 0; k < few.meanContacts().size(); ++k)
        {
            CHECK(more.meanContacts()[k].body == scenes.stored.bodies[std::size_t(few.meanContacts()[k].body)]);
            CHECK(more.meanContacts()[k].force == few.meanContacts()[k].force);
        }
    }
}

TEST_CASE("a state of another number of bodies than those named is refused, and so is one of other restraints")
{
    const Scenes scenes(true);
    LiggghtsEngine few(scenes.few), more(scenes.more);
    CHECK_THROWS_AS(more.restore(few.save(), {{}, {1, 2, 4}, {1}}), DemError);
    CHECK_THROWS_AS(more.restore(few.save(), {{}, {1, 2, 4, 5, 6, 7}, {}}), DemError);
    more.restore(few.save(), scenes.stored);
}
