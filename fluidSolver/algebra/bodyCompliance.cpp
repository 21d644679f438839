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

/// visit(surface node, one of the same node that is not behind it): the lower half of the products of their bodies.
template<class Visit>
void BodyCompliance::forPairs(const Visit& visit) const
{
    for (std::size_t first = 0, k = 0; k < surface_.size(); ++k)
    {
        while (surface_[first].node != surface_[k].node) ++first;
        for (std::size_t l = first; l <= k; ++l) visit(surface_[k], surface_[l]);
    }
}

/// Of this rank's nodes: the lower half of K^T T K, each block as two bodies and nDof*nDof values, in the order of the bodies.
void BodyCompliance::findAddedMasses()
{
    pairs_.clear();
    forPairs([&](const SurfaceNode& a, const SurfaceNode& b) { pairs_.emplace_back(a.body, b.body); });
    std::sort(pairs_.begin(), pairs_.end());
    pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
    const std::size_t width = 2 + nDof_*nDof_;
    blocks_.assign(pairs_.size()*width, 0.0);
    for (std::size_t k = 0; k < pairs_.size(); ++k)
    {
        blocks_[k*width] = pairs_[k].first;
        blocks_[k*width + 1] = pairs_[k].second;
    }
    forPairs([&](const SurfaceNode& a, const SurfaceNode& b)
    {
        const auto at = std::lower_bound(pairs_.begin(), pairs_.end(), Pair(a.body, b.body)) - pairs_.begin();
        double* block = &blocks_[std::size_t(at)*width + 2];
        for (int r = 0; r < nDof_; ++r)
            for (int c = 0; c < nDof_; ++c) block[r*nDof_ + c] += a.pointwise*a.flux[r]*b.flux[c];
    });
}

/// The matrix's upper half, which is its lower one transposed.
void BodyCompliance::setEntries(const SolidUnknowns& solids)
{
    entries_.clear();
    const auto addBlock = [&](int rowBody, int columnBody, auto&& value)
    {
        for (int r = 0; r < nDof_; ++r)
            for (int c = 0; c < (rowBody == columnBody ? r + 1 : nDof_); ++c) entries_.push_back({columnBody*nDof_ + c, rowBody*nDof_ + r, value(r, c)});
    };
    findAddedMasses();
    gatherAll(blocks_, halo_.comm(), allBlocks_);
    for (auto b = allBlocks_.begin(); b != allBlocks_.end(); b += 2 + nDof_*nDof_)
        addBlock(int(b[0]), int(b[1]), [&](int r, int c) { return b[2 + r*nDof_ + c]; });
    for (int f = 0; f < nBodies_; ++f) addBlock(f, f, [&](int r, int c) { return 0.5*(solids.block(f)(r, c) + solids.block(f)(c, r)); });
}

void BodyCompliance::set(const FlowSystem& system, const SolidUnknowns& solids, const std::vector<double>& pointwise)
{
    nDof_ = system.nDof;
    nBodies_ = int(solids.free().size());
    if (nBodies_ == 0) return;
    findSurface(system, solids, pointwise);
    setEntries(solids);
    if (!matrix_.factor(nBodies_*nDof_, entries_)) nBodies_ = 0;     // the same on every rank
}

void BodyCompliance::correct(double* p)
{
    if (nBodies_ == 0) return;
    motion_.assign(nBodies_*nDof_, 0.0);
    for (const SurfaceNode& s : surface_)
        for (int d = 0; d < nDof_; ++d) motion_[s.body*nDof_ + d] += s.flux[d]*p[s.node];
    halo_.sum(motion_.data(), int(motion_.size()));
    matrix_.solve(motion_.data());
    for (const SurfaceNode& s : surface_)
    {
        double flux = 0;
        for (int d = 0; d < nDof_; ++d) flux += s.flux[d]*motion_[s.body*nDof_ + d];
        p[s.node] -= s.pointwise*flux;
    }
}

} // namespace flotsam
