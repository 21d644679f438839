// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/filmFit.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

/// Newton steps, at most, and the step after which a fit counts as found.
constexpr int nIterations = 16;
constexpr double lastStep = 0.05;
/// Most cells that are tried hold no film: by then, at the latest, a film's residual is this near to what is wanted.
constexpr int trialIterations = 4;
constexpr double hopeless = 5;
/// Against its neighbours the fitted cell counts this much.
constexpr double ownWeight = 4;
/// A fit that has not been found when the steps are over makes no film: it would be another one with every change of the last digits.
constexpr double firstDamping = 1e-3;
/// Longest step of an unknown, and the thinnest film.
constexpr double longestStep = 0.5, thinnest = 0.01;
/// What one cell resolves.
constexpr double largestTaper = 0.5;

/// Unknowns: those of the middle, thickness, taper.
template<int dim>
struct Layout : SurfaceShape<dim>
{
    using S = SurfaceShape<dim>;
    static constexpr int thickness = S::size, taper = thickness + 1, size = taper + S::tangents;
};

/// Derivatives of the middle and of the thickness by their unknowns.
template<int dim>
void shapeFunctions(const double* along, double* shape)
{
    using L = Layout<dim>;
    SurfaceShape<dim>::derivatives(along, shape);
    shape[L::thickness] = 1;
    std::copy_n(along, L::tangents, shape + L::taper);
}

/// Mean of a film over a cell and its derivatives by middle and thickness (in units of 1/steepness).
struct FilmMean { double value, byMiddle, byThickness; };

FilmMean filmMean(const SurfaceSample& cell, double fromMiddle, double thickness, double steepness)
{
    const auto front = [&](double distance) { return std::exp(std::clamp(steepness*(0.5*thickness + distance), -150., 150.)); };
    const double upper = front(-fromMiddle), lower = front(fromMiddle), inverse = 1/cell.growth;
    const double u1 = 1 + upper*cell.growth, u2 = 1 + upper*inverse, l1 = 1 + lower*cell.growth, l2 = 1 + lower*inverse;
    const double slopeUp = (u1 - u2)/(u1*u2*cell.thickness), slopeLow = (l1 - l2)/(l1*l2*cell.thickness);
    return {std::log(u1/u2*(l1/l2))/cell.thickness - 1, slopeUp - slopeLow, 0.5*(slopeUp + slopeLow)};
}

template<int dim>
double slopeLength(const double* tilt)
{
    double square = 1;
    for (int d = 0; d < dim - 1; ++d)
    {
        square += tilt[d]*tilt[d];
    }
    return std::sqrt(square);
}

/// A plane film of uniform thickness with the first moment of the samples.
template<int dim>
void startFilm(const SurfaceSample* samples, int nSamples, double* unknown)
{
    double liquid = 0, moment = 0, sum = 0, squares = 0;
    for (int k = 0; k < nSamples; ++k)
    {
        liquid += samples[k].alpha;
        moment += samples[k].alpha*samples[k].across;
        sum += samples[k].across/nSamples;
        squares += samples[k].across*samples[k].across/nSamples;
    }
    std::fill_n(unknown, Layout<dim>::size, 0.);
    unknown[0] = moment/liquid;
    unknown[Layout<dim>::thickness] = liquid/nSamples*std::sqrt(12*(squares - sum*sum) + 1);
}

/// Normal equations of the fit at given unknowns.
template<int dim>
struct NormalEquations
{
    using L = Layout<dim>;
    double matrix[L::size][L::size] = {}, right[L::size] = {};
    double cost = 0;        // what is minimised
    double residual = 0;    // sum of squared differences of the other cells

    NormalEquations(const SurfaceSample* samples, int nSamples, double steepness, const double* unknown)
    {
        const double scale = steepness/slopeLength<dim>(&unknown[L::tilt]);
        for (int k = 0; k < nSamples; ++k)
        {
            const double square = addSample(samples[k], k == 0 ? ownWeight : 1, scale, unknown);
            residual += k == 0 ? 0 : square;
        }
        for (int i = 0; i < L::size; ++i)
        {
            if (i < L::curvature || (i >= L::thickness && i < L::taper))
            {
                continue;
            }
            matrix[i][i] += surfaceRidge;
            right[i] -= surfaceRidge*unknown[i];
            cost += surfaceRidge*unknown[i]*unknown[i];
        }
    }

