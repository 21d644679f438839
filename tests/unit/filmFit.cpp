// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/filmFit.hpp"
#include "equations/surfaceLevel.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace flotsam;

namespace
{

constexpr double steepness = 5;

struct Shape { double middle, tilt, curvature, thickness, taper; };

/// Means of a film, bent and tapered along the first tangent, over the cells of a block of 3^dim.
template<int dim>
std::vector<SurfaceSample> samplesOf(const Shape& shape)
{
    std::vector<SurfaceSample> samples;
    const double scale = steepness/std::sqrt(1 + shape.tilt*shape.tilt), growth = std::exp(0.5*steepness);
    for (int k = 0; k < (dim == 2 ? 9 : 27); ++k)
    {
        const auto place = [k](int stride) { return double((k/stride + 1) % 3) - 1; };  // k = 0: the middle of the block
        SurfaceSample s{place(1), {place(3), dim == 3 ? place(9) : 0}, steepness, growth, 0};
        const double z = s.along[0], half = 0.5*(shape.thickness + shape.taper*z);
        const double middle = shape.middle + shape.tilt*z + 0.5*shape.curvature*z*z;
        s.alpha = ProfileSlab{scale*(half - s.across + middle), steepness}.mean() + ProfileSlab{scale*(half + s.across - middle), steepness}.mean() - 1;
        samples.push_back(s);
    }
    return samples;
}

template<int dim>
void checkRecovered(const Shape& shape)
{
    const std::vector<SurfaceSample> samples = samplesOf<dim>(shape);
    REQUIRE(samples[0].across == 0);
    Film<dim> film = fitFilm<dim>(samples.data(), int(samples.size()), steepness, 1);
    CHECK(std::abs(film.middle - shape.middle) < 0.02);
    CHECK(std::abs(film.tilt[0] - shape.tilt) < 0.02);
    CHECK(std::abs(film.thickness - shape.thickness) < 0.02);
    CHECK(std::abs(film.taper[0] - shape.taper) < 0.02);
    CHECK(film.residual < 1e-3);
    film.thickness += 0.3;
    fillFilm(film, samples[0], steepness);
    CHECK(std::abs(film.thickness - shape.thickness) < 0.02);
}

} // namespace

TEST_CASE("the means of a film, straight, tilted, tapered or bent, give the film back")
{
    for (const Shape& shape : {Shape{0, 0, 0, 1, 0}, Shape{0.3, 0.1, 0, 0.6, 0}, Shape{-0.2, 0, 0, 1.2, 0.2}, Shape{0.1, 0, 0.15, 0.8, 0}})
    {
        checkRecovered<2>(shape);
        checkRecovered<3>(shape);
    }
}
