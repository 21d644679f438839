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
#include "equations/patchForces.hpp"
#include "equations/wallLaw.hpp"
#include "equations/wallTerms.hpp"

#include <cmath>

namespace flotsam
{

namespace
{

/// With the wall law below a profile that the elements have: by the velocity at the element's centroid, centreSpeed, which the layer below moves; the wall's own slips by what
/// the lowest element cannot show of the profile.
template<int D>
void holdByProfile(const ElementData<D>& e, const NumericsControls& controls, double speed, double centreSpeed, double height, WallCoefficients& c)
{
    constexpr double leastSlip = 0.1;   // share of the velocity above: less is next to none
    const double reynolds = centreSpeed*e.rho/e.molecular, u = velocityOverFriction(reynolds*height/(D + 1), reynolds*controls.wallRoughness);
    if (u > 0) c.tangential = std::max(c.tangential, e.rho*centreSpeed*centreSpeed/(u*u*std::max(speed, leastSlip*centreSpeed)));
}

/// Coefficients of the tangential velocity on a no-slip patch. speed: along the wall, mean over the face; centreSpeed: that of the element [m/s]; height: of the element over it [m].
/// Where the elements resolve the layer the form is symmetric, and the fluid above the wall does not feel that the wall slips a little; it needs a gamma above 2 D.
/// Where they do not, less must hold: what is held there is taken from fluid whose layer is far thinner than the element; the non-symmetric form is stable with it,
/// and in elements that a solid cuts, of which any small part may lie on the wall.
template<int D>
void holdTangentially(const ElementData<D>& e, const NumericsControls& controls, double speed, double centreSpeed, double height, bool isCut, WallCoefficients& c)
{
    constexpr double sublayer = 20;     // Reynolds number of an element's height: about where the viscous sublayer ends, y+ u+ = 25
    const double reynolds = e.rho*speed*height/e.molecular, resolved = isCut ? 0 : 1/(1 + reynolds*reynolds/(sublayer*sublayer));
    const double gamma = controls.nitscheGamma + std::max(0.0, controls.wallGamma - controls.nitscheGamma)*resolved;
    c.adjoint = 1 - 2*resolved;
    c.tangential = gamma*e.molecular/height;
    if (!controls.wallLaw || speed <= 0) return;
    if (controls.mixingDepth > 0) return holdByProfile(e, controls, speed, centreSpeed, height, c);
    const double u = velocityOverFriction(reynolds/2, e.rho*speed*controls.wallRoughness/e.molecular);  // in the middle of the element
    c.tangential = std::max(c.tangential, e.rho*speed/(u*u));
}

/// A face of a wall as its element sees it.
template<int D>
struct WallFace
{
    double normal[3];                       ///< out of the mesh
    double area = 0, height;                ///< [m^(D-1)]; of the element over it [m]
    double first[D + 1] = {}, second[(D + 1)*(D + 1)] = {};    ///< int N_a, int N_a N_b over the fluid part, by the element's corners
    double outflow = 0, speed = 0;          ///< velocity into the wall and along it, means over the face [m/s]
    double centreSpeed = 0;                 ///< along the wall, at the element's centroid [m/s]

