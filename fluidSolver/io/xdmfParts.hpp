// SPDX-License-Identifier: GPL-3.0-or-later
/// What the XDMF files beside the history file (bodies.xdmf, restraints.xdmf) are made of.
#pragma once

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <string>

namespace flotsam
{

/// Rows `first`..`first+count-1` of a table of so many columns, as XDMF's reader of ParaView 5 wants them.
struct XdmfSlab
{
    std::string dataset;            ///< file:path
    const char* type = "Float";
    std::size_t first = 0, count = 0, total = 0, columns = 3;
    int precision = 4;
};
std::ostream& operator<<(std::ostream& out, const XdmfSlab& slab);

std::string folderOf(const std::string& file);      ///< with its last '/'; empty: there is none
std::string fileNameOf(const std::string& file);

/// Writes the file as a whole, so that a reader never meets half of it. Throws when it cannot be written.
void writeXdmfFile(const std::string& name, const std::string& collection, const std::function<void(std::ostream&)>& writeTimes);

} // namespace flotsam
