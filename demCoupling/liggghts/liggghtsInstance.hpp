// SPDX-License-Identifier: GPL-3.0-or-later
/// One LIGGGHTS instance on MPI_COMM_SELF: opening, closing, commands.
#pragma once

#include "demCoupling/liggghts/liggghtsEngine.hpp"

namespace LAMMPS_NS
{
class LAMMPS;
class Fix;
}

namespace flotsam
{

/// %.17g: reads back to the same bits.
std::string exactText(double value);

class LiggghtsInstance
{
public:
    LiggghtsInstance();
    ~LiggghtsInstance();
    LiggghtsInstance(const LiggghtsInstance&) = delete;
    LiggghtsInstance& operator=(const LiggghtsInstance&) = delete;

    void command(const std::string& line);
    /// Same as the `fix` command, without its limits on line length and on blanks in file names.
    LAMMPS_NS::Fix* addFix(const std::vector<std::string>& arguments);
    LAMMPS_NS::Fix* findFix(const std::string& id) const;

    LAMMPS_NS::LAMMPS& lammps() const { return *lammps_; }

    /// Runs f; an error inside leaves LIGGGHTS half way: the instance is then abandoned (closing it would crash).
    template <class F>
    void guarded(F&& f)
    {
        if (!failure_.empty())
            throw DemError("the DEM engine cannot go on after an earlier error: " + failure_);
        try
        {
            f();
        }
        catch (const std::exception& e)
        {
            failure_ = e.what();
            throw;
        }
    }

private:
    LAMMPS_NS::LAMMPS* lammps_ = nullptr;
    std::string failure_;
};

} // namespace flotsam
