// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/caseCheck.H"

#include "equations/inflowBalance.hpp"
#include "foam/boundaryReader.H"
#include "foam/dictionaryChecks.H"
#include "foam/patchNodes.H"
#include "foam/startReport.H"
#include "geometry/shape.hpp"
#include "io/runLog.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flotsam
{

namespace
{

struct MeshCounts { long nodes = 0, elements = 0, largestShare = 0; double hMin = 0, hMax = 0; };

MeshCounts count(const SimplexMesh& mesh, const Halo& halo)
{
    MeshCounts counts;
    long owned = 0;
    double hMin = 1e300, hMax = 0;
    for (int e = 0; e < mesh.nElements; ++e)
    {
        owned += mesh.isOwnedElement[e];
        hMin = std::min(hMin, mesh.h[e]);
        hMax = std::max(hMax, mesh.h[e]);
    }
    counts.nodes = static_cast<long>(mesh.nGlobal);
    counts.elements = halo.sum(owned);
    counts.largestShare = static_cast<long>(halo.max(static_cast<double>(mesh.nOwned)));
    counts.hMin = halo.min(hMin);
    counts.hMax = halo.max(hMax);
    return counts;
}

void line(const char* what, const std::string& value)
{
    std::string s = text("  ", what);
    s.resize(std::max<std::size_t>(s.size(), 22), ' ');
    Foam::Info << s.c_str() << value.c_str() << Foam::nl;
}

/// An oil has it, and water whose dynamic viscosity was given as nu: said, as a warning would be wrong for every oil.
std::string thickness(const FluidProperties& f)
{
    constexpr double ofWater = 1e-3, thick = 10;     // [Pa s]
    return f.muLiquid >= thick*ofWater ? text(" (", std::round(f.muLiquid/ofWater), " times water's: nu ", f.muLiquid/f.rhoLiquid, " m^2/s)") : "";
}

std::string fluidLine(const CaseControls& controls)
{
    const FluidProperties& f = controls.fluid;
    return f.isTwoPhase ? text("two, ", controls.liquidName, " rho ", f.rhoLiquid, " mu ", f.muLiquid, thickness(f), ", gas rho ", f.rhoGas, " mu ", f.muGas)
                        : text("one, rho ", f.rhoLiquid, " mu ", f.muLiquid, " (no phase field)");
}

std::string bodiesLine(const SceneCounts& scene)
{
    if (scene.bodies == 0) return "none (DEM engine not opened)";
    const std::string toCome = scene.bodiesToCome > 0 ? text(" (", scene.bodiesToCome, " come in at their release)") : "";
    return text(scene.bodies, " free", toCome, ", ", scene.demSpheres, " DEM spheres, ", scene.walls, " DEM walls");
}

std::string structuresLine(const SceneCounts& scene)
{
    if (scene.fixedStructures + scene.movingStructures == 0) return "none";
    return text(scene.fixedStructures, " fixed, ", scene.movingStructures, " moving",
        scene.bodies + scene.movingStructures == 0 ? " (mesh cut once)" : "");
}

void printCost(const MeshCounts& counts, const SimplexMesh& mesh, const SceneCounts& scene, const CostModel& cost, int ranks)
{
    const double bytes = mesh.dim == 2 ? cost.bytesPerNode2d : cost.bytesPerNode3d;
    const double micro = mesh.dim == 2 ? cost.microsecondsPerNode2d : cost.microsecondsPerNode3d;
    const double seconds = 1e-6*(micro*counts.largestShare + cost.microsecondsPerSphere*scene.demSpheres);
    const double all = cost.bytesPerRank*ranks + bytes*counts.nodes + cost.bytesPerSphere*scene.demSpheres;
    line("memory", text("about ", std::ceil(all/1e6), " MB on ", ranks, ranks > 1 ? " ranks" : " rank"));
    line("time per step", text("about ", std::round(seconds*1000)/1000, " s (estimate for one core per rank)"));
}

constexpr double furthestOfBodies = 2;   // elements in a step
constexpr double roundOff = 1e-6;   // of gravity's direction

double strength(const std::array<double, 3>& g) { return std::hypot(g[0], g[1], g[2]); }

/// Part of gravity that acts along the empty direction of a 2D mesh.
double across(const std::array<double, 3>& g, const SimplexMesh& mesh) { return mesh.dim == 2 ? std::abs(g[mesh.axes[2]]) : 0; }

/// What is no error, but seldom meant; empty: nothing.
std::string gravityWarning(const FluidProperties& fluid, const SimplexMesh& mesh)
{
    const auto& g = fluid.gravity;
    if (strength(g) == 0) return fluid.isTwoPhase ? "constant/g is (0 0 0): nothing keeps the lighter fluid above" : "";
    for (const auto& [unit, factor] : {std::pair("cm", 100), std::pair("mm", 1000)})
        if (std::abs(strength(g) - 9.81*factor) < 0.005*9.81*factor) return text("constant/g has ", strength(g), " m/s^2, which is the earth's gravity in ", unit, "/s^2. Units are SI, lengths in m");
    for (const double factor : {0.1, 10.0})
        if (std::abs(strength(g) - 9.81*factor) < 0.005*9.81*factor) return text("constant/g has ", strength(g), " m/s^2, ", factor, " times the earth's: is the decimal point where it belongs?");
    if (across(g, mesh) > roundOff*strength(g))
        return text("gravity acts along ", "xyz"[mesh.axes[2]], ", across this 2D mesh: that part does nothing. Give constant/g in the plane of the mesh");
    return "";
}

bool isOpenWall(const BoundaryPatch& patch, const SimplexMesh& mesh)
{
    return patch.velocity == BoundaryPatch::Velocity::Open && patch.meshPatch >= 0 && mesh.patches[patch.meshPatch].type == "wall";
}

/// Entries of the wall law that have nothing to act on; empty: none.
std::string idleWallLaw(const NumericsControls& numerics, const std::vector<BoundaryPatch>& boundary)
{
    if (numerics.wallRoughness > 0 && !numerics.wallLaw)
        return text("wallRoughness ", numerics.wallRoughness, " m does nothing: it is that of the wall law, which is off. Set wallLaw on in `flotsam`");
    const bool hasNoSlip = std::any_of(boundary.begin(), boundary.end(), [](const BoundaryPatch& p) { return p.velocity == BoundaryPatch::Velocity::NoSlip; });
    return numerics.wallLaw && !hasNoSlip ? "wallLaw on does nothing: it is that of no-slip patches, and there are none (structures of constant/bodies do not have it)" : "";
}

/// Blocked to the fluid, and bodies go through it: a bed that blockMeshDict has as type patch.
bool isWallToFluidAlone(const BoundaryPatch& patch, const SimplexMesh& mesh)
{
    return (patch.isWall() || patch.isNoSlipWall) && !patch.stopsBodies && patch.meshPatch >= 0 && mesh.patches[patch.meshPatch].type == "patch";
}

/// Area and box of a patch: faces that are in another patch than meant are seen there. Collective.
std::string extent(const BoundaryPatch& patch, const SimplexMesh& mesh, const Halo& halo)
{
    const double area = halo.sum(makePatchNodes(mesh, halo, mesh.patches[patch.meshPatch]).area());
    if (area == 0) return "no faces";
    Vec3 low = Vec3::Constant(-1e300), high = low;
    for (const int node : patch.nodes)
    {
        const auto x = mesh.spacePoint(node);
        for (int d = 0; d < 3; ++d)
        {
            low[d] = std::max(low[d], -x[d]);
            high[d] = std::max(high[d], x[d]);
        }
    }
    for (int d = 0; d < 3; ++d)
    {
        low[d] = -halo.max(low[d]);
        high[d] = halo.max(high[d]);
    }
    const double least = 1e-9*(high - low).norm();     // shorter is round-off of a coordinate that is 0
    const auto round = [least](double x) { return std::abs(x) < least ? 0 : x; };
    const auto point = [&](const Vec3& x) { return text('(', round(x[0]), ' ', round(x[1]), ' ', round(x[2]), ')'); };
    return text(area, " m^2 from ", point(low), " to ", point(high));
}

} // namespace

void checkGravity(const FluidProperties& fluid, const SimplexMesh& mesh)
{
    const auto& g = fluid.gravity;
    const double inPlane = mesh.dim == 2 ? std::hypot(g[mesh.axes[0]], g[mesh.axes[1]]) : strength(g);
    if (!fluid.isTwoPhase || across(g, mesh) == 0 || inPlane > roundOff*strength(g)) return;
    std::array<double, 3> meant{};
    meant[mesh.axes[2] == 1 ? 2 : 1] = -strength(g);
    failOnAll(text("constant/g is (", g[0], ' ', g[1], ' ', g[2], "), along ", "xyz"[mesh.axes[2]], ", the empty direction of this 2D mesh: there would be no gravity, and nothing to keep the lighter"
        " fluid above.\n    Give it in the plane of the mesh, for instance (", meant[0], ' ', meant[1], ' ', meant[2], "); where none is meant (0 0 0)."));
}

std::vector<std::string> doubtfulSteps(const TimeControls& time)
{
    std::vector<std::string> doubts;
    if (!time.adjustTimeStep) return doubts;    // deltaT is seen while the run goes on
    if (time.maxCo > RunLog::largeCourant)
        doubts.push_back(text("maxCo ", time.maxCo, " of system/controlDict lets the water cross ", time.maxCo, " elements in a step: a dam break with more than ", RunLog::largeCourant,
            " is wrong by a tenth and more (docs/resolution.md). The default is ", TimeControls().maxCo));
    if (time.maxBodyCo > furthestOfBodies)
        doubts.push_back(text("maxBodyCo ", time.maxBodyCo, " of system/controlDict lets a body cross ", time.maxBodyCo, " elements in a step, behind which it leaves what it has not pushed aside. The default is ", TimeControls().maxBodyCo));
    return doubts;
}

std::string doubtfulLevel(const CaseControls& controls, const SimplexMesh& mesh, const Halo& halo)
{
    const auto& g = controls.fluid.gravity;
    if (strength(g) == 0) return "";
    double low = 1e300, high = -1e300;  // heights of the mesh
    for (int node = 0; node < mesh.nNodes; ++node)
    {
        const auto x = mesh.spacePoint(node);
        const double height = -(g[0]*x[0] + g[1]*x[1] + g[2]*x[2])/strength(g);
        low = std::min(low, height);
        high = std::max(high, height);
    }
    low = 0 - halo.max(-low);   // no -0
    high = halo.max(high);
    const double level = -controls.gravityPotentialRef/strength(g), range = high - low;
    if (level >= low - range && level <= high + range) return "";
    return text("constant/hRef is ", level, " m, and the mesh reaches from ", low, " to ", high, " m in height: where p_rgh is prescribed water presses as from that level. Lengths are in m");
}

std::string describe(const TimeControls& time)
{
    if (!time.adjustTimeStep) return text("fixed, ", time.deltaT, " s");
    return text("adaptive, from ", time.deltaT, " s; maxCo ", time.maxCo, ", bodies ", time.maxBodyCo,
        time.maxDeltaT < 1e29 ? text(", at most ", time.maxDeltaT, " s") : "");
}

void printCaseCheck(const CaseControls& controls, const MeshAdapter& adapter, const Halo& halo, const std::vector<BoundaryPatch>& boundary,
    const SceneCounts& scene, const CostModel& cost)
{
    const SimplexMesh& mesh = adapter.mesh;
    const MeshCounts counts = count(mesh, halo);
    Foam::Info << "What will be solved" << Foam::nl;
    line("mesh", text(mesh.dim == 2 ? "2D triangles, " : "3D tetrahedra, ", counts.nodes, " nodes, ", counts.elements, " elements, element length ",
        counts.hMin, " to ", counts.hMax, " m"));
    line("fluids", fluidLine(controls));
    const auto& g = controls.fluid.gravity;
    line("gravity", text("(", g[0], " ", g[1], " ", g[2], ") m/s^2"));
    const std::string gravity = gravityWarning(controls.fluid, mesh);
    if (!gravity.empty()) line("warning", gravity);
    for (const std::string& doubt : doubtfulFluids(controls)) line("warning", doubt);
    line("structures", structuresLine(scene));
    line("bodies", bodiesLine(scene));
    if (const std::string level = doubtfulLevel(controls, mesh, halo); !level.empty()) line("warning", level);
    line("time step", describe(controls.time));
    for (const std::string& doubt : doubtfulSteps(controls.time)) line("warning", doubt);
    const std::string changed = changedNumerics(controls.numerics);
    line("numerics", text(changed.empty() ? "all entries of `flotsam` have their defaults" : "defaults, but " + changed, "; solvers, PIMPLE (pRefValue excepted) and fvSchemes are not used"));
    if (const std::string idle = idleWallLaw(controls.numerics, boundary); !idle.empty()) line("warning", idle);
    for (const auto& patch : boundary) line("patch", text(describe(patch, controls.fluid.isTwoPhase), "; ", extent(patch, mesh, halo)));
    for (const auto& patch : boundary)
        if (isOpenWall(patch, mesh)) line("warning", text("patch ", patch.name, " is of type wall, but its U lets fluid through. Give it noSlip or slip; in 2D the front and back are of type empty"));
    for (const auto& patch : boundary)
        if (scene.bodies > 0 && !scene.areWallsChosen && isWallToFluidAlone(patch, mesh))
            line("warning", text("bodies pass through patch ", patch.name, ", which lets no fluid through: it is of type patch. Make it one of type wall (constant/polyMesh/boundary), or say"
                " in constant/bodies which patches stop bodies: wallPatches (names);"));
    const bool hasLevel = std::any_of(boundary.begin(), boundary.end(), [](const BoundaryPatch& b) { return b.pressure != BoundaryPatch::Pressure::Natural; });
    if (!hasLevel) line("pressure level", text("none prescribed: in every basin mean in the gas (without gas: of all) pRefValue ", controls.fluid.pRefValue));
    if (scene.thinnestLinearBody > 0 && scene.thinnestLinearBody < counts.hMin)
        line("warning", text("the thinnest body with an STL shape of many faces (", scene.thinnestLinearBody, " m) is thinner than the smallest elements (", counts.hMin, " m): where no node of the mesh lies inside of it the fluid does not see it,"
            " and it sinks. Refine around the bodies, to 3 elements if you can, or take boxes, cylinders, capsules, spheres or unions of these, which float however thin they are"));
    else if (scene.bodies > 0 && scene.thinnestBody < 3*counts.hMin)
        line("warning", text("the thinnest body (", scene.thinnestBody, " m) spans less than 3 of the smallest elements (", counts.hMin, " m): refine around the bodies"));
    printCost(counts, mesh, scene, cost, halo.size());
    Foam::Info << Foam::endl;
}

void checkInflow(const MeshAdapter& adapter, const Halo& halo, const std::vector<BoundaryPatch>& patches, const FlowState& state, const Cover* cover, double time)
{
    if (!needsInflowBalance(patches)) return;
    std::vector<PatchValues> values(patches.size());
    for (std::size_t p = 0; p < patches.size(); ++p)
        if (patches[p].evaluate) patches[p].evaluate({time, state.u.data(), state.alpha.data(), cover}, values[p]);
    checkInflowBalance(adapter.mesh, halo, patches, values, cover);
}

} // namespace flotsam
