// SPDX-License-Identifier: GPL-3.0-or-later
/// Anderson acceleration of a fixed-point iteration x = G(x) (Walker & Ni 2011, doi 10.1137/10078356X).
#pragma once

#include <Eigen/Dense>

#include <vector>

namespace flotsam
{

class Anderson
{
public:
    explicit Anderson(int depth = 5) : depth_(depth) {}

    void reset() { x_.clear(); g_.clear(); }

    /// Next x from the pair x, g = G(x). The first call of an iteration returns g.
    Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& g);

private:
    int depth_;
    std::vector<Eigen::VectorXd> x_, g_;
};

} // namespace flotsam
