// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/dualCells.hpp"

#include "algebra/halo.hpp"
#include "geometry/cover.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

/// The share of corner 0 is dim! simplices of equal volume: corner, edge midpoint, (face centroid,) centroid, one for each
/// order in which the other corners are added. Mean of a product over a simplex with n+1 corner values P, Q:
/// (sum P sum Q + sum P Q)/((n+1)(n+2)).
ShareMoments ShareMoments::of(int dim)
{
    ShareMoments m{0, 0, 0};
    const int n = dim + 1;
    std::array<int, 3> order{1, 2, 3};
    int nParts = 0;
    do
    {
        double p[4] = {}, q[4] = {};    // lambda_1 and lambda_2 at the corners of the part
        bool has1 = false, has2 = false;
        for (int k = 1; k <= dim; ++k)
        {
            has1 = has1 || order[k - 1] == 1;
            has2 = has2 || order[k - 1] == 2;
            p[k] = has1 ? 1./(k + 1) : 0;
            q[k] = has2 ? 1./(k + 1) : 0;
        }
        double sumP = 0, sumQ = 0, sumPP = 0, sumPQ = 0;
        for (int k = 0; k <= dim; ++k)
        {
            sumP += p[k];
            sumQ += q[k];
            sumPP += p[k]*p[k];
            sumPQ += p[k]*q[k];
        }
        m.first += sumP/n;
        m.square += (sumP*sumP + sumPP)/(n*(n + 1));
        m.mixed += (sumP*sumQ + sumPQ)/(n*(n + 1));
        ++nParts;
    } while (std::next_permutation(order.begin(), order.begin() + dim));
    m.first /= nParts;
    m.square /= nParts;
    m.mixed /= nParts;
    return m;
}

void findDualVolumes(const SimplexMesh& mesh, const Cover* cover, std::vector<double>& volume)
{
    const int n = mesh.dim + 1;
    volume.assign(mesh.nNodes, 0);
    for (int e = 0; e < mesh.nElements; ++e)
    {
        if (cover && cover->state[e] == ElementState::Solid)
        {
            continue;
        }
        const bool isCut = cover && cover->state[e] == ElementState::Cut;
        const double* first = isCut ? cover->cuts[cover->cutIndex[e]].first : nullptr;
        const int* nodes = &mesh.elements[std::size_t(e)*n];
        for (int a = 0; a < n; ++a)
        {
            volume[nodes[a]] += isCut ? first[a] : mesh.volume[e]/n;
        }
    }
}

std::vector<double> dualVolumes(const SimplexMesh& mesh, const Cover* cover)
{
    std::vector<double> volume;
    findDualVolumes(mesh, cover, volume);
    return volume;
}

DualCells::DualCells(const SimplexMesh& mesh)
    : dim_(mesh.dim), volume_(dualVolumes(mesh, nullptr)), centroid_(std::size_t(mesh.nNodes)*dim_, 0),
      second_(std::size_t(mesh.nNodes)*(dim_ == 2 ? 3 : 6), 0)
{
    const int n = dim_ + 1, nSecond = dim_ == 2 ? 3 : 6;
    const ShareMoments moments = ShareMoments::of(dim_);
    for (int e = 0; e < mesh.nElements; ++e)
    {
        const int* nodes = &mesh.elements[std::size_t(e)*n];
        for (int a = 0; a < n; ++a)
        {
            // x - x_a = sum_b lambda_b r_b, so mean(x x) = (square - mixed) sum r_b r_b + mixed (sum r_b)(sum r_b)
            const double* xa = &mesh.x[std::size_t(nodes[a])*dim_];
            double sum[3] = {}, product[3][3] = {};
            for (int b = 0; b < n; ++b)
            {
                const double* xb = &mesh.x[std::size_t(nodes[b])*dim_];
                for (int i = 0; i < dim_; ++i)
                {
                    sum[i] += xb[i] - xa[i];
                    for (int j = 0; j < dim_; ++j)
                    {
                        product[i][j] += (xb[i] - xa[i])*(xb[j] - xa[j]);
                    }
                }
            }
            const double weight = mesh.volume[e]/n;
            double* second = &second_[std::size_t(nodes[a])*nSecond];
            int mixed = dim_;
            for (int i = 0; i < dim_; ++i)
            {
                centroid_[std::size_t(nodes[a])*dim_ + i] += weight*moments.first*sum[i];
                for (int j = i; j < dim_; ++j)
                {
                    second[j == i ? i : mixed++] += weight*((moments.square - moments.mixed)*product[i][j] + moments.mixed*sum[i]*sum[j]);
                }
            }
        }
    }
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        double* c = &centroid_[std::size_t(i)*dim_];
        double* m = &second_[std::size_t(i)*nSecond];
        int mixed = dim_;
        for (int d = 0; d < dim_; ++d)
        {
            c[d] /= volume_[i];
        }
        for (int d = 0; d < dim_; ++d)
        {
            for (int k = d; k < dim_; ++k)
            {
                double& value = m[k == d ? d : mixed++];
                value = value/volume_[i] - c[d]*c[k];
            }
        }
    }
}

void DualCells::complete(const Halo& halo)
{
    halo.update(volume_, 1);
    halo.update(centroid_, dim_);
    halo.update(second_, dim_ == 2 ? 3 : 6);
}

double DualCells::halfWidth(int i, const double* n) const
{
    if (dim_ == 2)
    {
        const double* m = &second_[std::size_t(i)*3];
        return std::sqrt(3*(n[0]*n[0]*m[0] + n[1]*n[1]*m[1] + 2*n[0]*n[1]*m[2]));
    }
    const double* m = &second_[std::size_t(i)*6];
    return std::sqrt(3*(n[0]*n[0]*m[0] + n[1]*n[1]*m[1] + n[2]*n[2]*m[2]
        + 2*(n[0]*n[1]*m[3] + n[0]*n[2]*m[4] + n[1]*n[2]*m[5])));
}

double DualCells::meanBend(int i, const double* K) const
{
    const double* m = &second_[std::size_t(i)*(dim_ == 2 ? 3 : 6)];
    if (dim_ == 2)
    {
        return 0.5*(K[0]*m[0] + K[1]*m[1]) + K[2]*m[2];
    }
    return 0.5*(K[0]*m[0] + K[1]*m[1] + K[2]*m[2]) + K[3]*m[3] + K[4]*m[4] + K[5]*m[5];
}

} // namespace flotsam
