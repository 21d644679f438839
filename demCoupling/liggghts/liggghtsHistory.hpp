// SPDX-License-Identifier: GPL-3.0-or-later
/// Contacts as LIGGGHTS remembers them.
#pragma once

#include "demCoupling/liggghts/liggghtsParts.hpp"

#include <mpi.h>

#include <functional>

namespace flotsam
{

/// visit(sphere i, sphere j, tangential spring on i, its length) for every touching pair of spheres.
void forEachPairContact(const LiggghtsModel& model, const std::function<void(int, int, const double*, int)>& visit);

/// All triangles of all meshes that this sphere (LIGGGHTS index) touches.
void findMeshTouches(const LiggghtsModel& model, int sphere, std::vector<MeshTouch>& touches);

/// Corners of a triangle of the mesh [m].
std::array<Vec3, 3> cornersOf(LAMMPS_NS::FixMeshSurface& mesh, int triangle);

/// Whether this sphere touches a triangle of the mesh.
bool touchesMesh(LAMMPS_NS::FixMeshSurface& mesh, int sphere);
/// Whether it touches this triangle of the mesh.
bool touchesTriangle(LAMMPS_NS::FixMeshSurface& mesh, int sphere, int triangle);
/// The spring that it has at a triangle is now that at another, which it did not touch before.
void renameTriangle(LAMMPS_NS::FixMeshSurface& mesh, int sphere, int from, int to);

} // namespace flotsam
