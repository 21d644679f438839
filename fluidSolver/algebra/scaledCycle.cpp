// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/scaledCycle.hpp"

#include "algebra/petscCalls.hpp"

namespace flotsam
{

ScaledCycle::ScaledCycle(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const char* prefix)
:   mesh_(mesh), graph_(graph), halo_(halo), prefix_(prefix)
{}

ScaledCycle::~ScaledCycle()
{
    PCDestroy(&cycle_);
    MatDestroy(&matrix_);
    VecDestroy(&in_);
    VecDestroy(&out_);
}

Mat ScaledCycle::newMatrix(const FlowSystem& system)
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
    check(PCDestroy(&cycle_));  // before a new one needs memory: it keeps the old matrix and its levels
    check(MatDestroy(&matrix_));
    check(MatCreateAIJ(halo_.comm(), n, n, PETSC_DETERMINE, PETSC_DETERMINE, 0, diagonal.data(), 0, offDiagonal.data(), &matrix_));
    return matrix_;
}

void ScaledCycle::create()
{
    if (!in_)
    {
        check(VecCreateMPI(halo_.comm(), mesh_.nOwned, PETSC_DETERMINE, &in_));
        check(VecCreateMPIWithArray(halo_.comm(), 1, mesh_.nOwned, PETSC_DETERMINE, nullptr, &out_));
    }
    check(PCCreate(halo_.comm(), &cycle_));
    check(PCSetType(cycle_, PCHYPRE));
    check(PCHYPRESetType(cycle_, "boomeramg"));
    check(PCSetOptionsPrefix(cycle_, prefix_.c_str()));
    const char* options[][2] = {{"coarsen_type", "PMIS"}, {"interp_type", "ext+i"}, {"strong_threshold", "0.25"},
        {"agg_nl", "1"}, {"P_max", "4"}, {"relax_type_coarse", "symmetric-SOR/Jacobi"}};
    for (auto& o : options)
    {
        const std::string key = "-" + prefix_ + "pc_hypre_boomeramg_" + o[0];
        PetscBool isSet;
        check(PetscOptionsHasName(nullptr, nullptr, key.c_str(), &isSet));
        if (!isSet) check(PetscOptionsSetValue(nullptr, key.c_str(), o[1]));
    }
    check(PCSetFromOptions(cycle_));
}

void ScaledCycle::build(const std::vector<double>& scale)
{
    check(MatAssemblyBegin(matrix_, MAT_FINAL_ASSEMBLY));
    check(MatAssemblyEnd(matrix_, MAT_FINAL_ASSEMBLY));
    // hypre would keep a copy beside PETSc's matrix
    Mat copy = nullptr;
    check(MatConvert(matrix_, MATHYPRE, MAT_INITIAL_MATRIX, &copy));
    check(MatDestroy(&matrix_));
    matrix_ = copy;
    create();
    check(PCSetOperators(cycle_, matrix_, matrix_));
    check(PCSetUp(cycle_));
    builtScale_ = scale;
    weight_.assign(mesh_.nOwned, 1.0);
}

void ScaledCycle::rescale(const std::vector<double>& scale)
{
    for (int i = 0; i < mesh_.nOwned; ++i) weight_[i] = scale[i]/builtScale_[i];
}

void ScaledCycle::apply(const double* r, double* p)
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

} // namespace flotsam
