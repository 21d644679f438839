// SPDX-License-Identifier: GPL-3.0-or-later
/// Restarted GMRES with the preconditioner on the right (Saad & Schultz 1986, doi 10.1137/0907058) for a ScaledFlowSystem.
///
/// The basis is kept in single precision where the wanted reduction allows it: its vectors are rounded before the product with them is made, so
/// that what rounding costs is 6e-8 of the residual at the start, whatever the condition of the matrix. The first preconditioned vectors are kept
/// (double: the matrix would magnify their rounding), and a solve of no more iterations needs no further preconditioner for its solution.
#pragma once

#include "algebra/scaledFlowSystem.hpp"

namespace flotsam
{

class Gmres
{
public:
    Gmres(ScaledFlowSystem& system, const Halo& halo, int restart) : system_(system), halo_(halo), restart_(restart) {}

    struct Result
    {
        int iterations = 0;
        double residual = 0;
        bool hasConverged = false;
    };

    /// Improves (x, q), whose scaled residual is `residual` of norm `first`, until the norm is below target. Overwrites `residual`. Collective.
    Result solve(std::vector<double>& x, std::vector<double>& q, std::vector<double>& residual, double first, double target, int maxIterations);

    /// Norm of a scaled vector. Collective.
    double norm(const std::vector<double>& v) const;

private:
    template<class Real> using Basis = std::vector<std::vector<Real>>;
    template<class Real> void cycle(Basis<Real>& basis, std::vector<double>& x, std::vector<double>& q, std::vector<double>& work, double first, double target,
        int maxIterations, Result& result);
    template<class Real> double orthogonalise(const Basis<Real>& basis, int count, std::vector<double>& work);
    template<class Real> void addSolution(Basis<Real>& basis, int count, std::vector<double>& x, std::vector<double>& q, std::vector<double>& work);
    double rotate(int column, double next);
    void solveTriangular(int count);
    double& hessenberg(int row, int column) { return hessenberg_[std::size_t(column)*(restart_ + 1) + row]; }

    ScaledFlowSystem& system_;
    const Halo& halo_;
    int restart_;
    Basis<float> single_;
    Basis<double> double_;
    Basis<double> preconditioned_;      // of the first vectors, unscaled
    std::vector<double> hessenberg_;    // (restart+1) per column
    std::vector<double> cosine_, sine_, right_;     // Givens rotations; right-hand side of the least squares problem, then its solution
    std::vector<double> column_;        // projections on the basis
};

} // namespace flotsam
