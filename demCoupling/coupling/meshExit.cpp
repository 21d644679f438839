// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/meshExit.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

constexpr double infinite = 1e300;

/// In the plane of the mesh.
struct Box
{
    double lower[3], upper[3];

    double squaredDistance(const double* x, int dim) const
    {
        double sum = 0;
        for (int d = 0; d < dim; ++d)
        {
            const double outside = std::max({0.0, lower[d] - x[d], x[d] - upper[d]});
            sum += outside*outside;
        }
        return sum;
    }
};

Box boxOf(const SimplexMesh& mesh, int element)
{
    Box box;
    std::fill_n(box.lower, 3, infinite);
    std::fill_n(box.upper, 3, -infinite);
    for (int a = 0; a <= mesh.dim; ++a)
        for (int d = 0; d < mesh.dim; ++d)
        {
            const double x = mesh.x[std::size_t(mesh.elements[std::size_t(element)*(mesh.dim + 1) + a])*mesh.dim + d];
            box.lower[d] = std::min(box.lower[d], x);
            box.upper[d] = std::max(box.upper[d], x);
        }
    return box;
}

} // namespace

MeshExit::MeshExit(const SimplexMesh& mesh, const Halo& halo, const std::vector<BodyDefinition>& bodies, const Vec3& gravity)
:   mesh_(mesh), halo_(halo), bodies_(bodies)
{
    for (const BodyDefinition& body : bodies) extents_.push_back(outerRadius(body));
    double strongest = 0;
    for (int d = 0; d < mesh.dim; ++d)
    {
        const double g = gravity[mesh.axes[d]];
        if (!(std::abs(g) > strongest)) continue;
        strongest = std::abs(g);
        up_ = d;
        upSign_ = g < 0 ? 1 : -1;
    }
}

std::vector<char> MeshExit::findOutside(const std::vector<BodyState>& states, const std::vector<char>& mayBe) const
{
    std::vector<double> isNear(bodies_.size(), 0);
    if (std::none_of(mayBe.begin(), mayBe.end(), [](char c) { return c != 0; })) return mayBe;
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        if (mayBe[b]) isNear[b] = isNearElement(b, states[b]);
    halo_.sum(isNear.data(), int(isNear.size()));
    std::vector<char> isOutside(mayBe);
    for (std::size_t b = 0; b < bodies_.size(); ++b) isOutside[b] = mayBe[b] && isNear[b] == 0;
    return isOutside;
}

bool MeshExit::isNearElement(std::size_t b, const BodyState& state) const
{
    const auto inPlane = [this](const Vec3& x, double* y) { for (int d = 0; d < mesh_.dim; ++d) y[d] = x[mesh_.axes[d]]; };
    double centre[3], x[3];
    inPlane(state.pose.position, centre);
    const Eigen::Matrix3d R = state.pose.orientation.toRotationMatrix();
    for (int e = 0; e < mesh_.nElements; ++e)
    {
        if (!mesh_.isOwnedElement[e]) continue;
        Box box = boxOf(mesh_, e);
        if (up_ >= 0) (upSign_ > 0 ? box.upper : box.lower)[up_] = upSign_*infinite;
        if (box.squaredDistance(centre, mesh_.dim) > extents_[b]*extents_[b]) continue;
        for (const SurfaceSphere& s : bodies_[b].spheres)
        {
            inPlane(state.pose.position + R*s.centre, x);
            if (box.squaredDistance(x, mesh_.dim) <= s.radius*s.radius) return true;
        }
    }
    return false;
}

} // namespace flotsam
