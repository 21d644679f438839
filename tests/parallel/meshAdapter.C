// SPDX-License-Identifier: GPL-3.0-or-later
/// The meshes of support/makeMeshCases.sh, read whole by every rank and decomposed by all of them.
#include "algebra/halo.hpp"
#include "foam/meshAdapter.H"
#include "foam/simplexSplit.H"
#include "foam/splitOrder.H"
#include "support/meshChecks.hpp"
#include "support/near.hpp"

#include "Time.H"
#include "argList.H"
#include "ListOps.H"
#include "cellModel.H"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <utility>

using namespace flotsam;

namespace
{

const std::string caseFolder = FLOTSAM_MESH_CASES;

int rankOf(MPI_Comm comm)
{
    int rank = 0;
    MPI_Comm_rank(comm, &rank);
    return rank;
}

int sizeOf(MPI_Comm comm)
{
    int size = 1;
    MPI_Comm_size(comm, &size);
    return size;
}

/// OpenFOAM's parallel mode, once per process. Never destroyed: its destructor ends the process.
void startFoam()
{
    static Foam::argList* args = nullptr;
    if (args) return;
    const int size = sizeOf(MPI_COMM_WORLD);
    static std::string words[4] = {"test", "-case", caseFolder + "/obstacle.np" + std::to_string(size), "-parallel"};
    static char* pointers[5] = {&words[0][0], &words[1][0], &words[2][0], &words[3][0], nullptr};
    int argc = size > 1 ? 4 : 3;
    char** argv = pointers;
    Foam::argList::noBanner();
    args = new Foam::argList(argc, argv);
    Foam::FatalError.throwExceptions();
    // every rank reads the whole case for itself: no reading of shared dictionaries by the master alone
    Foam::regIOobject::fileModificationChecking = Foam::regIOobject::timeStamp;
}

/// A time and its mesh: the whole case (read outside OpenFOAM's parallel mode), or this rank's part.
class FoamMesh
{
public:
    FoamMesh(const std::string& name, MPI_Comm comm)
    {
        startFoam();
        const bool wasParallel = Foam::UPstream::parRun();
        Foam::UPstream::parRun() = sizeOf(comm) > 1;
        const int size = sizeOf(comm);
        const std::string part = size > 1 ? "/processor" + std::to_string(rankOf(comm)) : "";
        time_.reset(new Foam::Time(Foam::Time::controlDictName, caseFolder, name + ".np" + std::to_string(size) + part));
        mesh_.reset(new Foam::polyMesh(Foam::IOobject(
            Foam::polyMesh::defaultRegion, time_->timeName(), *time_, Foam::IOobject::MUST_READ)));
        try
        {
            adapter_ = makeSimplexMesh(*mesh_, comm);
        }
        catch (const Foam::error& problem)
        {
            message_ = problem.message();
        }
        mesh_->cellVolumes();
        Foam::UPstream::parRun() = wasParallel;
    }

