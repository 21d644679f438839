// SPDX-License-Identifier: GPL-3.0-or-later
#include "unit/demSupport.hpp"

#include <doctest/doctest.h>

#include <mpi.h>

#include <algorithm>

using namespace flotsam;
using namespace demTest;

namespace
{

std::vector<double> numbersOf(const LiggghtsEngine& engine)
{
    std::vector<double> numbers;
    const auto add = [&](const auto& v) { numbers.insert(numbers.end(), v.data(), v.data() + v.size()); };
    for (const BodyState& s : engine.states())
    {
        add(s.pose.position);
        add(s.pose.orientation.coeffs());
        add(s.motion.velocity);
        add(s.angularMomentum);
    }
    for (const auto& loads : {engine.meanContactLoads(), engine.meanWallLoads()})
        for (const Load& load : loads)
        {
            add(load.force);
            add(load.moment);
        }
    return numbers;
}

void advance(LiggghtsEngine& engine, int times, double duration)
{
    for (int i = 0; i < times; ++i)
        engine.advance(duration);
}

} // namespace

TEST_CASE("restore continues to the same bits, in this engine and in a new one")
{
    for (const bool hasMeshes : {false, true})
    {
        CAPTURE(hasMeshes);
        const DemSetup setup = heap(6, hasMeshes);
        LiggghtsEngine engine(setup);
        engine.setLoads(weights(setup));
        advance(engine, 100, 2e-3);
        REQUIRE(engine.hasContact());

        const DemState state = engine.save();
        advance(engine, 50, 2e-3); // some 10^4 sub-steps
        const auto first = numbersOf(engine);

        engine.restore(state);
        CHECK(engine.save().data == state.data);
        advance(engine, 50, 2e-3);
        CHECK(numbersOf(engine) == first);

        LiggghtsEngine other(setup);
        other.restore(state);
        other.setLoads(weights(setup));
        advance(other, 50, 2e-3);
        CHECK(numbersOf(other) == first);
    }
}

TEST_CASE("restore goes back to the same bits from where nothing is near any more")
{
    DemSetup setup = scene({ball(0.01, 0.05, Vec3::Zero()), ball(0.01, 0.05, Vec3(0.021, 0, 0))}, {plane(Vec3(0, 0, -0.02), Vec3::UnitZ())});
    setup.bodies[1].motion.velocity = Vec3(-1, 0.1, 0);
    LiggghtsEngine engine(setup);
    engine.setLoads({Load(), Load()});
    for (int i = 0; i < 100 && !engine.hasContact(); ++i)
        engine.advance(2e-4);
    REQUIRE(engine.hasContact());
    const DemState state = engine.save();
    advance(engine, 100, 5e-3); // half a metre apart
    const auto first = numbersOf(engine);
    engine.restore(state);
    CHECK(engine.save().data == state.data);
    advance(engine, 100, 5e-3);
    CHECK(numbersOf(engine) == first);
}

TEST_CASE("a predictor step leaves no trace")
{
    const DemSetup setup = heap(6, true);
    LiggghtsEngine plain(setup), repeated(setup);
    std::vector<Load> wild = weights(setup);
    for (Load& load : wild)
        load = {Vec3(0.5, -0.3, 1.0), Vec3(1e-3, 0, 2e-3)};
    for (int i = 0; i < 60; ++i)
    {
        plain.setLoads(weights(setup));
        plain.advance(1e-3);
        const DemState state = repeated.save();
        repeated.setLoads(wild);
        repeated.advance(i % 10 == 0 ? 2e-2 : 1e-3);
        repeated.restore(state);
        repeated.setLoads(weights(setup));
        repeated.advance(1e-3);
    }
    CHECK(numbersOf(plain) == numbersOf(repeated));
}

