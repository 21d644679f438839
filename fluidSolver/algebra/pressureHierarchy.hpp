// SPDX-License-Identifier: GPL-3.0-or-later
/// BoomerAMG on the Schur approximation of a FlowSystem (with the ghost faces' pressure part), and the decision when to build it anew.
///
/// Between, an old hierarchy serves the matrix in its scaled form: with the diagonal D then and now the cycle V becomes W V W, W^2 = D_then/D_now.
/// Where the surface passes a node its diagonal changes by the density ratio; unscaled, a cycle built for water there is a thousand times too
/// strong for gas, and each such node costs GMRES an iteration. A change of the time step is met exactly.
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

    /// A new step's system: builds the hierarchy when that pays. scale: nOwned, 1/sqrt(diagonal) of the pressure's rows.
    void update(const FlowSystem& system, const std::vector<double>& scale);
    /// Whether update() will build it.
    bool isWorn() const;
    bool isNew() const { return age_ == 0; }
    /// The next step builds it anew.
    void forget() { age_ = -1; }

    /// p (nOwned) = one V-cycle on r (nOwned).
    void apply(const double* r, double* p);

    /// Iterations that the first solve of a step took.
    void countIterations(int iterations);

private:
    void createMatrix(const FlowSystem& system);
    void fillMatrix(const FlowSystem& system);
    void addGhosts(const FlowSystem& system);
    void createCycle();

    const SimplexMesh& mesh_;
    const NodeGraph& graph_;
    const Halo& halo_;
    Mat matrix_ = nullptr;
    PC cycle_ = nullptr;
    Vec in_ = nullptr, out_ = nullptr;
    PetscInt maxAge_ = 20;      // steps it is kept at most
    int age_ = -1;              // steps since it was built
    int nSolves_ = 0, leastIterations_ = 0, lastExcess_ = 0, sumOfExcess_ = 0; // first solves of the steps since
    std::vector<double> builtScale_, weight_;   // nOwned: scale then; diagonal of W
};

} // namespace flotsam
