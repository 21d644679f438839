// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/hdf5File.hpp"

#include "io/hdf5Calls.hpp"

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <type_traits>

namespace flotsam
{

static_assert(std::is_same<hid_t, std::int64_t>::value, "HDF5 before 1.10 has narrower identifiers");

namespace
{

herr_t keepFirst(unsigned, const H5E_error2_t* error, void* text)
{
    auto& message = *static_cast<std::string*>(text);
    if (message.empty() && error->desc) message = error->desc;
    return 0;
}

std::string lastHdf5Error()
{
    std::string text;
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keepFirst, &text);
    const std::string mark = "error message = '"; // of the operating system, among much that says nothing to a user
    const std::size_t begin = text.find(mark);
    if (begin == std::string::npos) return text.empty() ? "no reason given" : text;
    const std::size_t word = begin + mark.size();
    return text.substr(word, text.find('\'', word) - word);
}

/// A file that could not be closed (the disk is full) makes HDF5 crash where it ends with the program, after the message that says so. Before the first call of HDF5.
void endWithoutHdf5()
{
    static const herr_t done = H5dont_atexit();
    (void)done;
}

herr_t collectName(hid_t, const char* name, const H5L_info_t*, void* list)
{
    static_cast<std::vector<std::string>*>(list)->push_back(name);
    return 0;
}

hid_t storageType(Hdf5File::Storage storage)
{
    switch (storage)
    {
        case Hdf5File::Storage::Float32: return H5T_IEEE_F32LE;
        case Hdf5File::Storage::Int32: return H5T_STD_I32LE;
        default: return H5T_IEEE_F64LE;
    }
}

/// {rows, columns} of a table; rank as stored.
struct Extent
{
    int rank = 0;
    hsize_t size[2] = {0, 1};

    explicit Extent(hid_t dataset)
    {
        const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
        rank = H5Sget_simple_extent_ndims(space);
        if (rank == 1 || rank == 2) H5Sget_simple_extent_dims(space, size, nullptr);
    }
    bool isTable() const { return rank == 1 || rank == 2; }
};

constexpr hsize_t arrayBlock = 1 << 17; // values per checksummed block: 1 MiB

} // namespace

Hdf5File::Hdf5File(const std::string& file, Mode mode, const std::string& preamble)
:   file_(file), preamble_(preamble)
{
    endWithoutHdf5();
    const Hdf5Silence silence;
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    // A reader that holds the file open must not stop a running computation.
    H5Pset_file_locking(access, false, true);
    // Format of HDF5 1.8: its structure is checksummed, and it has no "still open" mark that a killed run would leave set.
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);

    switch (mode)
    {
        case Mode::Create: create(access); break;
        case Mode::ReadWrite: id_ = H5Fopen(file.c_str(), H5F_ACC_RDWR, access); break;
        case Mode::Read: id_ = H5Fopen(file.c_str(), H5F_ACC_RDONLY, access); break;
    }
    if (id_ < 0) fail(mode == Mode::Create ? "cannot create the file" : "cannot open the file", "");
}

