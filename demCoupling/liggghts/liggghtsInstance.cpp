// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/liggghtsInstance.hpp"

#include "demCoupling/liggghts/liggghtsErrors.hpp"

#include <mpi.h>

#include "fix.h"
#include "input.h"
#include "lammps.h"
#include "library.h"
#include "modify.h"

#include <cstdio>
#include <iostream>

namespace flotsam
{

namespace
{

/// From the second instance on LIGGGHTS reports its own static tables as hundreds of "collisions" on std::cerr.
class MutedErrorStream
{
public:
    MutedErrorStream() : buffer_(std::cerr.rdbuf(nullptr)) {}
    ~MutedErrorStream()
    {
        std::cerr.rdbuf(buffer_);
        std::cerr.clear();
    }

private:
    std::streambuf* buffer_;
};

} // namespace

std::string exactText(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

LiggghtsInstance::LiggghtsInstance()
{
    int isInitialised = 0;
    MPI_Initialized(&isInitialised);
    if (!isInitialised)
        throw DemError("MPI must be initialised before the DEM engine is made");
    checkErrorsAreCaught();

    // a screen of "none" would be a null FILE* that fix mesh/surface prints to without a check
    const char* arguments[] = {"dem", "-screen", "/dev/null", "-log", "none", "-nocite"};
    void* handle = nullptr;
    const MutedErrorStream muted;
    lammps_open(6, const_cast<char**>(arguments), MPI_COMM_SELF, &handle);
    lammps_ = static_cast<LAMMPS_NS::LAMMPS*>(handle);
}

LiggghtsInstance::~LiggghtsInstance()
{
    if (!failure_.empty())
        return; // a half-built instance frees memory twice: better to lose it
    FILE* screen = lammps_->screen; // not closed by LIGGGHTS
    lammps_close(lammps_);
    if (screen != nullptr)
        std::fclose(screen);
}

void LiggghtsInstance::command(const std::string& line)
{
    guarded([&] { lammps_->input->one(line.c_str()); });
}

LAMMPS_NS::Fix* LiggghtsInstance::addFix(const std::vector<std::string>& arguments)
{
    std::vector<std::string> copy = arguments;
    std::vector<char*> pointers;
    for (std::string& a : copy)
        pointers.push_back(a.data());
    guarded([&] { lammps_->modify->add_fix(static_cast<int>(pointers.size()), pointers.data()); });
    return findFix(arguments[0]);
}

LAMMPS_NS::Fix* LiggghtsInstance::findFix(const std::string& id) const
{
    return lammps_->modify->find_fix_id(id.c_str());
}

} // namespace flotsam
