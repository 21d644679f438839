// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/anderson.hpp"

namespace flotsam
{

Eigen::VectorXd Anderson::next(const Eigen::VectorXd& x, const Eigen::VectorXd& g)
{
    x_.push_back(x);
    g_.push_back(g);
    if (int(x_.size()) > depth_ + 1)
    {
        x_.erase(x_.begin());
        g_.erase(g_.begin());
    }
    const int m = int(x_.size()) - 1;
    if (m == 0) return g;
    Eigen::MatrixXd residualChange(x.size(), m), imageChange(x.size(), m);
    for (int k = 0; k < m; ++k)
    {
        residualChange.col(k) = (g_[k + 1] - x_[k + 1]) - (g_[k] - x_[k]);
        imageChange.col(k) = g_[k + 1] - g_[k];
    }
    // rank-revealing: contacts that open or close make the history nearly dependent
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
    qr.setThreshold(1e-6);
    const Eigen::VectorXd weights = qr.compute(residualChange).solve(g - x);
    return g - imageChange*weights;
}

} // namespace flotsam
