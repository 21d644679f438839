// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/beyondMesh.hpp"

#include "core/patchFaces.hpp"
#include "equations/linearExtension.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

constexpr int divisions = 6;            // of a face's edges: one line along the normal through the middle of every part
constexpr double partsOfElement = 8;    // of a line, in the size of the face
constexpr double steepest = 0.87;       // sine of the angle between a face's normal and gravity, at least (60 degrees)
constexpr int bodyRings = 6;            // into the body the flow's pressure is continued

bool overlap(const std::array<Vec3, 2>& a, const std::array<Vec3, 2>& b)
{
    return (a[0].array() <= b[1].array()).all() && (b[0].array() <= a[1].array()).all();
}

/// Without what moves its surface for the linear cut: there is none beyond the mesh.
Solid trueShape(Solid solid)
{
    solid.offset = 0;
    solid.offsetSlope.setZero();
    return solid;
}

bool isBody(const Solid& solid) { return solid.kind == Solid::Kind::Free || solid.isLoose; }

/// A vector of the mesh's plane.
Vec3 inSpace(const SimplexMesh& mesh, const double* inPlane)
{
    Vec3 v = Vec3::Zero();
    for (int d = 0; d < mesh.dim; ++d) v[mesh.axes[d]] = inPlane[d];
    return v;
}

Vec3 placeOf(const SimplexMesh& mesh, int node)
{
    const std::array<double, 3> x = mesh.spacePoint(node);
    return {x[0], x[1], x[2]};
}

/// Shape functions of a face at a point.
using FacePoint = std::array<double, 3>;

double at(const FacePoint& shape, const double* corners) { return shape[0]*corners[0] + shape[1]*corners[1] + shape[2]*corners[2]; }

/// Points of a face, in the middle of parts of equal size.
std::vector<FacePoint> middles(int dim)
{
    std::vector<FacePoint> points;
    const double n = divisions;
    if (dim == 2)
        for (double k = 0.5; k < n*n; ++k) points.push_back({k/(n*n), 1 - k/(n*n), 0});
    else
        for (int i = 0; i < divisions; ++i)
            for (int j = 0; i + j < divisions; ++j)
            {
                points.push_back({(i + 1/3.0)/n, (j + 1/3.0)/n, 1 - (i + j + 2/3.0)/n});
                if (i + j + 1 < divisions) points.push_back({(i + 2/3.0)/n, (j + 2/3.0)/n, 1 - (i + j + 4/3.0)/n});
            }
    return points;
}

/// What a line has in a body.
struct Chord
{
    double length = 0;
    double moment = 0;  ///< integral of the way over the length
};

/// On the line from x along the unit vector n, up to `end` from x, in steps. Where it enters and leaves it counts linearly over a step. The distance says how many steps
/// have nothing else to show.
Chord chordIn(const Solid& solid, const Vec3& x, const Vec3& n, double end, double step)
{
    Chord chord;
    const int nSteps = int(std::ceil(end/step));
    for (int k = 0; k < nSteps;)
    {
        const double distance = solid.distance(x + (k + 0.5)*step*n)/step;
        const int run = std::clamp(int(std::abs(distance) - 0.5), 1, nSteps - k);
        const double length = run*step*std::clamp(0.5 - distance, 0.0, 1.0);
        chord.length += length;
        chord.moment += length*(k + 0.5*run)*step;
        k += run;
    }
    return chord;
}

/// Of a body in fluid without a wall, by its own axes, over the displaced fluid: those of beyondMesh.hpp, in space. In 2D none along the axis through the mesh counts.
Eigen::Matrix3d addedMass(const SimplexMesh& mesh, const Solid& solid)
{
    const std::array<Vec3, 2> bounds = solid.shape->bounds();
    const Eigen::Matrix3d axes = solid.pose.orientation.toRotationMatrix();
    Vec3 slender = (bounds[1] - bounds[0]).cwiseInverse();
    for (int k = 0; k < 3 && mesh.dim == 2; ++k)
        if (std::abs(axes(mesh.axes[2], k)) > 0.7) slender[k] = 0;
    Vec3 coefficients;
    for (int k = 0; k < 3; ++k) coefficients[k] = slender[k]/(slender.sum() - slender[k]);
    return axes*coefficients.asDiagonal()*axes.transpose();
}

