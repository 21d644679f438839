// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/solidEdges.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

/// Free bodies have none: they go with the water around, and their motion is not known before the solve. Nor have the faces that stand for what is round, and unions.
bool hasEdges(const Solid& solid)
{
    double distance[maxFaces];
    const bool isStructure = solid.kind != Solid::Kind::Free && !(solid.isThin && solid.isLoose);
    return isStructure && solid.shape->nParts() == 1 && !SolidPart(solid, 0).isReplaced() && SolidPart(solid, 0).faceDistances(solid.pose.position, distance) > 1;
}

/// Of the solid's faces the one that a facet group lies on, as a bit; 0: it cuts an edge off and lies on none.
template<int D>
int faceOf(const FacetGroup<D>& group, const SimplexMesh& mesh, const Solid& solid)
{
    constexpr double leastCosine = 0.95, step = 0.01;   // of the angle to the face; over the element length
    const int* nodes = &mesh.elements[std::size_t(group.element)*(D + 1)];
    const double length = step*mesh.h[group.element];
    Vec3 centre = Vec3::Zero(), deeper;
    for (int a = 0; a <= D; ++a)
    {
        const std::array<double, 3> x = mesh.spacePoint(nodes[a]);
        for (int d = 0; d < 3; ++d) centre[d] += group.m1[a]/group.area*x[d];
    }
    deeper = centre;
    for (int d = 0; d < D; ++d) deeper[mesh.axes[d]] += length*group.normal[d];
    double here[maxFaces], inside[maxFaces];
    const SolidPart part(solid, 0);
    const int n = part.faceDistances(centre, here);
    part.faceDistances(deeper, inside);
    const auto face = std::min_element(here, here + n, [](double l, double r) { return std::abs(l) < std::abs(r); }) - here;
    return here[face] - inside[face] > leastCosine*length ? 1 << face : 0;
}

bool areTwo(int faces) { return (faces & (faces - 1)) != 0; }   // or more

} // namespace

template<int D>
void SolidEdges::find(const std::vector<FacetGroup<D>>& groups, const SimplexMesh& mesh, const Halo& halo, const Cover& cover, const std::vector<Solid>& solids)
{
    constexpr int N = D + 1;
    elements_.clear();
    has_.resize(solids.size());
    std::transform(solids.begin(), solids.end(), has_.begin(), hasEdges);
    isAny_ = std::any_of(has_.begin(), has_.end(), [](char has) { return has; });
    if (!isAny_) return;
    const auto isInside = [&](int node, int solid) { return cover.distance[node] < 0 && cover.nearestSolid[node] == solid; };
    faceOfGroup_.assign(groups.size(), 0);
    facesAt_.assign(mesh.nNodes, 0);
    groupsOf_.assign(mesh.nElements, 0);
    for (std::size_t g = 0; g < groups.size(); ++g)
    {
        ++groupsOf_[groups[g].element];
        if (!has_[groups[g].solid]) continue;
        faceOfGroup_[g] = faceOf(groups[g], mesh, solids[groups[g].solid]);
        const int* nodes = &mesh.elements[std::size_t(groups[g].element)*N];
        for (int a = 0; a < N; ++a)
            if (nodes[a] < mesh.nOwned && isInside(nodes[a], groups[g].solid)) facesAt_[nodes[a]] |= faceOfGroup_[g];
    }
    halo.update(facesAt_, 1);   // copies do not see all of their elements
    for (std::size_t g = 0; g < groups.size(); ++g)
    {
        if (!faceOfGroup_[g] || groupsOf_[groups[g].element] > 1) continue;
        const int* nodes = &mesh.elements[std::size_t(groups[g].element)*N];
        const double* n = groups[g].normal;
        Element edge{{groups[g].element}, groups[g].solid, {}};
        std::copy_n(n, D, edge.normal);
        bool isAt = false;
        for (int a = 0; a < N; ++a)
        {
            if (!isInside(nodes[a], edge.solid) || !areTwo(facesAt_[nodes[a]])) continue;
            isAt = true;
            for (int k = 0; k < D*D; ++k) edge.across[a][k] = n[k/D]*n[k % D];
        }
        if (isAt) elements_.push_back(edge);
    }
}

template void SolidEdges::find<2>(const std::vector<FacetGroup<2>>&, const SimplexMesh&, const Halo&, const Cover&, const std::vector<Solid>&);
template void SolidEdges::find<3>(const std::vector<FacetGroup<3>>&, const SimplexMesh&, const Halo&, const Cover&, const std::vector<Solid>&);

} // namespace flotsam
