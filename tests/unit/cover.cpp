// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/coverScene.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>

using namespace flotsam;

namespace
{

/// A fixed cylinder, a box and a sphere that move, box and cylinder close to each other.
std::vector<Solid> makeSolids(double time)
{
    return {makeSolid(makeCylinder({0, 0, -0.6}, {0, 0, 0.6}, 0.2), {-0.45, 0.1, 0}, Solid::Kind::Fixed),
            makeSolid(makeBox(Vec3::Zero(), {0.5, 0.3, 1}), {0.08 + 0.05 * time, 0.11, 0.02}, Solid::Kind::Free),
            makeSolid(makeSphere(Vec3::Zero(), 0.25), {0.4, -0.45 - 0.1 * time, 0.03}, Solid::Kind::Prescribed)};
}

/// Totals that must not depend on the order in which a cover was made.
std::vector<double> summary(const CoverScene& scene, const Cover& cover)
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
    CHECK(ghost.area == near(area, 1e-14));
    CHECK(normal.norm() == near(1, 1e-14));
    for (std::size_t k = 1; k < x.size(); ++k) CHECK(std::abs(normal.dot(x[k] - x[0])) < 1e-12);
    CHECK(normal.dot(point(face.opposite[0]) - x[0]) < 0);
    CHECK(normal.dot(point(face.opposite[1]) - x[0]) > 0);
}

void checkSame(const std::vector<double>& a, const std::vector<double>& b)
{
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) CHECK(a[i] == near(b[i], 1e-14));
}

} // namespace

TEST_CASE("states, cut indices and facets fit together")
{
    for (const int dim : {2, 3})
    {
        const CoverScene scene(dim, dim == 2 ? 40 : 16);
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
                const int nFaces = SolidPart(s, 0).faceDistances({x[0], x[1], x[2]}, faces);
                exact = std::min(exact, nFaces > 0 ? *std::max_element(faces, faces + nFaces) : s.distance({x[0], x[1], x[2]}));
            }
            const double h = 2.0 / (dim == 2 ? 40 : 16);
            if (cover.distance[i] < 2 * h) CHECK(cover.distance[i] == near(exact, 5e-13));
            else CHECK(exact > 2 * h * 0.7);
        }
    }
}

