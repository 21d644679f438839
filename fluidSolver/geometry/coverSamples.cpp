// SPDX-License-Identifier: GPL-3.0-or-later
/// CoverBuilder: distances of the nodes from the solids.
#include "geometry/coverBuilder.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

/// Of a structure's size: distance of a face from the mesh's boundary, or of a node from the face, that is none.
constexpr double flush = 1e-9;

/// Of a node in the solid or on it: faces that lie beyond the mesh are none to it, unless there are no others.
void leaveOut(unsigned beyond, double onFace, double* distances, int n)
{
    if (*std::max_element(distances, distances + n) > onFace || beyond == (1u << n) - 1) return;
    for (int f = 0; f < n; ++f)
        if (beyond >> f & 1) distances[f] = -farDistance;
}

} // namespace

/// Faces of a structure at rest that lie beyond the mesh or on its boundary, as bits: the foot of a pier that stands on the bed. The distances at the nodes must not know them: a node of the
/// bed would be as near to the surface as the pier reaches below the bed, and between two solids, where the cut is linear, water would get under the foot. Of a moving
/// structure they are known, as what they sweep must not jump. Distances from faces are convex: the corners of what the mesh's box and the structure's have in common tell.
unsigned CoverBuilder::facesBeyond(const Solid& solid, int number) const
{
    double distances[maxFaces];
    if (!solid.isCutOnce() || solid.shape->part(number).faceDistances(Vec3::Zero(), distances) == 0) return 0;
    Solid plain = solid; // not by the offsets, which would move the foot of a pier off the bed
    plain.offset = 0;
    plain.offsetSlope.setZero();
    const SolidPart part(plain, number);
    auto [low, high] = part.spaceBounds();
    const double size = (high - low).norm(), tolerance = flush * size;
    low.array() -= 0.01 * size; // beyond the structure's own faces
    high.array() += 0.01 * size;
    for (int d = 0; d < 3; ++d)
    {
        const int k = mesh_.axes[d];
        low[k] = d < mesh_.dim ? std::max(low[k], lower_[d]) : mesh_.planeOffset;
        high[k] = d < mesh_.dim ? std::min(high[k], upper_[d]) : mesh_.planeOffset;
        if (low[k] > high[k]) return 0;
    }
    unsigned beyond = ~0u;
    for (int corner = 0; corner < 8; ++corner)
    {
        const Vec3 x(corner & 1 ? low[0] : high[0], corner & 2 ? low[1] : high[1], corner & 4 ? low[2] : high[2]);
        const int n = part.faceDistances(x, distances);
        for (int f = 0; f < n; ++f)
            if (distances[f] > tolerance) beyond &= ~(1u << f);
        beyond &= (1u << n) - 1;
    }
    return beyond;
}

/// Of one part after the other.
void CoverBuilder::sample(const Solid& solid, std::vector<Sample>& samples) const
{
    samples.clear();
    const int n = solid.shape->nParts();
    for (int number = 0; number < n; ++number) samplePart(solid, number, samples);
    if (n == 1) return;
    for (const Sample& s : samples) partsAt_[s.node] = static_cast<char>(std::min(partsAt_[s.node] + 1, 2));
    for (Sample& s : samples)
        if (partsAt_[s.node] > 1) s.face = s.filmFace = severalParts;
    for (const Sample& s : samples) partsAt_[s.node] = 0;
}

void CoverBuilder::samplePart(const Solid& solid, int number, std::vector<Sample>& samples) const
{
    const SolidPart part(solid, number);
    const Eigen::Matrix3d toBody = solid.pose.orientation.toRotationMatrix().transpose();
    const auto [lower, upper] = part.shape().bounds();
    const Vec3 position = solid.pose.position;
    const double outward = solid.offsetBound();
    const unsigned beyond = facesBeyond(solid, number);
    const int firstFace = number * maxFaces;
    const double onFace = flush * (upper - lower).norm();
    const Vec3 far = Vec3::Constant(farDistance);
    bins_.forEachNear(isNeedless_ ? std::array<Vec3, 2>{-far, far} : part.spaceBounds(), [&](int node, const Vec3& x)
    {
        const Vec3 y = toBody * (x - position);
        const double outside = (lower - y).cwiseMax(y - upper).cwiseMax(0.0).norm();
        const double limit = bins_.reach(node) + outward;
        if (outside > limit && !isNeedless_) return;
        double faces[maxFaces];
        const int nFaces = part.plainFaceDistances(x, faces);
        if (beyond != 0) leaveOut(beyond, onFace, faces, nFaces);
        film_.join(node, part, nFaces, faces);
        const double* nearest = std::max_element(faces, faces + nFaces);
        const double d = nFaces > 0 ? *nearest : film_.joined(node, part, part.plainDistance(x));
        if (d > limit) return;
        const int face = firstFace + static_cast<int>(nearest - faces);
        Sample sample{node, number, face, face, d, noFilm};
        if (nFaces == 0) sample.film = film_.thickness(node, part);
        else
        {
            // offsets, still to come, may bring faces nearer to the wall: cutDistance() takes what is larger
            sample.film = film_.lift(node, part, nFaces, faces, 2 * largestOffset);
            sample.filmFace = firstFace + static_cast<int>(std::max_element(faces, faces + nFaces) - faces);
        }
        samples.push_back(sample);
    });
}

void CoverBuilder::sampleMovingSolids(const std::vector<Solid>& solids)
{
    samples_.resize(solids.size());
    for (std::size_t s = 0; s < solids.size(); ++s)
        if (!solids[s].isCutOnce()) sample(solids[s], samples_[s]);
}

double CoverBuilder::cutDistance(const Solid& solid, const Sample& sample) const
{
    const auto x = mesh_.spacePoint(sample.node);
    const double distance = snapped(sample.distance - SolidPart(solid, sample.part).offsetAt(Vec3(x[0], x[1], x[2])), snap_[sample.node]);
    return std::max(distance, sample.film);
}

void CoverBuilder::applySamples(Cover& cover, const std::vector<Solid>& solids, int solid, const std::vector<Sample>& samples)
{
    for (const Sample& s : samples)
    {
        const double d = cutDistance(solids[solid], s);
        if (const double share = film_.share(s.node, solids[solid], d); share > 0) cover.filmNodes.push_back({s.node, share});
        if (d < cover.distance[s.node])
        {
            cover.distance[s.node] = d;
            cover.nearestSolid[s.node] = solid;
            face_[s.node] = cutFace(s, d);
        }
    }
}

} // namespace flotsam
