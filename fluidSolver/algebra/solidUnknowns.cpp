// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/solidUnknowns.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

void SolidUnknowns::set(const FlowSystem& system)
{
    system_ = &system;
    nDof_ = system.nDof;
    const int n = nDof_;
    free_.clear();
    block_.clear();
    inverse_.clear();
    scale_.clear();
    values_.clear();
    for (std::size_t s = 0; s < system.solids.size(); ++s)
    {
        const SolidCoupling& solid = system.solids[s];
        if (!solid.isFree) continue;
        free_.push_back(int(s));
        values_.insert(values_.end(), solid.block.begin(), solid.block.begin() + n*n);
    }
    halo_.sum(values_.data(), int(values_.size()));     // of all at once
    for (std::size_t f = 0; f < free_.size(); ++f)
    {
        double* block = &values_[f*n*n];
        const std::vector<double>& inertia = system.solids[free_[f]].inertia;
        for (int k = 0; k < n*n; ++k) block[k] += inertia[k];
        const Block& m = block_.emplace_back(Eigen::Map<Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(block, n, n));
        inverse_.push_back(m.inverse());
        for (int k = 0; k < n; ++k) scale_.push_back(1/std::sqrt(std::abs(m(k, k))));
    }
}

const std::vector<double>& SolidUnknowns::broadcast(const double* entries)
{
    values_.resize(nEntries());
    if (halo_.rank() == 0) std::copy(entries, entries + nEntries(), values_.begin());
    MPI_Bcast(values_.data(), nEntries(), MPI_DOUBLE, 0, halo_.comm());
    return values_;
}

void SolidUnknowns::readVelocity(const double* entries, std::vector<double>& q)
{
    if (isEmpty()) return;
    const std::vector<double>& values = broadcast(entries);
    for (std::size_t f = 0; f < free_.size(); ++f)
        for (int d = 0; d < nDof_; ++d) q[free_[f]*nDof_ + d] = values[f*nDof_ + d]*scale_[f*nDof_ + d];
}

void SolidUnknowns::readRows(const double* entries, std::vector<double>& rows)
{
    if (isEmpty()) return;
    const std::vector<double>& values = broadcast(entries);
    for (std::size_t f = 0; f < free_.size(); ++f)
        for (int d = 0; d < nDof_; ++d) rows[free_[f]*nDof_ + d] = values[f*nDof_ + d]/scale_[f*nDof_ + d];
}

void SolidUnknowns::writeRows(const std::vector<double>& rows, double* entries) const
{
    if (halo_.rank() != 0) return;
    for (std::size_t f = 0; f < free_.size(); ++f)
        for (int d = 0; d < nDof_; ++d) entries[f*nDof_ + d] = rows[free_[f]*nDof_ + d]*scale_[f*nDof_ + d];
}

void SolidUnknowns::writeVelocity(const std::vector<double>& q, double* entries) const
{
    if (halo_.rank() != 0) return;
    for (std::size_t f = 0; f < free_.size(); ++f)
        for (int d = 0; d < nDof_; ++d) entries[f*nDof_ + d] = q[free_[f]*nDof_ + d]/scale_[f*nDof_ + d];
}

void SolidUnknowns::solve(const std::vector<double>& rows, std::vector<double>& w) const
{
    for (std::size_t f = 0; f < free_.size(); ++f)
    {
        const Eigen::Map<const Eigen::VectorXd> r(rows.data() + free_[f]*nDof_, nDof_);
        Eigen::Map<Eigen::VectorXd>(w.data() + free_[f]*nDof_, nDof_) = inverse_[f]*r;
    }
}

void SolidUnknowns::addInertia(const double* q, double* rows) const
{
    for (int s : free_)
        for (int d = 0; d < nDof_; ++d)
            for (int c = 0; c < nDof_; ++c) rows[s*nDof_ + d] += system_->solids[s].inertia[d*nDof_ + c]*q[s*nDof_ + c];
}

} // namespace flotsam