    const Foam::polyMesh& foam() const { return *mesh_; }
    const MeshAdapter& adapter() const { return adapter_; }
    const std::string& message() const { return message_; } ///< of the FatalError, if any

private:
    std::unique_ptr<Foam::Time> time_;
    std::unique_ptr<Foam::polyMesh> mesh_;
    MeshAdapter adapter_;
    std::string message_;
};

/// Largest relative difference between a cell's volume and that of its simplices.
double cellVolumeError(const Foam::polyMesh& foam, const MeshAdapter& adapter)
{
    double worst = 0;
    for (Foam::label c = 0; c < foam.nCells(); ++c)
    {
        double volume = 0;
        for (Foam::label k = adapter.cellStart[c]; k < adapter.cellStart[c + 1]; ++k)
        {
            const int e = adapter.cellElements[k];
            volume += adapter.mesh.volume[e];
        }
        const double exact = foam.cellVolumes()[c];
        worst = std::max(worst, std::abs(volume * adapter.mesh.thickness - exact) / exact);
    }
    return worst;
}

/// Largest distance between a point and its node in space; 2D: along the plane.
double pointError(const Foam::polyMesh& foam, const MeshAdapter& adapter)
{
    const SimplexMesh& mesh = adapter.mesh;
    double worst = 0;
    for (Foam::label i = 0; i < foam.nPoints(); ++i)
    {
        const auto x = mesh.spacePoint(adapter.pointNode[i]);
        for (int d = 0; d < mesh.dim; ++d)
        {
            worst = std::max(worst, std::abs(x[mesh.axes[d]] - foam.points()[i][mesh.axes[d]]));
        }
    }
    return worst;
}

/// Smallest element over its cell.
double worstElement(const Foam::polyMesh& foam, const MeshAdapter& adapter)
{
    double worst = 1;
    for (Foam::label c = 0; c < foam.nCells(); ++c)
    {
        for (Foam::label k = adapter.cellStart[c]; k < adapter.cellStart[c + 1]; ++k)
        {
            worst = std::min(worst, adapter.mesh.volume[adapter.cellElements[k]] * adapter.mesh.thickness / foam.cellVolumes()[c]);
        }
    }
    return worst;
}

/// What lean to one side in the plane of axes a and b, less what lean to the other, of all diagonals in that plane, or of those of up to a length.
double lean(const SimplexMesh& mesh, int a, int b, double longest = 1e300)
{
    const int n = mesh.dim + 1;
    double sum = 0, count = 0;
    for (int e = 0; e < mesh.nElements; ++e)
    {
        for (int i = 0; i < n; ++i)
        {
            for (int j = 0; j < i; ++j)
            {
                const auto x = mesh.spacePoint(mesh.elements[std::size_t(e) * n + i]), y = mesh.spacePoint(mesh.elements[std::size_t(e) * n + j]);
                const double da = x[a] - y[a], db = x[b] - y[b], dc = x[3 - a - b] - y[3 - a - b];
                const double shorter = std::min(std::abs(da), std::abs(db)), longer = std::max(std::abs(da), std::abs(db));
                const bool isDiagonal = shorter > 0.3 * longer && std::abs(dc) < 0.3 * longer && std::hypot(da, db) < longest;
                sum += isDiagonal ? (da * db > 0 ? 1 : -1) : 0;
                count += isDiagonal;
            }
        }
    }
    return sum / count;
}

bool isConforming(const SimplexMesh& mesh)
{
    const NodeGraph graph(mesh);
    std::size_t boundary = 0;
    for (const MeshPatch& patch : mesh.patches)
    {
        boundary += patch.faceElement.size();
    }
    return 2 * graph.faces.size() + boundary == mesh.elements.size();
}

/// Relative difference of the mesh's volume and that of its simplices.
double totalVolumeError(const Foam::polyMesh& foam, const SimplexMesh& mesh)
{
    double exact = 0, found = 0;
    for (const double volume : foam.cellVolumes()) exact += volume;
    for (const double volume : mesh.volume) found += volume * mesh.thickness;
    return std::abs(found - exact) / exact;
}

/// Volume between the two pairs of triangles that the diagonals of warped boundary faces (quads) span, half of it, over the mesh's: OpenFOAM's faces
/// lie in the middle.
double warpedVolume(const Foam::polyMesh& foam)
{
    double total = 0, warped = 0;
    for (const double volume : foam.cellVolumes()) total += volume;
    const Foam::pointField& x = foam.points();
    for (Foam::label k = foam.nInternalFaces(); k < foam.nFaces(); ++k)
    {
        const Foam::face& f = foam.faces()[k];
        warped += std::abs(((x[f[1]] - x[f[0]]) ^ (x[f[2]] - x[f[0]])) & (x[f[3]] - x[f[0]])) / 12;
    }
    return warped / total;
}

void checkWhole(const FoamMesh& whole, double volumeTolerance)
{
    const MeshAdapter& adapter = whole.adapter();
    CHECK(totalVolumeError(whole.foam(), adapter.mesh) < volumeTolerance);
    CHECK(isConforming(adapter.mesh));
    CHECK(pointError(whole.foam(), adapter) == 0);
    CHECK(worstElement(whole.foam(), adapter) > 1e-4);
    CHECK(*std::max_element(adapter.mesh.originalNode.begin(), adapter.mesh.originalNode.end()) == adapter.mesh.nNodes - 1);
}

void compare(const SimplexMesh& whole, const SimplexMesh& share)
{
    const Halo one(whole, MPI_COMM_SELF), all(share, MPI_COMM_WORLD);
    CHECK(checkDistribution(share, all) == "");
    const MeshSummary expected = summarise(whole, NodeGraph(whole), one), found = summarise(share, NodeGraph(share), all);
    CHECK(found.elements == expected.elements);
    CHECK(found.nodes == expected.nodes);
    CHECK(found.splitDigest == expected.splitDigest);
    CHECK(found.volume == near(expected.volume, std::max(1e-13, 1.2e-16*double(expected.elements)))); // a sum in another order
    CHECK(found.laplacian == near(expected.laplacian, 2e-14));
    REQUIRE(found.patchArea.size() == expected.patchArea.size());
    double sum[3] = {0, 0, 0};
    for (std::size_t p = 0; p < expected.patchArea.size(); ++p)
    {
        CHECK(share.patches[p].name == whole.patches[p].name);
        CHECK(share.patches[p].type == whole.patches[p].type);
        CHECK(found.patchArea[p] == near(expected.patchArea[p], 1e-14));
        CHECK(found.nodalPatchArea[p] == near(expected.patchArea[p], 5e-14));
        for (int d = 0; d < 3; ++d)
        {
            sum[d] += found.patchNormal[p][d];
        }
    }
    for (const double component : sum)
    {
        CHECK(std::abs(component) < 1e-12); // a closed surface
    }
}

/// The mesh whole and decomposed. Simplices use a diagonal of warped faces where OpenFOAM uses their centre; what one cell
/// loses there its neighbour gains, so that the whole volume changes at warped boundaries only.
void checkCase(const std::string& name, int dim, double volumeTolerance)
{
    const bool hasWarpedFaces = dim == 3;
    const FoamMesh whole(name, MPI_COMM_SELF);
    REQUIRE(whole.message() == "");
    CHECK(whole.adapter().mesh.dim == dim);
    checkWhole(whole, volumeTolerance);

    const FoamMesh share(name, MPI_COMM_WORLD);
    REQUIRE(share.message() == "");
    CHECK((hasWarpedFaces || cellVolumeError(share.foam(), share.adapter()) < volumeTolerance));
    CHECK(pointError(share.foam(), share.adapter()) == 0);
    CHECK(share.adapter().mesh.thickness == whole.adapter().mesh.thickness);
    compare(whole.adapter().mesh, share.adapter().mesh);
}

} // namespace

