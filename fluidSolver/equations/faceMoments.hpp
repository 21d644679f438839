// SPDX-License-Identifier: GPL-3.0-or-later
/// Integrals over the fluid part of a patch face.
#pragma once

#include "geometry/cover.hpp"
#include "geometry/cutSimplex.hpp"

#include <algorithm>

namespace flotsam
{

/// int N_k and int N_k N_l over the fluid part of a face, over the face's area (shape functions of the face itself).
template<int D>
struct FaceMoments
{
    double second[D*D], first[D];

    /// cover: null without solids; nodes: D of the face, which is the element's.
    FaceMoments(const SimplexMesh& mesh, const Cover* cover, int element, const int* nodes)
    {
        if (cover && !cover->patchFaces.empty() && takeCut(mesh, *cover, element, nodes)) return;
        double distance[D];
        int nSolid = 0;
        for (int k = 0; k < D; ++k)
        {
            distance[k] = cover ? cover->distance[nodes[k]] : 1;
            nSolid += distance[k] < 0;
        }
        if (nSolid == 0) fill(1);
        else if (nSolid == D) fill(0);
        else integrateCut(distance);
        sumRows();
    }

private:
    void sumRows()
    {
        for (int k = 0; k < D; ++k)
        {
            first[k] = 0;
            for (int l = 0; l < D; ++l) first[k] += second[k*D + l];
        }
    }

    bool takeCut(const SimplexMesh& mesh, const Cover& cover, int element, const int* nodes)
    {
        const int* corners = &mesh.elements[std::size_t(element)*(D + 1)];
        int place[D], sum = 0;
        for (int k = 0; k < D; ++k) sum += place[k] = int(std::find(corners, corners + D + 1, nodes[k]) - corners);
        const CutPatchFace* face = patchFaceOf(&cover, element, D*(D + 1)/2 - sum);
        if (!face) return false;
        for (int k = 0; k < D; ++k)
            for (int l = 0; l < D; ++l) second[k*D + l] = face->second[place[k]*(D + 1) + place[l]];
        sumRows();
        return true;
    }

    void fill(double share)
    {
        for (int k = 0; k < D; ++k)
            for (int l = 0; l < D; ++l) second[k*D + l] = share*(k == l ? 2. : 1.)/(D*(D + 1));
    }

    void integrateCut(const double* distance)
    {
        if constexpr (D == 3)
        {
            constexpr double vertices[6] = {0, 0, 1, 0, 0, 1}, gradN[6] = {-1, -1, 1, 0, 0, 1};
            const SimplexCut<2> cut = cutSimplex<2>(distance, 0.5, vertices, gradN);
            for (int m = 0; m < 9; ++m) second[m] = 2*cut.second[m];
        }
        else
        {
            // the edge from its fluid end, of which the part s in [0, t] is fluid: N = 1 - s there, s at the other end
            const int fluid = distance[0] > 0 ? 0 : 1, solid = 1 - fluid;
            const double t = distance[fluid]/(distance[fluid] - distance[solid]);
            second[fluid*2 + fluid] = (1 - (1 - t)*(1 - t)*(1 - t))/3;
            second[solid*2 + solid] = t*t*t/3;
            second[1] = second[2] = t*t/2 - t*t*t/3;
        }
    }
};

} // namespace flotsam
