// SPDX-License-Identifier: GPL-3.0-or-later
/// FoamFields at the start of a run: nodal values from the cells' values, or from the point fields that a run has written.
#include "foam/fieldIO.H"
#include "equations/materials.hpp"
#include "foam/boundaryConditions.H"
#include "foam/surfaceFromCells.H"

#include "Time.H"
#include "pointMesh.H"

#include <algorithm>

namespace flotsam
{

namespace
{

/// Cell values -> nodes: mean over the cells around a node, weighted with their volumes.
class CellsToNodes
{
public:
    CellsToNodes(const MeshAdapter& adapter, const Halo& halo) : adapter_(adapter), halo_(halo) {}

    template<class CellValue>
    std::vector<double> operator()(CellValue cellValue) const
    {
        const SimplexMesh& mesh = adapter_.mesh;
        const int nCells = adapter_.cellStart.size() - 1;
        // deviations from a value that all ranks share: uniform fields come out exactly
        const double reference = halo_.max(nCells > 0 ? cellValue(0) : -1e300);
        std::vector<double> sum(2*static_cast<std::size_t>(mesh.nNodes), 0.0);
        std::vector<int> nodes;
        for (int c = 0; c < nCells; ++c)
        {
            const double volume = collectCell(adapter_, c, nodes);
            for (int i : nodes)
            {
                sum[2*std::size_t(i)] += volume*(cellValue(c) - reference);
                sum[2*std::size_t(i) + 1] += volume;
            }
        }
        halo_.sumToOwners(sum, 2);
        halo_.update(sum, 2);
        std::vector<double> nodal(mesh.nNodes);
        for (int i = 0; i < mesh.nNodes; ++i) nodal[i] = reference + sum[2*i]/sum[2*i + 1];
        return nodal;
    }

private:
    const MeshAdapter& adapter_;
    const Halo& halo_;
};

/// The surface between the cells' values, and the volume of their liquid.
void readSurface(const Foam::polyMesh& cells, const MeshAdapter& adapter, const Halo& halo, const Foam::scalarField& alpha, FlowState& state)
{
    std::vector<double> fraction(alpha.begin(), alpha.end());
    for (double& f : fraction) f = std::clamp(f, 0.0, 1.0);
    const SimplexMesh& mesh = adapter.mesh;
    const int n = mesh.dim + 1;
    std::vector<double>& volume = state.startLiquid.volume;
    volume.assign(mesh.nNodes, 0.0);
    for (std::size_t c = 0; c < fraction.size(); ++c)
        for (int k = adapter.cellStart[c]; k < adapter.cellStart[c + 1]; ++k)
        {
            const int e = adapter.cellElements[k];
            for (int a = 0; a < n; ++a) volume[mesh.elements[std::size_t(e)*n + a]] += fraction[c]*mesh.volume[e]/n;
        }
    halo.sumToOwners(volume, 1);
    state.startLiquid.isAtSide = reconstructSurface(cells, adapter, halo, fraction, state.alpha);
}

} // namespace

void FoamFields::readStart(FlowState& state) const
{
    const SimplexMesh& mesh = adapter_.mesh;
    const CellsToNodes toNodes(adapter_, halo_);
    state.time = mesh_.time().value();
    state.u.assign(static_cast<std::size_t>(mesh.nNodes)*mesh.dim, 0.0);
    for (int d = 0; d < mesh.dim; ++d)
    {
        const auto u = toNodes([&](int c) { return velocity_[c][mesh.axes[d]]; });
        for (int i = 0; i < mesh.nNodes; ++i) state.u[i*mesh.dim + d] = u[i];
    }
    if (alpha_)
    {
        state.alpha = toNodes([&](int c) { return std::clamp((*alpha_)[c], 0.0, 1.0); });
        readSurface(mesh_, adapter_, halo_, *alpha_, state);
    }
    else state.alpha.assign(mesh.nNodes, 1.0);
    const Foam::volScalarField& pressure = pressureRgh_ ? *pressureRgh_ : *pressure_;
    state.p = toNodes([&](int c) { return pressure[c]*pressureScale_; });
    if (!pressureRgh_) return;
    for (int i = 0; i < mesh.nNodes; ++i)
        state.p[i] += density(controls_.fluid, controls_.numerics, state.alpha[i])*gravityPotential(controls_, mesh, i);
}

/// Nodal values from a point field of the start time. False, on every rank, when a rank has no such field or one of another number of points.
template<class Field, class Value>
bool FoamFields::readPoints(const char* name, int width, Value value, std::vector<double>& nodal) const
{
    nodal.assign(static_cast<std::size_t>(adapter_.mesh.nNodes)*width, 0.0);
    Foam::IOobject io(name, mesh_.time().timeName(), mesh_, Foam::IOobject::MUST_READ, Foam::IOobject::NO_WRITE, false);
    bool isRead = io.typeHeaderOk<Field>(true);
    if (halo_.any(!isRead)) return false;
    const bool didThrow = Foam::FatalIOError.throwExceptions();
    try
    {
        const Field field(io, Foam::pointMesh::New(mesh_));
        forAll(adapter_.pointNode, point)
            for (int k = 0; k < width; ++k) nodal[static_cast<std::size_t>(adapter_.pointNode[point])*width + k] = value(field[point], k);
    }
    catch (const Foam::IOerror&) { isRead = false; } // of another number of points
    if (!didThrow) Foam::FatalIOError.dontThrowExceptions();
    if (halo_.any(!isRead)) return false;
    halo_.update(nodal, width);
    fillCellCentres(width, nodal);
    return true;
}

/// Nodes that are no points of the mesh: means of the nodes around them.
void FoamFields::fillCellCentres(int width, std::vector<double>& nodal) const
{
    const SimplexMesh& mesh = adapter_.mesh;
    const int n = mesh.dim + 1;
    std::vector<char> isPoint(mesh.nOwned, 0);
    for (const Foam::label node : adapter_.pointNode)
        if (node < mesh.nOwned) isPoint[node] = 1;
    std::vector<double> sum(static_cast<std::size_t>(mesh.nOwned)*width, 0.0);
    std::vector<int> count(mesh.nOwned, 0);
    for (int e = 0; e < mesh.nInnerElements; ++e)
        for (int a = 0; a < n; ++a)
        {
            const int node = mesh.elements[std::size_t(e)*n + a];
            if (node >= mesh.nOwned || isPoint[node]) continue;
            for (int b = 0; b < n; ++b)
            {
                if (b == a) continue;
                const std::size_t other = mesh.elements[std::size_t(e)*n + b];
                for (int k = 0; k < width; ++k) sum[std::size_t(node)*width + k] += nodal[other*width + k];
                ++count[node];
            }
        }
    for (int i = 0; i < mesh.nOwned; ++i)
        for (int k = 0; k < width && count[i] > 0; ++k) nodal[std::size_t(i)*width + k] = sum[std::size_t(i)*width + k]/count[i];
    halo_.update(nodal, width);
}

/// Solid fraction as written at the start time; none where there was no solid.
std::unique_ptr<Foam::volScalarField> FoamFields::writtenSolid() const
{
    Foam::IOobject io("solid", mesh_.time().timeName(), mesh_, Foam::IOobject::MUST_READ, Foam::IOobject::NO_WRITE, false);
    if (halo_.any(!io.typeHeaderOk<Foam::volScalarField>(true))) return nullptr;
    return std::make_unique<Foam::volScalarField>(io, mesh_);
}

bool FoamFields::agreesWithCells(const FlowState& state) const
{
    constexpr double speedShare = 0.05;     // allowed beyond the nodes' velocities, of the fastest: values are rounded when written
    constexpr double alphaMargin = 0.6;     // beyond the nodes' alpha: a cell's comes from planes in the dual cells, not from the nodal values
    constexpr double allSolid = 0.99;       // such cells have the solid's velocity
    const std::unique_ptr<Foam::volScalarField> solid = writtenSolid();
    const SimplexMesh& mesh = adapter_.mesh;
    double fastest = 0;
    for (const double u : state.u) fastest = std::max(fastest, std::abs(u));
    const double margin = speedShare*halo_.max(fastest);
    bool isOther = false;
    std::vector<int> nodes;
    const auto isWithin = [&](double value, const std::vector<double>& nodal, int width, int component, double allowed)
    {
        double lower = 1e300, upper = -1e300;
        for (const int i : nodes)
        {
            const double v = nodal[std::size_t(i)*width + component];
            lower = std::min(lower, v);
            upper = std::max(upper, v);
        }
        return value >= lower - allowed && value <= upper + allowed;
    };
    for (Foam::label c = 0; c < mesh_.nCells() && !isOther; ++c)
    {
        if (solid && (*solid)[c] > allSolid) continue;
        collectCell(adapter_, c, nodes);
        for (int d = 0; d < mesh.dim; ++d) isOther = isOther || !isWithin(velocity_[c][mesh.axes[d]], state.u, mesh.dim, d, margin);
        if (alpha_) isOther = isOther || !isWithin((*alpha_)[c], state.alpha, 1, 0, alphaMargin);
    }
    return !halo_.any(isOther);
}

bool FoamFields::readNodes(FlowState& state) const
{
    const SimplexMesh& mesh = adapter_.mesh;
    const auto scalar = [](double v, int) { return v; };
    if (!readPoints<Foam::pointVectorField>("pointU", mesh.dim, [&](const Foam::vector& u, int d) { return u[mesh.axes[d]]; }, state.u)) return false;
    if (!readPoints<Foam::pointScalarField>("pointP", 1, scalar, state.p)) return false;
    for (double& p : state.p) p *= pressureScale_;
    if (!alpha_) state.alpha.assign(mesh.nNodes, 1.0);
    else if (!readPoints<Foam::pointScalarField>("pointAlpha", 1, scalar, state.alpha)) return false;
    state.time = mesh_.time().value();
    return agreesWithCells(state);
}

} // namespace flotsam
