// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/solidExtension.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace flotsam
{

namespace
{

/// Rings around the known nodes, one after the other.
class Rings
{
public:
    /// isKnown: right for owned nodes.
    Rings(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const std::vector<char>& isKnown, std::vector<double>& values, int width, RingWork& work)
    :   mesh_(mesh), graph_(graph), halo_(halo), values_(values), width_(width), entry_(width + 1), state_(work.state), left_(work.left), found_(work.found), means_(work.means)
    {
        state_.resize(std::size_t(mesh.nNodes)*entry_);
        left_.clear();
        for (int i = 0; i < mesh.nOwned; ++i)
            if (!isKnown[i]) left_.push_back(i);
        areLeft_ = halo.any(!left_.empty());
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            std::copy_n(&values[std::size_t(i)*width], width, &state_[std::size_t(i)*entry_]);
            state_[std::size_t(i)*entry_ + width] = isKnown[i] ? 1 : 0;
        }
        if (areLeft_) halo_.update(state_, entry_); // a second-ring copy may not see the fluid element that makes it active
    }

    bool areLeft() const { return areLeft_; }
    bool has(int i) const { return state_[std::size_t(i)*entry_ + width_] != 0; }

    /// The nodes beside those that are known by now.
    void extend()
    {
        found_.clear();
        std::size_t kept = 0;
        for (const int i : left_)
            if (!takeMean(i)) left_[kept++] = i;
        left_.resize(kept);
        const double* mean = means_.data();
        for (const int i : found_)
        {
            std::copy_n(mean, width_, &state_[std::size_t(i)*entry_]);
            state_[std::size_t(i)*entry_ + width_] = 1;
            mean += width_;
        }
        halo_.update(state_, entry_);
    }

    void write()
    {
        for (int i = 0; i < mesh_.nNodes; ++i)
            if (has(i)) std::copy_n(&state_[std::size_t(i)*entry_], width_, &values_[std::size_t(i)*width_]);
    }

private:
    bool takeMean(int i)
    {
        means_.resize((found_.size() + 1)*width_);
        double *sum = &means_[found_.size()*width_], count = 0;
        std::fill_n(sum, width_, 0.0);
        for (int k = graph_.rowStart[i]; k < graph_.rowStart[i + 1]; ++k)
        {
            const double* neighbour = &state_[std::size_t(graph_.column[k])*entry_];
            if (neighbour[width_] == 0) continue;
            for (int w = 0; w < width_; ++w) sum[w] += neighbour[w];
            count += 1;
        }
        if (count == 0) return false;
        for (int w = 0; w < width_; ++w) sum[w] /= count;
        found_.push_back(i);
        return true;
    }

    const SimplexMesh& mesh_;
    const NodeGraph& graph_;
    const Halo& halo_;
    std::vector<double>& values_;
    int width_, entry_;             // entry: values and 1 where they are known, so that one exchange a ring keeps both right on the copies
    std::vector<double>& state_;
    bool areLeft_;
    std::vector<int> &left_, &found_;   // owned nodes
    std::vector<double>& means_;        // of found_
};

void extendAround(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const std::vector<char>& isKnown, std::vector<double>& values, RingWork& work, int nRings)
{
    Rings rings(mesh, graph, halo, isKnown, values, 1, work);
    if (!rings.areLeft()) return;
    for (int ring = 0; ring < nRings; ++ring) rings.extend();
    rings.write();
}

} // namespace

void extendIntoSolids(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const Cover& cover,
    std::vector<double>& alpha, RingWork& work, int nRings)
{
    extendAround(mesh, graph, halo, cover.isActiveNode, alpha, work, nRings);
}

void extendIntoSolids(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const Cover& cover,
    std::vector<double>& alpha, int nRings)
{
    RingWork work;
    extendIntoSolids(mesh, graph, halo, cover, alpha, work, nRings);
}

void extendIntoSolids(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const std::vector<char>& isKnown,
    std::vector<double>& values, int nRings)
{
    RingWork work;
    extendAround(mesh, graph, halo, isKnown, values, work, nRings);
}

void extendTo(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const std::vector<char>& isKnown, const std::vector<int>& isWanted,
    std::vector<double>& values, int width)
{
    RingWork work;
    Rings rings(mesh, graph, halo, isKnown, values, width, work);
    const auto isMissing = [&]
    {
        for (int i = 0; i < mesh.nOwned; ++i)
            if (isWanted[i] && !rings.has(i)) return true;
        return false;
    };
    for (long ring = 0; ring < mesh.nGlobal && halo.any(isMissing()); ++ring) rings.extend();
    rings.write();
}

void takeFromFluidBeside(const SimplexMesh& mesh, const Halo& halo, const Cover& cover, const std::vector<char>& isWanted,
    std::vector<double>& values)
{
    const int n = mesh.dim + 1;
    std::map<int, std::array<double, 2>> found; // sums of values and of weights
    for (const CutElement& cut : cover.cuts)
    {
        const int* nodes = &mesh.elements[std::size_t(cut.element)*n];
        const auto isFluid = [&](int a) { return cover.distance[nodes[a]] > 0; };
        for (int a = 0; a < n; ++a)
        {
            if (nodes[a] >= mesh.nOwned || isFluid(a) || !isWanted[nodes[a]]) continue;
            std::array<double, 2>& sums = found[nodes[a]];
            for (int b = 0; b < n; ++b)
            {
                if (!isFluid(b)) continue;
                sums[0] += cut.first[b]*values[nodes[b]];
                sums[1] += cut.first[b];
            }
        }
    }
    if (!halo.any(!found.empty())) return;
    for (const auto& [node, sums] : found)
        if (sums[1] > 0) values[node] = sums[0]/sums[1];
    halo.update(values, 1);
}

} // namespace flotsam
