// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/cellCost.H"

#include "volFields.H"

#include <array>

namespace flotsam
{

CellCostReport writeCellCost(const Foam::fvMesh& mesh, const MeshAdapter& adapter, const Halo& halo, const Cover* cover, const ElementCosts& costs)
{
    const Foam::IOobject io("cellCost", mesh.time().timeName(), mesh, Foam::IOobject::NO_READ, Foam::IOobject::NO_WRITE, false);
    Foam::volScalarField field(io, mesh, Foam::dimensionedScalar("cellCost", Foam::dimless, 0));
    const double elementsOfHexahedron = adapter.mesh.dim == 2 ? 2 : 6;
    const std::array<double, 3> costOf{1, costs.cut, costs.solid};     // in the order of ElementState
    std::array<double, 4> sums{};
    for (Foam::label c = 0; c < mesh.nCells(); ++c)
    {
        for (int k = adapter.cellStart[c]; k < adapter.cellStart[c + 1]; ++k)
        {
            const auto state = std::size_t(cover ? cover->state[adapter.cellElements[k]] : ElementState::Fluid);
            ++sums[state];
            field[c] += costOf[state]/elementsOfHexahedron;
        }
        sums[3] += field[c];
    }
    field.write();
    halo.sum(sums.data(), int(sums.size()));
    return {long(sums[0]), long(sums[1]), long(sums[2]), sums[3]};
}

} // namespace flotsam
