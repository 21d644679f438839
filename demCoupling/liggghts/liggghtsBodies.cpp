// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies go in and are read through LIGGGHTS' C++ classes: its own commands place them at random and take mass and
/// inertia from Monte-Carlo points.
#include "demCoupling/liggghts/liggghtsNear.hpp"

#include <mpi.h>

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "fix_multisphere.h"
#include "integrate.h"
#include "lammps.h"
#include "math_extra.h"
#include "modify.h"
#include "neighbor.h"
#include "particleToInsert_multisphere.h"
#include "update.h"

#include <cfenv>
#include <limits>

namespace flotsam
{

namespace
{

/// set_xv() is protected; a derived class may name it.
struct MultisphereAccess : LAMMPS_NS::FixMultisphere
{
    static void placeSpheres(LAMMPS_NS::FixMultisphere& bodies)
    {
        void (LAMMPS_NS::FixMultisphere::*method)() = &MultisphereAccess::set_xv;
        (bodies.*method)();
    }
    /// From the centre of the body to that of each sphere, in the frame of the body [m].
    static double** arms(LAMMPS_NS::FixMultisphere& bodies) { return bodies.*&MultisphereAccess::displace_; }
};

struct BodyMotion { Vec3 centre, velocity, spin; std::array<Vec3, 3> axes; };

BodyMotion motionOf(const BodyArrays& b, int body)
{
    return {Vec3::Map(b.xcm[body]), Vec3::Map(b.vcm[body]), Vec3::Map(b.omega[body]),
            {Vec3::Map(b.ex[body]), Vec3::Map(b.ey[body]), Vec3::Map(b.ez[body])}};
}

/// LIGGGHTS' own clearing of all forces before every sub-step; a derived class may name it.
struct IntegratorAccess : LAMMPS_NS::Integrate
{
    static int& leavesForces(LAMMPS_NS::Integrate& integrator) { return integrator.*&IntegratorAccess::external_force_clear; }
};

void copy(const Vec3& from, double* to)
{
    for (int k = 0; k < 3; ++k)
        to[k] = from[k];
}

void checkDefinition(const BodyDefinition& body)
{
    if (body.spheres.empty())
        throw DemError("body '" + body.name + "' has no DEM spheres");
    if (!(body.mass > 0) || !(body.principalInertia.minCoeff() > 0))
        throw DemError("body '" + body.name + "': mass and principal inertia must be > 0");
    for (const SurfaceSphere& s : spheresAtWalls(body))
        if (!(s.radius > 0) || !s.centre.allFinite())
            throw DemError("body '" + body.name + "': a DEM sphere has radius " + std::to_string(s.radius));
}

int insertBody(LiggghtsModel& model, const BodyDefinition& body, int contactClass)
{
    checkDefinition(body);
    const std::vector<SurfaceSphere> spheres = spheresAtWalls(body);
    const int n = static_cast<int>(spheres.size());
    LAMMPS_NS::ParticleToInsertMultisphere particle(&model.instance.lammps(), n);
    particle.groupbit = 1;
    particle.atom_type = model.contacts.typeOf(contactClass, 0);
    particle.type_ms = 1;
    particle.mass_ins = body.mass;
    // LIGGGHTS' density and volume are informative only; their product must be the mass
    particle.volume_ins = body.volume > 0 ? body.volume : body.mass;
    particle.density_ins = body.mass / particle.volume_ins;
    particle.r_bound_ins = outerRadius(body);
    for (int s = 0; s < n; ++s)
    {
        const SurfaceSphere& sphere = spheres[static_cast<size_t>(s)];
        particle.radius_ins[s] = sphere.radius;
        particle.volumeweight[s] = 1.0 / n;
        copy(sphere.centre, particle.displace[s]);
    }
    copy(body.principalInertia, particle.inertia);
    copy(Vec3::Zero(), particle.xcm_to_xbound);
    copy(Vec3::Zero(), particle.x_bound_ins);
    copy(Vec3::UnitX(), particle.ex_space);
    copy(Vec3::UnitY(), particle.ey_space);
    copy(Vec3::UnitZ(), particle.ez_space);
    double x[3], v[3], omega[3];
    copy(body.pose.position, x);
    copy(body.motion.velocity, v);
    copy(body.motion.angularVelocity, omega);
    const Eigen::Quaterniond q = body.pose.orientation.normalized();
    double quaternion[4] = {q.w(), q.x(), q.y(), q.z()};
    particle.set_x_v_omega(x, v, omega, quaternion);
    return particle.insert();
}

/// The body's spheres come behind those there are, its corners last.
void noteSpheres(LiggghtsModel& model, const BodyDefinition& body, size_t index)
{
    const int first = model.firstSphere.back() + static_cast<int>(body.spheres.size()), last = first + static_cast<int>(body.corners.size());
    model.firstCorner.push_back(first);
    model.firstSphere.push_back(last);
    model.classOfSphere.resize(static_cast<size_t>(first), model.contacts.classOfBody[index]);
    model.classOfSphere.resize(static_cast<size_t>(last), model.contacts.classOfCorners[index]);
    model.isRetreated.resize(static_cast<size_t>(last), 0);
}

/// Modify::setup() calls set_arrays() on every fix that is still "just created", which would wipe the link between
/// spheres and bodies: the bodies would move and their spheres stay.
void markFixesAsUsed(LAMMPS_NS::Modify& modify)
{
    for (int f = 0; f < modify.nfix; ++f)
        if (modify.fix[f]->create_attribute)
        {
            modify.fix[f]->pre_set_arrays();
            modify.fix[f]->just_created = 0;
        }
}

/// After LIGGGHTS' set-up: NearSpheres moves the spheres, clears their forces and asks for new lists.
void leaveSpheresToUs(LiggghtsModel& model)
{
    LAMMPS_NS::LAMMPS& dem = model.instance.lammps();
    IntegratorAccess::leavesForces(*dem.update->integrate) = 1;
    dem.neighbor->delay = std::numeric_limits<int>::max(); // until LIGGGHTS looks by itself how far every sphere has moved
    std::fill_n(dem.atom->f[0], 3 * dem.atom->nlocal, 0.0);
    std::fill_n(dem.atom->torque[0], 3 * dem.atom->nlocal, 0.0);
    shrinkContactPages(model);
}

std::vector<Load> totalForces(const LiggghtsModel& model)
{
    std::vector<Load> forces;
    forces.reserve(static_cast<size_t>(model.bodies.count));
    for (int b = 0; b < model.bodies.count; ++b)
        forces.push_back({Vec3::Map(model.bodies.fcm[b]), Vec3::Map(model.bodies.torque[b])});
    return forces;
}

} // namespace

bool LiggghtsModel::touchesWalls(int sphere) const
{
    const int body = multisphere->belongs_to(sphere) - 1;
    return body < firstMover && !isGone[static_cast<size_t>(body)] && !isRetreated[static_cast<size_t>(sphere)];
}

BodyArrays bodyArrays(const LiggghtsModel& model)
{
    LAMMPS_NS::Multisphere& data = model.multisphere->data();
    const auto vector = [&](const char* name) {
        double** values = data.extract_double_vector(name);
        if (!values)
            throw DemError(std::string("LIGGGHTS has no body property '") + name + "'");
        return values;
    };
    BodyArrays b;
    b.count = data.n_body();
    b.xcm = vector("xcm");
    b.vcm = vector("vcm");
    b.fcm = vector("fcm");
    b.torque = vector("torque");
    b.drag = vector("dragforce_cm");
    b.hdTorque = vector("hdtorque_cm");
    b.angmom = vector("angmom");
    b.omega = vector("omega");
    b.ex = vector("ex_space");
    b.ey = vector("ey_space");
    b.ez = vector("ez_space");
    b.inertia = vector("inertia");
    b.quat = data.prop().getElementProperty<LAMMPS_NS::VectorContainer<double, 4>>("quat")->begin();
    b.mass = data.extract_double_scalar("masstotal");
    return b;
}

void insertBodies(LiggghtsModel& model, const DemSetup& setup)
{
    LAMMPS_NS::LAMMPS& dem = model.instance.lammps();
    markFixesAsUsed(*dem.modify);
    model.firstSphere.assign(1, 0);
    model.parking = setup.box;
    std::vector<char> isAway;
    for (const BodyDefinition& body : setup.bodies)
    {
        isAway.push_back(body.entersAtRelease);
        model.exits.push_back(body.pose);
    }
    const std::vector<BodyDefinition> bodies = placedAtStart(setup);
    model.instance.guarded([&] {
        for (size_t b = 0; b < bodies.size(); ++b)
        {
            insertBody(model, bodies[b], model.contacts.classOfBody[b]);
            noteSpheres(model, setup.bodies[b], b);
        }
        LAMMPS_NS::Atom& atoms = *dem.atom;
        for (size_t i = 0; i < model.classOfSphere.size(); ++i)
            atoms.type[i] = model.contacts.typeOf(model.classOfSphere[i], 0);
        atoms.tag_extend();
        atoms.natoms = atoms.nlocal;
        atoms.nghost = 0;
        atoms.map_init();
        atoms.map_set();
        markGone(model, isAway);
        // places the spheres with a time step of 0 and a flag that LIGGGHTS has not set yet: by chance it divides 0 by 0 there, for a
        // virial nobody reads, and a program that traps floating point exceptions (as OpenFOAM's do) would end
        std::fenv_t environment;
        std::feholdexcept(&environment);
        model.multisphere->add_body_finalize();
        std::fesetenv(&environment);
    });
    model.instance.command("run 0 post no");
    leaveSpheresToUs(model);
    checkBodies(model, setup);
    model.bodies = bodyArrays(model);
    for (int b = 0; b < model.bodies.count; ++b)
        if (model.multisphere->data().tag(b) != b + 1)
            throw DemError("LIGGGHTS has reordered the bodies");
    // the quaternion made from the axes may have the opposite sign or differ in the last bit
    for (size_t b = 0; b < bodies.size(); ++b)
    {
        setPose(model, static_cast<int>(b), bodies[b].pose);
        setMotion(model, static_cast<int>(b), bodies[b].motion);
    }
    placeSpheres(model);
}

void checkBodies(const LiggghtsModel& model, const DemSetup& setup)
{
    LAMMPS_NS::Multisphere& data = model.multisphere->data();
    const int expected = static_cast<int>(setup.bodies.size());
    if (data.n_body() != expected)
    {
        for (int b = 0; b < expected; ++b)
            if (data.map(b + 1) < 0)
                throw DemError("body '" + setup.bodies[static_cast<size_t>(b)].name + "' was lost by LIGGGHTS");
        throw DemError("LIGGGHTS holds " + std::to_string(data.n_body()) + " bodies instead of "
                       + std::to_string(expected));
    }
    const LAMMPS_NS::Atom& atoms = *model.instance.lammps().atom;
    if (atoms.nlocal != model.firstSphere.back())
        throw DemError("LIGGGHTS holds " + std::to_string(atoms.nlocal) + " spheres instead of "
                       + std::to_string(model.firstSphere.back()));
    for (int i = 0; i < atoms.nlocal; ++i)
        if (atoms.tag[i] != i + 1 || model.multisphere->belongs_to(i) <= 0)
            throw DemError("LIGGGHTS has lost the link between spheres and bodies");
}

void setMobility(LiggghtsModel& model, int body, const std::array<bool, 6>& isFree)
{
    bool force[3] = {isFree[0], isFree[1], isFree[2]}, torque[3] = {isFree[3], isFree[4], isFree[5]};
    model.multisphere->data().set_fflag(body, force);
    model.multisphere->data().set_tflag(body, torque);
}

void setPose(LiggghtsModel& model, int body, const Pose& pose)
{
    const BodyArrays& b = model.bodies;
    const Eigen::Quaterniond q = pose.orientation.normalized();
    copy(pose.position, b.xcm[body]);
    b.quat[body][0] = q.w();
    b.quat[body][1] = q.x();
    b.quat[body][2] = q.y();
    b.quat[body][3] = q.z();
    MathExtra::q_to_exyz(b.quat[body], b.ex[body], b.ey[body], b.ez[body]);
}

void setMotion(LiggghtsModel& model, int body, const Motion& motion)
{
    double omega[3];
    copy(motion.velocity, model.bodies.vcm[body]);
    copy(motion.angularVelocity, omega);
    model.multisphere->data().set_angmom_via_omega_body(body, omega); // the integrator owns angmom
}

void placeSpheres(LiggghtsModel& model)
{
    model.near->showAll();
    MultisphereAccess::placeSpheres(*model.multisphere);
}

void placeSpheres(LiggghtsModel& model, const std::vector<int>& spheres)
{
    const LAMMPS_NS::Atom& atoms = *model.instance.lammps().atom;
    double* const* const arms = MultisphereAccess::arms(*model.multisphere);
    int last = 0;
    BodyMotion body = motionOf(model.bodies, last);
    for (const int i : spheres)
    {
        const int b = model.multisphere->belongs_to(i) - 1;
        if (b != last)
            body = motionOf(model.bodies, b);
        last = b;
        const double* const arm = arms[i];
        const Vec3 r = body.axes[0] * arm[0] + body.axes[1] * arm[1] + body.axes[2] * arm[2];
        copy(r + body.centre, atoms.x[i]);
        copy(body.spin.cross(r) + body.velocity, atoms.v[i]);
        copy(body.spin, atoms.omega[i]);
    }
}

void takeForces(LiggghtsModel& model, const std::vector<int>& spheres)
{
    const BodyArrays& b = model.bodies;
    const LAMMPS_NS::Atom& atoms = *model.instance.lammps().atom;
    for (const int i : spheres)
    {
        Vec3::MapType force(atoms.f[i]), moment(atoms.torque[i]);
        if (force.isZero(0))
            continue;
        const int body = model.multisphere->belongs_to(i) - 1;
        const Vec3 arm = Vec3::Map(atoms.x[i]) - Vec3::Map(b.xcm[body]);
        Vec3::Map(b.fcm[body]) += force;
        Vec3::Map(b.torque[body]) += arm.cross(force) + moment;
        force.setZero();
        moment.setZero();
    }
}

void answerContacts(LiggghtsModel& model, const std::vector<Load>& given)
{
    const BodyArrays& b = model.bodies;
    for (const BodyShare& shared : model.shares)
    {
        Vector6 contact;
        contact << Vec3::Map(b.fcm[shared.body]), Vec3::Map(b.torque[shared.body]);
        const Vector6 answer = shared.share * contact - contact;
        const Load& load = given[static_cast<size_t>(shared.body)];
        Vec3::Map(b.drag[shared.body]) = load.force + answer.head<3>();
        Vec3::Map(b.hdTorque[shared.body]) = load.moment + answer.tail<3>();
    }
}

void rebuildNeighbours(LiggghtsModel& model)
{
    // what Verlet::run does when it rebuilds
    LAMMPS_NS::LAMMPS& dem = model.instance.lammps();
    const std::vector<Load> forces = totalForces(model);
    model.instance.guarded([&] {
        ++dem.update->ntimestep; // mesh walls recognise a changed grid of bins by the step number alone
        dem.modify->pre_exchange();
        dem.domain->pbc();
        dem.domain->reset_box();
        dem.comm->setup();
        dem.neighbor->setup_bins();
        dem.comm->exchange();
        dem.comm->borders();
        dem.modify->pre_neighbor();
        dem.neighbor->build();
        dem.modify->pre_force(0); // clears the forces of the bodies
    });
    for (size_t b = 0; b < forces.size(); ++b)
    {
        copy(forces[b].force, model.bodies.fcm[b]);
        copy(forces[b].moment, model.bodies.torque[b]);
    }
}

} // namespace flotsam
