// SPDX-License-Identifier: GPL-3.0-or-later
/// What every call of PETSc needs.
#pragma once

#include <petscsys.h>

#include <cfenv>
#include <stdexcept>
#include <string>

namespace flotsam
{

inline void check(PetscErrorCode error)
{
    if (error) throw std::runtime_error("PETSc error " + std::to_string(int(error)) + " in the flow solver");
}

/// Switches floating point traps off while a library runs that divides 0 by 0 harmlessly.
class NoFloatingPointTraps
{
public:
    NoFloatingPointTraps() : enabled_(fegetexcept()) { fedisableexcept(FE_ALL_EXCEPT); }
    ~NoFloatingPointTraps() { std::feclearexcept(FE_ALL_EXCEPT); feenableexcept(enabled_); }
private:
    int enabled_;
};

} // namespace flotsam
