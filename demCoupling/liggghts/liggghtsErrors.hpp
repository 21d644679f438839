// SPDX-License-Identifier: GPL-3.0-or-later
/// LIGGGHTS ends the process (MPI_Abort, exit) when it meets an error. This file's .cpp defines LIGGGHTS' own Error
/// methods anew, so that the dynamic linker binds the library's calls to ours, which throw DemError.
#pragma once

namespace flotsam
{

/// Throws DemError when the library would still call its own Error methods (wrong link order, hidden symbols).
/// Must be called before the first instance is opened; also keeps the object file from being dropped by the linker.
void checkErrorsAreCaught();

} // namespace flotsam
