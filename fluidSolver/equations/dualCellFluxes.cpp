// SPDX-License-Identifier: GPL-3.0-or-later
/// The element loops of the dual-cell transport: face values, model flux.
#include "equations/dualCellTransport.hpp"
#include "equations/profileMeans.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

template<int dim>
double dot(const double* a, const double* b)
{
    double s = a[0]*b[0] + a[1]*b[1];
    if constexpr (dim == 3)
    {
        s += a[2]*b[2];
    }
    return s;
}

/// Centroids of an element's dual faces, in the order of CornerPairs, and the velocities there.
template<int dim>
struct FaceGeometry
{
    using Pairs = CornerPairs<dim>;
    static constexpr int n = dim + 1;
    static constexpr DualFaceWeights weights = DualFaceWeights::of(dim);
    double corner[n][dim], centroid[Pairs::count][dim], velocity[Pairs::count][dim];

    FaceGeometry(const SimplexMesh& mesh, const std::vector<double>& u, const int* nodes)
    {
        double speed[n][dim], sum[dim] = {}, speedSum[dim] = {};
        for (int a = 0; a < n; ++a)
        {
            for (int d = 0; d < dim; ++d)
            {
                corner[a][d] = mesh.x[std::size_t(nodes[a])*dim + d];
                speed[a][d] = u[std::size_t(nodes[a])*dim + d];
                sum[d] += corner[a][d];
                speedSum[d] += speed[a][d];
            }
        }
        for (int p = 0; p < Pairs::count; ++p)
        {
            const int a = Pairs::first[p], b = Pairs::second[p];
            for (int d = 0; d < dim; ++d)
            {
                centroid[p][d] = atFace(sum[d], corner[a][d], corner[b][d]);
                velocity[p][d] = atFace(speedSum[d], speed[a][d], speed[b][d]);
            }
        }
    }

    static double atFace(double sum, double a, double b) { return weights.far*sum + (weights.near - weights.far)*(a + b); }
};

/// The corners of an element as its faces see them upwind.
template<int dim>
struct UpwindCorners
{
    static constexpr int n = dim + 1;
    ProfileKind kind[n];
    double alpha[n], exchanged[n];  // exchanged: value of the upwind exchange
    bool hasProfile = false;

    UpwindCorners(const ProfileReconstruction& reconstruction, const std::vector<double>& nodalAlpha, const std::vector<double>& nodalExchanged, const int* nodes)
    {
        for (int a = 0; a < n; ++a)
        {
            kind[a] = reconstruction.kind(nodes[a]);
            hasProfile = hasProfile || kind[a] > ProfileKind::Bulk;
            alpha[a] = nodalAlpha[nodes[a]];
            exchanged[a] = nodalExchanged[nodes[a]];
        }
    }

    /// Face value of a corner without a profile, less that of the upwind exchange. In a cell of traces it differs from the cell's own by these at most.
    double plain(int upwind, int other) const
    {
        const double most = kind[upwind] == ProfileKind::Tail ? std::min(alpha[upwind], 1 - alpha[upwind]) : 0;
        return alpha[upwind] + std::clamp(alpha[other] - alpha[upwind], -most, most) - exchanged[upwind];
    }

    bool hasSeveralFronts() const { return std::count(kind, kind + n, ProfileKind::Front) > 1; }
};

/// Faces with a profile upwind, of which the means over what passes during the step are computed together.
/// offset: of the face's centroid from the upwind node; velocity: at the centroid.
class SweptFaces
{
public:
    struct Face
    {
        double* antiFlux;
        double volume, upwind;      ///< that passes, and the upwind value of alpha
        const NodeProfile* film;    ///< null: one front
    };

    ~SweptFaces() { evaluate(); }

    template<int dim>
    void addFront(const Face& face, const NodeProfile& front, const double* offset, const double* velocity, double dt)
    {
        double direction[dim];
        const double psi = front.value + front.steepness*bentDistance<dim>(front, offset, direction);
        addMean(psi, front.steepness*dt*dot<dim>(direction, velocity));
        addFace(face);
    }

