// SPDX-License-Identifier: GPL-3.0-or-later
/// Exchange of nodal values between ranks: owners send, halo copies receive.
#pragma once

#include "core/simplexMesh.hpp"

#include <mpi.h>

namespace flotsam
{

class Halo
{
public:
    /// Collective. Works out from mesh.globalNode / nodeOwner who sends what.
    Halo(const SimplexMesh& mesh, MPI_Comm comm);

    /// Overwrites the entries of the halo nodes with the owners' values. values: nNodes*width, interleaved.
    void update(double* values, int width) const;
    void update(std::vector<double>& values, int width) const { update(values.data(), width); }
    void update(std::vector<int>& values, int width) const;

    /// Adds the halo copies' contributions into the owners' entries (halo entries are left as they are).
    void sumToOwners(std::vector<double>& values, int width) const;

    double sum(double) const;           ///< over ranks
    double max(double) const;
    double min(double) const;
    long sum(long) const;
    void sum(double* values, int n) const;  ///< in place, the same result on every rank
    bool any(bool) const;
    MPI_Comm comm() const { return comm_; }
    int rank() const { return rank_; }
    int size() const { return size_; }

    /// Communication done so far, for the scaling model: messages sent, bytes sent, reductions.
    struct Counters { long messages = 0, bytes = 0, reductions = 0; };
    const Counters& counters() const { return counters_; }

private:
    MPI_Comm comm_;
    int rank_ = 0, size_ = 1;
    std::vector<int> neighbours_;               // ranks we exchange with
    std::vector<int> sendStart_, sendNode_;     // per neighbour: owned nodes to send
    std::vector<int> receiveStart_, receiveNode_; // per neighbour: halo nodes to fill
    mutable std::vector<double> sendBuffer_, receiveBuffer_;
    mutable Counters counters_;
};

} // namespace flotsam
