// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/fieldIO.H"
#include "equations/linearExtension.hpp"
#include "equations/liquidShares.hpp"
#include "equations/materials.hpp"
#include "foam/boundaryConditions.H"
#include "foam/boundaryReader.H"
#include "foam/cellMeans.H"
#include "foam/dictionaryChecks.H"

#include "Time.H"
#include "fixedValueFvPatchField.H"
#include "pointMesh.H"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

enum Component { Ux, Uy, Uz, P, Prgh, Alpha };

Foam::IOobject inputField(const Foam::fvMesh& mesh, const Foam::word& name)
{
    return Foam::IOobject(name, mesh.time().timeName(), mesh, Foam::IOobject::MUST_READ, Foam::IOobject::AUTO_WRITE);
}

template<class Field, class Mesh>
std::unique_ptr<Field> newField(const Foam::fvMesh& db, const Mesh& mesh, const Foam::word& name, const Foam::dimensionSet& dims)
{
    using Type = typename Field::value_type;
    const Foam::IOobject io(name, db.time().timeName(), db, Foam::IOobject::NO_READ, Foam::IOobject::AUTO_WRITE);
    return std::make_unique<Field>(io, mesh, Foam::dimensioned<Type>(name, dims, Foam::pTraits<Type>::zero));
}

bool isNumber(double value) { return std::isfinite(value); }
bool isNumber(const Foam::vector& value) { return std::isfinite(value.x()) && std::isfinite(value.y()) && std::isfinite(value.z()); }

/// Binary files hold what is no number as well as numbers, and comparisons with it are false, or end the run with a stack trace.
template<class Field>
void checkNumbers(const Field& field, const Halo& halo)
{
    double counts[2] = {};  // of cells; of faces that prescribe a value
    for (const auto& value : field.primitiveField()) counts[0] += !isNumber(value);
    for (const auto& patch : field.boundaryField())
        if (patch.fixesValue())
            for (const auto& value : patch) counts[1] += !isNumber(value);
    halo.sum(counts, 2);
    if (counts[0] + counts[1] == 0) return;
    const bool isOfCells = counts[0] > 0;
    failOnAll(text("Field ", std::string(field.name()), " of time ", std::string(field.time().timeName()), " has values that are no numbers (nan, inf), in ", isOfCells ? counts[0] : counts[1],
        isOfCells ? " cells" : " faces of the boundary", ": a run or a tool that failed has written them.\n    Make the field anew (cp -r 0.orig 0, then setFields or what you fill it with),"
        " or remove this time to go on from the one before."));
}

/// Other solvers overshoot by less than this, setAlphaField on polyhedra with warped faces by up to 0.02.
constexpr double largestOvershoot = 0.03;

void checkFractions(const Foam::volScalarField& alpha, const Halo& halo)
{
    double low = 0, high = 0;
    for (const double a : alpha.primitiveField())
    {
        low = std::min(low, a);
        high = std::max(high, a);
    }
    low = halo.min(low);
    high = halo.max(high);
    if (high <= 0)
        Foam::Info<< "Warning: field " << alpha.name() << " of time " << alpha.time().timeName() << " has no liquid in any cell (setFields, setExprFields or setAlphaField"
            << " not run?): nothing flows but what comes in through patches" << Foam::nl << Foam::endl;
    if (low >= -largestOvershoot && high <= 1 + largestOvershoot) return;
    FatalErrorInFunction << "Field " << alpha.name() << " of time " << alpha.time().timeName() << " has cells from " << low << " to " << high
        << ": it is the liquid's share of their volume, from 0 to 1." << Foam::exit(Foam::FatalError);
}

/// Coupled (processor) patches take their cells' values from each other.
template<class Field>
void exchangeCoupled(Field& field)
{
    if (!Foam::Pstream::parRun()) return;
    auto& boundary = field.boundaryFieldRef();
    const Foam::label firstRequest = Foam::Pstream::nRequests();
    forAll(boundary, i)
        if (boundary[i].coupled()) boundary[i].initEvaluate(Foam::Pstream::commsTypes::nonBlocking);
    Foam::Pstream::waitRequests(firstRequest);
    forAll(boundary, i)
        if (boundary[i].coupled()) boundary[i].evaluate(Foam::Pstream::commsTypes::nonBlocking);
}

