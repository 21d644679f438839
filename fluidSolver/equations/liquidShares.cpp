// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/liquidShares.hpp"

#include "core/elementaryFunctions.hpp"
#include "equations/dualCells.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

constexpr double pure = 1e-3;       // alpha this near to 0 and 1 is spread evenly: half of a shallow flume's nodes have traces of the other fluid
constexpr int maxIterations = 30;   // of Newton's method for the plane's place
constexpr double nearEnough = 1e-3; // widths of the plane from its place: the rest is linear
constexpr double thinnest = 1e-3;   // slab, in widths
constexpr double farthest = 300;    // of a slab's end from the node, in widths, and of the surface: sums of both are what exp() can tell from infinity

/// The corner's share of an element: fluid volume, and as a slab along the normal, in widths of the profile.
struct Share
{
    std::size_t slot;
    double volume, middle, thickness;
};

template<int dim>
class Spreading
{
public:
    Spreading(const SimplexMesh& mesh, const Halo& halo, const Cover* cover, const std::vector<double>& alpha, const std::vector<double>& width)
    :   mesh_(mesh), halo_(halo), cover_(cover), alpha_(alpha), width_(width), moments_(ShareMoments::of(dim)),
        result_(mesh.elements.size(), 0.0)
    {
        spreadEvenly();
        collectCorners();
        setGradients();
    }

    std::vector<double> run()
    {
        placePlanes();
        for (int i = 0; i < mesh_.nNodes; ++i)
        {
            const double* plane = &planes_[std::size_t(i)*nPlane];
            if (band_[i] < 0 || plane[Planarity] <= 0) continue;
            collectShares(i, plane);
            setEnds();
            evaluateShares(plane[Place]);
            for (std::size_t k = 0; k < shares_.size(); ++k)
            {
                const double mean = mean_[k] + plane[Step]*slope_[k];
                result_[shares_[k].slot] = shares_[k].volume*((1 - plane[Planarity])*alpha_[i] + plane[Planarity]*mean);
            }
        }
        return std::move(result_);
    }

private:
    static constexpr int n = dim + 1;
    /// Of a node's plane, after its normal. Planarity: 1: all gradients around point the same way; in the middle of a sheet they cancel; 0: none. Place: of the node from
    /// the plane, in widths. Step: what is linear of it.
    enum { Planarity = dim, Place, Step, nPlane };

    bool isInBand(int i) const { return alpha_[i] > pure && alpha_[i] < 1 - pure; }

    /// All shares as if alpha were uniform in a dual cell, and the elements of nodes of which it is not.
    void spreadEvenly()
    {
        for (int e = 0; e < mesh_.nElements; ++e)
        {
            const ElementState state = cover_ ? cover_->state[e] : ElementState::Fluid;
            if (state == ElementState::Solid) continue;
            const int* nodes = &mesh_.elements[std::size_t(e)*n];
            const double* first = state == ElementState::Cut ? cover_->cuts[cover_->cutIndex[e]].first : nullptr;
            for (int a = 0; a < n; ++a) result_[std::size_t(e)*n + a] = (first ? first[a] : mesh_.volume[e]/n)*alpha_[nodes[a]];
            if (std::any_of(nodes, nodes + n, [&](int i) { return isInBand(i); })) elements_.push_back(e);
        }
    }

    /// Numbers the nodes of the band; their corners in the elements around.
    void collectCorners()
    {
        band_.assign(mesh_.nNodes, -1);
        int nBand = 0;
        for (int i = 0; i < mesh_.nNodes; ++i)
            if (isInBand(i)) band_[i] = nBand++;
        start_.assign(nBand + 1, 0);
        const auto forCorners = [&](auto visit) {
            for (int e : elements_)
                for (std::size_t k = std::size_t(e)*n; k < std::size_t(e + 1)*n; ++k)
                    if (const int b = band_[mesh_.elements[k]]; b >= 0) visit(b, k);
        };
        forCorners([&](int b, std::size_t) { ++start_[b + 1]; });
        for (int b = 0; b < nBand; ++b) start_[b + 1] += start_[b];
        corner_.resize(start_[nBand]);
        std::vector<int> next(start_.begin(), start_.end() - 1);
        forCorners([&](int b, std::size_t k) { corner_[next[b]++] = k; });
    }

