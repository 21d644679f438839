// SPDX-License-Identifier: GPL-3.0-or-later
/// What a sub-step works on: the spheres and neighbours that can touch soon.
#pragma once

#include "demCoupling/liggghts/liggghtsParts.hpp"

namespace flotsam
{

/// Triangles of a mesh that a sphere can touch soon.
struct SphereTriangles { size_t mesh; int sphere; std::vector<int> triangles; };

/// LIGGGHTS' list of pairs of spheres.
LAMMPS_NS::NeighList& pairList(const LiggghtsModel& model);

/// LIGGGHTS' list of the spheres near a triangle.
std::vector<int>& meshList(LAMMPS_NS::FixMeshSurface& mesh, int triangle);

/// LIGGGHTS' lists hold every pair of spheres closer than its skin, and every sub-step visits them, places every sphere twice and asks every
/// sphere for its force. Few of them can touch within the next sub-steps: those alone are left in the lists, and those alone are moved and
/// asked, here instead of by LIGGGHTS. What is left out would add zeros: the motion is the same to the last bit.
/// The choice is made in two stages: candidates for some twenty sub-steps from LIGGGHTS' lists, and from the candidates what can touch within a few.
class NearSpheres
{
public:
    NearSpheres(LiggghtsModel& model, const DemSetup& setup);

    /// After LIGGGHTS has rebuilt its lists, with all spheres in their places. `nearPlane`: per wall, spheres that can touch the plane.
    void takeLists(const std::vector<std::vector<int>>& nearPlane);
    /// Instead of a rebuild, where the bodies are exactly as at the last one: then its lists are what another would give. False where they are not.
    bool takeListsAgain();
    /// Whether LIGGGHTS' lists are of the present positions.
    bool isNew() const { return isNew_; }
    /// After the bodies have moved. False where only a rebuild helps.
    bool keepUp();
    /// Bound of the present speed of any centre of a body's spheres [m/s]: along the body's own axes, as a log that rolls moves none of those on its axis.
    double speedOf(size_t body) const;
    /// Before a look ahead: what comes into touch while the bodies move by `ways` [m] is among the candidates, as far as LIGGGHTS' own lists have it,
    /// and in its place.
    void cover(const std::vector<double>& ways);
    /// Pairs of spheres that can touch before the next choice of candidates, in LIGGGHTS' order.
    template <class Visit>
    void forEachCandidate(const Visit& visit) const
    {
        for (const Neighbours& n : candidates_)
            for (size_t k = n.first; k < n.last; ++k)
                visit(n.sphere, candidateOthers_[k]);
    }
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
    /// A sphere and those beside it, a part of a list of all.
    struct Neighbours { int sphere; size_t first, last; };
    /// Of a sphere of LIGGGHTS' lists when it was last looked at: least gap to any of the others, and how far its body and the fastest one had gone by then [m].
    struct Gap { double least, way, largestWay; };
    /// What LIGGGHTS visits in a sub-step, side by side: its own lists are spread over some MB, which no cache holds.
    struct ListedPairs
    {
        std::vector<int> others, flags;
        std::vector<double> springs;
        /// Lists that LIGGGHTS points to do not move while others are added.
        void clear(size_t most)
        {
            others.clear();
            flags.clear();
            springs.clear();
            others.reserve(most);
            flags.reserve(most);
            springs.reserve(3 * most);
        }
        void add(int other, int flag, const Vec3& spring)
        {
            others.push_back(other);
            flags.push_back(flag);
            springs.insert(springs.end(), spring.data(), spring.data() + 3);
        }
    };
    struct TriangleNeighbours { size_t mesh; int triangle; std::array<Vec3, 3> corners; std::vector<int> spheres; };
    /// Pose of a body as LIGGGHTS keeps it: centre and axes.
    using Place = std::array<Vec3, 4>;

    Place placeOf(size_t body) const;
    double wayFrom(const std::vector<Place>& places, size_t body) const;
    double wantedReach(size_t body, double steps, double least) const;
    double listReach() const;
    size_t bodyOf(int sphere) const { return bodies_[static_cast<size_t>(sphere)]; }
    void takePairs();
    void takeTriangles();
    void select();
    void forgetGaps();
    void addWays();
    void selectCandidates();
    void addCandidates(const Neighbours& all, Gap& gap);
    void collectCandidates();
    void selectFew();
    int selectFew(const Neighbours& all);
    void selectTriangles();
    void sortBySpheres();
    void markActive(int sphere) { isActive_[static_cast<size_t>(sphere)] = 1; }

    LiggghtsModel& model_;
    std::vector<size_t> bodies_;    ///< of each sphere
    std::vector<Vec3> extents_;     ///< of the spheres' centres along each body's axes [m]
    bool isNew_ = false;
    bool isOld_ = false;            ///< before the next choice something may touch that LIGGGHTS' lists have not
    std::vector<Neighbours> pairs_, candidates_; ///< LIGGGHTS' own lists, and what is left of them
    std::vector<int> others_, candidateOthers_;
    std::vector<Gap> gaps_;         ///< of pairs_
    std::vector<TriangleNeighbours> triangles_;
    std::vector<int> allSpheres_, listed_, nearPlanes_, active_;
    std::vector<int> near_;         ///< spheres of candidates, at triangles or planes
    std::vector<Place> rebuilt_, selected_, few_; ///< of the bodies when the lists were rebuilt, when candidates and when the few were chosen
    std::vector<char> wasGone_, wasRetreated_;  ///< when the lists were rebuilt
    std::vector<double> reach_, shortReach_;    ///< how far each body may move before the next choice of candidates, of the few [m]
    std::vector<double> ways_;      ///< each body has gone since the rebuild, from choice to choice [m]
    double largestWay_ = 0;         ///< sum of the largest ways from choice to choice [m]
    std::vector<int> atMeshes_;
    std::vector<std::vector<int>> touchable_;
    std::vector<SphereTriangles> atTriangles_;
    std::vector<char> isActive_;    ///< of each sphere
    std::vector<char> isHeld_;      ///< of each sphere: active whatever pairs are chosen, at triangles or planes
    ListedPairs fewPairs_, fewPairsBefore_;
};

} // namespace flotsam
