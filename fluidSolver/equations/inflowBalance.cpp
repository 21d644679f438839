// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/inflowBalance.hpp"

#include "core/patchFaces.hpp"
#include "equations/faceMoments.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace flotsam
{

namespace
{

constexpr double allowed = 0.01;    // of what enters and leaves: boundary values are given by faces, and solids cut them
constexpr double roundOff = 1e-9;   // of what would pass if the velocity were normal to the faces

/// Of the faces of patches: what enters, what leaves, what would pass at most [m^dim/s].
enum { In, Out, Most, nFlows };

/// Through the fluid part of a patch. velocity: nNodes*D.
template<int D>
void addFlow(const SimplexMesh& mesh, const MeshPatch& patch, const std::vector<double>& velocity, const Cover* cover, double* flows)
{
    for (std::size_t f = 0; f < patch.faceElement.size(); ++f)
    {
        if (!patch.isOwnedFace[f]) continue;
        const int* nodes = &patch.faceNodes[f*D];
        double area[D], flow = 0;
        outwardVector(mesh, patch, f, area);
        const FaceMoments<D> moments(mesh, cover, patch.faceElement[f], nodes);
        for (int a = 0; a < D; ++a)
        {
            double speed = 0, size = 0;
            for (int d = 0; d < D; ++d)
            {
                const double u = velocity[std::size_t(nodes[a])*D + d];
                flow += moments.first[a]*area[d]*u;
                speed += u*u;
                size += area[d]*area[d];
            }
            flows[Most] += moments.first[a]*std::sqrt(speed*size);
        }
        flows[flow > 0 ? Out : In] += std::abs(flow);
    }
}

} // namespace

bool needsInflowBalance(const std::vector<BoundaryPatch>& patches)
{
    const auto isOne = [&](BoundaryPatch::Velocity kind) { return std::any_of(patches.begin(), patches.end(), [&](const BoundaryPatch& p) { return p.velocity == kind; }); };
    return isOne(BoundaryPatch::Velocity::Fixed) && !isOne(BoundaryPatch::Velocity::Open);
}

void checkInflowBalance(const SimplexMesh& mesh, const Halo& halo, const std::vector<BoundaryPatch>& patches, const std::vector<PatchValues>& values, const Cover* cover)
{
    double flow[nFlows] = {};
    std::string names;
    std::vector<double> velocity(std::size_t(mesh.nNodes)*mesh.dim, 0.0);
    for (std::size_t p = 0; p < patches.size(); ++p)
    {
        if (patches[p].velocity != BoundaryPatch::Velocity::Fixed || values[p].velocity.empty()) continue;
        names += (names.empty() ? "" : ", ") + patches[p].name;
        for (std::size_t k = 0; k < patches[p].nodes.size(); ++k)
            for (int d = 0; d < mesh.dim; ++d) velocity[std::size_t(patches[p].nodes[k])*mesh.dim + d] = values[p].velocity[k*mesh.dim + d];
        const MeshPatch& faces = mesh.patches[patches[p].meshPatch];
        mesh.dim == 2 ? addFlow<2>(mesh, faces, velocity, cover, flow) : addFlow<3>(mesh, faces, velocity, cover, flow);
        for (std::size_t k = 0; k < patches[p].nodes.size(); ++k)
            for (int d = 0; d < mesh.dim; ++d) velocity[std::size_t(patches[p].nodes[k])*mesh.dim + d] = 0;
    }
    halo.sum(flow, nFlows);
    if (std::abs(flow[In] - flow[Out]) <= allowed*(flow[In] + flow[Out]) + roundOff*flow[Most]) return;
    std::ostringstream message;
    message << "the patches with a given velocity (" << names << ") bring in " << flow[In]*mesh.thickness << " m^3/s and take out " << flow[Out]*mesh.thickness
            << " m^3/s, and no other patch lets fluid through: the fluids are incompressible. Give one patch a pressure and an open velocity (0/p_rgh totalPressure or"
               " fixedValue with 0/U pressureInletOutletVelocity or zeroGradient), or prescribe velocities that balance";
    throw std::invalid_argument(message.str());
}

} // namespace flotsam