TEST_CASE("a cover updated while solids move is the cover made anew")
{
    for (const int dim : {2, 3})
    {
        const CoverScene scene(dim, dim == 2 ? 30 : 12);
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

TEST_CASE("structures that stand, move and stand again: the cover that is kept is the cover made anew")
{
    for (const int dim : {2, 3})
    {
        const CoverScene scene(dim, dim == 2 ? 30 : 12);
        CoverBuilder kept(scene.mesh, scene.graph, scene.halo);
        std::vector<Solid> solids = makeSolids(0);
        solids[1].kind = Solid::Kind::Prescribed;
        solids.push_back(makeSolid(makeBox(Vec3::Zero(), {0.01, 0.4, 1}), {0.6, 0.3, 0}, Solid::Kind::Fixed)); // thin
        const auto check = [&]
        {
            std::vector<Solid> others = solids;
            const Cover fresh = cutMeshWithExactVolume(scene.mesh, scene.graph, scene.halo, others);
            const Cover& cover = kept.buildExactVolume(solids);
            checkSame(summary(scene, cover), summary(scene, fresh));
            CHECK(cover.distance == fresh.distance);
            CHECK(cover.nearestSolid == fresh.nearestSolid);
            CHECK(solids[3].isThin);
        };
        for (const double time : {0.0, 0.0, 1.0, 1.0, 0.0})
        {
            for (int s : {1, 2}) solids[s].pose = makeSolids(time)[s].pose;
            check();
        }
        solids[1].pose.orientation = Eigen::AngleAxisd(0.3, Vec3::UnitZ());
        check();
        std::vector<Solid> elsewhere = makeSolids(2);
        elsewhere.push_back(solids[3]);
        kept.build(elsewhere);
        check();
        solids.pop_back();
        solids.push_back(makeSolid(makeBox(Vec3::Zero(), {0.01, 0.4, 1}), {0.6, -0.1, 0}, Solid::Kind::Fixed));
        check();
    }
}

TEST_CASE("the cover does not depend on the number of ranks")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 30 : 12;
        CoverScene parallel(dim, n), serial(dim, n, MPI_COMM_SELF);
        std::vector<Solid> solids = makeSolids(0);
        solids[2].kind = Solid::Kind::Free; // has an offset, as boxes have not
        std::vector<Solid> solidsSerial = solids;
        CoverBuilder builder(parallel.mesh, parallel.graph, parallel.halo), builderSerial(serial.mesh, serial.graph, serial.halo);
        for (int call = 0; call < 2; ++call)
        {
            const Cover& cover = builder.buildExactVolume(solids);
            const Cover& coverSerial = builderSerial.buildExactVolume(solidsSerial);
            checkSame(summary(parallel, cover), summary(serial, coverSerial));
            CHECK(solids[2].offset > 1e-3);
            CHECK(solids[2].offset == near(solidsSerial[2].offset, 1e-10));
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
    // a box whose faces are mesh planes: its volume and area are exact, but for nodes on it, which count as solid by 1e-10 of an element
    for (const int dim : {2, 3})
    {
        SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {8, 8, 8}, {-1, -1, -1}, {1, 1, 1});
        const NodeGraph graph(mesh);
        const Halo halo(mesh, MPI_COMM_WORLD);
        std::vector<Solid> solids(1);
        solids[0].shape = makeBox(Vec3::Zero(), Vec3::Constant(1));
        const Cover cover = cutMesh(mesh, graph, halo, solids);
        CHECK(cover.solidVolume[0] == near(1, 5e-10));
        CHECK(cover.solidArea[0] == near(2 * dim, 5e-10));
        for (int i = 0; i < mesh.nNodes; ++i) CHECK(cover.distance[i] != 0);
        for (const CutElement& cut : cover.cuts) CHECK(cut.facetEnd > cut.facetStart);
    }
}

TEST_CASE("what touches a structure with an edge or a corner is not cut, whatever round-off and a body nearby make of the distances")
{
    for (const int dim : {2, 3})
        for (const double height : {1., 0.3})       // of the mesh: elements as long as wide, and flat ones
            for (const bool isWithin : {true, false})   // sharp, or through the boundary and linear
            {
                SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {8, 8, 8}, {-1, -height, -1}, {1, height, 1});
                const NodeGraph graph(mesh);
                const Halo halo(mesh, MPI_COMM_WORLD);
                std::vector<Solid> solids(2);
                const Vec3 size = isWithin ? Vec3(1, height, 1) : Vec3(1, 4, 4);
                const auto beyond = [&](const Vec3& x)
                {
                    double most = -1e300;
                    for (int d = 0; d < dim; ++d) most = std::max(most, std::abs(x[d]) - size[d]/2);
                    return most;
                };
                solids[0].shape = makeBox(Vec3::Zero(), size);
                solids[1].kind = Solid::Kind::Free;
                solids[1].shape = makeSphere(Vec3::Zero(), 0.1*height);
                CoverBuilder builder(mesh, graph, halo);
                long wrong = 0, cuts = 0;
                for (int k = 0; k < 12; ++k)
                {
                    solids[0].pose.position.x() = 1e-16*(k % 5 - 2);
                    solids[1].pose.position = Vec3(0.5 + (0.12 + 0.02*k)*height, (0.06*k - 0.31)*height, dim == 2 ? 0 : 0.05*k - 0.4);
                    const Cover& cover = builder.build(solids);
                    for (int e = 0; e < mesh.nElements; ++e)
                    {
                        const int* nodes = &mesh.elements[std::size_t(e)*(dim + 1)];
                        int nIn = 0;    // nodes in the closed box
                        bool isInside = true, isNearBody = false;
                        Vec3 centre = Vec3::Zero();
                        for (int a = 0; a <= dim; ++a)
                        {
                            const auto x = mesh.spacePoint(nodes[a]);
                            const Vec3 y(x[0], x[1], x[2]);
                            nIn += beyond(y) < 1e-9;
                            centre += y/(dim + 1);
                            isNearBody = isNearBody || (y - solids[1].pose.position).norm() < 0.1*height;
                        }
                        isInside = beyond(centre) < 0;
                        const ElementState expected = isInside ? ElementState::Solid : nIn == dim ? ElementState::Cut : ElementState::Fluid;
                        if (isNearBody || (cover.state[e] == ElementState::Cut && cover.cuts[cover.cutIndex[e]].volume < (1 - 1e-9)*mesh.volume[e])) continue;   // the body's
                        wrong += cover.state[e] != expected;
                        cuts += expected == ElementState::Cut;
                    }
                }
                CHECK(halo.sum(wrong) == 0);
                CHECK(halo.sum(cuts) > 0);
            }
}

