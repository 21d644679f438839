// SPDX-License-Identifier: GPL-3.0-or-later
/// The geometry during a step in which solids move.
#pragma once

#include "geometry/cover.hpp"

namespace flotsam
{

/// Copies what a step still reads of the cover at its start: states, cut elements, facets and active nodes. Not what bodies cover of each other, the largest part.
void keepForMean(const Cover& cover, Cover& kept);

/// Mean over the step of what is fluid: moments and facets of `start` and `end`, half each. Only states, cut elements, facets and active nodes
/// are set. An element counts as whole only if it is at both times.
void setMeanCover(const SimplexMesh& mesh, const Cover& start, const Cover& end, Cover& mean);

} // namespace flotsam