    /// Sums over the elements around a node: gradients of alpha, and their lengths, by volume.
    void setGradients()
    {
        gradient_.assign((start_.size() - 1)*n, 0.0);
        for (int e : elements_)
        {
            const int* nodes = &mesh_.elements[std::size_t(e)*n];
            double g[dim] = {}, square = 0;
            for (int a = 0; a < n; ++a)
                for (int d = 0; d < dim; ++d) g[d] += mesh_.gradN[(std::size_t(e)*n + a)*dim + d]*alpha_[nodes[a]];
            for (int d = 0; d < dim; ++d) square += g[d]*g[d];
            for (int a = 0; a < n; ++a)
            {
                if (band_[nodes[a]] < 0) continue;
                double* sum = &gradient_[std::size_t(band_[nodes[a]])*n];
                for (int d = 0; d < dim; ++d) sum[d] += mesh_.volume[e]*g[d];
                sum[dim] += mesh_.volume[e]*std::sqrt(square);
            }
        }
    }

    /// Planes of all nodes: copies of nodes do not have all elements around them, but their owners have.
    void placePlanes()
    {
        planes_.assign(std::size_t(mesh_.nNodes)*nPlane, 0.0);
        for (int i = 0; i < mesh_.nOwned; ++i)
        {
            if (band_[i] < 0) continue;
            double* plane = &planes_[std::size_t(i)*nPlane];
            findDirection(i, plane);
            if (plane[Planarity] <= 0) continue;
            collectShares(i, plane);
            if (!placeSurface(alpha_[i], plane)) plane[Planarity] = 0;
        }
        halo_.update(planes_, nPlane);
    }

    void findDirection(int i, double* plane) const
    {
        const double* g = &gradient_[std::size_t(band_[i])*n];
        double size = 0;
        for (int d = 0; d < dim; ++d) size += g[d]*g[d];
        size = std::sqrt(size);
        plane[Planarity] = g[dim] > 0 ? size/g[dim] : 0;
        for (int d = 0; d < dim && size > 0; ++d) plane[d] = g[d]/size;
    }

    /// The local shares of node i, and these as slabs along the plane's normal with middles relative to the node.
    void collectShares(int i, const double* plane)
    {
        shares_.clear();
        for (int k = start_[band_[i]]; k < start_[band_[i] + 1]; ++k)
        {
            const std::size_t slot = corner_[k], e = slot/n;
            const bool isCut = cover_ && cover_->state[e] == ElementState::Cut;
            const double volume = isCut ? cover_->cuts[cover_->cutIndex[e]].first[slot % n] : mesh_.volume[e]/n;
            shares_.push_back(slabOf(slot, volume, &mesh_.x[std::size_t(i)*dim], plane, 1/width_[i]));
        }
    }

    /// The whole share of a corner, whose node is at x, as a slab of its own variance; scale: 1/m.
    Share slabOf(std::size_t slot, double volume, const double* x, const double* normal, double scale) const
    {
        const std::size_t e = slot/n;
        double sum = 0, squares = 0;    // of the other corners' places along the normal
        for (int b = 0; b < n; ++b)
        {
            double along = 0;
            for (int d = 0; d < dim; ++d) along += normal[d]*(mesh_.x[std::size_t(mesh_.elements[e*n + b])*dim + d] - x[d]);
            sum += along;
            squares += along*along;
        }
        const double mean = moments_.first*sum;
        const double variance = (moments_.square - moments_.mixed)*squares + moments_.mixed*sum*sum - mean*mean;
        return {slot, volume, mean*scale, std::clamp(std::sqrt(12*std::max(0.0, variance))*scale, thinnest, farthest)};
    }

