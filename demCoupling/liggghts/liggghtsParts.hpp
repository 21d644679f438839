// SPDX-License-Identifier: GPL-3.0-or-later
/// Parts of the engine that see LIGGGHTS types; included by this folder's .cpp files only.
#pragma once

#include "demCoupling/core/storedMembers.hpp"
#include "demCoupling/liggghts/contactLaw.hpp"
#include "demCoupling/liggghts/liggghtsInstance.hpp"

namespace LAMMPS_NS
{
class FixMultisphere;
class FixMeshSurface;
class NeighList;
}

namespace flotsam
{

class ContactTally;
class NearSpheres;
class Restraints;

/// LIGGGHTS' arrays of the bodies, [body][component], space frame. Valid until a body is inserted.
struct BodyArrays
{
    int count = 0;
    double **xcm, **vcm, **fcm, **torque, **drag, **hdTorque, **angmom, **omega, **ex, **ey, **ez, **inertia, **quat;
    double* mass;
};

/// What a wall of the set-up became in LIGGGHTS.
struct WallHandle
{
    int axis = -1;              ///< of a primitive plane; -1: mesh
    double coordinate = 0;      ///< of the plane on that axis [m]
    LAMMPS_NS::Fix* force = nullptr;    ///< plane: per-sphere force on the sphere [N]
    LAMMPS_NS::Fix* history = nullptr;  ///< plane: per-sphere tangential history
    LAMMPS_NS::FixMeshSurface* mesh = nullptr; ///< may hold further walls, see MeshGroup
};

/// Walls that are one mesh in LIGGGHTS, which visits every sphere for every mesh in every sub-step. They are of one class, and so far
/// apart that no sphere touches two of them.
struct MeshGroup
{
    LAMMPS_NS::FixMeshSurface* mesh = nullptr;
    std::vector<int> walls;
    std::vector<std::array<Vec3, 2>> boxes; ///< of the walls, a sphere's radius larger
    /// The wall a point on a triangle or the centre of a touching sphere belongs to.
    int wallAt(const Vec3& point) const;
};

/// Everything that lives inside one LIGGGHTS instance.
struct LiggghtsModel
{
    LiggghtsModel();
    ~LiggghtsModel();
    LiggghtsInstance instance;
    LAMMPS_NS::FixMultisphere* multisphere = nullptr;
    ContactTally* tally = nullptr;      ///< owned by LIGGGHTS' list of fixes
    LAMMPS_NS::Fix* meshWalls = nullptr; ///< contact with all mesh walls; null without them
    LAMMPS_NS::Fix* meshForce = nullptr; ///< per-sphere force of all mesh walls [N]; null without mesh walls
    std::unique_ptr<NearSpheres> near;
    std::unique_ptr<Restraints> restraints;
    std::vector<WallHandle> walls;
    std::vector<MeshGroup> meshes;
    BodyArrays bodies;
    std::vector<char> isGone;           ///< per body: takes part in nothing, any more or yet
    std::vector<Pose> exits;            ///< per body that is gone: where it was, or comes in
    std::array<Vec3, 2> parking;        ///< box that holds those that are gone
    int firstMover = 0;                 ///< bodies from this one on move as prescribed, and touch the others alone
    bool touchesWalls(int sphere) const;
    std::vector<int> firstSphere;       ///< per body, and the total: sphere of index s has LIGGGHTS tag s+1
    std::vector<int> firstCorner;       ///< per body, among its spheres: from this one on they touch walls alone
    std::vector<int> classOfSphere;     ///< in `contacts`
    std::vector<char> isRetreated;      ///< per sphere: a corner that touches nothing, see CornerSpheres
    ContactTable contacts;
    std::vector<Load> loads;            ///< given to the bodies beside contact, constant over a call
    std::vector<BodyShare> shares;      ///< of contact loads, where the fluid answers them within the call
};

// liggghtsScript.cpp
double largestRadius(const DemSetup& setup);
void writeScript(LiggghtsModel& model, const DemSetup& setup, double timeStep);
void setTimeStep(LiggghtsModel& model, double timeStep);
void run(LiggghtsModel& model, long steps);

// liggghtsWalls.cpp
void addWalls(LiggghtsModel& model, const DemSetup& setup);
std::string contactModelOptions();
std::vector<std::string> words(const std::string& text);

// liggghtsBodies.cpp
void insertBodies(LiggghtsModel& model, const DemSetup& setup);
void checkBodies(const LiggghtsModel& model, const DemSetup& setup);
BodyArrays bodyArrays(const LiggghtsModel& model);
/// Which components may change: mobility {force xyz, torque xyz}.
void setMobility(LiggghtsModel& model, int body, const std::array<bool, 6>& isFree);
void setPose(LiggghtsModel& model, int body, const Pose& pose);
void setMotion(LiggghtsModel& model, int body, const Motion& motion);
/// Positions and velocities of all spheres from those of their bodies; the lists must be rebuilt before the next sub-step.
void placeSpheres(LiggghtsModel& model);
/// What LIGGGHTS does with all spheres in every sub-step: positions and velocities; forces added to those of the bodies, and cleared.
void placeSpheres(LiggghtsModel& model, const std::vector<int>& spheres);
void takeForces(LiggghtsModel& model, const std::vector<int>& spheres);
/// Of contact loads (in fcm and torque, alone) what the fluid answers joins the given loads.
void answerContacts(LiggghtsModel& model, const std::vector<Load>& given);
/// Lists of neighbours for the present positions of the spheres.
void rebuildNeighbours(LiggghtsModel& model);

/// A triangle of a mesh that a sphere touches: nearest point and overlap [m].
struct MeshTouch { size_t mesh; Vec3 point; double overlap; };

// liggghtsHistory.cpp: tangential springs as plain doubles, keyed by sphere tags and triangle ids
void appendHistories(const LiggghtsModel& model, std::vector<double>& data);
/// Returns the position behind what was read.
size_t readHistories(LiggghtsModel& model, const std::vector<double>& data, size_t position);
/// Appends to `renumbered` what is stored from the position on, with other tags of the spheres (tags[old]), and returns the position behind it.
size_t renumberHistories(const LiggghtsModel& model, const std::vector<double>& data, size_t position, const std::vector<int>& tags, std::vector<double>& renumbered);

/// LIGGGHTS clears pages of marks for 100,000 contacts per mesh in every sub-step: after its set-up, pages no longer than one sphere may need.
void shrinkContactPages(LiggghtsModel& model);

/// Of a sphere (LIGGGHTS index) with planes and meshes.
void forgetWallContacts(LiggghtsModel& model, int sphere);

// liggghtsGone.cpp
void excludePairs(LiggghtsModel& model);
std::vector<BodyDefinition> placedAtStart(const DemSetup& setup);       ///< with those that come later out of the way
void setGone(LiggghtsModel& model, const std::vector<char>& isGone);
void markGone(LiggghtsModel& model, const std::vector<char>& isGone);   ///< without moving them

// liggghtsState.cpp
void saveState(const LiggghtsModel& model, DemState& state);     ///< keeps its memory
void restoreState(LiggghtsModel& model, const DemState& state);

// liggghtsAdded.cpp
/// A state of some of the bodies and restraints as one of all: the others are as they are now, without contact. Movers are all in the state.
DemState withAdded(const LiggghtsModel& model, const DemState& state, const StoredMembers& stored);

// liggghtsContacts.cpp
std::vector<Contact> listContacts(const LiggghtsModel& model, const DemSetup& setup);

} // namespace flotsam