    /// The mean over the whole face between two nodes, half way between them, instead of one element's piece of it; toNeighbour: from the upwind node; thickness: of the upwind
    /// cell along its front's normal.
    template<int dim>
    void addWholeFront(const Face& face, const NodeProfile& front, const double* toNeighbour, const double* velocity, double dt, double thickness)
    {
        double half[dim], direction[dim];
        for (int d = 0; d < dim; ++d) half[d] = 0.5*toNeighbour[d];
        const double along = dot<dim>(half, front.normal), sine = std::sqrt(std::max(0., 1 - along*along/dot<dim>(half, half)));
        const double psi = front.value + front.steepness*bentDistance<dim>(front, half, direction);
        const double swept = front.steepness*dt*dot<dim>(direction, velocity), across = front.steepness*thickness*sine;
        if (across > std::abs(swept)) addMean(psi + 0.5*across, across);
        else addMean(psi, swept);
        addFace(face);
    }

    /// gradient: of the level in the element.
    template<int dim>
    void addRoof(const Face& face, const NodeProfile& roof, const double* gradient, const double* offset, const double* velocity, double dt)
    {
        const double length = 1e-30 + std::sqrt(dot<dim>(gradient, gradient));
        const double scale = std::min(roof.roofFactor, 1/length)*roof.steepness;
        addMean(roof.value + scale*dot<dim>(gradient, offset), scale*dt*dot<dim>(gradient, velocity));
        addFace(face);
    }

    template<int dim>
    void addFilm(const Face& face, const double* offset, const double* velocity, double dt)
    {
        const NodeProfile& film = *face.film;
        double direction[dim];
        const double across = film.steepness*bentDistance<dim>(film, offset, direction), sweptAcross = film.steepness*dt*dot<dim>(direction, velocity);
        const double wedge = film.steepness*dot<dim>(film.taper, offset), sweptWedge = film.steepness*dt*dot<dim>(film.taper, velocity);
        addMean(film.value + wedge - across, sweptWedge - sweptAcross);
        addMean(film.otherValue + wedge + across, sweptWedge + sweptAcross);
        addFace(face);
    }

private:
    static constexpr int most = 128;

    void addMean(double psi, double swept)
    {
        psi_[nMeans_] = psi;
        swept_[nMeans_++] = swept;
    }

    void addFace(const Face& face)
    {
        faces_[nFaces_++] = face;
        if (nMeans_ > most - 2) evaluate();
    }

    void evaluate()
    {
        double mean[most];
        sweptMeans(psi_, swept_, nMeans_, mean);
        const double* next = mean;
        for (int k = 0; k < nFaces_; ++k)
        {
            const Face& face = faces_[k];
            double value = *next++;
            if (face.film)
            {
                const double share = std::max(0., value + *next++ - 1);
                value = face.film->isGas ? 1 - share : share;
            }
            *face.antiFlux = face.volume*(value - face.upwind);
        }
        nMeans_ = nFaces_ = 0;
    }

    int nMeans_ = 0, nFaces_ = 0;
    double psi_[most], swept_[most];
    Face faces_[most];
};

} // namespace

