// SPDX-License-Identifier: GPL-3.0-or-later
/// Cells with one front: its direction and curvature from the neighbours.
#include "equations/frontFit.hpp"
#include "equations/profileMeans.hpp"
#include "equations/profileReconstruction.hpp"

#include "geometry/cover.hpp"

namespace flotsam
{

template<int dim>
void ProfileReconstruction::findRing(int i, const Cover* cover, Ring& ring)
{
    ring.size = 1;
    ring.node[0] = i;
    ring.count[0] = 0;
    placeInRing_[i] = 0;
    for (int k = graph_.nodeElementStart[i]; k < graph_.nodeElementStart[i + 1] && ring.size < maxRing - dim; ++k)
    {
        const int e = graph_.nodeElement[k];
        if (cover && cover->state[e] == ElementState::Solid)
        {
            continue;
        }
        const int* nodes = &mesh_.elements[std::size_t(e)*(dim + 1)];
        for (int a = 0; a <= dim; ++a)
        {
            int& place = placeInRing_[nodes[a]];
            const bool isNew = place < 0;   // no branch: none could be foretold
            place = isNew ? ring.size : place;
            ring.node[place] = nodes[a];
            ring.count[place] = isNew ? 1 : ring.count[place] + 1;
            ring.size += isNew;
        }
    }
    for (int k = 0; k < ring.size; ++k)
    {
        placeInRing_[ring.node[k]] = -1;
    }
}

/// Node j's cell in axes at node i, lengths in units of `length`.
template<int dim>
SurfaceSample ProfileReconstruction::sampleOf(int i, int j, double share, const double (&axes)[dim][dim], double length) const
{
    SurfaceSample sample;
    double place[3] = {};
    for (int d = 0; d < dim; ++d)
    {
        const double x = mesh_.x[std::size_t(j)*dim + d] + cells_.centroid(j)[d] - mesh_.x[std::size_t(i)*dim + d];
        for (int c = 0; c < dim; ++c)
        {
            place[c] += axes[c][d]*x/length;
        }
    }
    sample.across = place[0];
    std::copy_n(place + 1, 2, sample.along);
    sample.thickness = std::min(2*cells_.halfWidth(j, axes[0])*profile_[i].steepness, 300.);
    sample.alpha = share;
    return sample;
}

/// Turns and bends the front of the ring's first node so that the neighbours are met.
template<int dim>
void ProfileReconstruction::bendFront(const Ring& ring, const std::vector<double>& alpha)
{
    const int i = ring.node[0];
    NodeProfile& p = profile_[i];
    double axes[dim][dim];
    std::copy_n(p.normal, dim, axes[0]);
    completeAxes<dim>(axes);
    const double length = 2*cells_.halfWidth(i, axes[0]);
    static_assert(maxRing <= maxSamples, "a fit takes the whole ring");
    SurfaceSample samples[maxRing];
    int nSamples = 0;
    for (int k = 0; k < ring.size; ++k)
    {
        const int j = ring.node[k];
        if (isMixed(alpha[j]))
        {
            samples[nSamples++] = sampleOf<dim>(i, j, alpha[j], axes, length);
        }
    }
    Front<dim> front;
    if (!fitFront<dim>(samples, nSamples, length*p.steepness, front))
    {
        return;
    }
    for (int d = 0; d < dim; ++d)
    {
        p.normal[d] = front.across*axes[0][d];
        for (int c = 0; c < dim - 1; ++c)
        {
            p.normal[d] += front.tilt[c]*axes[c + 1][d];
        }
    }
    setBend<dim>(p, front.curvature, axes, 1/length);
}

/// p.bend = factor sum of K_ab t_a t_b, K the upper triangle in the tangents axes[1], ...
template<int dim>
void ProfileReconstruction::setBend(NodeProfile& p, const double* curvature, const double (&axes)[dim][dim], double factor)
{
    std::fill_n(p.bend, 6, 0.);
    int k = 0;
    for (int a = 1; a < dim; ++a)
    {
        for (int b = a; b < dim; ++b, ++k)
        {
            int mixed = dim;
            for (int d = 0; d < dim; ++d)
            {
                for (int c = d; c < dim; ++c)
                {
                    const double product = a == b ? axes[a][d]*axes[a][c] : axes[a][d]*axes[b][c] + axes[b][d]*axes[a][c];
                    p.bend[c == d ? d : mixed++] += factor*curvature[k]*product;
                }
            }
        }
    }
}

/// What the front of the ring's first node misses in its neighbours: sum of squared differences of alpha.
template<int dim>
double ProfileReconstruction::frontResidual(const Ring& ring, const std::vector<double>& alpha) const
{
    const int i = ring.node[0];
    const NodeProfile& p = profile_[i];
    double end[maxRing], thickness[maxRing], mean[maxRing];
    for (int k = 1; k < ring.size; ++k)
    {
        const int j = ring.node[k];
        double x[dim], gradient[dim];
        for (int d = 0; d < dim; ++d)
        {
            x[d] = mesh_.x[std::size_t(j)*dim + d] + cells_.centroid(j)[d] - mesh_.x[std::size_t(i)*dim + d];
        }
        thickness[k] = 2*cells_.halfWidth(j, p.normal)*p.steepness;
        end[k] = p.value + p.steepness*(bentDistance<dim>(p, x, gradient) + cells_.meanBend(j, p.bend)) + 0.5*thickness[k];
    }
    sweptMeans(end + 1, thickness + 1, ring.size - 1, mean + 1);
    double sum = 0;
    for (int k = 1; k < ring.size; ++k)
    {
        const double defect = mean[k] - alpha[ring.node[k]];
        sum += defect*defect;
    }
    return sum;
}

template void ProfileReconstruction::findRing<2>(int, const Cover*, Ring&);
template void ProfileReconstruction::findRing<3>(int, const Cover*, Ring&);
template SurfaceSample ProfileReconstruction::sampleOf<2>(int, int, double, const double (&)[2][2], double) const;
template SurfaceSample ProfileReconstruction::sampleOf<3>(int, int, double, const double (&)[3][3], double) const;
template void ProfileReconstruction::bendFront<2>(const Ring&, const std::vector<double>&);
template void ProfileReconstruction::bendFront<3>(const Ring&, const std::vector<double>&);
template void ProfileReconstruction::setBend<2>(NodeProfile&, const double*, const double (&)[2][2], double);
template void ProfileReconstruction::setBend<3>(NodeProfile&, const double*, const double (&)[3][3], double);
template double ProfileReconstruction::frontResidual<2>(const Ring&, const std::vector<double>&) const;
template double ProfileReconstruction::frontResidual<3>(const Ring&, const std::vector<double>&) const;

} // namespace flotsam
