// SPDX-License-Identifier: GPL-3.0-or-later
/// BoomerAMG on the Schur approximation of a FlowSystem (with the ghost faces' pressure part), and the decision when to build it anew.
#pragma once

#include "algebra/flowSystem.hpp"
#include "algebra/halo.hpp"

#include <petscpc.h>

namespace flotsam
{

inline bool isFreePressure(const FlowSystem& system, int i) { return system.isActive[i] && !system.isPressureFixed[i]; }

inline double schurDiagonal(const FlowSystem& system, const NodeGraph& graph, int i)
{
    const double d = system.schur[graph.diagonal[i]];
    return d > 0 ? d : 1;
}

class PressureHierarchy
{
public:
    PressureHierarchy(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo);
    ~PressureHierarchy();
    PressureHierarchy(const PressureHierarchy&) = delete;
    PressureHierarchy& operator=(const PressureHierarchy&) = delete;

    /// A new step's system: builds the hierarchy when that pays.
    void update(const FlowSystem& system);
    bool isNew() const { return age_ == 0; }

    /// p (nOwned) = one V-cycle on r (nOwned). Both arrays are the caller's.
    void apply(const double* r, double* p);

    /// Iterations that the first solve of a step took.
    void countIterations(int iterations);

private:
    void createMatrix(const FlowSystem& system);
    void fillMatrix(const FlowSystem& system);
    void addGhosts(const FlowSystem& system);
    void createCycle();
    double typicalDiagonal(const FlowSystem& system) const;
    bool isWorn(const FlowSystem& system, double typical) const;

    const SimplexMesh& mesh_;
    const NodeGraph& graph_;
    const Halo& halo_;
    Mat matrix_ = nullptr;
    PC cycle_ = nullptr;
    Vec in_ = nullptr, out_ = nullptr;
    int age_ = -1;              // steps since it was built
    int nSolves_ = 0, leastIterations_ = 0, lastExcess_ = 0, sumOfExcess_ = 0; // first solves of the steps since
    double builtFor_ = 0;       // typical diagonal then
};

} // namespace flotsam
