// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/needlessWork.hpp"

#include "algebra/petscCalls.hpp"

namespace flotsam
{

bool doesNeedless(const char* work)
{
    PetscBool isRunning = PETSC_FALSE, isGiven = PETSC_FALSE;
    check(PetscInitialized(&isRunning));
    if (isRunning) check(PetscOptionsHasName(nullptr, nullptr, ("-needless_" + std::string(work)).c_str(), &isGiven));
    return isGiven;
}

} // namespace flotsam
