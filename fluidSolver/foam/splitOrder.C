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

/// Parity of the number of layers between a point and the first one, on shortest paths along edges: each point follows the neighbour of the
/// smallest key among those that were reached before it, on any number of processes the same. Parts of the mesh that are not joined begin anew.
class LayerParity
{
public:
    LayerParity(const polyMesh& mesh, const labelList& keys, int vertical)
    :   mesh_(mesh), keys_(keys), vertical_(vertical), parity_(mesh.nPoints(), -1), offer_(mesh.nPoints(), labelMax)
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
            for (const label j : mesh_.pointPoints()[i])
            {
                if (parity_[j] >= 0) continue;
                if (offer_[j] == labelMax) touched.push_back(j);
                offer_[j] = min(offer_[j], 2*keys_[i] + (parity_[i] ^ label(leadsAcross(i, j))));
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

    bool leadsAcross(label i, label j) const
    {
        const vector edge = mesh_.points()[j] - mesh_.points()[i];
        return mag(edge[vertical_]) > acrossLayers*mag(edge);
    }

    const polyMesh& mesh_;
    const labelList& keys_;
    const int vertical_;
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