Eigen::Matrix3d crossMatrix(const Vec3& r)
{
    Eigen::Matrix3d m;
    m << 0, -r[2], r[1], r[2], 0, -r[0], -r[1], r[0], 0;
    return m;
}

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Places of the system's degrees of freedom in a force and moment of space.
std::vector<int> placesInSpace(const SimplexMesh& mesh)
{
    if (mesh.dim == 2) return {mesh.axes[0], mesh.axes[1], 3 + mesh.axes[2]};
    return {0, 1, 2, 3, 4, 5};
}

} // namespace

/// What acts on the part of a solid that is outside, in space, about the solid's position.
struct BeyondMesh::Outside
{
    Vec3 centre, force = Vec3::Zero(), moment = Vec3::Zero();
    Eigen::Matrix3d isRotation, addedMass;  // rotations about axes of symmetry move no fluid
    Matrix6 inertia = Matrix6::Zero();

    void addForce(const Vec3& f, const Vec3& at)
    {
        force += f;
        moment += (at - centre).cross(f);
    }

    void addMass(double displaced, const Vec3& at)
    {
        Eigen::Matrix<double, 3, 6> velocity;
        velocity << Eigen::Matrix3d::Identity(), -crossMatrix(at - centre)*isRotation;
        inertia += displaced*velocity.transpose()*addedMass*velocity;
    }
};

/// A face of an open patch.
struct BeyondMesh::Face
{
    double area = 0, size = 0;              // [m^(dim-1)], [m]
    Vec3 normal, corners[3];                // out of the mesh; space
    double pressure[3] = {}, side[3] = {};  // at the corners; side: positive in the liquid
    Vec3 slope, gravity;                    // along the patch: of the pressure, linear between the corners; gravity
};

BeyondMesh::BeyondMesh(const SimplexMesh& mesh, const Halo& halo, const FluidProperties& fluid, const std::vector<BoundaryPatch>& patches)
:   mesh_(mesh), halo_(halo), fluid_(fluid), gravity_(fluid.gravity[0], fluid.gravity[1], fluid.gravity[2]), patches_(patches), points_(middles(mesh.dim))
{
    constexpr double infinite = 1e300;
    for (std::size_t p = 0; p < patches.size(); ++p)
    {
        const MeshPatch& faces = mesh.patches[patches[p].meshPatch];
        if (patches[p].stopsBodies || patches[p].isWall() || patches[p].isNoSlipWall || faces.type != "patch") continue;
        Passage passage{int(p), {Vec3::Constant(infinite), Vec3::Constant(-infinite)}};
        for (int i : faces.faceNodes)
        {
            const Vec3 x = placeOf(mesh, i);
            passage.bounds[0] = passage.bounds[0].cwiseMin(x);
            passage.bounds[1] = passage.bounds[1].cwiseMax(x);
        }
        for (int d = 0; d < 3; ++d)
        {
            passage.bounds[0][d] = halo.min(passage.bounds[0][d]);
            passage.bounds[1][d] = halo.max(passage.bounds[1][d]);
        }
        passages_.push_back(passage);
    }
}

bool BeyondMesh::isReached(const Passage& passage, const Solid& solid) const
{
    return isBody(solid) && overlap(passage.bounds, solid.spaceBounds());
}

bool BeyondMesh::isReached(const std::vector<Solid>& solids) const
{
    for (const Passage& passage : passages_)
        for (const Solid& solid : solids)
            if (isReached(passage, solid)) return true;
    return false;
}

/// Positive in the liquid.
double BeyondMesh::side(const FlowStepData& step, int node) const { return step.level ? (*step.level)[node] : step.state->alpha[node] - 0.5; }