TEST_CASE("saving does not disturb")
{
    const DemSetup setup = heap(5, false);
    LiggghtsEngine plain(setup), saved(setup);
    for (LiggghtsEngine* engine : {&plain, &saved})
        engine->setLoads(weights(setup));
    for (int i = 0; i < 100; ++i)
    {
        plain.advance(1e-3);
        saved.advance(1e-3);
        (void)saved.save();
    }
    CHECK(numbersOf(plain) == numbersOf(saved));
}

TEST_CASE("a state of another case is refused")
{
    LiggghtsEngine two(heap(2, false)), three(heap(3, false));
    CHECK_THROWS_AS(two.restore(three.save()), DemError);
    DemState cut = two.save();
    cut.data.pop_back();
    CHECK_THROWS_AS(two.restore(cut), DemError);
}

TEST_CASE("every rank gets the same bits")
{
    const DemSetup setup = heap(4, false);
    LiggghtsEngine engine(setup);
    engine.setLoads(weights(setup));
    advance(engine, 100, 1e-3);
    auto mine = numbersOf(engine), first = mine;
    MPI_Bcast(first.data(), static_cast<int>(first.size()), MPI_DOUBLE, 0, MPI_COMM_WORLD);
    CHECK(mine == first);
}

TEST_CASE("bodies that are gone touch nothing; the others go on, to the same bits from a stored state as well")
{
    for (const bool hasMeshes : {false, true})
    {
        CAPTURE(hasMeshes);
        const DemSetup setup = heap(6, hasMeshes);
        std::vector<char> gone(6, 0);
        LiggghtsEngine engine(setup);
        engine.setLoads(weights(setup));
        advance(engine, 100, 2e-3);
        const auto touches = [&](int body) // in the present contacts
        {
            for (const Contact& c : engine.contacts())
                if (c.body == body || c.other == body)
                    return true;
            return false;
        };
        int lowest = 0;
        while (lowest < 6 && !touches(lowest))
            ++lowest;
        REQUIRE(lowest < 6);
        gone[static_cast<size_t>(lowest)] = 1;
        const Vec3 place = engine.states()[static_cast<size_t>(lowest)].pose.position;
        engine.setHeld(gone);
        engine.setGone(gone);
        CHECK(!touches(lowest));
        const DemState state = engine.save();
        advance(engine, 100, 2e-3);
        CHECK(!touches(lowest));
        CHECK(engine.meanContactLoads()[static_cast<size_t>(lowest)].isZero());
        CHECK(engine.states()[static_cast<size_t>(lowest)].pose.position == place);
        REQUIRE(engine.hasContact());
        const auto first = numbersOf(engine);

        LiggghtsEngine other(setup);
        other.setHeld(gone);
        other.restore(state);
        other.setLoads(weights(setup));
        advance(other, 100, 2e-3);
        CHECK(numbersOf(other) == first);
    }
}

TEST_CASE("any number of bodies may be gone at one place; what falls there falls freely, and on a wall as if they were not there")
{
    std::vector<BodyDefinition> bars(300, debris(Vec3(0.5, 0.5, 0.02)));
    for (size_t b = 0; b < bars.size(); ++b)
        bars[b].name = "bar" + std::to_string(b);
    std::vector<char> gone(bars.size(), 1);
    gone[0] = 0;
    bars[0].pose.position.z() = 0.1;
    for (size_t b = 1; b < bars.size(); ++b) // apart at the start
        bars[b].pose.position = Vec3(0.5 + 0.3 * static_cast<double>(b % 20), 1 + 0.1 * static_cast<double>(b / 20), 0.5);
    const DemSetup setup = scene(bars, {plane(Vec3::Zero(), Vec3::UnitZ())});
    LiggghtsEngine engine(setup), alone(scene({bars[0]}, setup.walls));
    std::vector<BodyState> states = engine.states();
    for (size_t b = 1; b < states.size(); ++b)
        states[b].pose.position = Vec3(0.5, 0.5, 0.02);
    engine.setStates(states);
    engine.setHeld(gone);
    engine.setGone(gone);
    CHECK(engine.states()[7].pose.position == states[7].pose.position);
    engine.setLoads(weights(setup));
    alone.setLoads({weights(setup)[0]});
    for (int k = 0; k < 100; ++k)
    {
        engine.advance(2e-3);
        alone.advance(2e-3);
    }
    CHECK(engine.contacts().size() == 1);
    CHECK((engine.states()[0].pose.position - alone.states()[0].pose.position).norm() < 1e-9);
    CHECK(engine.subSteps() == alone.subSteps());
}

