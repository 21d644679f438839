// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/facingElements.hpp"

#include "core/roomyVector.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

constexpr int nRings = 3;               // around the elements that the surface may pass: the level farther away (spray, traces of alpha) is of no use
constexpr double possible = 0.1;        // least alpha, or 1 - alpha, of such an element
constexpr double lastChoice = 1e-12;    // weight of elements whose level is known at some nodes only: no others, or they do not count

bool isInBand(double alpha) { return alpha > lowestOfBand && alpha < highestOfBand; }

} // namespace

template<int D>
void FacingElements<D>::findCandidates(const std::vector<double>& alpha, const Cover* cover)
{
    candidates_.clear();
    for (int e = 0; e < mesh_.nElements; ++e)
    {
        const int* nodes = &mesh_.elements[std::size_t(e)*N];
        if (cover && cover->state[e] == ElementState::Solid) continue;
        if (std::any_of(nodes, nodes + N, [&](int i) { return isInBand(alpha[i]); })) candidates_.push_back(e);
    }
}

/// isNear: positive at the nodes near elements that the surface may pass, by the ring that reached them.
template<int D>
void FacingElements<D>::markNearSurface(const std::vector<double>& alpha, std::vector<double>& isNear) const
{
    isNear.assign(mesh_.nNodes, 0.0);
    for (int e : candidates_)
    {
        const int* nodes = &mesh_.elements[std::size_t(e)*N];
        double least = 1, most = 0;
        for (int a = 0; a < N; ++a)
        {
            least = std::min(least, alpha[nodes[a]]);
            most = std::max(most, alpha[nodes[a]]);
        }
        if (most > possible && least < 1 - possible)
            for (int a = 0; a < N; ++a) isNear[nodes[a]] = 1;
    }
    for (int ring = 1; ring <= nRings; ++ring)
    {
        halo_.update(isNear, 1);
        for (int e : candidates_)
        {
            const int* nodes = &mesh_.elements[std::size_t(e)*N];
            if (std::none_of(nodes, nodes + N, [&](int i) { return isNear[i] > 0 && isNear[i] <= ring; })) continue;
            for (int a = 0; a < N; ++a)
                if (isNear[nodes[a]] == 0) isNear[nodes[a]] = ring + 1;
        }
    }
    halo_.update(isNear, 1);
}

template<int D>
void FacingElements<D>::addElement(int e, const std::vector<double>& alpha, const Cover* cover)
{
    const int* nodes = &mesh_.elements[std::size_t(e)*N];
    Element element{&mesh_.gradN[std::size_t(e)*N*D], 0, {}, {}};
    bool isKnown = true;
    double variation = 0;
    for (int a = 0; a < N; ++a)
    {
        const int i = nodes[a];
        isKnown = isKnown && isInBand(alpha[i]) && (!cover || cover->isActiveNode[i]);
        variation += alpha[i]*(1 - alpha[i]);
        if (local_[i] < 0)
        {
            local_[i] = int(node_.size());
            node_.push_back(i);
        }
        element.node[a] = i;
        element.local[a] = local_[i];
    }
    element.weight = variation*variation*mesh_.volume[e]*(isKnown ? 1 : lastChoice);
    elements_.push_back(element);
}

template<int D>
void FacingElements<D>::findElements(const std::vector<double>& alpha, const Cover* cover, const std::vector<double>& isNear)
{
    const auto isFacing = [&](int e)
    {
        const int* nodes = &mesh_.elements[std::size_t(e)*N];
        return std::any_of(nodes, nodes + N, [&](int i) { return isNear[i] > 0; });
    };
    elements_.clear();
    reserveRoom(elements_, std::count_if(candidates_.begin(), candidates_.end(), isFacing));
    local_.assign(mesh_.nNodes, -1);
    node_.clear();
    for (int e : candidates_)
        if (isFacing(e)) addElement(e, alpha, cover);
    band_.clear();
    for (int i = 0; i < mesh_.nOwned; ++i)
        if (isNear[i] > 0 && isInBand(alpha[i])) band_.push_back(i);
}

/// As at first: the whole band.
template<int D>
void FacingElements<D>::wantBand()
{
    reserveRoom(wanted_, node_.size());
    reserveRoom(acting_, elements_.size());
    reserveRoom(isWanted_, node_.size());
    isWanted_.assign(node_.size(), 0);
    wanted_.clear();
    acting_.clear();
    for (int i : band_) want(local_[i]);
    for (int e = 0; e < int(elements_.size()); ++e)
        if (std::any_of(elements_[e].local, elements_[e].local + N, [this](int l) { return isWanted_[l]; })) acting_.push_back(e);
}

template<int D>
void FacingElements<D>::find(const std::vector<double>& alpha, const Cover* cover, std::vector<double>& work)
{
    findCandidates(alpha, cover);
    markNearSurface(alpha, work);
    findElements(alpha, cover, work);
    reserveRoom(sums_, node_.size()*N);
    sums_.assign(node_.size()*N, 0.0);
    wantBand();
    areAroundListed_ = false;
}

template<int D>
void FacingElements<D>::sumGradients(const std::vector<double>& level)
{
    for (int l : wanted_) std::fill_n(sum(l), N, 0.0);
    for (int k : acting_)
    {
        const Element& e = elements_[k];
        double part[N] = {}, square = 0;
        for (int a = 0; a < N; ++a)
            for (int d = 0; d < D; ++d) part[d] += level[e.node[a]]*e.gradN[a*D + d];
        for (int d = 0; d < D; ++d) square += part[d]*part[d];
        part[D] = std::sqrt(square);
        for (int a = 0; a < N; ++a)
            for (int d = 0; d < N; ++d) sums_[std::size_t(e.local[a])*N + d] += e.weight*part[d];
    }
}

template<int D>
void FacingElements<D>::listElementsAround()
{
    reserveRoom(start_, node_.size() + 1);
    start_.assign(node_.size() + 1, 0);
    for (const Element& e : elements_)
        for (int l : e.local) ++start_[l];
    for (std::size_t l = 0; l < node_.size(); ++l) start_[l + 1] += start_[l];
    reserveRoom(around_, start_.back());
    around_.resize(start_.back());
    for (int e = int(elements_.size()) - 1; e >= 0; --e) // from the end of each place's, which become their starts
        for (int l : elements_[e].local) around_[--start_[l]] = e;
    reserveRoom(isActing_, elements_.size());
    isActing_.assign(elements_.size(), 0);
    areAroundListed_ = true;
}

template<int D>
void FacingElements<D>::wantNeighbours(const std::vector<int>& moved)
{
    if (!areAroundListed_) listElementsAround();
    for (int l : wanted_) isWanted_[l] = 0;
    wanted_.clear();
    for (int m : moved)
        for (int k = start_[m]; k < start_[m + 1]; ++k)
            for (int l : elements_[around_[k]].local) want(l);
    for (int l : wanted_)
        for (int k = start_[l]; k < start_[l + 1]; ++k) isActing_[around_[k]] = 1;
    acting_.clear();
    for (int e = 0; e < int(elements_.size()); ++e)
    {
        if (!isActing_[e]) continue;
        isActing_[e] = 0;
        acting_.push_back(e);
    }
}

template class FacingElements<2>;
template class FacingElements<3>;

} // namespace flotsam
