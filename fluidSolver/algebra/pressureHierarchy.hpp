// SPDX-License-Identifier: GPL-3.0-or-later
/// BoomerAMG on the Schur approximation of a FlowSystem (with the ghost faces' pressure part), and the decision when to build it anew.
#pragma once

#include "algebra/scaledCycle.hpp"

namespace flotsam
{

class PressureHierarchy
{
public:
    PressureHierarchy(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo);

    /// A new step's system: builds the hierarchy when that pays. scale: nOwned, 1/sqrt(diagonal) of the pressure's rows.
    void update(const FlowSystem& system, const std::vector<double>& scale);
    /// Whether update() will build it.
    bool isWorn() const;
    bool isNew() const { return age_ == 0; }
    /// The next step builds it anew.
    void forget() { age_ = -1; }

    /// p (nOwned) = one V-cycle on r (nOwned).
    void apply(const double* r, double* p) { cycle_.apply(r, p); }

    /// Iterations that the first solve of a step took.
    void countIterations(int iterations);

private:
    void fillMatrix(const FlowSystem& system, Mat matrix);
    void addGhosts(const FlowSystem& system, Mat matrix);

    const SimplexMesh& mesh_;
    const NodeGraph& graph_;
    ScaledCycle cycle_;
    PetscInt maxAge_ = 20;      // steps it is kept at most
    int age_ = -1;              // steps since it was built
    int nSolves_ = 0, leastIterations_ = 0, lastExcess_ = 0, sumOfExcess_ = 0; // first solves of the steps since
};

} // namespace flotsam
