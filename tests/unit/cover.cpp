// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/coverBuilder.hpp"
#include "support/boxMesh.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

using namespace flotsam;

namespace
{

struct Scene
{
    SimplexMesh mesh;
    NodeGraph graph;
    Halo halo;

    Scene(int dim, int n, MPI_Comm comm = MPI_COMM_WORLD) : Scene(dim, std::array{n, n, n}, comm) {}

    Scene(int dim, std::array<int, 3> n, MPI_Comm comm = MPI_COMM_WORLD)
        : mesh(makeBoxMesh(comm, dim, n, {-1, -1, -1}, {1, 1, 1}, 0.15, true)), graph(mesh), halo(mesh, comm)
    {
    }
};

Solid makeSolid(std::shared_ptr<const Shape> shape, const Vec3& position, Solid::Kind kind)
{
    Solid s;
    s.kind = kind;
    s.shape = std::move(shape);
    s.pose.position = position;
    s.pose.orientation = Eigen::AngleAxisd(0.4, Vec3::UnitZ()) * Eigen::AngleAxisd(kind == Solid::Kind::Fixed ? 0 : 0.2, Vec3::UnitX());
    return s;
}

/// A fixed cylinder, a box and a sphere that move, box and cylinder close to each other.
std::vector<Solid> makeSolids(double time)
{
    return {makeSolid(makeCylinder({0, 0, -0.6}, {0, 0, 0.6}, 0.2), {-0.45, 0.1, 0}, Solid::Kind::Fixed),
            makeSolid(makeBox(Vec3::Zero(), {0.5, 0.3, 1}), {0.08 + 0.05 * time, 0.11, 0.02}, Solid::Kind::Free),
            makeSolid(makeSphere(Vec3::Zero(), 0.25), {0.4, -0.45 - 0.1 * time, 0.03}, Solid::Kind::Prescribed)};
}

/// Totals that must not depend on the order in which a cover was made.
std::vector<double> summary(const Scene& scene, const Cover& cover)
{
    const SimplexMesh& mesh = scene.mesh;
    std::vector<double> sums(12, 0);
    for (int e = 0; e < mesh.nElements; ++e)
    {
        if (!mesh.isOwnedElement[e]) continue;
        sums[static_cast<int>(cover.state[e])] += 1;
        if (cover.cutIndex[e] < 0) continue;
        const CutElement& cut = cover.cuts[cover.cutIndex[e]];
        sums[3] += cut.volume;
        for (int f = cut.facetStart; f < cut.facetEnd; ++f) sums[4 + cover.facets[f].solid] += cover.facets[f].area;
    }
    for (int i = 0; i < mesh.nOwned; ++i) sums[7] += cover.isActiveNode[i];
    for (const GhostFace& ghost : cover.ghostFaces)
    {
        // half from either side: once over all ranks
        const int e = scene.graph.faces[ghost.face].element[0], other = scene.graph.faces[ghost.face].element[1];
        const double share = 0.5 * (mesh.isOwnedElement[e] + mesh.isOwnedElement[other]);
        sums[8] += share;
        sums[9] += share * ghost.area;
    }
    scene.halo.sum(sums.data(), static_cast<int>(sums.size()));
    sums[10] = static_cast<double>(cover.nSharedElements);
    sums.insert(sums.end(), cover.solidVolume.begin(), cover.solidVolume.end());
    sums.insert(sums.end(), cover.solidArea.begin(), cover.solidArea.end());
    return sums;
}

/// Area from the face's nodes; unit normal across its edges, from element 0 to element 1.
void checkFaceGeometry(const SimplexMesh& mesh, const InteriorFace& face, const GhostFace& ghost)
{
    auto point = [&](int node)
    {
        const auto x = mesh.spacePoint(node);
        return Vec3(x[0], x[1], x[2]);
    };
    std::vector<Vec3> x;
    for (int a = 0; a <= mesh.dim; ++a)
    {
        const int node = mesh.elements[face.element[0] * (mesh.dim + 1) + a];
        if (node != face.opposite[0]) x.push_back(point(node));
    }
    REQUIRE(static_cast<int>(x.size()) == mesh.dim);
    const double area = mesh.dim == 2 ? (x[1] - x[0]).norm() : 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
    const Vec3 normal(ghost.normal[0], ghost.normal[1], ghost.normal[2]);
    CHECK(ghost.area == doctest::Approx(area).epsilon(1e-12));
    CHECK(normal.norm() == doctest::Approx(1).epsilon(1e-12));
    for (std::size_t k = 1; k < x.size(); ++k) CHECK(std::abs(normal.dot(x[k] - x[0])) < 1e-12);
    CHECK(normal.dot(point(face.opposite[0]) - x[0]) < 0);
    CHECK(normal.dot(point(face.opposite[1]) - x[0]) > 0);
}

void checkSame(const std::vector<double>& a, const std::vector<double>& b)
{
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) CHECK(a[i] == doctest::Approx(b[i]).epsilon(1e-12));
}

} // namespace

