// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/slipNormals.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

using Vector = std::array<double, 3>;

constexpr double sameNormal = 0.9; // cosine above which two faces belong to one smooth wall
constexpr double flat = 1 - 1e-12; // cosine up to which they are one plane, from 1e-6 of an angle on
constexpr double leastSine = 0.1;  // of the angle between walls: nothing but round-off between the sides of a baffle

double dot(const Vector& a, const Vector& b) { return a[0]*b[0] + a[1]*b[1] + a[2]*b[2]; }

double length(const Vector& a) { return std::sqrt(dot(a, a)); }

void add(Vector& a, double factor, const Vector& b)
{
    for (int d = 0; d < 3; ++d) a[d] += factor*b[d];
}

} // namespace

void SlipNormals::addFace(const double* v, const double* place, int dim)
{
    Wall face;
    std::copy(v, v + dim, face.area.begin());
    std::copy(place, place + dim, face.place.begin());
    for (Wall& wall : walls_)
    {
        const double cosine = dot(wall.area, face.area)/(length(wall.area)*length(face.area));
        if (cosine <= sameNormal) continue;
        isBent_ = isBent_ || cosine < flat;
        add(wall.area, 1, face.area);
        add(wall.place, 1, face.place);
        return;
    }
    walls_.push_back(face);
}

/// The fluid fills more than 180 degrees between two walls if each lies on the outer side of the other.
bool SlipNormals::isAtEdge(const Wall& wall) const
{
    return std::any_of(walls_.begin(), walls_.end(), [&](const Wall& other) {
        return &other != &wall && isOutside(wall, other) && isOutside(other, wall);
    });
}

bool SlipNormals::isOutside(const Wall& wall, const Wall& other)
{
    return dot(wall.area, other.place) > leastSine*length(wall.area)*length(other.place);
}

bool SlipNormals::hasEdge() const
{
    return std::any_of(walls_.begin(), walls_.end(), [&](const Wall& wall) { return isAtEdge(wall); });
}

std::vector<std::array<double, 3>> SlipNormals::edgeNormals() const
{
    std::vector<Vector> normals;
    for (const Wall& wall : walls_)
    {
        if (!isAtEdge(wall)) continue;
        normals.emplace_back();
        add(normals.back(), 1/length(wall.area), wall.area);
    }
    return normals;
}

NodeConstraint SlipNormals::constraint(int node, int dim) const
{
    NodeConstraint c{};
    c.node = node;
    std::array<Vector, 3> chosen{};
    for (const Wall& wall : walls_)
    {
        if (isAtEdge(wall)) continue;
        Vector direction = wall.area;
        for (int k = 0; k < c.nDirections; ++k) add(direction, -dot(direction, chosen[k]), chosen[k]);
        const double size = length(direction);
        if (size < 0.1*length(wall.area) || c.nDirections == dim) continue;
        Vector unit{};
        add(unit, 1/size, direction);
        chosen[c.nDirections] = unit;
        std::copy(unit.begin(), unit.end(), c.direction[c.nDirections++]);
    }
    return c;
}

} // namespace flotsam
