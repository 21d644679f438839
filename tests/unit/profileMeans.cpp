// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/elementaryFunctions.hpp"
#include "equations/profileMeans.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace flotsam;

TEST_CASE("exponentials and logarithms are those of the standard library to round-off")
{
    std::vector<double> x, y;
    for (int k = -7000; k <= 7000; ++k)
    {
        x.push_back(0.1*k + 1e-3*std::sin(k));
        y.push_back(std::exp(0.1*k));
    }
    std::vector<double> exponential = x, logarithm = y;
    exponential.front() = x.front() = -700;
    exponential.back() = x.back() = 700;
    for (const double near : {1., 1 - 1e-12, 1 + 1e-12, std::sqrt(0.5), std::sqrt(2.), 1e-300, 1e300})
    {
        y.push_back(near);
        logarithm.push_back(near);
    }
    exponentials(exponential.data(), int(exponential.size()));
    logarithms(logarithm.data(), int(logarithm.size()));
    double worst = 0;
    for (std::size_t k = 0; k < x.size(); ++k) worst = std::max(worst, std::abs(exponential[k]/std::exp(x[k]) - 1));
    CHECK(worst < 1e-15);
    worst = 0;
    for (std::size_t k = 0; k < y.size(); ++k)
    {
        const double wanted = std::log(y[k]);
        worst = std::max(worst, wanted == 0 ? std::abs(logarithm[k]) : std::abs(logarithm[k]/wanted - 1));
    }
    CHECK(worst < 1e-15);
}

TEST_CASE("means over many faces are those over each, also where little passes and far from the front")
{
    std::vector<double> psi, swept, mean;
    for (const double p : {-60., -34.9, -7., -1., -1e-3, 0., 0.4, 3., 20., 35.1, 100.})
    {
        for (const double s : {0., 1e-9, -1e-4, 9.9e-4, -1.1e-3, 0.01, 0.29, -0.31, 2., -40., 150.})
        {
            psi.push_back(p);
            swept.push_back(s);
        }
    }
    mean.resize(psi.size());
    std::vector<double> work = swept;
    sweptMeans(psi.data(), work.data(), int(psi.size()), mean.data());
    for (std::size_t k = 0; k < psi.size(); ++k)
    {
        CAPTURE(psi[k]);
        CAPTURE(swept[k]);
        CHECK(std::abs(mean[k] - sweptMean(psi[k], swept[k])) < 2e-9);
    }
}

TEST_CASE("the front of a mean gives the mean back, in thin and in thick slabs")
{
    std::vector<double> alpha, thickness;
    for (const double a : {1e-4, 0.01, 0.3, 0.5, 0.9, 1 - 1e-4})
    {
        for (const double t : {0.01, 0.5, 5., 40., 900.})
        {
            alpha.push_back(a);
            thickness.push_back(t);
        }
    }
    std::vector<double> middle = thickness;
    frontsFromMeans(alpha.data(), middle.data(), int(middle.size()));
    for (std::size_t k = 0; k < alpha.size(); ++k)
    {
        CAPTURE(alpha[k]);
        CAPTURE(thickness[k]);
        // the mean itself, without the ends that sweptMean() leaves out: ln(1 + exp(x)) for any x
        const auto area = [](double x) { return std::max(x, 0.) + std::log1p(std::exp(-std::abs(x))); };
        const double half = 0.5*thickness[k];
        CHECK(std::abs((area(middle[k] + half) - area(middle[k] - half))/thickness[k] - alpha[k]) < 1e-9);
    }
}
