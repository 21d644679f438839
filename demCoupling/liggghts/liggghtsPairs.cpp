// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/liggghtsPairs.hpp"

#include "demCoupling/liggghts/liggghtsFacets.hpp"
#include "demCoupling/liggghts/liggghtsHistory.hpp"
#include "geometry/closestPoint.hpp"

#include "atom.h"
#include "fix.h"
#include "fix_multisphere.h"
#include "lammps.h"
#include "update.h"

#include <algorithm>
#include <iterator>

namespace flotsam
{

namespace
{

Vec3 asVec(const double* v) { return Vec3(v[0], v[1], v[2]); }

/// Force on the first sphere: LIGGGHTS' law, with the spring as friction has left it.
Vec3 pairForce(const ContactTable& table, const LAMMPS_NS::Atom& atoms, int i, int j, const Vec3& normal, double overlap, const double* spring)
{
    const size_t entry = table.entryOf(atoms.type[i], atoms.type[j]);
    // rotation moves the contact point along the surfaces only
    const double normalSpeed = (asVec(atoms.v[i]) - asVec(atoms.v[j])).dot(normal);
    const double normalForce = table.stiffness[entry] * overlap - table.dampingOf(atoms.type[i], atoms.type[j]) * normalSpeed;
    return std::max(0.0, normalForce) * normal - table.stiffness[entry] * asVec(spring);
}

} // namespace

void PairTally::Sum::add(const Vec3& f, const Vec3& point, double depth)
{
    force += f;
    weightedPoint += f.norm() * point;
    weight += f.norm();
    overlap = std::max(overlap, depth);
    ++spheres;
}

void PairTally::Sum::add(double times, const Sum& other)
{
    force += times * other.force;
    weightedPoint += times * other.weightedPoint;
    weight += times * other.weight;
    overlap = std::max(overlap, other.overlap);
    spheres = std::max(spheres, other.spheres);
}

bool PairTally::isDue() const
{
    const LAMMPS_NS::Update& update = *model_.instance.lammps().update;
    return isOn_ || update.ntimestep == update.laststep;
}

int PairTally::bodyOf(int sphere) const { return model_.multisphere->belongs_to(sphere) - 1; }

void PairTally::readPairs()
{
    now_.clear();
    forEachPairContact(model_, [this](int i, int j, const double* spring, int) { addPair(i, j, spring); });
}

void PairTally::addPair(int i, int j, const double* spring)
{
    const LAMMPS_NS::Atom& atoms = *model_.instance.lammps().atom;
    const Vec3 apart = asVec(atoms.x[i]) - asVec(atoms.x[j]);
    const double distance = apart.norm(), overlap = atoms.radius[i] + atoms.radius[j] - distance;
    if (!(overlap > 0)) // its flag is cleared later in the sub-step
        return;
    const Vec3 normal = apart / distance, point = asVec(atoms.x[j]) + (atoms.radius[j] - 0.5 * overlap) * normal;
    const Vec3 force = pairForce(model_.contacts, atoms, i, j, normal, overlap, spring);
    const int a = bodyOf(i), b = bodyOf(j);
    now_[{std::min(a, b), std::max(a, b)}].add(a < b ? force : Vec3(-force), point, overlap);
}

void PairTally::readWalls(const std::vector<std::vector<int>>& nearPlane)
{
    for (size_t w = 0; w < nearPlane.size(); ++w)
        readPlane(w, nearPlane[w]);
    if (!model_.meshForce)
        return;
    for (const int i : model_.near->atMeshes())
        readMeshes(i);
}

void PairTally::readPlane(size_t index, const std::vector<int>& spheres)
{
    const LAMMPS_NS::Atom& atoms = *model_.instance.lammps().atom;
    const WallHandle& wall = model_.walls[index];
    for (const int i : spheres)
    {
        const Vec3 force = asVec(wall.force->array_atom[i]);
        if (force.isZero(0))
            continue;
        Vec3 point = asVec(atoms.x[i]);
        const double overlap = atoms.radius[i] - std::abs(point[wall.axis] - wall.coordinate);
        point[wall.axis] = wall.coordinate;
        now_[{bodyOf(i), -1 - static_cast<int>(index)}].add(force, point, overlap);
    }
}

/// LIGGGHTS keeps one force of all meshes on a sphere: exact for the body; where the sphere touches several walls they get it shared out by overlap.
void PairTally::readMeshes(int sphere)
{
    const Vec3 force = asVec(model_.meshForce->array_atom[sphere]);
    if (force.isZero(0))
        return;
    findTouches(sphere);
    double total = 0;
    for (const MeshTouch& touch : touches_)
        total += touch.overlap;
    for (const MeshTouch& touch : touches_)
    {
        const MeshGroup& group = model_.meshes[touch.mesh];
        const int wall = group.walls.size() > 1 ? group.wallAt(touch.point) : group.walls.front();
        now_[{bodyOf(sphere), -1 - wall}].add(force * (touch.overlap / total), touch.point, touch.overlap);
    }
}

/// The nearest triangle where LIGGGHTS remembers none: no force is lost.
void PairTally::findTouches(int sphere)
{
    findMeshTouches(model_, sphere, touches_);
    if (!touches_.empty())
        return;
    const Vec3 centre = asVec(model_.instance.lammps().atom->x[sphere]);
    MeshTouch nearest{0, centre, 1};
    double least = 1e300;
    for (const SphereTriangles& near : model_.near->atTriangles())
        for (const int t : near.triangles)
        {
            if (near.sphere != sphere)
                continue;
            const std::array<Vec3, 3> corners = cornersOf(*model_.meshes[near.mesh].mesh, t);
            const Vec3 point = closestPointOfTriangle(centre, corners[0], corners[1], corners[2]);
            if ((point - centre).norm() >= least)
                continue;
            least = (point - centre).norm();
            nearest = {near.mesh, point, 1e-30};
        }
    touches_.push_back(nearest);
}

void PairTally::add(double weight)
{
    if (!isOn_)
        return;
    for (const auto& [key, sum] : now_)
        sums_[key].add(weight, sum);
}

void PairTally::finish(double duration)
{
    means_.clear();
    for (const auto& [key, sum] : sums_)
        if (sum.weight > 0)
            means_.push_back({key.first, key.second, sum.weightedPoint / sum.weight, sum.force / duration, sum.overlap, sum.spheres});
}

void PairTally::leaveWalls(const std::vector<char>& isGone, std::vector<Load>& wallsNow)
{
    std::vector<char> isLeft(wallsNow.size(), 0), isTouched(wallsNow.size(), 0);
    for (auto at = now_.begin(); at != now_.end();)
    {
        const auto& [key, sum] = *at;
        const size_t wall = static_cast<size_t>(-1 - key.second);
        const bool isLeaving = key.second < 0 && isGone[static_cast<size_t>(key.first)];
        if (key.second < 0)
            (isLeaving ? isLeft : isTouched)[wall] = 1;
        if (isLeaving && sum.weight > 0)
        {
            wallsNow[wall].force += sum.force;
            wallsNow[wall].moment += (sum.weightedPoint / sum.weight).cross(sum.force);
        }
        at = isLeaving ? now_.erase(at) : std::next(at);
    }
    for (size_t w = 0; w < wallsNow.size(); ++w)
        if (isLeft[w] && !isTouched[w])
            wallsNow[w] = {}; // without round-off
}

void PairTally::append(std::vector<double>& data) const
{
    data.push_back(static_cast<double>(now_.size()));
    for (const auto& [key, sum] : now_)
    {
        data.insert(data.end(), {static_cast<double>(key.first), static_cast<double>(key.second)});
        data.insert(data.end(), sum.force.data(), sum.force.data() + 3);
        data.insert(data.end(), sum.weightedPoint.data(), sum.weightedPoint.data() + 3);
        data.insert(data.end(), {sum.weight, sum.overlap, static_cast<double>(sum.spheres)});
    }
}

size_t PairTally::countAt(const std::vector<double>& data, size_t position)
{
    const size_t count = position < data.size() ? static_cast<size_t>(data[position]) : 0;
    if (position >= data.size() || data.size() - position - 1 < count * entryLength)
        throw DemError("DEM state: the contacts end early");
    return count;
}

size_t PairTally::renumber(const std::vector<double>& data, size_t position, const std::vector<int>& bodies, std::vector<double>& renumbered)
{
    const size_t count = countAt(data, position), begin = renumbered.size();
    const auto first = data.begin() + static_cast<std::ptrdiff_t>(position);
    renumbered.insert(renumbered.end(), first, first + static_cast<std::ptrdiff_t>(1 + count * entryLength));
    for (size_t k = 0; k < count; ++k)
        for (double* number : {&renumbered[begin + 1 + k * entryLength], &renumbered[begin + 2 + k * entryLength]})
            if (*number >= 0) // not a wall
                *number = bodies.at(static_cast<size_t>(*number));
    return position + 1 + count * entryLength;
}

size_t PairTally::read(const std::vector<double>& data, size_t position)
{
    now_.clear();
    const size_t count = countAt(data, position);
    for (const double* v = data.data() + position + 1; now_.size() < count; v += entryLength)
        now_[{static_cast<int>(v[0]), static_cast<int>(v[1])}] = {Vec3(v[2], v[3], v[4]), Vec3(v[5], v[6], v[7]), v[8], v[9], static_cast<int>(v[10])};
    return position + 1 + count * entryLength;
}

} // namespace flotsam
