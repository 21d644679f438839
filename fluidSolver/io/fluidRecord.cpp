// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/fluidRecord.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>

namespace flotsam
{

namespace
{

constexpr double roundOff = 1e-9;

struct Property { const char *name, *unit; std::size_t first, size; };

/// In the order of fluidRecord(). Viscosities are kinematic, as they are given: another density alone does not change them.
constexpr Property properties[] = {
    {"number of fluids", "", 0, 1},
    {"density of the liquid", " kg/m^3", 1, 1},
    {"nu of the liquid", " m^2/s", 2, 1},
    {"density of the gas", " kg/m^3", 3, 1},
    {"nu of the gas", " m^2/s", 4, 1},
    {"gravity", " m/s^2", 5, 3}};

std::string written(const double* values, std::size_t size)
{
    std::ostringstream s;
    s << (size > 1 ? "(" : "");
    for (std::size_t k = 0; k < size; ++k) s << (k ? " " : "") << values[k];
    s << (size > 1 ? ")" : "");
    return s.str();
}

bool differs(const double* a, const double* b, std::size_t size)
{
    double difference = 0, scale = 0;
    for (std::size_t k = 0; k < size; ++k)
    {
        difference = std::max(difference, std::abs(a[k] - b[k]));
        scale = std::max({scale, std::abs(a[k]), std::abs(b[k])});
    }
    return difference > roundOff*scale;
}

} // namespace

std::vector<double> fluidRecord(const FluidProperties& fluid)
{
    const auto& g = fluid.gravity;
    return {fluid.isTwoPhase ? 2.0 : 1.0, fluid.rhoLiquid, fluid.muLiquid/fluid.rhoLiquid, fluid.rhoGas, fluid.muGas/fluid.rhoGas, g[0], g[1], g[2]};
}

std::string changedFluid(const std::vector<double>& record, const FluidProperties& fluid)
{
    const std::vector<double> now = fluidRecord(fluid);
    std::string changes;
    if (record.size() != now.size()) return changes;
    for (const Property& p : properties)
    {
        const bool isOfGas = p.first == 3 || p.first == 4;
        const double *a = &record[p.first], *b = &now[p.first];
        if ((isOfGas && !fluid.isTwoPhase) || !differs(a, b, p.size)) continue;
        changes += (changes.empty() ? "" : "; ") + std::string(p.name) + " " + written(a, p.size) + ", now " + written(b, p.size) + p.unit;
    }
    return changes;
}

} // namespace flotsam
