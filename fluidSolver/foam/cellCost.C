// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/cellCost.H"

#include "volFields.H"

#include <array>

namespace flotsam
{

namespace
{

/// Processor time of an element in a step over that of an element full of fluid, in the order of ElementState. Measured, see docs/cluster.md.
constexpr std::array<double, 3> elementCosts2d{1, 4, 0.5}, elementCosts3d{1, 6, 0.25};

} // namespace

CellCostReport writeCellCost(const Foam::fvMesh& mesh, const MeshAdapter& adapter, const Halo& halo, const Cover* cover)
{
    const Foam::IOobject io("cellCost", mesh.time().timeName(), mesh, Foam::IOobject::NO_READ, Foam::IOobject::NO_WRITE, false);
    Foam::volScalarField field(io, mesh, Foam::dimensionedScalar("cellCost", Foam::dimless, 0));
    const bool is2d = adapter.mesh.dim == 2;
    const std::array<double, 3>& costs = is2d ? elementCosts2d : elementCosts3d;
    const double elementsOfHexahedron = is2d ? 2 : 6;
    std::array<double, 4> sums{};
    for (Foam::label c = 0; c < mesh.nCells(); ++c)
    {
        for (int k = adapter.cellStart[c]; k < adapter.cellStart[c + 1]; ++k)
        {
            const auto state = std::size_t(cover ? cover->state[adapter.cellElements[k]] : ElementState::Fluid);
            ++sums[state];
            field[c] += costs[state]/elementsOfHexahedron;
        }
        sums[3] += field[c];
    }
    field.write();
    halo.sum(sums.data(), int(sums.size()));
    return {long(sums[0]), long(sums[1]), long(sums[2]), sums[3]};
}

} // namespace flotsam
