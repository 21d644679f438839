// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/solid.hpp"

namespace flotsam
{

/// What one body and another, or one wall, did to each other during an advance(), in however many places they touched.
struct MeanContact
{
    int body = 0;                   ///< index of the body
    int other = 0;                  ///< index of the other body, or -1 - wall
    Vec3 point = Vec3::Zero();      ///< centre of the places, weighted by force and time [m]
    Vec3 force = Vec3::Zero();      ///< on `body` [N], time mean
    double overlap = 0;             ///< the deepest of the two DEM surfaces [m]
    int spheres = 0;                ///< most pairs of spheres, or spheres at the wall, that touched at once
};

} // namespace flotsam