TEST_CASE("states, cut indices and facets fit together")
{
    for (const int dim : {2, 3})
    {
        const Scene scene(dim, dim == 2 ? 40 : 16);
        const SimplexMesh& mesh = scene.mesh;
        const std::vector<Solid> solids = makeSolids(0);
        CoverBuilder builder(mesh, scene.graph, scene.halo);
        const Cover& cover = builder.build(solids);
        std::vector<char> isActive(mesh.nNodes, 0);
        int wrong = 0;
        for (int e = 0; e < mesh.nElements; ++e)
        {
            const ElementState state = cover.state[e];
            const bool isCut = state == ElementState::Cut;
            if (isCut != (cover.cutIndex[e] >= 0) || (isCut && cover.cuts[cover.cutIndex[e]].element != e)) ++wrong;
            for (int a = 0; a <= dim; ++a)
            {
                const int i = mesh.elements[e * (dim + 1) + a];
                if (state != ElementState::Solid) isActive[i] = 1;
                if ((cover.distance[i] < 0) != (state == ElementState::Solid) && !isCut) ++wrong;
            }
        }
        CHECK(wrong == 0);
        for (int i = 0; i < mesh.nOwned; ++i)
            if (isActive[i] != cover.isActiveNode[i]) ++wrong;
        CHECK(wrong == 0);
        for (const CutElement& cut : cover.cuts)
        {
            CHECK(cut.volume > 0);
            CHECK(cut.volume <= mesh.volume[cut.element]); // whole: with one of its faces a solid's surface
            for (int f = cut.facetStart; f < cut.facetEnd; ++f)
            {
                CHECK(cover.facets[f].element == cut.element);
                CHECK(cover.facets[f].solid >= 0);
            }
        }
        std::size_t nGhosts = 0;
        for (const InteriorFace& face : scene.graph.faces)
        {
            const ElementState a = cover.state[face.element[0]], b = cover.state[face.element[1]];
            nGhosts += a != ElementState::Solid && b != ElementState::Solid && (a == ElementState::Cut || b == ElementState::Cut);
        }
        CHECK(cover.ghostFaces.size() == nGhosts);
        for (const GhostFace& ghost : cover.ghostFaces)
        {
            const InteriorFace& face = scene.graph.faces[ghost.face];
            int nCut = 0;
            for (int e : face.element)
            {
                CHECK(cover.state[e] != ElementState::Solid);
                nCut += cover.state[e] == ElementState::Cut;
            }
            CHECK(nCut > 0);
            checkFaceGeometry(mesh, face, ghost);
        }
        // nodal distances are the nearest solid's (of a free one: from its faces), and known wherever they are small
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            const auto x = mesh.spacePoint(i);
            double exact = farDistance;
            for (const Solid& s : solids)
            {
                double faces[maxFaces];
                const int nFaces = s.faceDistances({x[0], x[1], x[2]}, faces);
                exact = std::min(exact, nFaces > 0 ? *std::max_element(faces, faces + nFaces) : s.distance({x[0], x[1], x[2]}));
            }
            const double h = 2.0 / (dim == 2 ? 40 : 16);
            if (cover.distance[i] < 2 * h) CHECK(cover.distance[i] == doctest::Approx(exact).epsilon(1e-12));
            else CHECK(exact > 2 * h * 0.7);
        }
    }
}

