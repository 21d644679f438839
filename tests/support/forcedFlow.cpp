// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/forcedFlow.hpp"

#include "equations/rigidCoupling.hpp"
#include "geometry/simplexDivision.hpp"
#include "support/flowCases.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

/// Fourth-order first and second derivative from values at -2..2 steps.
double firstDerivative(const double* v, double h) { return (v[0] - 8*v[1] + 8*v[3] - v[4])/(12*h); }
double secondDerivative(const double* v, double h) { return (-v[0] + 16*v[1] - 30*v[2] + 16*v[3] - v[4])/(12*h*h); }

constexpr double difference = 1e-3; // of lengths and times of order one

std::vector<BoundaryPatch> exactPatches(const SimplexMesh& mesh, const ExactFlow& exact)
{
    return allPatches(mesh, BoundaryPatch::Velocity::Fixed, [exact](const double* x, double t)
    {
        std::array<double, 3> u{};
        exact.velocity(x, t, u.data());
        return u;
    });
}

/// False for an element inside a solid. first: int N_a over the fluid part.
bool isFluid(const SimplexMesh& mesh, const Cover* cover, int e, double* first)
{
    const int n = mesh.dim + 1;
    if (cover && cover->state[e] == ElementState::Solid) return false;
    if (cover && cover->state[e] == ElementState::Cut)
    {
        const CutElement& cut = cover->cuts[cover->cutIndex[e]];
        std::copy(cut.first, cut.first + n, first);
    }
    else std::fill(first, first + n, mesh.volume[e]/n);
    return true;
}

} // namespace

void exactForce(const ExactFlow& exact, const FluidProperties& fluid, int dim, const double* x, double t, double* f)
{
    double u[3];
    exact.velocity(x, t, u);
    double rate[3][5], along[3][5], p[5];
    std::fill(f, f + dim, 0.0);
    for (int s = 0; s < 5; ++s)
    {
        double v[3];
        exact.velocity(x, t + (s - 2)*difference, v);
        for (int k = 0; k < dim; ++k) rate[k][s] = v[k];
    }
    for (int k = 0; k < dim; ++k) f[k] += fluid.rhoLiquid*firstDerivative(rate[k], difference);
    for (int d = 0; d < dim; ++d)
    {
        for (int s = 0; s < 5; ++s)
        {
            double y[3] = {0, 0, 0}, v[3];
            std::copy(x, x + dim, y);
            y[d] += (s - 2)*difference;
            exact.velocity(y, t, v);
            for (int k = 0; k < dim; ++k) along[k][s] = v[k];
            p[s] = exact.pressure(y, t);
        }
        for (int k = 0; k < dim; ++k)
            f[k] += fluid.rhoLiquid*u[d]*firstDerivative(along[k], difference) - fluid.muLiquid*secondDerivative(along[k], difference);
        f[d] += firstDerivative(p, difference);
    }
}

ForcedFlow::ForcedFlow(const SimplexMesh& mesh, const Halo& halo, const FluidProperties& fluid, const NumericsControls& controls,
    const ExactFlow& exact, double time)
:   mesh_(mesh), halo_(halo), graph_(mesh), fluid_(fluid), controls_(controls), exact_(exact), patches_(exactPatches(mesh, exact)),
    values_(patches_.size()), equation_(mesh, graph_, halo, fluid_, controls_, patches_), solver_(mesh, graph_, halo, controls_), basins_(mesh, halo),
    state_(restState(mesh)), force_(std::size_t(mesh.nElements)*mesh.dim, 0.0), x_(std::size_t(mesh.nNodes)*(mesh.dim + 1), 0.0)
{
    fluid_.isTwoPhase = false;
    state_.time = time;
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        exact_.velocity(&mesh.x[std::size_t(i)*mesh.dim], time, &state_.u[std::size_t(i)*mesh.dim]);
        state_.p[i] = exact_.pressure(&mesh.x[std::size_t(i)*mesh.dim], time);
    }
    state_.uOld = state_.u;
    basins_.find(nullptr);
}

void ForcedFlow::setGeometry(const Cover& cover, const std::vector<Solid>& solids)
{
    cover_ = &cover;
    solids_ = &solids;
    basins_.find(cover_);
}

/// The force at the centre of the fluid part: its mean up to second order.
void ForcedFlow::setForce(double t)
{
    const int dim = mesh_.dim, n = dim + 1;
    if (!exact_.isForced) return;
    for (int e = 0; e < mesh_.nElements; ++e)
    {
        double first[4], centre[3] = {0, 0, 0}, volume = 0;
        if (!isFluid(mesh_, cover_, e, first)) continue;
        for (int a = 0; a < n; ++a) volume += first[a];
        for (int a = 0; a < n; ++a)
            for (int d = 0; d < dim; ++d)
                centre[d] += first[a]/volume*mesh_.x[std::size_t(mesh_.elements[std::size_t(e)*n + a])*dim + d];
        exactForce(exact_, fluid_, dim, centre, t, &force_[std::size_t(e)*dim]);
    }
}

