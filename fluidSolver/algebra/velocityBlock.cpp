// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/velocityBlock.hpp"

#include <Eigen/Dense>

#include <algorithm>

namespace flotsam
{

namespace
{

/// Over its diagonal the consistent mass matrix, which is most of the block, has eigenvalues from 1/2 to (D + 2)/2, whatever the elements (A. J. Wathen,
/// IMA J. Numer. Anal. 7 (1987) 449, doi 10.1093/imanum/7.4.449): one over their middle.
template<int D> constexpr double damping = 4.0/(D + 3);

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
    for (int i : held_.nodes()) inverse(i).setZero();
}

/// As a matrix for each component: mean of the diagonal, ghost faces.
void VelocityBlock::setHeldNodes(const FlowSystem& system, const std::vector<double>& ghost)
{
    held_.clear();
    if (system.ghosts.empty()) return;
    std::vector<char>& isExcluded = isHeld_;
    isExcluded.assign(nOwned_, 0);
    ofElements_.assign(nOwned_, 0.0);
    for (int i = 0; i < nOwned_; ++i)
    {
        isExcluded[i] = !system.isActive[i];
        const double* diagonal = &system.matrix.velocity[std::size_t(graph_.diagonal[i])*dim_*dim_];
        for (int a = 0; a < dim_; ++a) ofElements_[i] += diagonal[a*dim_ + a]/dim_;
    }
    for (const NodeConstraint& c : system.constraints) isExcluded[c.node] = 1;
    held_.find(ghost, ofElements_, isExcluded);
    if (held_.isEmpty()) return;
    entries_.clear();
    for (int k = 0; k < int(held_.nodes().size()); ++k) entries_.push_back({k, k, std::max(ofElements_[held_.nodes()[k]], 0.0)});
    for (const GhostTerm& g : system.ghosts)
        for (int i = 0; i < dim_ + 2; ++i)
        {
            const int row = held_.position(g.node[i]);
            for (int j = 0; row >= 0 && j < dim_ + 2; ++j)
                if (const int column = held_.position(g.node[j]); column >= row)
                    entries_.push_back({row, column, g.velocityFactor*g.jumpVelocity[i]*g.jumpVelocity[j]});
        }
    held_.factor(entries_, dim_);
}

/// Solves for held_.values() and adds factor times that to the velocities of z.
void VelocityBlock::addHeldValues(double factor, double* z)
{
    held_.solve();
    for (std::size_t k = 0; k < held_.nodes().size(); ++k)
        for (int a = 0; a < dim_; ++a) z[std::size_t(held_.nodes()[k])*(dim_ + 1) + a] += factor*held_.values()(k, a);
}

void VelocityBlock::findLightNodes(const FlowSystem& system)
{
    isHeld_.assign(nOwned_, 0);
    for (const NodeConstraint& c : system.constraints) isHeld_[c.node] = 1;
    for (int i : held_.nodes()) isHeld_[i] = 1;
    lightNodes_.clear();
    for (int i = 0; i < nOwned_; ++i)
        if (system.isActive[i] && system.isLight[i] && !isHeld_[i]) lightNodes_.push_back(i);
}

template<int D>
void VelocityBlock::relaxNode(int i, const double* r, const double* scale, double* z) const
{
    constexpr int B = D + 1;
    double rest[D];
    const double unscaled = 1/scale[std::size_t(i)*B];
    for (int a = 0; a < D; ++a) rest[a] = r[std::size_t(i)*B + a]*unscaled;
    for (int k = graph_.rowStart[i]; k < graph_.rowStart[i + 1]; ++k)
    {
        const int j = graph_.column[k];
        if (j == i || j >= nOwned_) continue;
        const double *block = &system_->matrix.velocity[std::size_t(k)*D*D], *v = z + std::size_t(j)*B;
        for (int a = 0; a < D; ++a)
            for (int b = 0; b < D; ++b) rest[a] -= block[a*D + b]*v[b];
    }
    product<D>(&inverse_[std::size_t(i)*D*D], rest, z + std::size_t(i)*B);
}

template<int D>
void VelocityBlock::relaxT(const double* r, const double* scale, double* z) const
{
    for (auto i = lightNodes_.begin(); i != lightNodes_.end(); ++i) relaxNode<D>(*i, r, scale, z);
    for (auto i = lightNodes_.rbegin(); i != lightNodes_.rend(); ++i) relaxNode<D>(*i, r, scale, z);
}

template<int D>
void VelocityBlock::solveT(const double* r, const double* scale, double* z) const
{
    constexpr int B = D + 1;
    for (int i = 0; i < nOwned_; ++i)
    {
        double sum[D];
        const double factor = damping<D>/scale[std::size_t(i)*B];
        for (int a = 0; a < D; ++a) sum[a] = r[std::size_t(i)*B + a]*factor;
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
        for (int a = 0; a < D; ++a) z[std::size_t(i)*(D + 1) + a] -= damping<D>*change[a];
    }
}

void VelocityBlock::set(const FlowSystem& system, const std::vector<double>& ghost)
{
    system_ = &system;
    setHeldNodes(system, ghost);
    if (dim_ == 2) setT<2>(system, ghost); else setT<3>(system, ghost);
    findLightNodes(system);
}

void VelocityBlock::solve(const double* r, const double* scale, double* z)
{
    if (dim_ == 2) solveT<2>(r, scale, z); else solveT<3>(r, scale, z);
    if (held_.isEmpty()) return;
    for (std::size_t k = 0; k < held_.nodes().size(); ++k)
    {
        const std::size_t row = std::size_t(held_.nodes()[k])*(dim_ + 1);
        for (int a = 0; a < dim_; ++a) held_.values()(k, a) = r[row + a]/scale[row];
    }
    addHeldValues(1, z);
}

void VelocityBlock::relaxLightNodes(const double* r, const double* scale, double* z) const
{
    if (dim_ == 2) relaxT<2>(r, scale, z); else relaxT<3>(r, scale, z);
}

void VelocityBlock::subtractDiagonal(const double* g, double* z)
{
    if (dim_ == 2) subtractT<2>(g, z); else subtractT<3>(g, z);
    if (held_.isEmpty()) return;
    for (std::size_t k = 0; k < held_.nodes().size(); ++k)
        for (int a = 0; a < dim_; ++a) held_.values()(k, a) = g[std::size_t(held_.nodes()[k])*dim_ + a];
    addHeldValues(-1, z);
}

} // namespace flotsam
