// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/surfaceLevel.hpp"

#include "equations/profileReconstruction.hpp"
#include "geometry/cover.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

/// As far out as the transport keeps the profile: nodes of cut elements lie up to 1.1 h from the surface on slanted triangles, 1.7 h in
/// tetrahedra, and a level cut off there tilts the element's plane.
constexpr double lowest = 1e-4, highest = 1 - lowest;

constexpr int mostRepeats = 12;
constexpr double lastChoice = 1e-12;    // weight of elements whose level is known at some nodes only: no others, or they do not count

bool isInBand(double alpha) { return alpha > lowest && alpha < highest; }

/// An element with a say in the surface's direction at its nodes.
struct Facing { int element; double weight; };

std::vector<Facing> facingElements(const SimplexMesh& mesh, const std::vector<double>& alpha, const Cover* cover)
{
    const int n = mesh.dim + 1;
    std::vector<Facing> result;
    for (int e = 0; e < mesh.nElements; ++e)
    {
        const int* nodes = &mesh.elements[std::size_t(e)*n];
        if (cover && cover->state[e] == ElementState::Solid) continue;
        if (std::none_of(nodes, nodes + n, [&](int i) { return isInBand(alpha[i]); })) continue;
        bool isKnown = true;
        double variation = 0;
        for (int a = 0; a < n; ++a)
        {
            const int i = nodes[a];
            isKnown = isKnown && isInBand(alpha[i]) && (!cover || cover->isActiveNode[i]);
            variation += alpha[i]*(1 - alpha[i]);
        }
        result.push_back({e, variation*variation*mesh.volume[e]*(isKnown ? 1 : lastChoice)});
    }
    return result;
}

/// Sums around the nodes of the band: weighted gradients of the level, dim, and their lengths.
void sumGradients(const SimplexMesh& mesh, const std::vector<Facing>& elements, const std::vector<double>& level, std::vector<double>& sums)
{
    const int dim = mesh.dim, n = dim + 1;
    for (const Facing& f : elements)
        for (int a = 0; a < n; ++a) std::fill_n(&sums[std::size_t(mesh.elements[std::size_t(f.element)*n + a])*n], n, 0.0);
    for (const Facing& f : elements)
    {
        const int* nodes = &mesh.elements[std::size_t(f.element)*n];
        double gradient[3] = {}, length = 0;
        for (int a = 0; a < n; ++a)
            for (int d = 0; d < dim; ++d) gradient[d] += level[nodes[a]]*mesh.gradN[(std::size_t(f.element)*n + a)*dim + d];
        for (int d = 0; d < dim; ++d) length += gradient[d]*gradient[d];
        for (int a = 0; a < n; ++a)
        {
            double* sum = &sums[std::size_t(nodes[a])*n];
            for (int d = 0; d < dim; ++d) sum[d] += f.weight*gradient[d];
            sum[dim] += f.weight*std::sqrt(length);
        }
    }
}

double thicknessInWidths(const DualCells& cells, int i, const double* normal, double width)
{
    return 2*cells.halfWidth(i, normal)/width;
}

double centroidHeight(const DualCells& cells, int i, const double* normal, int dim)
{
    double result = 0;
    for (int d = 0; d < dim; ++d) result += normal[d]*cells.centroid(i)[d];
    return result;
}

} // namespace

double ProfileSlab::mean() const { return sweptMean(middle + 0.5*thickness, thickness); }

double ProfileSlab::slope() const
{
    const auto profile = [](double psi) { return 0.5 + 0.5*std::tanh(0.5*psi); };
    if (thickness > 1e-3) return (profile(middle + 0.5*thickness) - profile(middle - 0.5*thickness))/thickness;
    return profile(middle)*profile(-middle);
}

ProfileSlab profileSlab(const DualCells* cells, int i, const double* normal, double distance, double width)
{
    if (!cells) return {distance/width, 0};
    return {(distance + centroidHeight(*cells, i, normal, cells->dim()))/width, thicknessInWidths(*cells, i, normal, width)};
}

std::vector<double> surfaceLevel(const SimplexMesh& mesh, const Halo& halo, const std::vector<double>& alpha,
    const std::vector<double>& width, const DualCells* cells, const Cover* cover, double tolerance)
{
    const int dim = mesh.dim, n = dim + 1;
    const double clip = std::log(highest/lowest);
    std::vector<double> level(mesh.nNodes);
    for (int i = 0; i < mesh.nNodes; ++i)
        level[i] = width[i]*(alpha[i] <= lowest ? -clip : alpha[i] >= highest ? clip : std::log(alpha[i]/(1 - alpha[i])));
    if (!cells) return level;

    const std::vector<Facing> elements = facingElements(mesh, alpha, cover);
    std::vector<int> band;
    std::vector<char> isTaken(mesh.nOwned, 0);
    for (const Facing& f : elements)
        for (int a = 0; a < n; ++a)
        {
            const int i = mesh.elements[std::size_t(f.element)*n + a];
            if (i >= mesh.nOwned || isTaken[i] || !isInBand(alpha[i])) continue;
            isTaken[i] = 1;
            band.push_back(i);
        }
    const std::vector<double> atNode = level;
    std::vector<double> sums(std::size_t(mesh.nNodes)*n);
    for (int repeat = 0; repeat < mostRepeats; ++repeat)
    {
        sumGradients(mesh, elements, level, sums);
        double change = 0;
        for (int i : band)
        {
            double* sum = &sums[std::size_t(i)*n], length = 0;
            for (int d = 0; d < dim; ++d) length += sum[d]*sum[d];
            length = std::sqrt(length);
            if (!(length > 1e-12*sum[dim])) continue;
            for (int d = 0; d < dim; ++d) sum[d] /= length;
            // where the neighbours do not agree on a direction (sheets, corners) there is no slab of the cell to take the mean over
            const double share = std::clamp((length/sum[dim] - 0.5)/0.45, 0., 1.);
            const double slab = width[i]*std::log(frontFromMean(alpha[i], thicknessInWidths(*cells, i, sum, width[i])))
                - centroidHeight(*cells, i, sum, dim);
            const double found = share*slab + (1 - share)*atNode[i];
            change = std::max(change, std::abs(found - level[i])/width[i]);
            level[i] = found;
        }
        halo.update(level, 1);
        if (halo.max(change) < tolerance) break;
    }
    return level;
}

} // namespace flotsam
