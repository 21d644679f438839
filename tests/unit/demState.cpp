// SPDX-License-Identifier: GPL-3.0-or-later
#include "unit/demSupport.hpp"

#include <doctest/doctest.h>

#include <mpi.h>

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
