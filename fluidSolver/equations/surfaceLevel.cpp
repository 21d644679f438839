// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/surfaceLevel.hpp"

#include "equations/profileMeans.hpp"
#include "geometry/cover.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

/// As far out as nodes of cut elements lie: up to 1.1 h from the surface on slanted triangles, 1.7 h in tetrahedra, farther beside smaller elements, whose size is in the
/// tetrahedra, and a level cut off there tilts the element's plane.
constexpr double lowest = 1e-5, highest = 1 - lowest;

constexpr int mostRepeats = 12, patience = 3;
constexpr double stubborn = 0.7;        // change over the last one from which a node does not converge (sheets, corners): it is not waited for
constexpr int nRings = 3;               // around the elements that the surface may pass: the level farther away (spray, traces of alpha) is of no use
constexpr double possible = 0.1;        // least alpha, or 1 - alpha, of such an element
constexpr double lastChoice = 1e-12;    // weight of elements whose level is known at some nodes only: no others, or they do not count

bool isInBand(double alpha) { return alpha > lowest && alpha < highest; }

/// Elements with a say in the surface's direction at their nodes, and these nodes.
template<int D>
struct FacingElements
{
    static constexpr int N = D + 1;
    struct Element { const double* gradN; double weight; int node[N], local[N]; };

    std::vector<Element> elements;
    std::vector<int> local;     ///< per mesh node: its place in sums, -1: none
    std::vector<int> node;      ///< the other way round
    std::vector<int> band;      ///< owned nodes whose level is sought
    std::vector<double> sums;   ///< around each wanted node: weighted gradients of the level, D, and their lengths
    std::vector<char> isWanted; ///< per place in sums

    FacingElements(const SimplexMesh& mesh, const Halo& halo, const std::vector<double>& alpha, const Cover* cover);
    void sumGradients(const std::vector<double>& level);
    void wantNeighbours(const std::vector<int>& moved);

private:
    std::vector<int> wanted_;           // places in sums
    std::vector<int> acting_;           // elements with wanted nodes, ascending: sums are the same to the last bit whoever else acts
    std::vector<char> isActing_;        // per element
    std::vector<int> start_, around_;   // elements of each place in sums, from the second repeat on

    void want(int place) { if (!isWanted[place]) { isWanted[place] = 1; wanted_.push_back(place); } }
    void listElementsAround();
};

/// Positive at the nodes near elements that the surface may pass: see nRings. Elements: those with nodes in the band.
std::vector<double> nearSurface(const SimplexMesh& mesh, const Halo& halo, const std::vector<double>& alpha, const std::vector<int>& elements)
{
    const int n = mesh.dim + 1;
    std::vector<double> isNear(mesh.nNodes, 0.0), next;
    for (int e : elements)
    {
        const int* nodes = &mesh.elements[std::size_t(e)*n];
        double least = 1, most = 0;
        for (int a = 0; a < n; ++a)
        {
            least = std::min(least, alpha[nodes[a]]);
            most = std::max(most, alpha[nodes[a]]);
        }
        if (most > possible && least < 1 - possible)
            for (int a = 0; a < n; ++a) isNear[nodes[a]] = 1;
    }
    for (int ring = 0; ring < nRings; ++ring)
    {
        halo.update(isNear, 1);
        next = isNear;
        for (int e : elements)
        {
            const int* nodes = &mesh.elements[std::size_t(e)*n];
            if (std::any_of(nodes, nodes + n, [&](int i) { return isNear[i] > 0; }))
                for (int a = 0; a < n; ++a) next[nodes[a]] = 1;
        }
        isNear.swap(next);
    }
    halo.update(isNear, 1);
    return isNear;
}

std::vector<int> bandElements(const SimplexMesh& mesh, const std::vector<double>& alpha, const Cover* cover)
{
    const int n = mesh.dim + 1;
    std::vector<int> result;
    for (int e = 0; e < mesh.nElements; ++e)
    {
        const int* nodes = &mesh.elements[std::size_t(e)*n];
        if (cover && cover->state[e] == ElementState::Solid) continue;
        if (std::any_of(nodes, nodes + n, [&](int i) { return isInBand(alpha[i]); })) result.push_back(e);
    }
    return result;
}

