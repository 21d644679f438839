// SPDX-License-Identifier: GPL-3.0-or-later
/// Of the triangles that a sphere overlaps, those that stand for one place of the surface count once.
#pragma once

#include "demCoupling/liggghts/liggghtsNear.hpp"

namespace flotsam
{

/// A triangle's nearest point to a sphere's centre, and how deep the sphere overlaps it there [m].
struct FacetTouch { int triangle; double depth; Vec3 point, normal; };

/// LIGGGHTS gives a sphere a spring for each triangle it overlaps, at the triangle's nearest point, be that on an edge or a corner. Over a round pile, a
/// finely divided surface or beside an edge the neighbours' springs come on top of the nearest one's, in almost the same direction: contact is as many
/// times as stiff and as damped, and where a neighbour joins with an overlap that is not zero (in a hollow) it gives work that nobody has done. Here, of
/// triangles whose contact normals are close, the one with the deepest overlap alone acts. The energy is that of one spring, k/2 times the square
/// of the deepest overlap, whatever the surface is divided into; hollows hardly wider than the sphere are left (docs/contact.md).
class FacetChoice
{
public:
    explicit FacetChoice(LiggghtsModel& model) : model_(model) {}

    /// Cosine of the largest angle between normals of one place, 30 degrees. An edge beside the face that the sphere is over has up to
    /// acos(1 - overlap/radius), 18 degrees at 5 %; faces that meet at more than the limit in a corner are two places. Table: docs/contact.md.
    static constexpr double sameNormal = 0.866;

    /// One touch for each place of the surface that the sphere overlaps, or comes within `margin` of [m]. Valid until the next call.
    const std::vector<FacetTouch>& places(const SphereTriangles& near, double margin);

    /// Before and after the forces of a sub-step, with the lists unchanged between: triangles that do not count are out of them.
    void leaveOut();
    void takeBack();

private:
    struct Taken { size_t mesh; int triangle, sphere; size_t place; };

    void findTouches(const SphereTriangles& near, double margin);
    void leaveOut(const SphereTriangles& near, int triangle);
    void handOnSpring(const SphereTriangles& near, const FacetTouch& place);

    LiggghtsModel& model_;
    std::vector<FacetTouch> touches_, places_;
    std::vector<int> doubled_;  ///< triangles of the touches that are no place of their own
    std::vector<Taken> taken_;
};

} // namespace flotsam
