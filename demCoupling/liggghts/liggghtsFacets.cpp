// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/liggghtsFacets.hpp"

#include "demCoupling/liggghts/liggghtsHistory.hpp"
#include "geometry/closestPoint.hpp"

#include <mpi.h>

#include "atom.h"
#include "fix_mesh_surface.h"
#include "lammps.h"

#include <algorithm>

namespace flotsam
{

/// As LIGGGHTS finds them: of an edge or a corner that triangles share, one has it.
void FacetChoice::findTouches(const SphereTriangles& near, double margin)
{
    const LAMMPS_NS::Atom& atoms = *model_.instance.lammps().atom;
    LAMMPS_NS::TriMesh& surface = *model_.meshes[near.mesh].mesh->triMesh();
    double* const centre = atoms.x[near.sphere];
    touches_.clear();
    for (const int t : near.triangles)
    {
        Vec3 way, weights;
        int side = 0;
        const double gap = surface.resolveTriSphereContactBary(near.sphere, t, atoms.radius[near.sphere], centre, way.data(), weights.data(), side, true);
        if (gap < margin)
            touches_.push_back({t, -gap, Vec3::Map(centre) + way, way.normalized()});
    }
}

const std::vector<FacetTouch>& FacetChoice::places(const SphereTriangles& near, double margin)
{
    findTouches(near, margin);
    std::stable_sort(touches_.begin(), touches_.end(), [](const FacetTouch& a, const FacetTouch& b) { return a.depth > b.depth; });
    places_.clear();
    doubled_.clear();
    for (const FacetTouch& t : touches_)
    {
        const auto same = std::find_if(places_.begin(), places_.end(), [&t](const FacetTouch& p) { return p.normal.dot(t.normal) > sameNormal; });
        if (same == places_.end())
            places_.push_back(t);
        else
            doubled_.push_back(t.triangle);
    }
    return places_;
}

void FacetChoice::leaveOut()
{
    for (const SphereTriangles& near : model_.near->atTriangles())
    {
        if (near.triangles.size() < 2)
            continue;
        places(near, 0);
        for (const int t : doubled_)
            leaveOut(near, t);
        for (const FacetTouch& place : places_)
            if (!touchesTriangle(*model_.meshes[near.mesh].mesh, near.sphere, place.triangle))
                handOnSpring(near, place);
    }
}

void FacetChoice::leaveOut(const SphereTriangles& near, int triangle)
{
    std::vector<int>& list = meshList(*model_.meshes[near.mesh].mesh, triangle);
    const auto at = std::find(list.begin(), list.end(), near.sphere);
    taken_.push_back({near.mesh, triangle, near.sphere, static_cast<size_t>(at - list.begin())});
    list.erase(at);
}

/// What slides over an edge keeps its friction: a place that begins has the spring of a triangle that is none any more, if their normals are close.
void FacetChoice::handOnSpring(const SphereTriangles& near, const FacetTouch& place)
{
    LAMMPS_NS::FixMeshSurface& surface = *model_.meshes[near.mesh].mesh;
    const Vec3 centre = Vec3::Map(model_.instance.lammps().atom->x[near.sphere]);
    for (const int t : near.triangles)
    {
        const bool isPlace = std::any_of(places_.begin(), places_.end(), [t](const FacetTouch& p) { return p.triangle == t; });
        if (isPlace || !touchesTriangle(surface, near.sphere, t))
            continue;
        const std::array<Vec3, 3> corners = cornersOf(surface, t);
        if ((closestPointOfTriangle(centre, corners[0], corners[1], corners[2]) - centre).normalized().dot(place.normal) > sameNormal)
            return renameTriangle(surface, near.sphere, t, place.triangle);
    }
}

void FacetChoice::takeBack()
{
    for (auto t = taken_.rbegin(); t != taken_.rend(); ++t)
    {
        std::vector<int>& list = meshList(*model_.meshes[t->mesh].mesh, t->triangle);
        list.insert(list.begin() + static_cast<std::ptrdiff_t>(t->place), t->sphere);
    }
    taken_.clear();
}

} // namespace flotsam