TEST_CASE("elements between two solids are counted and their facets belong to the nearer one")
{
    const CoverScene scene(2, 20);
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

// A plate just under the bed would be nearer to the bed's nodes than a box that stands on it, and take the box's film away.
TEST_CASE("a structure beside the mesh is not there")
{
    for (const int dim : {2, 3})
    {
        const CoverScene scene(dim, 6);
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

TEST_CASE("a pier that stands on the bed, or reaches a little or far below it, has no foot in the fluid")
{
    const CoverScene scene(3, 8);
    double first[2] = {-1, -1};
    for (const double below : {0.0, 1e-3, 0.03, 0.5})
        for (const bool isBox : {false, true})
        {
            const auto shape = isBox ? makeBox({0, -0.5*below, 0}, {0.5, 1.2 + below, 0.4}) : makeCylinder({0, -0.6 - below, 0}, {0, 0.6, 0}, 0.3);
            std::vector<Solid> solids{makeSolid(shape, {0.03, -0.4, 0.02}, Solid::Kind::Fixed)};
            solids[0].pose.orientation.setIdentity();
            CoverBuilder builder(scene.mesh, scene.graph, scene.halo);
            // the volume of slip structures is made exact by an offset, which must not bring the foot back
            solids[0].wall = Solid::Wall::Slip;
            solids[0].offset = 0;
            const Cover slip = builder.buildExactVolume(solids);
            CHECK(slip.solidVolume[0] == near(1.2*(isBox ? 0.2 : M_PI*0.09), 0.01));    // integrated on divided elements [test cutGeometry]
            double lift = 0;
            for (const CutElement& cut : slip.cuts)
                for (int f = cut.facetStart; f < cut.facetEnd; ++f)
                    if (scene.mesh.isOwnedElement[cut.element]) lift -= slip.facets[f].area * slip.facets[f].normal[1];
            CHECK(scene.halo.sum(lift) == near(isBox ? 0.2 : M_PI*0.09, 0.15));
            solids[0].wall = Solid::Wall::NoSlip;
            solids[0].offset = 0;
            solids[0].offsetSlope.setZero();
            const Cover& cover = builder.build(solids);
            CAPTURE(below);
            CAPTURE(isBox);
            double& volume = first[isBox];
            if (volume < 0) volume = cover.solidVolume[0];
            CHECK(cover.solidVolume[0] == near(volume, 1e-12));
            // vertical force of a uniform pressure: that on the top alone
            double force = 0;
            for (const CutElement& cut : cover.cuts)
                for (int f = cut.facetStart; f < cut.facetEnd; ++f)
                    if (scene.mesh.isOwnedElement[cut.element]) force += cover.facets[f].area * cover.facets[f].normal[1];
            CHECK(-scene.halo.sum(force) == near(isBox ? 0.2 : M_PI*0.09, 0.15));
        }
}

TEST_CASE("no solids: all fluid")
{
    const CoverScene scene(3, 6);
    const Cover cover = cutMesh(scene.mesh, scene.graph, scene.halo, {});
    CHECK(cover.cuts.empty());
    CHECK(cover.ghostFaces.empty());
    CHECK(std::count(cover.isActiveNode.begin(), cover.isActiveNode.end(), 1) == scene.mesh.nNodes);
}
