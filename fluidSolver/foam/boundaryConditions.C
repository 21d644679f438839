// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/boundaryConditions.H"
#include "foam/criticalLevel.H"
#include "foam/dictionaryChecks.H"
#include "foam/faceValues.H"
#include "foam/fieldEntry.H"
#include "foam/innerPoints.H"
#include "foam/tableJumps.H"

#include "equations/materials.hpp"

#include "Function1.H"
#include "OSspecific.H"
#include "vectorField.H"

#include <algorithm>

namespace flotsam
{

namespace
{

using Foam::scalar;
using Foam::vector;

template<class Type>
using TimeFunction = std::shared_ptr<const Foam::Function1<Type>>;

/// "10 l/s": OpenFOAM leaves what follows the number.
void checkNoUnit(const Foam::dictionary& dict, const char* keyword)
{
    if (dict.isDict(keyword)) return;
    const Foam::ITstream& value = dict.lookup(keyword);
    const bool hasWord = value.size() > 0 && value[0].isWord() && (value[0].wordToken() == "constant" || value[0].wordToken() == "uniform"); // a table may begin with its length
    const Foam::label number = hasWord ? 1 : 0;
    if (value.size() > number + 1 && value[number].isNumber()) failValue(dict, keyword, "a number, or a Function1 (table, csv, sine, ...)");
}

/// All of it stands in the entry: a value, or a table.
bool isWholeFunction(const Foam::dictionary& dict, const char* keyword)
{
    if (dict.isDict(keyword)) return false;
    const Foam::ITstream& value = dict.lookup(keyword);
    return value.size() != 1 || !value[0].isWord();
}

const char* example(scalar) { return "0"; }
const char* example(const vector&) { return "(0 0 0)"; }

template<class Type>
TimeFunction<Type> timeFunction(const Foam::dictionary& dict, const char* keyword)
{
    if (!dict.found(keyword)) failIn(dict, text("Entry '", keyword, "' is missing: give a constant, or a Function1 (table, csv, sine, ...)."));
    checkNoUnit(dict, keyword);
    const bool didThrow = Foam::FatalError.throwExceptions();
    TimeFunction<Type> function;
    std::string mistake;
    try { function.reset(Foam::Function1<Type>::New(keyword, dict).ptr()); }
    catch (const Foam::IOerror&)
    {
        Foam::FatalError.throwExceptions(didThrow);
        if (!isWholeFunction(dict, keyword)) throw; // something in a group of its own, which the message names
        failValue(dict, keyword, text("a ", Foam::pTraits<Type>::typeName, ", or a function of time of such values: table ((0 ", example(Type()), ") (10 ", example(Type()), ")), csvFile, .."));
    }
    catch (const Foam::error& error) { mistake = error.message(); } // of a table whose times do not rise, for instance, says neither
    Foam::FatalError.throwExceptions(didThrow);
    if (!mistake.empty()) failIn(dict, text("Entry '", keyword, "' is no function of time: ", mistake, "\n    Give a constant, or a Function1 (table with rising times, csv, sine, ...)."));
    return function;
}

[[noreturn]] void failNotAvailable(const ConditionInput& in, const std::string& type, const std::vector<std::string>& known)
{
    const auto near = nearestWords(type, known);
    failIn(in.dict, text("Field ", in.field, ", patch ", in.patch.name(), ": condition '", type, "' is not available in flotsamFoam.",
        near.empty() ? "" : text("\n    Nearest: ", joined(near)), "\n    Use one of: ", joined(known)));
}

template<class Condition>
using Maker = Condition (*)(const ConditionInput&);

/// Looks the type up in a table; constraint types are the mesh's affair and common to all fields.
template<class Condition>
Condition makeFrom(const std::vector<std::pair<std::string, Maker<Condition>>>& table, const ConditionInput& in)
{
    std::vector<std::string> known;
    for (const auto& [name, make] : table) known.push_back(name);
    const std::string type = readWord(in.dict, "type", known);
    for (const auto& [name, make] : table)
        if (name == type) return make(in);
    failNotAvailable(in, type, known);
}

// ---- values

std::vector<double> faceScalars(const ConditionInput& in, const char* keyword)
{
    checkFieldEntry<scalar>(in.dict, keyword, in.patch.size(), "faces of the patch");
    const Foam::scalarField values(keyword, in.dict, in.patch.size());
    return std::vector<double>(values.begin(), values.end());
}

std::vector<double> inPlane(const SimplexMesh& mesh, const vector& v)
{
    std::vector<double> u(mesh.dim);
    for (int d = 0; d < mesh.dim; ++d) u[d] = v[mesh.axes[d]];
    return u;
}

std::vector<double> faceVectors(const ConditionInput& in, const char* keyword)
{
    checkFieldEntry<vector>(in.dict, keyword, in.patch.size(), "faces of the patch");
    const Foam::vectorField values(keyword, in.dict, in.patch.size());
    std::vector<double> result;
    for (const vector& v : values)
        for (double c : inPlane(in.adapter.mesh, v)) result.push_back(c);
    return result;
}

NodalValues constantValues(std::vector<double> values)
{
    return [values = std::move(values)](const BoundaryState&, std::vector<double>& out) { out = values; };
}

NodalValues nodalScalars(const ConditionInput& in, const char* keyword)
{
    return constantValues(averageToNodes(in.patch, in.adapter, in.halo, in.nodes->nodes, faceScalars(in, keyword), 1));
}

NodalValues uniformScalars(const ConditionInput& in, const char* keyword)
{
    return [f = timeFunction<scalar>(in.dict, keyword), n = in.nodes](const BoundaryState& state, std::vector<double>& out)
    { out.assign(n->nodes.size(), f->value(state.time)); };
}

// ---- velocity

VelocityCondition fixedVelocity(NodalValues values, std::vector<TimeJump> jumps = {}) { return {BoundaryPatch::Velocity::Fixed, std::move(values), {}, std::move(jumps)}; }

VelocityCondition noSlip(const ConditionInput& in)
{
    return fixedVelocity(constantValues(std::vector<double>(in.nodes->nodes.size()*in.adapter.mesh.dim, 0.0)));
}

VelocityCondition fixedValueVelocity(const ConditionInput& in)
{
    return fixedVelocity(constantValues(velocityAtNodes(in.patch, in.adapter, in.halo, *in.nodes, faceVectors(in, "value"))));
}

VelocityCondition uniformVelocity(const ConditionInput& in)
{
    const auto f = timeFunction<vector>(in.dict, "uniformValue");
    return fixedVelocity([f, n = in.nodes](const BoundaryState& state, std::vector<double>& out)
    {
        const auto u = inPlane(*n->mesh, f->value(state.time));
        out.clear();
        for (std::size_t i = 0; i < n->nodes.size(); ++i) out.insert(out.end(), u.begin(), u.end());
    }, tableJumps(*f));
}

VelocityCondition slip(const ConditionInput&) { return {BoundaryPatch::Velocity::Slip, {}, {}, {}}; }
VelocityCondition open(const ConditionInput&) { return {BoundaryPatch::Velocity::Open, {}, {}, {}}; }

/// Normal inflow `flow` through what solids leave of the patch, split over the nodes as `weight`; of the P1 flux `share` counts, as it does for the transport.
void distributeFlow(const PatchNodes& patch, const Halo& halo, double flow, const std::vector<double>& weight, const std::vector<double>& share,
    const Cover* cover, const std::string& name, std::vector<double>& out)
{
    const int dim = patch.mesh->dim;
    std::vector<double> outwards;
    for (std::size_t k = 0; k < patch.normal.size(); ++k) outwards.push_back(weight[k/dim]*patch.normal[k]);
    const double outflow = halo.sum(patch.outflow(outwards, share, cover));
    const double area = halo.sum(patch.area());
    out.assign(outwards.size(), 0.0);
    if (flow == 0) return;
    if (outflow < 1e-9*area)
        FatalErrorInFunction << "Patch " << name.c_str() << ": a flow rate of " << flow << " m^3/s is given but there is no part of the patch it could "
            << "pass: its nodes hold no liquid, or solids cover it." << Foam::nl
            << "    Set the phase field at the patch to 1 below the water level (setFields), or use flowRateInletVelocity." << Foam::exit(Foam::FatalError);
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = -flow/outflow*outwards[k];
}

VelocityCondition flowRateVelocity(const ConditionInput& in)
{
    if (in.dict.found("massFlowRate"))
        failIn(in.dict, "massFlowRate is not available: give volumetricFlowRate [m^3/s] (mass flow rate over density).");
    if (in.dict.getOrDefault<bool>("extrapolateProfile", false))
        failIn(in.dict, "extrapolateProfile yes is not available: the velocity is uniform over the patch. Remove the entry.");
    const auto f = timeFunction<scalar>(in.dict, "volumetricFlowRate");
    return fixedVelocity([f, n = in.nodes, &halo = in.halo,
        all = std::vector<double>(in.nodes->nodes.size(), 1.0), name = in.patch.name()](const BoundaryState& state, std::vector<double>& out)
        { distributeFlow(*n, halo, f->value(state.time), all, all, state.cover, name, out); }, tableJumps(*f));
}

/// Share of the inlet's velocity that the nodes of a patch have where `liquid` enters: all of it where a node or one that shares a face with it has a fifth of liquid, so that
/// the elements that the surface passes move as the liquid in them. Gas at rest there slows it down, in elements that count it to both nodes, and makes waves (docs/numerics, 2.8).
std::vector<double> shareOfVelocity(const PatchNodes& patch, const Halo& halo, const std::vector<double>& liquid)
{
    constexpr double enough = 0.2;
    std::vector<double> share = patch.largestAround(halo, liquid);
    for (double& s : share) s = std::min(1.0, s/enough);
    return share;
}

VelocityCondition variableHeightVelocity(const ConditionInput& in)
{
    const Foam::word alpha = in.dict.getOrDefault<Foam::word>("alpha", in.controls.alphaName);
    if (in.controls.alphaName.empty()) failIn(in.dict, "variableHeightFlowRateInletVelocity needs two fluids; use flowRateInletVelocity.");
    if (alpha != in.controls.alphaName)
        failIn(in.dict, text("Entry 'alpha' is ", alpha, "; the phase field of this case is ", in.controls.alphaName, "."));
    const auto f = timeFunction<scalar>(in.dict, "flowRate");
    const auto flow = [f](double time) { return f->value(time); };
    VelocityCondition condition = fixedVelocity([flow, n = in.nodes, &halo = in.halo, name = in.patch.name()](const BoundaryState& state, std::vector<double>& out)
    {
        std::vector<double> liquid; // the surface's nodes let gas in as well: what counts is the liquid
        for (std::size_t k = 0; k < n->nodes.size(); ++k) liquid.push_back(std::clamp(state.entering ? state.entering[k] : state.alpha[n->nodes[k]], 0.0, 1.0));
        distributeFlow(*n, halo, flow(state.time), shareOfVelocity(*n, halo, liquid), liquid, state.cover, name, out);
    }, tableJumps(*f));
    condition.liquidInflow = flow;
    return condition;
}

VelocityCondition pressureVelocity(const ConditionInput& in)
{
    if (in.dict.found("tangentialVelocity"))
        failIn(in.dict, "Entry 'tangentialVelocity' is not available: remove it, the velocity at the patch follows from the flow.");
    return open(in);
}

VelocityCondition inletOutletVelocity(const ConditionInput& in)
{
    for (double u : faceVectors(in, "inletValue"))
        if (u != 0)
            failIn(in.dict, "inletOutlet with an inletValue other than zero is not available for the velocity: use fixedValue where the fluid enters, "
                "or inletValue uniform (0 0 0).");
    return open(in);
}

const std::vector<std::pair<std::string, Maker<VelocityCondition>>>& velocityTable()
{
    static const std::vector<std::pair<std::string, Maker<VelocityCondition>>> table{
        {"fixedValue", fixedValueVelocity}, {"uniformFixedValue", uniformVelocity}, {"noSlip", noSlip}, {"movingWallVelocity", noSlip},
        {"slip", slip}, {"symmetry", slip}, {"symmetryPlane", slip}, {"flowRateInletVelocity", flowRateVelocity},
        {"variableHeightFlowRateInletVelocity", variableHeightVelocity}, {"zeroGradient", open}, {"inletOutlet", inletOutletVelocity},
        {"pressureInletOutletVelocity", pressureVelocity}, {"pressureInletVelocity", pressureVelocity}};
    return table;
}

// ---- pressure

/// values*scale + rho (g.x - ghRef) with the density that the fluid has there (traces of alpha weigh nothing: another one along the top would set the gas in
/// motion): p_rgh -> p. `isFull`: the values are p already.
NodalValues fullPressure(const ConditionInput& in, NodalValues values, bool isFull)
{
    const bool addGravity = !isFull && in.field == "p_rgh";
    std::vector<double> potential;
    for (int node : in.nodes->nodes) potential.push_back(addGravity ? gravityPotential(in.controls, in.adapter.mesh, node) : 0);
    return [values = std::move(values), potential, n = in.nodes, fluid = in.controls.fluid, numerics = in.controls.numerics,
               scale = in.scale](const BoundaryState& state, std::vector<double>& out)
    {
        values(state, out);
        for (std::size_t i = 0; i < out.size(); ++i)
        {
            out[i] = out[i]*scale + density(fluid, numerics, state.alpha[n->nodes[i]])*potential[i];
        }
    };
}

using Pressure = BoundaryPatch::Pressure;

PressureCondition naturalPressure(const ConditionInput&) { return {Pressure::Natural, {}}; }
PressureCondition fixedPressure(const ConditionInput& in) { return {Pressure::Fixed, fullPressure(in, nodalScalars(in, "value"), false)}; }
PressureCondition uniformPressure(const ConditionInput& in) { return {Pressure::Fixed, fullPressure(in, uniformScalars(in, "uniformValue"), false)}; }
PressureCondition totalPressure(const ConditionInput& in) { return {Pressure::Total, fullPressure(in, nodalScalars(in, "p0"), false)}; }
PressureCondition uniformTotal(const ConditionInput& in) { return {Pressure::Total, fullPressure(in, uniformScalars(in, "p0"), false)}; }
// the prgh conditions give the full pressure: p_rgh = p - rho (g.x - ghRef)
PressureCondition prghPressure(const ConditionInput& in) { return {Pressure::Fixed, fullPressure(in, nodalScalars(in, "p"), true)}; }
PressureCondition prghTotal(const ConditionInput& in) { return {Pressure::Total, fullPressure(in, nodalScalars(in, "p0"), true)}; }

const std::vector<std::pair<std::string, Maker<PressureCondition>>>& pressureTable(bool isModified)
{
    static const std::vector<std::pair<std::string, Maker<PressureCondition>>> common{
        {"fixedValue", fixedPressure}, {"uniformFixedValue", uniformPressure}, {"totalPressure", totalPressure}, {"uniformTotalPressure", uniformTotal},
        {"zeroGradient", naturalPressure}, {"fixedFluxPressure", naturalPressure}, {"slip", naturalPressure}, {"symmetry", naturalPressure},
        {"symmetryPlane", naturalPressure}};
    static const auto modified = []
    {
        auto table = common;
        table.insert(table.end(), {{"prghPressure", prghPressure}, {"prghTotalPressure", prghTotal}});
        return table;
    }();
    return isModified ? modified : common;
}

// ---- phase

using Phase = BoundaryPatch::Phase;

PhaseCondition naturalPhase(const ConditionInput&) { return {Phase::Natural, {}}; }

PhaseCondition inflowPhase(const ConditionInput& in, const char* keyword)
{
    const auto values = faceScalars(in, keyword); // read once: OpenFOAM hands a list of values out only once
    for (double a : values) checkRange(in.dict, keyword, a, {0, 1}, "A phase fraction: 1 liquid, 0 gas.");
    return {Phase::Inflow, constantValues(averageToNodes(in.patch, in.adapter, in.halo, in.nodes->nodes, values, 1))};
}
PhaseCondition fixedPhase(const ConditionInput& in) { return inflowPhase(in, "value"); }
PhaseCondition inletOutletPhase(const ConditionInput& in) { return inflowPhase(in, "inletValue"); }
PhaseCondition uniformPhase(const ConditionInput& in) { return {Phase::Inflow, uniformScalars(in, "uniformValue")}; }
PhaseCondition uniformInletOutletPhase(const ConditionInput& in) { return {Phase::Inflow, uniformScalars(in, "uniformInletValue")}; }

/// The phase an element inside the patch enters, values below/above the bounds as pure gas/liquid: the water level at the inlet is that of the stream inside. With the phase
/// of the patch's own nodes nothing would bring it back: they have no velocity along the patch by which the stream could raise or lower it. Not below the critical level of the flow
/// rate that enters: a faster stream knows nothing of the level inside, and would draw down for good.
PhaseCondition variableHeightPhase(const ConditionInput& in)
{
    const double lower = readNumber(in.dict, "lowerBound", {-1, 1}), upper = readNumber(in.dict, "upperBound", {0, 2});
    if (lower >= upper) failIn(in.dict, text("lowerBound ", lower, " must be below upperBound ", upper, "."));
    const auto inside = std::make_shared<const InnerPoints>(*in.nodes);     // refers to the nodes: both are kept
    const auto critical = in.controls.numerics.criticalInlet ? std::make_shared<const CriticalLevel>(*in.nodes, in.halo, in.controls.fluid.gravity) : nullptr;
    return {Phase::Inflow, [n = in.nodes, inside, critical, &halo = in.halo, lower, upper, name = in.patch.name(), isSaid = std::make_shared<bool>(false)](
        const BoundaryState& state, std::vector<double>& out)
    {
        out = inside->values(halo, state.alpha);
        for (double& a : out) a = a < lower ? 0.0 : a > upper ? 1.0 : a;
        if (!critical || !critical->raise(state.liquidInflow, state.cover, out) || *isSaid) return;
        *isSaid = true;
        Foam::Info << "Patch " << name << ": the stream inside is lower than the critical level of the " << state.liquidInflow << " m^3/s that enter, from " << state.time
            << " s on at least: they enter at that level. For a lower, faster stream: entry criticalInlet off, or its level as fixedValue (docs/dictionaries.md, Inflow)." << Foam::endl;
    }};
}

PhaseCondition contactAngle(const ConditionInput& in)
{
    const double theta = readNumber(in.dict, "theta0", {0, 180});
    if (theta != 90) failIn(in.dict, text("Contact angle theta0 ", theta, " is not modelled; allowed: 90 (the natural condition), as zeroGradient."));
    Foam::dlOpen("libtwoPhaseProperties.so", false); // of interFoam: OpenFOAM reads and writes the field by its own class of that name
    return naturalPhase(in);
}

const std::vector<std::pair<std::string, Maker<PhaseCondition>>>& phaseTable()
{
    static const std::vector<std::pair<std::string, Maker<PhaseCondition>>> table{
        {"zeroGradient", naturalPhase}, {"fixedValue", fixedPhase}, {"uniformFixedValue", uniformPhase}, {"inletOutlet", inletOutletPhase},
        {"uniformInletOutlet", uniformInletOutletPhase}, {"variableHeightFlowRate", variableHeightPhase}, {"constantAlphaContactAngle", contactAngle},
        {"slip", naturalPhase}, {"symmetry", naturalPhase}, {"symmetryPlane", naturalPhase}};
    return table;
}

} // namespace

VelocityCondition makeVelocityCondition(const ConditionInput& input) { return makeFrom(velocityTable(), input); }
PressureCondition makePressureCondition(const ConditionInput& input) { return makeFrom(pressureTable(input.field == "p_rgh"), input); }
PhaseCondition makePhaseCondition(const ConditionInput& input) { return makeFrom(phaseTable(), input); }

bool isNoSlipWall(const Foam::dictionary& dict, const Foam::polyPatch& patch)
{
    const Foam::word type = dict.getOrDefault<Foam::word>("type", "");
    if (type == "noSlip" || type == "movingWallVelocity") return true;
    if (type != "fixedValue") return false;
    if (patch.empty()) return true; // this rank has no say
    checkFieldEntry<vector>(dict, "value", patch.size(), "faces of the patch");
    // looked at without reading the field: OpenFOAM hands a list of values out only once
    Foam::ITstream& value = dict.lookup("value");
    if (value.size() < 2 || !value[0].isWord() || value[0].wordToken() != "uniform") return false;
    value.rewind();
    const Foam::token uniform(value);
    return vector(value) == vector::zero;
}

double gravityPotential(const CaseControls& controls, const SimplexMesh& mesh, int node)
{
    const auto x = mesh.spacePoint(node);
    const auto& g = controls.fluid.gravity;
    return g[0]*x[0] + g[1]*x[1] + g[2]*x[2] - controls.gravityPotentialRef;
}

} // namespace flotsam
