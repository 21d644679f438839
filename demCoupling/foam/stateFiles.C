// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/stateFiles.H"

#include "OSspecific.H"

#include <mpi.h>

#include <cstring>
#include <sstream>
#include <stdexcept>

namespace flotsam
{

namespace
{

const Foam::word fileName = "flotsamState.h5";
const char* const decompositionName = "decomposition";

/// FNV-1a of the bits of some numbers, a number at a time.
std::uint64_t hashOf(const std::vector<double>& values)
{
    std::uint64_t hash = 14695981039346656037ull;
    for (const double v : values)
    {
        std::uint64_t bits;
        std::memcpy(&bits, &v, sizeof bits);
        hash = (hash ^ bits)*1099511628211ull;
    }
    return hash;
}

template<class T>
void broadcast(std::vector<T>& values, MPI_Datatype type, MPI_Comm comm)
{
    long size = long(values.size());
    MPI_Bcast(&size, 1, MPI_LONG, 0, comm);
    values.resize(size);
    MPI_Bcast(values.data(), int(size), type, 0, comm);
}

/// What the first process has read, without fields at nodes, on all.
void broadcast(RunState& state, MPI_Comm comm)
{
    std::vector<char> names;
    std::vector<double> values{state.flow.time, state.flow.dt, double(state.arrays.size())};
    const auto put = [&](const std::string& name, const double* data, std::size_t n)
    {
        names.insert(names.end(), name.begin(), name.end());
        names.push_back('\n');
        values.push_back(double(n));
        values.insert(values.end(), data, data + n);
    };
    for (const auto& a : state.arrays) put(a.first, a.second.data(), a.second.size());
    for (const auto& s : state.scalars) put(s.first, &s.second, 1);
    broadcast(names, MPI_CHAR, comm);
    broadcast(values, MPI_DOUBLE, comm);

    state = RunState();
    state.flow.time = values[0];
    state.flow.dt = values[1];
    const double* at = &values[3];
    std::istringstream list(std::string(names.begin(), names.end()));
    std::string name;
    for (long k = 0; std::getline(list, name); ++k)
    {
        const std::size_t n = std::size_t(*at++);
        if (k < long(values[2])) state.arrays[name].assign(at, at + n);
        else state.scalars[name] = *at;
        at += n;
    }
}

/// What reads a file, with what to do without it where it is damaged.
template<class Read>
auto withAdvice(const char* advice, Read read)
{
    try { return read(); }
    catch (const DamagedCheckpoint& damage) { throw std::runtime_error("restart: " + std::string(damage.what()) + ". " + advice); }
}

const char* const withoutOwn = "Remove the time's folder (in parallel of every processor*) to go on from the time before; or that file alone, and the run goes on"
    " from what else is there: bodies and sums from uniform/flotsamState.h5, the fluid from the written fields";
const char* const withoutShared = "Remove the time's folder (in parallel of every processor*) to go on from the time before; or that file alone, and the run starts"
    " anew from the written fields, with the bodies at their places in constant/bodies";

} // namespace

StateFiles::StateFiles(const Foam::Time& runTime, const SimplexMesh& mesh, const Halo& halo)
:   runTime_(runTime), mesh_(mesh), halo_(halo)
{}

Foam::fileName StateFiles::ownFile() const { return runTime_.timePath()/fileName; }

/// Where a tool has not carried it along, that of the whole case or of the first process will do: it is the same.
Foam::fileName StateFiles::sharedFile() const
{
    const Foam::fileName whole = runTime_.globalPath(), first = whole/"processor0";
    for (const Foam::fileName& folder : {runTime_.path(), whole, first})
    {
        const Foam::fileName file = folder/runTime_.timeName()/"uniform"/fileName;
        if (Foam::isFile(file)) return file;
    }
    return Foam::fileName();
}

/// Number of processes, this one, and what tells its part of the mesh from others.
std::vector<double> StateFiles::decomposition() const
{
    const std::uint64_t hash = hashOf(mesh_.x);
    return {double(halo_.size()), double(halo_.rank()), double(hash >> 32), double(hash & 0xffffffffu)};
}

StateFiles::Found StateFiles::find() const
{
    const bool isHere = Foam::isFile(ownFile());
    const bool isMine = isHere && withAdvice(withoutOwn, [&] { return readCheckpointArray(ownFile(), decompositionName); }) == decomposition();
    if (!halo_.any(!isMine)) return Found::Own;
    const bool isShared = halo_.rank() == 0 && !sharedFile().empty();
    if (halo_.any(isShared)) return Found::Shared;
    return halo_.any(isHere) ? Found::Foreign : Found::Nothing;
}

RunState StateFiles::readOwn() const
{
    return withAdvice(withoutOwn, [&] { return readCheckpoint(ownFile(), std::size_t(mesh_.nNodes)); });
}

RunState StateFiles::readShared() const
{
    RunState state;
    if (halo_.rank() == 0) state = withAdvice(withoutShared, [&] { return readCheckpoint(sharedFile(), 0); });
    broadcast(state, halo_.comm());
    return state;
}

void StateFiles::write(RunState state, const std::vector<std::string>& ofProcess) const
{
    state.arrays[decompositionName] = decomposition();
    writeCheckpoint(ownFile(), state);
    if (halo_.rank() != 0) return;
    state.arrays.erase(decompositionName);
    for (const std::string& name : ofProcess) state.arrays.erase(name);
    const FlowState& flow = state.flow;
    FlowState times;
    times.time = flow.time;
    times.dt = flow.dt;
    state.flow = times;
    const Foam::fileName folder = runTime_.timePath()/"uniform";
    Foam::mkDir(folder);
    writeCheckpoint(folder/fileName, state);
}

} // namespace flotsam
