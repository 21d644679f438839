// SPDX-License-Identifier: GPL-3.0-or-later
/// The commands that set up a LIGGGHTS instance.
#include "demCoupling/liggghts/liggghtsTally.hpp"

#include <mpi.h>

#include "fix_multisphere.h"
#include "force.h"
#include "lammps.h"
#include "modify.h"
#include "pair.h"
#include "update.h"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

struct Box { Vec3 lower, upper; };

void include(Box& box, const Vec3& point, double margin = 0)
{
    box.lower = box.lower.cwiseMin(point.array().matrix() - Vec3::Constant(margin));
    box.upper = box.upper.cwiseMax(point.array().matrix() + Vec3::Constant(margin));
}

Box holdingEverything(const DemSetup& setup)
{
    const double margin = 2 * largestRadius(setup) + setup.skin;
    Box box {setup.box[0], setup.box[1]};
    for (const BodyDefinition& body : setup.bodies)
        for (const SurfaceSphere& s : spheresAtWalls(body))
            include(box, body.pose.position + body.pose.orientation * s.centre, margin);
    for (const WallDefinition& wall : setup.walls)
        for (const Vec3& point : wall.surface.points)
            include(box, point, margin);
    return box;
}

/// LIGGGHTS fills the whole box with neighbour bins, by default of half the cut-off: a box of metres would cost
/// hundreds of MB. Wider bins cost nothing measurable.
double binSize(const DemSetup& setup, const Box& box)
{
    constexpr double largestCount = 6e4;
    const double cutoff = 2 * largestRadius(setup) + setup.skin;
    return std::max(cutoff, std::cbrt((box.upper - box.lower).prod() / largestCount));
}

/// Most neighbours of a sphere: LIGGGHTS ends where a sphere has more triangles in reach. All of a surface: with 97,000 triangles that costs
/// neither time nor memory (measured once).
size_t mostNeighbours(const DemSetup& setup)
{
    constexpr size_t least = 2000, most = 200000;   // LIGGGHTS' own default
    size_t triangles = 0;
    for (const WallDefinition& wall : setup.walls)
        triangles += wall.surface.triangles.size();
    return std::clamp(triangles, least, most);
}

std::string numbers(const std::vector<double>& values)
{
    std::string text;
    for (const double v : values)
        text += " " + exactText(v);
    return text;
}

/// `value` of two atom types.
template <class Value>
void addMaterialTable(LiggghtsModel& model, const std::string& name, const Value& value)
{
    const int n = model.contacts.typeCount();
    std::vector<double> values;
    for (int a = 1; a <= n; ++a)
        for (int b = 1; b <= n; ++b)
            values.push_back(value(a, b));
    model.instance.addFix(words("table_" + name + " all property/global " + name + " peratomtypepair " + std::to_string(n)
                                + numbers(values)));
}

} // namespace

double largestRadius(const DemSetup& setup)
{
    double radius = 0;
    for (const BodyDefinition& body : setup.bodies)
        for (const SurfaceSphere& s : body.spheres)
            radius = std::max(radius, s.radius);
    return radius;
}

void writeScript(LiggghtsModel& model, const DemSetup& setup, double timeStep)
{
    LiggghtsInstance& dem = model.instance;
    const Box box = holdingEverything(setup);
    dem.command("units si");
    dem.command("atom_style granular");
    dem.command("atom_modify map array sort 0 0.0"); // spheres keep their order, so sums keep their order
    dem.command("boundary m m m");                   // fixed ones delete bodies that leave, without a word
    dem.command("newton off");
    dem.command("communicate single vel yes");
    dem.command("region box block" + numbers({box.lower.x(), box.upper.x(), box.lower.y(), box.upper.y(),
                                              box.lower.z(), box.upper.z()}) + " units box");
    dem.command("create_box " + std::to_string(model.contacts.typeCount()) + " box");
    dem.command("neighbor " + exactText(setup.skin) + " bin");
    const size_t neighbours = mostNeighbours(setup);
    dem.command("neigh_modify delay 0 every 1 check yes binsize " + exactText(binSize(setup, box)) + " one " + std::to_string(neighbours) + " page "
                + std::to_string(std::max(size_t(100000), 10 * neighbours)));
    excludePairs(model);
    dem.command("timestep " + exactText(timeStep));

    const ContactTable& table = model.contacts;
    const auto stiffness = [&](int a, int b) { return table.stiffness[table.entryOf(a, b)]; };
    const auto damping = [&](int a, int b) { return table.dampingOf(a, b); };
    addMaterialTable(model, "kn", stiffness);
    addMaterialTable(model, "kt", stiffness);
    addMaterialTable(model, "gamman_abs", damping);
    addMaterialTable(model, "gammat_abs", damping); // asked for, not used: see contactModelOptions()
    addMaterialTable(model, "coefficientFriction", [&](int a, int b) { return table.friction[table.entryOf(a, b)]; });
    dem.command("pair_style gran model hooke/stiffness tangential history " + contactModelOptions());
    dem.command("pair_coeff * *");
    WallLimit::install(model);
    addWalls(model, setup);
    model.multisphere = static_cast<LAMMPS_NS::FixMultisphere*>(dem.addFix({"bodies", "all", "multisphere"}));
    ContactTally::install(model, setup);
    dem.command("thermo 1000000000");
}

void setTimeStep(LiggghtsModel& model, double timeStep)
{
    LAMMPS_NS::LAMMPS& dem = model.instance.lammps();
    if (dem.update->dt == timeStep)
        return;
    // LIGGGHTS reads the step size in init() only, and a full init() is what "pre no" avoids
    dem.update->dt = timeStep;
    dem.force->pair->reset_dt();
    model.multisphere->init();
}

void run(LiggghtsModel& model, long steps)
{
    model.instance.command("run " + std::to_string(steps) + " pre no post no");
}

} // namespace flotsam
