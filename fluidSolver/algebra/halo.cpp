// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/halo.hpp"

#include <algorithm>
#include <stdexcept>

namespace flotsam
{
namespace
{

constexpr int updateTag = 710, sumTag = 711, requestTag = 712;

MPI_Datatype mpiType(double) { return MPI_DOUBLE; }
MPI_Datatype mpiType(int) { return MPI_INT; }

/// One message each way per neighbour: part k of `out` goes to neighbour k, part k of `in` comes from it.
template <class T>
void exchange(const std::vector<int>& neighbours, const std::vector<int>& outStart, const T* out,
    const std::vector<int>& inStart, T* in, int width, int tag, MPI_Comm comm)
{
    const int n = static_cast<int>(neighbours.size());
    std::vector<MPI_Request> requests(2 * n, MPI_REQUEST_NULL);
    for (int k = 0; k < n; ++k)
    {
        const int count = (inStart[k + 1] - inStart[k]) * width;
        if (count > 0)
        {
            MPI_Irecv(in + static_cast<std::size_t>(inStart[k]) * width, count, mpiType(T()), neighbours[k], tag, comm, &requests[k]);
        }
    }
    for (int k = 0; k < n; ++k)
    {
        const int count = (outStart[k + 1] - outStart[k]) * width;
        if (count > 0)
        {
            MPI_Isend(out + static_cast<std::size_t>(outStart[k]) * width, count, mpiType(T()), neighbours[k], tag, comm, &requests[n + k]);
        }
    }
    MPI_Waitall(2 * n, requests.data(), MPI_STATUSES_IGNORE);
}

template <class T>
void gather(const std::vector<int>& nodes, const T* values, int width, std::vector<T>& buffer)
{
    buffer.resize(nodes.size() * width);
    for (std::size_t k = 0; k < nodes.size(); ++k)
    {
        std::copy_n(values + static_cast<std::size_t>(nodes[k]) * width, width, buffer.begin() + k * width);
    }
}

template <class T>
void scatter(const std::vector<int>& nodes, const std::vector<T>& buffer, int width, T* values)
{
    for (std::size_t k = 0; k < nodes.size(); ++k)
    {
        std::copy_n(buffer.begin() + k * width, width, values + static_cast<std::size_t>(nodes[k]) * width);
    }
}

long countMessages(const std::vector<int>& start)
{
    long messages = 0;
    for (std::size_t k = 0; k + 1 < start.size(); ++k)
    {
        messages += start[k + 1] > start[k];
    }
    return messages;
}

} // namespace

Halo::Halo(const SimplexMesh& mesh, MPI_Comm comm) : comm_(comm)
{
    MPI_Comm_rank(comm_, &rank_);
    MPI_Comm_size(comm_, &size_);

    std::vector<int> wanted(size_, 0), requested(size_, 0);
    for (int i = mesh.nOwned; i < mesh.nNodes; ++i)
    {
        ++wanted[mesh.nodeOwner[i]];
    }
    MPI_Alltoall(wanted.data(), 1, MPI_INT, requested.data(), 1, MPI_INT, comm_);

    std::vector<int> neighbourOfRank(size_, -1);
    sendStart_.assign(1, 0);
    receiveStart_.assign(1, 0);
    for (int r = 0; r < size_; ++r)
    {
        if (wanted[r] > 0 || requested[r] > 0)
        {
            neighbourOfRank[r] = static_cast<int>(neighbours_.size());
            neighbours_.push_back(r);
            receiveStart_.push_back(receiveStart_.back() + wanted[r]);
            sendStart_.push_back(sendStart_.back() + requested[r]);
        }
    }

    // the request names the nodes by their row on the owner, so that nobody has to search
    receiveNode_.resize(receiveStart_.back());
    std::vector<int> next(receiveStart_.begin(), receiveStart_.end() - 1);
    for (int i = mesh.nOwned; i < mesh.nNodes; ++i)
    {
        receiveNode_[next[neighbourOfRank[mesh.nodeOwner[i]]]++] = i;
    }
    std::vector<std::int64_t> firstOfRank(size_);
    MPI_Allgather(&mesh.firstGlobal, 1, MPI_INT64_T, firstOfRank.data(), 1, MPI_INT64_T, comm_);
    std::vector<int> request(receiveNode_.size());
    for (std::size_t k = 0; k < request.size(); ++k)
    {
        const int i = receiveNode_[k];
        request[k] = static_cast<int>(mesh.globalNode[i] - firstOfRank[mesh.nodeOwner[i]]);
    }
    sendNode_.resize(sendStart_.back());
    exchange(neighbours_, receiveStart_, request.data(), sendStart_, sendNode_.data(), 1, requestTag, comm_);
    for (const int i : sendNode_)
    {
        if (i < 0 || i >= mesh.nOwned)
        {
            throw std::runtime_error("halo: another rank asks for a node that this rank does not own (globalNode and nodeOwner disagree)");
        }
    }
}

void Halo::update(double* values, int width) const
{
    if (neighbours_.empty())
    {
        return;
    }
    gather(sendNode_, values, width, sendBuffer_);
    receiveBuffer_.resize(receiveNode_.size() * width);
    exchange(neighbours_, sendStart_, sendBuffer_.data(), receiveStart_, receiveBuffer_.data(), width, updateTag, comm_);
    scatter(receiveNode_, receiveBuffer_, width, values);
    counters_.messages += countMessages(sendStart_);
    counters_.bytes += static_cast<long>(sendBuffer_.size() * sizeof(double));
}

void Halo::update(std::vector<int>& values, int width) const
{
    if (neighbours_.empty())
    {
        return;
    }
    std::vector<int> send, receive(receiveNode_.size() * width);
    gather(sendNode_, values.data(), width, send);
    exchange(neighbours_, sendStart_, send.data(), receiveStart_, receive.data(), width, updateTag, comm_);
    scatter(receiveNode_, receive, width, values.data());
    counters_.messages += countMessages(sendStart_);
    counters_.bytes += static_cast<long>(send.size() * sizeof(int));
}

void Halo::sumToOwners(std::vector<double>& values, int width) const
{
    if (neighbours_.empty())
    {
        return;
    }
    gather(receiveNode_, values.data(), width, receiveBuffer_);
    sendBuffer_.resize(sendNode_.size() * width);
    exchange(neighbours_, receiveStart_, receiveBuffer_.data(), sendStart_, sendBuffer_.data(), width, sumTag, comm_);
    for (std::size_t k = 0; k < sendNode_.size(); ++k)
    {
        for (int c = 0; c < width; ++c)
        {
            values[static_cast<std::size_t>(sendNode_[k]) * width + c] += sendBuffer_[k * width + c];
        }
    }
    counters_.messages += countMessages(receiveStart_);
    counters_.bytes += static_cast<long>(receiveBuffer_.size() * sizeof(double));
}

double Halo::sum(double value) const
{
    sum(&value, 1);
    return value;
}

double Halo::max(double value) const
{
    ++counters_.reductions;
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, comm_);
    return value;
}

double Halo::min(double value) const
{
    ++counters_.reductions;
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MIN, comm_);
    return value;
}

long Halo::sum(long value) const
{
    ++counters_.reductions;
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_LONG, MPI_SUM, comm_);
    return value;
}

void Halo::sum(double* values, int n) const
{
    ++counters_.reductions;
    MPI_Allreduce(MPI_IN_PLACE, values, n, MPI_DOUBLE, MPI_SUM, comm_);
}

bool Halo::any(bool value) const
{
    ++counters_.reductions;
    int flag = value;
    MPI_Allreduce(MPI_IN_PLACE, &flag, 1, MPI_INT, MPI_LOR, comm_);
    return flag != 0;
}

} // namespace flotsam
