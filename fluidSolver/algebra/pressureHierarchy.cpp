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
:   mesh_(mesh), graph_(graph), halo_(halo)
{
    check(VecCreateMPI(halo.comm(), mesh.nOwned, PETSC_DETERMINE, &in_));
    check(VecCreateMPIWithArray(halo.comm(), 1, mesh.nOwned, PETSC_DETERMINE, nullptr, &out_));
    check(PetscOptionsGetInt(nullptr, nullptr, "-pressure_max_age", &maxAge_, nullptr)); // 0: anew in every step, to see what keeping it saves
}

PressureHierarchy::~PressureHierarchy()
{
    PCDestroy(&cycle_);
    MatDestroy(&matrix_);
    VecDestroy(&in_);
    VecDestroy(&out_);
}

/// A new matrix each time: the pressure ghost terms reach beyond the graph, and their faces move with the solids.
void PressureHierarchy::createMatrix(const FlowSystem& system)
{
    const int n = mesh_.nOwned;
    std::vector<PetscInt> diagonal(n, 0), offDiagonal(n, 0);
    auto count = [&](int row, int column) { ++(column < n ? diagonal : offDiagonal)[row]; };
    for (int i = 0; i < n; ++i)
        for (int k = graph_.rowStart[i]; k < graph_.rowStart[i + 1]; ++k) count(i, graph_.column[k]);
    for (const GhostTerm& g : system.ghosts)
    {
        const int a = g.node[mesh_.dim], b = g.node[mesh_.dim + 1];
        if (a < n) count(a, b);
        if (b < n) count(b, a);
    }
    MatDestroy(&matrix_);
    check(MatCreateAIJ(halo_.comm(), n, n, PETSC_DETERMINE, PETSC_DETERMINE, 0, diagonal.data(), 0, offDiagonal.data(), &matrix_));
}

void PressureHierarchy::addGhosts(const FlowSystem& system)
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
                check(MatSetValues(matrix_, 1, &row, 1, &column, &value, ADD_VALUES));
            }
        }
}

void PressureHierarchy::fillMatrix(const FlowSystem& system)
{
    const double shift = system.hasPressureLevel ? 1 : 1 + singularShift;
    std::vector<PetscInt> columns;
    std::vector<PetscScalar> values;
    for (int i = 0; i < mesh_.nOwned; ++i)
    {
        const PetscInt row = mesh_.globalNode[i];
        const bool isFree = isFreePressure(system, i);
        columns.clear();
        values.clear();
        for (int k = graph_.rowStart[i]; k < graph_.rowStart[i + 1]; ++k)
        {
            const int j = graph_.column[k];
            columns.push_back(mesh_.globalNode[j]);
            if (i == j) values.push_back(isFree ? system.schur[k]*shift : schurDiagonal(system, graph_, i));
            else values.push_back(isFree && isFreePressure(system, j) ? system.schur[k] : 0);
        }
        check(MatSetValues(matrix_, 1, &row, PetscInt(columns.size()), columns.data(), values.data(), ADD_VALUES));
    }
    addGhosts(system);
    check(MatAssemblyBegin(matrix_, MAT_FINAL_ASSEMBLY));
    check(MatAssemblyEnd(matrix_, MAT_FINAL_ASSEMBLY));
    // hypre would keep a copy beside PETSc's matrix
    Mat copy = nullptr;
    check(MatConvert(matrix_, MATHYPRE, MAT_INITIAL_MATRIX, &copy));
    check(MatDestroy(&matrix_));
    matrix_ = copy;
}

void PressureHierarchy::createCycle()
{
    check(PCCreate(halo_.comm(), &cycle_));
    check(PCSetType(cycle_, PCHYPRE));
    check(PCHYPRESetType(cycle_, "boomeramg"));
    check(PCSetOptionsPrefix(cycle_, "pressure_"));
    const char* options[][2] = {{"coarsen_type", "PMIS"}, {"interp_type", "ext+i"}, {"strong_threshold", "0.25"},
        {"agg_nl", "1"}, {"P_max", "4"}, {"relax_type_coarse", "symmetric-SOR/Jacobi"}};
    for (auto& o : options)
    {
        const std::string key = std::string("-pressure_pc_hypre_boomeramg_") + o[0];
        PetscBool isSet;
        check(PetscOptionsHasName(nullptr, nullptr, key.c_str(), &isSet));
        if (!isSet) check(PetscOptionsSetValue(nullptr, key.c_str(), o[1]));
    }
    check(PCSetFromOptions(cycle_));
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
        for (int i = 0; i < mesh_.nOwned; ++i) weight_[i] = scale[i]/builtScale_[i];
        return;
    }
    check(PCDestroy(&cycle_));  // first: it keeps the old matrix and its levels
    createMatrix(system);
    fillMatrix(system);
    createCycle();
    check(PCSetOperators(cycle_, matrix_, matrix_));
    check(PCSetUp(cycle_));
    age_ = nSolves_ = leastIterations_ = lastExcess_ = sumOfExcess_ = 0;
    builtScale_ = scale;
    weight_.assign(mesh_.nOwned, 1.0);
}

void PressureHierarchy::apply(const double* r, double* p)
{
    PetscScalar* in;
    check(VecGetArrayWrite(in_, &in));
    for (int i = 0; i < mesh_.nOwned; ++i) in[i] = weight_[i]*r[i];
    check(VecRestoreArrayWrite(in_, &in));
    check(VecPlaceArray(out_, p));
    check(PCApply(cycle_, in_, out_));
    check(VecResetArray(out_));
    for (int i = 0; i < mesh_.nOwned; ++i) p[i] *= weight_[i];
}

void PressureHierarchy::countIterations(int iterations)
{
    if (nSolves_ == 0 || iterations < leastIterations_) leastIterations_ = iterations;
    ++nSolves_;
    lastExcess_ = iterations - leastIterations_;
    sumOfExcess_ += lastExcess_;
}

} // namespace flotsam
