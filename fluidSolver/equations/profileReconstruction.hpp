// SPDX-License-Identifier: GPL-3.0-or-later
/// The model's own profile inside every dual cell that the free surface crosses.
///
/// A cell's alpha is taken as the mean of 1/(1+exp(-psi)), psi = distance/width, over the cell. Where the neighbours agree
/// on the direction the surface is one front of second degree (frontFit.hpp); elsewhere (thin filaments, corners) psi is a "roof": one slope and
/// direction per element around the node, one value at the node. Films with both surfaces in a cell are fitted to the neighbours (filmFit.hpp).
#pragma once

#include "equations/dualCells.hpp"

#include <algorithm>

namespace flotsam
{

struct SurfaceSample;

/// A cell is full or empty up to traces (Tail), mixed without a surface (Bulk), or has a profile.
enum class ProfileKind : char { Tail, Bulk, Front, Roof, Film };

/// psi(x) = value + steepness (normal.r + r.K r/2) (front), r = x - x_node, or per element (roof). A film of one phase has two fronts:
/// psi = value + steepness (taper.r -+ (normal.r + r.K r/2)), its alpha is the sum of both less 1.
struct NodeProfile
{
    double value;           ///< psi at the node
    double steepness;       ///< 1/width [1/m]
    double roofFactor;      ///< slope of a roof over that of the interpolated psi, before it is limited to 1/width
    double normal[3];       ///< unit, into the liquid (front) or across the film
    double bend[6];         ///< K [1/m]: xx yy xy, in 3D xx yy zz xy xz yz
    double taper[3];        ///< half the gradient of a film's thickness
    double otherValue;      ///< of a film's second front
    bool isGas;             ///< the film is of gas
};

/// normal.r + r.K r/2 [m] and its gradient normal + K r.
template<int dim>
[[gnu::always_inline]] inline double bentDistance(const NodeProfile& p, const double* r, double* gradient)
{
    const double* k = p.bend;
    if constexpr (dim == 2)
    {
        gradient[0] = p.normal[0] + k[0]*r[0] + k[2]*r[1];
        gradient[1] = p.normal[1] + k[2]*r[0] + k[1]*r[1];
    }
    else
    {
        gradient[0] = p.normal[0] + k[0]*r[0] + k[3]*r[1] + k[4]*r[2];
        gradient[1] = p.normal[1] + k[3]*r[0] + k[1]*r[1] + k[5]*r[2];
        gradient[2] = p.normal[2] + k[4]*r[0] + k[5]*r[1] + k[2]*r[2];
    }
    double distance = 0;
    for (int d = 0; d < dim; ++d)
    {
        distance += 0.5*(p.normal[d] + gradient[d])*r[d];
    }
    return distance;
}

/// Weight of a node in the normals around it: 0 in water and gas.
inline double variation(double alpha)
{
    return alpha*(1 - alpha);
}

/// Outside [mixedEdge, 1 - mixedEdge] a cell counts as full or empty.
constexpr double mixedEdge = 1e-4;
inline bool isMixed(double alpha)
{
    return alpha > mixedEdge && alpha < 1 - mixedEdge;
}

class ProfileReconstruction
{
public:
    ProfileReconstruction(const SimplexMesh& mesh, const NodeGraph& graph, const DualCells& cells,
        const std::vector<double>& width);

    /// `elements`: all local elements in which alpha varies; `nodes`: owned and first-ring nodes of them. Fills kind() and profile() of
    /// `nodes` and the level for levelGradient(). Solid elements of `cover` (may be null) are not read. distance: of the nodes from the surface, read from cell means [m],
    /// null: not known; it decides about cells whose neighbours disagree by the values at the nodes.
    void build(const std::vector<double>& alpha, const std::vector<int>& elements, const std::vector<int>& nodes,
        const Cover* cover, const std::vector<double>* distance);

    ProfileKind kind(int node) const { return kind_[node]; }
    const NodeProfile& profile(int node) const { return profile_[node]; }   ///< of a front, roof or film
    /// Gradient of the level, width ln(alpha/(1-alpha)), clipped [m], in an element with a node in the band: of length 1 in the equilibrium profile.
    template<int dim> void levelGradient(int element, double (&gradient)[dim]) const;

    long nFronts() const { return nFronts_; }
    long nRoofs() const { return nRoofs_; }
    long nFilms() const { return nFilms_; }

private:
    static constexpr int maxRing = 128;
    /// A node, first, and its neighbours, with the number of elements around the first that have them.
    struct Ring { int size, node[maxRing], count[maxRing]; };

    template<int dim> void sumNormals(const std::vector<double>& alpha, const std::vector<int>& elements, const Cover* cover);
    template<int dim> bool agreesByMeans(int i, const std::vector<double>& alpha, const Cover* cover);
    template<int dim> void fillFront(int i, double alpha);
    template<int dim> void bendFront(const Ring& ring, const std::vector<double>& alpha);
    template<int dim> static void setBend(NodeProfile& p, const double* curvature, const double (&axes)[dim][dim], double factor);
    template<int dim> bool fitFilm(const Ring& ring, const std::vector<double>& alpha, bool isCoherent, const Cover* cover);
    template<int dim> void findRing(int i, const Cover* cover, Ring& ring);
    template<int dim> void findFilmAxes(int i, const std::vector<double>& alpha, const Cover* cover, double (&axes)[dim][dim]) const;
    template<int dim> SurfaceSample sampleOf(int i, int j, double share, const double (&axes)[dim][dim], double length) const;
    template<int dim> double frontResidual(const Ring& ring, const std::vector<double>& alpha) const;
    template<int dim> void fitRoof(int i, double alpha, const Cover* cover);
    template<int dim> void build(const std::vector<double>& alpha, const std::vector<int>& elements,
        const std::vector<int>& nodes, const Cover* cover);

    const std::vector<double>* distance_ = nullptr; // during build()
    const SimplexMesh& mesh_;
    const NodeGraph& graph_;
    const DualCells& cells_;
    const std::vector<double>& width_;
    ShareMoments moments_;
    std::vector<ProfileKind> kind_;
    std::vector<NodeProfile> profile_;
    std::vector<double> level_, normalSum_, coherence_;
    std::vector<int> levelNodes_;       // of elements with a node in the band
    std::vector<char> hasLevel_;
    std::vector<int> placeInRing_;      // while a ring is found: of its nodes, else -1
    long nFronts_ = 0, nRoofs_ = 0, nFilms_ = 0;
};

template<int dim>
inline void ProfileReconstruction::levelGradient(int element, double (&gradient)[dim]) const
{
    constexpr int n = dim + 1;
    const int* nodes = &mesh_.elements[std::size_t(element)*n];
    const double* gradN = &mesh_.gradN[std::size_t(element)*n*dim];
    std::fill_n(gradient, dim, 0.);
    for (int a = 0; a < n; ++a)
    {
        for (int d = 0; d < dim; ++d)
        {
            gradient[d] += level_[nodes[a]]*gradN[a*dim + d];
        }
    }
}

} // namespace flotsam