/// Patch values are set without evaluating conditions; only coupled (processor) patches exchange their cells' values. What a patch prescribes by its
/// values stays: a run that goes on from the written field reads them.
template<class Field, class FaceValue>
void assignPatches(Field& field, FaceValue faceValue)
{
    using Type = typename Field::value_type;
    auto& boundary = field.boundaryFieldRef();
    forAll(boundary, i)
    {
        if (boundary[i].coupled() || boundary[i].type() == Foam::fixedValueFvPatchField<Type>::typeName) continue;
        Foam::Field<Type> values(boundary[i].size());
        const Foam::polyPatch& patch = boundary[i].patch().patch();
        forAll(values, f) values[f] = faceValue(patch[f]);
        boundary[i] == values;
    }
    exchangeCoupled(field);
}

} // namespace

FoamFields::FoamFields(const Foam::fvMesh& mesh, const MeshAdapter& adapter, const Halo& halo, const CaseControls& controls)
:
    mesh_(mesh), adapter_(adapter), halo_(halo), controls_(controls), velocity_(inputField(mesh, "U"), mesh)
{
    checkNumbers(velocity_, halo);
    const std::string pressureName = pressureFieldName(mesh, controls);
    auto read = std::make_unique<Foam::volScalarField>(inputField(mesh, pressureName), mesh);
    checkNumbers(*read, halo);
    if (read->dimensions() != Foam::dimPressure) pressureScale_ = controls.fluid.rhoLiquid;
    const Foam::dimensionSet dims = read->dimensions();
    if (pressureName == "p") pressure_ = std::move(read);
    else
    {
        pressureRgh_ = std::move(read);
        pressure_ = newField<Foam::volScalarField>(mesh, mesh, "p", dims);
    }
    const Foam::pointMesh& points = Foam::pointMesh::New(mesh);
    pointU_ = newField<Foam::pointVectorField>(mesh, points, "pointU", Foam::dimVelocity);
    pointP_ = newField<Foam::pointScalarField>(mesh, points, "pointP", dims);
    if (!controls.fluid.isTwoPhase) return;
    alpha_ = std::make_unique<Foam::volScalarField>(inputField(mesh, controls.alphaName), mesh);
    checkNumbers(*alpha_, halo);
    checkFractions(*alpha_, halo);
    pointAlpha_ = newField<Foam::pointScalarField>(mesh, points, "pointAlpha", Foam::dimless);
}

bool FoamFields::isNeeded() const
{
    return mesh_.time().writeTime() || !mesh_.time().functionObjects().empty();
}

void FoamFields::update(const FlowState& state, const std::vector<double>& width, const Cover* cover, const std::vector<Solid>& solids)
{
    storeOldTimes();
    updateNodal(state, cover, solids);
    updateCells(state, width, cover, solids);
    updatePatches();
    updatePointFields();
    if (cover) updateSolidFraction(*cover);
}

/// Function objects that look back (ddt) have OpenFOAM keep a field's last values, which it does where solvers assign fields as a whole: here cells are set one by one.
void FoamFields::storeOldTimes()
{
    velocity_.storeOldTimes();
    for (const auto* field : {&pressure_, &pressureRgh_, &alpha_, &solid_})
        if (*field) (*field)->storeOldTimes();
}

void FoamFields::updateNodal(const FlowState& state, const Cover* cover, const std::vector<Solid>& solids)
{
    const SimplexMesh& mesh = adapter_.mesh;
    nodal_.assign(static_cast<std::size_t>(mesh.nNodes)*nodalWidth, 0.0);
    std::vector<double> pressure(state.p.begin(), state.p.begin() + mesh.nNodes);
    if (cover) extendLinearly(mesh, halo_, *cover, pressure);
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        double* v = &nodal_[static_cast<std::size_t>(i)*nodalWidth];
        for (int d = 0; d < mesh.dim; ++d) v[Ux + mesh.axes[d]] = state.u[i*mesh.dim + d];
        const bool isInSolid = cover && !cover->isActiveNode[i] && cover->nearestSolid[i] >= 0;
        if (isInSolid)
        {
            const auto x = mesh.spacePoint(i);
            const Vec3 u = solids[cover->nearestSolid[i]].velocityAt(Vec3(x[0], x[1], x[2]));
            for (int d = 0; d < mesh.dim; ++d) v[Ux + mesh.axes[d]] = u[mesh.axes[d]];
        }
        v[Alpha] = state.alpha.empty() ? 1 : state.alpha[i];
        const double rho = density(controls_.fluid, controls_.numerics, v[Alpha]);
        v[P] = pressure[i]/pressureScale_;
        v[Prgh] = (pressure[i] - rho*gravityPotential(controls_, mesh, i))/pressureScale_;
    }
}

