// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/linearExtension.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

/// A value and its gradient, D, then 1 where they are known: of every node.
template<int D>
struct Continued
{
    static constexpr int N = D + 1, width = D + 2, known = D + 1;

    Continued(const SimplexMesh& mesh, const Halo& halo, const Cover& cover) : mesh(mesh), halo(halo), cover(cover), of(std::size_t(mesh.nNodes)*width, 0.0) {}

    double* at(int i) { return &of[std::size_t(i)*width]; }
    bool isKnown(int i) const { return of[std::size_t(i)*width + known] > 0; }
    const int* nodes(int e) const { return &mesh.elements[std::size_t(e)*N]; }
    bool bordersUnknown(int e) const
    {
        const int known = int(std::count_if(nodes(e), nodes(e) + N, [this](int i) { return isKnown(i); }));
        return known > 0 && known < N;
    }

    const SimplexMesh& mesh;
    const Halo& halo;
    const Cover& cover;
    std::vector<double> of;
};

template<int D>
void start(Continued<D>& c, const std::vector<double>& values)
{
    for (int i = 0; i < c.mesh.nNodes; ++i)
    {
        c.at(i)[0] = values[i];
        c.at(i)[Continued<D>::known] = c.cover.isActiveNode[i] ? 1 : 0;
    }
    c.halo.update(c.of, Continued<D>::width);   // a second-ring copy may not see the fluid element that makes it active
}

/// Gradients of the known nodes beside unknown ones.
template<int D>
void setGradients(Continued<D>& c)
{
    constexpr int N = D + 1;
    std::vector<char> isWanted(c.mesh.nNodes, 0);
    for (int e = 0; e < c.mesh.nElements; ++e)
        if (c.bordersUnknown(e))
            for (int a = 0; a < N; ++a) isWanted[c.nodes(e)[a]] = c.isKnown(c.nodes(e)[a]);
    std::vector<double> volume(c.mesh.nNodes, 0.0);
    for (int e = 0; e < c.mesh.nElements; ++e)
    {
        const int* nodes = c.nodes(e);
        const double fluid = fluidVolume(c.mesh, &c.cover, e);
        if (fluid <= 0 || std::none_of(nodes, nodes + N, [&](int i) { return isWanted[i]; })) continue;
        double gradient[D] = {};
        for (int a = 0; a < N; ++a)
            for (int d = 0; d < D; ++d) gradient[d] += c.at(nodes[a])[0]*c.mesh.gradN[(std::size_t(e)*N + a)*D + d];
        for (int a = 0; a < N; ++a)
        {
            volume[nodes[a]] += fluid;
            for (int d = 0; d < D; ++d) c.at(nodes[a])[1 + d] += fluid*gradient[d];
        }
    }
    for (int i = 0; i < c.mesh.nNodes; ++i)
        for (int d = 0; d < D; ++d) c.at(i)[1 + d] *= isWanted[i] && volume[i] > 0 ? 1/volume[i] : 0;
    c.halo.update(c.of, Continued<D>::width);
}

/// Adds what the known nodes of an element say of the unknown ones; the count goes where these say that they are not known.
template<int D>
void addNeighbours(Continued<D>& c, int e, std::vector<double>& sums)
{
    constexpr int width = Continued<D>::width;
    const int* nodes = c.nodes(e);
    for (int a = 0; a <= D; ++a)
    {
        if (c.isKnown(nodes[a])) continue;
        double* sum = &sums[std::size_t(nodes[a])*width];
        for (int b = 0; b <= D; ++b)
        {
            if (!c.isKnown(nodes[b])) continue;
            const double* of = c.at(nodes[b]);
            double value = of[0];
            for (int d = 0; d < D; ++d)
            {
                value += of[1 + d]*(c.mesh.x[std::size_t(nodes[a])*D + d] - c.mesh.x[std::size_t(nodes[b])*D + d]);
                sum[1 + d] += of[1 + d];
            }
            sum[0] += value;
            sum[width - 1] += 1;
        }
    }
}

template<int D>
void extend(const SimplexMesh& mesh, const Halo& halo, const Cover& cover, std::vector<double>& values, int nRings)
{
    constexpr int width = Continued<D>::width;
    Continued<D> c(mesh, halo, cover);
    start(c, values);
    setGradients(c);
    std::vector<double> sums;
    for (int ring = 0; ring < nRings; ++ring)
    {
        sums.assign(c.of.size(), 0.0);
        for (int e = 0; e < mesh.nElements; ++e)
            if (c.bordersUnknown(e)) addNeighbours(c, e, sums);
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            const double* sum = &sums[std::size_t(i)*width];
            if (sum[width - 1] > 0)
                for (int k = 0; k < width; ++k) c.at(i)[k] = sum[k]/sum[width - 1];
        }
        halo.update(c.of, width);
    }
    for (int i = 0; i < mesh.nNodes; ++i) values[i] = c.at(i)[0];
}

} // namespace

void extendLinearly(const SimplexMesh& mesh, const Halo& halo, const Cover& cover, std::vector<double>& values, int nRings)
{
    if (!halo.any(std::find(cover.isActiveNode.begin(), cover.isActiveNode.end(), 0) != cover.isActiveNode.end())) return;
    if (mesh.dim == 2) extend<2>(mesh, halo, cover, values, nRings);
    else extend<3>(mesh, halo, cover, values, nRings);
}

} // namespace flotsam