/// At the nodes of a patch that does not prescribe it: of the stream at t^n. Where a fluid is behind bodies alone it is p, the flow's, continued into them.
void BeyondMesh::setStreamPressures(const FlowStepData& step, const BoundaryPatch& patch, std::vector<double>& p) const
{
    const MeshPatch& faces = mesh_.patches[patch.meshPatch];
    const auto isGas = [&](int i) { return side(step, i) <= 0; };
    const auto weight = [&](int i) { return (isGas(i) ? fluid_.rhoGas : fluid_.rhoLiquid)*gravity_.dot(placeOf(mesh_, i)); };
    double sums[2][2] = {};     // liquid, gas: pressure without the weight, area
    for (std::size_t f = 0; f < faces.faceElement.size(); ++f)
    {
        if (!faces.isOwnedFace[f]) continue;
        double v[3] = {};
        outwardVector(mesh_, faces, f, v);
        const double area = inSpace(mesh_, v).norm();
        for (int k = 0; k < mesh_.dim; ++k)
        {
            const int i = faces.faceNodes[f*mesh_.dim + k];
            if (!step.cover->isActiveNode[i]) continue;
            sums[isGas(i)][0] += area*(step.state->p[i] - weight(i));
            sums[isGas(i)][1] += area;
        }
    }
    halo_.sum(sums[0], 4);
    for (int i : faces.faceNodes)
        if (sums[isGas(i)][1] > 0) p[i] = sums[isGas(i)][0]/sums[isGas(i)][1] + weight(i);
}

/// Those that are this rank's own, without tops and floors: a channel does not go on upward. pressure: at the nodes of the patch if it prescribes them, else at all.
std::vector<BeyondMesh::Face> BeyondMesh::makeFaces(const FlowStepData& step, const BoundaryPatch& patch, const std::vector<double>& pressure) const
{
    std::vector<Face> faces;
    const MeshPatch& all = mesh_.patches[patch.meshPatch];
    for (std::size_t f = 0; f < all.faceElement.size(); ++f)
    {
        if (!all.isOwnedFace[f]) continue;
        const Face face = makeFace(step, patch, f, pressure);
        if (face.gravity.norm() >= steepest*gravity_.norm()) faces.push_back(face);
    }
    return faces;
}

BeyondMesh::Face BeyondMesh::makeFace(const FlowStepData& step, const BoundaryPatch& patch, std::size_t f, const std::vector<double>& pressure) const
{
    const int dim = mesh_.dim;
    const MeshPatch& faces = mesh_.patches[patch.meshPatch];
    const int* nodes = &faces.faceNodes[f*dim];
    const int* corners = &mesh_.elements[std::size_t(faces.faceElement[f])*(dim + 1)];
    Face face;
    const bool isPrescribed = patch.pressure != BoundaryPatch::Pressure::Natural;
    double v[3] = {}, slope[3] = {};
    outwardVector(mesh_, faces, f, v);
    for (int k = 0; k < dim; ++k)
    {
        const int i = nodes[k];
        face.corners[k] = placeOf(mesh_, i);
        face.side[k] = side(step, i);
        face.pressure[k] = pressure[isPrescribed ? std::lower_bound(patch.nodes.begin(), patch.nodes.end(), i) - patch.nodes.begin() : i];
        const auto corner = std::find(corners, corners + dim + 1, i) - corners;
        for (int d = 0; d < dim; ++d) slope[d] += face.pressure[k]*mesh_.gradN[(std::size_t(faces.faceElement[f])*(dim + 1) + corner)*dim + d];
    }
    face.normal = inSpace(mesh_, v);
    face.slope = inSpace(mesh_, slope);
    face.gravity = gravity_;
    face.area = face.normal.norm();
    face.size = dim == 2 ? face.area : std::sqrt(2*face.area);
    face.normal /= face.area;
    for (Vec3* along : {&face.slope, &face.gravity}) *along -= along->dot(face.normal)*face.normal;
    return face;
}

