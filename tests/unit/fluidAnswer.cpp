// SPDX-License-Identifier: GPL-3.0-or-later
/// What the fluid answers to contact loads on light bodies: how it is measured, and what it makes of the iteration of fluid and engine.
#include "demCoupling/coupling/contactIteration.hpp"
#include "demCoupling/coupling/fluidProbes.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

constexpr double density = 25, radius = 0.05;  // [kg/m^3], of inertia [m]

BodyDefinition lightBody()
{
    BodyDefinition body;
    body.volume = 1e-3;
    body.mass = density*body.volume;
    body.principalInertia = Vec3::Constant(body.mass*radius*radius);
    return body;
}

/// Share of a body with 50 times its mass of water across, none along, and an offset that turns it.
LoadShare share(const BodyDefinition& body)
{
    LoadShare mass = LoadShare::Identity()*body.mass, added = LoadShare::Zero();
    mass.bottomRightCorner<3, 3>() = Eigen::Matrix3d(body.principalInertia.asDiagonal());
    Vector6 pull;
    pull << 0, 1, 0, 0, 0, 0.5*radius;
    added = 50*body.mass*pull*pull.transpose();
    return mass*(mass + added).inverse();
}

double largest(const LoadShare& m) { return m.cwiseAbs().maxCoeff(); }

} // namespace

TEST_CASE("probes measure what the body keeps of a load, once a step, and leave the guess as it was")
{
    const BodyDefinition body = lightBody();
    FluidAnswer answer({body}, {});
    FluidProbes probes({body});
    probes.begin();
    const std::vector<Load> guess{{Vec3(3, 0, 0), Vec3::Zero()}}, found{{Vec3(0, 40, 0), Vec3(0, 0, 0.1)}};
    const LoadShare p = share(body);
    const auto fluid = [&](const std::vector<Load>& contact) { return std::vector<Load>{asLoad((p - LoadShare::Identity())*asVector(contact[0]) + Vector6::Ones())}; };
    REQUIRE(probes.choose({0}, {guess, fluid(guess), found}, answer));
    CHECK(probes.count() == 6);
    for (int k = 0; k < probes.count(); ++k) probes.take(k, fluid(probes.guess(k)));
    probes.finish({BodyState()}, answer);
    CHECK(answer.isKnown(0));
    CHECK(largest(answer.shares()[0] - p) < 1e-12);
    CHECK(probes.guessBefore()[0].force == guess[0].force);
    CHECK_FALSE(probes.choose({0}, {guess, fluid(guess), found}, answer));
    probes.begin();
    CHECK(probes.choose({0}, {guess, fluid(guess), found}, answer));
}

TEST_CASE("in 2D a body is asked for three components, across any axis")
{
    BodyDefinition body = lightBody();
    body.isPlanar = true;
    CHECK(FluidAnswer({body}, {}).components(0) == std::vector<int>{0, 1, 5});
    body.planeAxis = 1;
    CHECK(FluidAnswer({body}, {}).components(0) == std::vector<int>{0, 2, 4});
}

TEST_CASE("what is kept is symmetric as a mobility and takes energy, whatever errors the solves leave")
{
    const BodyDefinition body = lightBody();
    FluidAnswer answer({body}, {});
    LoadShare measured = share(body);
    measured(0, 0) = 1.02;      // more than a body without fluid
    measured(0, 1) += 0.02;     // and no (1, 0)
    measured(2, 2) = -0.01;
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()));
    answer.set(0, measured, turned);
    LoadShare mobility = answer.shares()[0];
    mobility.topRows<3>() /= body.mass;
    mobility.bottomRows<3>() /= body.mass*radius*radius;
    CHECK(largest(mobility - mobility.transpose()) < 1e-12*largest(mobility));
    const Eigen::SelfAdjointEigenSolver<LoadShare> eigen(mobility);
    CHECK(eigen.eigenvalues()[0] > 0);
    CHECK(mobility(0, 0) < 1/body.mass*(1 + 1e-12));
}

