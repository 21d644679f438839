// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/frontFit.hpp"
#include "equations/profileReconstruction.hpp"
#include "equations/surfaceLevel.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace flotsam;

namespace
{

constexpr double steepness = 5;

/// Distance (place + s + tilt z1 + bend z1^2/2 + twist z1 z2)/sqrt(1 + tilt^2).
struct Shape { double place, tilt, bend, twist; };

/// Means of a front over the mixed cells of a block of 3^dim.
template<int dim>
std::vector<SurfaceSample> samplesOf(const Shape& shape)
{
    std::vector<SurfaceSample> samples;
    for (int k = 0; k < (dim == 2 ? 9 : 27); ++k)
    {
        const auto place = [k](int stride) { return double((k/stride + 1) % 3) - 1; };  // k = 0: the middle of the block
        SurfaceSample s{place(1), {place(3), dim == 3 ? place(9) : 0}, steepness, std::exp(0.5*steepness), 0};
        const double* z = s.along;
        const double distance = (shape.place + s.across + shape.tilt*z[0] + 0.5*shape.bend*z[0]*z[0] + shape.twist*z[0]*z[1])/std::sqrt(1 + shape.tilt*shape.tilt);
        s.alpha = ProfileSlab{steepness*distance, steepness}.mean();
        if (isMixed(s.alpha))
        {
            samples.push_back(s);
        }
    }
    return samples;
}

template<int dim>
void checkRecovered(const Shape& shape)
{
    const std::vector<SurfaceSample> samples = samplesOf<dim>(shape);
    Front<dim> front;
    REQUIRE(fitFront<dim>(samples.data(), int(samples.size()), steepness, front));
    const double length = std::sqrt(1 + shape.tilt*shape.tilt);
    CHECK(std::abs(front.across - 1/length) < 1e-3);
    CHECK(std::abs(front.tilt[0] - shape.tilt/length) < 1e-3);
    CHECK(std::abs(front.curvature[0] - shape.bend/length) < 2e-3);
    if (dim == 3)
    {
        CHECK(std::abs(front.curvature[1] - shape.twist/length) < 2e-3);
        CHECK(std::abs(front.tilt[dim - 2]) < 1e-3);
    }
}

} // namespace

TEST_CASE("the means of a front, straight, tilted, bent or twisted, give it back")
{
    for (const Shape& shape : {Shape{0, 0, 0, 0}, Shape{0.3, 0.2, 0, 0}, Shape{-0.2, 0, 0.15, 0}, Shape{0.1, -0.1, -0.1, 0}})
    {
        checkRecovered<2>(shape);
        checkRecovered<3>(shape);
    }
    checkRecovered<3>({0.1, 0.1, 0.05, 0.1});
}

TEST_CASE("a cell whose neighbours are full or empty keeps its direction")
{
    const SurfaceSample own{0, {0, 0}, steepness, std::exp(0.5*steepness), 0.4};
    Front<3> front;
    REQUIRE(fitFront<3>(&own, 1, steepness, front));
    CHECK(front.across == near(1, 1e-14));
    for (const double x : {front.tilt[0], front.tilt[1], front.curvature[0], front.curvature[1], front.curvature[2]})
    {
        CHECK(std::abs(x) < 1e-12);
    }
}

TEST_CASE("distances that fall along the direction make no front")
{
    std::vector<SurfaceSample> samples = samplesOf<2>({0, 0, 0, 0});
    for (SurfaceSample& s : samples)
    {
        s.alpha = 1 - s.alpha;
    }
    Front<2> front;
    CHECK(!fitFront<2>(samples.data(), int(samples.size()), steepness, front));
}