/// antiFlux_ = dt F (alpha of the profile at the face - value of the upwind exchange), from the first corner to the second.
template<int dim>
void DualCellTransport::addFaceValues(const Arguments& in)
{
    using Pairs = CornerPairs<dim>;
    constexpr int n = dim + 1;
    antiFlux_.resize(std::max(antiFlux_.size(), active_.size()*Pairs::count));
    frontElements_.clear();
    SweptFaces faces;
    for (std::size_t k = 0; k < active_.size(); ++k)
    {
        const int e = stored_[active_[k]];
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        const double dt = timeStep(in, activeLevel_[k]);
        const double* flux = &flux_[std::size_t(active_[k])*Pairs::count];
        double* antiFlux = &antiFlux_[k*Pairs::count];

        const UpwindCorners<dim> corners(reconstruction_, in.alpha, upwind_, nodes);
        if (!corners.hasProfile)
        {
            for (int p = 0; p < Pairs::count; ++p)
            {
                const int a = Pairs::first[p], b = Pairs::second[p];
                const double fromA = corners.plain(a, b), fromB = corners.plain(b, a);
                antiFlux[p] = dt*flux[p]*(flux[p] > 0 ? fromA : fromB);
            }
            continue;
        }
        if (corners.hasSeveralFronts())
        {
            frontElements_.push_back(k);
        }

        double gradient[dim];
        reconstruction_.levelGradient<dim>(e, gradient);
        const FaceGeometry<dim> geometry(mesh_, in.u, nodes);
        const bool isCut = in.cover && in.cover->state[e] == ElementState::Cut;
        for (int p = 0; p < Pairs::count; ++p)
        {
            const int a = Pairs::first[p], b = Pairs::second[p], upwind = flux[p] > 0 ? a : b;
            const ProfileKind kind = corners.kind[upwind];
            if (kind <= ProfileKind::Bulk)
            {
                antiFlux[p] = dt*flux[p]*corners.plain(upwind, a + b - upwind);
                continue;
            }
            const NodeProfile& profile = reconstruction_.profile(nodes[upwind]);
            const SweptFaces::Face face{&antiFlux[p], dt*flux[p], corners.exchanged[upwind], kind == ProfileKind::Film ? &profile : nullptr};
            const double* velocity = geometry.velocity[p];
            double offset[dim];
            for (int d = 0; d < dim; ++d)
            {
                offset[d] = geometry.centroid[p][d] - geometry.corner[upwind][d];
            }
            if (kind == ProfileKind::Film)
            {
                faces.addFilm<dim>(face, offset, velocity, dt);
            }
            else if (kind == ProfileKind::Front && isCut)
            {
                // what a solid leaves of the pieces above and below a node differs, and as it moves along the surface one would gain on the other
                double toNeighbour[dim];
                for (int d = 0; d < dim; ++d) toNeighbour[d] = geometry.corner[a + b - upwind][d] - geometry.corner[upwind][d];
                faces.addWholeFront<dim>(face, profile, toNeighbour, velocity, dt, 2*cells_.halfWidth(nodes[upwind], profile.normal));
            }
            else if (kind == ProfileKind::Front)
            {
                faces.addFront<dim>(face, profile, offset, velocity, dt);
            }
            else
            {
                faces.addRoof<dim>(face, profile, gradient, offset, velocity, dt);
            }
        }
    }
}

/// The Allen-Cahn flux gamma delta grad alpha (1 - 1/|grad level|), which vanishes in the equilibrium profile
/// (ratio form).
template<int dim>
void DualCellTransport::addModelFlux(const Arguments& in)
{
    using Pairs = CornerPairs<dim>;
    constexpr int n = dim + 1;
    for (std::size_t k = 0; k < active_.size(); ++k)
    {
        const int e = stored_[active_[k]];
        if (in.cover && in.cover->state[e] != ElementState::Fluid)
        {
            continue;
        }
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        const double* g = &mesh_.gradN[std::size_t(e)*n*dim];
        double slope[dim] = {}, gradient[dim], width = 0;
        reconstruction_.levelGradient<dim>(e, gradient);
        bool inBand = false;
        for (int a = 0; a < n; ++a)
        {
            const int i = nodes[a];
            inBand = inBand || reconstruction_.kind(i) != ProfileKind::Bulk;
            width += width_[i]/n;
            for (int d = 0; d < dim; ++d)
            {
                slope[d] += in.alpha[i]*g[a*dim + d];
            }
        }
        const double length = std::sqrt(dot<dim>(gradient, gradient));
        if (!inBand || length <= 0)
        {
            continue;
        }
        const double factor = timeStep(in, activeLevel_[k])*in.mobility*width*(1 - std::min(2., 1/length))*mesh_.volume[e]/n;
        for (int p = 0; p < Pairs::count; ++p)
        {
            antiFlux_[k*Pairs::count + p] -= factor*(dot<dim>(slope, g + Pairs::second[p]*dim) - dot<dim>(slope, g + Pairs::first[p]*dim));
        }
    }
}

template void DualCellTransport::addFaceValues<2>(const Arguments&);
template void DualCellTransport::addModelFlux<2>(const Arguments&);
template void DualCellTransport::addFaceValues<3>(const Arguments&);
template void DualCellTransport::addModelFlux<3>(const Arguments&);

} // namespace flotsam