// J = G(J): the engine sticks to what it touches; the fluid keeps 1/51 of a load across
TEST_CASE("with the fluid's own answer the engine finds the contact in one repeat, with a wrong one it moves away")
{
    const BodyDefinition body = lightBody();
    const LoadShare p = share(body);
    Vector6 wanted, outer;
    wanted << 1, -2, 0.5, 0.01, 0.02, -0.03;    // load beside which the body stays where it is
    outer << 5, 4, 3, 0.2, 0.1, 0.3;
    const auto errorAfter = [&](const LoadShare& known, int repeats)
    {
        Vector6 contact = Vector6::Zero();
        for (int k = 0; k < repeats; ++k)
        {
            const Vector6 fluid = outer + (p - LoadShare::Identity())*contact;
            // the engine's load, fluid + contact + known (found - contact), is the wanted one
            contact += known.inverse()*(wanted - fluid - contact);
        }
        return (outer + p*contact - wanted).norm();
    };
    CHECK(errorAfter(p, 1) < 1e-12);
    CHECK(errorAfter(LoadShare::Identity(), 20) > 0.1);      // 1 - 1/51 a time
    const LoadShare factor = LoadShare::Identity()/32;      // one number for all directions: right across, 31 times too small along
    CHECK(errorAfter(factor, 4) > 1e3);
}

TEST_CASE("loads of the engine: beside the contact that the fluid was solved with the body has the fluid's load and that contact")
{
    const BodyDefinition body = lightBody();
    FluidAnswer answer({body}, {});
    const std::vector<Load> fluid{{Vec3(1, 2, 3), Vec3(4, 5, 6)}}, contact{{Vec3(-3, 7, 1), Vec3(0.1, 0.2, 0.3)}};
    std::vector<Load> loads;
    answer.findEngineLoads(fluid, contact, loads);
    CHECK(loads[0].force == fluid[0].force); // not asked: to the last bit
    answer.set(0, share(body), Eigen::Quaterniond::Identity());
    answer.findEngineLoads(fluid, contact, loads);
    const Vector6 given = asVector(loads[0]), total = given + answer.shares()[0]*asVector(contact[0]);
    CHECK((total - asVector(fluid[0]) - asVector(contact[0])).norm() < 1e-12);
    answer.drop(0);
    CHECK_FALSE(answer.isKnown(0));
}

TEST_CASE("without gravity a contact that was expected and is not there is not one that holds")
{
    CouplingControls controls;
    controls.gravity = 0;
    const BodyDefinition body = lightBody();
    FluidAnswer answer({body}, controls);
    ContactIteration iteration({body}, controls);
    iteration.begin(0.01);
    iteration.setGuess({{Vec3(0, 10, 0), Vec3::Zero()}});
    CHECK_FALSE(iteration.take({Load()}, answer));
    CHECK(iteration.mismatch() == 1);
    CHECK(iteration.take({Load()}, answer));
    CHECK(iteration.mismatch() == 0);
}

TEST_CASE("a repeat is slow that leaves more than half of the difference of the one before, and only within a step")
{
    const BodyDefinition body = lightBody();
    FluidAnswer answer({body}, {});
    answer.set(0, share(body), Eigen::Quaterniond::Identity());
    ContactIteration iteration({body}, {});
    const auto found = [&iteration](double more) { return std::vector<Load>{{iteration.guess()[0].force + Vec3(more, 0, 0), Vec3::Zero()}}; };
    iteration.begin(0.01);
    CHECK_FALSE(iteration.isSlow(0, found(10), answer));
    REQUIRE_FALSE(iteration.take(found(10), answer));
    CHECK_FALSE(iteration.isSlow(0, found(4.9), answer));
    CHECK(iteration.isSlow(0, found(5.1), answer));
    iteration.begin(0.01);
    CHECK_FALSE(iteration.isSlow(0, found(5.1), answer));
}