/// share: weightShare(). What the pressure does not carry of its weight falls, and takes the body along.
void BeyondMesh::addFace(const Face& face, const Solid& solid, double share, Outside& outside) const
{
    const Vec3 toCentre = outside.centre - face.corners[0];
    const double radius = solid.radius(), end = toCentre.dot(face.normal) + radius;
    if (end <= 0 || (toCentre - toCentre.dot(face.normal)*face.normal).norm() > radius + 2*face.size) return;
    const double area = face.area/points_.size();
    for (const FacePoint& shape : points_)
    {
        Vec3 x = Vec3::Zero();
        for (int k = 0; k < mesh_.dim; ++k) x += shape[k]*face.corners[k];
        if (solid.distance(x) < 0) outside.addForce(-at(shape, face.pressure)*area*face.normal, x);
        const Chord chord = chordIn(solid, x, face.normal, end, face.size/partsOfElement);
        if (chord.length <= 0) continue;
        const double displaced = density(face, shape)*chord.length*area;
        const Vec3 middle = x + chord.moment/chord.length*face.normal, fromMiddle = chord.length/std::sqrt(12.0)*face.normal;
        outside.addForce(displaced*((1 - share)*outside.addedMass*face.gravity - share*face.gravity), middle);
        for (const Vec3& half : {Vec3(middle - fromMiddle), Vec3(middle + fromMiddle)}) outside.addMass(displaced/2, half);
    }
}

/// Pressure has no moment about axes around which the solid turns into itself (rigidCoupling.hpp).
void BeyondMesh::addSolid(const std::vector<Face>& faces, const Solid& solid, double share, double* load, double* inertia) const
{
    Outside outside;
    outside.centre = solid.pose.position;
    outside.isRotation = Eigen::Matrix3d::Identity() - solid.turning();
    outside.addedMass = addedMass(mesh_, solid);
    for (const Face& face : faces) addFace(face, solid, share, outside);
    Eigen::Matrix<double, 6, 1> loads;
    loads << outside.force, outside.isRotation*outside.moment;
    const std::vector<int> place = placesInSpace(mesh_);
    for (std::size_t r = 0; r < place.size(); ++r)
    {
        load[r] += loads[place[r]];
        for (std::size_t c = 0; c < place.size(); ++c) inertia[r*place.size() + c] += outside.inertia(place[r], place[c]);
    }
}

/// Of the fluid's weight along the patch what the prescribed pressure carries there, 0 to 1. Of the whole patch: in single faces that the surface crosses the linear
/// pressure does not tell.
double BeyondMesh::weightShare(const std::vector<Face>& faces) const
{
    double sums[2] = {};    // carried, there
    for (const Face& face : faces)
    {
        double weight = 0;
        for (const FacePoint& shape : points_) weight += density(face, shape)*face.gravity.squaredNorm()/points_.size();
        sums[0] += face.area*face.slope.dot(face.gravity);
        sums[1] += face.area*weight;
    }
    halo_.sum(sums, 2);
    return sums[1] > 0 ? std::clamp(sums[0]/sums[1], 0.0, 1.0) : 0;
}

double BeyondMesh::density(const Face& face, const FacePoint& shape) const { return at(shape, face.side) > 0 ? fluid_.rhoLiquid : fluid_.rhoGas; }

void BeyondMesh::addLoads(const FlowStepData& step, int nDof, std::vector<double>& loads, std::vector<double>& inertia) const
{
    const std::vector<Solid>& solids = *step.solids;
    std::vector<double> stream;     // of patches that do not prescribe the pressure
    for (const Passage& passage : passages_)
    {
        if (std::none_of(solids.begin(), solids.end(), [&](const Solid& solid) { return isReached(passage, solid); })) continue;
        const BoundaryPatch& patch = patches_[passage.patch];
        const bool isPrescribed = patch.pressure != BoundaryPatch::Pressure::Natural;
        if (!isPrescribed && stream.empty()) extendLinearly(mesh_, halo_, *step.cover, stream = step.state->p, bodyRings);
        if (!isPrescribed) setStreamPressures(step, patch, stream);
        const std::vector<Face> faces = makeFaces(step, patch, isPrescribed ? (*step.patchValues)[passage.patch].pressure : stream);
        const double share = isPrescribed ? weightShare(faces) : 1;
        for (std::size_t s = 0; s < solids.size(); ++s)
            if (isReached(passage, solids[s])) addSolid(faces, trueShape(solids[s]), share, &loads[s*nDof], &inertia[s*nDof*nDof]);
    }
}

} // namespace flotsam
