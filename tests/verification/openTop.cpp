// SPDX-License-Identifier: GPL-3.0-or-later
/// Water at rest whose surface's profile reaches open patches: what they prescribe is the pressure of a sharp surface, the profile's own comes besides
/// (docs/numerics/2-momentum.md, 2.8).
#include "equations/materials.hpp"
#include "support/waterAtRest.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

constexpr double g = 9.81, side = 0.2;
constexpr int n = 10;       // elements a side

/// Of p_rgh: a level (p_rgh = 0, hRef). Of p: none.
enum class Prescribed { Level, Pressure };

struct Rest { double speed, lost; };    // fastest water [m/s]; liquid that has left, of all

/// Square or cube; the top or, with a level, the end x = side is open.
class Tank
{
public:
    Tank(int dim, double level) : dim_(dim), level_(level), mesh_(makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {0, 0, 0}, {side, side, dim == 2 ? 1 : side}, 0.12)), halo_(mesh_, MPI_COMM_WORLD)
    {
        usePetsc();
        properties_.gravity[dim - 1] = -g;
        controls_.tolerance = 1e-9;
        patches_ = allPatches(mesh_, BoundaryPatch::Velocity::Slip);
    }

    void open(int p, Prescribed what, double reference)
    {
        patches_[p] = makePatch(mesh_, p, BoundaryPatch::Velocity::Open);
        const std::vector<int> nodes = patches_[p].nodes;
        patches_[p].evaluate = [this, nodes, what, reference](const BoundaryState& s, PatchValues& values)
        {
            values.alpha.assign(nodes.size(), 0.0);
            values.pressure.assign(nodes.size(), 0.0);
            for (std::size_t k = 0; k < nodes.size() && what == Prescribed::Level; ++k)
                values.pressure[k] = density(properties_, controls_, s.alpha[nodes[k]])*g*(reference - height(nodes[k]));
        };
    }

    Rest after(double time)
    {
        Fluid fluid(mesh_, halo_, properties_, controls_, patches_);
        fluid.start(waterAtRest(fluid, level_), false);
        const double before = fluid.liquidVolume();
        while (fluid.state().time < time)
        {
            fluid.beginStep(2e-3);
            fluid.assemble();
            REQUIRE(fluid.solve({}).hasConverged);
            fluid.endStep();
        }
        Rest rest{0, 1 - fluid.liquidVolume()/before};
        for (int i = 0; i < mesh_.nOwned; ++i)
            for (int d = 0; d < dim_; ++d)
                if (fluid.state().alpha[i] > 0.5) rest.speed = std::max(rest.speed, std::abs(fluid.state().u[std::size_t(i)*dim_ + d]));
        rest.speed = halo_.max(rest.speed);
        return rest;
    }

private:
    double height(int i) const { return mesh_.x[std::size_t(i)*dim_ + dim_ - 1]; }

    int dim_;
    double level_;
    SimplexMesh mesh_;
    Halo halo_;
    FluidProperties properties_;
    NumericsControls controls_;
    std::vector<BoundaryPatch> patches_;
};

} // namespace

TEST_CASE("no water leaves through an open top close above it")
{
    for (const int dim : {2, 3})
        for (const Prescribed what : {Prescribed::Level, Prescribed::Pressure})
            for (const double elements : {0.5, 1.0, 1.4})
            {
                Tank tank(dim, side*(1 - elements/n));
                tank.open(2*dim - 1, what, 0);
                const Rest rest = tank.after(0.1);
                MESSAGE(dim, "D, ", elements, " elements below the top, ", std::string(what == Prescribed::Level ? "p_rgh" : "p"), ": ", rest.speed, " m/s, lost ", rest.lost);
                CHECK(rest.speed < 1e-5);
                CHECK(std::abs(rest.lost) < 1e-8);
            }
}

TEST_CASE("nor through an open end that keeps the level")
{
    for (const int dim : {2, 3})
        for (const double elements : {5.0, 5.37})
        {
            const double level = side*(1 - elements/n);
            Tank tank(dim, level);
            tank.open(1, Prescribed::Level, level);
            const Rest rest = tank.after(0.1);
            MESSAGE(dim, "D, level ", elements, " elements below the top: ", rest.speed, " m/s, lost ", rest.lost);
            CHECK(rest.speed < 1e-5);
            CHECK(std::abs(rest.lost) < 1e-8);
        }
}
