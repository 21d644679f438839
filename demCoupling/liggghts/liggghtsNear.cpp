// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/liggghtsNear.hpp"

#include "demCoupling/liggghts/liggghtsHistory.hpp"
#include "demCoupling/liggghts/liggghtsRestraints.hpp"
#include "geometry/closestPoint.hpp"

#include <mpi.h>

#include "atom.h"
#include "fix_mesh_surface.h"
#include "fix_neighlist_mesh.h"
#include "force.h"
#include "lammps.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "pair_gran.h"
#include "update.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace flotsam
{

namespace
{

constexpr double stepsToSelection = 20; // a choice costs as much as one sub-step
constexpr double leastReach = 0.0025;   // of the skin, for bodies that are pushed from rest

Vec3 asVec(const double* v) { return Vec3(v[0], v[1], v[2]); }

/// The lists are protected; a derived class may name them.
struct MeshListAccess : LAMMPS_NS::FixNeighlistMesh
{
    static std::vector<int>& of(LAMMPS_NS::FixNeighlistMesh& lists, int triangle)
    {
        return (lists.*&MeshListAccess::triangles)[static_cast<size_t>(triangle)].contacts;
    }
};

} // namespace

LAMMPS_NS::NeighList& pairList(const LiggghtsModel& model) { return *model.instance.lammps().force->pair->list; }

std::vector<int>& meshList(LAMMPS_NS::FixMeshSurface& mesh, int triangle) { return MeshListAccess::of(*mesh.meshNeighlist(), triangle); }

LiggghtsModel::LiggghtsModel() = default;
LiggghtsModel::~LiggghtsModel() = default;

NearSpheres::NearSpheres(LiggghtsModel& model, const DemSetup& setup)
    : model_(model), extents_(setup.bodies.size(), Vec3::Zero()), reach_(setup.bodies.size())
{
    for (size_t b = 0; b < setup.bodies.size(); ++b)
        for (const SurfaceSphere& s : spheresAtWalls(setup.bodies[b]))
        {
            extents_[b] = extents_[b].cwiseMax(s.centre.cwiseAbs());
            bodies_.push_back(b);
        }
    isActive_.resize(bodies_.size());
}

NearSpheres::Place NearSpheres::placeOf(size_t body) const
{
    const BodyArrays& b = model_.bodies;
    return {asVec(b.xcm[body]), asVec(b.ex[body]), asVec(b.ey[body]), asVec(b.ez[body])};
}

/// Bound of the way any of the body's spheres has gone [m].
double NearSpheres::wayFrom(const std::vector<Place>& places, size_t body) const
{
    const BodyArrays& b = model_.bodies;
    const Place& old = places[body];
    return (asVec(b.xcm[body]) - old[0]).norm() + extents_[body][0] * (asVec(b.ex[body]) - old[1]).norm()
           + extents_[body][1] * (asVec(b.ey[body]) - old[2]).norm() + extents_[body][2] * (asVec(b.ez[body]) - old[3]).norm();
}

double NearSpheres::speedOf(size_t body) const
{
    const BodyArrays& b = model_.bodies;
    const Vec3 spin = asVec(b.omega[body]);
    return asVec(b.vcm[body]).norm() + extents_[body][0] * spin.cross(asVec(b.ex[body])).norm() + extents_[body][1] * spin.cross(asVec(b.ey[body])).norm()
           + extents_[body][2] * spin.cross(asVec(b.ez[body])).norm();
}

/// How far a body may move between two rebuilds [m]: another may come to meet it.
double NearSpheres::listReach() const { return 0.5 * model_.instance.lammps().neighbor->skin; }

double NearSpheres::wantedReach(size_t body, double steps, double least) const
{
    const LAMMPS_NS::LAMMPS& dem = model_.instance.lammps();
    return std::min(steps * speedOf(body) * dem.update->dt + least * dem.neighbor->skin, 0.5 * listReach());
}

void NearSpheres::takeLists(const std::vector<std::vector<int>>& nearPlane)
{
    rebuilt_.resize(reach_.size());
    for (size_t b = 0; b < rebuilt_.size(); ++b)
        rebuilt_[b] = placeOf(b);
    wasGone_ = model_.isGone;
    wasRetreated_ = model_.isRetreated;
    isOld_ = false;
    std::fill(isActive_.begin(), isActive_.end(), 0);
    takePairs();
    takeTriangles();
    nearPlanes_.clear();
    for (const std::vector<int>& spheres : nearPlane)
        nearPlanes_.insert(nearPlanes_.end(), spheres.begin(), spheres.end());
    for (const int i : nearPlanes_)
        markActive(i);
    listed_.clear();
    for (size_t i = 0; i < isActive_.size(); ++i)
        if (isActive_[i])
            listed_.push_back(static_cast<int>(i));
    select();
    isNew_ = true;
}

bool NearSpheres::takeListsAgain()
{
    if (rebuilt_.empty() || wasGone_ != model_.isGone || wasRetreated_ != model_.isRetreated)
        return false;
    for (size_t b = 0; b < rebuilt_.size(); ++b)
        if (placeOf(b) != rebuilt_[b])
            return false;
    const LAMMPS_NS::NeighList& list = pairList(model_);
    allSpheres_.assign(list.ilist, list.ilist + list.inum);
    isOld_ = false;
    forgetGaps();
    select();
    isNew_ = true;
    return true;
}

void NearSpheres::takePairs()
{
    const LAMMPS_NS::NeighList& list = pairList(model_);
    allSpheres_.assign(list.ilist, list.ilist + list.inum);
    pairs_.clear();
    others_.clear();
    for (const int i : allSpheres_)
    {
        if (list.numneigh[i] == 0)
            continue;
        const size_t first = others_.size();
        others_.insert(others_.end(), list.firstneigh[i], list.firstneigh[i] + list.numneigh[i]);
        pairs_.push_back({i, first, others_.size()});
        markActive(i);
        for (size_t k = first; k < others_.size(); ++k)
            markActive(others_[k] & NEIGHMASK);
    }
    forgetGaps();
}

void NearSpheres::takeTriangles()
{
    triangles_.clear();
    for (size_t m = 0; m < model_.meshes.size(); ++m)
    {
        const int nTriangles = model_.meshes[m].mesh->triMesh()->sizeLocal();
        for (int t = 0; t < nTriangles; ++t)
        {
            const std::vector<int>& spheres = meshList(*model_.meshes[m].mesh, t);
            if (spheres.empty())
                continue;
            triangles_.push_back({m, t, cornersOf(*model_.meshes[m].mesh, t), spheres});
            for (const int i : spheres)
                markActive(i);
        }
    }
}

bool NearSpheres::keepUp()
{
    isNew_ = false;
    bool isFar = false;
    for (size_t b = 0; b < selected_.size() && !isOld_; ++b)
    {
        if (wayFrom(selected_, b) > reach_[b])
        {
            select();
            return !isOld_;
        }
        isFar = isFar || wayFrom(few_, b) > shortReach_[b];
    }
    if (isFar && !isOld_)
    {
        placeSpheres(model_, near_);
        selectFew();
    }
    return !isOld_;
}

void NearSpheres::cover(const std::vector<double>& ways)
{
    for (size_t b = 0; b < selected_.size(); ++b)
        if (wayFrom(selected_, b) + ways[b] > reach_[b])
            return select();
    placeSpheres(model_, near_);
    selectFew();
}

void NearSpheres::select()
{
    placeSpheres(model_, listed_);
    addWays();
    selected_.resize(reach_.size());
    for (size_t b = 0; b < reach_.size(); ++b)
    {
        selected_[b] = placeOf(b);
        reach_[b] = wantedReach(b, stepsToSelection, leastReach);
        isOld_ = isOld_ || wayFrom(rebuilt_, b) + reach_[b] > listReach();
    }
    for (const int i : listed_)
        isActive_[static_cast<size_t>(i)] = 0;
    selectTriangles();
    for (const int i : nearPlanes_)
        markActive(i);
    isHeld_ = isActive_;
    selectCandidates();
    selectFew();
}

void NearSpheres::dropOpenedContacts()
{
    const LAMMPS_NS::Atom& atoms = *model_.instance.lammps().atom;
    const LAMMPS_NS::NeighList& list = pairList(model_);
    const LAMMPS_NS::NeighList& history = *list.listgranhistory;
    for (int ii = 0; ii < list.inum; ++ii)
    {
        const int i = list.ilist[ii];
        for (int jj = 0; jj < list.numneigh[i]; ++jj)
        {
            if (!history.firstneigh[i][jj])
                continue;
            const int j = list.firstneigh[i][jj] & NEIGHMASK;
            const double reach = atoms.radius[i] + atoms.radius[j];
            if ((asVec(atoms.x[i]) - asVec(atoms.x[j])).squaredNorm() < reach * reach)
                continue;
            history.firstneigh[i][jj] = 0;
            std::fill_n(history.firstdouble[i] + 3 * jj, 3, 0.0);
        }
    }
}

void NearSpheres::selectTriangles()
{
    const LAMMPS_NS::Atom& atoms = *model_.instance.lammps().atom;
    touchable_.assign(model_.meshes.size(), {});
    for (const TriangleNeighbours& all : triangles_)
    {
        LAMMPS_NS::FixMeshSurface& mesh = *model_.meshes[all.mesh].mesh;
        std::vector<int>& list = meshList(mesh, all.triangle);
        list.clear();
        for (const int i : all.spheres)
        {
            const Vec3 centre = asVec(atoms.x[i]), point = closestPointOfTriangle(centre, all.corners[0], all.corners[1], all.corners[2]);
            const double reach = atoms.radius[i] + reach_[bodyOf(i)];
            if ((point - centre).squaredNorm() > reach * reach && !touchesTriangle(mesh, i, all.triangle))
                continue;
            list.push_back(i);
            markActive(i);
        }
        if (!list.empty())
            touchable_[all.mesh].push_back(all.triangle);
    }
    atMeshes_.clear();
    for (const int i : listed_)
        if (isActive_[static_cast<size_t>(i)])
            atMeshes_.push_back(i);
    sortBySpheres();
}

void NearSpheres::sortBySpheres()
{
    atTriangles_.clear();
    for (size_t m = 0; m < model_.meshes.size(); ++m)
    {
        std::map<int, std::vector<int>> bySphere;
        for (const int t : touchable_[m])
            for (const int i : meshList(*model_.meshes[m].mesh, t))
                bySphere[i].push_back(t);
        for (auto& [sphere, triangles] : bySphere)
            atTriangles_.push_back({m, sphere, std::move(triangles)});
    }
}

void NearSpheres::showAll()
{
    isNew_ = isOld_ = false;
    atTriangles_.clear();
    atMeshes_.resize(bodies_.size());
    std::iota(atMeshes_.begin(), atMeshes_.end(), 0);
    touchable_.resize(model_.meshes.size());
    for (size_t m = 0; m < touchable_.size(); ++m)
    {
        touchable_[m].resize(static_cast<size_t>(model_.meshes[m].mesh->triMesh()->sizeLocal()));
        std::iota(touchable_[m].begin(), touchable_[m].end(), 0);
    }
    if (allSpheres_.empty())
        return;
    LAMMPS_NS::NeighList& list = pairList(model_);
    std::copy(allSpheres_.begin(), allSpheres_.end(), list.ilist);
    list.inum = static_cast<int>(allSpheres_.size());
    allSpheres_.clear();
    selected_.clear(); // nothing to keep up with until the next rebuild
}

} // namespace flotsam
