// SPDX-License-Identifier: GPL-3.0-or-later
/// The model's own profile inside every dual cell that the free surface crosses.
///
/// A cell's alpha is taken as the mean of 1/(1+exp(-psi)), psi = distance/width, over the cell. Where the neighbours agree
/// on the direction the surface is one front of second degree (frontFit.hpp); elsewhere (thin filaments, corners) psi is a "roof": one slope and
/// direction per element around the node, one value at the node. Films with both surfaces in a cell are fitted to the neighbours (filmFit.hpp).
#pragma once

#include "equations/dualCells.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

struct SurfaceSample;

/// psi(x) = value + steepness (normal.r + r.K r/2) (front), r = x - x_node, or per element (roof). A film of one phase has two fronts:
/// psi = value + steepness (taper.r -+ (normal.r + r.K r/2)), its alpha is the sum of both less 1.
struct NodeProfile
{
    enum class Kind : int { Tail, Bulk, Front, Roof, Film };
    double normal[3];       ///< unit, into the liquid (front) or across the film
    double bend[6];         ///< K [1/m]: xx yy xy, in 3D xx yy zz xy xz yz
    double taper[3];        ///< half the gradient of a film's thickness
    double value;           ///< psi at the node
    double otherValue;      ///< of a film's second front
    double steepness;       ///< 1/width [1/m]
    double roofFactor;      ///< slope of a roof over that of the interpolated psi, before it is limited to 1/width
    Kind kind;
    bool isGas;             ///< the film is of gas
};

/// normal.r + r.K r/2 [m] and its gradient normal + K r.
template<int dim>
double bentDistance(const NodeProfile& p, const double* r, double* gradient)
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

/// int_0^1 of 1/(1+exp(-(psi - s swept))) ds: mean of the profile over what passes a face during a step.
inline double sweptMean(double psi, double swept)
{
    constexpr double limit = 35;    // exp(-35) is below the round-off of 1
    if (std::abs(swept) < 0.3)      // series about the middle, error below 1e-9; a third of the exact form's time
    {
        const double middle = 1/(1 + std::exp(0.5*swept - std::clamp(psi, -limit, limit)));
        const double slope = middle*(1 - middle), square = swept*swept;
        return middle + slope*(1 - 2*middle)*square*(1./24 + square*(1 - 12*slope)/1920);
    }
    const double first = std::clamp(psi, -limit, limit), last = std::clamp(psi - swept, -limit, limit);
    if (first == last)
    {
        return first > 0 ? 1 : 0;
    }
    return std::log((1 + std::exp(first))/(1 + std::exp(last)))/(first - last);
}

/// Outside [mixedEdge, 1 - mixedEdge] a cell counts as full or empty.
constexpr double mixedEdge = 1e-4;
inline bool isMixed(double alpha)
{
    return alpha > mixedEdge && alpha < 1 - mixedEdge;
}

/// exp(psi at the middle of a slab) from the mean alpha of 1/(1+exp(-psi)) over it; thickness in widths.
inline double frontFromMean(double alpha, double thickness)
{
    const double a = std::exp(0.5*thickness), b = std::expm1(thickness*alpha);
    return std::max(b/(a - (b + 1)/a), 1e-300);
}

class ProfileReconstruction
{
public:
    ProfileReconstruction(const SimplexMesh& mesh, const NodeGraph& graph, const DualCells& cells,
        const std::vector<double>& width);

    /// `elements`: all local elements in which alpha varies; `nodes`: owned and first-ring nodes of them. Fills profile() of
    /// `nodes` and level() of all nodes of elements with a node in the band. Solid elements of `cover` (may be null) are not read.
    void build(const std::vector<double>& alpha, const std::vector<int>& elements, const std::vector<int>& nodes,
        const Cover* cover);

    const NodeProfile& profile(int node) const { return profile_[node]; }
    /// width ln(alpha/(1-alpha)), clipped [m]: its gradient in an element has length 1 in the equilibrium profile.
    double level(int node) const { return level_[node]; }

    long nFronts() const { return nFronts_; }
    long nRoofs() const { return nRoofs_; }
    long nFilms() const { return nFilms_; }

private:
    template<int dim> void sumNormals(const std::vector<double>& alpha, const std::vector<int>& elements, const Cover* cover);
    template<int dim> void fillFront(int i, double alpha);
    template<int dim> void bendFront(const int* ring, int size, const std::vector<double>& alpha);
    template<int dim> static void setBend(NodeProfile& p, const double* curvature, const double (&axes)[dim][dim], double factor);
    template<int dim> bool fitFilm(const int* ring, int size, const std::vector<double>& alpha, bool isCoherent, const Cover* cover);
    template<int dim> int findRing(int i, const Cover* cover, int* ring) const;
    template<int dim> void findFilmAxes(int i, const std::vector<double>& alpha, const Cover* cover, double (&axes)[dim][dim]) const;
    template<int dim> SurfaceSample sampleOf(int i, int j, double share, const double (&axes)[dim][dim], double length) const;
    template<int dim> double frontResidual(const int* ring, int size, const std::vector<double>& alpha) const;
    template<int dim> void fitRoof(int i, double alpha, const Cover* cover);
    template<int dim> void build(const std::vector<double>& alpha, const std::vector<int>& elements,
        const std::vector<int>& nodes, const Cover* cover);

    static constexpr int maxRing = 128;

    const SimplexMesh& mesh_;
    const NodeGraph& graph_;
    const DualCells& cells_;
    const std::vector<double>& width_;
    ShareMoments moments_;
    std::vector<NodeProfile> profile_;
    std::vector<double> level_, normalSum_, coherence_;
    std::vector<int> bandElements_, levelNodes_;   // elements with a node in the band; their nodes
    std::vector<char> hasLevel_;
    long nFronts_ = 0, nRoofs_ = 0, nFilms_ = 0;
};

} // namespace flotsam