TEST_CASE("a cover updated while solids move is the cover made anew")
{
    for (const int dim : {2, 3})
    {
        const Scene scene(dim, dim == 2 ? 30 : 12);
        CoverBuilder moving(scene.mesh, scene.graph, scene.halo);
        for (const double time : {0.0, 1.0, 2.0, 0.5})
        {
            const std::vector<Solid> solids = makeSolids(time);
            const Cover fresh = cutMesh(scene.mesh, scene.graph, scene.halo, solids);
            const Cover& cover = moving.build(solids);
            checkSame(summary(scene, cover), summary(scene, fresh));
            CHECK(cover.distance == fresh.distance);
            CHECK(cover.nearestSolid == fresh.nearestSolid);
            CHECK(cover.isActiveNode == fresh.isActiveNode);
            CHECK(std::equal(cover.state.begin(), cover.state.end(), fresh.state.begin()));
        }
    }
}

TEST_CASE("the cover does not depend on the number of ranks")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 30 : 12;
        const Scene parallel(dim, n), serial(dim, n, MPI_COMM_SELF);
        std::vector<Solid> solids = makeSolids(0), solidsSerial = solids;
        CoverBuilder builder(parallel.mesh, parallel.graph, parallel.halo), builderSerial(serial.mesh, serial.graph, serial.halo);
        for (int call = 0; call < 2; ++call)
        {
            const Cover& cover = builder.buildExactVolume(solids);
            const Cover& coverSerial = builderSerial.buildExactVolume(solidsSerial);
            checkSame(summary(parallel, cover), summary(serial, coverSerial));
            CHECK(solids[1].offset == doctest::Approx(solidsSerial[1].offset).epsilon(1e-10));
            std::map<std::int64_t, int> active;
            for (int i = 0; i < serial.mesh.nNodes; ++i) active[serial.mesh.originalNode[i]] = coverSerial.isActiveNode[i];
            int wrong = 0;
            for (int i = 0; i < parallel.mesh.nNodes; ++i) wrong += active[parallel.mesh.originalNode[i]] != cover.isActiveNode[i];
            CHECK(wrong == 0);
        }
    }
}

TEST_CASE("surfaces that lie in the mesh's nodes and faces")
{
    // a box whose faces are mesh planes: its volume and area are exact, nodes on it count as solid
    for (const int dim : {2, 3})
    {
        SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {8, 8, 8}, {-1, -1, -1}, {1, 1, 1});
        const NodeGraph graph(mesh);
        const Halo halo(mesh, MPI_COMM_WORLD);
        std::vector<Solid> solids(1);
        solids[0].shape = makeBox(Vec3::Zero(), Vec3::Constant(1));
        const Cover cover = cutMesh(mesh, graph, halo, solids);
        CHECK(cover.solidVolume[0] == doctest::Approx(1).epsilon(1e-10));
        CHECK(cover.solidArea[0] == doctest::Approx(2 * dim).epsilon(1e-10));
        for (int i = 0; i < mesh.nNodes; ++i) CHECK(cover.distance[i] != 0);
        for (const CutElement& cut : cover.cuts) CHECK(cut.facetEnd > cut.facetStart);
    }
}

TEST_CASE("elements between two solids are counted and their facets belong to the nearer one")
{
    const Scene scene(2, 20);
    const double gap = 0.03; // h = 0.1
    std::vector<Solid> solids{makeSolid(makeBox({-0.25 - gap / 2, 0, 0}, {0.5, 0.5, 1}), Vec3::Zero(), Solid::Kind::Fixed),
                              makeSolid(makeBox({0.25 + gap / 2, 0, 0}, {0.5, 0.5, 1}), Vec3::Zero(), Solid::Kind::Fixed)};
    const Cover near = cutMesh(scene.mesh, scene.graph, scene.halo, solids);
    CHECK(near.nSharedElements > 0);
    for (const CutFacet& facet : near.facets)
    {
        Vec3 x = Vec3::Zero();
        for (int q = 0; q < facet.nPoints; ++q)
            for (int a = 0; a <= 2; ++a)
            {
                const auto y = scene.mesh.spacePoint(scene.mesh.elements[3 * facet.element + a]);
                x += facet.shape[q][a] / facet.nPoints * Vec3(y[0], y[1], y[2]);
            }
        CHECK(solids[facet.solid].distance(x) <= solids[1 - facet.solid].distance(x) + 1e-3);
    }
    solids[1].pose.position[0] += 0.4;
    CHECK(cutMesh(scene.mesh, scene.graph, scene.halo, solids).nSharedElements == 0);
}

