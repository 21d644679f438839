// SPDX-License-Identifier: GPL-3.0-or-later
/// Communication of lists of any length, once a step at most (Halo is for more).
#pragma once

#include <mpi.h>

#include <cstdint>
#include <vector>

namespace flotsam
{

inline MPI_Datatype mpiTypeOf(const int*) { return MPI_INT; }
inline MPI_Datatype mpiTypeOf(const double*) { return MPI_DOUBLE; }
inline MPI_Datatype mpiTypeOf(const std::int64_t*) { return MPI_INT64_T; }

/// Collective. outgoing[r] goes to rank r; the result's entry r came from rank r.
template <class T>
std::vector<std::vector<T>> exchangeLists(const std::vector<std::vector<T>>& outgoing, MPI_Comm comm)
{
    constexpr int tag = 720;
    const int size = static_cast<int>(outgoing.size());
    std::vector<int> sendCount(size), receiveCount(size);
    for (int r = 0; r < size; ++r)
    {
        sendCount[r] = static_cast<int>(outgoing[r].size());
    }
    MPI_Alltoall(sendCount.data(), 1, MPI_INT, receiveCount.data(), 1, MPI_INT, comm);

    std::vector<std::vector<T>> incoming(size);
    std::vector<MPI_Request> requests;
    for (int r = 0; r < size; ++r)
    {
        incoming[r].resize(receiveCount[r]);
        if (receiveCount[r] > 0)
        {
            requests.emplace_back();
            MPI_Irecv(incoming[r].data(), receiveCount[r], mpiTypeOf(incoming[r].data()), r, tag, comm, &requests.back());
        }
    }
    for (int r = 0; r < size; ++r)
    {
        if (sendCount[r] > 0)
        {
            requests.emplace_back();
            MPI_Isend(outgoing[r].data(), sendCount[r], mpiTypeOf(outgoing[r].data()), r, tag, comm, &requests.back());
        }
    }
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
    return incoming;
}

/// Collective. The lists of all ranks, one after the other, into `all`, which keeps its memory.
inline void gatherAll(const std::vector<double>& mine, MPI_Comm comm, std::vector<double>& all)
{
    int size;
    MPI_Comm_size(comm, &size);
    if (size == 1)
    {
        all = mine;
        return;
    }
    const int n = static_cast<int>(mine.size());
    std::vector<int> counts(size), starts(size + 1, 0);
    MPI_Allgather(&n, 1, MPI_INT, counts.data(), 1, MPI_INT, comm);
    for (int r = 0; r < size; ++r) starts[r + 1] = starts[r] + counts[r];
    all.resize(starts.back());
    MPI_Allgatherv(mine.data(), n, MPI_DOUBLE, all.data(), counts.data(), starts.data(), MPI_DOUBLE, comm);
}
inline std::vector<double> gatherAll(const std::vector<double>& mine, MPI_Comm comm)
{
    std::vector<double> all;
    gatherAll(mine, comm, all);
    return all;
}

} // namespace flotsam
