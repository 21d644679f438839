// SPDX-License-Identifier: GPL-3.0-or-later
/// What walls of the mesh hold weakly: no-slip patches the tangential velocity, patches at re-entrant edges, whose nodes have no normal, the normal one too.
/// Zero velocity at the nodes would make the layer at an unresolved wall one element thick, which holds a front back that runs along it; held weakly, the
/// fluid there slips by what its own shear allows and sticks where the layer is resolved (Bazilevs & Hughes 2007, doi 10.1016/j.compfluid.2005.07.012).
///
/// A stream leaves a sharp edge along the wall that it comes along (Kutta's condition): at the edge the wall that the fluid runs into holds it, the one that it
/// comes away from does not. Were both to hold it alike, a jet would cling to the wall behind the edge.
#include "core/patchFaces.hpp"
#include "equations/elementLoader.hpp"
#include "equations/faceMoments.hpp"
#include "equations/flowEquation.hpp"
#include "equations/wallLaw.hpp"
#include "equations/wallTerms.hpp"

#include <cmath>

namespace flotsam
{

namespace
{

/// Pa s/m, factor of the normal velocities' product. outflow: velocity into the wall, mean over the face [m/s]. At rest as every wall holds it.
template<int D>
double edgeHold(const ElementData<D>& e, double held, double h, double dt, double outflow)
{
    if (outflow == 0) return held;
    return outflow > 0 ? e.rho*(h/dt + std::sqrt(squared<D>(e.advection))) : 0;
}

} // namespace

/// Pa s/m, factor of the tangential velocities' product on a no-slip patch. speed: along the wall, mean over the face [m/s]; height: of the element over it [m].
template<int D>
double tangentialHold(const ElementData<D>& e, const NumericsControls& controls, double speed, double height)
{
    const double reynolds = e.rho*speed*height/e.mu;
    const double gamma = controls.nitscheGamma + std::max(0.0, controls.wallGamma - controls.nitscheGamma)/(1 + reynolds/20);
    double hold = gamma*e.mu/height;
    if (controls.wallLaw && speed > 0)
    {
        const double u = velocityOverFriction(reynolds/2, e.rho*speed*controls.wallRoughness/e.mu);
        hold = std::max(hold, e.rho*speed/(u*u));
    }
    return hold;
}

/// The terms of a wall (wallTerms.hpp) on every face of a no-slip patch, and of a slip patch where it has a node of a re-entrant edge. At other nodes the
/// normal velocity is prescribed and its terms vanish. No volume passes through the face: the continuity rows lose int q u.n.
template<int D>
void FlowEquation::assemblePatchWalls()
{
    for (const BoundaryPatch& patch : patches_)
    {
        if (!patch.isWall()) continue;
        const bool isSlip = patch.velocity == BoundaryPatch::Velocity::Slip;
        const MeshPatch& faces = mesh_.patches[patch.meshPatch];
        for (std::size_t f = 0; f < faces.faceElement.size(); ++f)
        {
            const int* nodes = &faces.faceNodes[f*D];
            const bool hasEdge = std::any_of(nodes, nodes + D, [&](int i) { return isSlipEdge_[i]; });
            if ((!isSlip || hasEdge) && faces.faceElement[f] < mesh_.nInnerElements) addWallFace<D>(faces, f, isSlip, hasEdge);
        }
    }
}

template<int D>
void FlowEquation::addWallFace(const MeshPatch& faces, std::size_t f, bool isSlip, bool hasEdge)
{
    constexpr int N = D + 1, B = D + 1;
    ElementData<D> data;
    const int e = faces.faceElement[f];
    if (!loadElement<D>(e, data)) return;
    const int* nodes = &mesh_.elements[std::size_t(e)*N];
    double normal[3], mean[D] = {}, area = 0, outflow = 0;
    outwardVector(mesh_, faces, f, normal);
    for (int d = 0; d < D; ++d) area += normal[d]*normal[d];
    area = std::sqrt(area);
    for (int d = 0; d < D; ++d) normal[d] /= area;
    const FaceMoments<D> moments(step_.cover, &faces.faceNodes[f*D]);
    int corner[D];  // of the element, for each of the face's nodes
    for (int k = 0; k < D; ++k)
    {
        corner[k] = int(std::find(nodes, nodes + N, faces.faceNodes[f*D + k]) - nodes);
        for (int d = 0; d < D; ++d) mean[d] += moments.first[k]*nodal_.advection[std::size_t(nodes[corner[k]])*D + d];
    }
    for (int d = 0; d < D; ++d) outflow += mean[d]*normal[d];
    double first[N] = {}, second[N*N] = {};
    for (int k = 0; k < D; ++k)
    {
        first[corner[k]] = area*moments.first[k];
        for (int l = 0; l < D; ++l) second[corner[k]*N + corner[l]] = area*moments.second[k*D + l];
    }
    const double height = D*mesh_.volume[e]/area, dt = step_.time.dt;   // of the element over the face: of a layer of stretched elements, not their mean size
    WallCoefficients c = nitscheCoefficients(data, isSlip, controls_.nitscheGamma, mesh_.h[e], dt, 0);  // no volume passes: nothing flows in
    if (!isSlip) c.tangential = tangentialHold(data, controls_, std::sqrt(std::max(0.0, squared<D>(mean) - outflow*outflow)), height);
    c.normal = hasEdge ? edgeHold(data, c.normal, mesh_.h[e], dt, outflow) : 0;
    const WallTerms<D> terms(c, normal, data.gradN);
    double m[B*B];
    for (int a = 0; a < N; ++a)
    {
        if (nodes[a] >= mesh_.nOwned) continue;
        for (int b = 0; b < N; ++b)
        {
            terms.block(a, b, first[a], first[b], second[a*N + b], second[a*N + b], m);
            system_.matrix.add<D>(graph_.slot(nodes[a], (std::size_t(e)*N + a)*N + b), m);
        }
    }
}

template void FlowEquation::assemblePatchWalls<2>();
template void FlowEquation::assemblePatchWalls<3>();

} // namespace flotsam
