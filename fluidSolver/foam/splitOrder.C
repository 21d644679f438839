// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/splitOrder.H"

#include "globalMeshData.H"
#include "syncTools.H"

#include <algorithm>
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

/// Parity of the number of layers between a point and the first one, on shortest paths along edges: each point follows the neighbour of the
/// smallest key among those that were reached before it, on any number of processes the same. Parts of the mesh that are not joined, or only by steps of the cells'
/// size, begin anew.
class LayerParity
{
public:
    LayerParity(const polyMesh& mesh, const labelList& keys, int vertical)
    :   mesh_(mesh), keys_(keys), vertical_(vertical), isStep_(findStepsOfSize(mesh, vertical)), parity_(mesh.nPoints(), -1),
        offer_(mesh.nPoints(), labelMax)
    {
        while (startPart()) while (advance()) {}
    }

    const labelList& parity() const { return parity_; }

private:
    /// From the point of the smallest key that has not been reached.
    bool startPart()
    {
        label first = labelMax;
        forAll(parity_, i)
            if (parity_[i] < 0) first = min(first, keys_[i]);
        reduce(first, minOp<label>());
        front_.clear();
        forAll(parity_, i)
            if (keys_[i] == first && parity_[i] < 0)
            {
                parity_[i] = 0;
                front_.push_back(i);
            }
        return first != labelMax;
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
                if (offer_[j] == labelMax) touched.push_back(j);
                offer_[j] = min(offer_[j], 2*keys_[i] + (parity_[i] ^ label(leadsAcross(mesh_, vertical_, i, j))));
            }
        if (Pstream::parRun())
        {
            syncTools::syncPointList(mesh_, offer_, minEqOp<label>(), labelMax);
            for (const label i : mesh_.globalData().coupledPatch().meshPoints())
                if (offer_[i] != labelMax) touched.push_back(i);
        }
        front_.clear();
        for (const label i : touched)
        {
            if (offer_[i] == labelMax) continue;    // twice among them: shared with another process
            parity_[i] = offer_[i] & 1;
            offer_[i] = labelMax;
            front_.push_back(i);
        }
        return returnReduce(!front_.empty(), orOp<bool>());
    }

    const polyMesh& mesh_;
    const labelList& keys_;
    const int vertical_;
    const boolList isStep_;
    labelList parity_, offer_;      // offer: twice the key it comes from, and the parity
    std::vector<label> front_;
};

} // namespace

labelList splitOrder(const polyMesh& mesh, const labelList& keys, int vertical)
{
    const LayerParity layers(mesh, keys, vertical);
    const labelList& parity = layers.parity();
    const int a = (vertical + 1) % 3, b = (vertical + 2) % 3;
    std::vector<std::tuple<label, scalar, label>> rank;
    forAll(parity, i)
    {
        const point& x = mesh.points()[i];
        rank.emplace_back(parity[i], x[min(a, b)] + (parity[i] ? -second : second)*x[max(a, b)], keys[i]);
    }
    std::vector<label> sorted(rank.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) sorted[i] = label(i);
    std::sort(sorted.begin(), sorted.end(), [&](label i, label j) { return rank[i] < rank[j]; });
    labelList order(mesh.nPoints());
    for (std::size_t k = 0; k < sorted.size(); ++k) order[sorted[k]] = label(k);
    return order;
}

} // namespace flotsam
