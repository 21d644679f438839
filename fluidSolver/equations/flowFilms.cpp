// SPDX-License-Identifier: GPL-3.0-or-later
/// What flows along a wall under a body that lies on it.
///
/// The cut leaves a film there (WallFilm) that has a pressure but carries hardly anything: its inertia would hold the body down, and by far the largest mass in the
/// scene would then push against the contact. Beds and logs are not that smooth. So an unresolved layer, a part of an element thick, lets fluid in and out in
/// proportion to the gradient of pressure and weight: Reynolds' equation, with the speed that the gradient gives in the time T = sqrt(h/g). It fades as the gap
/// grows to one element, which the cut carries.
#include "core/patchFaces.hpp"
#include "equations/flowEquation.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace flotsam
{

namespace
{

double difference(const SimplexMesh& mesh, int a, int b, int d)
{
    return mesh.x[std::size_t(a)*mesh.dim + d] - mesh.x[std::size_t(b)*mesh.dim + d];
}

/// - int grad N_k.grad N_l over a face of `area`, its nodes being `nodes`; obtuse angles let nothing through.
template<int D>
double stiffness(const SimplexMesh& mesh, const int* nodes, double area, int k, int l)
{
    if constexpr (D == 2) return 1/area;
    double product = 0;
    const int opposite = nodes[3 - k - l];
    for (int d = 0; d < D; ++d) product += difference(mesh, nodes[k], opposite, d)*difference(mesh, nodes[l], opposite, d);
    return std::max(0.0, product/(4*area));
}

} // namespace

/// In which the gradient of pressure and weight makes a layer's speed: sqrt(h/g), a few steps at least [s].
double FlowEquation::layerTime(double height) const
{
    constexpr double fewestSteps = 4;
    const double g = std::hypot(fluid_.gravity[0], fluid_.gravity[1], fluid_.gravity[2]);
    return std::max(g > 0 ? std::sqrt(height/g) : 0, fewestSteps*step_.time.dt);
}

/// Nodes under bodies, before the elements are assembled.
void FlowEquation::findFilms()
{
    nodal_.film.clear();
    if (!step_.cover || step_.cover->filmNodes.empty()) return;
    nodal_.film.resize(mesh_.nNodes);
    for (const FilmNode& film : step_.cover->filmNodes) nodal_.film[film.node] = std::max(nodal_.film[film.node], film.share);
}

/// Between two nodes of a wall. force: gravity of the element behind the face [N/m^3].
template<int D>
void FlowEquation::addFilm(int a, int b, double conductance, const double* force)
{
    double hydrostatic = 0;
    for (int d = 0; d < D; ++d) hydrostatic += force[d]*difference(mesh_, a, b, d);
    films_.push_back({a, b, conductance, hydrostatic});
    addConductance<D>(a, b, conductance, hydrostatic);
}

/// Volume flux from node a to b: conductance (p_a - p_b - hydrostatic), into the continuity rows of both.
template<int D>
void FlowEquation::addConductance(int a, int b, double conductance, double hydrostatic)
{
    constexpr int B = D + 1;
    for (const auto& [i, j, sign] : {std::tuple(a, b, 1), std::tuple(b, a, -1)})
    {
        if (i >= mesh_.nOwned) continue;
        const int own = graph_.diagonal[i], other = graph_.find(i, j);
        for (double* entries : {system_.matrix.pressure.data(), system_.schur.data()})
        {
            entries[own] += conductance;
            entries[other] -= conductance;
        }
        system_.rhs[std::size_t(i)*B + D] += sign*conductance*hydrostatic;
    }
}

/// One face of a wall, the element behind it being e.
template<int D>
void FlowEquation::addFilmFace(const MeshPatch& patch, std::size_t f)
{
    const int* nodes = &patch.faceNodes[f*D];
    const int e = patch.faceElement[f], *corners = &mesh_.elements[std::size_t(e)*(D + 1)];
    if (std::none_of(corners, corners + D + 1, [&](int i) { return i < mesh_.nOwned; })) return;
    double share = 0, rho = 0, v[3], area = 0;
    for (int k = 0; k < D; ++k) { share += nodal_.film[nodes[k]]/D; rho += nodal_.rho[nodes[k]]/D; }
    if (share == 0 || step_.cover->state[e] == ElementState::Solid) return;
    outwardVector(mesh_, patch, f, v);
    for (int d = 0; d < D; ++d) area += v[d]*v[d];
    area = std::sqrt(area);
    const double height = D*mesh_.volume[e]/area;
    const double conductance = share*layerThickness*height*layerTime(height)/rho;
    for (int k = 0; k < D; ++k)
        for (int l = k + 1; l < D; ++l)
            if (const double s = stiffness<D>(mesh_, nodes, area, k, l); s > 0)
                addFilm<D>(nodes[k], nodes[l], conductance*s, &(*step_.elementForce)[std::size_t(e)*D]);
}

template<int D>
void FlowEquation::assembleFilms()
{
    films_.clear();
    if (nodal_.film.empty()) return;
    for (const MeshPatch& patch : mesh_.patches)
        for (std::size_t f = 0; f < patch.faceElement.size() && patch.type == "wall"; ++f) addFilmFace<D>(patch, f);
}

template void FlowEquation::addConductance<2>(int, int, double, double);
template void FlowEquation::addConductance<3>(int, int, double, double);
template void FlowEquation::assembleFilms<2>();
template void FlowEquation::assembleFilms<3>();

} // namespace flotsam