void FoamFields::updateCells(const FlowState& state, const std::vector<double>& width, const Cover* cover, const std::vector<Solid>& solids)
{
    double mean[nodalWidth];
    const Foam::label nCells = mesh_.nCells();
    std::vector<double> shares;
    if (alpha_ && controls_.numerics.dualCellTransport)
        shares = liquidShares(adapter_.mesh, halo_, cover, state.alpha, width);
    for (Foam::label c = 0; c < nCells; ++c)
    {
        const bool hasFluid = cellMean(adapter_, cover, nodal_, c, mean);
        if (cover && !hasFluid) rigidVelocity(*cover, solids, c, mean);
        velocity_[c] = Foam::vector(mean[Ux], mean[Uy], mean[Uz]);
        (*pressure_)[c] = mean[P];
        if (pressureRgh_) (*pressureRgh_)[c] = mean[Prgh];
        if (alpha_) (*alpha_)[c] = shares.empty() ? mean[Alpha] : liquidFraction(adapter_, cover, shares, c, mean[Alpha]);
    }
}

void FoamFields::rigidVelocity(const Cover& cover, const std::vector<Solid>& solids, Foam::label cell, double* velocity) const
{
    const SimplexMesh& mesh = adapter_.mesh;
    const int solid = cover.nearestSolid[mesh.elements[adapter_.cellElements[adapter_.cellStart[cell]]*(mesh.dim + 1)]];
    if (solid < 0) return;
    const Foam::point& x = mesh_.cellCentres()[cell]; // not C(): collective, and only ranks with solid cells come here
    const Vec3 u = solids[solid].velocityAt(Vec3(x.x(), x.y(), x.z()));
    for (int d = 0; d < mesh.dim; ++d) velocity[mesh.axes[d]] = u[mesh.axes[d]];
}

void FoamFields::updateSolidFraction(const Cover& cover)
{
    if (!solid_) solid_ = newField<Foam::volScalarField>(mesh_, mesh_, "solid", Foam::dimless);
    for (Foam::label c = 0; c < mesh_.nCells(); ++c)
    {
        double fluid = 0, whole = 0;
        for (int k = adapter_.cellStart[c]; k < adapter_.cellStart[c + 1]; ++k)
        {
            const int e = adapter_.cellElements[k];
            whole += adapter_.mesh.volume[e];
            fluid += fluidVolume(adapter_.mesh, &cover, e);
        }
        (*solid_)[c] = std::max(0.0, 1 - fluid/whole);
    }
    // the patch value of a cell fraction is its cell's: the derived patch fields are calculated
    auto& boundary = solid_->boundaryFieldRef();
    forAll(boundary, i)
        if (!boundary[i].coupled()) boundary[i] == boundary[i].patchInternalField()();
    exchangeCoupled(*solid_);
}

void FoamFields::updatePatches()
{
    const auto mean = [&](const Foam::face& face, int component)
    {
        double sum = 0;
        for (const Foam::label point : face)
            sum += nodal_[static_cast<std::size_t>(adapter_.pointNode[point])*nodalWidth + component];
        return sum/face.size();
    };
    assignPatches(velocity_, [&](const Foam::face& f) { return Foam::vector(mean(f, Ux), mean(f, Uy), mean(f, Uz)); });
    assignPatches(*pressure_, [&](const Foam::face& f) { return mean(f, P); });
    if (pressureRgh_) assignPatches(*pressureRgh_, [&](const Foam::face& f) { return mean(f, Prgh); });
    if (alpha_) assignPatches(*alpha_, [&](const Foam::face& f) { return mean(f, Alpha); });
}

void FoamFields::updatePointFields()
{
    forAll(adapter_.pointNode, point)
    {
        const double* v = &nodal_[static_cast<std::size_t>(adapter_.pointNode[point])*nodalWidth];
        (*pointU_)[point] = Foam::vector(v[Ux], v[Uy], v[Uz]);
        (*pointP_)[point] = v[P];
        if (pointAlpha_) (*pointAlpha_)[point] = v[Alpha];
    }
}

} // namespace flotsam
