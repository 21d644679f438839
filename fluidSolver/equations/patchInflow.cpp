// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/patchInflow.hpp"

#include "core/patchFaces.hpp"
#include "equations/faceMoments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flotsam
{

namespace
{

/// Flows through the fluid part of a face; inflow: the velocity into the mesh times the face's area at its nodes, entering, standing: alpha there.
template<int D>
void addFace(const FaceMoments<D>& moments, const double* inflow, const double* entering, const double* standing, double* flows)
{
    for (int a = 0; a < D; ++a)
    {
        flows[0] += moments.first[a]*inflow[a];
        for (int b = 0; b < D; ++b)
        {
            flows[1] += moments.second[a*D + b]*inflow[a]*entering[b];
            flows[2] += moments.second[a*D + b]*std::max(inflow[a], 0.0)*std::max(standing[b] - entering[b], 0.0);
        }
    }
}

/// Nodes of the patch are ascending.
std::size_t placeIn(const BoundaryPatch& patch, int node) { return std::lower_bound(patch.nodes.begin(), patch.nodes.end(), node) - patch.nodes.begin(); }

template<int D>
void addPatch(const SimplexMesh& mesh, const BoundaryPatch& patch, const PatchValues& values, const FlowState& state, const Cover* cover, double* flows)
{
    const MeshPatch& faces = mesh.patches[patch.meshPatch];
    for (std::size_t f = 0; f < faces.faceElement.size(); ++f)
    {
        if (!faces.isOwnedFace[f]) continue;
        const int* nodes = &faces.faceNodes[f*D];
        double area[D], inflow[D], entering[D], standing[D];
        outwardVector(mesh, faces, f, area);
        for (int a = 0; a < D; ++a)
        {
            const std::size_t k = placeIn(patch, nodes[a]);
            inflow[a] = 0;
            for (int d = 0; d < D; ++d) inflow[a] -= area[d]*values.velocity[k*D + d];
            standing[a] = state.alpha.empty() ? 1.0 : std::clamp(state.alpha[nodes[a]], 0.0, 1.0);
            entering[a] = values.alpha.empty() || inflow[a] < 0 ? standing[a] : values.alpha[k];
        }
        addFace<D>(FaceMoments<D>(mesh, cover, faces.faceElement[f], nodes), inflow, entering, standing, flows);
    }
}

/// Values of a patch whose nodes all hold that phase.
PatchValues valuesIn(double phase, const SimplexMesh& mesh, const BoundaryPatch& patch, double time)
{
    const std::vector<double> alpha(mesh.nNodes, phase), rest(std::size_t(mesh.nNodes)*mesh.dim, 0.0);
    PatchValues values;
    patch.evaluate({time, rest.data(), alpha.data()}, values);
    return values;
}

/// No gas stands at the patch now (a culvert's end, an opening below the level). Collective.
bool isBelowLevel(const Halo& halo, const BoundaryPatch& patch, const std::vector<double>& alpha)
{
    return !halo.any(std::any_of(patch.nodes.begin(), patch.nodes.end(), [&](int node) { return alpha.empty() || alpha[node] < 0.5; }));
}

double heightOf(const SimplexMesh& mesh, int node, const std::array<double, 3>& gravity, double strength)
{
    double z = 0;
    for (int d = 0; d < mesh.dim; ++d) z -= gravity[mesh.axes[d]]*mesh.x[std::size_t(node)*mesh.dim + d]/strength;
    return z;
}

bool givesPressure(const BoundaryPatch& patch) { return patch.pressure != BoundaryPatch::Pressure::Natural && patch.evaluate; }

} // namespace

PatchInflow prescribedInflow(const SimplexMesh& mesh, const Halo& halo, const BoundaryPatch& patch, const PatchValues& values, const FlowState& state, const Cover* cover)
{
    double flows[3] = {};
    mesh.dim == 2 ? addPatch<2>(mesh, patch, values, state, cover, flows) : addPatch<3>(mesh, patch, values, state, cover, flows);
    halo.sum(flows, 3);
    return {flows[0]*mesh.thickness, flows[1]*mesh.thickness, flows[2]*mesh.thickness};
}

std::vector<double> outsideLevels(const SimplexMesh& mesh, const Halo& halo, const std::vector<BoundaryPatch>& patches, const FluidProperties& fluid, double time)
{
    const auto& g = fluid.gravity;
    const double strength = std::hypot(g[0], g[1], g[2]), none = -std::numeric_limits<double>::infinity();
    // A condition that adds the weight of what is there (p_rgh) has p = base + density*potential, others have the base alone.
    std::vector<std::vector<double>> base(patches.size()), potential(patches.size());
    double lowest = std::numeric_limits<double>::max();
    for (std::size_t p = 0; p < patches.size(); ++p)
    {
        if (!givesPressure(patches[p])) continue;
        const std::vector<double> liquid = valuesIn(1, mesh, patches[p], time).pressure, gas = valuesIn(0, mesh, patches[p], time).pressure;
        for (std::size_t k = 0; k < liquid.size(); ++k)
        {
            potential[p].push_back((liquid[k] - gas[k])/(fluid.rhoLiquid - fluid.rhoGas));
            base[p].push_back(liquid[k] - fluid.rhoLiquid*potential[p].back());
            lowest = std::min(lowest, base[p].back());
        }
    }
    lowest = halo.min(lowest);
    std::vector<double> levels;
    for (std::size_t p = 0; p < patches.size(); ++p)
    {
        double level = none;
        for (std::size_t k = 0; k < base[p].size(); ++k)
        {
            const double head = (potential[p][k] + (base[p][k] - lowest)/fluid.rhoLiquid)/strength, z = heightOf(mesh, patches[p].nodes[k], g, strength);
            if (head > 1e-9*std::max(1.0, std::abs(z))) level = std::max(level, z + head);
        }
        levels.push_back(halo.max(level));
    }
    return levels;
}

GasPressures gasPressures(const SimplexMesh& mesh, const Halo& halo, const std::vector<BoundaryPatch>& patches, const FluidProperties& fluid,
    const std::vector<double>& alpha, double time)
{
    const auto& g = fluid.gravity;
    const double strength = std::hypot(g[0], g[1], g[2]), weight = fluid.rhoGas*strength;
    constexpr double far = std::numeric_limits<double>::max();
    double least = far, most = -far, bottom = far, top = -far;
    for (const BoundaryPatch& patch : patches)
    {
        for (int node : patch.nodes)
        {
            bottom = std::min(bottom, heightOf(mesh, node, g, strength));
            top = std::max(top, heightOf(mesh, node, g, strength));
        }
        if (!givesPressure(patch) || isBelowLevel(halo, patch, alpha)) continue;
        const PatchValues gas = valuesIn(0, mesh, patch, time);
        for (std::size_t k = 0; k < gas.pressure.size(); ++k)
        {
            if (!gas.alpha.empty() && gas.alpha[k] > 0.5) continue; // liquid enters there
            const double overRest = gas.pressure[k] + weight*heightOf(mesh, patch.nodes[k], g, strength);
            least = std::min(least, overRest);
            most = std::max(most, overRest);
        }
    }
    least = halo.min(least);
    most = halo.max(most);
    bottom = halo.min(bottom);
    top = halo.max(top);
    return {most > least ? most - least : 0, weight*(top - bottom)};
}

} // namespace flotsam
