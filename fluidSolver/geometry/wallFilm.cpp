// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/wallFilm.hpp"

#include "core/patchFaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flotsam
{

namespace
{

constexpr double reachOfFilm = 0.5;     // over the height of the elements on the wall
constexpr double facingCosine = 0.5;    // least one of a face that looks at the wall
constexpr double flatCosine = 0.9;      // of one that lies on it, and ends there: the film goes on to its rim
constexpr double oppositeCosine = -0.5; // of the normals of walls that face each other
constexpr double bentCosine = 0.99;     // of the normals of a face and the wall at its node: there the wall is not flat

/// Nodes with an element between two walls that face each other: off both, nothing would be left of a body between. height: 0 off the walls.
std::vector<double> narrowNodes(const SimplexMesh& mesh, const std::vector<double>& normal, const std::vector<double>& height)
{
    const int dim = mesh.dim, n = dim + 1;
    std::vector<double> isNarrow(mesh.nNodes, 0.0);
    for (int e = 0; e < mesh.nElements; ++e)
        for (int a = 0; a < n; ++a)
            for (int b = 0; b < a; ++b)
            {
                const int i = mesh.elements[std::size_t(e)*n + a], j = mesh.elements[std::size_t(e)*n + b];
                if (height[i] <= 0 || height[j] <= 0) continue;
                double product = 0, ofI = 0, ofJ = 0;
                for (int d = 0; d < dim; ++d)
                {
                    const double u = normal[std::size_t(i)*dim + d], v = normal[std::size_t(j)*dim + d];
                    product += u*v;
                    ofI += u*u;
                    ofJ += v*v;
                }
                if (product < oppositeCosine*std::sqrt(ofI*ofJ)) isNarrow[i] = isNarrow[j] = 1;
            }
    return isNarrow;
}

/// A place on a face of the wall: there the distances of a solid's faces.
using FaceValues = std::array<double, maxFaces>;

/// Of a convex polygon (or a segment as one with two corners) the part where a linear function, given by the corners' values number f, is less than `limit`.
void clip(std::vector<FaceValues>& polygon, int f, double limit, int nFaces)
{
    std::vector<FaceValues> part;
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
        const FaceValues &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        if (a[f] < limit) part.push_back(a);
        if ((a[f] < limit) == (b[f] < limit)) continue;
        const double t = (limit - a[f])/(b[f] - a[f]);
        FaceValues& between = part.emplace_back();
        for (int k = 0; k < nFaces; ++k) between[k] = (1 - t)*a[k] + t*b[k];
    }
    polygon.swap(part);
}

/// Whether somewhere on the polygon all distances are less than `limit`.
bool comesNearer(std::vector<FaceValues> polygon, double limit, int nFaces)
{
    for (int f = 0; f < nFaces && !polygon.empty(); ++f) clip(polygon, f, limit, nFaces);
    return !polygon.empty();
}

} // namespace

WallFilm::WallFilm(const SimplexMesh& mesh, const Halo& halo) : mesh_(mesh), position_(mesh.nNodes, -1)
{
    const int dim = mesh.dim;
    std::vector<double> normal(std::size_t(mesh.nNodes)*dim, 0.0), height(mesh.nNodes, 0.0);
    for (const MeshPatch& patch : mesh.patches)
    {
        if (patch.type != "wall") continue;
        for (std::size_t f = 0; f < patch.faceElement.size(); ++f)
        {
            double v[3], area = 0;
            outwardVector(mesh, patch, f, v);
            for (int d = 0; d < dim; ++d) area += v[d]*v[d];
            const double ofElement = dim*mesh.volume[patch.faceElement[f]]/std::sqrt(area);
            for (int k = 0; k < dim; ++k)
            {
                const int i = patch.faceNodes[f*dim + k];
                for (int d = 0; d < dim; ++d) normal[std::size_t(i)*dim + d] += v[d];
                height[i] = height[i] > 0 ? std::min(height[i], ofElement) : ofElement;
            }
        }
    }
    halo.update(normal, dim);   // second-ring copies do not see all of their faces
    halo.update(height, 1);
    std::vector<double> isNarrow = narrowNodes(mesh, normal, height);
    halo.update(isNarrow, 1);
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        if (height[i] <= 0 || isNarrow[i] > 0) continue;
        WallNode node;
        for (int d = 0; d < dim; ++d) node.normal[mesh.axes[d]] = normal[std::size_t(i)*dim + d];
        node.normal.normalize();
        node.height = height[i];
        position_[i] = int(nodes_.size());
        nodes_.push_back(node);
    }
    findFaces(halo);
}

