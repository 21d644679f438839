// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/profileReconstruction.hpp"

#include "core/elementaryFunctions.hpp"
#include "equations/facingElements.hpp"
#include "equations/profileMeans.hpp"
#include "geometry/cover.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

/// Below this ratio |sum of normals|/sum of |normals| a cell gets a roof instead of one front.
constexpr double coherenceLimit = 0.95;
/// The same for directions read from cell means, which are those of a plane to round-off: what bends more is left to roofs and films.
constexpr double coherenceOfMeans = 0.99;

/// Slope, relative to the equilibrium profile's, below which alpha counts as mixed: there is no surface to keep sharp
/// (and where the width varies with the mesh, a constant alpha has a slope of this order).
constexpr double flatSlope = 0.05;

/// Slope of a roof over the interpolated one: blunt for filaments (opposed normals), sharp for corners.
double roofFactorOf(double coherence)
{
    return 0.7 + 0.55*std::clamp((coherence - 0.5)/0.45, 0., 1.);
}

/// Cells with less of either phase carry too little for the fit of a film to pay.
constexpr double leastOfFilm = 0.03;
constexpr double leastOfBent = 0.01;        // with less of one phase a front stays straight: hardly anything crosses the cell's faces

constexpr int maxRoofParts = 256;

/// The elements' parts of a roof cell as slabs: mean of the profile = log((1 + X upper)/(1 + X lower))/thickness, X = exp(psi at the node).
/// Weights: volume over thickness.
struct RoofParts
{
    int size = 0;
    double weight[maxRoofParts], upper[maxRoofParts], lower[maxRoofParts];
};

/// ln X with sum of the parts' means = alpha, by Newton steps.
double roofValue(const RoofParts& parts, double alpha)
{
    double psi = std::log(alpha/(1 - alpha)) + 0.3;
    for (int iteration = 0; iteration < 12; ++iteration)
    {
        const double x = std::exp(psi);
        double mean = 0, slope = 0;
        double ratio[maxRoofParts];
        for (int k = 0; k < parts.size; ++k)
        {
            const double up = 1 + x*parts.upper[k], low = 1 + x*parts.lower[k];
            ratio[k] = up/low;
            slope += parts.weight[k]*x*(parts.upper[k] - parts.lower[k])/(up*low);
        }
        logarithms(ratio, parts.size);
        for (int k = 0; k < parts.size; ++k)
        {
            mean += parts.weight[k]*ratio[k];
        }
        if (std::abs(mean - alpha) < 1e-9 || slope < 1e-14)
        {
            break;
        }
        psi -= std::clamp((mean - alpha)/slope, -2., 2.);
    }
    return psi;
}

} // namespace

ProfileReconstruction::ProfileReconstruction(const SimplexMesh& mesh, const NodeGraph& graph, const DualCells& cells,
    const std::vector<double>& width)
    : mesh_(mesh), graph_(graph), cells_(cells), width_(width), moments_(ShareMoments::of(mesh.dim)), kind_(mesh.nNodes), profile_(mesh.nNodes),
      level_(mesh.nNodes), normalSum_(std::size_t(mesh.nNodes)*mesh.dim), coherence_(mesh.nNodes),
      hasLevel_(mesh.nNodes, 0), placeInRing_(mesh.nNodes, -1)
{
}

