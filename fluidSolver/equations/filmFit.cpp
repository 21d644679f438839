// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/filmFit.hpp"

#include "core/elementaryFunctions.hpp"

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
/// Root of what the fitted cell counts against a neighbour.
constexpr double rootOwnWeight = 2;
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

/// Mean of a film over a cell, as the growth exp((mean + 1) thickness), and its derivatives by middle and thickness (in units of 1/steepness).
template<class Value>
struct FilmMean { Value growth, byMiddle, byThickness; };

/// thickness, growth: of the cell (SurfaceSample); upper, lower: exp(psi) of the film's two fronts at the cell's middle.
template<class Value>
[[gnu::always_inline]] inline FilmMean<Value> filmMean(const Value& thickness, const Value& growth, const Value& inverseGrowth, const Value& upper, const Value& lower)
{
    const Value u1 = 1 + upper*growth, u2 = 1 + upper*inverseGrowth, l1 = 1 + lower*growth, l2 = 1 + lower*inverseGrowth;
    const Value slopeUp = (u1 - u2)/(u1*u2*thickness), slopeLow = (l1 - l2)/(l1*l2*thickness);
    return {u1/u2*(l1/l2), slopeUp - slopeLow, 0.5*(slopeUp + slopeLow)};
}

/// Of exp(psi): with it the products above stay finite.
constexpr double largestExponent = 150;

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

/// The cells in groups of nLanes; what the last one has too many counts nothing.
template<int dim>
class Cells
{
public:
    using L = Layout<dim>;

    Cells(const SurfaceSample* samples, int nSamples)
    :   size_((nSamples + nLanes - 1)/nLanes)
    {
        for (int k = 0; k < size_*nLanes; ++k)
        {
            const SurfaceSample& s = samples[std::min(k, nSamples - 1)];
            Group& group = groups_[k/nLanes];
            const int lane = k % nLanes;
            group.across[lane] = s.across;
            for (int d = 0; d < L::tangents; ++d)
            {
                group.along[d][lane] = s.along[d];
            }
            group.thickness[lane] = s.thickness;
            group.growth[lane] = s.growth;
            group.alpha[lane] = s.alpha;
            group.rootWeight[lane] = k == 0 ? rootOwnWeight : k < nSamples ? 1 : 0;
        }
        for (int g = 0; g < size_; ++g)
        {
            groups_[g].inverseGrowth = 1/groups_[g].growth;
        }
    }

    int size() const { return size_; }

    /// Roots of the weights times what the groups' means miss, and times the derivatives of these by the unknowns.
    void evaluate(double scale, const double* unknown, Lanes* defect, Lanes (*derivatives)[maxGroups]) const
    {
        Lanes fronts[2*maxGroups], *upper = fronts, *lower = fronts + size_;
        for (int g = 0; g < size_; ++g)
        {
            Lanes shape[L::size], fromMiddle = groups_[g].across, thickness = Lanes::Zero();
            setShape(g, shape);
            for (int i = 0; i < L::thickness; ++i)
            {
                fromMiddle -= shape[i]*unknown[i];
            }
            for (int i = L::thickness; i < L::size; ++i)
            {
                thickness += shape[i]*unknown[i];
            }
            upper[g] = (scale*(0.5*thickness - fromMiddle)).max(-largestExponent).min(largestExponent);
            lower[g] = (scale*(0.5*thickness + fromMiddle)).max(-largestExponent).min(largestExponent);
        }
        exponentials(fronts[0].data(), 2*size_*nLanes);
        for (int g = 0; g < size_; ++g)
        {
            const Group& cell = groups_[g];
            const FilmMean<Lanes> mean = filmMean<Lanes>(cell.thickness, cell.growth, cell.inverseGrowth, upper[g], lower[g]);
            const Lanes factor = scale*cell.rootWeight, byMiddle = factor*mean.byMiddle, byThickness = factor*mean.byThickness;
            Lanes shape[L::size];
            setShape(g, shape);
            for (int i = 0; i < L::size; ++i)
            {
                derivatives[i][g] = shape[i]*(i < L::thickness ? byMiddle : byThickness);
            }
            defect[g] = mean.growth;
        }
        logarithms(defect[0].data(), size_*nLanes);
        for (int g = 0; g < size_; ++g)
        {
            const Group& cell = groups_[g];
            defect[g] = cell.rootWeight*(cell.alpha + 1 - defect[g]/cell.thickness);
        }
    }

private:
    struct Group { Lanes across, along[L::tangents], thickness, growth, inverseGrowth, alpha, rootWeight; };

