// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/faceFan.H"

#include "syncTools.H"

#include <algorithm>
#include <vector>

using namespace Foam;

namespace flotsam
{
namespace
{

/// Twice the area vector of the triangle at positions start, start+i, start+i+1, walked in direction step (1 or n-1).
vector triangleArea(const pointField& points, const face& f, label start, label step, label i)
{
    const label n = f.size();
    const point& apex = points[f[start]];
    return (points[f[(start + i * step) % n]] - apex) ^ (points[f[(start + (i + 1) * step) % n]] - apex);
}

scalar worstTriangle(const pointField& points, const face& f, label start, label step, const vector& area)
{
    scalar worst = VGREAT;
    for (label i = 1; i + 1 < f.size(); ++i)
    {
        worst = min(worst, triangleArea(points, f, start, step, i) & area);
    }
    return worst / (magSqr(area) + VSMALL);
}

vector areaOf(const pointField& points, const face& f, label start, label step)
{
    vector area(Zero);
    for (label i = 1; i + 1 < f.size(); ++i)
    {
        area += triangleArea(points, f, start, step, i);
    }
    return area;
}

/// Fans of one face from several starts are compared with this margin, so that round-off does not decide.
constexpr scalar tieMargin = 1e-6;

label bestStart(const pointField& points, const face& f, const labelList& order, label first, label step, label nTried)
{
    const label n = f.size();
    const vector area = areaOf(points, f, first, step);
    label best = first;
    scalar bestQuality = -VGREAT;
    for (label s = 0; s < nTried; ++s)
    {
        const label start = (first + s * step) % n;
        const scalar quality = worstTriangle(points, f, start, step, area);
        const bool isTied = quality > bestQuality - tieMargin && order[f[start]] < order[f[best]];
        if (quality > bestQuality + tieMargin || isTied)
        {
            bestQuality = max(bestQuality, quality);
            best = start;
        }
    }
    return best;
}

/// Highest order of a point that only two faces of the cell hold, per face; -1 where there is none.
void markThinPoints(const polyMesh& mesh, const labelList& order, labelList& thin)
{
    const faceList& faces = mesh.faces();
    std::vector<label> cellPoints;
    for (const cell& c : mesh.cells())
    {
        cellPoints.clear();
        for (const label facei : c)
        {
            cellPoints.insert(cellPoints.end(), faces[facei].begin(), faces[facei].end());
        }
        std::sort(cellPoints.begin(), cellPoints.end());
        for (auto i = cellPoints.begin(); i != cellPoints.end();)
        {
            const label pointi = *i;
            const auto end = std::upper_bound(i, cellPoints.end(), pointi);
            if (end - i == 2)
            {
                for (const label facei : c)
                {
                    if (faces[facei].size() > 3 && faces[facei].found(pointi))
                    {
                        thin[facei] = max(thin[facei], order[pointi]);
                    }
                }
            }
            i = end;
        }
    }
}

void syncBoundary(const polyMesh& mesh, labelList& thin)
{
    const label nInternal = mesh.nInternalFaces();
    labelList boundary(mesh.nFaces() - nInternal);
    forAll(boundary, i)
    {
        boundary[i] = thin[nInternal + i];
    }
    syncTools::syncBoundaryFaceList(mesh, boundary, maxEqOp<label>());
    forAll(boundary, i)
    {
        thin[nInternal + i] = boundary[i];
    }
}

} // namespace

label fanStart(const pointField& points, const face& f, const labelList& order)
{
    const label n = f.size();
    label first = 0;
    for (label i = 1; i < n; ++i)
    {
        first = order[f[i]] < order[f[first]] ? i : first;
    }
    if (n <= 3)
    {
        return first;
    }
    // the two cells of a face see it in opposite directions: always walk towards the lower neighbour
    const label step = order[f[(first + 1) % n]] < order[f[(first + n - 1) % n]] ? 1 : n - 1;
    constexpr scalar goodQuad = 0.05;
    if (n == 4 && worstTriangle(points, f, first, step, areaOf(points, f, first, step)) > goodQuad)
    {
        return first;
    }
    return bestStart(points, f, order, first, step, n == 4 ? 2 : n);
}

scalar worstTriangle(const pointField& points, const face& f, label start)
{
    return worstTriangle(points, f, start, 1, areaOf(points, f, start, 1));
}

labelList fanStarts(const polyMesh& mesh, const labelList& order)
{
    labelList thin(mesh.nFaces(), -1), fan(mesh.nFaces());
    markThinPoints(mesh, order, thin);
    syncBoundary(mesh, thin);
    forAll(fan, facei)
    {
        const face& f = mesh.faces()[facei];
        fan[facei] = fanStart(mesh.points(), f, order);
        for (label i = 0; i < f.size() && thin[facei] >= 0; ++i)
        {
            fan[facei] = order[f[i]] == thin[facei] ? i : fan[facei];
        }
    }
    return fan;
}

} // namespace flotsam
