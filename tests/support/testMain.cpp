// SPDX-License-Identifier: GPL-3.0-or-later
/// Test driver: doctest inside MPI. Every rank runs every test; the exit code is the worst of the ranks.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>
#include <mpi.h>

int main(int argc, char** argv)
{
    MPI_Init(&argc, &argv);
    const int failed = doctest::Context(argc, argv).run();
    int worst = 0;
    MPI_Allreduce(&failed, &worst, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    MPI_Finalize();
    return worst;
}
