// SPDX-License-Identifier: GPL-3.0-or-later
/// Tolerances of assertions: CHECK(x == near(expected, relative)), CHECK(x == within(expected, absolute)).
#pragma once

#include <doctest/doctest.h>

#include <limits>

namespace flotsam
{

/// Equal to the part `relative` of the larger of both. doctest allows epsilon (scale + larger); its default scale of 1 makes that an absolute tolerance where
/// values are below 1, and any two values far below epsilon are equal. Not quite 0, so that 0 is near 0 (doctest compares by <); nothing else is: see within.
inline doctest::Approx near(double value, double relative) { return doctest::Approx(value).epsilon(relative).scale(1e-200); }

/// Equal to `absolute`, and the values' rounding.
inline doctest::Approx within(double value, double absolute)
{
    constexpr double rounding = std::numeric_limits<double>::epsilon();
    return doctest::Approx(value).epsilon(rounding).scale(absolute/rounding);
}

} // namespace flotsam
