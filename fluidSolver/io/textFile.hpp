// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cerrno>
#include <cstring>
#include <ostream>
#include <stdexcept>
#include <string>

namespace flotsam
{

/// After a line has been flushed: a stream that fails once (the disk is full) would leave out all later lines, in silence.
inline void checkWritten(const std::ostream& file, const std::string& name)
{
    if (!file) throw std::runtime_error(name + ": cannot write the file to disk (" + std::strerror(errno) + ")");
}

} // namespace flotsam
