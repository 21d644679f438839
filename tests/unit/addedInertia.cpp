// SPDX-License-Identifier: GPL-3.0-or-later
/// Factors of inertia from what the fluid answers to changes of contact loads: of force and moment apart, compared by what they do in the engine.
#include "demCoupling/coupling/addedInertia.hpp"

#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

constexpr double density = 25, radius = 0.05;  // [kg/m^3], of inertia [m]
constexpr double r = 31.0/32;                   // contraction: fluid of 31 times the body's inertia moves with it

BodyDefinition lightBody()
{
    BodyDefinition body;
    body.volume = 1e-3;
    body.mass = density*body.volume;
    body.principalInertia = Vec3::Constant(body.mass*radius*radius);
    return body;
}

std::vector<Load> one(double force, double moment) { return {{Vec3(0, force, 0), Vec3(0, 0, moment)}}; }

} // namespace

TEST_CASE("a force that the fluid answers raises the factor of mass, not that of turning")
{
    AddedInertia inertia({lightBody()}, {});
    CHECK(inertia.raise(one(10, 0), one(-10*r, 0)));
    CHECK(inertia.factors()[0].mass == 32);
    CHECK(inertia.factors()[0].turn == 1);
}

TEST_CASE("once the force is calmed, a moment of a tenth of it counts: it turns the engine's body three times as much")
{
    AddedInertia inertia({lightBody()}, {});
    const double force = 10, moment = 0.1*force*radius;
    inertia.raise(one(force, moment), one(-force*r, -moment*r));
    CHECK(inertia.factors()[0].turn == 1);  // beside a force of ten times its size what the fluid answers to it cannot be told
    CHECK(inertia.raise(one(force, moment), one(-force*r, -moment*r)));
    CHECK(inertia.factors()[0].mass == 32);
    CHECK(inertia.factors()[0].turn == 32);
}

TEST_CASE("a moment that turns the engine's body less than half of what its force moves it does not count")
{
    AddedInertia inertia({lightBody()}, {});
    const double force = 10, moment = 0.4*force*radius/32;
    inertia.raise(one(force, 0), one(-force*r, 0));
    CHECK_FALSE(inertia.raise(one(force, moment), one(-force*r, -moment*r)));
    CHECK(inertia.factors()[0].turn == 1);
}

TEST_CASE("nothing is raised by changes below the tolerance, or by a fluid that does not resist")
{
    CouplingControls controls;
    AddedInertia inertia({lightBody()}, controls);
    const double small = 0.9*controls.tolerance*controls.gravity*density*1e-3;
    CHECK_FALSE(inertia.raise(one(small, 0), one(-small*r, 0)));
    CHECK_FALSE(inertia.raise(one(10, 1), one(10, 1)));
    CHECK_FALSE(inertia.raise(one(10, 1), one(-5, -0.5)));  // contraction 1/2: repeats converge by themselves
}

TEST_CASE("no more added mass than twice the liquid that the body displaces")
{
    AddedInertia inertia({lightBody()}, {});
    inertia.raise(one(10, 0), one(-9.9999, 0));
    CHECK(inertia.factors()[0].mass == 64); // below 1 + 2*1000/25
}