TEST_CASE("2D: dam-break tank with an obstacle in the x-y plane")
{
    checkCase("obstacle", 2, 1e-10);
    const FoamMesh whole("obstacle", MPI_COMM_SELF);
    const SimplexMesh& mesh = whole.adapter().mesh;
    CHECK(mesh.nElements == 2 * whole.foam().nCells());
    CHECK(2 * mesh.nNodes == whole.foam().nPoints());
    CHECK(mesh.patches.size() == 4);
    CHECK(mesh.axes == std::array<int, 3>{0, 1, 2});
    CHECK(mesh.thickness == near(0.0146, 1e-14));
    CHECK(mesh.planeOffset == near(0.0073, 1e-14));
    CHECK(std::abs(lean(mesh, 0, 1)) < 0.05);
}

TEST_CASE("2D: locally refined block in the x-z plane")
{
    checkCase("upright", 2, 1e-10);
    const FoamMesh whole("upright", MPI_COMM_SELF);
    const SimplexMesh& mesh = whole.adapter().mesh;
    CHECK(whole.foam().nCells() > 160);
    CHECK(mesh.nElements > 2 * whole.foam().nCells()); // cells with hanging points give more than two
    CHECK(mesh.axes == std::array<int, 3>{2, 0, 1});
    CHECK(mesh.spacePoint(0)[1] == within(0, 1e-17));
}

TEST_CASE("in finer cells within others diagonals lean as often to one side as to the other, too")
{
    for (const std::string name : {"boxed", "boxed3D"})
    {
        const int dim = name == "boxed" ? 2 : 3;
        checkCase(name, dim, 1e-10);
        const FoamMesh whole(name, MPI_COMM_SELF);
        const double h = dim == 2 ? 1./16 : 1./8;
        for (int axis = dim == 2 ? 2 : 0; axis < (dim == 2 ? 3 : 2); ++axis)    // 3D: planes across the layers
        {
            const double all = lean(whole.adapter().mesh, (axis + 1) % 3, (axis + 2) % 3), fine = lean(whole.adapter().mesh, (axis + 1) % 3, (axis + 2) % 3, 0.9 * h);
            std::printf("%s, across axis %d: lean %.3f, of the finer cells %.3f\n", name.c_str(), axis, all, fine);
            CHECK(std::abs(all) < 0.05);
            CHECK(std::abs(fine) < 0.05);
        }
    }
}

TEST_CASE("3D: graded and skewed blocks")
{
    const FoamMesh whole("skewed", MPI_COMM_SELF);
    checkCase("skewed", 3, warpedVolume(whole.foam()));
    CHECK(whole.adapter().mesh.nElements == 6 * whole.foam().nCells());
    CHECK(whole.adapter().mesh.nNodes == whole.foam().nPoints());
    for (int axis = 0; axis < 3; ++axis)
    {
        CHECK(std::abs(lean(whole.adapter().mesh, (axis + 1) % 3, (axis + 2) % 3)) < 0.05);
    }
}

TEST_CASE("3D: prisms with hanging points have the same points inside on any number of ranks")
{
    checkCase("hanging", 3, 1e-12);
    const FoamMesh whole("hanging", MPI_COMM_SELF);
    CHECK(whole.adapter().mesh.nNodes > whole.foam().nPoints());
}

