// SPDX-License-Identifier: GPL-3.0-or-later
/// The direction and the curvature of a single front from the means of a dual cell and of its neighbours.
///
/// Each mean gives the distance of its cell from the front (the profile's slab mean, inverted). Least squares for
/// distance = c + a s + b.z + z.K z/2, weighted with (alpha (1 - alpha))^2, as an error of alpha makes one of delta/(alpha (1 - alpha)) of the distance.
#pragma once

#include "equations/surfaceFit.hpp"

namespace flotsam
{

/// Gradient and second derivatives of the distance over the length of its gradient; K in 1/h.
template<int dim>
struct Front
{
    double across, tilt[dim - 1];
    double curvature[(dim - 1)*dim/2];
};

/// steepness = h/delta; s of the samples lies near the normal, into the phase of their alpha, all between 0 and 1. False where the distances do not rise along s.
template<int dim> bool fitFront(const SurfaceSample* samples, int nSamples, double steepness, Front<dim>& front);

} // namespace flotsam
