// SPDX-License-Identifier: GPL-3.0-or-later
/// Tangential springs of all contacts, written and read as plain doubles.
/// Pair contacts and planes are keyed by sphere tags, mesh contacts by sphere tag and triangle id.
#include "demCoupling/liggghts/liggghtsHistory.hpp"
#include "geometry/closestPoint.hpp"


#include "atom.h"
#include "fix_mesh_surface.h"
#include "force.h"
#include "lammps.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "pair_gran.h"

#include <algorithm>
#include <map>

namespace flotsam
{

namespace
{

using LAMMPS_NS::FixContactHistoryMesh;

/// The arrays are protected; a derived class may name them.
struct MeshHistoryAccess : FixContactHistoryMesh
{
    static int& count(FixContactHistoryMesh& h, int i) { return (h.*&MeshHistoryAccess::npartner_)[i]; }
    static int* triangles(FixContactHistoryMesh& h, int i) { return (h.*&MeshHistoryAccess::partner_)[i]; }
    static LAMMPS_NS::MyPage<bool>& keptPage(FixContactHistoryMesh& h) { return *(h.*&MeshHistoryAccess::keeppage_)[0]; }
    static double* springs(FixContactHistoryMesh& h, int i) { return (h.*&MeshHistoryAccess::contacthistory_)[i]; }
};

size_t reserveCount(std::vector<double>& data)
{
    data.push_back(0);
    return data.size() - 1;
}

void appendPairs(const LiggghtsModel& model, std::vector<double>& data)
{
    const size_t count = reserveCount(data);
    const int* tag = model.instance.lammps().atom->tag;
    forEachPairContact(model, [&](int i, int j, const double* spring, int n) {
        data.push_back(tag[i]);
        data.push_back(tag[j]);
        data.insert(data.end(), spring, spring + n);
        ++data[count];
    });
}

void appendPlane(const LiggghtsModel& model, const LAMMPS_NS::Fix& history, std::vector<double>& data)
{
    const size_t count = reserveCount(data);
    const LAMMPS_NS::Atom& atoms = *model.instance.lammps().atom;
    const int n = history.size_peratom_cols;
    for (int i = 0; i < atoms.nlocal; ++i)
    {
        const double* spring = history.array_atom[i];
        if (std::all_of(spring, spring + n, [](double s) { return s == 0; }))
            continue;
        data.push_back(atoms.tag[i]);
        data.insert(data.end(), spring, spring + n);
        ++data[count];
    }
}

/// Order of the occupied slots after LIGGGHTS' own compaction at the next rebuild: the last occupied slot moves
/// into the first empty one. The order decides which of several coplanar triangles hands on its spring.
std::vector<int> compactedSlots(const int* triangles, int slots)
{
    std::vector<int> order(static_cast<size_t>(slots));
    for (int s = 0; s < slots; ++s)
        order[static_cast<size_t>(s)] = triangles[s] >= 0 ? s : -1;
    for (size_t first = 0; first < order.size(); ++first)
    {
        while (!order.empty() && order.back() < 0)
            order.pop_back();
        if (first < order.size() && order[first] < 0)
            std::swap(order[first], order.back());
    }
    return order;
}

void appendMesh(const LiggghtsModel& model, FixContactHistoryMesh& history, std::vector<double>& data)
{
    const size_t count = reserveCount(data);
    const LAMMPS_NS::Atom& atoms = *model.instance.lammps().atom;
    const int n = history.get_dnum();
    for (int i = 0; i < atoms.nlocal; ++i)
    {
        if (MeshHistoryAccess::count(history, i) == 0)
            continue;
        const int* triangles = MeshHistoryAccess::triangles(history, i);
        const double* springs = MeshHistoryAccess::springs(history, i);
        for (const int slot : compactedSlots(triangles, history.nneighs(i)))
        {
            data.push_back(atoms.tag[i]);
            data.push_back(triangles[slot]);
            data.insert(data.end(), springs + slot * n, springs + (slot + 1) * n);
            ++data[count];
        }
    }
}

/// A reader that refuses to run past the end.
class Reader
{
public:
    Reader(const std::vector<double>& data, size_t position) : data_(data), position_(position) {}
    const double* take(size_t count)
    {
        if (position_ + count > data_.size())
            throw DemError("DEM state: the data end early (written by another version or another case?)");
        position_ += count;
        return data_.data() + (position_ - count);
    }
    long takeCount() { return std::lround(*take(1)); }
    size_t position() const { return position_; }

private:
    const std::vector<double>& data_;
    size_t position_;
};

int sphereOf(const LiggghtsModel& model, double tag)
{
    const int i = model.instance.lammps().atom->map(static_cast<int>(tag));
    if (i < 0)
        throw DemError("DEM state: it names a sphere this case does not have");
    return i;
}

void readPairs(LiggghtsModel& model, Reader& reader)
{
    auto& pair = static_cast<LAMMPS_NS::PairGran&>(*model.instance.lammps().force->pair);
    const int n = pair.dnum();
    std::map<std::pair<int, int>, const double*> stored;
    for (long c = reader.takeCount(); c > 0; --c)
    {
        const double* entry = reader.take(static_cast<size_t>(2 + n));
        stored[{sphereOf(model, entry[0]), sphereOf(model, entry[1])}] = entry + 2;
    }
    size_t found = 0;
    LAMMPS_NS::NeighList& list = *pair.list;
    LAMMPS_NS::NeighList& history = *list.listgranhistory;
    for (int ii = 0; ii < list.inum; ++ii)
    {
        const int i = list.ilist[ii];
        for (int jj = 0; jj < list.numneigh[i]; ++jj)
        {
            const int j = list.firstneigh[i][jj] & NEIGHMASK;
            double sign = 1;
            auto it = stored.find({i, j});
            if (it == stored.end())
            {
                it = stored.find({j, i});
                sign = -1; // the spring acts on the first of the two
            }
            const bool isTouching = it != stored.end();
            found += isTouching;
            history.firstneigh[i][jj] = isTouching;
            for (int d = 0; d < n; ++d)
                history.firstdouble[i][n * jj + d] = isTouching ? sign * it->second[d] : 0;
        }
    }
    if (found != stored.size())
        throw DemError("DEM state: touching spheres are out of reach of each other; the state does not fit this case");
}

void readPlane(LiggghtsModel& model, LAMMPS_NS::Fix& history, Reader& reader)
{
    const int n = history.size_peratom_cols, spheres = model.instance.lammps().atom->nlocal;
    for (int i = 0; i < spheres; ++i)
        std::fill_n(history.array_atom[i], n, 0.0);
    for (long c = reader.takeCount(); c > 0; --c)
    {
        const double* entry = reader.take(static_cast<size_t>(1 + n));
        std::copy_n(entry + 1, n, history.array_atom[sphereOf(model, entry[0])]);
    }
}

void readMesh(LiggghtsModel& model, FixContactHistoryMesh& history, Reader& reader)
{
    const int n = history.get_dnum(), spheres = model.instance.lammps().atom->nlocal;
    for (int i = 0; i < spheres; ++i)
    {
        const int slots = history.nneighs(i);
        MeshHistoryAccess::count(history, i) = 0;
        std::fill_n(MeshHistoryAccess::triangles(history, i), slots, -1);
        std::fill_n(MeshHistoryAccess::springs(history, i), slots * n, 0.0);
    }
    for (long c = reader.takeCount(); c > 0; --c)
    {
        const double* entry = reader.take(static_cast<size_t>(2 + n));
        const int i = sphereOf(model, entry[0]);
        const int slot = MeshHistoryAccess::count(history, i)++;
        if (slot >= history.nneighs(i))
            throw DemError("DEM state: a sphere touches more triangles than are near it; the state does not fit this case");
        MeshHistoryAccess::triangles(history, i)[slot] = static_cast<int>(entry[1]);
        std::copy_n(entry + 2, n, MeshHistoryAccess::springs(history, i) + slot * n);
    }
}

} // namespace

void forgetWallContacts(LiggghtsModel& model, int sphere)
{
    for (const WallHandle& wall : model.walls)
        if (!wall.mesh)
            std::fill_n(wall.history->array_atom[sphere], wall.history->size_peratom_cols, 0.0);
    for (const MeshGroup& group : model.meshes)
    {
        FixContactHistoryMesh& history = *group.mesh->contactHistory();
        const int slots = history.nneighs(sphere);
        MeshHistoryAccess::count(history, sphere) = 0;
        std::fill_n(MeshHistoryAccess::triangles(history, sphere), slots, -1);
        std::fill_n(MeshHistoryAccess::springs(history, sphere), slots * history.get_dnum(), 0.0);
    }
}

void forEachPairContact(const LiggghtsModel& model, const std::function<void(int, int, const double*, int)>& visit)
{
    auto& pair = static_cast<LAMMPS_NS::PairGran&>(*model.instance.lammps().force->pair);
    const int n = pair.dnum();
    const LAMMPS_NS::NeighList& list = *pair.list;
    const LAMMPS_NS::NeighList& history = *list.listgranhistory;
    for (int ii = 0; ii < list.inum; ++ii)
    {
        const int i = list.ilist[ii];
        for (int jj = 0; jj < list.numneigh[i]; ++jj)
            if (history.firstneigh[i][jj])
                visit(i, list.firstneigh[i][jj] & NEIGHMASK, history.firstdouble[i] + n * jj, n);
    }
}

void shrinkContactPages(LiggghtsModel& model)
{
    const int longest = model.instance.lammps().neighbor->oneatom;
    for (const MeshGroup& group : model.meshes)
        MeshHistoryAccess::keptPage(*group.mesh->contactHistory()).init(longest, longest);
}

std::array<Vec3, 3> cornersOf(LAMMPS_NS::FixMeshSurface& mesh, int triangle)
{
    std::array<Vec3, 3> corners;
    for (int k = 0; k < 3; ++k)
        mesh.triMesh()->node_slow(triangle, k, corners[static_cast<size_t>(k)].data());
    return corners;
}

bool touchesMesh(LAMMPS_NS::FixMeshSurface& mesh, int sphere)
{
    return MeshHistoryAccess::count(*mesh.contactHistory(), sphere) > 0;
}

bool touchesTriangle(LAMMPS_NS::FixMeshSurface& mesh, int sphere, int triangle)
{
    if (!touchesMesh(mesh, sphere))
        return false;
    const int* touched = MeshHistoryAccess::triangles(*mesh.contactHistory(), sphere);
    const int id = mesh.triMesh()->id(triangle), slots = mesh.contactHistory()->nneighs(sphere);
    return std::find(touched, touched + slots, id) != touched + slots;
}

void renameTriangle(LAMMPS_NS::FixMeshSurface& mesh, int sphere, int from, int to)
{
    int* const touched = MeshHistoryAccess::triangles(*mesh.contactHistory(), sphere);
    std::replace(touched, touched + mesh.contactHistory()->nneighs(sphere), mesh.triMesh()->id(from), mesh.triMesh()->id(to));
}

void findMeshTouches(const LiggghtsModel& model, int sphere, std::vector<MeshTouch>& touches)
{
    touches.clear();
    const LAMMPS_NS::Atom& atoms = *model.instance.lammps().atom;
    const Vec3 centre(atoms.x[sphere][0], atoms.x[sphere][1], atoms.x[sphere][2]);
    for (size_t g = 0; g < model.meshes.size(); ++g)
    {
        FixContactHistoryMesh& history = *model.meshes[g].mesh->contactHistory();
        if (MeshHistoryAccess::count(history, sphere) == 0)
            continue;
        LAMMPS_NS::TriMesh& mesh = *model.meshes[g].mesh->triMesh();
        const int* triangles = MeshHistoryAccess::triangles(history, sphere);
        for (int slot = 0; slot < history.nneighs(sphere); ++slot)
        {
            const int t = triangles[slot] >= 0 ? mesh.map(triangles[slot], 0) : -1;
            if (t < 0)
                continue;
            const std::array<Vec3, 3> corners = cornersOf(*model.meshes[g].mesh, t);
            const Vec3 point = closestPointOfTriangle(centre, corners[0], corners[1], corners[2]);
            const double overlap = atoms.radius[sphere] - (point - centre).norm();
            if (overlap > 0)
                touches.push_back({g, point, overlap});
        }
    }
}

void appendHistories(const LiggghtsModel& model, std::vector<double>& data)
{
    appendPairs(model, data);
    for (const WallHandle& wall : model.walls)
        if (!wall.mesh)
            appendPlane(model, *wall.history, data);
    for (const MeshGroup& group : model.meshes)
        appendMesh(model, *group.mesh->contactHistory(), data);
}

size_t readHistories(LiggghtsModel& model, const std::vector<double>& data, size_t position)
{
    Reader reader(data, position);
    readPairs(model, reader);
    for (const WallHandle& wall : model.walls)
        if (!wall.mesh)
            readPlane(model, *wall.history, reader);
    for (const MeshGroup& group : model.meshes)
        readMesh(model, *group.mesh->contactHistory(), reader);
    return reader.position();
}

size_t renumberHistories(const LiggghtsModel& model, const std::vector<double>& data, size_t position, const std::vector<int>& tags, std::vector<double>& renumbered)
{
    Reader reader(data, position);
    const auto passTable = [&](int nTags, int length)
    {
        const long count = reader.takeCount();
        renumbered.push_back(static_cast<double>(count));
        for (long c = 0; c < count; ++c)
        {
            const double* entry = reader.take(static_cast<size_t>(length));
            for (int k = 0; k < nTags; ++k)
            {
                const long tag = std::lround(entry[k]);
                if (tag < 0 || tag >= static_cast<long>(tags.size()))
                    throw DemError("DEM state: it names a sphere this case does not have");
                renumbered.push_back(tags[static_cast<size_t>(tag)]);
            }
            renumbered.insert(renumbered.end(), entry + nTags, entry + length);
        }
    };
    passTable(2, 2 + static_cast<LAMMPS_NS::PairGran&>(*model.instance.lammps().force->pair).dnum());
    for (const WallHandle& wall : model.walls)
        if (!wall.mesh)
            passTable(1, 1 + wall.history->size_peratom_cols);
    for (const MeshGroup& group : model.meshes)
        passTable(1, 2 + group.mesh->contactHistory()->get_dnum());
    return reader.position();
}

} // namespace flotsam