/// Of each node the faces of the wall: normal, and the other corners.
std::vector<std::vector<double>> WallFilm::facesOfNodes() const
{
    const int dim = mesh_.dim;
    std::vector<std::vector<double>> ofNode(mesh_.nNodes);
    for (const MeshPatch& patch : mesh_.patches)
    {
        if (patch.type != "wall") continue;
        for (std::size_t f = 0; f < patch.faceElement.size(); ++f)
        {
            double v[3];
            outwardVector(mesh_, patch, f, v);
            Vec3 normal = Vec3::Zero();
            for (int d = 0; d < dim; ++d) normal[mesh_.axes[d]] = v[d];
            normal.normalize();
            for (int a = 0; a < dim; ++a)
            {
                std::vector<double>& own = ofNode[patch.faceNodes[f*dim + a]];
                own.insert(own.end(), normal.data(), normal.data() + 3);
                for (int b = 0; b < dim; ++b)
                {
                    const std::array<double, 3> x = mesh_.spacePoint(patch.faceNodes[f*dim + b]);
                    if (b != a) own.insert(own.end(), x.begin(), x.end());
                }
            }
        }
    }
    return ofNode;
}

/// Owners give them to the others, which do not see all of them.
void WallFilm::findFaces(const Halo& halo)
{
    const int ofFace = 3*mesh_.dim;     // normal, other corners
    const std::vector<std::vector<double>> ofNode = facesOfNodes();
    std::size_t most = 0;
    for (int i = 0; i < mesh_.nOwned; ++i) most = std::max(most, ofNode[i].size());
    const int width = 1 + static_cast<int>(halo.max(double(most)));
    std::vector<double> all(std::size_t(mesh_.nNodes)*width, 0.0); // number, coordinates
    for (int i = 0; i < mesh_.nOwned; ++i)
    {
        all[std::size_t(i)*width] = double(ofNode[i].size());
        std::copy(ofNode[i].begin(), ofNode[i].end(), &all[std::size_t(i)*width] + 1);
    }
    halo.update(all, width);
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        if (position_[i] < 0) continue;
        WallNode& node = nodes_[position_[i]];
        const double* own = &all[std::size_t(i)*width];
        node.firstCorner = corners_.size();
        node.firstFacing = facings_.size();
        bool isBent = false;
        for (int k = 0; k < int(own[0]); k += ofFace)
        {
            takeFace(own + 1 + k);
            isBent = isBent || facings_.back().dot(node.normal) < bentCosine;
        }
        if (!isBent) facings_.resize(node.firstFacing);
        node.endCorner = corners_.size();
        node.endFacing = facings_.size();
    }
}

void WallFilm::takeFace(const double* numbers)
{
    facings_.emplace_back(numbers[0], numbers[1], numbers[2]);
    for (int k = 3; k < 3*mesh_.dim; k += 3) corners_.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
}

/// 1: the solid reaches into a face of the wall at the node; 0: it stays a film's thickness away from all of them. distances: of its faces, at the node;
/// shift: to be added to those elsewhere.
double WallFilm::touch(const WallNode& wall, const SolidPart& part, int nFaces, const double* distances, double shift) const
{
    const int nOthers = mesh_.dim - 1;
    const double film = filmThickness*wall.height;
    double most = 0;
    for (std::size_t c = wall.firstCorner; c < wall.endCorner && most < 1; c += nOthers)
    {
        std::vector<FaceValues> face(1 + nOthers);
        std::copy_n(distances, nFaces, face[0].begin());
        for (int k = 0; k < nOthers; ++k)
        {
            part.faceDistances(corners_[c + k], face[1 + k].data());
            for (int f = 0; f < nFaces; ++f) face[1 + k][f] += shift;
        }
        if (!comesNearer(face, (1 - most)*film, nFaces)) continue;
        double low = 0, high = (1 - most)*film;     // the solid comes nearer than high
        if (comesNearer(face, 0, nFaces)) return 1;
        while (high - low > 1e-6*film) (comesNearer(face, 0.5*(low + high), nFaces) ? high : low) = 0.5*(low + high);
        most = 1 - high/film;
    }
    return most;
}

