// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/runScene.H"

#include "algebra/needlessWork.hpp"

#include <algorithm>
#include <stdexcept>

namespace flotsam
{

SceneCounts countScene(const BodiesInput& input)
{
    SceneCounts counts;
    for (const StructureDefinition& s : input.structures) ++(s.motion ? counts.movingStructures : counts.fixedStructures);
    counts.bodies = int(input.bodies.size());
    counts.thinnestBody = thinnestBody(input);
    counts.thinnestLinearBody = thinnestLinearBody(input);
    for (const BodyDefinition& b : input.bodies)
    {
        counts.bodiesToCome += b.entersAtRelease;
        counts.demSpheres += long(b.spheres.size() + b.corners.size());
    }
    for (const MoverDefinition& m : input.movers) counts.demSpheres += long(m.spheres.size());
    counts.walls = int(input.walls.size());
    counts.areWallsChosen = input.areWallsChosen;
    return counts;
}

Scene makeScene(const BodiesInput& input, const Vec3& gravity)
{
    std::vector<SceneStructure> structures;
    for (const StructureDefinition& s : input.structures) structures.push_back({s.solid, s.wall, s.motion});
    Scene scene(structures, input.bodies, gravity);
    scene.liesIn(input.box);
    return scene;
}

void checkEntries(const BodiesInput& input, const FluidProperties& fluid)
{
    for (const BodyDefinition& body : input.bodies)
        if (body.entersAtRelease && !fluid.isTwoPhase)
            throw std::runtime_error("constant/bodies: body " + body.name + " is absent before its release (beforeRelease absent), but there is no gas through which"
                " it could come in: the case has one fluid. Use 'beforeRelease held', or two fluids");
}

namespace
{

std::vector<int> wallsOf(const WallForceGroup& group, const BodiesInput& input)
{
    std::vector<int> walls;
    for (std::size_t w = 0; w < input.walls.size(); ++w)
        if (std::find(group.patchNames.begin(), group.patchNames.end(), input.walls[w].patch) != group.patchNames.end()) walls.push_back(int(w));
    return walls;
}

} // namespace

DemSetup makeDemSetup(const BodiesInput& input, const std::vector<WallForceGroup>& groups, double timeStep, double startTime)
{
    DemSetup setup;
    setup.bodies = input.bodies;
    setup.walls = input.walls;
    setup.movers = input.movers;
    setup.restraints = input.restraints;
    for (const WallForceGroup& group : groups) setup.wallGroups.push_back(wallsOf(group, input));
    setup.startTime = startTime;
    setup.nMaterials = int(input.materials.size());
    setup.laws = input.laws;
    setup.box = input.box;
    setup.timeStep = timeStep;
    setup.hasContactStepsOnly = doesNeedless("demSteps");
    return setup;
}

std::vector<ContactForce> contactForces(const std::vector<std::vector<int>>& groups, const BodyCoupling* bodies)
{
    std::vector<ContactForce> result(groups.size());
    for (std::size_t g = 0; g < groups.size() && bodies; ++g)
    {
        for (const int w : groups[g])
        {
            result[g].force += bodies->wallLoads()[w].force;
            result[g].moment += bodies->wallLoads()[w].moment;
        }
        result[g].peak = bodies->groupPeaks()[g];
    }
    return result;
}

} // namespace flotsam
