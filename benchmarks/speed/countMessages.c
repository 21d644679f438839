// SPDX-License-Identifier: GPL-3.0-or-later
// Counts the MPI messages, bytes and collective calls of a program, for LD_PRELOAD: standard profiling interface (PMPI), no
// change of the program. At MPI_Finalize rank 0 appends one line to the file $MESSAGE_COUNTS:
//   ranks  messages(sum max)  bytes(sum max)  allreduce(max)  other collectives(max)  work of the ranks [us], one after the other
// max: largest of a rank. Start-up is in it: subtract two runs. work: processor time outside MPI, so without what waiting
// for another rank burns; unlike clock time it does not depend on what else the cores do.
#include <mpi.h>

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { nSlots = 1 << 16 };

static long long messages, bytes, reductions, collectives;
static long long inside;    // processor time within MPI [ns]

static long long processorTime(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1000000000LL * now.tv_sec + now.tv_nsec;
}

// RESULT_OF(call): its result, its time charged to MPI
#define RESULT_OF(call) \
    const long long before = processorTime(); \
    const int result = call; \
    inside += processorTime() - before; \
    return result;

// persistent sends: size of the message that MPI_Start sends
static struct { MPI_Request request; long long bytes; int destination; } persistent[nSlots];

static void countSend(long long size, int destination)
{
    if (destination == MPI_PROC_NULL) return;
    ++messages;
    bytes += size;
}

static long long sizeOf(int count, MPI_Datatype type)
{
    int size = 0;
    PMPI_Type_size(type, &size);
    return (long long)size * count;
}

static size_t slotOf(MPI_Request request)
{
    size_t slot = ((size_t)request >> 4) % nSlots;
    for (int tries = 0; tries < nSlots; ++tries, slot = (slot + 1) % nSlots)
        if (persistent[slot].request == request || persistent[slot].request == 0) return slot;
    return 0;
}

static void countStart(MPI_Request request)
{
    const size_t slot = slotOf(request);
    if (persistent[slot].request == request) countSend(persistent[slot].bytes, persistent[slot].destination);
}