template<int dim>
void ProfileReconstruction::sumNormals(const std::vector<double>& alpha, const std::vector<int>& elements, const Cover* cover)
{
    constexpr int n = dim + 1;
    constexpr double clip = 1e-4;   // the same tail value whatever round-off has left in the bulk
    const double floorLevel = std::log(clip/(1 - clip));
    for (int i : levelNodes_)
    {
        hasLevel_[i] = 0;
    }
    levelNodes_.clear();
    for (int e : elements)
    {
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        if (std::none_of(nodes, nodes + n, [&](int i) { return isMixed(alpha[i]); }))
        {
            continue;
        }
        for (int a = 0; a < n; ++a)
        {
            const int i = nodes[a];
            if (hasLevel_[i])
            {
                continue;
            }
            hasLevel_[i] = 1;
            levelNodes_.push_back(i);
            const double q = alpha[i];
            level_[i] = width_[i]*(q <= clip ? floorLevel : q >= 1 - clip ? -floorLevel : std::log(q/(1 - q)));
            coherence_[i] = 0;
            std::fill_n(&normalSum_[std::size_t(i)*dim], dim, 0.);
        }
        if (cover && cover->state[e] == ElementState::Solid)
        {
            continue;
        }
        double gradient[dim], weight = 0;
        levelGradient<dim>(e, gradient);
        for (int a = 0; a < n; ++a)
        {
            weight += variation(alpha[nodes[a]]);
        }
        weight = (weight*weight + 1e-8)*fluidVolume(mesh_, cover, e);
        double length = 0;
        for (int d = 0; d < dim; ++d)
        {
            length += gradient[d]*gradient[d];
        }
        if (length < flatSlope*flatSlope)
        {
            continue;
        }
        length = weight*std::sqrt(length);
        for (int a = 0; a < n; ++a)
        {
            coherence_[nodes[a]] += length;
            for (int d = 0; d < dim; ++d)
            {
                normalSum_[std::size_t(nodes[a])*dim + d] += weight*gradient[d];
            }
        }
    }
}

/// Whether the neighbours agree on a direction by distances read from cell means; it is the front's then. Where dual cells differ in size and their centroids lie beside their
/// nodes (polyhedra, whose corners have 6 to 70 tetrahedra) a flat surface's values, taken for those at the nodes, do not.
template<int dim>
bool ProfileReconstruction::agreesByMeans(int i, const std::vector<double>& alpha, const Cover* cover)
{
    constexpr int n = dim + 1;
    double sum[dim] = {}, lengths = 0, squares = 0;
    for (int k = graph_.nodeElementStart[i]; distance_ && k < graph_.nodeElementStart[i + 1]; ++k)
    {
        const int e = graph_.nodeElement[k], *nodes = &mesh_.elements[std::size_t(e)*n];
        const auto isRead = [&](int j) { return alpha[j] > lowestOfBand && alpha[j] < highestOfBand; };
        if ((cover && cover->state[e] == ElementState::Solid) || !std::all_of(nodes, nodes + n, isRead))
        {
            continue;
        }
        double gradient[dim] = {}, weight = 0, square = 0;
        for (int a = 0; a < n; ++a)
        {
            weight += variation(alpha[nodes[a]]);
            for (int d = 0; d < dim; ++d)
            {
                gradient[d] += (*distance_)[nodes[a]]*mesh_.gradN[(std::size_t(e)*n + a)*dim + d];
            }
        }
        weight *= weight*fluidVolume(mesh_, cover, e);
        for (int d = 0; d < dim; ++d)
        {
            square += gradient[d]*gradient[d];
            sum[d] += weight*gradient[d];
        }
        lengths += weight*std::sqrt(square);
    }
    for (int d = 0; d < dim; ++d)
    {
        squares += sum[d]*sum[d];
    }
    const double length = std::sqrt(squares);
    if (!(length > 0 && length >= coherenceOfMeans*lengths))
    {
        return false;
    }
    for (int d = 0; d < dim; ++d)
    {
        profile_[i].normal[d] = sum[d]/length;
    }
    return true;
}

/// Puts the front where the cell's mean is alpha.
template<int dim>
void ProfileReconstruction::fillFront(int i, double alpha)
{
    NodeProfile& p = profile_[i];
    const double thickness = std::min(2*cells_.halfWidth(i, p.normal)*p.steepness, 600.);
    double gradient[dim];
    const double meanDistance = bentDistance<dim>(p, cells_.centroid(i), gradient) + cells_.meanBend(i, p.bend);
    kind_[i] = ProfileKind::Front;
    p.value = std::log(frontFromMean(alpha, thickness)) - meanDistance*p.steepness;
}

