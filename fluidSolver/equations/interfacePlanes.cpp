// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/interfacePlanes.hpp"

#include "geometry/cover.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flotsam
{

namespace
{

/// Relative difference of squared distances below which two planes count as equally near. At a node that the surface goes through all of them are round-off: there they
/// count so within this share of the planes' reach.
constexpr double tieTolerance = 1e-9;

constexpr double none = std::numeric_limits<double>::infinity();

template<int dim>
double squaredDistance(const double* a, const double* b)
{
    double s = 0;
    for (int d = 0; d < dim; ++d)
        s += (a[d] - b[d])*(a[d] - b[d]);
    return s;
}

/// A choice between two equally near planes that depends neither on the order of the elements nor on the rank.
bool comesFirst(const double* a, const double* b, int dim, double tolerance)
{
    for (int d = 0; d <= 2*dim; ++d)    // point, then normal, then reach
        if (std::abs(a[d] - b[d]) > (d >= dim && d < 2*dim ? tieTolerance : tolerance))
            return a[d] < b[d];
    return false;
}

double longestEdge(const SimplexMesh& mesh, int e)
{
    const int nCorners = mesh.dim + 1, *nodes = &mesh.elements[static_cast<std::size_t>(e)*nCorners];
    double longest = 0;
    for (int a = 1; a < nCorners; ++a)
        for (int b = 0; b < a; ++b)
        {
            const double *p = &mesh.x[static_cast<std::size_t>(nodes[a])*mesh.dim], *q = &mesh.x[static_cast<std::size_t>(nodes[b])*mesh.dim];
            longest = std::max(longest, mesh.dim == 2 ? squaredDistance<2>(p, q) : squaredDistance<3>(p, q));
        }
    return std::sqrt(longest);
}

bool isCut(const int* nodes, int nCorners, const std::vector<double>& level)
{
    bool wet = false, dry = false;
    for (int a = 0; a < nCorners; ++a)
        (level[nodes[a]] >= 0 ? wet : dry) = true;
    return wet && dry;
}

} // namespace

void InterfacePlanes::clear(const SimplexMesh& mesh)
{
    dim_ = mesh.dim;
    width_ = 2*dim_ + 1;
    const std::size_t size = static_cast<std::size_t>(mesh.nNodes)*width_;
    if (data_.size() != size)
    {
        data_.assign(size, 0);
        next_.assign(size, 0);
        nearest_.assign(mesh.nNodes, none);
        distance_.assign(mesh.nNodes, 0);
        isOffered_.assign(mesh.nNodes, 0);
    }
    for (int i : nodes_)
    {
        at(i)[width_ - 1] = 0;
        nearest_[i] = none;
    }
    nodes_.clear();
    changed_.clear();
}

/// Takes `plane` for `node` (in next_) when it is nearer than what the node has.
template<int dim>
inline void InterfacePlanes::offer(const SimplexMesh& mesh, int node, const double* plane)
{
    constexpr int width = 2*dim + 1;
    const double then = squaredDistance<dim>(&mesh.x[static_cast<std::size_t>(node)*dim], plane), now = nearest_[node];
    double* own = &next_[static_cast<std::size_t>(node)*width];
    if (now < none)
    {
        const double roundOff = tieTolerance*std::max(plane[2*dim], own[2*dim]);
        const double tolerance = tieTolerance*std::max(now, then) + roundOff*roundOff;
        if (then > now + tolerance)
            return;
        if (then > now - tolerance)
        {
            const bool isSame = then == now && std::equal(plane, plane + width, own);
            if (isSame || !comesFirst(plane, own, dim, std::sqrt(std::max(now, then))*tieTolerance + roundOff))
                return;
        }
    }
    std::copy_n(plane, width, own);
    nearest_[node] = then;
    if (!isOffered_[node])
    {
        isOffered_[node] = 1;
        offered_.push_back(node);
    }
}

void InterfacePlanes::planesOfCutElements(const SimplexMesh& mesh, const std::vector<double>& level, const Cover* cover)
{
    const int nCorners = dim_ + 1;
    cutElements_.clear();
    cutPlanes_.clear();
    for (int e = 0; e < mesh.nElements; ++e)
    {
        const int* nodes = &mesh.elements[static_cast<std::size_t>(e)*nCorners];
        if (!isCut(nodes, nCorners, level) || (cover && cover->state[e] == ElementState::Solid))
            continue;

        double plane[7] = {}, gradient[3] = {};
        int nCrossings = 0;
        for (int a = 0; a < nCorners; ++a)
        {
            const double la = level[nodes[a]];
            for (int d = 0; d < dim_; ++d)
                gradient[d] += la*mesh.gradN[(static_cast<std::size_t>(e)*nCorners + a)*dim_ + d];
            for (int b = 0; b < nCorners; ++b)
            {
                const double lb = level[nodes[b]];
                if (la < 0 || lb >= 0)
                    continue;
                const double t = la/(la - lb);
                for (int d = 0; d < dim_; ++d)
                    plane[d] += (1 - t)*mesh.x[nodes[a]*dim_ + d] + t*mesh.x[nodes[b]*dim_ + d];
                ++nCrossings;
            }
        }
        const double slope = std::sqrt(gradient[0]*gradient[0]
            + gradient[1]*gradient[1] + gradient[2]*gradient[2]);
        for (int d = 0; d < dim_; ++d)
        {
            plane[d] /= nCrossings;
            plane[dim_ + d] = gradient[d]/slope;    // slope > 0: the level changes sign
        }
        plane[2*dim_] = std::max(mesh.h[e], longestEdge(mesh, e)/std::sqrt(dim_));
        cutElements_.push_back(e);
        cutPlanes_.insert(cutPlanes_.end(), plane, plane + width_);
    }
}

template<int dim>
void InterfacePlanes::offerCutPlanes(const SimplexMesh& mesh)
{
    constexpr int nCorners = dim + 1;
    for (std::size_t k = 0; k < cutElements_.size(); ++k)
        for (int a = 0; a < nCorners; ++a)
            offer<dim>(mesh, mesh.elements[static_cast<std::size_t>(cutElements_[k])*nCorners + a], &cutPlanes_[k*width_]);
    commit();
}

/// Normals become means over the cut elements around, weighted by volume: a node's foot lies beside the plane's own point, and the tilt of one
/// element alone, carried there, lets a level surface creep (docs/numerics.md, section 2). The more the normals disagree (sheets, corners), the
/// more each element's own counts.
void InterfacePlanes::alignNormals(const SimplexMesh& mesh)
{
    const int nCorners = dim_ + 1, stride = dim_ + 1;   // sum of normals, of weights
    normalSum_.resize(static_cast<std::size_t>(mesh.nNodes)*stride);
    const auto forNodes = [&](std::size_t k, auto&& act) {
        for (int a = 0; a < nCorners; ++a)
            act(&normalSum_[static_cast<std::size_t>(mesh.elements[static_cast<std::size_t>(cutElements_[k])*nCorners + a])*stride]);
    };
    for (std::size_t k = 0; k < cutElements_.size(); ++k)
        forNodes(k, [&](double* sum) { std::fill_n(sum, stride, 0.); });
    for (std::size_t k = 0; k < cutElements_.size(); ++k)
    {
        const double weight = mesh.volume[cutElements_[k]], *normal = &cutPlanes_[k*width_ + dim_];
        forNodes(k, [&](double* sum) {
            for (int d = 0; d < dim_; ++d)
                sum[d] += weight*normal[d];
            sum[dim_] += weight;
        });
    }
    for (std::size_t k = 0; k < cutElements_.size(); ++k)
    {
        double mean[3] = {}, *normal = &cutPlanes_[k*width_ + dim_], weight = 0, length = 0, newLength = 0;
        forNodes(k, [&](const double* sum) {
            for (int d = 0; d < dim_; ++d)
                mean[d] += sum[d];
            weight += sum[dim_];
        });
        for (int d = 0; d < dim_; ++d)
            length += mean[d]*mean[d];
        for (int d = 0; d < dim_; ++d)
        {
            mean[d] += (weight - std::sqrt(length))*normal[d];
            newLength += mean[d]*mean[d];
        }
        for (int d = 0; d < dim_ && newLength > 0; ++d)
            normal[d] = mean[d]/std::sqrt(newLength);
    }
}

/// Moves the accepted offers from next_ to data_: a sweep reads only the state before it (the same on any rank).
void InterfacePlanes::commit()
{
    changed_.clear();
    for (int i : offered_)
    {
        if (!has(i))
            nodes_.push_back(i);
        std::copy_n(&next_[static_cast<std::size_t>(i)*width_], width_, at(i));
        isOffered_[i] = 0;
        changed_.push_back(i);
    }
    offered_.clear();
}

template<int dim>
void InterfacePlanes::sweep(const SimplexMesh& mesh, const NodeGraph& graph)
{
    constexpr int nCorners = dim + 1;
    for (int i : changed_)
    {
        if (i < mesh.nOwned)
        {
            for (int k = graph.rowStart[i]; k < graph.rowStart[i + 1]; ++k)
                if (graph.column[k] != i)
                    offer<dim>(mesh, graph.column[k], at(i));
            continue;
        }
        for (int k = graph.nodeElementStart[i]; k < graph.nodeElementStart[i + 1]; ++k)
        {
            const int* nodes = &mesh.elements[static_cast<std::size_t>(graph.nodeElement[k])*nCorners];
            for (int a = 0; a < nCorners; ++a)
                if (nodes[a] != i)
                    offer<dim>(mesh, nodes[a], at(i));
        }
    }
    commit();
}

/// Owners' planes to the halo copies; copies that change hand theirs on in the next sweep.
void InterfacePlanes::exchange(const SimplexMesh& mesh, const Halo& halo)
{
    if (halo.size() == 1)
        return;
    const std::size_t first = static_cast<std::size_t>(mesh.nOwned)*width_;
    before_.assign(data_.begin() + first, data_.end());
    halo.update(data_, width_);
    for (int i = mesh.nOwned; i < mesh.nNodes; ++i)
    {
        const double* old = &before_[static_cast<std::size_t>(i - mesh.nOwned)*width_];
        if (at(i)[width_ - 1] == 0 || std::equal(old, old + width_, at(i)))
            continue;
        if (old[width_ - 1] == 0)
            nodes_.push_back(i);
        std::copy_n(at(i), width_, &next_[static_cast<std::size_t>(i)*width_]);
        const double* x = &mesh.x[static_cast<std::size_t>(i)*dim_];
        nearest_[i] = dim_ == 2 ? squaredDistance<2>(x, at(i)) : squaredDistance<3>(x, at(i));
        changed_.push_back(i);
    }
}

double InterfacePlanes::alongNormal(const SimplexMesh& mesh, int node) const
{
    double result = 0;
    for (int d = 0; d < dim_; ++d)
        result += normal(node)[d]*(mesh.x[static_cast<std::size_t>(node)*dim_ + d] - point(node)[d]);
    return result;
}

double InterfacePlanes::distanceFromSurface(const SimplexMesh& mesh, int node) const
{
    const double *x = &mesh.x[static_cast<std::size_t>(node)*dim_], along = alongNormal(mesh, node);
    const double square = dim_ == 2 ? squaredDistance<2>(x, point(node)) : squaredDistance<3>(x, point(node));
    return std::hypot(along, std::max(0., std::sqrt(std::max(0., square - along*along)) - reach(node)));
}

/// Of the nodes that hand their planes on next those near them; false where no rank has any. Thin elements have more rings within the profile, whose width is
/// that of the element's size.
bool InterfacePlanes::keepNear(const SimplexMesh& mesh, const Halo& halo, const Extent& extent)
{
    if (!extent.width)
        return false;
    const auto isFar = [&](int i) { return distanceFromSurface(mesh, i) > extent.widths*(*extent.width)[i]; };
    changed_.erase(std::remove_if(changed_.begin(), changed_.end(), isFar), changed_.end());
    return halo.any(!changed_.empty());
}

/// From nodes inside solids beside the plane, however far along it, to the nodes around them.
void InterfacePlanes::handOnThroughSolids(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const Extent& extent, const Cover& cover)
{
    const auto isElsewhere = [&](int i) { return cover.distance[i] >= 0 || std::abs(alongNormal(mesh, i)) > extent.widths*(*extent.width)[i]; };
    for (changed_ = nodes_;;)
    {
        changed_.erase(std::remove_if(changed_.begin(), changed_.end(), isElsewhere), changed_.end());
        if (!halo.any(!changed_.empty()))
            return;
        dim_ == 2 ? sweep<2>(mesh, graph) : sweep<3>(mesh, graph);
        exchange(mesh, halo);
    }
}

void InterfacePlanes::propagate(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo,
    const std::vector<double>& level, const Extent& extent, const Cover* cover, bool hasMeanNormals)
{
    clear(mesh);
    planesOfCutElements(mesh, level, cover);
    if (hasMeanNormals)
        alignNormals(mesh);
    dim_ == 2 ? offerCutPlanes<2>(mesh) : offerCutPlanes<3>(mesh);
    if (hasMeanNormals)
        exchange(mesh, halo);   // the means of elements that touch no owned node lack what other ranks hold
    // Two rings of elements are held: two stages are right on the owned nodes before copies must be refreshed.
    for (int ring = 1; ring <= extent.rings || keepNear(mesh, halo, extent); ++ring)
    {
        dim_ == 2 ? sweep<2>(mesh, graph) : sweep<3>(mesh, graph);
        if (ring % 2 == 1 || ring >= extent.rings)
            exchange(mesh, halo);
    }
    if (extent.rings < 1)
        exchange(mesh, halo);
    if (extent.throughSolids && extent.width && cover)
        handOnThroughSolids(mesh, graph, halo, extent, *cover);

    for (int i : nodes_)
        distance_[i] = alongNormal(mesh, i);
}

} // namespace flotsam
