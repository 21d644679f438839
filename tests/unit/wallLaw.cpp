// SPDX-License-Identifier: GPL-3.0-or-later
/// Spalding's law against what it joins: the viscous sublayer, the logarithmic layer, the fully rough wall.
#include "equations/wallLaw.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

using namespace flotsam;

TEST_CASE("velocity over a smooth wall")
{
    CHECK(velocityOverFriction(0, 0) == 0);
    CHECK(velocityOverFriction(1e-6, 0) == near(1e-3, 1e-9));
    for (double reY : {1e4, 1e6, 1e8})      // u+ = ln(y+)/kappa + B with y+ = reY/u+
    {
        const double u = velocityOverFriction(reY, 0);
        CHECK(u == near(std::log(reY/u)/0.41 + 5, 0.02));
    }
    CHECK(velocityOverFriction(11*11, 0) < 11);     // the buffer layer is below both laws
}

// u+ = ln(y/ks)/kappa + 8.5 (Nikuradse)
TEST_CASE("velocity over a rough wall")
{
    for (double height : {5., 100., 1e4}) CHECK(velocityOverFriction(1e9, 1e9/height) == near(std::log(height)/0.41 + 8.5, 0.01));
    CHECK(velocityOverFriction(1e9, 1e9) == near(std::log(1 + std::exp(0.41*8.5))/0.41, 1e-3));    // at the height of a grain
    for (double reY : {1e-3, 1., 1e3, 1e6}) // and it never lets more pass than the smooth one
        CHECK(velocityOverFriction(reY, reY/20) <= velocityOverFriction(reY, 0));
}
