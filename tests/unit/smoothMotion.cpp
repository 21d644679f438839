// SPDX-License-Identifier: GPL-3.0-or-later
/// A body that sticks to a spring in a fluid with added mass, stepped as fluid and engine are: the fluid's load is constant within a step, the spring's
/// motion exact, contact converged. Unit mass and inertia, unit time step. The fluid's share of the body's row (BDF2, Fluid::newLoadShare()) is written out here.
#include "demCoupling/coupling/smoothMotion.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <cstdio>

using namespace flotsam;

namespace
{

constexpr int nSteps = 400;

/// Displacement along x, turning about x.
struct Oscillator
{
    double place = 0, speed = 0;

    BodyState state(bool turns) const
    {
        BodyState s;
        if (turns)
        {
            s.pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(place, Vec3::UnitX()));
            s.motion.angularVelocity = s.angularMomentum = Vec3(speed, 0, 0);
        }
        else
        {
            s.pose.position = Vec3(place, 0, 0);
            s.motion.velocity = Vec3(speed, 0, 0);
        }
        return s;
    }

    /// Exactly over the unit step, with that load: frequency w, damping ratio beta < 1.
    Oscillator after(double load, double w, double beta) const
    {
        const std::complex<double> root(-beta*w, w*std::sqrt(1 - beta*beta));
        const double rest = load/(w*w), amplitude = place - rest;
        const std::complex<double> c(amplitude, (root.real()*amplitude - speed)/root.imag());
        const std::complex<double> z = c*std::exp(root);
        return {rest + z.real(), (root*z).real()};
    }
};

/// Largest displacement in the last fifth over that in the first fifth of the steps; isSmooth: the fluid gets SmoothMotion's velocity.
double growth(double addedMass, double w, double beta, bool isSmooth, bool turns)
{
    BodyDefinition body;
    body.mass = 1;
    body.principalInertia = Vec3::Ones();
    Oscillator now{1e-3, 0};
    SmoothMotion smooth({body}, {now.state(turns)});
    double older = 0, old = 0, meanLoad = 0, first = 0, last = 0; // velocities in the fluid; of the step before
    for (int step = 0; step < nSteps; ++step)
    {
        auto velocity = [&](double load)    // in the fluid, at the step's end
        {
            const Oscillator end = now.after(load, w, beta);
            const double contact = end.speed - now.speed - load;
            Load mean;
            (turns ? mean.moment : mean.force) = Vec3(contact, 0, 0);
            smooth.find({now.state(turns)}, {end.state(turns)}, {mean}, 1);
            if (!isSmooth) return end.speed;
            return old + load + (turns ? smooth.drive()[0].moment[0] : smooth.drive()[0].force[0]);
        };
        // two thirds of -addedMass (3/2 v - 2 old + 1/2 older) and one third of the last mean load, the velocity linear in the load
        auto excess = [&](double load) { return load + addedMass*(velocity(load) - 4*old/3 + older/3) - meanLoad/3; };
        const double atZero = excess(0), load = -atZero*1e-3/(excess(1e-3) - atZero);
        older = old;
        old = velocity(load);
        meanLoad = load;
        now = now.after(load, w, beta);
        const Vec3 inFluid(old, 0, 0);
        smooth.accept({turns ? Motion{Vec3::Zero(), inFluid} : Motion{inFluid, Vec3::Zero()}}, {false});
        (step < nSteps/5 ? first : last) = std::max(step < nSteps/5 ? first : step < 4*nSteps/5 ? 0 : last, std::abs(now.place));
        if (!(last < 1e3*first) && step >= nSteps/5) break;
    }
    return last/first;
}

double largestGrowth(double addedMass, double beta, bool isSmooth, bool turns)
{
    double largest = 0;
    for (double w = 0.05; w < 30; w *= 1.01) largest = std::max(largest, growth(addedMass, w, beta, isSmooth, turns));
    return largest;
}

} // namespace

TEST_CASE("a body on contact springs does not vibrate ever more, whatever its added mass, spring and dashpot")
{
    for (const bool turns : {false, true})
        for (const double beta : {0.0, 0.05, 0.7})
            for (const double addedMass : {0.2, 1.0, 5.0, 20.0})
            {
                const double smooth = largestGrowth(addedMass, beta, true, turns);
                std::printf("%s, damping ratio %.2f, added mass %.1f: amplitude times %.3g\n", turns ? "turning" : "moving", beta, addedMass, smooth);
                CHECK(smooth < 1.1);
            }
}

TEST_CASE("with the velocity at the step's end it does: the test can fail")
{
    for (const bool turns : {false, true}) CHECK(largestGrowth(1, 0, false, turns) > 100);
}

TEST_CASE("untouched bodies move as the engine says, to the last bit")
{
    BodyDefinition body;
    body.mass = 3;
    body.principalInertia = Vec3(1, 2, 3);
    const BodyState before = Oscillator{0.1, 0.3}.state(false), after = Oscillator{0.2, 0.7}.state(false);
    SmoothMotion smooth({body}, {before});
    smooth.find({before}, {after}, {Load()}, 0.5);
    CHECK(smooth.drive()[0].force.isZero(0));
    CHECK(smooth.drive()[0].moment.isZero(0));
    smooth.accept({Motion()}, {false});
    CHECK(smooth.states()[0].motion.velocity == after.motion.velocity);
    CHECK(smooth.states()[0].angularMomentum == after.angularMomentum);
}

TEST_CASE("a body that was touched moves as the engine says again one step later")
{
    BodyDefinition body;
    body.mass = 3;
    body.principalInertia = Vec3(1, 2, 3);
    const BodyState first = Oscillator{0.1, 0.3}.state(true), second = Oscillator{0.2, -0.7}.state(true), third = Oscillator{0.1, -0.7}.state(true);
    SmoothMotion smooth({body}, {first});
    smooth.find({first}, {second}, {Load{Vec3::Zero(), Vec3(1, 0, 0)}}, 0.5);
    smooth.accept({Motion{Vec3::Zero(), Vec3(-0.2, 0, 0)}}, {false});
    CHECK(smooth.states()[0].motion.angularVelocity != second.motion.angularVelocity);
    smooth.find({second}, {third}, {Load()}, 0.5);
    CHECK(!smooth.drive()[0].isZero());
    smooth.accept({Motion()}, {false});
    CHECK(smooth.states()[0].motion.angularVelocity == third.motion.angularVelocity);
    CHECK(smooth.states()[0].angularMomentum == third.angularMomentum);
    smooth.find({third}, {third}, {Load()}, 0.5);
    CHECK(smooth.drive()[0].isZero());
}

TEST_CASE("what is saved goes on the same")
{
    BodyDefinition body;
    body.mass = 3;
    body.principalInertia = Vec3(1, 2, 3);
    const BodyState first = Oscillator{0.1, 0.3}.state(true), second = Oscillator{0.2, 0.7}.state(true), third = Oscillator{0.2, -0.7}.state(true);
    const Load contact{Vec3(1, 2, 3), Vec3(3, 2, 1)};
    SmoothMotion a({body}, {first}), b({body}, {first});
    a.find({first}, {second}, {contact}, 0.5);
    a.accept({Motion{Vec3(1, 2, 3), Vec3(3, 1, 2)}}, {false});
    b.restore({second}, a.save().data());
    for (SmoothMotion* m : {&a, &b}) m->find({second}, {third}, {contact}, 0.25);
    CHECK(a.drive()[0].force == b.drive()[0].force);
    CHECK(a.drive()[0].moment == b.drive()[0].moment);
    CHECK(a.save() == b.save());
}
