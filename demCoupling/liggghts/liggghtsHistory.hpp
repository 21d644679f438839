// SPDX-License-Identifier: GPL-3.0-or-later
/// Contacts as LIGGGHTS remembers them.
#pragma once

#include "demCoupling/liggghts/liggghtsParts.hpp"

#include <mpi.h>

#include <functional>

namespace flotsam
{

/// visit(sphere i, sphere j, tangential spring on i, its length) for every touching pair of spheres.
void forEachPairContact(const LiggghtsModel& model, const std::function<void(int, int, const double*, int)>& visit);

/// Whether this sphere (LIGGGHTS index) touches a triangle of a mesh wall.
bool touchesMesh(const WallHandle& wall, int sphere);

} // namespace flotsam
