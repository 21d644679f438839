// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/surfaceNearPatch.H"

#include "messageStream.H"

#include <algorithm>

namespace flotsam
{

namespace
{

constexpr double half = 0.5;    // alpha: surface

/// Most liquid in the cells at the patch, and in those behind them.
struct Layers { double first = 0, second = 0; };

Layers largestAlpha(const Foam::volScalarField& alpha, const Foam::labelUList& cells)
{
    Layers found;
    for (const Foam::label cell : cells)
    {
        found.first = std::max(found.first, double(alpha[cell]));
        for (const Foam::label next : alpha.mesh().cellCells()[cell]) found.second = std::max(found.second, double(alpha[next]));
    }
    return found;
}

} // namespace

void warnOfNearSurface(const Foam::volScalarField& alpha, const Foam::volScalarField& pressure, const Halo& halo)
{
    const auto& patches = alpha.mesh().boundary();
    forAll(patches, i)
    {
        if (!pressure.boundaryField()[i].fixesValue()) continue;    // those between ranks, which differ from rank to rank, do not
        const Layers here = largestAlpha(alpha, patches[i].faceCells());
        if (halo.max(here.first) >= half || halo.max(here.second) < half) continue;
        Foam::Info<< "Warning: field " << alpha.name() << " of time " << alpha.time().timeName() << ": the surface lies one cell from patch " << patches[i].name()
            << " and will reach it: liquid leaves there. Put two cells of gas between them at least" << Foam::nl << Foam::endl;
    }
}

} // namespace flotsam
