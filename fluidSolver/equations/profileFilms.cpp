// SPDX-License-Identifier: GPL-3.0-or-later
/// Cells that hold both surfaces of a film: found by what one front misses in the neighbours.
#include "equations/filmFit.hpp"
#include "equations/profileReconstruction.hpp"

#include "geometry/cover.hpp"

#include <cmath>

namespace flotsam
{

namespace
{

/// A surface is thick where the cell's neighbours reach both phases up to this.
constexpr double pureLimit = 0.01;
/// A front whose neighbours are met this well needs no film; a film must meet them by this factor better.
constexpr double frontIsGood = 1e-3, filmIsBetter = 0.1;
/// Largest thickness of a film, of the cell's.
constexpr double thickFilm = 4;
/// Ties are decided the same way whatever the round-off, on any number of ranks.
constexpr double tie = 1e-6;

/// About the eigenvector of the largest eigenvalue, by powers; the fit turns what is left.
template<int dim>
void commonDirection(const double (&tensor)[dim][dim], double (&direction)[dim])
{
    int largest = 0;
    for (int d = 1; d < dim; ++d)
    {
        largest = tensor[d][d] > (1 + tie)*tensor[largest][largest] ? d : largest;
    }
    std::copy_n(tensor[largest], dim, direction);
    for (int iteration = 0; iteration < 4; ++iteration)
    {
        normalise(direction);
        double image[dim] = {};
        for (int d = 0; d < dim; ++d)
        {
            for (int c = 0; c < dim; ++c)
            {
                image[d] += tensor[d][c]*direction[c];
            }
        }
        std::copy_n(image, dim, direction);
    }
    normalise(direction);
}

} // namespace

/// axes[0]: the direction, without its sign, that the elements' normals around a node have in common; the others complete it.
template<int dim>
void ProfileReconstruction::findFilmAxes(int i, const std::vector<double>& alpha, const Cover* cover, double (&axes)[dim][dim]) const
{
    constexpr int n = dim + 1;
    double tensor[dim][dim] = {};
    for (int k = graph_.nodeElementStart[i]; k < graph_.nodeElementStart[i + 1]; ++k)
    {
        const int e = graph_.nodeElement[k];
        if (cover && cover->state[e] == ElementState::Solid)
        {
            continue;
        }
        double gradient[dim], length = 1e-30, weight = 0;
        levelGradient<dim>(e, gradient);
        for (int a = 0; a < n; ++a)
        {
            weight += variation(alpha[mesh_.elements[std::size_t(e)*n + a]]);
        }
        for (int d = 0; d < dim; ++d)
        {
            length += gradient[d]*gradient[d];
        }
        weight *= weight*mesh_.volume[e]/std::sqrt(length);
        for (int d = 0; d < dim; ++d)
        {
            for (int c = 0; c < dim; ++c)
            {
                tensor[d][c] += weight*gradient[d]*gradient[c];
            }
        }
    }
    commonDirection(tensor, axes[0]);
    completeAxes<dim>(axes);
}

/// Whether node i, which has a front, is better described by a film; if so, it is one.
template<int dim>
bool ProfileReconstruction::fitFilm(const Ring& ring, const std::vector<double>& alpha, bool isCoherent, const Cover* cover)
{
    const int i = ring.node[0];
    bool hasGas = false, hasLiquid = false;
    double levels = 0, levelSize = 0;
    for (int k = 1; k < ring.size; ++k)
    {
        const int j = ring.node[k];
        hasGas = hasGas || alpha[j] < pureLimit;
        hasLiquid = hasLiquid || alpha[j] > 1 - pureLimit;
        levels += ring.count[k]*(level_[j] - level_[i]);
        levelSize += ring.count[k]*std::abs(level_[j] - level_[i]);
    }
    if (isCoherent && hasGas && hasLiquid)
    {
        return false;
    }
    const double residual = frontResidual<dim>(ring, alpha);
    if (residual < frontIsGood)
    {
        return false;
    }
    NodeProfile& p = profile_[i];
    const bool isGas = hasGas == hasLiquid ? levels > tie*levelSize : hasLiquid;
    double axes[dim][dim];
    findFilmAxes<dim>(i, alpha, cover, axes);
    const double length = 2*cells_.halfWidth(i, axes[0]), steepness = length*p.steepness;
    SurfaceSample samples[maxRing];
    for (int k = 0; k < ring.size; ++k)
    {
        const int j = ring.node[k];
        samples[k] = sampleOf<dim>(i, j, isGas ? 1 - alpha[j] : alpha[j], axes, length);
        samples[k].growth = std::exp(0.5*samples[k].thickness);
    }
    Film<dim> film = flotsam::fitFilm<dim>(samples, ring.size, steepness, filmIsBetter*residual);
    if (!(film.residual < filmIsBetter*residual))
    {
        return false;
    }
    fillFilm(film, samples[0], steepness);
    if (!(film.thickness < thickFilm))
    {
        return false;
    }
    kind_[i] = ProfileKind::Film;
    p.isGas = isGas;
    double slope = 1;
    for (const double t : film.tilt)
    {
        slope += t*t;
    }
    slope = std::sqrt(slope);
    setBend<dim>(p, film.curvature, axes, -1/(slope*length));
    const double ownBend = p.steepness*cells_.meanBend(i, p.bend);      // the fit has it in the middle
    p.value = steepness/slope*(0.5*film.thickness + film.middle) + ownBend;
    p.otherValue = steepness/slope*(0.5*film.thickness - film.middle) - ownBend;
    for (int d = 0; d < dim; ++d)
    {
        p.normal[d] = axes[0][d]/slope;
        p.taper[d] = 0;
        for (int c = 0; c < dim - 1; ++c)
        {
            p.normal[d] -= film.tilt[c]*axes[c + 1][d]/slope;
            p.taper[d] += 0.5*film.taper[c]*axes[c + 1][d]/slope;
        }
    }
    return true;
}

template bool ProfileReconstruction::fitFilm<2>(const Ring&, const std::vector<double>&, bool, const Cover*);
template bool ProfileReconstruction::fitFilm<3>(const Ring&, const std::vector<double>&, bool, const Cover*);

} // namespace flotsam
