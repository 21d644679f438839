// SPDX-License-Identifier: GPL-3.0-or-later
/// For developers: work that a scene does not need, done all the same, to see what leaving it out saves (benchmarks/speed/skipping). Answers stay what they are.
/// Options of PETSc:  PETSC_OPTIONS="-needless_cut" flotsamFoam
///
///   -needless_cut         in every step, moving solids or not: distances at all nodes, all elements looked at, fixed solids cut again
///   -needless_insides     elements inside solids are assembled, their nodes are unknowns
///   -needless_assembly    the matrix is assembled again for every new contact load of a step
///   -needless_transport   the phase field is advanced in all elements
///   -needless_demSteps    LIGGGHTS takes contact's sub-steps in free flight
///   -pressure_max_age 0   the multigrid hierarchy is built in every step (PressureHierarchy)
#pragma once

namespace flotsam
{

/// Whether -needless_<work> is given. Looks it up: keep the answer.
bool doesNeedless(const char* work);

} // namespace flotsam