namespace
{

/// Largest force of a uniform pressure on the rows of the owned nodes off the mesh's boundary, over the pressure and the mesh size: the fluid's surface is closed if there is none.
double largestHole(const Scene& scene, const Cover& cover, double h)
{
    const SimplexMesh& mesh = scene.mesh;
    const int dim = mesh.dim;
    std::vector<double> force(std::size_t(mesh.nNodes) * dim, 0.0);
    std::vector<char> isBoundary(mesh.nNodes, 0);
    for (const MeshPatch& patch : mesh.patches)
        for (int i : patch.faceNodes) isBoundary[i] = 1;
    for (int e = 0; e < mesh.nElements; ++e)
        for (int a = 0; a <= dim; ++a)
            for (int d = 0; d < dim; ++d)
                force[std::size_t(mesh.elements[std::size_t(e) * (dim + 1) + a]) * dim + d] += fluidVolume(mesh, &cover, e) * mesh.gradN[(std::size_t(e) * (dim + 1) + a) * dim + d];
    for (const CutFacet& f : cover.facets)
        for (int a = 0; a <= dim; ++a)
            for (int d = 0; d < dim; ++d)
                for (int q = 0; q < f.nPoints; ++q) force[std::size_t(mesh.elements[std::size_t(f.element) * (dim + 1) + a]) * dim + d] -= f.weight[q] * f.shape[q][a] * f.normal[d];
    double largest = 0;
    for (int i = 0; i < mesh.nOwned; ++i)
        for (int d = 0; d < dim && !isBoundary[i]; ++d) largest = std::max(largest, std::abs(force[std::size_t(i) * dim + d]) / std::pow(h, dim - 1));
    return scene.halo.max(largest);
}

} // namespace

TEST_CASE("the fluid's surface is closed around solids that touch, in every node's row")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 24 : 12;
        Scene scene(dim, n);
        CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
        for (int k = 0; k < 24; ++k)
        {
            // side by side, one on both, an edge of one beside the side of another; overlaps and gaps, a little turned
            const double by = 0.003 * (k % 3 - 1), turned = 0.01 * (k % 5 - 2);
            std::vector<Solid> solids = {makeSolid(makeBox(Vec3::Zero(), {0.5, 0.4, 0.7}), {-0.25 - by + 0.011 * k, -0.3, 0.02}, Solid::Kind::Free),
                makeSolid(makeBox(Vec3::Zero(), {0.5, 0.4, 0.7}), {0.25 + 0.011 * k, -0.3 + 0.004 * k, 0.01}, Solid::Kind::Free),
                makeSolid(makeBox(Vec3::Zero(), {0.4, 0.3, 0.5}), {0.05 + 0.011 * k, 0.055 + 0.004 * k, 0}, k % 2 ? Solid::Kind::Fixed : Solid::Kind::Prescribed)};
            for (Solid& solid : solids) solid.pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(turned, Vec3::UnitZ()));
            CHECK(largestHole(scene, builder.build(solids), 2.0 / n) < 1e-12);
        }
    }
}

// Of long elements, whose next ones are beyond reach of the body.
TEST_CASE("the fluid's surface is closed around structures that touch while a body passes by")
{
    for (const int dim : {2, 3})
    {
        Scene scene(dim, dim == 2 ? std::array{8, 32, 1} : std::array{5, 15, 15});
        for (int place = 0; place < 10; ++place)
        {
            CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
            std::vector<Solid> solids = {makeSolid(makeBox(Vec3::Zero(), {0.35, 0.36, 0.7}), {-0.08 - 0.02 * place, -0.03, 0.02}, Solid::Kind::Fixed),
                makeSolid(makeBox(Vec3::Zero(), {0.35, 0.5, 0.7}), {-0.37, -0.4, 0}, Solid::Kind::Fixed), makeSolid(makeBox(Vec3::Zero(), {0.3, 0.3, 0.5}), {}, Solid::Kind::Free)};
            for (int s = 0; s < 3; ++s) solids[s].pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(s == 0 ? -0.24 : 0.04, Vec3::UnitZ()));
            for (int k = 0; k < 12; ++k)
            {
                solids[2].pose.position = {0.4 + 0.03 * k, 0.2 * std::sin(k) - 0.2, 0.1};
                CHECK(largestHole(scene, builder.build(solids), 0.1) < 1e-12);
            }
        }
    }
}

