// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/restraintOutput.H"

#include "foam/dictionaryChecks.H"
#include "io/textFile.hpp"

#include "OSspecific.H"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace flotsam
{

namespace
{

template<class... Values>
std::string formatted(const char* format, Values... values)
{
    char line[256];
    std::snprintf(line, sizeof line, format, values...);
    return line;
}

std::string header(const RestraintDefinition& r)
{
    return text("# Restraint ", r.name, ", ", r.kind == RestraintDefinition::Kind::Tether ? "tether" : "linearSpring", ": force on `body` and tension, means over the step that ends at Time [N]; tension of the"
        " sub-step in which it was largest [N]; length at Time [m]; 1: broken\n")
        + formatted("# %-16s %18s %18s %18s %18s %18s %18s %6s\n", "Time", "force_x", "force_y", "force_z", "tension", "largest", "length", "broken");
}

/// Number of the record of what the end is fastened to; -1: a point of space.
int recordOf(const RestraintEnd& end, const BodiesInput& input)
{
    if (end.body >= 0) return int(input.structures.size()) + end.body;
    if (end.mover < 0) return -1;
    const int wall = int(input.walls.size()) + end.mover;
    const auto isMover = [&](const StructureDefinition& s) { return s.motion && s.wall == wall; };
    return int(std::find_if(input.structures.begin(), input.structures.end(), isMover) - input.structures.begin());
}

Vec3 inSpace(const RestraintEnd& end, int record, const std::vector<BodyRecord>& records)
{
    if (record < 0) return end.place;
    return records[record].pose.position + records[record].pose.orientation*end.place;
}

} // namespace

RestraintOutput::RestraintOutput(const BodiesInput& input) : restraints_(input.restraints), extremes_(input.restraints.size())
{
    for (const RestraintDefinition& r : restraints_) records_.push_back({recordOf(r.end, input), recordOf(r.other, input)});
}

std::vector<LineRecord> RestraintOutput::lines(const std::vector<BodyRecord>& records, const std::vector<RestraintLoad>& loads) const
{
    std::vector<LineRecord> lines;
    for (std::size_t i = 0; i < restraints_.size(); ++i)
    {
        const Vec3 end = inSpace(restraints_[i].end, records_[i][0], records), other = inSpace(restraints_[i].other, records_[i][1], records);
        const bool isThere = !loads[i].isBroken && loads[i].length > 0;
        lines.push_back({end, isThere ? other : end, loads[i].tension, records_[i][0], records_[i][1]});
    }
    return lines;
}

void RestraintOutput::begin(const Foam::Time& runTime)
{
    if (!Foam::Pstream::master()) return;
    const Foam::fileName folder = runTime.globalPath()/"postProcessing"/"restraints"/runTime.timeName();
    files_.resize(restraints_.size());
    if (!files_.empty()) Foam::mkDir(folder);
    for (std::size_t i = 0; i < restraints_.size(); ++i)
    {
        const std::string& name = restraints_[i].name;
        Foam::fileName path = folder/(name + ".dat");
        for (int k = 1; Foam::exists(path); ++k) path = folder/text(name, '_', k, ".dat");
        files_[i].open(path);
        files_[i] << header(restraints_[i]) << std::flush;
        if (!files_[i]) throw std::runtime_error("cannot write " + path);
    }
}

void RestraintOutput::record(double time, const std::vector<RestraintLoad>& loads)
{
    for (std::size_t i = 0; i < loads.size(); ++i)
    {
        const RestraintLoad& load = loads[i];
        Extreme& extreme = extremes_[i];
        if (std::abs(load.largest) > std::abs(extreme.tension)) extreme = {load.largest, time, extreme.brokenAt};
        if (load.isBroken && extreme.brokenAt < 0)
        {
            extreme.brokenAt = time;
            Foam::Info<< text("t = ", time, " s: restraint ", restraints_[i].name, " is broken: its force exceeded ", restraints_[i].breakingForce, " N").c_str() << Foam::endl;
        }
        if (files_.empty()) continue;
        files_[i] << formatted("%-18.12g %18.10e %18.10e %18.10e %18.10e %18.10e %18.10e %6d", time, load.force[0], load.force[1], load.force[2], load.tension, load.largest,
            load.length, int(load.isBroken)) << std::endl;
        checkWritten(files_[i], "postProcessing/restraints, " + restraints_[i].name);
    }
}

std::string RestraintOutput::summary() const
{
    if (restraints_.empty()) return "";
    std::string table = "\n  restraints              largest tension [N]     at [s]   broken at [s]\n";
    for (std::size_t i = 0; i < restraints_.size(); ++i)
        table += formatted("  %-22s %20.4g %10.4g   ", restraints_[i].name.c_str(), extremes_[i].tension, extremes_[i].time)
            + (extremes_[i].brokenAt < 0 ? "no" : formatted("%.4g", extremes_[i].brokenAt)) + '\n';
    return table;
}

std::vector<std::string> RestraintOutput::names() const
{
    std::vector<std::string> names;
    for (const RestraintDefinition& r : restraints_) names.push_back(r.name);
    return names;
}

std::vector<double> RestraintOutput::values() const
{
    std::vector<double> values;
    for (const Extreme& e : extremes_) values.insert(values.end(), {e.tension, e.time, e.brokenAt});
    return values;
}

void RestraintOutput::restore(const std::vector<double>& values)
{
    for (std::size_t i = 0; i < extremes_.size() && 3*i + 2 < values.size(); ++i) extremes_[i] = {values[3*i], values[3*i + 1], values[3*i + 2]};
}

} // namespace flotsam
