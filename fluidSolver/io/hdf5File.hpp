// SPDX-License-Identifier: GPL-3.0-or-later
/// A thin HDF5 file: arrays, growing tables and attributes; every failure is an Hdf5Error with file and dataset.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace flotsam
{

struct Hdf5Error : std::runtime_error { using std::runtime_error::runtime_error; };

/// Serial access by one process. Paths are absolute ("/run/time"); missing groups are made on the way.
class Hdf5File
{
public:
    enum class Mode { Create, ReadWrite, Read };
    /// How numbers are stored; in memory they are always double (or int for Int32).
    enum class Storage { Float64, Float32, Int32 };

    /// preamble: text for other programs before HDF5's own content, which finds itself behind it; with Mode::Create.
    Hdf5File(const std::string& file, Mode mode, const std::string& preamble = "");
    ~Hdf5File(); ///< closes; a failure is not reported here: call close() where it matters
    Hdf5File(const Hdf5File&) = delete;
    Hdf5File& operator=(const Hdf5File&) = delete;

    /// Flushes and closes. Throws when the file could not be completed.
    void close();

    bool exists(const std::string& path) const;
    std::vector<std::string> names(const std::string& group) const; ///< children of a group, by name; empty if no such group

    /// Second name for an existing dataset; it takes no space.
    void link(const std::string& existing, const std::string& path);

    // attributes of a group or dataset ("/" is the file)
    void setAttribute(const std::string& path, const std::string& name, const std::string& value);
    void setAttribute(const std::string& path, const std::string& name, double value);
    void setAttribute(const std::string& path, const std::string& name, std::int64_t value);
    bool hasAttribute(const std::string& path, const std::string& name) const;
    std::string stringAttribute(const std::string& path, const std::string& name) const;
    double realAttribute(const std::string& path, const std::string& name) const;
    std::int64_t integerAttribute(const std::string& path, const std::string& name) const;

    // arrays of fixed size, with a checksum per block, so that a flipped bit is found on reading
    void writeArray(const std::string& path, const std::vector<double>& values);
    std::vector<double> readArray(const std::string& path) const; ///< any rank, flattened

    // tables: rows are appended; one column makes a one-dimensional dataset
    void createTable(const std::string& path, std::size_t columns, std::size_t chunkRows, Storage storage = Storage::Float64);
    std::size_t rows(const std::string& path) const;
    std::size_t columns(const std::string& path) const;
    void appendRows(const std::string& path, const double* values, std::size_t nRows);
    void appendRows(const std::string& path, const int* values, std::size_t nRows);
    void setRows(const std::string& path, std::size_t nRows); ///< cuts off (or extends by zeros)

private:
    using Id = std::int64_t; // hid_t; HDF5's header stays out of this one

    void create(Id access);
    void writePreamble() const;
    void append(const std::string& path, const void* values, Id memoryType, std::size_t nRows);
    Id openDataset(const std::string& path) const;
    Id openAttribute(const std::string& path, const std::string& name) const;
    void writeAttribute(const std::string& path, const std::string& name, Id type, const void* value);
    void readAttribute(const std::string& path, const std::string& name, Id type, void* value) const;
    [[noreturn]] void fail(const std::string& action, const std::string& path) const;

    std::string file_;
    std::string preamble_;
    Id id_ = -1;
};

} // namespace flotsam