#define SEND_PARAMETERS const void *data, int count, MPI_Datatype type, int destination, int tag, MPI_Comm comm
#define BLOCKING(name) \
    int MPI_##name(SEND_PARAMETERS) \
    { \
        countSend(sizeOf(count, type), destination); \
        RESULT_OF(PMPI_##name(data, count, type, destination, tag, comm)) \
    }
#define NONBLOCKING(name) \
    int MPI_##name(SEND_PARAMETERS, MPI_Request* request) \
    { \
        countSend(sizeOf(count, type), destination); \
        RESULT_OF(PMPI_##name(data, count, type, destination, tag, comm, request)) \
    }
#define PERSISTENT(name) \
    int MPI_##name(SEND_PARAMETERS, MPI_Request* request) \
    { \
        const int result = PMPI_##name(data, count, type, destination, tag, comm, request); \
        const size_t slot = slotOf(*request); \
        persistent[slot].request = *request; \
        persistent[slot].bytes = sizeOf(count, type); \
        persistent[slot].destination = destination; \
        return result; \
    }
/// A communicator of one process (the DEM engine has one) does not communicate.
static int isShared(MPI_Comm comm)
{
    int size = 1;
    PMPI_Comm_size(comm, &size);
    return size > 1;
}

#define COLLECTIVE(name, counter, parameters, arguments) \
    int MPI_##name parameters { counter += isShared(c); RESULT_OF(PMPI_##name arguments) }

BLOCKING(Send)
BLOCKING(Ssend)
BLOCKING(Bsend)
BLOCKING(Rsend)
NONBLOCKING(Isend)
NONBLOCKING(Issend)
NONBLOCKING(Ibsend)
NONBLOCKING(Irsend)
PERSISTENT(Send_init)
PERSISTENT(Ssend_init)
PERSISTENT(Rsend_init)

// a receive may get the handle of a persistent send that was freed
int MPI_Recv_init(void* data, int count, MPI_Datatype type, int source, int tag, MPI_Comm comm, MPI_Request* request)
{
    const int result = PMPI_Recv_init(data, count, type, source, tag, comm, request);
    const size_t slot = slotOf(*request);
    persistent[slot].request = *request;
    persistent[slot].destination = MPI_PROC_NULL;
    return result;
}

int MPI_Start(MPI_Request* request)
{
    countStart(*request);
    RESULT_OF(PMPI_Start(request))
}

int MPI_Startall(int count, MPI_Request requests[])
{
    for (int i = 0; i < count; ++i) countStart(requests[i]);
    RESULT_OF(PMPI_Startall(count, requests))
}

int MPI_Sendrecv(const void* sent, int sentCount, MPI_Datatype sentType, int destination, int sentTag, void* received, int count,
    MPI_Datatype type, int source, int tag, MPI_Comm comm, MPI_Status* status)
{
    countSend(sizeOf(sentCount, sentType), destination);
    RESULT_OF(PMPI_Sendrecv(sent, sentCount, sentType, destination, sentTag, received, count, type, source, tag, comm, status))
}

// where a rank waits
#define WAITING(name, parameters, arguments) \
    int MPI_##name parameters { RESULT_OF(PMPI_##name arguments) }

WAITING(Recv, (void* a, int n, MPI_Datatype t, int source, int tag, MPI_Comm c, MPI_Status* s), (a, n, t, source, tag, c, s))
WAITING(Irecv, (void* a, int n, MPI_Datatype t, int source, int tag, MPI_Comm c, MPI_Request* r), (a, n, t, source, tag, c, r))
WAITING(Wait, (MPI_Request* r, MPI_Status* s), (r, s))
WAITING(Waitall, (int n, MPI_Request r[], MPI_Status* s), (n, r, s))
WAITING(Waitany, (int n, MPI_Request r[], int* i, MPI_Status* s), (n, r, i, s))
WAITING(Waitsome, (int n, MPI_Request r[], int* done, int i[], MPI_Status* s), (n, r, done, i, s))
WAITING(Test, (MPI_Request* r, int* flag, MPI_Status* s), (r, flag, s))
WAITING(Testall, (int n, MPI_Request r[], int* flag, MPI_Status* s), (n, r, flag, s))
WAITING(Testany, (int n, MPI_Request r[], int* i, int* flag, MPI_Status* s), (n, r, i, flag, s))
WAITING(Probe, (int source, int tag, MPI_Comm c, MPI_Status* s), (source, tag, c, s))
WAITING(Iprobe, (int source, int tag, MPI_Comm c, int* flag, MPI_Status* s), (source, tag, c, flag, s))

COLLECTIVE(Allreduce, reductions, (const void* a, void* b, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c), (a, b, n, t, o, c))
COLLECTIVE(Iallreduce, reductions, (const void* a, void* b, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c, MPI_Request* r), (a, b, n, t, o, c, r))
COLLECTIVE(Reduce, collectives, (const void* a, void* b, int n, MPI_Datatype t, MPI_Op o, int root, MPI_Comm c), (a, b, n, t, o, root, c))
COLLECTIVE(Bcast, collectives, (void* a, int n, MPI_Datatype t, int root, MPI_Comm c), (a, n, t, root, c))
COLLECTIVE(Barrier, collectives, (MPI_Comm c), (c))
COLLECTIVE(Scan, collectives, (const void* a, void* b, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c), (a, b, n, t, o, c))
COLLECTIVE(Exscan, collectives, (const void* a, void* b, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c), (a, b, n, t, o, c))
COLLECTIVE(Gather, collectives, (const void* a, int n, MPI_Datatype t, void* b, int m, MPI_Datatype u, int root, MPI_Comm c), (a, n, t, b, m, u, root, c))
COLLECTIVE(Gatherv, collectives, (const void* a, int n, MPI_Datatype t, void* b, const int m[], const int d[], MPI_Datatype u, int root, MPI_Comm c),
    (a, n, t, b, m, d, u, root, c))
COLLECTIVE(Allgather, collectives, (const void* a, int n, MPI_Datatype t, void* b, int m, MPI_Datatype u, MPI_Comm c), (a, n, t, b, m, u, c))
COLLECTIVE(Allgatherv, collectives, (const void* a, int n, MPI_Datatype t, void* b, const int m[], const int d[], MPI_Datatype u, MPI_Comm c),
    (a, n, t, b, m, d, u, c))
COLLECTIVE(Alltoall, collectives, (const void* a, int n, MPI_Datatype t, void* b, int m, MPI_Datatype u, MPI_Comm c), (a, n, t, b, m, u, c))
COLLECTIVE(Alltoallv, collectives, (const void* a, const int n[], const int d[], MPI_Datatype t, void* b, const int m[], const int e[], MPI_Datatype u, MPI_Comm c),
    (a, n, d, t, b, m, e, u, c))

static void report(void)
{
    const long long work = (processorTime() - inside) / 1000;
    int rank = 0, size = 1;
    PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
    PMPI_Comm_size(MPI_COMM_WORLD, &size);
    const long long mine[4] = {messages, bytes, reductions, collectives};
    long long sum[4], largest[4];
    PMPI_Reduce(mine, sum, 4, MPI_LONG_LONG, MPI_SUM, 0, MPI_COMM_WORLD);
    PMPI_Reduce(mine, largest, 4, MPI_LONG_LONG, MPI_MAX, 0, MPI_COMM_WORLD);
    long long* works = malloc((size_t)size * sizeof *works);
    PMPI_Gather(&work, 1, MPI_LONG_LONG, works, 1, MPI_LONG_LONG, 0, MPI_COMM_WORLD);
    const char* name = getenv("MESSAGE_COUNTS");
    FILE* file = rank == 0 && name ? fopen(name, "a") : 0;
    if (file)
    {
        fprintf(file, "%d %lld %lld %lld %lld %lld %lld", size, sum[0], largest[0], sum[1], largest[1], largest[2], largest[3]);
        for (int i = 0; i < size; ++i) fprintf(file, " %lld", works[i]);
        fprintf(file, "\n");
        fclose(file);
    }
    free(works);
}

int MPI_Finalize(void)
{
    report();
    return PMPI_Finalize();
}
