// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/dualCells.hpp"
#include "support/boxMesh.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

using namespace flotsam;

TEST_CASE("share moments: the shares of all corners make up the simplex")
{
    for (const int dim : {2, 3})
    {
        const ShareMoments m = ShareMoments::of(dim);
        const int n = dim + 1;
        // mean of lambda_0 over the simplex is 1/n, of lambda_0^2 2/(n(n+1)), of lambda_0 lambda_1 1/(n(n+1))
        const double own = 1 - dim*m.first;
        CHECK((own + dim*m.first)/n == near(1./n, 1e-14));
        const double ownSquare = 1 - 2*dim*m.first + dim*m.square + dim*(dim - 1)*m.mixed;
        CHECK((ownSquare + dim*m.square)/n == near(2./(n*(n + 1)), 1e-14));
        const double ownMixed = m.first - m.square - (dim - 1)*m.mixed;
        CHECK((2*ownMixed + (dim - 1)*m.mixed)/n == near(1./(n*(n + 1)), 1e-14));
        CHECK(m.square > m.first*m.first);
    }
}

TEST_CASE("dual cells fill the mesh; their moments add up to those of the box")
{
    for (const int dim : {2, 3})
    {
        const SimplexMesh mesh = makeBoxMesh(MPI_COMM_SELF, dim, {5, 4, 3}, {0, 0, 0}, {1, 2, 3}, 0.15);
        const DualCells cells(mesh);
        const double volume = dim == 2 ? 2 : 6;
        double total = 0, first = 0, second = 0;
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            const double y = mesh.x[std::size_t(i)*dim + 1] + cells.centroid(i)[1];
            const double n[3] = {0, 1, 0};
            const double L = cells.halfWidth(i, n);
            const double K[6] = {0, 2, 0, 0, 0, 0};
            CHECK(cells.meanBend(i, K) == near(L*L/3, 1e-12));
            total += cells.volume(i);
            first += cells.volume(i)*y;
            second += cells.volume(i)*(y*y + L*L/3);
        }
        CHECK(total == near(volume, 1e-13));
        CHECK(first == near(volume, 1e-13));
        CHECK(second == near(volume*4/3, 1e-13));
    }
}
