// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/velocityBlock.hpp"

#include <Eigen/Dense>

namespace flotsam
{

namespace
{

template<int D> using Block = Eigen::Matrix<double, D, D, Eigen::RowMajor>;

template<int D>
inline void product(const float* m, const double* v, double* result)
{
    for (int a = 0; a < D; ++a)
    {
        result[a] = 0;
        for (int b = 0; b < D; ++b) result[a] += m[a*D + b]*v[b];
    }
}

} // namespace

template<int D>
void VelocityBlock::setT(const FlowSystem& system, const std::vector<double>& ghost)
{
    const auto inverse = [&](int i) { return Eigen::Map<Eigen::Matrix<float, D, D, Eigen::RowMajor>>(&inverse_[std::size_t(i)*D*D]); };
    for (int i = 0; i < nOwned_; ++i)
    {
        if (!system.isActive[i])
        {
            inverse(i).setZero();
            continue;
        }
        const Eigen::Map<const Block<D>> diagonal(&system.matrix.velocity[std::size_t(graph_.diagonal[i])*D*D]);
        const Block<D> whole = diagonal + ghost[i]*Block<D>::Identity();
        inverse(i) = whole.inverse().template cast<float>();
    }
}

template<int D>
void VelocityBlock::solveT(const double* r, const double* scale, double* z) const
{
    constexpr int B = D + 1;
    for (int i = 0; i < nOwned_; ++i)
    {
        double sum[D];
        const double unscaled = 1/scale[std::size_t(i)*B];
        for (int a = 0; a < D; ++a) sum[a] = r[std::size_t(i)*B + a]*unscaled;
        product<D>(&inverse_[std::size_t(i)*D*D], sum, z + std::size_t(i)*B);
        z[std::size_t(i)*B + D] = 0;
    }
}

template<int D>
void VelocityBlock::subtractT(const double* g, double* z) const
{
    for (int i = 0; i < nOwned_; ++i)
    {
        double change[D];
        product<D>(&inverse_[std::size_t(i)*D*D], g + std::size_t(i)*D, change);
        for (int a = 0; a < D; ++a) z[std::size_t(i)*(D + 1) + a] -= change[a];
    }
}

void VelocityBlock::set(const FlowSystem& system, const std::vector<double>& ghost)
{
    if (dim_ == 2) setT<2>(system, ghost); else setT<3>(system, ghost);
}

void VelocityBlock::solve(const double* r, const double* scale, double* z) const
{
    if (dim_ == 2) solveT<2>(r, scale, z); else solveT<3>(r, scale, z);
}

void VelocityBlock::subtractDiagonal(const double* g, double* z) const
{
    if (dim_ == 2) subtractT<2>(g, z); else subtractT<3>(g, z);
}

} // namespace flotsam