TEST_CASE("with what others cover of it every body's surface is closed")
{
    for (const int dim : {2, 3})
    {
        Scene scene(dim, dim == 2 ? 24 : 12);
        // a box flat on a fixed one and a little in it, a sphere between both and a prescribed box
        std::vector<Solid> solids = {makeSolid(makeBox(Vec3::Zero(), {1.2, 0.4, 0.9}), {0, -0.5, 0}, Solid::Kind::Fixed), makeSolid(makeBox(Vec3::Zero(), {0.5, 0.3, 0.6}), {0.13, -0.155, 0.02}, Solid::Kind::Free),
            makeSolid(makeSphere(Vec3::Zero(), 0.2), {-0.33, -0.2, 0}, Solid::Kind::Free), makeSolid(makeBox(Vec3::Zero(), {0.3, 0.4, 0.5}), {-0.62, 0, 0}, Solid::Kind::Prescribed)};
        for (Solid& solid : solids) solid.pose.orientation = Eigen::Quaterniond::Identity();
        CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
        const Cover& cover = builder.build(solids);
        for (std::size_t s = 1; s < solids.size(); ++s)
        {
            Eigen::Matrix<double, 4, 3> moments = Eigen::Matrix<double, 4, 3>::Zero(); // of (1, x) over the surface
            double covered = 0;
            const auto add = [&](int element, const double* shape, const double* area)
            {
                Eigen::Vector4d place(1, 0, 0, 0);
                for (int a = 0; a <= dim; ++a)
                    for (int d = 0; d < dim; ++d) place[1 + d] += shape[a] * scene.mesh.x[std::size_t(scene.mesh.elements[std::size_t(element) * (dim + 1) + a]) * dim + d];
                for (int d = 0; d < dim; ++d) moments.col(d) += area[d] * place;
            };
            for (const CutFacet& f : cover.facets)
            {
                if (f.solid != int(s) || !scene.mesh.isOwnedElement[f.element]) continue;
                double shape[4] = {}, area[3];
                for (int q = 0; q < f.nPoints; ++q)
                    for (int a = 0; a <= dim; ++a) shape[a] += f.weight[q] / f.area * f.shape[q][a];
                for (int d = 0; d < dim; ++d) area[d] = f.area * f.normal[d];
                add(f.element, shape, area);
            }
            for (const CoveredFacet& f : cover.coveredFacets)
            {
                if (f.solid != int(s) || !scene.mesh.isOwnedElement[f.element]) continue;
                for (int q = 0; q < f.nPoints; ++q) add(f.element, f.shape[q], f.area);
                covered += f.nPoints * std::abs(f.area[0]);
            }
            scene.halo.sum(moments.data(), 12);
            covered = scene.halo.sum(covered);
            const double volume = cutMesh(scene.mesh, scene.graph, scene.halo, {solids[s]}).solidVolume[0];
            CHECK(covered > 0.01);
            for (int d = 0; d < dim; ++d)
                for (int k = 0; k <= dim; ++k) CHECK(moments(k, d) == doctest::Approx(k == d + 1 ? -volume : 0).epsilon(1e-12));
        }
    }
}

// A plate just under the bed would be nearer to the bed's nodes than a box that stands on it, and take the box's film away.
TEST_CASE("a structure beside the mesh is not there")
{
    for (const int dim : {2, 3})
    {
        const Scene scene(dim, 6);
        std::vector<Solid> solids{makeSolid(makeBox(Vec3::Zero(), {1, 0.2, 3}), {0, -1.11, 0}, Solid::Kind::Fixed)};
        solids[0].pose.orientation.setIdentity();
        CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
        const Cover& beside = builder.build(solids);
        CHECK(std::all_of(beside.nearestSolid.begin(), beside.nearestSolid.end(), [](int s) { return s < 0; }));
        solids[0].pose.position.y() += 0.03;
        const Cover& within = builder.build(solids);
        CHECK(scene.halo.any(std::any_of(within.nearestSolid.begin(), within.nearestSolid.end(), [](int s) { return s == 0; })));
    }
}

TEST_CASE("no solids: all fluid")
{
    const Scene scene(3, 6);
    const Cover cover = cutMesh(scene.mesh, scene.graph, scene.halo, {});
    CHECK(cover.cuts.empty());
    CHECK(cover.ghostFaces.empty());
    CHECK(std::count(cover.isActiveNode.begin(), cover.isActiveNode.end(), 1) == scene.mesh.nNodes);
}
