// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/velocityBlock.hpp"

#include <Eigen/Dense>

namespace flotsam
{

namespace
{

template<int D> using Block = Eigen::Matrix<double, D, D, Eigen::RowMajor>;

template<int D>
Block<D> freeDirections(const NodeConstraint& c)
{
    if (c.nDirections >= D) return Block<D>::Zero();
    Block<D> result = Block<D>::Identity();
    for (int k = 0; k < c.nDirections; ++k)
    {
        const Eigen::Map<const Eigen::Matrix<double, D, 1>> n(c.direction[k]);
        result -= n*n.transpose();
    }
    return result;
}

/// sum -= K v
template<int D>
inline void subtractProduct(const double* K, const double* v, double* sum)
{
    for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) sum[a] -= K[a*D + b]*v[b];
}

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
    for (const NodeConstraint& c : system.constraints)
    {
        const Block<D> isFree = freeDirections<D>(c), before = inverse(c.node).template cast<double>();
        inverse(c.node) = (isFree*before*isFree).template cast<float>();
    }
}

template<int D>
void VelocityBlock::solveDiagonal(const double* r, const double* scale, double* z) const
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

/// (diagonal + upper part)^-1 diagonal (diagonal + lower part)^-1, on the rank's own nodes.
template<int D>
void VelocityBlock::sweep(const double* r, const double* scale, double* z) const
{
    constexpr int B = D + 1;
    const int* column = graph_.column.data();
    const double* K = system_->matrix.velocity.data();
    for (int i = 0; i < nOwned_; ++i)
    {
        double sum[D];
        const double unscaled = 1/scale[std::size_t(i)*B];
        for (int a = 0; a < D; ++a) sum[a] = r[std::size_t(i)*B + a]*unscaled;
        for (int k = graph_.rowStart[i]; k < graph_.diagonal[i]; ++k) subtractProduct<D>(K + std::size_t(k)*D*D, z + std::size_t(column[k])*B, sum);
        product<D>(&inverse_[std::size_t(i)*D*D], sum, z + std::size_t(i)*B);
        z[std::size_t(i)*B + D] = 0;
    }
    for (int i = nOwned_ - 1; i >= 0; --i)
    {
        double sum[D] = {}, change[D];
        for (int k = graph_.rowStart[i + 1] - 1; k > graph_.diagonal[i]; --k)   // the node that has just changed comes last
            if (column[k] < nOwned_) subtractProduct<D>(K + std::size_t(k)*D*D, z + std::size_t(column[k])*B, sum);
        product<D>(&inverse_[std::size_t(i)*D*D], sum, change);
        for (int a = 0; a < D; ++a) z[std::size_t(i)*B + a] += change[a];
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
    system_ = &system;
    if (system.dim == 2) setT<2>(system, ghost); else setT<3>(system, ghost);
}

void VelocityBlock::solve(const double* r, const double* scale, double* z) const
{
    if (system_->dim == 2) sweep<2>(r, scale, z); else solveDiagonal<3>(r, scale, z);
}

void VelocityBlock::subtractDiagonal(const double* g, double* z) const
{
    if (system_->dim == 2) subtractT<2>(g, z); else subtractT<3>(g, z);
}

} // namespace flotsam