    /// Returns the squared difference.
    double addSample(const SurfaceSample& sample, double weight, double scale, const double* unknown)
    {
        double shape[L::size], middle = 0, thickness = 0;
        shapeFunctions<dim>(sample.along, shape);
        for (int i = 0; i < L::size; ++i)
        {
            (i < L::thickness ? middle : thickness) += shape[i]*unknown[i];
        }
        const FilmMean mean = filmMean(sample, sample.across - middle, thickness, scale);
        const double defect = sample.alpha - mean.value;
        for (int i = 0; i < L::size; ++i)
        {
            shape[i] *= scale*(i < L::thickness ? mean.byMiddle : mean.byThickness);
        }
        for (int i = 0; i < L::size; ++i)
        {
            right[i] += weight*shape[i]*defect;
            for (int j = i; j < L::size; ++j)
            {
                matrix[i][j] += weight*shape[i]*shape[j];
            }
        }
        cost += weight*defect*defect;
        return defect*defect;
    }

    /// Levenberg-Marquardt's step. Returns the largest change.
    double step(double damping, double* unknown) const
    {
        double m[L::size][L::size], change[L::size];
        std::copy_n(&matrix[0][0], L::size*L::size, &m[0][0]);
        std::copy_n(right, L::size, change);
        double largest = 0;
        for (int i = 0; i < L::size; ++i)
        {
            m[i][i] += damping;
        }
        solveSymmetric(m, change);
        for (int i = 0; i < L::size; ++i)
        {
            unknown[i] += std::clamp(change[i], -longestStep, longestStep);
            largest = std::max(largest, std::abs(change[i]));
        }
        unknown[L::thickness] = std::max(unknown[L::thickness], thinnest);
        const auto limit = [&](int first, int last, double most) {
            std::for_each(unknown + first, unknown + last, [most](double& x) { x = std::clamp(x, -most, most); });
        };
        limit(L::curvature, L::thickness, largestCurvature);
        limit(L::taper, L::size, largestTaper);
        return largest;
    }
};

} // namespace

template<int dim>
Film<dim> fitFilm(const SurfaceSample* samples, int nSamples, double steepness, double wanted)
{
    using L = Layout<dim>;
    double best[L::size], damping = firstDamping;
    startFilm<dim>(samples, nSamples, best);
    NormalEquations<dim> atBest(samples, nSamples, steepness, best);
    bool hasConverged = false;
    for (int iteration = 0; iteration < nIterations && !hasConverged; ++iteration)
    {
        double next[L::size];
        std::copy_n(best, L::size, next);
        const double change = atBest.step(damping, next);
        const NormalEquations<dim> atNext(samples, nSamples, steepness, next);
        const bool isBetter = atNext.cost <= atBest.cost;
        if (isBetter)
        {
            std::copy_n(next, L::size, best);
            atBest = atNext;
        }
        hasConverged = change < lastStep;
        damping *= isBetter ? 0.3 : 10;
        if (iteration + 1 == trialIterations && atBest.residual > hopeless*wanted)
        {
            break;
        }
    }
    Film<dim> film;
    film.middle = best[0];
    film.thickness = best[L::thickness];
    film.residual = hasConverged ? atBest.residual : 1e300;
    std::copy_n(&best[L::tilt], L::tangents, film.tilt);
    std::copy_n(&best[L::taper], L::tangents, film.taper);
    std::copy_n(&best[L::curvature], L::thickness - L::curvature, film.curvature);
    return film;
}

template<int dim>
void fillFilm(Film<dim>& film, const SurfaceSample& own, double steepness)
{
    const double scale = steepness/slopeLength<dim>(film.tilt);
    double middle = film.middle, wedge = 0;
    for (int d = 0; d < dim - 1; ++d)
    {
        middle += film.tilt[d]*own.along[d];
        wedge += film.taper[d]*own.along[d];
    }
    double thickness = film.thickness + wedge, thinner = 0, thicker = 1e30;
    for (int iteration = 0; iteration < 30; ++iteration)
    {
        const FilmMean mean = filmMean(own, own.across - middle, thickness, scale);
        const double defect = own.alpha - mean.value;
        if (std::abs(defect) < 1e-9)
        {
            break;
        }
        (defect < 0 ? thicker : thinner) = thickness;
        const double slope = scale*mean.byThickness;
        const double next = thickness + (slope > 1e-12 ? std::clamp(defect/slope, -2., 2.) : defect < 0 ? -2. : 2.);
        thickness = next > thinner && next < thicker ? next : 0.5*(thinner + std::min(thicker, thinner + 2));
    }
    film.thickness = thickness - wedge;
}

template struct Film<2>;
template struct Film<3>;
template Film<2> fitFilm<2>(const SurfaceSample*, int, double, double);
template Film<3> fitFilm<3>(const SurfaceSample*, int, double, double);
template void fillFilm<2>(Film<2>&, const SurfaceSample&, double);
template void fillFilm<3>(Film<3>&, const SurfaceSample&, double);

} // namespace flotsam
