// SPDX-License-Identifier: GPL-3.0-or-later
/// Ghost penalty: jumps of the normal derivatives across faces of cut elements (docs/numerics.md, section 3).
#include "equations/elementLoader.hpp"
#include "equations/flowEquation.hpp"
#include "equations/shutPockets.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

/// Share of the inertial ghost penalties that a face needs: none between elements of which half or more is fluid, all beside vanishing cuts. The nodes of
/// larger parts are held by the flow itself, and what the penalty takes from a flow along a round wall is drag (docs/numerics.md). The viscous penalty stays
/// whole: there it improves the stress.
double ghostWeight(const SimplexMesh& mesh, const Cover& cover, const InteriorFace& face)
{
    const auto share = [&](int e) { return fluidVolume(mesh, &cover, e)/mesh.volume[e]; };
    const double lack = std::max(0.0, 1 - 2*std::min(share(face.element[0]), share(face.element[1])));
    return lack*lack;   // smooth where it vanishes: moving bodies feel no kink
}

/// The same in whatever order the nodes are: another process may have the face the other way round.
bool hasOneDensity(const std::vector<double>& rho, const int* nodes, int n)
{
    const auto [least, most] = std::minmax_element(nodes, nodes + n, [&](int i, int j) { return rho[i] < rho[j]; });
    return rho[*most] - rho[*least] < 1e-6*rho[*least];
}

/// The face's nodes, then the two opposite ones.
template<int D>
void setNodes(const int* elements, const InteriorFace& face, GhostTerm& term)
{
    int n = 0;
    for (int a = 0; a <= D; ++a)
    {
        const int i = elements[std::size_t(face.element[0])*(D + 1) + a];
        if (i != face.opposite[0]) term.node[n++] = i;
    }
    term.node[n] = face.opposite[0];
    term.node[n + 1] = face.opposite[1];
}

/// One side's part of the jumps; sign: 1 or -1. force: of the element [N/m^3], or null.
template<int D>
void addSide(double sign, const int* nodes, const ElementData<D>& side, const double* normal, const double* force, GhostTerm& term)
{
    for (int a = 0; a <= D; ++a)
    {
        const int k = int(std::find(term.node, term.node + D + 2, nodes[a]) - term.node);
        double gn = 0;
        for (int d = 0; d < D; ++d) gn += side.gradN[a*D + d]*normal[d];
        term.jumpVelocity[k] += sign*gn;
        term.jumpPressure[k] += sign*gn/side.rho;
    }
    double fn = 0;
    for (int d = 0; d < D && force; ++d) fn += force[d]*normal[d];
    term.pressureSource += sign*fn/side.rho;
}

/// Of the mean of the two sides' advection velocities [m/s].
template<int D>
double meanSpeed(const ElementData<D>* side)
{
    double squared = 0;
    for (int d = 0; d < D; ++d)
    {
        const double mean = 0.5*(side[0].advection[d] + side[1].advection[d]);
        squared += mean*mean;
    }
    return std::sqrt(squared);
}

} // namespace

template<int D>
void FlowEquation::assembleGhosts()
{
    constexpr int N = D + 1;
    system_.ghosts.clear();
    if (!step_.cover) return;
    const auto nodesOf = [&](int e) { return &mesh_.elements[std::size_t(e)*N]; };
    const auto hasOwned = [&](int e) { return std::any_of(nodesOf(e), nodesOf(e) + N, [&](int i) { return i < mesh_.nOwned; }); };
    ElementData<D> side[2];
    for (const GhostFace& face : step_.cover->ghostFaces)
    {
        const InteriorFace& f = graph_.faces[face.face];
        if (!hasOwned(f.element[0]) && !hasOwned(f.element[1])) continue;
        GhostTerm term{};
        setNodes<D>(mesh_.elements.data(), f, term);
        for (int s = 0; s < 2; ++s)
        {
            loadElement<D>(f.element[s], side[s]);
            const double* force = step_.elementForce ? &(*step_.elementForce)[std::size_t(f.element[s])*D] : nullptr;
            addSide(s == 0 ? 1 : -1, nodesOf(f.element[s]), side[s], face.normal, force, term);
        }
        const double speed = meanSpeed<D>(side);
        const double h = 0.5*(mesh_.h[f.element[0]] + mesh_.h[f.element[1]]);
        const double mu = 0.5*(side[0].mu + side[1].mu), rho = 0.5*(side[0].rho + side[1].rho);
        const double lighter = std::min(side[0].rho, side[1].rho);
        // at the water line all of it: it levels surfaces that would come to rest aslant beside a body
        const double weight = hasOneDensity(nodal_.rho, term.node, D + 2) ? ghostWeight(mesh_, *step_.cover, f) : 1;
        term.velocityFactor = face.area*(controls_.ghostVelocity*mu*h + weight*controls_.ghostConvection*rho*speed*h*h);
        // a pocket's pressure is that of fluid elsewhere: its gradient says nothing
        const bool isOfPocket = step_.pockets && std::any_of(term.node, term.node + D + 2, [&](int i) { return step_.pockets->isNode(i); });
        term.pressureFactor = isOfPocket ? 0 : weight*face.area*controls_.ghostPressure*h*h*h*lighter*lighter
            /(std::min(side[0].mu, side[1].mu) + lighter*(speed*h + h*h/step_.time.dt));
        system_.ghosts.push_back(term);
    }
}

void FlowEquation::ghostFluxes(const std::vector<double>& x, std::vector<PairFlux>& result) const
{
    const int n = mesh_.dim + 2, B = mesh_.dim + 1;
    result.clear();
    for (const GhostTerm& g : system_.ghosts)
    {
        if (g.pressureFactor == 0) continue;
        double jump = -g.pressureSource;
        for (int j = 0; j < n; ++j) jump += g.jumpPressure[j]*x[std::size_t(g.node[j])*B + B - 1];
        const double f = g.pressureFactor*jump;
        for (int j = 0; j < n; ++j)
            for (int k = j + 1; k < n; ++k)
                result.push_back({g.node[j], g.node[k], f*(g.jumpPressure[j] - g.jumpPressure[k])/n});
    }
    for (const FilmPair& f : films_)
        result.push_back({f.a, f.b, f.conductance*(x[std::size_t(f.a)*B + B - 1] - x[std::size_t(f.b)*B + B - 1] - f.hydrostatic)});
}

template void FlowEquation::assembleGhosts<2>();
template void FlowEquation::assembleGhosts<3>();

} // namespace flotsam
