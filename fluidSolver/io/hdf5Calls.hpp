// SPDX-License-Identifier: GPL-3.0-or-later
/// What every call of HDF5 needs.
#pragma once

#include <hdf5.h>

#include <string>

namespace flotsam
{

/// Closes an HDF5 identifier at the end of its scope.
class Hdf5Handle
{
public:
    Hdf5Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    ~Hdf5Handle() { if (id_ >= 0) close_(id_); }
    Hdf5Handle(const Hdf5Handle&) = delete;
    Hdf5Handle& operator=(const Hdf5Handle&) = delete;
    operator hid_t() const { return id_; }
    bool isValid() const { return id_ >= 0; }

private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

/// HDF5 prints its error stack by default; its message belongs into the exception instead.
class Hdf5Silence
{
public:
    Hdf5Silence() { H5Eget_auto2(H5E_DEFAULT, &function_, &data_); H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }
    ~Hdf5Silence() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
    Hdf5Silence(const Hdf5Silence&) = delete;
    Hdf5Silence& operator=(const Hdf5Silence&) = delete;

private:
    H5E_auto2_t function_ = nullptr;
    void* data_ = nullptr;
};

/// Whether every link of the path exists (H5Lexists fails on a missing parent).
inline bool pathExists(hid_t file, const std::string& path)
{
    if (path == "/") return true;
    for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1))
    {
        if (H5Lexists(file, path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
        if (end == std::string::npos) return true;
    }
}

/// For new links: groups missing on their path are made.
inline hid_t linkProperties()
{
    const hid_t properties = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(properties, 1);
    return properties;
}

} // namespace flotsam