TEST_CASE("a body to come touches nothing, not even at its place; it comes in there, at rest, and is felt from then on")
{
    BodyDefinition first = debris(Vec3(0.5, 0.5, 0.1)), second = first;
    second.name = "second";
    second.entersAtRelease = true;
    second.pose.position.z() += 0.001; // in the first
    second.motion.velocity = Vec3(1, 0, 0);
    const DemSetup setup = scene({first, second}, {plane(Vec3::Zero(), Vec3::UnitZ())});
    LiggghtsEngine engine(setup), alone(scene({first}, setup.walls));
    engine.setLoads(weights(setup));
    alone.setLoads({weights(setup)[0]});
    const auto advanceBoth = [&]
    {
        for (int k = 0; k < 100; ++k)
        {
            engine.advance(2e-3);
            alone.advance(2e-3);
        }
    };
    advanceBoth(); // down to the floor
    CHECK(engine.states()[1].pose.position == second.pose.position);
    CHECK(engine.states()[1].motion.velocity == Vec3::Zero());
    REQUIRE(engine.contacts().size() == 1);
    CHECK((engine.states()[0].pose.position - alone.states()[0].pose.position).norm() < 1e-12);

    const DemState before = engine.save();
    engine.setGone({0, 0});
    CHECK(engine.states()[1].pose.position == second.pose.position);
    CHECK(engine.states()[1].motion.velocity == Vec3::Zero());
    engine.setHeld({0, 0});
    CHECK(engine.states()[1].motion.velocity == second.motion.velocity);
    engine.setLoads(weights(setup));
    for (int k = 0; k < 100; ++k)
        engine.advance(2e-3);
    const auto touches = [](const Contact& c) { return c.body == 1 || c.other == 1; };
    const std::vector<Contact> contacts = engine.contacts();
    CHECK(std::any_of(contacts.begin(), contacts.end(), touches));

    LiggghtsEngine other(setup);
    other.setHeld({0, 0});
    other.setGone({0, 0}); // restore() knows better
    other.setHeld({0, 1});
    other.restore(before);
    other.setGone({0, 0});
    other.setHeld({0, 0});
    other.setLoads(weights(setup));
    for (int k = 0; k < 100; ++k)
        other.advance(2e-3);
    CHECK(numbersOf(other) == numbersOf(engine));
}

TEST_CASE("bodies to come are not felt where they wait")
{
    std::vector<BodyDefinition> bars(60, debris(Vec3(0.5, 0.5, 0.1)));
    for (size_t b = 0; b < bars.size(); ++b)
    {
        bars[b].name = "bar" + std::to_string(b);
        bars[b].entersAtRelease = b > 0;
    }
    DemSetup setup = scene(bars, {plane(Vec3::Zero(), Vec3::UnitZ())});
    setup.box = {Vec3(0.3, 0.3, -0.1), Vec3(0.7, 0.7, 0.3)}; // full of them
    DemSetup ofOne = setup;
    ofOne.bodies.resize(1);
    LiggghtsEngine engine(setup), alone(ofOne);
    engine.setLoads(weights(setup));
    alone.setLoads(weights(ofOne));
    for (int k = 0; k < 100; ++k)
    {
        engine.advance(2e-3);
        alone.advance(2e-3);
    }
    CHECK(engine.contacts().size() == 1);
    CHECK((engine.states()[0].pose.position - alone.states()[0].pose.position).norm() < 1e-12);
}
