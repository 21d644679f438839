// SPDX-License-Identifier: GPL-3.0-or-later
/// A folder of its own for a test (per process, so per rank), removed at the end.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

namespace flotsam
{

class TemporaryFolder
{
public:
    explicit TemporaryFolder(const std::string& name)
        : path_(std::filesystem::temp_directory_path() / ("flotsam_" + name + "_" + std::to_string(::getpid())))
    {
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder() { std::error_code ignored; std::filesystem::remove_all(path_, ignored); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::string operator/(const std::string& file) const { return (path_ / file).string(); }

private:
    std::filesystem::path path_;
};

} // namespace flotsam
