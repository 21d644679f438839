// SPDX-License-Identifier: GPL-3.0-or-later
/// What a sub-step works on: the spheres and neighbours that can touch soon.
#pragma once

#include "demCoupling/liggghts/liggghtsParts.hpp"

namespace flotsam
{

/// Triangles of a mesh that a sphere can touch soon.
struct SphereTriangles { size_t mesh; int sphere; std::vector<int> triangles; };

/// LIGGGHTS' list of the spheres near a triangle.
std::vector<int>& meshList(LAMMPS_NS::FixMeshSurface& mesh, int triangle);

/// LIGGGHTS' lists hold every pair of spheres closer than its skin, and every sub-step visits them, places every sphere twice and asks every
/// sphere for its force. Few of them can touch within the next sub-steps: those alone are left in the lists, and those alone are moved and
/// asked, here instead of by LIGGGHTS. What is left out would add zeros: the motion is the same to the last bit.
class NearSpheres
{
public:
    NearSpheres(LiggghtsModel& model, const DemSetup& setup);

    /// After LIGGGHTS has rebuilt its lists, with all spheres in their places. `nearPlane`: per wall, spheres that can touch the plane.
    void takeLists(const std::vector<std::vector<int>>& nearPlane);
    /// Whether LIGGGHTS' lists are of the present positions.
    bool isNew() const { return isNew_; }
    /// After the bodies have moved. False where only a rebuild helps.
    bool keepUp();
    /// Before a look ahead: what comes into touch while the bodies move by `ways` [m] is in the lists, as far as LIGGGHTS' own have it.
    void cover(const std::vector<double>& ways);
    /// After the forces of a sub-step: pairs that are apart have no tangential spring. LIGGGHTS itself forgets it at the next rebuild only; closed
    /// again before, the contact would push sideways for a slip that was another contact's.
    void dropOpenedContacts();
    /// The lists are complete again, and every sphere has to be placed.
    void showAll();

    /// Spheres that can touch something soon.
    const std::vector<int>& active() const { return active_; }

    /// Spheres with a triangle of a mesh in reach, in order.
    const std::vector<int>& atMeshes() const { return atMeshes_; }
    /// Triangles of a mesh with a sphere in reach.
    const std::vector<int>& touchable(const MeshGroup& group) const { return touchable_[static_cast<size_t>(&group - model_.meshes.data())]; }
    /// The same by spheres.
    const std::vector<SphereTriangles>& atTriangles() const { return atTriangles_; }

private:
    struct Neighbours { int sphere; std::vector<int> others; };
    struct Touching { int other, flag; Vec3 spring; };
    struct TriangleNeighbours { size_t mesh; int triangle; std::array<Vec3, 3> corners; std::vector<int> spheres; };
    /// Pose of a body as LIGGGHTS keeps it: centre and axes.
    using Place = std::array<Vec3, 4>;

    Place placeOf(size_t body) const;
    double wayFrom(const std::vector<Place>& places, size_t body) const;
    double wantedReach(size_t body) const;
    double listReach() const;
    size_t bodyOf(int sphere) const { return bodies_[static_cast<size_t>(sphere)]; }
    void takePairs();
    void takeTriangles();
    void select();
    void selectPairs();
    int selectPairs(const Neighbours& all);
    void selectTriangles();
    void sortBySpheres();
    void markActive(int sphere) { isActive_[static_cast<size_t>(sphere)] = 1; }

    LiggghtsModel& model_;
    std::vector<size_t> bodies_;    ///< of each sphere
    std::vector<Vec3> extents_;     ///< of the spheres' centres along each body's axes [m]
    bool isNew_ = false;
    bool isOld_ = false;            ///< before the next choice something may touch that LIGGGHTS' lists have not
    std::vector<Neighbours> pairs_; ///< LIGGGHTS' own lists
    std::vector<TriangleNeighbours> triangles_;
    std::vector<int> allSpheres_, listed_, nearPlanes_, active_;
    std::vector<Place> rebuilt_, selected_; ///< of the bodies when the lists were rebuilt, when the present choice was made
    std::vector<double> reach_;     ///< how far each body may move before the next choice [m]
    std::vector<int> atMeshes_;
    std::vector<std::vector<int>> touchable_;
    std::vector<SphereTriangles> atTriangles_;
    std::vector<char> isActive_;    ///< of each sphere
    std::vector<Touching> touching_; ///< of the sphere at hand
};

} // namespace flotsam
