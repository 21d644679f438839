// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/checkpoint.hpp"

#include "io/hdf5File.hpp"
#include "support/temporaryFolder.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>

using namespace flotsam;

namespace
{

constexpr std::size_t nNodes = 1000;

RunState example()
{
    RunState state;
    FlowState& flow = state.flow;
    flow.time = 1.0 / 3;
    flow.dt = 1e-3 / 7;
    flow.u.resize(3 * nNodes);
    std::iota(flow.u.begin(), flow.u.end(), 0.1);
    flow.uOld.assign(3 * nNodes, std::sqrt(2.0));
    flow.pOld.assign(nNodes, 99.5);
    flow.p.assign(nNodes, -1e5 / 3);
    flow.alpha.assign(nNodes, std::numeric_limits<double>::denorm_min());
    flow.alphaOld.assign(nNodes, -0.0);
    flow.fineScale.assign(3 * 5012, 0.1);
    flow.fineScaleOld.assign(3 * 5012, 1.0 / 7);
    state.arrays["dem/history"] = {1, 2, 3.5};
    state.arrays["a.b%c/d"] = {};
    state.arrays["."] = {4};
    state.scalars["mass of water"] = 42.0 / 13;
    return state;
}

/// What readCheckpoint complains about; "" if it does not. isDamaged: of what kind it is.
std::string complaint(const std::string& file, std::size_t n = nNodes, bool* isDamaged = nullptr)
{
    try
    {
        readCheckpoint(file, n);
    }
    catch (const DamagedCheckpoint& error)
    {
        if (isDamaged) *isDamaged = true;
        CHECK(std::string(error.what()).find(file) == 0);
        return error.what();
    }
    catch (const std::runtime_error& error)
    {
        CHECK(std::string(error.what()).find(file) == 0);
        return error.what();
    }
    return "";
}

void changeByte(const std::string& file, std::size_t position)
{
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(position);
    const char byte = char(stream.get() ^ 0x10);
    stream.seekp(position);
    stream.put(byte);
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("a checkpoint gives back every bit")
{
    const TemporaryFolder folder("checkpoint");
    const std::string file = folder / "state.h5";
    const RunState written = example();
    writeCheckpoint(file, written);
    const RunState read = readCheckpoint(file, nNodes);

    CHECK(read.flow.time == written.flow.time);
    CHECK(read.flow.dt == written.flow.dt);
    CHECK(read.flow.u == written.flow.u);
    CHECK(read.flow.uOld == written.flow.uOld);
    CHECK(read.flow.pOld == written.flow.pOld);
    CHECK(read.flow.p == written.flow.p);
    CHECK(read.flow.alpha == written.flow.alpha);
    CHECK(std::signbit(read.flow.alphaOld.at(0)));
    CHECK(read.flow.fineScale == written.flow.fineScale);
    CHECK(read.flow.fineScaleOld == written.flow.fineScaleOld);
    CHECK(read.arrays == written.arrays);
    CHECK(read.scalars == written.scalars);
    CHECK(!std::filesystem::exists(file + ".tmp"));

    CHECK(readCheckpointArray(file, "dem/history") == written.arrays.at("dem/history"));
    CHECK(readCheckpointArray(file, "no such array").empty());

    writeCheckpoint(file, written); // replaces the older one
    CHECK(complaint(file).empty());
}

TEST_CASE("an empty state (a rank without nodes) passes")
{
    const TemporaryFolder folder("checkpointEmpty");
    writeCheckpoint(folder / "state.h5", RunState());
    CHECK(complaint(folder / "state.h5", 0).empty());
}

TEST_CASE("a checkpoint begins with a head as OpenFOAM's files have")
{
    const TemporaryFolder folder("checkpointHead");
    const std::string file = folder / "state.h5";
    writeCheckpoint(file, example());
    std::string head(512, ' ');
    std::ifstream(file, std::ios::binary).read(&head[0], 512);
    CHECK(head.find("FoamFile\n{\n") == 0);
    CHECK(contains(head, "class       flotsamState;"));
    CHECK(contains(head, "object      state.h5;"));
    CHECK(head.substr(head.find('}')).find_first_not_of(std::string("}\n\0", 3)) == std::string::npos);
    CHECK(complaint(file).empty());
}

TEST_CASE("a checkpoint that does not fit is refused with its reason")
{
    const TemporaryFolder folder("checkpointRefused");
    const std::string file = folder / "state.h5";

    CHECK(contains(complaint(file), "No such file"));
    std::ofstream(file) << "this is no HDF5 file";
    CHECK(contains(complaint(file), "cannot open the file (file signature not found): cut off, damaged, or not a file of flotsamFoam"));
    CHECK_THROWS_AS(readCheckpointArray(file, "x"), DamagedCheckpoint);
    Hdf5File(file, Hdf5File::Mode::Create).writeArray("/x", {1});
    CHECK(contains(complaint(file), "not a checkpoint"));

    writeCheckpoint(file, example());
    CHECK(contains(complaint(file, nNodes + 1), "holds 1000 nodes, the mesh has 1001"));
    {
        Hdf5File change(file, Hdf5File::Mode::ReadWrite);
        change.setAttribute("/", "complete", std::int64_t(0));
    }
    CHECK(contains(complaint(file), "incomplete"));
    {
        Hdf5File change(file, Hdf5File::Mode::ReadWrite);
        change.setAttribute("/", "complete", std::int64_t(1));
        change.setAttribute("/", "formatVersion", std::int64_t(99));
    }
    CHECK(contains(complaint(file), "format 99"));
}

TEST_CASE("a damaged checkpoint is noticed wherever the damage is")
{
    const TemporaryFolder folder("checkpointDamaged");
    const std::string whole = folder / "whole.h5", file = folder / "state.h5";
    RunState state = example();
    for (double& u : state.flow.u) u = std::sin(u); // no two blocks alike
    std::vector<double>& bulk = state.arrays["bulk"]; // as in a real file, the content is far larger than HDF5's own tables
    for (int i = 0; i < 20000; ++i) bulk.push_back(std::cos(0.7*i));
    writeCheckpoint(whole, state);
    const std::size_t size = std::filesystem::file_size(whole);

    const auto overwrite = std::filesystem::copy_options::overwrite_existing;
    std::filesystem::copy_file(whole, file, overwrite);
    for (const std::size_t kept : {size/2, std::size_t(100), std::size_t(0), size - 1})
    {
        bool isDamaged = false;
        std::filesystem::copy_file(whole, file, overwrite);
        std::filesystem::resize_file(file, kept);
        CHECK(contains(complaint(file, nNodes, &isDamaged), "cut off, damaged, or not a file of flotsamFoam"));
        CHECK(isDamaged);
    }

    // a flipped bit is found, or was in unused space and the state is still exactly the written one
    int noticed = 0, harmless = 0;
    const std::size_t stride = size / 97;
    for (std::size_t position = 0; position < size; position += stride)
    {
        std::filesystem::copy_file(whole, file, overwrite);
        changeByte(file, position);
        if (complaint(file) != "")
        {
            ++noticed;
            continue;
        }
        ++harmless;
        const RunState read = readCheckpoint(file, nNodes);
        CHECK(read.flow.u == state.flow.u);
        CHECK(read.flow.p == state.flow.p);
        CHECK(read.flow.pOld == state.flow.pOld);
        CHECK(read.flow.fineScale == state.flow.fineScale);
    }
    CHECK(noticed > 9 * harmless);
}
TEST_CASE("a file that cannot be written is named")
{
    CHECK_THROWS_WITH_AS(writeCheckpoint("/nonexistent/folder/state.h5", example()),
        doctest::Contains("/nonexistent/folder/state.h5"), std::runtime_error);
}
