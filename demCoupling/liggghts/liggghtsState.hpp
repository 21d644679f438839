// SPDX-License-Identifier: GPL-3.0-or-later
/// How DemState is laid out: a header, the bodies, the loads of the walls, whether corners have retreated, springs, contacts of the instant, restraints.
#pragma once

#include "demCoupling/liggghts/liggghtsParts.hpp"

namespace flotsam
{

constexpr double stateFormat = 4;
constexpr double stateFormatWithoutPairs = 3;   // those of older versions: half a sub-step's forces are missing in the first advance's means
constexpr size_t stateHeaderLength = 4;         // format, numbers of bodies, walls, spheres
constexpr size_t stateBodyLength = 11 * 3 + 4 + 8;
constexpr size_t stateWallLength = 6;

} // namespace flotsam
