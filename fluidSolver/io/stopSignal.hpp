// SPDX-License-Identifier: GPL-3.0-or-later
/// Signals a user sends to a running computation. The handlers only set a flag; the main loop asks between steps.
#pragma once

namespace flotsam
{

/// SIGINT (Ctrl-C), SIGTERM, SIGUSR2: end after this step, with everything written. SIGUSR1: write now and go on.
/// A second SIGINT ends the process at once. Call after OpenFOAM has installed its own handlers (argList, Time).
/// Open MPI's mpirun passes SIGUSR1 and SIGUSR2 on. After SIGINT or SIGTERM it ends its processes: their first notice of that (SIGCONT from
/// the parent) counts as SIGUSR1, SIGTERM follows `odls_base_sigkill_timeout` seconds later (3 by scripts/environment.sh, 1 by default), SIGKILL again as long after.
void installStopSignals();

/// This process has been asked to end. Ranks may hear of it at different steps: combine with a maximum over the ranks.
bool stopRequested();

/// True once per SIGUSR1: the request is taken by asking.
bool takeWriteRequest();

/// Number of the signal that asked to end, 0 if none.
int stopSignalNumber();

} // namespace flotsam
