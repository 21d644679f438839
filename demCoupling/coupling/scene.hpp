// SPDX-License-Identifier: GPL-3.0-or-later
/// The solids of a run in one list (structures, then bodies), as the fluid sees them, and the way from body states to solids and
/// from fluid loads to bodies.
#pragma once

#include "demCoupling/coupling/bodyCoupling.hpp"
#include "equations/flowEquation.hpp"

#include <functional>
#include <string>
#include <utility>

namespace flotsam
{

/// One structure member of the scene.
struct SceneStructure
{
    Solid solid;
    int wall = -1;      ///< its DEM wall, -1: bodies do not feel it
    std::function<void(double time, Pose&, Motion&)> motion; ///< empty: fixed
};

class Scene
{
public:
    Scene(std::vector<SceneStructure> structures, const std::vector<BodyDefinition>& bodies, const Vec3& gravity);

    std::vector<Solid>& solids() { return solids_; }
    const std::vector<Solid>& solids() const { return solids_; }
    int nStructures() const { return int(structures_.size()); }
    int nBodies() const { return int(bodies_.size()); }
    int wallOf(int structure) const { return structures_[structure].wall; }
    bool isEmpty() const { return solids_.empty(); }
    bool moves() const { return isMoving_ || nBodies() > 0; }

    /// Prescribed structures at `time`; bodies as `coupling` predicts them (null: no bodies).
    void place(double time, const BodyCoupling* coupling);

    /// The free bodies' part of the linear system: states at t^n, weight, last and contact loads, inertia in the placed orientation.
    void findFreeBodies(const BodyCoupling& coupling, double newLoadShare, std::vector<FreeBody>& result) const;

    /// Mean over the step of fluid force and moment of every body plus its weight: the constant load of the DEM sub-steps. newLoadShare: see Fluid.
    template<class FluidLoad>
    void findBodyLoads(const std::vector<FluidLoad>& fluid, const BodyCoupling& coupling, double newLoadShare, std::vector<Load>& loads) const
    {
        loads.resize(bodies_.size());
        for (std::size_t b = 0; b < bodies_.size(); ++b)
        {
            const FluidLoad& now = fluid[structures_.size() + b];
            const Load& last = coupling.lastLoads()[b];
            const double share = coupling.newLoadShare(int(b), newLoadShare);
            loads[b].force = share*(now.force + bodies_[b].mass*gravity_) + (1 - share)*last.force;
            loads[b].moment = share*now.moment + (1 - share)*last.moment;
        }
    }

    /// Box of the mesh [m], everything without: structures outside of it move nothing.
    void liesIn(const std::array<Vec3, 2>& box) { meshBox_ = box; }

    /// Of the moving solids the one with the fastest surface, now or, of what moves as prescribed, at a time that is `ahead` of now [s]: its name and that speed [m/s]; nothing and 0 without
    /// one. Structures that do not come into the mesh until then do not count: a gate that is out of the water.
    std::pair<std::string, double> fastest(double time, double ahead) const;

    /// Poses, motions and offsets of all solids as numbers, and back (checkpoint).
    void save(std::vector<double>& data) const;
    void restore(const std::vector<double>& data);
    void restore(const std::vector<double>& data, const std::vector<int>& known);   ///< of these solids alone: the others stay as they are
    void hide(const std::vector<char>& areHidden);  ///< out of the mesh, until they are placed again
    /// Places some solids as a run that begins at `time` does; coupling as in place().
    void begin(double time, const BodyCoupling* coupling, const std::vector<char>& which);
    /// Pose, motion, offset and kind of every solid that save() has written.
    static std::vector<Solid> stored(const std::vector<double>& data);

private:
    void placeBody(std::size_t body, const BodyCoupling& coupling);

    std::vector<SceneStructure> structures_;
    std::vector<BodyDefinition> bodies_;
    std::vector<std::array<Vec3, 2>> bounds_;   // per solid, in its own frame [m]
    std::vector<Solid> solids_;
    std::array<Vec3, 2> meshBox_{Vec3::Constant(-1e300), Vec3::Constant(1e300)};
    Vec3 gravity_;
    bool isMoving_ = false;
};

} // namespace flotsam
