// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/slipNormals.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flotsam
{

namespace
{

using Vector = std::array<double, 3>;

constexpr double sameNormal = 0.9; // cosine above which two faces belong to one smooth wall
constexpr double flat = 1 - 1e-12; // cosine up to which they are one plane, from 1e-6 of an angle on
constexpr double tie = 1e-9;        // difference of such cosines that may be round-off
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
        if (cosine(wall, face) >= flat) return join(wall, face);
    walls_.push_back(face);
}

double SlipNormals::cosine(const Wall& wall, const Wall& other) { return dot(wall.area, other.area)/(length(wall.area)*length(other.area)); }

void SlipNormals::join(Wall& wall, const Wall& other)
{
    add(wall.area, 1, other.area);
    add(wall.place, 1, other.place);
}

std::array<long, 3> SlipNormals::Wall::direction() const
{
    constexpr double round = 1e6;
    std::array<long, 3> result;
    for (int d = 0; d < 3; ++d) result[d] = std::lround(round*area[d]/length(area));
    return result;
}

/// Of several whose angle is the same the one that comes first by their directions.
SlipNormals::Pair SlipNormals::nearestPair() const
{
    const auto directions = [this](const Pair& p) { return std::minmax({walls_[p.first].direction(), walls_[p.second].direction()}); };
    Pair best{0, 0, -1};
    for (std::size_t k = 1; k < walls_.size(); ++k)
        for (std::size_t l = 0; l < k; ++l)
        {
            const Pair pair{l, k, cosine(walls_[l], walls_[k])};
            const bool isTied = std::abs(pair.cosine - best.cosine) < tie && best.second > 0;
            if (isTied ? directions(pair) < directions(best) : pair.cosine > best.cosine) best = pair;
        }
    return best;
}

void SlipNormals::findWalls()
{
    for (Pair pair = nearestPair(); pair.cosine > sameNormal; pair = nearestPair())
    {
        isBent_ = isBent_ || pair.cosine < flat;
        join(walls_[pair.first], walls_[pair.second]);
        walls_.erase(walls_.begin() + std::ptrdiff_t(pair.second));
    }
    std::sort(walls_.begin(), walls_.end(), [](const Wall& l, const Wall& r) { return l.direction() < r.direction(); });
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
