// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/stopSignal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

namespace flotsam
{

namespace
{

volatile std::sig_atomic_t stopSignal = 0;
volatile std::sig_atomic_t writeSignal = 0;

extern "C" void onStop(int number)
{
    stopSignal = number;
    // the user insists: the next one is not caught
    if (number == SIGINT) std::signal(SIGINT, SIG_DFL);
}

extern "C" void onWrite(int)
{
    writeSignal = 1;
}

/// Open MPI's mpirun that is to end a job sends its processes SIGCONT first, then SIGTERM, then SIGKILL, `odls_base_sigkill_timeout` seconds apart.
/// It reads their output no more: writing to it must neither kill nor wait. A user who resumes mpirun sends SIGCONT, too: so the state is written, and the run goes on
/// until SIGTERM.
extern "C" void onContinue(int, siginfo_t* info, void*)
{
    if (info->si_code != SI_USER || info->si_pid != getppid()) return;
    writeSignal = 1;
    std::signal(SIGPIPE, SIG_IGN);
    for (const int output : {STDOUT_FILENO, STDERR_FILENO}) fcntl(output, F_SETFL, fcntl(output, F_GETFL) | O_NONBLOCK);
}

void install(int number, struct sigaction action)
{
    action.sa_flags |= SA_RESTART; // a file being written, a message being sent must not notice
    sigemptyset(&action.sa_mask);
    if (sigaction(number, &action, nullptr) != 0)
    {
        throw std::runtime_error("cannot install the handler of signal " + std::to_string(number) + " ("
            + std::strerror(errno) + ")");
    }
}

void install(int number, void (*handler)(int))
{
    struct sigaction action = {};
    action.sa_handler = handler;
    install(number, action);
}

void installContinue()
{
    struct sigaction action = {};
    action.sa_sigaction = onContinue;
    action.sa_flags = SA_SIGINFO;
    install(SIGCONT, action);
}

} // namespace

void installStopSignals()
{
    stopSignal = 0;
    writeSignal = 0;
    for (const int number : {SIGINT, SIGTERM, SIGUSR2}) install(number, onStop);
    install(SIGUSR1, onWrite);
    if (std::getenv("OMPI_COMM_WORLD_RANK")) installContinue();
}

bool stopRequested()
{
    return stopSignal != 0;
}

bool takeWriteRequest()
{
    const bool isRequested = writeSignal != 0;
    writeSignal = 0;
    return isRequested;
}

int stopSignalNumber()
{
    return stopSignal;
}

} // namespace flotsam
