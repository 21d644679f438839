// SPDX-License-Identifier: GPL-3.0-or-later
/// The whole state of a run as one value, and its file.
#pragma once

#include "core/flowState.hpp"

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace flotsam
{

struct RunState
{
    FlowState flow;                                     ///< this rank's nodes
    std::map<std::string, std::vector<double>> arrays;  ///< bodies, DEM, statistics by name
    std::map<std::string, double> scalars;
};

/// What readCheckpoint() throws for a file that is cut off, changed, or not of this program: file and what is wrong with it.
struct DamagedCheckpoint : std::runtime_error { using std::runtime_error::runtime_error; };

/// Writes one rank's state to `file` (HDF5), through a temporary file and a rename: never half written.
void writeCheckpoint(const std::string& file, const RunState& state);

/// Throws DamagedCheckpoint, or std::runtime_error (file, what is wrong) for a missing file, one of another version or another number of nodes.
RunState readCheckpoint(const std::string& file, std::size_t nNodes);

/// One of the arrays alone; empty where the file has none of that name. Throws as readCheckpoint().
std::vector<double> readCheckpointArray(const std::string& file, const std::string& name);

} // namespace flotsam
