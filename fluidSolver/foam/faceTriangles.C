// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/faceTriangles.H"

#include "syncTools.H"

using namespace Foam;

namespace flotsam
{
namespace
{

/// Quality below which another choice is tried, and the margin below which round-off would decide.
constexpr scalar goodQuad = 0.05, goodFan = 0.02, tieMargin = 1e-6;

/// A face seen from its point of lowest order towards the lower of the two neighbours: the same from both sides.
class CanonicalFace
{
public:
    CanonicalFace(const pointField& points, const face& f, const labelList& order, const std::vector<point>& centres)
        : points_(points), face_(f), order_(order), centres_(centres), n_(f.size())
    {
        for (label i = 1; i < n_; ++i)
        {
            first_ = order[f[i]] < order[f[first_]] ? i : first_;
        }
        step_ = order[f[(first_ + 1) % n_]] < order[f[(first_ + n_ - 1) % n_]] ? 1 : n_ - 1;
        vector mean(Zero);
        for (label i = 0; i < n_; ++i)
        {
            area_ += doubleArea(0, i, (i + 1) % n_);
            mean += points_[vertex(i)] / n_;
        }
        for (const point& centre : centres_)
        {
            pyramids_.push_back(area_ & (mean - centre));
        }
    }

    label size() const { return n_; }
    label vertex(label i) const { return face_[(first_ + i * step_) % n_]; }
    label orderOf(label i) const { return order_[vertex(i)]; }
    bool isReversed() const { return step_ != 1; }

    scalar quality(label i, label j, label k) const
    {
        const vector triangle = doubleArea(i, j, k);
        scalar worst = (triangle & area_) / (magSqr(area_) + VSMALL);
        for (std::size_t c = 0; c < centres_.size(); ++c)
        {
            const scalar pyramid = triangle & (points_[vertex(i)] - centres_[c]);
            // a sign test by the product: the ratio is the same seen from both sides
            worst = min(worst, pyramid * pyramids_[c] / (sqr(pyramids_[c]) + VSMALL * VSMALL));
        }
        return worst;
    }

    scalar fanQuality(label start) const
    {
        scalar worst = VGREAT;
        for (label i = 1; i + 1 < n_; ++i)
        {
            worst = min(worst, quality(start, (start + i) % n_, (start + i + 1) % n_));
        }
        return worst;
    }

private:
    vector doubleArea(label i, label j, label k) const
    {
        const point& x = points_[vertex(i)];
        return (points_[vertex(j)] - x) ^ (points_[vertex(k)] - x);
    }

    const pointField& points_;
    const face& face_;
    const labelList& order_;
    const std::vector<point>& centres_;
    label n_, first_ = 0, step_ = 1;
    vector area_ = Zero;
    std::vector<scalar> pyramids_; // six times the volume, per centre
};

void addTriangle(const CanonicalFace& f, label i, label j, label k, std::vector<Triangle>& triangles)
{
    const Triangle t{f.vertex(i), f.vertex(j), f.vertex(k)};
    triangles.push_back(f.isReversed() ? Triangle{t[0], t[2], t[1]} : t);
}

void addFan(const CanonicalFace& f, label start, std::vector<Triangle>& triangles)
{
    const label n = f.size();
    for (label i = 1; i + 1 < n; ++i)
    {
        addTriangle(f, start, (start + i) % n, (start + i + 1) % n, triangles);
    }
}

label bestFan(const CanonicalFace& f, scalar& quality)
{
    label best = 0;
    quality = -VGREAT;
    for (label start = 0; start < (f.size() == 4 ? 2 : f.size()); ++start)
    {
        const scalar q = f.fanQuality(start);
        const bool isTied = q > quality - tieMargin && f.orderOf(start) < f.orderOf(best);
        if (q > quality + tieMargin || isTied)
        {
            quality = max(quality, q);
            best = start;
        }
    }
    return best;
}

/// The triangulation whose worst triangle is best, by dynamic programming over the sub-polygons i..j.
class BestTriangulation
{
public:
    explicit BestTriangulation(const CanonicalFace& f) : face_(f), n_(f.size()), quality_(n_ * n_, VGREAT), middle_(n_ * n_, -1)
    {
        for (label span = 2; span < n_; ++span)
        {
            for (label i = 0; i + span < n_; ++i)
            {
                solve(i, i + span);
            }
        }
    }

    scalar quality() const { return quality_[n_ - 1]; }

    void add(std::vector<Triangle>& triangles) const { add(0, n_ - 1, triangles); }

private:
    void solve(label i, label j)
    {
        scalar& best = quality_[i * n_ + j];
        best = -VGREAT;
        for (label k = i + 1; k < j; ++k)
        {
            const scalar q = min(face_.quality(i, k, j), min(quality_[i * n_ + k], quality_[k * n_ + j]));
            if (q > best + tieMargin)
            {
                best = q;
                middle_[i * n_ + j] = k;
            }
        }
    }

    void add(label i, label j, std::vector<Triangle>& triangles) const
    {
        const label k = middle_[i * n_ + j];
        if (k >= 0)
        {
            addTriangle(face_, i, k, j, triangles);
            add(i, k, triangles);
            add(k, j, triangles);
        }
    }

    const CanonicalFace& face_;
    label n_;
    std::vector<scalar> quality_;
    std::vector<label> middle_;
};

} // namespace

scalar triangulate(const pointField& points, const face& f, const labelList& order, const std::vector<point>& centres,
    std::vector<Triangle>& triangles)
{
    triangles.clear();
    if (f.size() == 3)
    {
        triangles.push_back({f[0], f[1], f[2]});
        return 1;
    }
    const CanonicalFace canonical(points, f, order, centres);
    if (f.size() == 4)
    {
        const scalar first = canonical.fanQuality(0);
        if (first > goodQuad)
        {
            addFan(canonical, 0, triangles);
            return first;
        }
    }
    scalar quality;
    const label start = bestFan(canonical, quality);
    if (f.size() > 4 && quality < goodFan)
    {
        const BestTriangulation best(canonical);
        if (best.quality() > quality + tieMargin)
        {
            best.add(triangles);
            return best.quality();
        }
    }
    addFan(canonical, start, triangles);
    return quality;
}

FaceTriangles::FaceTriangles(const polyMesh& mesh, const labelList& order)
{
    const pointField& cellCentres = mesh.cellCentres();
    pointField acrossBoundary;
    syncTools::swapBoundaryCellPositions(mesh, cellCentres, acrossBoundary);

    std::vector<Triangle> ofFace;
    std::vector<point> centres(2);
    start.assign(1, 0);
    start.reserve(mesh.nFaces() + 1);
    triangles.reserve(2 * static_cast<std::size_t>(mesh.nFaces()));
    for (label facei = 0; facei < mesh.nFaces(); ++facei)
    {
        centres[0] = cellCentres[mesh.faceOwner()[facei]];
        centres[1] = mesh.isInternalFace(facei) ? cellCentres[mesh.faceNeighbour()[facei]] : acrossBoundary[facei - mesh.nInternalFaces()];
        triangulate(mesh.points(), mesh.faces()[facei], order, centres, ofFace);
        triangles.insert(triangles.end(), ofFace.begin(), ofFace.end());
        start.push_back(static_cast<int>(triangles.size()));
    }
}

} // namespace flotsam