SolveReport ForcedFlow::step(double dt)
{
    const int dim = mesh_.dim, B = dim + 1, nDof = equation_.system().nDof;
    const double t = state_.time + dt;
    const BoundaryState boundary{t, state_.u.data(), state_.alpha.data()};
    for (std::size_t p = 0; p < patches_.size(); ++p) patches_[p].evaluate(boundary, values_[p]);
    setForce(t);
    FlowStepData data;
    data.time = TimeScheme::bdf(controls_.timeOrder, dt, state_.dt);
    data.state = &state_;
    data.cover = cover_;
    data.basins = &basins_;
    data.solids = solids_;
    data.patchValues = &values_;
    data.elementForce = &force_;
    equation_.assemble(data);
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        for (int d = 0; d < dim; ++d) x_[std::size_t(i)*B + d] = state_.u[std::size_t(i)*dim + d];
        x_[std::size_t(i)*B + dim] = state_.p[i];
    }
    equation_.applyConstraints(values_, x_);
    q_.assign(solids_ ? solids_->size()*nDof : 0, 0.0);
    for (std::size_t s = 0; solids_ && s < solids_->size(); ++s) solidVelocity(mesh_, (*solids_)[s], &q_[s*nDof]);
    equation_.setFreeBodies({}, dt);
    solver_.setSystem(equation_.system());
    const SolveReport report = solver_.solve(x_, q_);
    std::swap(state_.u, state_.uOld);
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        for (int d = 0; d < dim; ++d) state_.u[std::size_t(i)*dim + d] = x_[std::size_t(i)*B + d];
        state_.p[i] = x_[std::size_t(i)*B + dim];
    }
    state_.dt = dt;
    state_.time = t;
    return report;
}

int ForcedFlow::toSteadyState(double dt, double change, int maxSteps)
{
    for (int k = 1; k <= maxSteps; ++k)
    {
        step(dt);
        double largest = 0;
        for (std::size_t i = 0; i < state_.u.size(); ++i) largest = std::max(largest, std::abs(state_.u[i] - state_.uOld[i]));
        if (halo_.max(largest) < change*largestVelocity()) return k;
    }
    return maxSteps;
}

double ForcedFlow::largestVelocity() const
{
    double largest = 0;
    for (int i = 0; i < mesh_.nOwned; ++i)
        for (int d = 0; d < mesh_.dim && (!cover_ || cover_->isActiveNode[i]); ++d)
            largest = std::max(largest, std::abs(state_.u[std::size_t(i)*mesh_.dim + d]));
    return halo_.max(largest);
}

std::vector<double> ForcedFlow::load(int s) const
{
    std::vector<double> rows(q_.size());
    FlowOperator(graph_, halo_, equation_.system(), mesh_.nOwned).solidRows(x_.data(), q_.data(), rows.data());
    const int nDof = equation_.system().nDof;
    std::vector<double> result(rows.begin() + s*nDof, rows.begin() + (s + 1)*nDof);
    for (double& v : result) v = -v;
    return result;
}

