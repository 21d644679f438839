// SPDX-License-Identifier: GPL-3.0-or-later
/// The cut by the faces of one solid or several: edges and corners stay sharp.
#include "geometry/clippedSimplex.hpp"
#include "geometry/facetPieces.hpp"
#include "geometry/simplexDivision.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{
namespace
{

constexpr int usualFacets = 8;          // at an edge
constexpr double sameFace = 1e-12;      // faces of two solids in one plane: what round-off makes of it must not lie outside of one for one part, and inside for the next
constexpr double samePlane = 1e-10;     // over the farthest of the simplex's corners: planes of two solids that are no farther apart at any corner are one
constexpr double leastRest = 0.01;      // over the simplex: a smaller fluid part is summed up itself
constexpr double justInside = -1e-300; // in place of zero: what is on a face is on the same side of it from both sides

/// Follows the parts of one simplex through the faces of one solid after the other.
template <int dim>
class EdgeCutter
{
public:
    /// faceEnd: nSolids, of each solid's faces in `distances`.
    EdgeCutter(const double* distances, const int* faceEnd, int nSolids, double volume, const double* vertices, const double* gradN)
        : distances_(distances), faceEnd_(faceEnd), nSolids_(nSolids), onFace_(nSolids > 1 ? sameFace : 0), volume_(volume), vertices_(vertices), gradN_(gradN)
    {
        if (nSolids > 1) joinPlanes();
    }

    void cut(EdgeCut<dim>& result)
    {
        SimplexPoint<dim> whole[dim + 1] = {};
        for (int a = 0; a <= dim; ++a) whole[a].n[a] = 1;
        begin(result);
        cutPart(whole, volume_, 0, 0);
    }

    /// The solid part instead, and its facets: of one solid.
    void cutSolid(EdgeCut<dim>& result)
    {
        if (dim == 3 && clipSolid(result)) return;
        SimplexPoint<dim> whole[dim + 1] = {};
        for (int a = 0; a <= dim; ++a) whole[a].n[a] = 1;
        begin(result);
        cutInside(whole, volume_, 0);
    }

    bool hasSolidPart(double leastPart) const
    {
        Point whole[dim + 1] = {};
        for (int a = 0; a <= dim; ++a) whole[a].n[a] = 1;
        return hasSolidPart(whole, 1, 0, leastPart);
    }

    /// The part in the solids of the simplex's own face opposite to `corner`.
    std::vector<SimplexFacet<dim>> cutOwnFace(int corner)
    {
        Point face[dim] = {};
        for (int a = 0, i = 0; a <= dim; ++a)
            if (a != corner) face[i++].n[a] = 1;
        double opposite[dim + 1] = {};  // falls towards the face
        opposite[corner] = 1;
        EdgeCut<dim> result;
        begin(result);
        for (int solid = 0; solid < nSolids_; ++solid) cutFacet(face, opposite, solid, solid == 0 ? 0 : faceEnd_[solid - 1]);
        return std::move(result.facets);
    }

private:
    using Point = SimplexPoint<dim>;

    void begin(EdgeCut<dim>& result)
    {
        result_ = &result;
        result.clear();
    }

    /// By polygons instead of simplices. False: round-off, see ClippedSimplex.
    bool clipSolid(EdgeCut<dim>& result)
    {
        begin(result);
        if constexpr (dim == 3)
        {
            ClippedSimplex solid;
            for (int face = 0; face < faceEnd_[0]; ++face)
            {
                if (!solid.clip(distances_ + face * (dim + 1), face)) return false;
                if (solid.isEmpty()) return true;
            }
            solid.addTo(result, volume_);
            solid.forFacets([&](const Point* corners, int face) { addFacet(corners, distances_ + face * (dim + 1), 0); });
        }
        return true;
    }

    /// Of planes that two solids nearly have in common, on the same or on opposite sides of it, the second becomes the first. What is on a face to round-off is inside of the other then, all of it. With
    /// their small distance some corners of a facet would count as inside and some as outside, others than those of the piece of volume beside it.
    void joinPlanes()
    {
        constexpr int n = dim + 1;
        for (int solid = 1; solid < nSolids_; ++solid)
            for (int face = faceEnd_[solid - 1]; face < faceEnd_[solid]; ++face)
                for (int other = 0; other < faceEnd_[solid - 1]; ++other)
                    if (const double sign = sideOf(distances_ + other * n, distances_ + face * n); sign != 0)
                    {
                        if (joined_.empty()) joined_.assign(distances_, distances_ + faceEnd_[nSolids_ - 1] * n);
                        distances_ = joined_.data();
                        for (int a = 0; a < n; ++a) joined_[face * n + a] = sign * joined_[other * n + a];
                        break;
                    }
    }

