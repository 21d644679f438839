// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies, walls and scenes for the tests of the DEM engine.
#pragma once

#include "demCoupling/liggghts/liggghtsEngine.hpp"

namespace demTest
{

using flotsam::BodyDefinition;
using flotsam::DemSetup;
using flotsam::Load;
using flotsam::TriSurface;
using flotsam::Vec3;
using flotsam::WallDefinition;

constexpr double gravity = 9.81;

/// Box of wood (590 kg/m^3) with spheres of `diameter` on its faces, centres at most `pitch` apart.
BodyDefinition bar(const Vec3& size, double diameter, double pitch, const Vec3& position);
/// The paper's piece of debris, 0.2 x 0.02 x 0.02 m, 80 spheres of 0.01 m.
BodyDefinition debris(const Vec3& position);
/// One sphere.
BodyDefinition ball(double radius, double mass, const Vec3& position);

WallDefinition plane(const Vec3& point, const Vec3& normal);
/// Closed box as triangles.
WallDefinition block(const Vec3& lower, const Vec3& upper);
/// Closed vertical cylinder as triangles, caps as fans.
WallDefinition pipe(const Vec3& foot, double radius, double height, int sides);

DemSetup scene(std::vector<BodyDefinition> bodies, std::vector<WallDefinition> walls, const flotsam::ContactLaw& law = {});

/// The weight of every body.
std::vector<Load> weights(const DemSetup& setup);

/// `count` bars falling into a container of five walls; with mesh walls instead of planes if asked.
DemSetup heap(int count, bool hasMeshes);

/// Twenty bars piled against the seven pipes of the slit dam, upstream of them on a bed between two side walls.
DemSetup pile();
/// What presses that pile together: a current along x, a tenth of the weight.
std::vector<Load> pressing(const DemSetup& setup);

} // namespace demTest
