// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/transportBoundary.hpp"

#include "core/patchFaces.hpp"
#include "equations/faceMoments.hpp"
#include "geometry/meanCover.hpp"

#include <algorithm>

namespace flotsam
{

TransportBoundary::TransportBoundary(const SimplexMesh& mesh, const NodeGraph& graph, const VolumeFlux& volumeFlux)
    : mesh_(mesh), graph_(graph), volumeFlux_(volumeFlux), nodal_(mesh.nNodes, 0), closingIndex_(mesh.nNodes, -1)
{
}

/// To nodal_: int N_a u.n over the fluid part of every face, as the continuity rows have it, over the whole of a step half of it with the cover of its start and half with
/// that of its end.
template<int D>
void TransportBoundary::addFaces(const MeshPatch& patch, const std::vector<double>& u, const Cover* cover)
{
    const bool isMean = cover && cover->start;
    const Cover* covers[2] = {isMean ? cover->start : cover, isMean ? cover->end : cover};
    for (std::size_t f = 0; f < patch.faceElement.size(); ++f)
    {
        const int* face = &patch.faceNodes[f*D];
        double area[3], through[D];     // through: S.u per node
        outwardVector(mesh_, patch, f, area);
        for (int a = 0; a < D; ++a)
        {
            through[a] = 0;
            for (int d = 0; d < D; ++d)
            {
                through[a] += area[d]*u[std::size_t(face[a])*D + d];
            }
        }
        for (int k = 0; k < 1 + isMean; ++k)
        {
            const FaceMoments<D> moments(mesh_, covers[k], patch.faceElement[f], face);
            for (int ab = 0; ab < D*D; ++ab)
            {
                nodal_[face[ab/D]] += moments.second[ab]*through[ab%D]/(1 + isMean);
            }
        }
    }
}

void TransportBoundary::addGivenVelocity(const std::vector<double>& u, const Cover* cover, const std::vector<BoundaryPatch>& patches,
    const std::vector<PatchValues>& values)
{
    for (std::size_t p = 0; p < patches.size(); ++p)
    {
        if (patches[p].velocity != BoundaryPatch::Velocity::Fixed)
        {
            continue;
        }
        const MeshPatch& patch = mesh_.patches[patches[p].meshPatch];
        mesh_.dim == 2 ? addFaces<2>(patch, u, cover) : addFaces<3>(patch, u, cover);
        const bool isInflow = patches[p].phase == BoundaryPatch::Phase::Inflow;
        for (std::size_t k = 0; k < patches[p].nodes.size(); ++k)
        {
            const int i = patches[p].nodes[k];
            if (i < mesh_.nOwned && nodal_[i] != 0)
            {
                fluxes_.push_back({i, nodal_[i], isInflow ? values[p].alpha[k] : -1});
            }
            nodal_[i] = 0;
        }
    }
}

void TransportBoundary::markClosingNodes(const std::vector<BoundaryPatch>& patches, const std::vector<PatchValues>& values,
    const std::vector<char>& isPressureFixed)
{
    for (int i : closing_)
    {
        closingIndex_[i] = -1;
    }
    closing_.clear();
    closingAlpha_.clear();
    const auto mark = [&](int i, double alphaIn) {
        if (i >= mesh_.nOwned)
        {
            return;
        }
        if (closingIndex_[i] < 0)
        {
            closingIndex_[i] = static_cast<int>(closing_.size());
            closing_.push_back(i);
            closingAlpha_.push_back(alphaIn);
        }
        else if (closingAlpha_[closingIndex_[i]] < 0)
        {
            closingAlpha_[closingIndex_[i]] = alphaIn;
        }
    };
    for (std::size_t p = 0; p < patches.size(); ++p)
    {
        if (patches[p].velocity == BoundaryPatch::Velocity::Open)
        {
            const bool isInflow = patches[p].phase == BoundaryPatch::Phase::Inflow;
            for (std::size_t k = 0; k < patches[p].nodes.size(); ++k)
            {
                mark(patches[p].nodes[k], isInflow ? values[p].alpha[k] : -1);
            }
        }
    }
    for (int i = 0; i < mesh_.nOwned && !isPressureFixed.empty(); ++i)
    {
        if (isPressureFixed[i])
        {
            mark(i, -1);
        }
    }
    closingSum_.assign(closing_.size(), 0);
}

void TransportBoundary::close(const std::vector<double>& u, const std::vector<double>& fineScale, const Cover* cover,
    const std::vector<PairFlux>& pairFlux)
{
    const int dim = mesh_.dim, n = dim + 1;
    for (std::size_t c = 0; c < closing_.size(); ++c)
    {
        const int i = closing_[c];
        for (int k = graph_.nodeElementStart[i]; k < graph_.nodeElementStart[i + 1]; ++k)
        {
            const int e = graph_.nodeElement[k];
            const int* nodes = &mesh_.elements[std::size_t(e)*n];
            closingSum_[c] += volumeFlux_.row(e, static_cast<int>(std::find(nodes, nodes + n, i) - nodes), u, fineScale, cover);
        }
    }
    const auto add = [&](int i, double flux) {
        if (closingIndex_[i] >= 0)
        {
            closingSum_[closingIndex_[i]] += flux;
        }
    };
    for (const PairFlux& pair : pairFlux)
    {
        add(pair.a, pair.flux);
        add(pair.b, -pair.flux);
    }
    for (const BoundaryFlux& given : fluxes_)
    {
        add(given.node, given.flux);
    }
    if (cover && !closing_.empty())     // through the solids' surfaces, by which the dual cell changes its volume
    {
        for (const CutElement& cut : cover->cuts)
        {
            const int* nodes = &mesh_.elements[std::size_t(cut.element)*n];
            if (std::none_of(nodes, nodes + n, [&](int i) { return closingIndex_[i] >= 0; }))
            {
                continue;
            }
            forEachFacet(*cover, cut.element, [&](const CutFacet& facet, double share)
            {
                for (int q = 0; q < facet.nPoints; ++q)
                {
                    double through = 0;
                    for (int a = 0; a < n; ++a)
                    {
                        for (int d = 0; d < dim; ++d)
                        {
                            through += share*facet.weight[q]*facet.shape[q][a]*u[std::size_t(nodes[a])*dim + d]*facet.normal[d];
                        }
                    }
                    for (int a = 0; a < n; ++a)
                    {
                        add(nodes[a], facet.shape[q][a]*through);
                    }
                }
            });
        }
    }
    for (std::size_t c = 0; c < closing_.size(); ++c)
    {
        fluxes_.push_back({closing_[c], -closingSum_[c], closingAlpha_[c]});
    }
}

void TransportBoundary::evaluate(const std::vector<double>& u, const std::vector<double>& fineScale, const Cover* cover,
    const std::vector<BoundaryPatch>& patches, const std::vector<PatchValues>& values,
    const std::vector<char>& isPressureFixed, const std::vector<PairFlux>& pairFlux)
{
    fluxes_.clear();
    addGivenVelocity(u, cover, patches, values);
    markClosingNodes(patches, values, isPressureFixed);
    close(u, fineScale, cover, pairFlux);
}

} // namespace flotsam
