// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/viscousBlock.hpp"

#include "algebra/petscCalls.hpp"

#include <cmath>

namespace flotsam
{

namespace
{

constexpr double aligned = 1 - 1e-6;    // of a prescribed direction: it is that of a component

} // namespace

ViscousBlock::ViscousBlock(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo)
:   mesh_(mesh), graph_(graph), halo_(halo), isFree_(std::size_t(mesh.nNodes)*mesh.dim), scale_(mesh.nOwned), in_(mesh.nOwned), out_(mesh.nOwned)
{
    for (int d = 0; d < mesh.dim; ++d) cycles_.push_back(std::make_unique<ScaledCycle>(mesh, graph, halo, "velocity_"));
}

/// Slanted directions are left to the projection that follows.
void ViscousBlock::findHeld(const FlowSystem& system)
{
    const int dim = mesh_.dim;
    for (int i = 0; i < mesh_.nNodes; ++i)
        for (int d = 0; d < dim; ++d) isFree_[std::size_t(i)*dim + d] = system.isActive[i];
    for (const NodeConstraint& c : system.constraints)
        for (int d = 0; d < dim; ++d)
        {
            bool isHeld = c.nDirections >= dim;
            for (int k = 0; k < c.nDirections; ++k) isHeld = isHeld || std::abs(c.direction[k][d]) > aligned;
            if (isHeld) isFree_[std::size_t(c.node)*dim + d] = 0;
        }
    halo_.update(isFree_, dim);
}

void ViscousBlock::fill(const FlowSystem& system, int component, Mat matrix)
{
    const int dim = mesh_.dim;
    const auto add = [&](int row, int column, double value)
    {
        const PetscInt i = mesh_.globalNode[row], j = mesh_.globalNode[column];
        check(MatSetValues(matrix, 1, &i, 1, &j, &value, ADD_VALUES));
    };
    for (int i = 0; i < mesh_.nOwned; ++i)
        for (int k = graph_.rowStart[i]; k < graph_.rowStart[i + 1]; ++k)
        {
            const int j = graph_.column[k];
            const double value = system.matrix.velocity[(std::size_t(k)*dim + component)*dim + component];
            if (i == j) add(i, i, isFree(i, component) ? value : 1);
            else add(i, j, isFree(i, component) && isFree(j, component) ? value : 0);
        }
    for (const GhostTerm& g : system.ghosts)
        for (int a = 0; a < dim + 2; ++a)
            for (int b = 0; b < dim + 2 && g.node[a] < mesh_.nOwned && isFree(g.node[a], component); ++b)
                if (isFree(g.node[b], component)) add(g.node[a], g.node[b], g.velocityFactor*g.jumpVelocity[a]*g.jumpVelocity[b]);
}

void ViscousBlock::setScale(const std::vector<double>& scale)
{
    for (int i = 0; i < mesh_.nOwned; ++i) scale_[i] = scale[std::size_t(i)*(mesh_.dim + 1)];
}

void ViscousBlock::build(const FlowSystem& system, const std::vector<double>& scale)
{
    findHeld(system);
    setScale(scale);
    for (int d = 0; d < mesh_.dim; ++d)
    {
        fill(system, d, cycles_[d]->newMatrix(system));
        cycles_[d]->build(scale_);
    }
}

void ViscousBlock::rescale(const std::vector<double>& scale)
{
    setScale(scale);
    for (auto& cycle : cycles_) cycle->rescale(scale_);
}

void ViscousBlock::solve(const double* r, const double* scale, double* z)
{
    const int dim = mesh_.dim, B = dim + 1;
    for (int d = 0; d < dim; ++d)
    {
        for (int i = 0; i < mesh_.nOwned; ++i) in_[i] = r[std::size_t(i)*B + d]/scale[std::size_t(i)*B];
        cycles_[d]->apply(in_.data(), out_.data());
        for (int i = 0; i < mesh_.nOwned; ++i) z[std::size_t(i)*B + d] = out_[i];
    }
    for (int i = 0; i < mesh_.nOwned; ++i) z[std::size_t(i)*B + dim] = 0;
}

void ViscousBlock::subtract(const double* g, double* z)
{
    const int dim = mesh_.dim;
    for (int d = 0; d < dim; ++d)
    {
        for (int i = 0; i < mesh_.nOwned; ++i) in_[i] = isFree(i, d) ? g[std::size_t(i)*dim + d] : 0;
        cycles_[d]->apply(in_.data(), out_.data());
        for (int i = 0; i < mesh_.nOwned; ++i) z[std::size_t(i)*(dim + 1) + d] -= out_[i];
    }
}

} // namespace flotsam