const WallFilm::WallNode* WallFilm::wallNode(int i, const Solid& solid) const
{
    return solid.isLoose && position_[i] >= 0 ? &nodes_[position_[i]] : nullptr;
}

Vec3 WallFilm::pointOver(int i, const WallNode& wall, const Vec3& normal, double heights) const
{
    const std::array<double, 3> x = mesh_.spacePoint(i);
    return Vec3(x[0], x[1], x[2]) - heights*wall.height*normal;
}

Vec3 WallFilm::pointOver(int i, const WallNode& wall, double heights) const { return pointOver(i, wall, wall.normal, heights); }

/// How much a solid's face looks at that face of the wall at which it looks most: at the edge of a step the mean of their normals may be nearly that of the step's side, and a body that
/// lies on top does not look at that. distance: of the solid's face at the node.
double WallFilm::cosineToFaces(int i, const WallNode& wall, const SolidPart& part, int face, double distance) const
{
    double most = -1;
    for (std::size_t f = wall.firstFacing; f < wall.endFacing; ++f)
    {
        double over[maxFaces];
        part.faceDistances(pointOver(i, wall, facings_[f], reachOfFilm), over);
        most = std::max(most, (distance - over[face])/(reachOfFilm*wall.height));
    }
    return most;
}

double WallFilm::thickness(int i, const SolidPart& part) const
{
    const WallNode* wall = wallNode(i, part.solid());
    if (!wall) return noFilm;
    // beside the solid as far as the film is thick: no jump as its edges pass the node
    const double film = filmThickness*wall->height;
    bool isNear = part.plainDistance(pointOver(i, *wall, reachOfFilm)) < film;
    for (std::size_t f = wall->firstFacing; f < wall->endFacing && !isNear; ++f) isNear = part.plainDistance(pointOver(i, *wall, facings_[f], reachOfFilm)) < film;
    return isNear ? film : noFilm;
}

double WallFilm::share(int i, const Solid& solid, double distance) const
{
    const WallNode* wall = wallNode(i, solid);
    return wall ? std::clamp(1 - distance/wall->height, 0.0, 1.0) : 0;
}

double WallFilm::lift(int i, const SolidPart& part, int nFaces, double* distances, double nearer) const
{
    const WallNode* wall = wallNode(i, part.solid());
    if (!wall) return noFilm;
    const std::array<double, 3> x = mesh_.spacePoint(i);
    double here[maxFaces], over[maxFaces];
    part.faceDistances(Vec3(x[0], x[1], x[2]), here);
    part.faceDistances(pointOver(i, *wall, reachOfFilm), over);
    const double film = filmThickness*wall->height;
    for (int k = 0; k < nFaces; ++k) distances[k] -= nearer*wall->height;
    // a round side lies on the wall at its line alone, but with all of it: what is lifted under it goes on beside its ends
    const bool isFlat = part.shape().symmetry().kind == Symmetry::Kind::None;
    const bool isBeside = isFlat && *std::max_element(distances, distances + nFaces) >= film;
    double ofSteep = isBeside ? -1 : 1;     // lifted beside the solid only where it reaches into the wall, with an edge between nodes; -1: not asked yet
    bool isLifted = false;
    const std::array<double, maxFaces> unlifted = [&] { std::array<double, maxFaces> d; std::copy_n(distances, nFaces, d.begin()); return d; }();
    for (int k = 0; k < nFaces; ++k)
    {
        const double cosine = (here[k] - over[k])/(reachOfFilm*wall->height);
        if (distances[k] >= film || (cosine <= facingCosine && cosineToFaces(i, *wall, part, k, here[k]) <= facingCosine)) continue;
        const bool isSteep = cosine <= flatCosine;
        if (isSteep && ofSteep < 0) ofSteep = touch(*wall, part, nFaces, unlifted.data(), -nearer*wall->height);
        const double share = isSteep ? ofSteep : 1;
        distances[k] += share*(film - distances[k]);
        isLifted = isLifted || share > 0;
    }
    return isLifted ? film : noFilm;
}

} // namespace flotsam
