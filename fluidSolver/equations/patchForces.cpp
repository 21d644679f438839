// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/patchForces.hpp"

#include "core/patchFaces.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace flotsam
{

namespace
{

/// Of the sum of n n over the patches at a node: directions below are those in which patches of nearly one direction differ (37 degrees between two).
constexpr double leastEigenvalue = 0.2;
constexpr double sameNormal = 0.9;  // cosine from which two faces of a patch are one wall, as in SlipNormals

/// Inverse of a sum of n n on the directions that count.
Eigen::Matrix3d inverseOnDirections(const Eigen::Matrix3d& sum)
{
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(sum);
    Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
    for (int k = 0; k < 3; ++k)
        if (eigen.eigenvalues()[k] > leastEigenvalue) inverse += eigen.eigenvectors().col(k)*eigen.eigenvectors().col(k).transpose()/eigen.eigenvalues()[k];
    return inverse;
}

} // namespace

PatchForces::PatchForces(const SimplexMesh& mesh, const Halo& halo, const std::vector<BoundaryPatch>& patches, const std::vector<int>& asked)
:   mesh_(mesh), halo_(halo), patches_(patches), isAsked_(patches.size(), 0), place_(mesh.nNodes, -1), result_(patches.size())
{
    for (int p : asked) isAsked_[p] = 1;
    findNodes();
}

/// Nodes of the asked patches, and all patches there that prescribe a velocity.
void PatchForces::findNodes()
{
    const int dim = mesh_.dim;
    for (std::size_t p = 0; p < patches_.size(); ++p)
        for (int i : mesh_.patches[patches_[p].meshPatch].faceNodes)
            if (isAsked_[p] && place_[i] < 0)
            {
                place_[i] = int(node_.size());
                node_.push_back(i);
            }
    std::vector<std::vector<Share>> at(node_.size());
    for (std::size_t p = 0; p < patches_.size(); ++p)
    {
        if (patches_[p].velocity == BoundaryPatch::Velocity::Open) continue;
        const MeshPatch& faces = mesh_.patches[patches_[p].meshPatch];
        for (std::size_t k = 0; k < faces.faceNodes.size(); ++k)
        {
            const int place = place_[faces.faceNodes[k]];
            if (place < 0) continue;
            Vec3 v = Vec3::Zero();
            outwardVector(mesh_, faces, k/dim, v.data());
            addToShares(int(p), v/dim, at[place]);
        }
    }
    first_.push_back(0);
    for (std::vector<Share>& shares : at)
    {
        for (Share& share : shares) share.normal.normalize();
        shares_.insert(shares_.end(), shares.begin(), shares.end());
        first_.push_back(int(shares_.size()));
    }
}

/// area: of a face at the node, out of the mesh.
void PatchForces::addToShares(int patch, const Vec3& area, std::vector<Share>& shares)
{
    const auto isSame = [&](const Share& s) { return s.patch == patch && s.normal.dot(area) > sameNormal*s.normal.norm()*area.norm(); };
    const auto found = std::find_if(shares.begin(), shares.end(), isSame);
    if (found == shares.end()) return shares.push_back({patch, area, area.norm(), Vec3::Zero()});
    found->normal += area;
    found->size += area.norm();
}

void PatchForces::start()
{
    for (Share& s : shares_) s.traction.setZero();
    reaction_.assign(node_.size()*mesh_.dim, 0.0);
    std::fill(result_.begin(), result_.end(), PatchForce());
}

Vec3 PatchForces::toSpace(const double* f) const
{
    Vec3 result = Vec3::Zero();
    for (int d = 0; d < mesh_.dim; ++d) result[mesh_.axes[d]] = mesh_.thickness*f[d];
    return result;
}

void PatchForces::add(int patch, int node, const double* pressure, const double* friction)
{
    if (!isAsked_[patch]) return;
    const std::array<double, 3> x = mesh_.spacePoint(node);
    const auto to = [&](const double* f, Vec3& force, Vec3& moment)
    {
        Vec3 turning = Vec3(x[0], x[1], x[2]).cross(toSpace(f));
        for (int d = 0; d < 2 && mesh_.dim == 2; ++d) turning[mesh_.axes[d]] = 0;
        force += toSpace(f);
        moment += turning;
    };
    PatchForce& result = result_[patch];
    to(pressure, result.pressure, result.pressureMoment);
    if (friction) to(friction, result.friction, result.frictionMoment);
}

void PatchForces::addFace(int patch, int node, const double* f, const double* normal)
{
    double along = 0, pressure[3], friction[3];
    for (int d = 0; d < mesh_.dim; ++d) along += f[d]*normal[d];
    for (int d = 0; d < mesh_.dim; ++d)
    {
        pressure[d] = along*normal[d];
        friction[d] = f[d] - pressure[d];
    }
    add(patch, node, pressure, friction);
}

void PatchForces::addTraction(int patch, int node, const double* f)
{
    int k = first_[place_[node]];
    while (shares_[k].patch != patch) ++k;  // any of the patch's
    for (int d = 0; d < mesh_.dim; ++d) shares_[k].traction[d] += f[d];
}

void PatchForces::addReaction(int node, const double* f)
{
    for (int d = 0; d < mesh_.dim; ++d) reaction_[std::size_t(place_[node])*mesh_.dim + d] += f[d];
}

void PatchForces::addAtEdge(int edge, int node, const double* f)
{
    if (place_[edge] >= 0) shareOut(place_[edge], node, f);
}

void PatchForces::addFacet(int patch, int element, const double* first, const double* normal)
{
    for (int a = 0; a <= mesh_.dim; ++a)
    {
        double f[3];
        for (int d = 0; d < mesh_.dim; ++d) f[d] = first[a]*normal[d];
        add(patch, mesh_.elements[std::size_t(element)*(mesh_.dim + 1) + a], f, nullptr);
    }
}

/// Each patch has the part along its normal, patches of nearly one direction by their areas; what is along no normal is friction, of patches that prescribe the whole velocity.
void PatchForces::shareOut(int place, int node, const double* f)
{
    const int dim = mesh_.dim;
    Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
    Vec3 left = Vec3::Zero();
    double size = 0, fixedSize = 0;
    for (int d = 0; d < dim; ++d) left[d] = f[d];
    for (int k = first_[place]; k < first_[place + 1]; ++k)
    {
        normals += shares_[k].normal*shares_[k].normal.transpose();
        size += shares_[k].size;
        if (patches_[shares_[k].patch].velocity == BoundaryPatch::Velocity::Fixed) fixedSize += shares_[k].size;
    }
    const Vec3 direction = inverseOnDirections(normals)*left;
    for (int k = first_[place]; k < first_[place + 1]; ++k) left -= direction.dot(shares_[k].normal)*shares_[k].normal;
    for (int k = first_[place]; k < first_[place + 1]; ++k)
    {
        const Share& s = shares_[k];
        const bool isFixed = patches_[s.patch].velocity == BoundaryPatch::Velocity::Fixed;
        Vec3 pressure = direction.dot(s.normal)*s.normal, friction = Vec3::Zero();
        if (fixedSize == 0) pressure += s.size/size*left;
        else if (isFixed) friction = s.size/fixedSize*left;
        add(s.patch, node, pressure.data(), friction.data());
    }
}

void PatchForces::finish()
{
    const int dim = mesh_.dim;
    for (std::size_t place = 0; place < node_.size(); ++place)
    {
        if (node_[place] >= mesh_.nOwned) continue;
        double* left = &reaction_[place*dim];
        for (int k = first_[place]; k < first_[place + 1]; ++k)
        {
            add(shares_[k].patch, node_[place], shares_[k].traction.data(), nullptr);
            for (int d = 0; d < dim; ++d) left[d] -= shares_[k].traction[d];
        }
        shareOut(int(place), node_[place], left);
    }
    for (PatchForce& r : result_)
    {
        double sums[12];
        for (int d = 0; d < 3; ++d)
        {
            sums[d] = r.pressure[d];
            sums[3 + d] = r.friction[d];
            sums[6 + d] = r.pressureMoment[d];
            sums[9 + d] = r.frictionMoment[d];
        }
        halo_.sum(sums, 12);
        r = {Vec3(sums), Vec3(sums + 3), Vec3(sums + 6), Vec3(sums + 9)};
    }
}

} // namespace flotsam
