// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace flotsam
{

struct CouplingControls
{
    double tolerance = 1e-2;    ///< change of contact acceleration over contact acceleration plus gravity that ends the repeats
    int maxRepeats = 8;
    double gravity = 9.81;      ///< |g| [m/s^2]
    double liquidDensity = 1000; ///< [kg/m^3]
};

} // namespace flotsam