    /// Derivatives of middle and thickness by their unknowns.
    [[gnu::always_inline]] void setShape(int g, Lanes* shape) const
    {
        const Lanes* along = groups_[g].along;
        shape[0] = shape[L::thickness] = Lanes::Ones();
        int k = L::curvature;
        for (int d = 0; d < L::tangents; ++d)
        {
            shape[L::tilt + d] = shape[L::taper + d] = along[d];
            for (int c = d; c < L::tangents; ++c)
            {
                shape[k++] = along[d]*along[c]*(c == d ? 0.5 : 1);
            }
        }
    }

    int size_;
    Group groups_[maxGroups];
};

/// Curvature and taper are kept small.
template<int dim>
bool hasRidge(int i)
{
    using L = Layout<dim>;
    return i >= L::taper || (i >= L::curvature && i < L::thickness);
}

/// What the film of given unknowns misses.
template<int dim>
struct Misfit
{
    using L = Layout<dim>;
    double unknown[L::size];
    Lanes derivatives[L::size][maxGroups], defect[maxGroups];
    double cost;        // what is minimised
    double residual;    // sum of squared differences of the other cells

    void evaluate(const Cells<dim>& cells, double steepness)
    {
        cells.evaluate(steepness/slopeLength<dim>(&unknown[L::tilt]), unknown, defect, derivatives);
        const double own = defect[0][0];
        defect[0][0] = 0;
        residual = sumOfProducts(defect, defect, cells.size());
        defect[0][0] = own;
        cost = residual + own*own;
        for (int i = 0; i < L::size; ++i)
        {
            if (hasRidge<dim>(i)) cost += surfaceRidge*unknown[i]*unknown[i];
        }
    }
};

template<int dim>
struct NormalEquations
{
    using L = Layout<dim>;
    double matrix[L::size][L::size], right[L::size];

    void set(const Misfit<dim>& at, int nGroups)
    {
        for (int i = 0; i < L::size; ++i)
        {
            right[i] = sumOfProducts(at.derivatives[i], at.defect, nGroups);
            for (int j = i; j < L::size; ++j)
            {
                matrix[i][j] = sumOfProducts(at.derivatives[i], at.derivatives[j], nGroups);
            }
        }
        for (int i = 0; i < L::size; ++i)
        {
            if (!hasRidge<dim>(i)) continue;
            matrix[i][i] += surfaceRidge;
            right[i] -= surfaceRidge*at.unknown[i];
        }
    }

    /// Levenberg-Marquardt's step. Returns the largest change.
    double step(double damping, double* unknown) const
    {
        double m[L::size][L::size], change[L::size];
        std::copy_n(right, L::size, change);
        double largest = 0;
        for (int i = 0; i < L::size; ++i)
        {
            std::copy(matrix[i] + i, matrix[i] + L::size, m[i] + i);
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
    Misfit<dim> films[2], *best = &films[0], *next = &films[1];
    const Cells<dim> cells(samples, nSamples);
    startFilm<dim>(samples, nSamples, best->unknown);
    best->evaluate(cells, steepness);
    NormalEquations<dim> equations;
    equations.set(*best, cells.size());
    double damping = firstDamping;
    bool hasConverged = false;
    for (int iteration = 1; iteration <= nIterations; ++iteration)
    {
        std::copy_n(best->unknown, L::size, next->unknown);
        hasConverged = equations.step(damping, next->unknown) < lastStep;
        next->evaluate(cells, steepness);
        const bool isBetter = next->cost <= best->cost;
        if (isBetter) std::swap(best, next);
        if (hasConverged || (iteration == trialIterations && best->residual > hopeless*wanted)) break;
        if (isBetter) equations.set(*best, cells.size());
        damping *= isBetter ? 0.3 : 10;
    }
    Film<dim> film;
    film.middle = best->unknown[0];
    film.thickness = best->unknown[L::thickness];
    film.residual = hasConverged ? best->residual : 1e300;
    std::copy_n(&best->unknown[L::tilt], L::tangents, film.tilt);
    std::copy_n(&best->unknown[L::taper], L::tangents, film.taper);
    std::copy_n(&best->unknown[L::curvature], L::thickness - L::curvature, film.curvature);
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
        const auto front = [scale](double distance) { return std::exp(std::clamp(scale*distance, -largestExponent, largestExponent)); };
        const double fromMiddle = own.across - middle;
        const FilmMean<double> mean = filmMean<double>(own.thickness, own.growth, 1/own.growth, front(0.5*thickness - fromMiddle), front(0.5*thickness + fromMiddle));
        const double defect = own.alpha + 1 - std::log(mean.growth)/own.thickness;
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
