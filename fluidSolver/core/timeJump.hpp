// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace flotsam
{

/// Something prescribed changes within a short time: a time step that is longer than that should end in its middle.
struct TimeJump
{
    double time;        ///< its middle [s]
    double length;      ///< [s]
};

} // namespace flotsam
