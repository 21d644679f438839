// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/eddyViscosity.hpp"

#include "geometry/patchDistance.hpp"

#include <cmath>

namespace flotsam
{

namespace
{

constexpr double kappa = 0.41;
constexpr double outer = 2./3;      // of the depth, where y sqrt(1 - y/H) is largest
constexpr double unknown = -1;
constexpr int rings = 4;            // of nodes, over which the surface is spread

double mixingLength(double y, double depth)
{
    const double share = std::min(y/depth, outer);
    return kappa*share*depth*std::sqrt(1 - share);
}

std::vector<int> noSlipPatches(const std::vector<BoundaryPatch>& patches)
{
    std::vector<int> found;
    for (const BoundaryPatch& p : patches)
        if (p.velocity == BoundaryPatch::Velocity::NoSlip) found.push_back(p.meshPatch);
    return found;
}

/// |S| = sqrt(2 S:S) of du_k/dx_l at k*dim + l.
double shearRate(const double* gradient, int dim)
{
    double sum = 0;
    for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l)
        {
            const double s = 0.5*(gradient[k*dim + l] + gradient[l*dim + k]);
            sum += 2*s*s;
        }
    return std::sqrt(sum);
}

} // namespace

double dampedEddyViscosity(double mixingLength, double y, double shear, double nu)
{
    constexpr double thickness = 26;    // of the damped layer, y+
    constexpr int nIterations = 8;      // from above; the error falls by about half in each (0.53 at y+ = 20): 0.6 % of the stress is left at most
    const double whole = mixingLength*mixingLength*shear;
    double eddy = whole;
    for (int k = 0; k < nIterations; ++k)
    {
        const double friction = std::sqrt((nu + eddy)*shear), factor = 1 - std::exp(-friction*y/(thickness*nu));
        eddy = whole*factor*factor;
    }
    return eddy;
}

EddyViscosity::EddyViscosity(const SimplexMesh& mesh, const Halo& halo, const std::vector<BoundaryPatch>& patches, const NumericsControls& controls)
:   mesh_(mesh), halo_(halo), depth_(controls.mixingDepth), isSmooth_(controls.wallRoughness == 0), gradients_(mesh, halo),
    distance_(distanceFromPatches(mesh, halo, noSlipPatches(patches), outer*controls.mixingDepth)), eddy_(mesh.nNodes), sum_(mesh.nNodes), count_(mesh.nNodes)
{}

void EddyViscosity::add(const Cover* cover, NodalData& nodal)
{
    gradients_.find(nodal.advection, cover);
    for (int i = 0; i < mesh_.nNodes; ++i)
        eddy_[i] = nodal.fluid[i] == NodalData::Liquid ? ofLiquid(i, nodal.mu[i]/nodal.rho[i], cover) : unknown;
    for (int ring = 0; ring < rings; ++ring) extend();
    nodal.eddy.resize(mesh_.nNodes);
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        nodal.eddy[i] = nodal.rho[i]*std::max(0.0, eddy_[i]);
        nodal.mu[i] += nodal.eddy[i];
    }
}

double EddyViscosity::ofLiquid(int node, double nu, const Cover* cover) const
{
    const double y = cover ? std::min(distance_[node], std::max(0.0, cover->distance[node])) : distance_[node];
    const double length = mixingLength(y, depth_), shear = shearRate(gradients_.at(node), mesh_.dim);
    return isSmooth_ ? dampedEddyViscosity(length, y, shear, nu) : length*length*shear;
}

/// One ring of nodes on: means of the neighbours that have one.
void EddyViscosity::extend()
{
    const int n = mesh_.dim + 1;
    std::fill(sum_.begin(), sum_.end(), 0.0);
    std::fill(count_.begin(), count_.end(), 0.0);
    for (int e = 0; e < mesh_.nInnerElements; ++e)
    {
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        for (int a = 0; a < n; ++a)
            for (int b = 0; b < n && eddy_[nodes[a]] == unknown; ++b)
                if (eddy_[nodes[b]] != unknown)
                {
                    sum_[nodes[a]] += eddy_[nodes[b]];
                    ++count_[nodes[a]];
                }
    }
    for (int i = 0; i < mesh_.nOwned; ++i)
        if (count_[i] > 0) eddy_[i] = sum_[i]/count_[i];
    halo_.update(eddy_, 1);
}

} // namespace flotsam
