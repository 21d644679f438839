// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/stopSignal.hpp"

#include <doctest/doctest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <initializer_list>

using namespace flotsam;

TEST_CASE("a signal to end is remembered, the process goes on")
{
    for (const int number : {SIGTERM, SIGUSR2, SIGINT})
    {
        installStopSignals();
        CHECK(!stopRequested());
        CHECK(stopSignalNumber() == 0);
        raise(number);
        CHECK(stopRequested());
        CHECK(stopSignalNumber() == number);
    }
}

TEST_CASE("a request to write is taken once and ends nothing")
{
    installStopSignals();
    CHECK(!takeWriteRequest());
    raise(SIGUSR1);
    CHECK(takeWriteRequest());
    CHECK(!takeWriteRequest());
    CHECK(!stopRequested());
}

TEST_CASE("a second SIGINT kills at once")
{
    const pid_t child = fork();
    if (child == 0)
    {
        for (const int number : {SIGINT, SIGTERM, SIGSEGV}) std::signal(number, SIG_DFL); // not the test driver's
        installStopSignals();
        raise(SIGINT);
        if (!stopRequested()) _exit(1);
        raise(SIGINT);
        _exit(2);
    }
    int status = 0;
    waitpid(child, &status, 0);
    REQUIRE(WIFSIGNALED(status));
    CHECK(WTERMSIG(status) == SIGINT);
}
