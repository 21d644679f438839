// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/pressureHierarchy.hpp"

#include "algebra/petscCalls.hpp"

namespace flotsam
{

namespace
{

constexpr int setupCost = 3;            // GMRES iterations that cost as much as a new hierarchy
constexpr double singularShift = 1e-7;  // relative diagonal shift of the matrix without a pressure level

} // namespace

PressureHierarchy::PressureHierarchy(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo)
:   mesh_(mesh), graph_(graph), cycle_(mesh, graph, halo, "pressure_")
{
    check(PetscOptionsGetInt(nullptr, nullptr, "-pressure_max_age", &maxAge_, nullptr)); // 0: anew in every step, to see what keeping it saves
}

void PressureHierarchy::addGhosts(const FlowSystem& system, Mat matrix)
{
    const int n = mesh_.dim + 2;
    for (const GhostTerm& g : system.ghosts)
        for (int j = 0; j < n; ++j)
        {
            if (g.node[j] >= mesh_.nOwned || !isFreePressure(system, g.node[j])) continue;
            const PetscInt row = mesh_.globalNode[g.node[j]];
            for (int k = 0; k < n; ++k)
            {
                if (!isFreePressure(system, g.node[k])) continue;
                const PetscInt column = mesh_.globalNode[g.node[k]];
                const PetscScalar value = g.pressureFactor*g.jumpPressure[j]*g.jumpPressure[k];
                check(MatSetValues(matrix, 1, &row, 1, &column, &value, ADD_VALUES));
            }
        }
}

void PressureHierarchy::fillMatrix(const FlowSystem& system, Mat matrix)
{
    std::vector<PetscInt> columns;
    std::vector<PetscScalar> values;
    for (int i = 0; i < mesh_.nOwned; ++i)
    {
        const PetscInt row = mesh_.globalNode[i];
        const bool isFree = isFreePressure(system, i), hasLevel = system.nLevels > 0 && system.level[i] >= 0;
        columns.clear();
        values.clear();
        for (int k = graph_.rowStart[i]; k < graph_.rowStart[i + 1]; ++k)
        {
            const int j = graph_.column[k];
            columns.push_back(mesh_.globalNode[j]);
            if (i == j) values.push_back(isFree ? system.schur[k]*(1 + (hasLevel ? singularShift : 0)) : schurDiagonal(system, graph_, i));
            else values.push_back(isFree && isFreePressure(system, j) ? system.schur[k] : 0);
        }
        check(MatSetValues(matrix, 1, &row, PetscInt(columns.size()), columns.data(), values.data(), ADD_VALUES));
    }
    addGhosts(system, matrix);
}

/// A hierarchy ages with the surface's motion: each step takes some iterations more than the best one. It is renewed when the last step's
/// excess is above the mean of what a step has cost in excess and set-up: from then on that mean would rise.
bool PressureHierarchy::isWorn() const
{
    if (age_ < 0 || age_ >= maxAge_) return true;
    return lastExcess_ > 0 && lastExcess_*nSolves_ >= setupCost + sumOfExcess_;
}

void PressureHierarchy::update(const FlowSystem& system, const std::vector<double>& scale)
{
    if (!isWorn())
    {
        ++age_;
        cycle_.rescale(scale);
        return;
    }
    fillMatrix(system, cycle_.newMatrix(system));
    cycle_.build(scale);
    age_ = nSolves_ = leastIterations_ = lastExcess_ = sumOfExcess_ = 0;
}

void PressureHierarchy::countIterations(int iterations)
{
    if (nSolves_ == 0 || iterations < leastIterations_) leastIterations_ = iterations;
    ++nSolves_;
    lastExcess_ = iterations - leastIterations_;
    sumOfExcess_ += lastExcess_;
}

} // namespace flotsam