template<int D>
FacingElements<D>::FacingElements(const SimplexMesh& mesh, const Halo& halo, const std::vector<double>& alpha, const Cover* cover)
:   local(mesh.nNodes, -1)
{
    const std::vector<int> candidates = bandElements(mesh, alpha, cover);
    const std::vector<double> isNear = nearSurface(mesh, halo, alpha, candidates);
    elements.reserve(candidates.size());
    for (int e : candidates)
    {
        const int* nodes = &mesh.elements[std::size_t(e)*N];
        if (std::none_of(nodes, nodes + N, [&](int i) { return isNear[i] > 0; })) continue;
        Element element{&mesh.gradN[std::size_t(e)*N*D], 0, {}, {}};
        bool isKnown = true;
        double variation = 0;
        for (int a = 0; a < N; ++a)
        {
            const int i = nodes[a];
            isKnown = isKnown && isInBand(alpha[i]) && (!cover || cover->isActiveNode[i]);
            variation += alpha[i]*(1 - alpha[i]);
            if (local[i] < 0)
            {
                local[i] = int(node.size());
                node.push_back(i);
            }
            element.node[a] = i;
            element.local[a] = local[i];
        }
        element.weight = variation*variation*mesh.volume[e]*(isKnown ? 1 : lastChoice);
        elements.push_back(element);
    }
    for (int i = 0; i < mesh.nOwned; ++i)
        if (isNear[i] > 0 && isInBand(alpha[i])) band.push_back(i);
    sums.resize(node.size()*N);
    wanted_.reserve(node.size());
    acting_.reserve(elements.size());
    isWanted.assign(node.size(), 0);
    for (int i : band) want(local[i]);
    for (int e = 0; e < int(elements.size()); ++e)
        if (std::any_of(elements[e].local, elements[e].local + N, [this](int l) { return isWanted[l]; })) acting_.push_back(e);
}

template<int D>
void FacingElements<D>::sumGradients(const std::vector<double>& level)
{
    for (int l : wanted_) std::fill_n(&sums[std::size_t(l)*N], N, 0.0);
    for (int k : acting_)
    {
        const Element& e = elements[k];
        double part[N] = {}, square = 0;
        for (int a = 0; a < N; ++a)
            for (int d = 0; d < D; ++d) part[d] += level[e.node[a]]*e.gradN[a*D + d];
        for (int d = 0; d < D; ++d) square += part[d]*part[d];
        part[D] = std::sqrt(square);
        for (int a = 0; a < N; ++a)
            for (int d = 0; d < N; ++d) sums[std::size_t(e.local[a])*N + d] += e.weight*part[d];
    }
}

template<int D>
void FacingElements<D>::listElementsAround()
{
    start_.assign(node.size() + 1, 0);
    for (const Element& e : elements)
        for (int l : e.local) ++start_[l + 1];
    for (std::size_t l = 0; l < node.size(); ++l) start_[l + 1] += start_[l];
    around_.resize(start_.back());
    std::vector<int> next(start_.begin(), start_.end() - 1);
    for (int e = 0; e < int(elements.size()); ++e)
        for (int l : elements[e].local) around_[next[l]++] = e;
    isActing_.assign(elements.size(), 0);
}

/// Wanted are the nodes of elements with a node that has moved (places in sums). In spray a few nodes never come to rest: from the
/// sixth repeat on a tenth of the elements acts and less.
template<int D>
void FacingElements<D>::wantNeighbours(const std::vector<int>& moved)
{
    if (start_.empty()) listElementsAround();
    for (int l : wanted_) isWanted[l] = 0;
    wanted_.clear();
    for (int m : moved)
        for (int k = start_[m]; k < start_[m + 1]; ++k)
            for (int l : elements[around_[k]].local) want(l);
    for (int l : wanted_)
        for (int k = start_[l]; k < start_[l + 1]; ++k) isActing_[around_[k]] = 1;
    acting_.clear();
    for (int e = 0; e < int(elements.size()); ++e)
    {
        if (!isActing_[e]) continue;
        isActing_[e] = 0;
        acting_.push_back(e);
    }
}

double thicknessInWidths(const DualCells& cells, int i, const double* normal, double width)
{
    return 2*cells.halfWidth(i, normal)/width;
}

double centroidHeight(const DualCells& cells, int i, const double* normal, int dim)
{
    double result = 0;
    for (int d = 0; d < dim; ++d) result += normal[d]*cells.centroid(i)[d];
    return result;
}

struct Slabs { std::vector<double> share, mean, level; };   // of the wanted nodes

