// SPDX-License-Identifier: GPL-3.0-or-later
/// Signals a user sends to a running computation. The handlers only set a flag; the main loop asks between steps.
#pragma once

namespace flotsam
{

/// SIGINT (Ctrl-C), SIGTERM, SIGUSR2: end after this step, with everything written. SIGUSR1: write now and go on.
/// A second SIGINT ends the process at once. Call after OpenFOAM has installed its own handlers (argList, Time).
/// In parallel send SIGUSR2 or SIGUSR1 to mpirun: it passes these on to the ranks, while after SIGINT or SIGTERM it kills
/// them within a second (Open MPI).
void installStopSignals();

/// This process has been asked to end. Ranks may hear of it at different steps: combine with a maximum over the ranks.
bool stopRequested();

/// True once per SIGUSR1: the request is taken by asking.
bool takeWriteRequest();

/// Number of the signal that asked to end, 0 if none.
int stopSignalNumber();

} // namespace flotsam
