// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/stopSignal.hpp"

#include <cerrno>
#include <csignal>
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

void install(int number, void (*handler)(int))
{
    struct sigaction action = {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART; // a file being written, a message being sent must not notice
    sigemptyset(&action.sa_mask);
    if (sigaction(number, &action, nullptr) != 0)
    {
        throw std::runtime_error("cannot install the handler of signal " + std::to_string(number) + " ("
            + std::strerror(errno) + ")");
    }
}

} // namespace

void installStopSignals()
{
    stopSignal = 0;
    writeSignal = 0;
    for (const int number : {SIGINT, SIGTERM, SIGUSR2}) install(number, onStop);
    install(SIGUSR1, onWrite);
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