template<int dim>
void ProfileReconstruction::fitRoof(int i, double alpha, const Cover* cover)
{
    constexpr int n = dim + 1;
    NodeProfile& p = profile_[i];
    RoofParts parts;
    double total = 0;
    for (int k = graph_.nodeElementStart[i]; k < graph_.nodeElementStart[i + 1] && parts.size < maxRoofParts; ++k)
    {
        const int e = graph_.nodeElement[k];
        if (cover && cover->state[e] == ElementState::Solid)
        {
            continue;
        }
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        const double* gradN = &mesh_.gradN[std::size_t(e)*n*dim];
        double gradient[dim] = {}, sum = 0, squares = 0;
        for (int a = 0; a < n; ++a)
        {
            const double difference = level_[nodes[a]] - level_[i];    // = gradient.(x_a - x_i)
            sum += difference;
            squares += difference*difference;
            for (int d = 0; d < dim; ++d)
            {
                gradient[d] += difference*gradN[a*dim + d];
            }
        }
        double length = 1e-30;
        for (int d = 0; d < dim; ++d)
        {
            length += gradient[d]*gradient[d];
        }
        length = std::sqrt(length);
        const double scale = std::min(p.roofFactor, 1/length)*p.steepness;
        const double mean = moments_.first*sum;
        const double spread = (moments_.square - moments_.mixed)*squares + moments_.mixed*sum*sum - mean*mean;
        const double thickness = std::max(2*scale*std::sqrt(3*std::max(spread, 0.)), 1e-4);
        parts.weight[parts.size] = mesh_.volume[e]/thickness;
        parts.upper[parts.size] = std::clamp(scale*mean + 0.5*thickness, -300., 300.);
        parts.lower[parts.size] = std::clamp(scale*mean - 0.5*thickness, -300., 300.);
        ++parts.size;
        total += mesh_.volume[e];
    }
    exponentials(parts.upper, parts.size);
    exponentials(parts.lower, parts.size);
    for (int k = 0; k < parts.size; ++k)
    {
        parts.weight[k] /= total;
    }
    kind_[i] = ProfileKind::Roof;
    p.value = roofValue(parts, alpha);
}

template<int dim>
void ProfileReconstruction::build(const std::vector<double>& alpha, const std::vector<int>& elements,
    const std::vector<int>& nodes, const Cover* cover)
{
    nFronts_ = nRoofs_ = nFilms_ = 0;
    sumNormals<dim>(alpha, elements, cover);
    for (int i : nodes)
    {
        kind_[i] = ProfileKind::Tail;
        if (!isMixed(alpha[i]))
        {
            continue;
        }
        kind_[i] = ProfileKind::Bulk;
        NodeProfile& p = profile_[i];
        const double* g = &normalSum_[std::size_t(i)*dim];
        double length = 0;
        for (int d = 0; d < dim; ++d)
        {
            length += g[d]*g[d];
        }
        length = std::sqrt(length);
        if (length <= 1e-12*coherence_[i] || length <= 0)
        {
            continue;
        }
        for (int d = 0; d < dim; ++d)
        {
            p.normal[d] = g[d]/length;
        }
        p.steepness = 1/width_[i];
        std::fill_n(p.bend, 6, 0.);
        const double coherence = length/coherence_[i];
        const bool isCoherent = coherence >= coherenceLimit || agreesByMeans<dim>(i, alpha, cover);
        const double lesser = std::min(alpha[i], 1 - alpha[i]);
        const bool isBent = isCoherent && lesser >= leastOfBent, mayBeFilm = lesser >= leastOfFilm;
        Ring ring;
        if (isBent || mayBeFilm)
        {
            findRing<dim>(i, cover, ring);
        }
        if (isBent)
        {
            bendFront<dim>(ring, alpha);
        }
        if (isCoherent || mayBeFilm)
        {
            fillFront<dim>(i, alpha[i]);
        }
        if (mayBeFilm && fitFilm<dim>(ring, alpha, isCoherent, cover))
        {
            nFilms_ += i < mesh_.nOwned;
        }
        else if (isCoherent)
        {
            nFronts_ += i < mesh_.nOwned;
        }
        else
        {
            p.roofFactor = roofFactorOf(coherence);
            fitRoof<dim>(i, alpha[i], cover);
            nRoofs_ += i < mesh_.nOwned;
        }
    }
}

void ProfileReconstruction::build(const std::vector<double>& alpha, const std::vector<int>& elements,
    const std::vector<int>& nodes, const Cover* cover, const std::vector<double>* distance)
{
    distance_ = distance;
    if (mesh_.dim == 2)
    {
        build<2>(alpha, elements, nodes, cover);
    }
    else
    {
        build<3>(alpha, elements, nodes, cover);
    }
}

} // namespace flotsam
