// SPDX-License-Identifier: GPL-3.0-or-later
/// What a state was computed with is compared with what the case gives now.
#include "io/fluidRecord.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

using namespace flotsam;

namespace
{

/// The message of a case changed after the state was written.
std::string after(const std::function<void(FluidProperties&)>& change)
{
    FluidProperties fluid;
    fluid.gravity = {0, -9.81, 0};
    const std::vector<double> record = fluidRecord(fluid);
    change(fluid);
    return changedFluid(record, fluid);
}

} // namespace

TEST_CASE("the same fluids, and those that differ by round-off, are the same")
{
    CHECK(after([](FluidProperties&) {}).empty());
    CHECK(after([](FluidProperties& f) { f.rhoLiquid = std::nextafter(1000.0, 2000.0); f.gravity = {1e-16, -9.81*(1 + 1e-15), 0}; }).empty());
}

TEST_CASE("every property that differs is named with both values, and no other")
{
    CHECK(after([](FluidProperties& f) { f.rhoLiquid = 1200; f.muLiquid = 1.2e-3; }) == "density of the liquid 1000, now 1200 kg/m^3");
    CHECK(after([](FluidProperties& f) { f.muLiquid = 1; }) == "nu of the liquid 1e-06, now 0.001 m^2/s");
    CHECK(after([](FluidProperties& f) { f.rhoGas = 1.2; f.muGas *= 1.2; }) == "density of the gas 1, now 1.2 kg/m^3");
    CHECK(after([](FluidProperties& f) { f.muGas = 1e-5; }) == "nu of the gas 1.8e-05, now 1e-05 m^2/s");
    CHECK(after([](FluidProperties& f) { f.gravity = {0, 0, -9.81}; }) == "gravity (0 -9.81 0), now (0 0 -9.81) m/s^2");
    CHECK(after([](FluidProperties& f) { f.rhoLiquid = 800; f.muLiquid = 8e-4; f.gravity = {0, 0, 0}; })
        == "density of the liquid 1000, now 800 kg/m^3; gravity (0 -9.81 0), now (0 0 0) m/s^2");
    CHECK(after([](FluidProperties& f) { f.isTwoPhase = false; f.rhoGas = f.rhoLiquid; f.muGas = f.muLiquid; }) == "number of fluids 2, now 1");
}

TEST_CASE("states of earlier versions have no record: nothing is said")
{
    CHECK(changedFluid({}, FluidProperties()).empty());
    CHECK(changedFluid({1, 2, 3}, FluidProperties()).empty());
}
