// SPDX-License-Identifier: GPL-3.0-or-later
/// A film (2D: filament) of one phase that is too thin for its two surfaces to lie in different dual cells, fitted to the
/// means of a dual cell and of its neighbours by least squares.
///
/// With s along a normal of the film and z in its plane: middle m(z) = c + b.z + z.K z/2, thickness t(z) = t0 + t1.z, and
/// alpha = S((t/2 - (s - m))/delta) + S((t/2 + (s - m))/delta) - 1, S(x) = 1/(1 + exp(-x)).
/// The curvature K only keeps the fit from moving the film: the neighbours on an arc lie on one side of its tangent. The thickness
/// must vary inside the cell, or it is carried along the film to first order only.
#pragma once

#include "equations/surfaceFit.hpp"

namespace flotsam
{

template<int dim>
struct Film
{
    static constexpr int tangents = dim - 1;
    double middle, thickness;           ///< at z = 0 [h]
    double tilt[tangents], taper[tangents];
    double curvature[tangents*dim/2];   ///< K [1/h], upper triangle
    double residual;                    ///< sum of the squared differences of the other cells' means
};

/// samples[0] is the cell that is fitted; steepness = h/delta; wanted: residual below which the film is of use. The residual is 1e300 where no fit was found.
template<int dim> Film<dim> fitFilm(const SurfaceSample* samples, int nSamples, double steepness, double wanted);

/// Changes the thickness so that the mean of samples[0] is met.
template<int dim> void fillFilm(Film<dim>& film, const SurfaceSample& own, double steepness);

} // namespace flotsam
