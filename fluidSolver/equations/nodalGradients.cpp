// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/nodalGradients.hpp"

namespace flotsam
{

void NodalGradients::find(const std::vector<double>& u, const Cover* cover)
{
    if (mesh_.dim == 2) findOf<2>(u, cover); else findOf<3>(u, cover);
}

template<int D>
void NodalGradients::findOf(const std::vector<double>& u, const Cover* cover)
{
    constexpr int N = D + 1;
    values_.assign(std::size_t(mesh_.nNodes)*D*D, 0.0);
    weight_.assign(mesh_.nNodes, 0.0);
    for (int e = 0; e < mesh_.nInnerElements; ++e)
    {
        if (cover && cover->state[e] == ElementState::Solid) continue;
        const int* nodes = &mesh_.elements[std::size_t(e)*N];
        double integral[D*D] = {};
        for (int a = 0; a < N; ++a)
        {
            const double *ua = &u[std::size_t(nodes[a])*D], *ga = &mesh_.gradN[(std::size_t(e)*N + a)*D];
            for (int k = 0; k < D; ++k)
                for (int l = 0; l < D; ++l) integral[k*D + l] += mesh_.volume[e]*ua[k]*ga[l];
        }
        for (int a = 0; a < N; ++a)
        {
            if (nodes[a] >= mesh_.nOwned) continue;
            weight_[nodes[a]] += mesh_.volume[e];
            for (int c = 0; c < D*D; ++c) values_[std::size_t(nodes[a])*D*D + c] += integral[c];
        }
    }
    for (int i = 0; i < mesh_.nOwned; ++i)
    {
        if (weight_[i] == 0) continue;
        for (int c = 0; c < D*D; ++c) values_[std::size_t(i)*D*D + c] /= weight_[i];
    }
    halo_.update(values_, D*D);
}

} // namespace flotsam