void Hdf5File::create(Id access)
{
    // Its size is a power of two from 512 on: there HDF5 looks for its content.
    hsize_t size = preamble_.empty() ? 0 : 512;
    while (size < preamble_.size()) size *= 2;
    const Hdf5Handle properties(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    H5Pset_userblock(properties, size);
    id_ = H5Fcreate(file_.c_str(), H5F_ACC_TRUNC, properties, access);
}

/// HDF5 leaves the place to others, and has nothing to write there itself.
void Hdf5File::writePreamble() const
{
    if (preamble_.empty()) return;
    std::fstream out(file_, std::ios::in | std::ios::out | std::ios::binary);
    if (!(out << preamble_ << std::flush)) throw Hdf5Error(file_ + ": cannot write the file to disk");
}

Hdf5File::~Hdf5File()
{
    const Hdf5Silence silence;
    if (id_ >= 0) H5Fclose(id_);
}

void Hdf5File::close()
{
    if (id_ < 0) return;
    const Hdf5Silence silence;
    const bool isFlushed = H5Fflush(id_, H5F_SCOPE_LOCAL) >= 0;
    const std::string reason = isFlushed ? "" : lastHdf5Error();
    const bool isClosed = H5Fclose(id_) >= 0;
    id_ = -1;
    if (!isFlushed) throw Hdf5Error(file_ + ": cannot write the file to disk (" + reason + ")");
    if (!isClosed) fail("cannot close the file", "");
    writePreamble();
}

void Hdf5File::fail(const std::string& action, const std::string& path) const
{
    const std::string where = path.empty() ? "" : ", dataset " + path;
    throw Hdf5Error(file_ + where + ": " + action + " (" + lastHdf5Error() + ")");
}

bool Hdf5File::exists(const std::string& path) const
{
    const Hdf5Silence silence;
    return pathExists(id_, path);
}

std::vector<std::string> Hdf5File::names(const std::string& group) const
{
    const Hdf5Silence silence;
    std::vector<std::string> list;
    if (!pathExists(id_, group)) return list;
    const Hdf5Handle id(H5Gopen2(id_, group.c_str(), H5P_DEFAULT), H5Gclose);
    if (!id.isValid() || H5Literate(id, H5_INDEX_NAME, H5_ITER_INC, nullptr, collectName, &list) < 0)
    {
        fail("cannot list the group", group);
    }
    return list;
}

void Hdf5File::link(const std::string& existing, const std::string& path)
{
    const Hdf5Silence silence;
    const Hdf5Handle properties(linkProperties(), H5Pclose);
    if (H5Lcreate_hard(id_, existing.c_str(), H5L_SAME_LOC, path.c_str(), properties, H5P_DEFAULT) < 0)
    {
        fail("cannot link to " + existing, path);
    }
}

Hdf5File::Id Hdf5File::openDataset(const std::string& path) const
{
    const hid_t id = H5Dopen2(id_, path.c_str(), H5P_DEFAULT);
    if (id < 0) fail("cannot find", path);
    return id;
}

// --- arrays -------------------------------------------------------------------------------------------------------

void Hdf5File::writeArray(const std::string& path, const std::vector<double>& values)
{
    const Hdf5Silence silence;
    const hsize_t size = values.size();
    const hsize_t block = std::min(size, arrayBlock);
    const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
    const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    if (size > 0)
    {
        H5Pset_chunk(creation, 1, &block);
        H5Pset_fletcher32(creation);
    }
    const Hdf5Handle links(linkProperties(), H5Pclose);
    const Hdf5Handle id(H5Dcreate2(id_, path.c_str(), H5T_IEEE_F64LE, space, links, creation, H5P_DEFAULT), H5Dclose);
    if (!id.isValid()) fail("cannot create", path);
    if (size > 0 && H5Dwrite(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    {
        fail("cannot write", path);
    }
}

std::vector<double> Hdf5File::readArray(const std::string& path) const
{
    const Hdf5Silence silence;
    const Hdf5Handle id(openDataset(path), H5Dclose);
    const Hdf5Handle space(H5Dget_space(id), H5Sclose);
    const hssize_t size = H5Sget_simple_extent_npoints(space);
    if (size < 0) fail("cannot read the size", path);
    std::vector<double> values(size);
    if (size > 0 && H5Dread(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    {
        fail("cannot read", path);
    }
    return values;
}

// --- tables -------------------------------------------------------------------------------------------------------

void Hdf5File::createTable(const std::string& path, std::size_t columns, std::size_t chunkRows, Storage storage)
{
    const Hdf5Silence silence;
    const int rank = columns == 1 ? 1 : 2;
    const hsize_t none[2] = {0, columns}, most[2] = {H5S_UNLIMITED, columns}, chunk[2] = {chunkRows, columns};
    const Hdf5Handle space(H5Screate_simple(rank, none, most), H5Sclose);
    const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(creation, rank, chunk);
    const Hdf5Handle links(linkProperties(), H5Pclose);
    const Hdf5Handle id(H5Dcreate2(id_, path.c_str(), storageType(storage), space, links, creation, H5P_DEFAULT), H5Dclose);
    if (!id.isValid()) fail("cannot create", path);
}

std::size_t Hdf5File::rows(const std::string& path) const
{
    const Hdf5Silence silence;
    const Hdf5Handle id(openDataset(path), H5Dclose);
    return Extent(id).size[0];
}

std::size_t Hdf5File::columns(const std::string& path) const
{
    const Hdf5Silence silence;
    const Hdf5Handle id(openDataset(path), H5Dclose);
    return Extent(id).size[1];
}

void Hdf5File::append(const std::string& path, const void* values, Id memoryType, std::size_t nRows)
{
    const Hdf5Silence silence;
    const Hdf5Handle id(openDataset(path), H5Dclose);
    Extent extent(id);
    if (!extent.isTable()) fail("not a table", path);
    const hsize_t start[2] = {extent.size[0], 0}, count[2] = {nRows, extent.size[1]};
    extent.size[0] += nRows;
    if (nRows == 0) return;
    if (H5Dset_extent(id, extent.size) < 0) fail("cannot extend", path);
    const Hdf5Handle inFile(H5Dget_space(id), H5Sclose), inMemory(H5Screate_simple(extent.rank, count, nullptr), H5Sclose);
    H5Sselect_hyperslab(inFile, H5S_SELECT_SET, start, nullptr, count, nullptr);
    if (H5Dwrite(id, memoryType, inMemory, inFile, H5P_DEFAULT, values) < 0) fail("cannot append", path);
}

void Hdf5File::appendRows(const std::string& path, const double* values, std::size_t nRows)
{
    append(path, values, H5T_NATIVE_DOUBLE, nRows);
}

void Hdf5File::appendRows(const std::string& path, const int* values, std::size_t nRows)
{
    append(path, values, H5T_NATIVE_INT, nRows);
}

void Hdf5File::setRows(const std::string& path, std::size_t nRows)
{
    const Hdf5Silence silence;
    const Hdf5Handle id(openDataset(path), H5Dclose);
    Extent extent(id);
    if (!extent.isTable()) fail("not a table", path);
    extent.size[0] = nRows;
    if (H5Dset_extent(id, extent.size) < 0) fail("cannot resize", path);
}

} // namespace flotsam
