// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/nodeGraph.hpp"
#include "support/boxMesh.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

using namespace flotsam;

namespace
{

SimplexMesh makeMesh(int dim, bool alternate = false)
{
    return makeBoxMesh(MPI_COMM_SELF, dim, {5, 4, 3}, {-1, 0.5, 0}, {1, 2, 0.7}, 0.15, alternate);
}

} // namespace

TEST_CASE("gradients of the shape functions sum to zero and reproduce linear functions")
{
    for (const int dim : {2, 3})
    {
        const SimplexMesh mesh = makeMesh(dim);
        const int n = dim + 1;
        const double slope[3] = {1.5, -2, 0.25};
        double worstSum = 0, worstSlope = 0;
        for (int e = 0; e < mesh.nElements; ++e)
        {
            for (int d = 0; d < dim; ++d)
            {
                double sum = 0, gradient = 0;
                for (int a = 0; a < n; ++a)
                {
                    const double g = mesh.gradN[(e * n + a) * dim + d];
                    const double* x = &mesh.x[mesh.elements[e * n + a] * dim];
                    sum += g;
                    gradient += g * (3 + slope[0] * x[0] + slope[1] * x[1] + (dim == 3 ? slope[2] * x[2] : 0));
                }
                worstSum = std::max(worstSum, std::abs(sum));
                worstSlope = std::max(worstSlope, std::abs(gradient - slope[d]));
            }
        }
        CHECK(worstSum < 1e-12);
        CHECK(worstSlope < 1e-11);
    }
}

TEST_CASE("the elements fill the box")
{
    for (const bool alternate : {false, true})
    {
        for (const int dim : {2, 3})
        {
            const SimplexMesh mesh = makeMesh(dim, alternate);
            double volume = 0;
            for (const double v : mesh.volume)
            {
                CHECK(v > 0);
                volume += v;
            }
            CHECK(volume == near(dim == 2 ? 3.0 : 2.1, 1e-14));
            CHECK(mesh.nElements == (dim == 2 ? 5 * 4 * 2 : 5 * 4 * 3 * 6));
        }
    }
}

TEST_CASE("an inverted element is turned, a flat one is refused")
{
    SimplexMesh mesh;
    mesh.dim = 2;
    mesh.nNodes = mesh.nOwned = 3;
    mesh.nElements = mesh.nInnerElements = 1;
    mesh.x = {0, 0, 2, 0, 0, 1};
    mesh.elements = {0, 2, 1};
    mesh.computeGeometry();
    CHECK(mesh.volume[0] == near(1, 1e-14));
    CHECK(mesh.h[0] == near(std::sqrt(2.0), 1e-14));
    CHECK(mesh.elements == std::vector<int>{0, 1, 2});
    mesh.x = {0, 0, 2, 2, 1, 1};
    CHECK_THROWS_AS(mesh.computeGeometry(), std::runtime_error);
}

TEST_CASE("slots lead to the columns, columns are the nodes that share an element")
{
    for (const int dim : {2, 3})
    {
        const SimplexMesh mesh = makeMesh(dim);
        const NodeGraph graph(mesh);
        const int n = dim + 1;
        std::vector<std::set<int>> neighbours(mesh.nNodes);
        bool slotsRight = true;
        for (int e = 0; e < mesh.nInnerElements; ++e)
        {
            for (int k = 0; k < n * n; ++k)
            {
                const int row = mesh.elements[e * n + k / n], column = mesh.elements[e * n + k % n];
                const int slot = graph.slot(row, e * n * n + k);
                neighbours[row].insert(column);
                slotsRight = slotsRight && graph.column[slot] == column && slot >= graph.rowStart[row] && slot < graph.rowStart[row + 1];
            }
        }
        CHECK(slotsRight);
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            const std::vector<int> row(graph.column.begin() + graph.rowStart[i], graph.column.begin() + graph.rowStart[i + 1]);
            CHECK(row == std::vector<int>(neighbours[i].begin(), neighbours[i].end()));
            CHECK(graph.column[graph.diagonal[i]] == i);
        }
    }
}

TEST_CASE("every face is interior once or on a patch once")
{
    for (const bool alternate : {false, true})
    {
        for (const int dim : {2, 3})
        {
            const SimplexMesh mesh = makeMesh(dim, alternate);
            const NodeGraph graph(mesh);
            std::size_t boundary = 0;
            for (const MeshPatch& patch : mesh.patches)
            {
                boundary += patch.faceElement.size();
            }
            CHECK(2 * graph.faces.size() + boundary == static_cast<std::size_t>(mesh.nElements) * (dim + 1));
            bool oppositeRight = true;
            for (const InteriorFace& face : graph.faces)
            {
                for (int side = 0; side < 2; ++side)
                {
                    const auto begin = mesh.elements.begin();
                    const int own = face.element[side] * (dim + 1), other = face.element[1 - side] * (dim + 1);
                    const int node = face.opposite[side];
                    oppositeRight = oppositeRight && std::count(begin + own, begin + own + dim + 1, node) == 1
                        && std::count(begin + other, begin + other + dim + 1, node) == 0;
                }
            }
            CHECK(oppositeRight);
        }
    }
}