    /// 1, -1: the second plane is the first one, seen from the same or from the other side; 0: it is another one.
    static double sideOf(const double* first, const double* second)
    {
        const double sign = (first[0] < 0) == (second[0] < 0) ? 1 : -1;
        double farthest = 0, apart = 0;
        for (int a = 0; a <= dim; ++a)
        {
            farthest = std::max(farthest, std::abs(first[a]));
            apart = std::max(apart, std::abs(first[a] - sign * second[a]));
        }
        return apart < samePlane * farthest ? sign : 0;
    }

    double valueAt(int face, const Point& p) const
    {
        const double* distances = distances_ + face * (dim + 1);
        double value = 0, scale = 0;
        for (int a = 0; a <= dim; ++a) value += distances[a] * p.n[a];
        for (int a = 0; a <= dim && onFace_ > 0; ++a) scale += std::abs(distances[a] * p.n[a]);
        return value > onFace_ * scale ? value : std::min(value, justInside);
    }

    template <int nCorners>
    int valuesAt(int face, const Point* corners, double* values) const
    {
        int nPositive = 0;
        for (int i = 0; i < nCorners; ++i)
        {
            values[i] = valueAt(face, corners[i]);
            nPositive += values[i] > 0;
        }
        return nPositive;
    }

    static void toElement(const Point* corners, const Point* local, int n, Point* result)
    {
        for (int i = 0; i < n; ++i)
            for (int a = 0; a <= dim; ++a)
            {
                result[i].n[a] = 0;
                for (int j = 0; j <= dim; ++j) result[i].n[a] += local[i].n[j] * corners[j].n[a];
            }
    }

    /// A part inside of all faces before `face`: what is inside of all of them is added.
    void cutInside(const Point* corners, double partVolume, int face)
    {
        double values[dim + 1];
        int nPositive = 0;
        for (; face < faceEnd_[0] && nPositive == 0; face += nPositive == 0) nPositive = valuesAt<dim + 1>(face, corners, values);
        if (nPositive == dim + 1) return;
        if (nPositive == 0) return addPart<dim>(*result_, corners, partVolume, volume_);
        for (double& v : values) v = -v;
        const SimplexDivision<dim> inside = divideSimplex<dim>(values);
        Point part[dim + 1];
        for (int k = 0; k < inside.nFacets; ++k)
        {
            toElement(corners, inside.facets[k].corner, dim, part);
            cutFacet(part, distances_ + face * (dim + 1), 0, face + 1);
        }
        for (int k = 0; k < inside.nParts; ++k)
        {
            if (inside.parts[k].share * partVolume < negligiblePart * volume_) continue;
            toElement(corners, inside.parts[k].corner, dim + 1, part);
            cutInside(part, inside.parts[k].share * partVolume, face + 1);
        }
    }

    /// Of a part inside of all faces before `face`, share: of the simplex.
    bool hasSolidPart(const Point* corners, double share, int face, double leastPart) const
    {
        double values[dim + 1];
        int nPositive = 0;
        for (; face < faceEnd_[0] && nPositive == 0; face += nPositive == 0) nPositive = valuesAt<dim + 1>(face, corners, values);
        if (nPositive == 0 || nPositive == dim + 1) return nPositive == 0;
        for (double& v : values) v = -v;
        const SimplexDivision<dim> inside = divideSimplex<dim>(values);
        for (int k = 0; k < inside.nParts; ++k)
        {
            if (!(inside.parts[k].share * share > leastPart)) continue;
            Point part[dim + 1];
            toElement(corners, inside.parts[k].corner, dim + 1, part);
            if (hasSolidPart(part, inside.parts[k].share * share, face + 1, leastPart)) return true;
        }
        return false;
    }

    /// Of the fluid, or cut by the next solid.
    void leavePart(const Point* corners, double partVolume, int solid)
    {
        if (solid + 1 == nSolids_) addPart<dim>(*result_, corners, partVolume, volume_);
        else cutPart(corners, partVolume, solid + 1, faceEnd_[solid]);
    }

