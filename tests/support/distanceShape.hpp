// SPDX-License-Identifier: GPL-3.0-or-later
/// A shape that is known by its distance alone, as STL surfaces of many faces are: no faces, no parts.
#pragma once

#include "geometry/shape.hpp"

namespace flotsam
{

class DistanceShape : public Shape
{
public:
    explicit DistanceShape(std::shared_ptr<const Shape> inner) : inner_(std::move(inner)) {}
    double distance(const Vec3& x) const override { return inner_->distance(x); }
    std::array<Vec3, 2> bounds() const override { return inner_->bounds(); }
    VolumeMoments moments() const override { return inner_->moments(); }
    TriSurface surface(double size) const override { return inner_->surface(size); }

private:
    std::shared_ptr<const Shape> inner_;
};

} // namespace flotsam
