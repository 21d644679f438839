// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/cellShare.H"

using namespace Foam;

namespace flotsam
{

namespace
{

/// Weight of a triangle in the middle of the face that it is a part of: the cutting classes of v1912 (isoCutFace) take the square of its area, those after (cutFace) the area.
scalar weightInMiddle(const vector& area)
{
#if OPENFOAM >= 2006
    return mag(area);
#else
    return magSqr(area);
#endif
}

} // namespace

/// The cone over the polygon's middle; a triangle is exact as it is.
CellShare::Part CellShare::ofPolygon() const
{
    const std::size_t n = polygon_.size();
    Part part;
    if (n < 3) return part;
    vector mean(Zero), sum(Zero);
    for (const point& x : polygon_) mean += x/scalar(n);
    scalar weights = 0;
    for (std::size_t k = 0; k < n; ++k)
    {
        const point &x = polygon_[k], &next = polygon_[(k + 1) % n];
        const vector area = 0.5*((next - x) ^ (mean - x));
        const scalar weight = weightInMiddle(area);
        part.area += area;
        sum += weight*(x + next + mean)/3;
        weights += weight;
    }
    part.middle = n == 3 || weights < ROOTVSMALL*ROOTVSMALL ? mean : sum/weights;
    return part;
}

/// The part of a face on the plane's positive side; of a whole one what the mesh has.
CellShare::Part CellShare::above(label facei, const point& origin, const vector& normal, scalar offset)
{
    const face& f = mesh_.faces()[facei];
    const pointField& points = mesh_.points();
    const auto height = [&](label i) { return (normal & (points[i] - origin)) - offset; };
    polygon_.clear();
    bool isWhole = true;
    forAll(f, k)
    {
        const label i = f[k], j = f.nextLabel(k);
        const scalar hi = height(i), hj = height(j);
        if (hi > 0) polygon_.push_back(points[i] - origin);
        if ((hi > 0) != (hj > 0)) polygon_.push_back(points[i] - origin + hi/(hi - hj)*(points[j] - points[i]));
        isWhole = isWhole && hi > 0;
    }
    if (!isWhole) return ofPolygon();
    Part part;
    part.area = mesh_.faceAreas()[facei];
    part.middle = mesh_.faceCentres()[facei] - origin;
    return part;
}

/// A third of the flux of x through the surface of what is cut off. Its faces' areas close with that of the plane, which thus need not be made: its area is minus their sum, its
/// flux that times its offset.
FluidFraction CellShare::operator()(label celli, const vector& normal, scalar offset)
{
    const point& origin = mesh_.cellCentres()[celli];
    const scalar fromOrigin = offset - (normal & origin);
    scalar flux = 0, cut = 0;
    for (const label facei : mesh_.cells()[celli])
    {
        const Part part = above(facei, origin, normal, fromOrigin);
        const scalar sign = mesh_.faceOwner()[facei] == celli ? 1 : -1;
        flux += sign*(part.area & (part.middle - fromOrigin*normal));
        cut += sign*(part.area & normal);
    }
    const scalar volume = mesh_.cellVolumes()[celli];
    return {flux/(3*volume), cut/volume};
}

bool CellShare::cutsFaceTwice(label celli, const std::function<bool(label)>& isAbove) const
{
    for (const label facei : mesh_.cells()[celli])
    {
        const face& f = mesh_.faces()[facei];
        int nCrossings = 0;
        forAll(f, k) nCrossings += isAbove(f[k]) != isAbove(f.nextLabel(k));
        if (nCrossings > 2) return true;
    }
    return false;
}

} // namespace flotsam
