// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/stopSignal.hpp"

#include <doctest/doctest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
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

TEST_CASE("mpirun's first notice that it ends the job has the state written, a SIGCONT of others nothing")
{
    setenv("OMPI_COMM_WORLD_RANK", "0", 1);
    installStopSignals();
    raise(SIGCONT); // by this process, as a shell's
    CHECK(!takeWriteRequest());
    const pid_t child = fork();
    if (child == 0)
    {
        bool isRequested = false;
        for (int k = 0; k < 500 && !isRequested; ++k)
        {
            usleep(10000);
            isRequested = takeWriteRequest();
        }
        _exit(isRequested && !stopRequested() ? 0 : 1);
    }
    usleep(20000);
    kill(child, SIGCONT); // by the parent, as mpirun's
    int status = 0;
    waitpid(child, &status, 0);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
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
