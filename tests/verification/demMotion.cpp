// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.hpp"
#include "unit/demSupport.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;
using namespace demTest;

namespace
{

BodyDefinition box()
{
    BodyDefinition body = bar(Vec3(0.2, 0.06, 0.03), 0.03, 0.2, Vec3::Zero());
    body.pose.orientation = Eigen::AngleAxisd(0.8, Vec3::Ones().normalized());
    body.motion.angularVelocity = Vec3(3, 40, -10);
    return body;
}

double energy(const BodyState& s) { return 0.5 * s.angularMomentum.dot(s.motion.angularVelocity); }

Eigen::Quaterniond turned(double step, double duration)
{
    LiggghtsEngine engine(scene({box()}, {}));
    engine.advance(duration, step);
    return engine.states()[0].pose.orientation;
}

} // namespace

TEST_CASE("a tumbling box keeps its angular momentum exactly and its energy to second order")
{
    double last = 0;
    for (const double step : {2e-4, 1e-4})
    {
        LiggghtsEngine engine(scene({box()}, {}));
        const BodyState start = engine.states()[0];
        double worst = 0;
        for (int i = 0; i < 100; ++i)
        {
            engine.advance(1e-2, step);
            worst = std::max(worst, std::abs(energy(engine.states()[0]) / energy(start) - 1));
        }
        CHECK((engine.states()[0].angularMomentum - start.angularMomentum).norm() == 0);
        CHECK(worst < 4e-6);
        if (last > 0)
            CHECK(last / worst > 3.5);
        last = worst;
    }
}

TEST_CASE("its orientation converges with second order")
{
    const Eigen::Quaterniond exact = turned(2e-6, 0.2);
    const double coarse = exact.angularDistance(turned(2e-4, 0.2)), fine = exact.angularDistance(turned(1e-4, 0.2));
    CHECK(coarse < 1e-3);
    CHECK(coarse / fine == near(4, 0.1));
}