/// The level of the wanted nodes of the band from the sums around them; wanted: their places in the band. The sums become unit vectors.
template<int D>
const std::vector<double>& levelsOf(const std::vector<int>& wanted, FacingElements<D>& facing, const std::vector<double>& alpha, const std::vector<double>& width,
    const DualCells& cells, const std::vector<double>& atNode, Slabs& work)
{
    std::vector<double> &shares = work.share, &means = work.mean, &slabs = work.level;
    for (std::vector<double>* v : {&shares, &means, &slabs}) v->resize(wanted.size());
    for (std::size_t m = 0; m < wanted.size(); ++m)
    {
        const int i = facing.band[wanted[m]];
        double* sum = &facing.sums[std::size_t(facing.local[i])*(D + 1)], length = 0;
        for (int d = 0; d < D; ++d) length += sum[d]*sum[d];
        length = std::sqrt(length);
        for (int d = 0; d < D; ++d) sum[d] /= length;
        // where the neighbours do not agree on a direction (sheets, corners) there is no slab of the cell to take the mean over
        shares[m] = std::clamp((length/sum[D] - 0.5)/0.45, 0., 1.);
        means[m] = alpha[i];
        slabs[m] = thicknessInWidths(cells, i, sum, width[i]);
    }
    frontsFromMeans(means.data(), slabs.data(), int(wanted.size()));
    for (std::size_t m = 0; m < wanted.size(); ++m)
    {
        const int i = facing.band[wanted[m]];
        const double slab = width[i]*slabs[m] - centroidHeight(cells, i, &facing.sums[std::size_t(facing.local[i])*(D + 1)], D);
        slabs[m] = shares[m]*slab + (1 - shares[m])*atNode[i];
    }
    return slabs;
}

/// Repeats what surfaceLevel() describes on the level it is given, each time for the nodes beside those that have moved by more than the tolerance.
template<int D>
void takeMeans(const SimplexMesh& mesh, const Halo& halo, const std::vector<double>& alpha, const std::vector<double>& width,
    const DualCells& cells, const Cover* cover, double tolerance, const std::vector<double>& atNode, std::vector<double>& level)
{
    FacingElements<D> facing(mesh, halo, alpha, cover);
    std::vector<double> lastChange(facing.band.size()), before;
    std::vector<int> wanted, moved;
    wanted.reserve(facing.band.size());
    moved.reserve(facing.node.size());
    Slabs work;
    for (int repeat = 0; repeat < mostRepeats; ++repeat)
    {
        facing.sumGradients(level);
        wanted.clear();
        for (std::size_t k = 0; k < facing.band.size(); ++k)
        {
            const int l = facing.local[facing.band[k]];
            const double* sum = &facing.sums[std::size_t(l)*(D + 1)];
            double square = 0;
            for (int d = 0; d < D; ++d) square += sum[d]*sum[d];
            if (facing.isWanted[l] && std::sqrt(square) > 1e-12*sum[D]) wanted.push_back(int(k));
        }
        const std::vector<double>& found = levelsOf<D>(wanted, facing, alpha, width, cells, atNode, work);
        before = level;
        double change = 0;
        // as much as it is of alpha, four times: far from the surface the level is of little use
        const auto changeOf = [&](int i) { return 4*alpha[i]*(1 - alpha[i])*std::abs(level[i] - before[i])/width[i]; };
        for (std::size_t m = 0; m < wanted.size(); ++m)
        {
            const int k = wanted[m], i = facing.band[k];
            level[i] = found[m];
            const double own = changeOf(i);
            if (repeat < patience || own < stubborn*lastChange[k]) change = std::max(change, own);
            lastChange[k] = own;
        }
        halo.update(level, 1);
        if (halo.max(change) < tolerance) break;
        moved.clear();
        for (std::size_t l = 0; l < facing.node.size(); ++l)
            if (changeOf(facing.node[l]) >= tolerance) moved.push_back(int(l));
        facing.wantNeighbours(moved);
    }
}

} // namespace

double ProfileSlab::mean() const { return sweptMean(middle + 0.5*thickness, thickness); }

double ProfileSlab::slope() const
{
    const auto profile = [](double psi) { return 0.5 + 0.5*std::tanh(0.5*psi); };
    if (thickness > 1e-3) return (profile(middle + 0.5*thickness) - profile(middle - 0.5*thickness))/thickness;
    return profile(middle)*profile(-middle);
}

ProfileSlab profileSlab(const DualCells* cells, int i, const double* normal, double distance, double width)
{
    if (!cells) return {distance/width, 0};
    return {(distance + centroidHeight(*cells, i, normal, cells->dim()))/width, thicknessInWidths(*cells, i, normal, width)};
}

std::vector<double> surfaceLevel(const SimplexMesh& mesh, const Halo& halo, const std::vector<double>& alpha,
    const std::vector<double>& width, const DualCells* cells, const Cover* cover, double tolerance)
{
    const double clip = std::log(highest/lowest);
    std::vector<double> level(mesh.nNodes);
    for (int i = 0; i < mesh.nNodes; ++i)
        level[i] = width[i]*(alpha[i] <= lowest ? -clip : alpha[i] >= highest ? clip : std::log(alpha[i]/(1 - alpha[i])));
    if (!cells) return level;
    const std::vector<double> atNode = level;
    if (mesh.dim == 2) takeMeans<2>(mesh, halo, alpha, width, *cells, cover, tolerance, atNode, level);
    else takeMeans<3>(mesh, halo, alpha, width, *cells, cover, tolerance, atNode, level);
    return level;
}

} // namespace flotsam
