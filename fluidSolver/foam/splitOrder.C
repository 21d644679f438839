// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/splitOrder.H"

#include "globalMeshData.H"
#include "syncTools.H"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <tuple>
#include <vector>

using namespace Foam;

namespace flotsam
{
namespace
{

/// Share of an edge's length across the vertical's layers from which it leads into the next one.
constexpr scalar acrossLayers = 0.5;

/// Of the second horizontal axis in the direction within a layer: far from 0 and 1, so that moved nodes do not change which corner of a face comes first.
constexpr scalar second = 0.6;

/// Cosine of the angle between the edges on both sides of a point from which they count as one edge that the point divides.
constexpr scalar straight = 0.9;

bool leadsAcross(const polyMesh& mesh, int vertical, label i, label j)
{
    const vector edge = mesh.points()[j] - mesh.points()[i];
    return mag(edge[vertical]) > acrossLayers*mag(edge);
}

/// Does a face have the edges p-v and v-n as one edge across the layers, divided at v (a hanging point, of finer cells beside it)?
bool isDivided(const polyMesh& mesh, int vertical, label p, label v, label n)
{
    const pointField& x = mesh.points();
    const vector in = x[v] - x[p], out = x[n] - x[v];
    return leadsAcross(mesh, vertical, p, v) && leadsAcross(mesh, vertical, v, n) && (in & out) > straight*mag(in)*mag(out);
}

/// Edges along which no layers can be counted: they lead from finer cells, with twice the layers, into coarser ones. These are the edges of cells
/// with a divided edge that meet this edge.
boolList findStepsOfSize(const polyMesh& mesh, int vertical)
{
    boolList isStep(mesh.nEdges(), false);
    std::vector<label> chain;
    forAll(mesh.cells(), c)
    {
        chain.clear();
        for (const label facei : mesh.cells()[c])
        {
            const face& f = mesh.faces()[facei];
            forAll(f, k)
                if (isDivided(mesh, vertical, f.prevLabel(k), f[k], f.nextLabel(k))) chain.insert(chain.end(), {f.prevLabel(k), f[k], f.nextLabel(k)});
        }
        if (chain.empty()) continue;
        const auto isInChain = [&](label i) { return std::find(chain.begin(), chain.end(), i) != chain.end(); };
        for (const label e : mesh.cellEdges()[c])
        {
            const edge& ends = mesh.edges()[e];
            if (isInChain(ends[0]) != isInChain(ends[1])) isStep[e] = true;
        }
    }
    syncTools::syncEdgeList(mesh, isStep, orEqOp<bool>(), false);
    return isStep;
}

/// An even number below 2^53 made of a point's place alone: whoever numbers the points, and on whatever processes they are, it is the same.
scalar placeNumber(const point& x)
{
    std::uint64_t number = 0;
    for (int d = 0; d < 3; ++d)
    {
        const double value = x[d] + 0.0;    // -0 and 0 are one place
        std::uint64_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        number = (number ^ bits)*0x9e3779b97f4a7c15u;  // multiplicative hashing, the high bits down again (Knuth)
        number ^= number >> 32;
    }
    return scalar(number >> 12 << 1);   // syncTools knows scalars
}

/// Parity of the number of layers between a point and the first one, on shortest paths along edges: each point follows the neighbour of the
/// smallest number of its place among those that were reached before it. The first one is the lowest; parts of the mesh that are not joined, or only by steps of the
/// cells' size, begin anew.
class LayerParity
{
public:
    LayerParity(const polyMesh& mesh, int vertical)
    :   mesh_(mesh), vertical_(vertical), isStep_(findStepsOfSize(mesh, vertical)), parity_(mesh.nPoints(), -1), offer_(mesh.nPoints(), none)
    {
        while (startPart()) while (advance()) {}
    }

    const labelList& parity() const { return parity_; }

private:
    static constexpr scalar none = VGREAT;

    /// From the lowest point that has not been reached; of several the first by the other axes.
    bool startPart()
    {
        const int axes[] = {vertical_, (vertical_ + 1) % 3, (vertical_ + 2) % 3};
        front_.clear();
        forAll(parity_, i)
            if (parity_[i] < 0) front_.push_back(i);
        for (const int axis : axes)
        {
            scalar lowest = VGREAT;
            for (const label i : front_) lowest = min(lowest, mesh_.points()[i][axis]);
            reduce(lowest, minOp<scalar>());
            front_.erase(std::remove_if(front_.begin(), front_.end(), [&](label i) { return mesh_.points()[i][axis] > lowest; }), front_.end());
        }
        for (const label i : front_) parity_[i] = 0;
        return returnReduce(!front_.empty(), orOp<bool>());
    }

    /// One step from the front to its neighbours.
    bool advance()
    {
        std::vector<label> touched;
        for (const label i : front_)
            for (const label e : mesh_.pointEdges()[i])
            {
                const label j = mesh_.edges()[e].otherVertex(i);
                if (parity_[j] >= 0 || isStep_[e]) continue;
                if (offer_[j] == none) touched.push_back(j);
                offer_[j] = min(offer_[j], placeNumber(mesh_.points()[i]) + scalar(parity_[i] ^ label(leadsAcross(mesh_, vertical_, i, j))));
            }
        if (Pstream::parRun())
        {
            syncTools::syncPointList(mesh_, offer_, minEqOp<scalar>(), none);
            for (const label i : mesh_.globalData().coupledPatch().meshPoints())
                if (offer_[i] != none) touched.push_back(i);
        }
        front_.clear();
        for (const label i : touched)
        {
            if (offer_[i] == none) continue;    // twice among them: shared with another process
            parity_[i] = label(std::int64_t(offer_[i]) & 1);
            offer_[i] = none;
            front_.push_back(i);
        }
        return returnReduce(!front_.empty(), orOp<bool>());
    }

    const polyMesh& mesh_;
    const int vertical_;
    const boolList isStep_;
    labelList parity_;
    scalarList offer_;      // number of the place it comes from, plus the parity
    std::vector<label> front_;
};

} // namespace

labelList splitOrder(const polyMesh& mesh, const labelList& keys, int vertical)
{
    const LayerParity layers(mesh, vertical);
    const labelList& parity = layers.parity();
    const int a = (vertical + 1) % 3, b = (vertical + 2) % 3;
    std::vector<std::tuple<label, scalar, scalar, scalar, label>> rank;
    forAll(parity, i)
    {
        const point& x = mesh.points()[i];
        rank.emplace_back(parity[i], x[min(a, b)] + (parity[i] ? -second : second)*x[max(a, b)], x[vertical], x[a], keys[i]);
    }
    std::vector<label> sorted(rank.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) sorted[i] = label(i);
    std::sort(sorted.begin(), sorted.end(), [&](label i, label j) { return rank[i] < rank[j]; });
    labelList order(mesh.nPoints());
    for (std::size_t k = 0; k < sorted.size(); ++k) order[sorted[k]] = label(k);
    return order;
}

} // namespace flotsam
