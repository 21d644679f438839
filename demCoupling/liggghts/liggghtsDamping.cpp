// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/liggghtsDamping.hpp"

#include <mpi.h>

#include "atom.h"
#include "fix_multisphere.h"
#include "force.h"
#include "lammps.h"
#include "neigh_list.h"
#include "pair_gran.h"

namespace flotsam
{

namespace
{

Vec3 asVec(const double* v) { return Vec3(v[0], v[1], v[2]); }

/// From above, at most an eighth too large (six equal ones); exact for a single contact.
double largestEigenvalue(const Eigen::Matrix<double, 6, 6>& a)
{
    const Eigen::Matrix<double, 6, 6> second = a * a, fourth = second * second, eighth = fourth * fourth;
    return std::sqrt(std::sqrt(std::sqrt(eighth.norm())));
}

} // namespace

SphereDamping::SphereDamping(LiggghtsModel& model, const DemSetup& setup)
    : model_(model), facets_(model), margins_(setup.bodies.size()), partners_(setup.bodies.size())
{
}

void SphereDamping::startSteps(double step)
{
    step_ = step;
    stepsToLook_ = 0;
}

void SphereDamping::beforeForces(const std::vector<std::vector<int>>& nearPlane)
{
    if (step_ == 0 || stepsToLook_-- > 0 || model_.contacts.levels == 1)
        return;
    stepsToLook_ = stepsBetweenLooks - 1;
    readBodies();
    model_.near->cover(margins_);
    addPairs();
    for (size_t w = 0; w < model_.walls.size(); ++w)
        if (!model_.walls[w].mesh)
            addPlane(w, nearPlane[w]);
    addMeshes();
    setLevels();
}

void SphereDamping::readBodies()
{
    near_.clear();
    for (size_t i = 0; i < partners_.size(); ++i)
    {
        partners_[i].clear();
        margins_[i] = model_.near->speedOf(i) * stepsBetweenLooks * step_;
    }
}

int SphereDamping::partnerOf(int body, int other)
{
    std::vector<Partner>& partners = partners_[static_cast<size_t>(body)];
    for (size_t p = 0; p < partners.size(); ++p)
        if (partners[p].other == other)
            return static_cast<int>(p);
    partners.push_back({other, Rates::Zero(), 0});
    return static_cast<int>(partners.size()) - 1;
}

int SphereDamping::bodyOf(int sphere) const { return model_.multisphere->belongs_to(sphere) - 1; }

double SphereDamping::damping(int sphere, int otherClass) const
{
    const int own = model_.classOfSphere[static_cast<size_t>(sphere)];
    return model_.contacts.damping[static_cast<size_t>(own * model_.contacts.size() + otherClass)];
}

/// M^-1/2 J^T of a contact: the square of its norm is what a unit impulse there changes of the normal velocity [1/kg].
SphereDamping::Row SphereDamping::inverseRoot(int body, const Vec3& arm, const Vec3& normal) const
{
    const BodyArrays& b = model_.bodies;
    const Vec3 turn = arm.cross(normal);
    Row row;
    row.head<3>() = normal / std::sqrt(b.mass[body]);
    const double* const axes[3] = {b.ex[body], b.ey[body], b.ez[body]};
    for (int k = 0; k < 3; ++k)
        row[3 + k] = turn.dot(asVec(axes[k])) / std::sqrt(b.inertia[body][k]);
    for (const BodyShare& shared : model_.shares)
        if (shared.body == body)
            row *= std::sqrt(sharedMobility(body, shared.share, normal, turn) / row.squaredNorm());
    return row;
}

/// Of a body with the fluid's answer: what a unit impulse along the normal, of this moment, changes of the velocity there [1/kg].
double SphereDamping::sharedMobility(int body, const LoadShare& share, const Vec3& normal, const Vec3& turn) const
{
    const BodyArrays& b = model_.bodies;
    Vector6 impulse, velocity;
    impulse << normal, turn;
    velocity << normal / b.mass[body], Vec3::Zero();
    const double* const axes[3] = {b.ex[body], b.ey[body], b.ez[body]};
    for (int k = 0; k < 3; ++k)
        velocity.tail<3>() += asVec(axes[k]) * (turn.dot(asVec(axes[k])) / b.inertia[body][k]);
    return velocity.dot(share * impulse);
}

/// Relative velocity of two bodies: (a - b)^2 <= (1 + s) a^2 + (1 + 1/s) b^2 splits their common matrix into one of each; with s the ratio of
/// their mobilities the bound is exact for a single contact.
void SphereDamping::addPairs()
{
    const LAMMPS_NS::Atom& atoms = *model_.instance.lammps().atom;
    model_.near->forEachCandidate([&](int i, int other)
    {
        const int j = other & NEIGHMASK, a = bodyOf(i), b = bodyOf(j);
        const Vec3 apart = asVec(atoms.x[i]) - asVec(atoms.x[j]);
        const double reach = atoms.radius[i] + atoms.radius[j] + margins_[static_cast<size_t>(a)] + margins_[static_cast<size_t>(b)];
        if (apart.squaredNorm() > reach * reach)
            return;
        const Vec3 normal = apart.normalized(), point = asVec(atoms.x[j]) + atoms.radius[j] * normal;
        const auto rowA = inverseRoot(a, point - asVec(model_.bodies.xcm[a]), normal);
        const auto rowB = inverseRoot(b, point - asVec(model_.bodies.xcm[b]), normal);
        const double c = damping(i, model_.classOfSphere[static_cast<size_t>(j)]);
        const double ratio = rowB.squaredNorm() / rowA.squaredNorm();
        near_.push_back({i, j, {a, partnerOf(a, b), std::sqrt(c * (1 + ratio)) * rowA}, {b, partnerOf(b, a), std::sqrt(c * (1 + 1 / ratio)) * rowB}});
    });
}

void SphereDamping::addWallContact(int sphere, int wallClass, int wall, const Vec3& point)
{
    const LAMMPS_NS::Atom& atoms = *model_.instance.lammps().atom;
    const int body = bodyOf(sphere);
    const Vec3 apart = asVec(atoms.x[sphere]) - point;
    if (apart.norm() > atoms.radius[sphere] + margins_[static_cast<size_t>(body)])
        return;
    const auto row = inverseRoot(body, point - asVec(model_.bodies.xcm[body]), apart.normalized());
    near_.push_back({sphere, -1, {body, partnerOf(body, -1 - wall), std::sqrt(damping(sphere, wallClass)) * row}, {-1, -1, Row::Zero()}});
}

void SphereDamping::addPlane(size_t wall, const std::vector<int>& spheres)
{
    const LAMMPS_NS::Atom& atoms = *model_.instance.lammps().atom;
    for (const int i : spheres)
    {
        Vec3 point = asVec(atoms.x[i]);
        point[model_.walls[wall].axis] = model_.walls[wall].coordinate;
        addWallContact(i, model_.contacts.classOfWall[wall], static_cast<int>(wall), point);
    }
}

void SphereDamping::addMeshes()
{
    for (const SphereTriangles& near : model_.near->atTriangles())
    {
        const int wallClass = model_.contacts.classOfWall[static_cast<size_t>(model_.meshes[near.mesh].walls.front())];
        for (const FacetTouch& touch : facets_.places(near, margins_[static_cast<size_t>(bodyOf(near.sphere))]))
            addWallContact(near.sphere, wallClass, static_cast<int>(model_.walls.size() + near.mesh), touch.point);
    }
}

SphereDamping::Partner& SphereDamping::partner(const Side& side)
{
    return partners_[static_cast<size_t>(side.body)][static_cast<size_t>(side.partner)];
}

/// The traces bound the eigenvalues from above: where they add up to no more than 1, nothing is too large.
void SphereDamping::addRates()
{
    std::vector<double>& traces = traces_;
    traces.assign(partners_.size(), 0);
    for (const Near& n : near_)
        for (const Side* side : {&n.side, &n.otherSide})
            if (side->body >= 0)
                traces[static_cast<size_t>(side->body)] += side->row.squaredNorm() * step_;
    for (const Near& n : near_)
        for (const Side* side : {&n.side, &n.otherSide})
            if (side->body >= 0 && traces[static_cast<size_t>(side->body)] > 1)
                partner(*side).rates += side->row * side->row.transpose();
}

void SphereDamping::setLevels()
{
    addRates();
    for (std::vector<Partner>& partners : partners_)
    {
        double sum = 0, largest = 0;
        for (Partner& p : partners)
        {
            p.z = p.rates.isZero(0) ? 0 : largestEigenvalue(p.rates) * step_;
            sum += p.z;
            largest = std::max(largest, p.z);
        }
        for (Partner& p : partners)
            p.z *= largest > 0 ? sum / largest : 1;
    }
    levels_.assign(static_cast<size_t>(model_.firstSphere.back()), 0);
    for (const Near& n : near_)
    {
        double z = partner(n.side).z;
        if (n.other >= 0)
            z = std::max(z, partner(n.otherSide).z);
        const int level = std::min(DampingLevel::of(z), model_.contacts.levels - 1);
        for (const int sphere : {n.sphere, n.other})
            if (sphere >= 0)
                levels_[static_cast<size_t>(sphere)] = std::max(levels_[static_cast<size_t>(sphere)], level);
    }
    int* const type = model_.instance.lammps().atom->type;
    for (size_t i = 0; i < levels_.size(); ++i)
        type[i] = model_.contacts.typeOf(model_.classOfSphere[i], levels_[i]);
}

} // namespace flotsam