    /// A part inside of all faces of the solid before `face`: what is outside of this one goes to the next solid, the rest goes on.
    void cutPart(const Point* corners, double partVolume, int solid, int face)
    {
        if (face == faceEnd_[solid]) return;
        double values[dim + 1];
        const int nPositive = valuesAt<dim + 1>(face, corners, values);
        if (nPositive == 0) return cutPart(corners, partVolume, solid, face + 1);
        if (nPositive == dim + 1) return leavePart(corners, partVolume, solid);
        const SimplexDivision<dim> outside = divideSimplex<dim>(values);
        Point part[dim + 1];
        for (int k = 0; k < outside.nParts; ++k)
        {
            toElement(corners, outside.parts[k].corner, dim + 1, part);
            if (const double volume = outside.parts[k].share * partVolume; volume >= negligiblePart * volume_) leavePart(part, volume, solid);
        }
        for (int k = 0; k < outside.nFacets; ++k)
        {
            toElement(corners, outside.facets[k].corner, dim, part);
            cutFacet(part, distances_ + face * (dim + 1), solid, face + 1);
        }
        if (face + 1 == faceEnd_[solid]) return; // the rest is inside of all
        for (double& v : values) v = -v;
        const SimplexDivision<dim> inside = divideSimplex<dim>(values);
        for (int k = 0; k < inside.nParts; ++k)
        {
            if (inside.parts[k].share * partVolume < negligiblePart * volume_) continue;
            toElement(corners, inside.parts[k].corner, dim + 1, part);
            cutPart(part, inside.parts[k].share * partVolume, solid, face + 1);
        }
    }

    /// A piece of a solid's face, inside of all of its faces before `face`: keeps what is inside of this one. own: its function, which falls along its normal.
    void cutFacet(const Point* corners, const double* own, int solid, int face)
    {
        if (face == faceEnd_[solid]) return keepOutside(corners, own, solid, solid + 1, face);
        double values[dim];
        const int nPositive = valuesAt<dim>(face, corners, values);
        if (nPositive == dim) return;
        if (nPositive == 0) return cutFacet(corners, own, solid, face + 1);
        Point inside[2][dim];
        const int n = keepInside(corners, values, inside);
        for (int k = 0; k < n; ++k) cutFacet(inside[k], own, solid, face + 1);
    }

    /// A piece of the surface of `solid`, inside of all faces of `other` before `face`: without what is inside of it and of the solids after it. What is inside of those before is in no part.
    void keepOutside(const Point* corners, const double* own, int solid, int other, int face)
    {
        if (other == nSolids_) return addFacet(corners, own, solid);
        if (face == faceEnd_[other]) return;
        double values[dim];
        const int nPositive = valuesAt<dim>(face, corners, values);
        if (nPositive == dim) return keepOutside(corners, own, solid, other + 1, faceEnd_[other]);
        if (nPositive == 0) return keepOutside(corners, own, solid, other, face + 1);
        Point piece[2][dim];
        int n = keepInside(corners, values, piece);
        for (int k = 0; k < n; ++k) keepOutside(piece[k], own, solid, other, face + 1);
        for (double& v : values) v = -v;
        n = keepInside(corners, values, piece);
        for (int k = 0; k < n; ++k) keepOutside(piece[k], own, solid, other + 1, faceEnd_[other]);
    }

    static Point between(const Point& a, double va, const Point& b, double vb)
    {
        Point p;
        for (int k = 0; k <= dim; ++k) p.n[k] = (a.n[k] * vb - b.n[k] * va) / (vb - va);
        return p;
    }

    /// Corners in cyclic order: a segment or a triangle without the part where the values are positive.
    static int keepInside(const Point* corners, const double* values, Point (*result)[dim])
    {
        Point kept[dim + 1];
        int n = 0;
        for (int i = 0; i < dim; ++i)
        {
            const int next = (i + 1) % dim;
            if (values[i] < 0) kept[n++] = corners[i];
            if ((values[i] < 0) != (values[next] < 0) && (dim == 3 || next > i)) kept[n++] = between(corners[i], values[i], corners[next], values[next]);
        }
        for (int k = 0; k + dim <= n; ++k)
        {
            result[k][0] = kept[0];
            for (int i = 1; i < dim; ++i) result[k][i] = kept[k + i];
        }
        return n - dim + 1;
    }

    void addFacet(const Point* corners, const double* own, int solid)
    {
        SimplexFacet<dim> facet;
        if (!setFacet<dim>(facet, corners, volume_, vertices_)) return;
        if (own != ofNormal_) setDescent<dim>(normal_, own, gradN_);
        ofNormal_ = own;
        std::copy(normal_, normal_ + dim, facet.normal);
        if (result_->facets.capacity() == 0) result_->facets.reserve(usualFacets);
        facet.solid = solid;
        result_->facets.push_back(facet);
    }

