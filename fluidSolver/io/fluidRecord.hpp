// SPDX-License-Identifier: GPL-3.0-or-later
/// The properties of fluids and gravity that a state was computed with, as numbers, since a state has nothing else.
#pragma once

#include "core/controls.hpp"

#include <string>
#include <vector>

namespace flotsam
{

std::vector<double> fluidRecord(const FluidProperties& fluid);

/// "density of the liquid 1000, now 1200 kg/m^3; ..": what differs by more than round-off. Empty: nothing, or a record of another length (none, or that of another version).
std::string changedFluid(const std::vector<double>& record, const FluidProperties& fluid);

} // namespace flotsam
