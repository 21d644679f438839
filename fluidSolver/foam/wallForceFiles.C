// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/dictionaryChecks.H"
#include "foam/wallForces.H"

#include "io/textFile.hpp"

#include "OSspecific.H"

#include <cmath>
#include <cstdio>

namespace flotsam
{

namespace
{

const char* const parts[] = {"total", "pressure", "viscous", "contact", "peak"};   // the last of forces alone

std::string header(const WallForceGroup& group, const SimplexMesh& mesh, bool isMoment)
{
    std::string s = text("# ", isMoment ? "Moment [N m]" : "Force [N]", " on patches ", joined(group.patchNames));
    if (isMoment) s += text(", about (", group.origin[0], ' ', group.origin[1], ' ', group.origin[2], ')');
    if (mesh.dim == 2) s += text(", of the mesh's thickness, ", mesh.thickness, " m");
    s += "\n# pressure and viscous: of the fluid, along the wall's normal and along the wall; contact: of bodies, mean over the step; total: their sum";
    s += isMoment ? "\n" : "; peak: of bodies, at the instant of the step at which it was largest\n";
    char column[32];
    std::snprintf(column, sizeof column, "# %-16s", "Time");
    s += column;
    for (int k = 0; k < (isMoment ? 4 : 5); ++k)
        for (char axis : {'x', 'y', 'z'})
        {
            std::snprintf(column, sizeof column, " %18s", text(parts[k], '_', axis).c_str());
            s += column;
        }
    return s + '\n';
}

void writeLine(std::ofstream& file, const std::string& name, double time, std::vector<Vec3> values)
{
    values.insert(values.begin(), values[0] + values[1] + values[2]);
    char column[40];
    std::snprintf(column, sizeof column, "%-18.12g", time);
    std::string line = column;
    for (const Vec3& v : values)
        for (int d = 0; d < 3; ++d)
        {
            std::snprintf(column, sizeof column, " %18.10e", v[d]);
            line += column;
        }
    file << line << std::endl;  // with what it takes to be read while the run goes on
    checkWritten(file, "postProcessing/" + name);
}

/// Of a 2D mesh that in its plane alone, as the fluid's.
Vec3 inPlane(Vec3 moment, const SimplexMesh& mesh)
{
    for (int d = 0; d < 2 && mesh.dim == 2; ++d) moment[mesh.axes[d]] = 0;
    return moment;
}

std::vector<std::string> namesOf(const std::vector<WallForceGroup>& groups)
{
    std::vector<std::string> names;
    for (const WallForceGroup& group : groups) names.push_back(group.name);
    return names;
}

} // namespace

WallForceFiles::WallForceFiles(const Foam::Time& runTime, const SimplexMesh& mesh, std::vector<WallForceGroup> groups)
:   mesh_(mesh), groups_(std::move(groups)), statistics_(namesOf(groups_))
{
    if (!Foam::Pstream::master()) return;
    files_.resize(groups_.size());
    for (std::size_t g = 0; g < groups_.size(); ++g) open(runTime, groups_[g], files_[g]);
}

void WallForceFiles::open(const Foam::Time& runTime, const WallForceGroup& group, Files& files) const
{
    const Foam::fileName folder = runTime.globalPath()/"postProcessing"/group.name/runTime.timeName();
    Foam::mkDir(folder);
    std::string number;
    for (int k = 1; Foam::exists(folder/("force" + number + ".dat")) || Foam::exists(folder/("moment" + number + ".dat")); ++k) number = text('_', k);
    for (const bool isMoment : {false, true})
    {
        std::ofstream& file = isMoment ? files.moment : files.force;
        const Foam::fileName path = folder/((isMoment ? "moment" : "force") + number + ".dat");
        file.open(path);
        file << header(group, mesh_, isMoment) << std::flush;
        if (!file) throw std::runtime_error("cannot write " + path);
    }
}

void WallForceFiles::write(double time, double dt, const std::vector<PatchForce>& onPatches, const std::vector<ContactForce>& contact)
{
    for (std::size_t g = 0; g < files_.size(); ++g)
    {
        PatchForce f;
        for (int p : groups_[g].patches)
        {
            f.pressure += onPatches[p].pressure;
            f.friction += onPatches[p].friction;
            f.pressureMoment += onPatches[p].pressureMoment;
            f.frictionMoment += onPatches[p].frictionMoment;
        }
        const Vec3 fluid = f.pressure + f.friction;
        statistics_.add(g, dt, fluid.data(), contact[g].force.data(), contact[g].peak.data());
        const auto about = [&](const Vec3& moment, const Vec3& force) { return inPlane(moment - groups_[g].origin.cross(force), mesh_); };
        writeLine(files_[g].force, groups_[g].name + ", force", time, {f.pressure, f.friction, contact[g].force, contact[g].peak});
        writeLine(files_[g].moment, groups_[g].name + ", moment", time, {about(f.pressureMoment, f.pressure), about(f.frictionMoment, f.friction), about(contact[g].moment, contact[g].force)});
    }
}

} // namespace flotsam
