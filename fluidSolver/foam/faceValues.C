// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/faceValues.H"

#include "SubField.H"
#include "polyPatch.H"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace flotsam
{

namespace
{

using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

/// Of a vector per face in space, such as its centre: what lies in the mesh's plane.
std::vector<double> inPlane(const SimplexMesh& mesh, const Foam::vectorField& values)
{
    std::vector<double> result;
    for (const Foam::vector& v : values)
        for (int d = 0; d < mesh.dim; ++d) result.push_back(v[mesh.axes[d]]);
    return result;
}

Eigen::Map<const Vector> at(const std::vector<double>& values, int k, int dim) { return {&values[static_cast<std::size_t>(k)*dim], dim}; }

/// What along the patch leads from its node k to `to`.
Vector alongPatch(const PatchNodes& nodes, int k, const Vector& to)
{
    const auto normal = at(nodes.normal, k, nodes.mesh->dim);
    return to - to.dot(normal)*normal;
}

/// Least squares of the averages' differences between neighbours: sums over the faces around a node of d d^T and d (difference)^T, dim*dim each. Sums over faces do not
/// depend on the decomposition.
std::vector<double> differenceSums(const Foam::polyPatch& patch, const MeshAdapter& adapter, const Halo& halo, const PatchNodes& nodes,
    const std::vector<double>& mean, const std::vector<double>& centre)
{
    const int dim = adapter.mesh.dim, width = 2*dim*dim;
    const auto position = [&](int node) { return int(std::lower_bound(nodes.nodes.begin(), nodes.nodes.end(), node) - nodes.nodes.begin()); };
    std::vector<double> sums(static_cast<std::size_t>(adapter.mesh.nNodes)*width, 0.0);
    for (const Foam::face& face : patch)
        for (const Foam::label from : face)
        {
            const int node = adapter.pointNode[from], k = position(node);
            double* s = &sums[static_cast<std::size_t>(node)*width];
            Eigen::Map<Eigen::MatrixXd> ofPlaces(s, dim, dim), ofValues(s + dim*dim, dim, dim);
            for (const Foam::label to : face)
            {
                const int l = position(adapter.pointNode[to]);
                const Vector d = alongPatch(nodes, k, at(centre, l, dim) - at(centre, k, dim));
                ofPlaces += d*d.transpose();
                ofValues += d*(at(mean, l, dim) - at(mean, k, dim)).transpose();
            }
        }
    halo.sumToOwners(sums, width);
    return sums;
}

/// M^-1 b of a positive matrix; where it has no rank, in directions in which the patch is one face wide, zero.
Vector solveWithin(const Matrix& m, const Vector& b)
{
    constexpr double rank = 1e-8;   // square of the largest aspect ratio of faces that still counts
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(m);
    Vector x = Vector::Zero(b.size());
    for (int k = 0; k < b.size(); ++k)
        if (eigen.eigenvalues()[k] > rank*eigen.eigenvalues().maxCoeff()) x += eigen.eigenvectors().col(k).dot(b)/eigen.eigenvalues()[k]*eigen.eigenvectors().col(k);
    return x;
}

/// A steep profile, continued linearly, would come back out at the rim. What is at rest (slower than `rest`, round-off) stays so: which way it went would decide.
double shareToRest(const Vector& mean, const Vector& change, double rest)
{
    if (mean.norm() <= rest) return 0;
    const double along = -change.dot(mean), all = mean.squaredNorm();
    return along > all ? all/along : 1;
}

} // namespace

std::vector<double> averageToNodes(const Foam::polyPatch& patch, const MeshAdapter& adapter, const Halo& halo,
    const std::vector<int>& nodes, const std::vector<double>& faceValues, int width)
{
    // deviations from one value, the same on every rank, so that uniform values come back unchanged
    std::vector<double> reference(width);
    for (int k = 0; k < width; ++k)
        reference[k] = halo.max(patch.size() ? faceValues[k] : -1e300);

    const SimplexMesh& mesh = adapter.mesh;
    std::vector<double> sum(static_cast<std::size_t>(mesh.nNodes)*(width + 1), 0.0);
    for (Foam::label f = 0; f < patch.size(); ++f)
    {
        const double area = Foam::mag(patch.faceAreas()[f]);
        for (const Foam::label point : patch[f])
        {
            double* s = &sum[static_cast<std::size_t>(adapter.pointNode[point])*(width + 1)];
            for (int k = 0; k < width; ++k) s[k] += area*(faceValues[f*width + k] - reference[k]);
            s[width] += area;
        }
    }
    halo.sumToOwners(sum, width + 1);
    halo.update(sum, width + 1);

    std::vector<double> result;
    result.reserve(nodes.size()*width);
    for (int i : nodes)
    {
        const double* s = &sum[static_cast<std::size_t>(i)*(width + 1)];
        for (int k = 0; k < width; ++k) result.push_back(reference[k] + (s[width] > 0 ? s[k]/s[width] : 0));
    }
    return result;
}

std::vector<double> velocityAtNodes(const Foam::polyPatch& patch, const MeshAdapter& adapter, const Halo& halo, const PatchNodes& nodes,
    const std::vector<double>& faceVelocities)
{
    const SimplexMesh& mesh = adapter.mesh;
    const int dim = mesh.dim, width = 2*dim*dim;
    const std::vector<double> mean = averageToNodes(patch, adapter, halo, nodes.nodes, faceVelocities, dim);
    const std::vector<double> centre = averageToNodes(patch, adapter, halo, nodes.nodes, inPlane(mesh, patch.faceCentres()), dim);
    constexpr double roundOff = 1e-12;  // of the fastest face
    double fastest = 0;
    for (const double u : faceVelocities) fastest = std::max(fastest, std::abs(u));
    const double rest = roundOff*halo.max(fastest);
    const std::vector<double> sums = differenceSums(patch, adapter, halo, nodes, mean, centre);

    std::vector<double> change(static_cast<std::size_t>(mesh.nNodes)*dim, 0.0);
    for (std::size_t k = 0; k < nodes.nodes.size(); ++k)
    {
        const int i = nodes.nodes[k];
        if (i >= mesh.nOwned) continue;
        const double* s = &sums[static_cast<std::size_t>(i)*width];
        const Eigen::Map<const Eigen::MatrixXd> ofPlaces(s, dim, dim), ofValues(s + dim*dim, dim, dim);
        const Vector way = alongPatch(nodes, int(k), at(mesh.x, i, dim) - at(centre, int(k), dim));
        const Vector all = ofValues.transpose()*solveWithin(ofPlaces, way);
        const Vector counted = shareToRest(at(mean, int(k), dim), all, rest)*all;
        std::copy(counted.data(), counted.data() + dim, &change[static_cast<std::size_t>(i)*dim]);
    }
    halo.update(change, dim);

    std::vector<double> velocity = mean;
    for (std::size_t k = 0; k < velocity.size(); ++k) velocity[k] += change[static_cast<std::size_t>(nodes.nodes[k/dim])*dim + k%dim];
    return velocity;
}

} // namespace flotsam