    /// exp(psi) at the slabs' ends for a plane through the node: another one multiplies all by the same factor.
    void setEnds()
    {
        const std::size_t size = shares_.size();
        ends_.resize(2*size);
        for (std::size_t k = 0; k < size; ++k)
        {
            const double half = 0.5*shares_[k].thickness;
            const double middle = std::clamp(shares_[k].middle, half - farthest, farthest - half);
            ends_[k] = middle - half;
            ends_[size + k] = middle + half;
        }
        exponentials(ends_.data(), int(2*size));
        mean_.resize(size);
        slope_.resize(size);
    }

    /// Means of the profile 1/(1+exp(-psi)) over the slabs, and their derivatives by `place`: differences of ln(1+exp(psi)) and of the profile.
    void evaluateShares(double place)
    {
        const std::size_t size = shares_.size();
        const double x = std::exp(place);
        const double *lower = ends_.data(), *upper = lower + size;
        for (std::size_t k = 0; k < size; ++k)
        {
            const double low = 1 + x*lower[k], up = 1 + x*upper[k];
            mean_[k] = up/low;
            slope_[k] = x*(upper[k] - lower[k])/(up*low);
        }
        logarithms(mean_.data(), int(size));
        for (std::size_t k = 0; k < size; ++k)
        {
            const double share = 1/shares_[k].thickness;
            mean_[k] *= share;
            slope_[k] *= share;
        }
    }

    /// Place of the plane in a slab of the whole cell's thickness: where its mean is alpha.
    double firstPlace(double alpha, double whole) const
    {
        double mean = 0, squares = 0;
        for (const Share& s : shares_)
        {
            mean += s.volume/whole*s.middle;
            squares += s.volume/whole*(s.middle*s.middle + s.thickness*s.thickness/12);
        }
        const double thickness = std::clamp(std::sqrt(12*std::max(0.0, squares - mean*mean)), thinnest, farthest);
        return std::log(std::expm1(alpha*thickness)/-std::expm1((alpha - 1)*thickness)) - 0.5*thickness - mean;
    }

    /// Newton's method for the plane with which the shares have `alpha` of their volume. The last step is linear, so that they have just that. False where it finds none.
    bool placeSurface(double alpha, double* plane)
    {
        double whole = 0;
        for (const Share& s : shares_) whole += s.volume;
        if (whole <= 0) return false;
        setEnds();
        double& place = plane[Place] = std::clamp(firstPlace(alpha, whole), -farthest, farthest);
        for (int k = 0; k < maxIterations; ++k)
        {
            double mean = 0, slope = 0;
            evaluateShares(place);
            for (std::size_t s = 0; s < shares_.size(); ++s)
            {
                mean += shares_[s].volume/whole*mean_[s];
                slope += shares_[s].volume/whole*slope_[s];
            }
            plane[Step] = (alpha - mean)/std::max(slope, 1e-30);
            if (std::abs(plane[Step]) < nearEnough) return true;
            place = std::clamp(place + std::clamp(plane[Step], -2.0, 2.0), -farthest, farthest);
        }
        return false;
    }

    const SimplexMesh& mesh_;
    const Halo& halo_;
    const Cover* cover_;
    const std::vector<double>&alpha_, &width_;
    ShareMoments moments_;
    std::vector<double> result_;
    std::vector<int> elements_;         // with nodes of the band
    std::vector<int> band_, start_;     // per node: place in start_ and gradient_, -1: not in the band
    std::vector<std::size_t> corner_;   // of the elements around the nodes of the band
    std::vector<double> gradient_;      // (dim+1) per node of the band, see setGradients()
    std::vector<double> planes_;        // nPlane per node
    // of the present node
    std::vector<Share> shares_;
    std::vector<double> mean_, slope_;      // of the shares
    std::vector<double> ends_;              // of their slabs, first all lower ones: see setEnds()
};

} // namespace

std::vector<double> liquidShares(const SimplexMesh& mesh, const Halo& halo, const Cover* cover, const std::vector<double>& alpha, const std::vector<double>& width)
{
    return mesh.dim == 2 ? Spreading<2>(mesh, halo, cover, alpha, width).run() : Spreading<3>(mesh, halo, cover, alpha, width).run();
}

} // namespace flotsam
