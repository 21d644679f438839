// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/checkpoint.hpp"

#include "io/hdf5File.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace flotsam
{

namespace
{

const std::string magic = "flotsam checkpoint";
constexpr std::int64_t formatVersion = 9;

using Field = std::vector<double> FlowState::*;
struct NamedField { const char* name; Field field; };
constexpr NamedField flowFields[] = {
    {"u", &FlowState::u}, {"uOld", &FlowState::uOld}, {"p", &FlowState::p}, {"pOld", &FlowState::pOld},
    {"alpha", &FlowState::alpha}, {"alphaOld", &FlowState::alphaOld},
    {"fineScale", &FlowState::fineScale}, {"fineScaleOld", &FlowState::fineScaleOld}};

/// HDF5 takes '/' for a group; a name of the map may hold any character.
std::string escaped(const std::string& name)
{
    std::string text;
    for (const char c : name)
    {
        if (c == '/') text += "%s";
        else if (c == '%') text += "%%";
        else if (c == '.') text += "%d";
        else text += c;
    }
    return text;
}

std::string unescaped(const std::string& text)
{
    std::string name;
    for (std::size_t i = 0; i < text.size(); ++i)
    {
        if (text[i] != '%' || i + 1 == text.size()) { name += text[i]; continue; }
        ++i;
        name += text[i] == 's' ? '/' : text[i] == 'd' ? '.' : '%';
    }
    return name;
}

/// The data must be on the disk before the rename is, or a power cut leaves an empty file under the final name.
void syncToDisk(const std::string& path)
{
    const int descriptor = ::open(path.c_str(), O_RDONLY);
    if (descriptor < 0) throw std::runtime_error(path + ": cannot open (" + std::strerror(errno) + ")");
    const bool isSynced = ::fsync(descriptor) == 0;
    const int error = errno;
    ::close(descriptor);
    // some file systems cannot sync a folder: that is their best already
    if (!isSynced && error != EINVAL) throw std::runtime_error(path + ": cannot write to disk (" + std::strerror(error) + ")");
}

std::string folderOf(const std::string& file)
{
    const auto slash = file.rfind('/');
    return slash == std::string::npos ? "." : slash == 0 ? "/" : file.substr(0, slash);
}

void writeContent(Hdf5File& out, const RunState& state)
{
    const FlowState& flow = state.flow;
    out.setAttribute("/", "kind", magic);
    out.setAttribute("/", "formatVersion", formatVersion);
    out.setAttribute("/flow", "nNodes", std::int64_t(flow.p.size()));
    out.setAttribute("/flow", "time", flow.time);
    out.setAttribute("/flow", "dt", flow.dt);
    for (const auto& f : flowFields) out.writeArray(std::string("/flow/") + f.name, flow.*f.field);
    for (const auto& a : state.arrays) out.writeArray("/arrays/" + escaped(a.first), a.second);
    for (const auto& s : state.scalars) out.writeArray("/scalars/" + escaped(s.first), {s.second});
    out.setAttribute("/", "nArrays", std::int64_t(state.arrays.size()));
    out.setAttribute("/", "nScalars", std::int64_t(state.scalars.size()));
    out.setAttribute("/", "complete", std::int64_t(1)); // last: its absence means the writer was interrupted
}

/// OpenFOAM's tools and function objects that list what a time folder holds (reconstructPar, foamToVTK, surfaces) read the head of every file in it, and
/// warn of those that have none.
std::string headForOpenFOAM(const std::string& file)
{
    const std::string name = file.substr(file.rfind('/') + 1); // all of it without a '/'
    return "FoamFile\n{\n    version     2.0;\n    format      binary;\n    class       flotsamState;\n    object      " + name + ";\n}\n";
}

void checkReadable(const std::string& file)
{
    if (::access(file.c_str(), R_OK) != 0) throw std::runtime_error(file + ": cannot read the checkpoint (" + std::strerror(errno) + ")");
}

void checkHeader(const Hdf5File& in, const std::string& file)
{
    if (!in.hasAttribute("/", "kind") || in.stringAttribute("/", "kind") != magic)
    {
        throw DamagedCheckpoint(file + ": not a checkpoint of this program");
    }
    const auto version = in.integerAttribute("/", "formatVersion");
    if (version != formatVersion)
    {
        throw std::runtime_error(file + ": written by another version of flotsamFoam (format " + std::to_string(version) + ", this one reads "
            + std::to_string(formatVersion) + "). Go on with that version, or remove the file to start from the volume fields beside it");
    }
    if (!in.hasAttribute("/", "complete") || in.integerAttribute("/", "complete") != 1)
    {
        throw DamagedCheckpoint(file + ": incomplete checkpoint (its writing was interrupted)");
    }
}

void checkNodes(const Hdf5File& in, const FlowState& flow, std::size_t nNodes, const std::string& file)
{
    const auto stored = in.integerAttribute("/flow", "nNodes");
    if (stored != std::int64_t(nNodes))
    {
        throw std::runtime_error(file + ": holds " + std::to_string(stored) + " nodes, the mesh has " + std::to_string(nNodes)
            + " here. It belongs to another mesh or decomposition: restart with those, or start without it");
    }
    for (const auto& f : flowFields)
    {
        const auto size = (flow.*f.field).size();
        const bool isPerElement = f.field == &FlowState::fineScale || f.field == &FlowState::fineScaleOld;
        if (!isPerElement && nNodes > 0 && size % nNodes != 0)
        {
            throw DamagedCheckpoint(file + ": damaged, /flow/" + f.name + " holds " + std::to_string(size) + " values for "
                + std::to_string(nNodes) + " nodes");
        }
    }
}

RunState readContent(const std::string& file, std::size_t nNodes)
{
    Hdf5File in(file, Hdf5File::Mode::Read);
    checkHeader(in, file);

    RunState state;
    FlowState& flow = state.flow;
    flow.time = in.realAttribute("/flow", "time");
    flow.dt = in.realAttribute("/flow", "dt");
    for (const auto& f : flowFields) flow.*f.field = in.readArray(std::string("/flow/") + f.name);
    checkNodes(in, flow, nNodes, file);
    for (const auto& name : in.names("/arrays")) state.arrays[unescaped(name)] = in.readArray("/arrays/" + name);
    for (const auto& name : in.names("/scalars")) state.scalars[unescaped(name)] = in.readArray("/scalars/" + name).at(0);
    if (std::int64_t(state.arrays.size()) != in.integerAttribute("/", "nArrays")
        || std::int64_t(state.scalars.size()) != in.integerAttribute("/", "nScalars"))
    {
        throw DamagedCheckpoint(file + ": damaged, arrays or scalars are missing");
    }
    return state;
}

/// HDF5 stumbles over whatever comes first in a file that is cut off or another's: what that means is said with it.
template<class Read>
auto readUndamaged(Read read)
{
    try { return read(); }
    catch (const Hdf5Error& error)
    {
        throw DamagedCheckpoint(std::string(error.what()) + ": cut off, damaged, or not a file of flotsamFoam");
    }
}

} // namespace

void writeCheckpoint(const std::string& file, const RunState& state)
{
    const std::string temporary = file + ".tmp";
    Hdf5File out(temporary, Hdf5File::Mode::Create, headForOpenFOAM(file));
    writeContent(out, state);
    out.close();
    syncToDisk(temporary);
    if (std::rename(temporary.c_str(), file.c_str()) != 0)
    {
        throw std::runtime_error(file + ": cannot rename " + temporary + " (" + std::strerror(errno) + ")");
    }
    syncToDisk(folderOf(file));
}

RunState readCheckpoint(const std::string& file, std::size_t nNodes)
{
    checkReadable(file);
    return readUndamaged([&] { return readContent(file, nNodes); });
}

std::vector<double> readCheckpointArray(const std::string& file, const std::string& name)
{
    checkReadable(file);
    return readUndamaged([&]
    {
        Hdf5File in(file, Hdf5File::Mode::Read);
        checkHeader(in, file);
        const std::string path = "/arrays/" + escaped(name);
        return in.exists(path) ? in.readArray(path) : std::vector<double>();
    });
}

} // namespace flotsam