namespace
{

struct QuadraturePoint
{
    double shape[4];    // of the element
    double weight;
};

/// Of degree 2 on a simplex of this volume in an element.
template<int D>
void addRule(const SimplexPoint<D>* corner, double volume, std::vector<QuadraturePoint>& points)
{
    constexpr double inner = D == 2 ? 1./6 : 0.1381966011250105, outer = 1 - D*inner;
    for (int k = 0; k <= D; ++k)
    {
        QuadraturePoint point{{}, volume/(D + 1)};
        for (int c = 0; c <= D; ++c)
            for (int a = 0; a <= D; ++a) point.shape[a] += (c == k ? outer : inner)*corner[c].n[a];
        points.push_back(point);
    }
}

/// On the fluid parts of a cut element; where it is not cut linearly (edges of boxes) the centre of the fluid. The centre alone would miss most of the gradient's
/// error, which nearly vanishes there: a share of the total that is the larger the coarser the mesh.
template<int D>
void addCutRule(const SimplexMesh& mesh, const Cover& cover, int e, std::vector<QuadraturePoint>& points)
{
    const CutElement& cut = cover.cuts[cover.cutIndex[e]];
    double distance[D + 1];
    for (int a = 0; a <= D; ++a) distance[a] = cover.distance[mesh.elements[std::size_t(e)*(D + 1) + a]];
    const auto [least, largest] = std::minmax_element(distance, distance + D + 1);
    if (*least < 0 && *largest > 0)
    {
        const SimplexDivision<D> division = divideSimplex<D>(distance);
        double volume = 0;
        for (int i = 0; i < division.nParts; ++i) volume += division.parts[i].share*mesh.volume[e];
        if (std::abs(volume - cut.volume) < 1e-9*mesh.volume[e])
        {
            for (int i = 0; i < division.nParts; ++i) addRule<D>(division.parts[i].corner, division.parts[i].share*mesh.volume[e], points);
            return;
        }
    }
    QuadraturePoint centre{{}, cut.volume};
    for (int a = 0; a <= D; ++a) centre.shape[a] = cut.first[a]/cut.volume;
    points.push_back(centre);
}

template<int D>
std::vector<QuadraturePoint> quadrature(const SimplexMesh& mesh, const Cover* cover, int e)
{
    std::vector<QuadraturePoint> points;
    if (cover && cover->state[e] == ElementState::Cut) addCutRule<D>(mesh, *cover, e, points);
    else if (!cover || cover->state[e] == ElementState::Fluid)
    {
        SimplexPoint<D> corner[D + 1] = {};
        for (int a = 0; a <= D; ++a) corner[a].n[a] = 1;
        addRule<D>(corner, mesh.volume[e], points);
    }
    return points;
}

/// Square of the error of the velocity's gradient (dim*dim: du_c/dx_d at c*dim + d).
double gradientError(const ExactFlow& exact, int dim, const double* x, double t, const double* gradient)
{
    constexpr double step = 1e-5;
    double sum = 0;
    for (int d = 0; d < dim; ++d)
    {
        double left[3], right[3], y[3];
        std::copy(x, x + 3, y);
        y[d] = x[d] - step;
        exact.velocity(y, t, left);
        y[d] = x[d] + step;
        exact.velocity(y, t, right);
        for (int c = 0; c < dim; ++c) sum += std::pow(gradient[c*dim + d] - (right[c] - left[c])/(2*step), 2);
    }
    return sum;
}

double largestNodalError(const SimplexMesh& mesh, const Halo& halo, const Cover* cover, const FlowState& state, const ExactFlow& exactFlow)
{
    double largest = 0;
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        if (cover && !cover->isActiveNode[i]) continue;
        double exact[3];
        exactFlow.velocity(&mesh.x[std::size_t(i)*mesh.dim], state.time, exact);
        for (int d = 0; d < mesh.dim; ++d) largest = std::max(largest, std::abs(state.u[std::size_t(i)*mesh.dim + d] - exact[d]));
    }
    return halo.max(largest);
}

} // namespace

FlowErrors flowErrors(const SimplexMesh& mesh, const Halo& halo, const Cover* cover, const FlowState& state, const ExactFlow& exactFlow)
{
    const int dim = mesh.dim, n = dim + 1;
    double sums[5] = {0, 0, 0, 0, 0}; // velocity, gradient, pressure^2, pressure, volume
    for (int e = 0; e < mesh.nElements; ++e)
    {
        if (!mesh.isOwnedElement[e]) continue;
        const int* nodes = &mesh.elements[std::size_t(e)*n];
        double gradient[9] = {};
        for (int a = 0; a < n; ++a)
            for (int c = 0; c < dim; ++c)
                for (int d = 0; d < dim; ++d) gradient[c*dim + d] += mesh.gradN[(std::size_t(e)*n + a)*dim + d]*state.u[std::size_t(nodes[a])*dim + c];
        for (const QuadraturePoint& point : dim == 2 ? quadrature<2>(mesh, cover, e) : quadrature<3>(mesh, cover, e))
        {
            double x[3] = {0, 0, 0}, u[3] = {0, 0, 0}, p = 0, exact[3];
            for (int a = 0; a < n; ++a)
            {
                p += point.shape[a]*state.p[nodes[a]];
                for (int d = 0; d < dim; ++d)
                {
                    x[d] += point.shape[a]*mesh.x[std::size_t(nodes[a])*dim + d];
                    u[d] += point.shape[a]*state.u[std::size_t(nodes[a])*dim + d];
                }
            }
            exactFlow.velocity(x, state.time, exact);
            const double dp = p - exactFlow.pressure(x, state.time);
            for (int d = 0; d < dim; ++d) sums[0] += point.weight*std::pow(u[d] - exact[d], 2);
            sums[1] += point.weight*gradientError(exactFlow, dim, x, state.time, gradient);
            sums[2] += point.weight*dp*dp;
            sums[3] += point.weight*dp;
            sums[4] += point.weight;
        }
    }
    halo.sum(sums, 5);
    FlowErrors result;
    result.velocity = std::sqrt(sums[0]);
    result.gradient = std::sqrt(sums[1]);
    result.pressure = std::sqrt(std::max(0.0, sums[2] - sums[3]*sums[3]/sums[4]));
    result.largest = largestNodalError(mesh, halo, cover, state, exactFlow);
    return result;
}

} // namespace flotsam
