// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/systemMatrix.hpp"

#include <Eigen/SparseLU>

#include <cmath>
#include <stdexcept>

namespace flotsam
{

namespace
{

using Triplets = std::vector<Eigen::Triplet<double>>;

void addGraphEntries(const SimplexMesh& mesh, const NodeGraph& graph, const FlowSystem& system, const std::vector<int>& unknown,
    Triplets& entries)
{
    const int dim = mesh.dim, B = dim + 1;
    for (int i = 0; i < mesh.nOwned; ++i)
        for (int k = graph.rowStart[i]; k < graph.rowStart[i + 1]; ++k)
            for (int r = 0; r < B; ++r)
                for (int c = 0; c < B; ++c)
                {
                    const int row = unknown[i*B + r], column = unknown[graph.column[k]*B + c];
                    if (row < 0 || column < 0) continue;
                    const BlockMatrix& m = system.matrix;
                    const std::size_t entry = k;
                    const double value = r < dim ? (c < dim ? m.velocity[entry*dim*dim + r*dim + c] : m.gradient[entry*dim + r])
                                                 : (c < dim ? m.divergence[entry*dim + c] : m.pressure[entry]);
                    entries.emplace_back(row, column, value);
                }
}

void addGhosts(const FlowSystem& system, const std::vector<int>& unknown, Triplets& entries)
{
    const int dim = system.dim, B = dim + 1;
    for (const GhostTerm& g : system.ghosts)
        for (int i = 0; i < dim + 2; ++i)
            for (int j = 0; j < dim + 2; ++j)
                for (int c = 0; c < B; ++c)
                {
                    const int row = unknown[g.node[i]*B + c], column = unknown[g.node[j]*B + c];
                    if (row < 0 || column < 0) continue;
                    const double *jump = c < dim ? g.jumpVelocity : g.jumpPressure, factor = c < dim ? g.velocityFactor : g.pressureFactor;
                    entries.emplace_back(row, column, factor*jump[i]*jump[j]);
                }
}

} // namespace

SystemMatrix systemMatrix(const SimplexMesh& mesh, const NodeGraph& graph, const FlowSystem& system, bool isScaled)
{
    const int dim = mesh.dim, B = dim + 1;
    if (mesh.nOwned != mesh.nNodes) throw std::invalid_argument("systemMatrix: one rank only");
    SystemMatrix result;
    result.unknown.assign(std::size_t(mesh.nNodes)*B, 0);
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        for (int c = 0; c < B && !system.isActive[i]; ++c) result.unknown[i*B + c] = -1;
        if (system.isPressureFixed[i]) result.unknown[i*B + dim] = -1;
    }
    for (const NodeConstraint& c : system.constraints)
    {
        if (c.nDirections != dim) throw std::invalid_argument("systemMatrix: slip walls are not supported");
        for (int k = 0; k < dim; ++k) result.unknown[c.node*B + k] = -1;
    }
    int n = 0;
    for (int& u : result.unknown) if (u >= 0) u = n++;
    Triplets entries;
    addGraphEntries(mesh, graph, system, result.unknown, entries);
    addGhosts(system, result.unknown, entries);
    result.matrix.resize(n, n);
    result.matrix.setFromTriplets(entries.begin(), entries.end());
    result.scale = Eigen::VectorXd::Ones(n);
    if (!isScaled) return result;
    const Eigen::VectorXd diagonal = result.matrix.diagonal();
    result.scale = diagonal.cwiseAbs().cwiseSqrt().cwiseInverse();
    result.matrix = result.scale.asDiagonal()*result.matrix*result.scale.asDiagonal();
    return result;
}

double conditionNumber(const SimplexMesh& mesh, const FlowSystem& system, const SystemMatrix& m)
{
    const int n = int(m.matrix.rows()), B = mesh.dim + 1;
    const bool isBordered = system.nLevels > 0;
    Eigen::VectorXd constant = Eigen::VectorXd::Zero(n); // the pressure that is one everywhere, scaled
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        const int k = m.unknown[i*B + mesh.dim];
        if (k >= 0) constant[k] = 1/m.scale[k];
    }
    constant.normalize();
    Eigen::SparseMatrix<double> bordered(n + isBordered, n + isBordered);
    Triplets entries;
    for (int c = 0; c < n; ++c)
        for (Eigen::SparseMatrix<double>::InnerIterator it(m.matrix, c); it; ++it) entries.emplace_back(it.row(), c, it.value());
    for (int k = 0; k < n && isBordered; ++k)
        if (constant[k] != 0)
        {
            entries.emplace_back(n, k, constant[k]);
            entries.emplace_back(k, n, constant[k]);
        }
    bordered.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SparseMatrix<double> transposed = bordered.transpose();
    Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(bordered);
    if (lu.info() != Eigen::Success) return 1e300;
    Eigen::VectorXd x = Eigen::VectorXd::Zero(bordered.rows()), y;
    for (int k = 0; k < n; ++k) x[k] = std::sin(1.0 + 12.9898*k); // no symmetry
    y = x;
    double largest = 0, inverse = 0;
    for (int k = 0; k < 60; ++k)
    {
        x = transposed*(bordered*x.normalized());
        largest = std::sqrt(x.norm());
    }
    for (int k = 0; k < 20; ++k)
    {
        y = lu.solve(Eigen::VectorXd(lu.transpose().solve(y.normalized())));
        inverse = std::sqrt(y.norm());
    }
    return largest*inverse;
}

} // namespace flotsam
