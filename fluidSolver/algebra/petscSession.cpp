// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/flowLinearSolver.hpp"

#include <petscksp.h>

namespace flotsam
{

PetscSession::PetscSession(MPI_Comm comm)
{
    int isRunning = 0;
    MPI_Initialized(&isRunning);
    if (isRunning) PETSC_COMM_WORLD = comm;
    // OpenFOAM's handlers for floating point errors and signals stay in force
    PetscOptionsSetValue(nullptr, "-no_signal_handler", "true");
    PetscInitializeNoArguments();
}

PetscSession::~PetscSession()
{
    int isOver = 0;
    MPI_Finalized(&isOver);
    if (!isOver) PetscFinalize();
}

} // namespace flotsam