    const double* distances_;
    const int* faceEnd_;
    int nSolids_;
    std::vector<double> joined_;    // distances_, where planes were joined
    double onFace_;     // of a value over its terms: round-off
    double volume_;
    const double *vertices_, *gradN_;
    EdgeCut<dim>* result_ = nullptr;
    const double* ofNormal_ = nullptr;  // function that normal_ is of: the pieces of a face follow each other
    double normal_[dim];
};

/// The moments of the fluid from those of the solid.
template <int dim>
void takeRest(SimplexMoments<dim>& moments, double volume)
{
    constexpr int n = dim + 1;
    moments.volume = volume - moments.volume;
    for (int a = 0; a < n; ++a) moments.first[a] = volume / n - moments.first[a];
    for (int ab = 0; ab < n * n; ++ab) moments.second[ab] = volume * (ab / n == ab % n ? 2 : 1) / (n * (n + 1)) - moments.second[ab];
}

template <int dim>
void add(const EdgeCut<dim>& part, int solid, EdgeCut<dim>& sum)
{
    sum.volume += part.volume;
    for (int a = 0; a <= dim; ++a) sum.first[a] += part.first[a];
    for (int ab = 0; ab < (dim + 1) * (dim + 1); ++ab) sum.second[ab] += part.second[ab];
    for (const SimplexFacet<dim>& facet : part.facets) sum.facets.emplace_back(facet).solid = solid;
}

} // namespace

/// The solid part has fewer pieces than the fluid, which is the rest of it, unless that is so little that digits were lost.
template <int dim>
void cutSimplexAtEdge(const double* distances, int nFaces, double volume, const double* vertices, const double* gradN, EdgeCut<dim>& cut)
{
    EdgeCutter<dim> cutter(distances, &nFaces, 1, volume, vertices, gradN);
    cutter.cutSolid(cut);
    if (volume - cut.volume < leastRest * volume) cutter.cut(cut);
    else takeRest(cut, volume);
}

template <int dim>
void cutSimplexOfSolids(const double* distances, const std::vector<int>& faceEnd, double volume, const double* vertices, const double* gradN, EdgeCut<dim>& cut)
{
    EdgeCutter<dim>(distances, faceEnd.data(), static_cast<int>(faceEnd.size()), volume, vertices, gradN).cut(cut);
    mergePieces<dim>(cut.facets);
}

template <int dim>
void cutSimplexOfApartSolids(const double* distances, const std::vector<int>& faceEnd, double volume, const double* vertices, const double* gradN, EdgeCut<dim>& sum, EdgeCut<dim>& part)
{
    sum.clear();
    for (std::size_t solid = 0; solid < faceEnd.size(); ++solid)
    {
        const int start = solid == 0 ? 0 : faceEnd[solid - 1], nFaces = faceEnd[solid] - start;
        EdgeCutter<dim>(distances + start * (dim + 1), &nFaces, 1, volume, vertices, gradN).cutSolid(part);
        add(part, static_cast<int>(solid), sum);
    }
    if (volume - sum.volume < leastRest * volume) return cutSimplexOfSolids<dim>(distances, faceEnd, volume, vertices, gradN, sum);
    takeRest(sum, volume);
    mergePieces<dim>(sum.facets);
}

template <int dim>
bool hasSolidPart(const double* distances, int nFaces, double leastPart)
{
    return EdgeCutter<dim>(distances, &nFaces, 1, 1, nullptr, nullptr).hasSolidPart(leastPart);
}

template <int dim>
void addFacePart(int corner, const double* distances, const std::vector<int>& faceEnd, double volume, const double* vertices, const double* gradN, std::vector<SimplexFacet<dim>>& facets)
{
    const std::vector<SimplexFacet<dim>> parts = EdgeCutter<dim>(distances, faceEnd.data(), static_cast<int>(faceEnd.size()), volume, vertices, gradN).cutOwnFace(corner);
    facets.insert(facets.end(), parts.begin(), parts.end());
}

template void cutSimplexAtEdge<2>(const double*, int, double, const double*, const double*, EdgeCut<2>&);
template void cutSimplexAtEdge<3>(const double*, int, double, const double*, const double*, EdgeCut<3>&);
template void cutSimplexOfSolids<2>(const double*, const std::vector<int>&, double, const double*, const double*, EdgeCut<2>&);
template void cutSimplexOfSolids<3>(const double*, const std::vector<int>&, double, const double*, const double*, EdgeCut<3>&);
template void cutSimplexOfApartSolids<2>(const double*, const std::vector<int>&, double, const double*, const double*, EdgeCut<2>&, EdgeCut<2>&);
template void cutSimplexOfApartSolids<3>(const double*, const std::vector<int>&, double, const double*, const double*, EdgeCut<3>&, EdgeCut<3>&);
template bool hasSolidPart<2>(const double*, int, double);
template bool hasSolidPart<3>(const double*, int, double);
template void addFacePart<2>(int, const double*, const std::vector<int>&, double, const double*, const double*, std::vector<SimplexFacet<2>>&);
template void addFacePart<3>(int, const double*, const std::vector<int>&, double, const double*, const double*, std::vector<SimplexFacet<3>>&);

} // namespace flotsam