TEST_CASE("3D: polyhedra of snappyHexMesh")
{
    checkCase("snapped", 3, 1e-4);
    const FoamMesh whole("snapped", MPI_COMM_SELF);
    const Foam::cellModel& hex = Foam::cellModel::ref(Foam::cellModel::HEX);
    int nPolyhedra = 0;
    for (const Foam::cellShape& shape : whole.foam().cellShapes())
    {
        nPolyhedra += shape.model() != hex;
    }
    CHECK(nPolyhedra > 100);
    CHECK(whole.adapter().mesh.patches.back().name == "block");
}

TEST_CASE("without the numbers of the undecomposed mesh the ranks still agree on one mesh")
{
    const FoamMesh whole("bare", MPI_COMM_SELF), share("bare", MPI_COMM_WORLD);
    const SimplexMesh& mesh = share.adapter().mesh;
    const Halo one(whole.adapter().mesh, MPI_COMM_SELF), all(mesh, MPI_COMM_WORLD);
    CHECK(checkDistribution(mesh, all) == "");
    const MeshSummary expected = summarise(whole.adapter().mesh, NodeGraph(whole.adapter().mesh), one);
    const MeshSummary found = summarise(mesh, NodeGraph(mesh), all);
    CHECK(found.elements == expected.elements);
    CHECK(found.nodes == expected.nodes);
    CHECK(found.volume == near(expected.volume, 1e-14)); // the same diagonals of warped faces
    CHECK(found.patchArea[0] == near(expected.patchArea[0], 1e-14)); // a plane one
}

TEST_CASE("diagonals, elements and the order of their corners do not depend on numbers of points and where faces begin: whoever made the mesh, and on whatever processes")
{
    for (const std::string name : {"obstacle", "boxed3D", "skewed", "snapped", "hanging"})
    {
        CAPTURE(name);
        const FoamMesh whole(name, MPI_COMM_SELF);
        const Foam::polyMesh& mesh = whole.foam();
        const Foam::label n = mesh.nPoints(), stride = 7919;    // a prime, which divides none of these n
        Foam::labelList numbers(n);
        forAll(numbers, i) numbers[i] = Foam::label((std::int64_t(i)*stride + 17) % n);
        Foam::pointField points(n);
        forAll(points, i) points[numbers[i]] = mesh.points()[i];
        Foam::faceList faces(mesh.faces());
        for (Foam::face& f : faces) Foam::inplaceRenumber(numbers, f);
        for (Foam::face& f : faces) std::rotate(f.begin(), f.begin() + 1, f.end());
        const bool wasParallel = std::exchange(Foam::UPstream::parRun(), false);
        Foam::polyMesh other(Foam::IOobject("renumbered", mesh.time().timeName(), mesh.time(), Foam::IOobject::NO_READ, Foam::IOobject::NO_WRITE, false), std::move(points),
            std::move(faces), Foam::labelList(mesh.faceOwner()), Foam::labelList(mesh.faceNeighbour()), false);
        Foam::PtrList<Foam::polyPatch> sides(1);
        sides.set(0, new Foam::polyPatch("sides", mesh.nFaces() - mesh.nInternalFaces(), mesh.nInternalFaces(), 0, other.boundaryMesh(), "patch"));
        other.addPatches(sides, false);
        const Foam::labelList before = splitOrder(mesh, Foam::identity(n), 1), after = splitOrder(other, Foam::identity(n), 1);
        CHECK(Foam::labelList(Foam::UIndirectList<Foam::label>(after, numbers)) == before);
        if (name != "obstacle")     // a plane one
        {
            const Foam::labelList noPatches(mesh.nFaces() - mesh.nInternalFaces(), -1);
            std::vector<int> expected = splitIntoTetrahedra(mesh, before, noPatches).elements;
            for (int& vertex : expected) vertex = vertex < n ? numbers[vertex] : vertex;
            CHECK(splitIntoTetrahedra(other, after, noPatches).elements == expected);
        }
        Foam::UPstream::parRun() = wasParallel;
    }
}

TEST_CASE("meshes that cannot be solved are refused with the reason")
{
    const auto expectMessage = [](const std::string& name, const std::string& text)
    {
        const FoamMesh whole(name, MPI_COMM_SELF);
        INFO(whole.message());
        CHECK(whole.message().find(text) != std::string::npos);
    };
    expectMessage("cyclic", "patch x0");
    expectMessage("cyclic", "type cyclic");
    expectMessage("wedge", "type wedge");
    expectMessage("layers", "not one cell thick");
}