    WallFace(const SimplexMesh& mesh, const Cover* cover, const MeshPatch& faces, std::size_t f, const std::vector<double>& velocity)
    {
        const int e = faces.faceElement[f], *face = &faces.faceNodes[f*D], *nodes = &mesh.elements[std::size_t(e)*(D + 1)];
        outwardVector(mesh, faces, f, normal);
        area = std::sqrt(squared<D>(normal));
        for (int d = 0; d < D; ++d) normal[d] /= area;
        height = D*mesh.volume[e]/area;
        const FaceMoments<D> moments(mesh, cover, e, face);
        double mean[D] = {};
        int corner[D];
        for (int k = 0; k < D; ++k)
        {
            corner[k] = int(std::find(nodes, nodes + D + 1, face[k]) - nodes);
            for (int d = 0; d < D; ++d) mean[d] += moments.first[k]*velocity[std::size_t(face[k])*D + d];
        }
        outflow = intoWall(mean);
        speed = alongWall(mean);
        double centre[D] = {};
        for (int a = 0; a <= D; ++a)
            for (int d = 0; d < D; ++d) centre[d] += velocity[std::size_t(nodes[a])*D + d]/(D + 1);
        centreSpeed = alongWall(centre);
        for (int k = 0; k < D; ++k)
        {
            first[corner[k]] = area*moments.first[k];
            for (int l = 0; l < D; ++l) second[corner[k]*(D + 1) + corner[l]] = area*moments.second[k*D + l];
        }
    }

private:
    double intoWall(const double* u) const
    {
        double sum = 0;
        for (int d = 0; d < D; ++d) sum += u[d]*normal[d];
        return sum;
    }
    double alongWall(const double* u) const
    {
        const double into = intoWall(u);
        return std::sqrt(std::max(0.0, squared<D>(u) - into*into));
    }
};

} // namespace

/// The terms of a wall (wallTerms.hpp) on every face of a no-slip patch, and of a slip patch where it has a node of a re-entrant edge or of a bend. At other
/// nodes the normal velocity is prescribed and its terms vanish; at a bend that of the faces' mean normal is, and what is left of it passes each of them: without its
/// terms hydrostatic pressure pushes fluid along the bend. No volume passes through the face: the continuity rows lose int q u.n.
template<int D>
void FlowEquation::assemblePatchWalls()
{
    for (const BoundaryPatch& patch : patches_)
    {
        if (!patch.isWall()) continue;
        const MeshPatch& faces = mesh_.patches[patch.meshPatch];
        for (std::size_t f = 0; f < faces.faceElement.size(); ++f)
            if (hasWallTerms(patch, f) && faces.faceElement[f] < mesh_.nInnerElements) addWallFace<D>(patch, f);
    }
}

bool FlowEquation::hasWallTerms(const BoundaryPatch& patch, std::size_t f) const
{
    if (!patch.isWall()) return false;
    const int* nodes = &mesh_.patches[patch.meshPatch].faceNodes[f*mesh_.dim];
    return patch.velocity == BoundaryPatch::Velocity::NoSlip || std::any_of(nodes, nodes + mesh_.dim, [&](int i) { return isSlipEdge_[i] || isSlipBend_[i]; });
}

/// Passes use(a, b, block, normal) the terms of a face: rows of the owned corners a of its element, columns of all its corners b.
template<int D, class Use>
void FlowEquation::forWallFace(const BoundaryPatch& patch, std::size_t f, const Use& use) const
{
    constexpr int N = D + 1, B = D + 1;
    ElementData<D> data;
    const MeshPatch& faces = mesh_.patches[patch.meshPatch];
    const int e = faces.faceElement[f], *ofFace = &faces.faceNodes[f*D];
    if (!loadElement<D>(e, data)) return;
    const bool isSlip = patch.velocity == BoundaryPatch::Velocity::Slip, hasEdge = std::any_of(ofFace, ofFace + D, [&](int i) { return isSlipEdge_[i]; });
    const int* nodes = &mesh_.elements[std::size_t(e)*N];
    const WallFace<D> face(mesh_, step_.cover, faces, f, nodal_.advection);
    WallCoefficients c = nitscheCoefficients(data, isSlip, controls_.nitscheGamma, mesh_.h[e], penaltyRateOf(e), 0);   // no volume passes: nothing flows in
    if (!hasEdge || face.outflow < 0) c.normal = 0;
    if (!isSlip) holdTangentially(data, controls_, face.speed, face.centreSpeed, face.height, step_.cover && step_.cover->state[e] == ElementState::Cut, c);
    const WallTerms<D> terms(c, face.normal, data.gradN);
    double m[B*B];
    for (int a = 0; a < N; ++a)
    {
        if (nodes[a] >= mesh_.nOwned) continue;
        for (int b = 0; b < N; ++b)
        {
            const double m2 = face.second[a*N + b];
            terms.block(a, b, face.first[a], face.first[b], m2, m2, m);
            use(a, b, m, face.normal);
        }
    }
}

template<int D>
void FlowEquation::addWallFace(const BoundaryPatch& patch, std::size_t f)
{
    constexpr int N = D + 1;
    const std::size_t e = mesh_.patches[patch.meshPatch].faceElement[f];
    const int* nodes = &mesh_.elements[e*N];
    forWallFace<D>(patch, f, [&](int a, int b, const double* m, const double*) { system_.matrix.add<D>(graph_.slot(nodes[a], (e*N + a)*N + b), m); });
}

/// What the terms of a face come to: the force on the wall, by the rows that feel it.
template<int D>
void FlowEquation::addFaceForce(int p, std::size_t f, const std::vector<double>& x, PatchForces& forces) const
{
    constexpr int N = D + 1, B = D + 1;
    const int* nodes = &mesh_.elements[std::size_t(mesh_.patches[patches_[p].meshPatch].faceElement[f])*N];
    double force[N][D] = {}, normal[D] = {};
    forWallFace<D>(patches_[p], f, [&](int a, int b, const double* m, const double* ofFace)
    {
        std::copy_n(ofFace, D, normal);
        addMomentumRows<D>(m, &x[std::size_t(nodes[b])*B], force[a]);
    });
    for (int a = 0; a < N; ++a) forces.addFace(p, nodes[a], force[a], normal);
}

template void FlowEquation::assemblePatchWalls<2>();
template void FlowEquation::assemblePatchWalls<3>();
template void FlowEquation::addFaceForce<2>(int, std::size_t, const std::vector<double>&, PatchForces&) const;
template void FlowEquation::addFaceForce<3>(int, std::size_t, const std::vector<double>&, PatchForces&) const;

} // namespace flotsam
