// SPDX-License-Identifier: GPL-3.0-or-later
/// The attributes of an Hdf5File.
#include "io/hdf5File.hpp"

#include "io/hdf5Calls.hpp"

#include <algorithm>

namespace flotsam
{

void Hdf5File::writeAttribute(const std::string& path, const std::string& name, Id type, const void* value)
{
    const Hdf5Silence silence;
    if (!pathExists(id_, path))
    {
        const Hdf5Handle properties(linkProperties(), H5Pclose);
        const Hdf5Handle group(H5Gcreate2(id_, path.c_str(), properties, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
        if (!group.isValid()) fail("cannot make the group", path);
    }
    if (H5Aexists_by_name(id_, path.c_str(), name.c_str(), H5P_DEFAULT) > 0)
    {
        H5Adelete_by_name(id_, path.c_str(), name.c_str(), H5P_DEFAULT);
    }
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle id(H5Acreate_by_name(id_, path.c_str(), name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose);
    if (!id.isValid() || H5Awrite(id, type, value) < 0) fail("cannot write attribute " + name, path);
}

void Hdf5File::setAttribute(const std::string& path, const std::string& name, const std::string& value)
{
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, std::max<std::size_t>(value.size(), 1));
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, H5T_CSET_UTF8);
    writeAttribute(path, name, type, value.c_str());
}

void Hdf5File::setAttribute(const std::string& path, const std::string& name, double value)
{
    writeAttribute(path, name, H5T_NATIVE_DOUBLE, &value);
}

void Hdf5File::setAttribute(const std::string& path, const std::string& name, std::int64_t value)
{
    writeAttribute(path, name, H5T_NATIVE_INT64, &value);
}

bool Hdf5File::hasAttribute(const std::string& path, const std::string& name) const
{
    const Hdf5Silence silence;
    return pathExists(id_, path) && H5Aexists_by_name(id_, path.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

Hdf5File::Id Hdf5File::openAttribute(const std::string& path, const std::string& name) const
{
    const hid_t id = H5Aopen_by_name(id_, path.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    if (id < 0) fail("cannot find attribute " + name, path);
    return id;
}

void Hdf5File::readAttribute(const std::string& path, const std::string& name, Id type, void* value) const
{
    const Hdf5Silence silence;
    const Hdf5Handle id(openAttribute(path, name), H5Aclose);
    if (H5Aread(id, type, value) < 0) fail("cannot read attribute " + name, path);
}

std::string Hdf5File::stringAttribute(const std::string& path, const std::string& name) const
{
    const Hdf5Silence silence;
    const Hdf5Handle id(openAttribute(path, name), H5Aclose);
    const Hdf5Handle type(H5Aget_type(id), H5Tclose);
    if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) fail("not a plain text: attribute " + name, path);
    std::string text(H5Tget_size(type), '\0');
    if (H5Aread(id, type, &text[0]) < 0) fail("cannot read attribute " + name, path);
    return text.substr(0, text.find('\0'));
}

double Hdf5File::realAttribute(const std::string& path, const std::string& name) const
{
    double value = 0;
    readAttribute(path, name, H5T_NATIVE_DOUBLE, &value);
    return value;
}

std::int64_t Hdf5File::integerAttribute(const std::string& path, const std::string& name) const
{
    std::int64_t value = 0;
    readAttribute(path, name, H5T_NATIVE_INT64, &value);
    return value;
}

} // namespace flotsam
