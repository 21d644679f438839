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

    void reset() { g_.clear(); residuals_.clear(); }

    /// Next x from g = G(x) and the residual G(x) - x, in any linear measure. The first call of an iteration returns g.
    Eigen::VectorXd next(const Eigen::VectorXd& g, const Eigen::VectorXd& residual);

private:
    int depth_;
    std::vector<Eigen::VectorXd> g_, residuals_;
};

} // namespace flotsam
