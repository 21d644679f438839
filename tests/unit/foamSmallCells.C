// SPDX-License-Identifier: GPL-3.0-or-later
/// Cells of a millimetre and less are divided as large ones are, with floating-point errors trapped, as OpenFOAM traps them.
#include "support/bodiesScene.H"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cfenv>

using namespace flotsam;

namespace
{

/// Ends the test where a number overflows, as long as it lives.
class Trapped
{
public:
    Trapped() : before_(fegetexcept()) { feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW); }
    ~Trapped()
    {
        fedisableexcept(FE_ALL_EXCEPT);
        feenableexcept(before_);
    }
    Trapped(const Trapped&) = delete;
    Trapped& operator=(const Trapped&) = delete;

private:
    int before_;
};

/// Cells that narrow upwards to a hundredth: from some of their points no good tetrahedra go out, from others none that fill them.
MeshAdapter spire(double scale)
{
    std::vector<FoamCase::Edit> edits = BodiesScene::edits(true);
    edits.push_back({"system/blockMeshDict3d", "(8 6 4)", "(4 4 1)"});
    edits.push_back({"system/blockMeshDict3d", "(0 0 0.4) (2 0 0.4) (2 1 0.4) (0 1 0.4)", "(0.9 0.42 0.4) (0.92 0.42 0.4) (0.924 0.431 0.4) (0.9 0.43 0.4)"});
    FoamCase foam("foamChannel", edits, "blockMeshDict3d");
    foam.mesh().movePoints(Foam::pointField(scale*foam.mesh().points()));
    const Trapped trapped;
    return makeSimplexMesh(foam.mesh(), MPI_COMM_WORLD);
}

} // namespace

TEST_CASE("3D: cells of a millimetre are divided, too, and fill the mesh")
{
    constexpr double scale = 1e-3;
    const MeshAdapter large = spire(1), small = spire(scale);
    const auto volume = [](const MeshAdapter& a)
    {
        double sum = 0;
        for (int e = 0; e < a.mesh.nElements; ++e) sum += a.mesh.isOwnedElement[e] ? a.mesh.volume[e] : 0;
        return Halo(a.mesh, MPI_COMM_WORLD).sum(sum);
    };
    REQUIRE(large.mesh.nElements > 12);
    CHECK(volume(small) == near(scale*scale*scale*volume(large), 1e-9));
}
