// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/anderson.hpp"

namespace flotsam
{

Eigen::VectorXd Anderson::next(const Eigen::VectorXd& g, const Eigen::VectorXd& residual)
{
    g_.push_back(g);
    residuals_.push_back(residual);
    if (int(g_.size()) > depth_ + 1)
    {
        g_.erase(g_.begin());
        residuals_.erase(residuals_.begin());
    }
    const int m = int(g_.size()) - 1;
    if (m == 0) return g;
    Eigen::MatrixXd residualChange(residual.size(), m), imageChange(g.size(), m);
    for (int k = 0; k < m; ++k)
    {
        residualChange.col(k) = residuals_[k + 1] - residuals_[k];
        imageChange.col(k) = g_[k + 1] - g_[k];
    }
    // rank-revealing: contacts that open or close make the history nearly dependent
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
    qr.setThreshold(1e-6);
    const Eigen::VectorXd weights = qr.compute(residualChange).solve(residual);
    return g - imageChange*weights;
}

} // namespace flotsam
