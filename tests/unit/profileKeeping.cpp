// SPDX-License-Identifier: GPL-3.0-or-later
/// How fast cells that disagree about the surface come together (docs/numerics/4-phase-field.md, 4.5).
#include "equations/fluid.hpp"
#include "equations/initialProfile.hpp"
#include "equations/surfaceLevel.hpp"
#include "support/flowCases.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

constexpr double g = 9.81;

/// Water at rest on a regular mesh of element length h, the surface between two rows of cells, 0.35 h above the lower one. The lower row
/// puts it `disagreement` further up than the upper one; the profile is so thin that other rows have no surface.
struct TwoRows
{
    static constexpr int n = 8;
    static constexpr double h = 0.05;

    int dim;
    double disagreement;
    SimplexMesh mesh;
    Halo halo;
    NumericsControls controls;

    TwoRows(int dim_, double disagreement_)
    :   dim(dim_), disagreement(disagreement_), mesh(makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {0, 0, 0}, {n*h, n*h, n*h})), halo(mesh, MPI_COMM_WORLD)
    {
        controls.interfaceWidth = 0.1;
    }

    double width() const { return controls.interfaceWidth*h; }
    int row(int i) const { return int(std::lround(mesh.x[std::size_t(i)*dim + dim - 1]/h)); }
    static constexpr int lower = 4, upper = 5;

    /// Distance of the row's nodes from the surface by their own alpha [m].
    double level(int row) const { return (lower + 0.35 - row)*h + (row == lower ? 0.5 : row == upper ? -0.5 : 0)*disagreement; }

    double startAlpha(const DualCells& cells, int i) const
    {
        double normal[3] = {};
        normal[dim - 1] = -1;
        return profileSlab(&cells, i, normal, level(row(i)), width()).mean();
    }

    FlowState start(const DualCells& cells) const
    {
        FlowState state = restState(mesh);
        for (int i = 0; i < mesh.nNodes; ++i) state.alpha[i] = startAlpha(cells, i);
        halo.update(state.alpha, 1);    // cells of second-ring copies are not whole
        state.alphaOld = state.alphaOlder = state.alpha;
        return state;
    }

    /// Cells at the walls are not as high as the others: their neighbours are left out as well.
    bool isInside(int i) const
    {
        bool result = true;
        for (int d = 0; d < dim - 1; ++d) result = result && std::abs(mesh.x[std::size_t(i)*dim + d] - 0.5*n*h) < 1.5*h;
        return result;
    }

    /// Liquid that the lower row has given to the upper one in a step, over a cell's volume: smallest and largest of the inner columns.
    std::array<double, 2> given(double dt)
    {
        FluidProperties properties;
        properties.gravity[dim - 1] = -g;
        Fluid fluid(mesh, halo, properties, controls, allPatches(mesh, BoundaryPatch::Velocity::Slip));
        const FlowState before = start(DualCells(mesh));
        fluid.start(before, false);
        fluid.beginStep(dt);
        std::array<double, 2> result{1e300, -1e300};
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            const double gain = fluid.state().alpha[i] - before.alpha[i];
            if (!isInside(i)) continue;
            if (row(i) != lower && row(i) != upper) CHECK(std::abs(gain) < 1e-12);
            else
            {
                result[0] = std::min(result[0], row(i) == upper ? gain : -gain);
                result[1] = std::max(result[1], row(i) == upper ? gain : -gain);
            }
        }
        return {halo.min(result[0]), halo.max(result[1])};
    }

    /// The same of the formula: the squared cosines of the connections of a column's two cells, weighted with the elements' volumes over their
    /// number of nodes, sum up to half a cell's volume, with triangles as with Kuhn's tetrahedra.
    double expected(double dt) const
    {
        const DualCells cells(mesh);
        double alpha[2] = {};
        for (int i = 0; i < mesh.nOwned; ++i)
            if (isInside(i) && (row(i) == lower || row(i) == upper)) alpha[row(i) - lower] = startAlpha(cells, i);
        const auto capacity = [&](double ofRow) { const double a = halo.max(ofRow); return a*(1 - a)/width(); };
        const double a = capacity(alpha[0]), b = capacity(alpha[1]);
        return 0.5*std::min(0.1, controls.profileKeeping*std::sqrt(g/h)*dt)*2*a*b/(a + b)*disagreement;
    }
};

} // namespace

TEST_CASE("cells above each other that disagree about the surface come together at the rate of the formula")
{
    usePetsc();
    for (const int dim : {2, 3})
        for (const double disagreement : {0.02*TwoRows::h, -0.01*TwoRows::h})
            for (const double rate : {0.3, 1.0})
                for (const double dt : {1e-4, 1e-3, 1.0}) // the last: a tenth of the disagreement
                {
                    TwoRows rows(dim, disagreement);
                    rows.controls.profileKeeping = rate;
                    CAPTURE(dim);
                    CAPTURE(disagreement);
                    CAPTURE(rate);
                    CAPTURE(dt);
                    const double expected = rows.expected(dt);
                    for (const double given : rows.given(dt)) CHECK(given == near(expected, 5e-6));
                }
}

TEST_CASE("cells that agree about the surface exchange nothing, nor do any at rate 0")
{
    usePetsc();
    for (const int dim : {2, 3})
    {
        TwoRows agreed(dim, 0), off(dim, 0.02*TwoRows::h);
        off.controls.profileKeeping = 0;
        for (const double given : agreed.given(1)) CHECK(std::abs(given) < 1e-9);
        for (const double given : off.given(1)) CHECK(std::abs(given) < 1e-15);
    }
}
