// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/bodyCompliance.hpp"

#include "algebra/exchange.hpp"

#include <algorithm>
#include <tuple>

namespace flotsam
{

void BodyCompliance::findSurface(const FlowSystem& system, const SolidUnknowns& solids, const std::vector<double>& pointwise)
{
    surface_.clear();
    const int nd = nDof_, B = system.dim + 1;
    for (int f = 0; f < int(solids.free().size()); ++f)
    {
        const SolidCoupling& solid = system.solids[solids.free()[f]];
        for (std::size_t k = 0; k < solid.node.size(); ++k)
        {
            const int i = solid.node[k];
            if (i >= nOwned_ || pointwise[i] == 0) continue;
            SurfaceNode s{i, f, {}, pointwise[i]};
            std::copy_n(&solid.column[(k*B + B - 1)*nd], nd, s.flux);
            surface_.push_back(s);
        }
    }
    std::sort(surface_.begin(), surface_.end(), [](const SurfaceNode& a, const SurfaceNode& b) { return std::tie(a.node, a.body) < std::tie(b.node, b.body); });
}

/// Of this rank's nodes: the lower half of K^T T K.
std::map<BodyCompliance::Pair, BodyCompliance::Block> BodyCompliance::addedMasses() const
{
    std::map<Pair, Block> blocks;
    for (std::size_t first = 0, k = 0; k < surface_.size(); ++k)
    {
        const SurfaceNode& a = surface_[k];
        while (surface_[first].node != a.node) ++first;
        for (std::size_t l = first; l <= k; ++l)
        {
            const SurfaceNode& b = surface_[l];
            Block& block = blocks[{a.body, b.body}];
            for (int r = 0; r < nDof_; ++r)
                for (int c = 0; c < nDof_; ++c) block[r*nDof_ + c] += a.pointwise*a.flux[r]*b.flux[c];
        }
    }
    return blocks;
}

/// All ranks', each as two bodies and nDof*nDof values.
std::vector<double> BodyCompliance::gathered(const std::map<Pair, Block>& blocks) const
{
    std::vector<double> values;
    values.reserve(blocks.size()*(2 + nDof_*nDof_));
    for (const auto& [bodies, block] : blocks)
    {
        values.insert(values.end(), {double(bodies.first), double(bodies.second)});
        values.insert(values.end(), block.begin(), block.begin() + nDof_*nDof_);
    }
    return gatherAll(values, halo_.comm());
}

void BodyCompliance::setEntries(const SolidUnknowns& solids)
{
    entries_.clear();
    const auto addBlock = [&](int rowBody, int columnBody, auto&& value)
    {
        for (int r = 0; r < nDof_; ++r)
            for (int c = 0; c < nDof_; ++c) entries_.emplace_back(rowBody*nDof_ + r, columnBody*nDof_ + c, value(r, c));
    };
    const std::vector<double> blocks = gathered(addedMasses());
    for (auto b = blocks.begin(); b != blocks.end(); b += 2 + nDof_*nDof_)
        addBlock(int(b[0]), int(b[1]), [&](int r, int c) { return b[2 + r*nDof_ + c]; });
    for (int f = 0; f < nBodies_; ++f) addBlock(f, f, [&](int r, int c) { return 0.5*(solids.block(f)(r, c) + solids.block(f)(c, r)); });
}

/// Whether the entries are where the last analysed matrix has them: the bodies that have nodes in common change seldom.
bool BodyCompliance::hasPattern(const Eigen::SparseMatrix<double>& m) const
{
    const auto isEqual = [](const int* a, const int* b, Eigen::Index n) { return std::equal(a, a + n, b); };
    return m.rows() == pattern_.rows() && m.nonZeros() == pattern_.nonZeros() && isEqual(m.outerIndexPtr(), pattern_.outerIndexPtr(), m.outerSize() + 1)
        && isEqual(m.innerIndexPtr(), pattern_.innerIndexPtr(), m.nonZeros());
}

void BodyCompliance::set(const FlowSystem& system, const SolidUnknowns& solids, const std::vector<double>& pointwise)
{
    nDof_ = system.nDof;
    nBodies_ = int(solids.free().size());
    if (nBodies_ == 0) return;
    findSurface(system, solids, pointwise);
    setEntries(solids);
    Eigen::SparseMatrix<double> matrix(nBodies_*nDof_, nBodies_*nDof_);
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    if (!hasPattern(matrix))
    {
        matrix_.analyzePattern(matrix);
        pattern_ = matrix;
    }
    matrix_.factorize(matrix);
    if (matrix_.info() != Eigen::Success) nBodies_ = 0;     // the same on every rank
}

/// motion_ = matrix_^-1 motion_, as matrix_.solve() does it but without memory from the heap.
void BodyCompliance::solve()
{
    work_.noalias() = matrix_.permutationP()*motion_;
    matrix_.matrixL().solveInPlace(work_);
    work_.array() /= matrix_.vectorD().array();
    matrix_.matrixU().solveInPlace(work_);
    motion_.noalias() = matrix_.permutationPinv()*work_;
}

void BodyCompliance::correct(double* p)
{
    if (nBodies_ == 0) return;
    motion_.setZero(nBodies_*nDof_);
    for (const SurfaceNode& s : surface_)
        for (int d = 0; d < nDof_; ++d) motion_[s.body*nDof_ + d] += s.flux[d]*p[s.node];
    halo_.sum(motion_.data(), int(motion_.size()));
    solve();
    for (const SurfaceNode& s : surface_)
    {
        double flux = 0;
        for (int d = 0; d < nDof_; ++d) flux += s.flux[d]*motion_[s.body*nDof_ + d];
        p[s.node] -= s.pointwise*flux;
    }
}

} // namespace flotsam
