// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/profileLevel.H"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

constexpr double sharpLevel = 0.5;      // of full and empty cells
constexpr double tornShare = 0.02;      // of the variance of a node's cells which what they say of the node may have; none in a linear field, 0.05 to 0.25 at a jump
constexpr double tornRatio = 1.5;       // of that variance over the mean of those of the cells' other nodes
constexpr double roundOff = 1e-8;       // of a variance

class ProfileLevel
{
public:
    ProfileLevel(const MeshAdapter& adapter, const Halo& halo, const SurfaceCells& cells, const std::vector<double>& fraction)
    :   mesh_(adapter.mesh), halo_(halo), cells_(cells), touches_(cells.touchingCells(fraction)), isTorn_(mesh_.nNodes, 0)
    {
        const double unit = std::atanh(1 - 2*SurfaceCells::sharp)/sharpLevel;
        for (const SurfaceCell& p : cells.profile())
        {
            value_.push_back(std::atanh(2*p.fraction - 1)/unit);
            centre_.push_back(cells.centre(p));
        }
        findSides(adapter, fraction);
    }

    std::vector<char> run(std::vector<double>& level)
    {
        carry();
        if (findTears()) carry();
        std::vector<char> isOnSide(level.size());
        for (std::size_t i = 0; i < level.size(); ++i)
        {
            const bool touchesFull = touches_[SurfaceCells::nKinds*i + SurfaceCells::Full] > 0, touchesEmpty = touches_[SurfaceCells::nKinds*i + SurfaceCells::Empty] > 0;
            isOnSide[i] = isTorn_[i] || (touchesFull && touchesEmpty) || (isKnown(i) && ((touchesEmpty && mean(i, Carried) > 0) || (touchesFull && mean(i, Carried) < 0)));
            if (isKnown(i)) level[i] = isOnSide[i] ? side_[i] : std::clamp(mean(i, Carried), -0.5, 0.5);
        }
        return withNeighbours(isOnSide);
    }

private:
    enum { Carried, CarriedSquare, Value, ValueSquare, nMeans };

    double mean(std::size_t i, int what) const { return means_[(nMeans + 1)*i + what]; }
    bool isKnown(std::size_t i) const { return mean(i, nMeans) > 0; }
    double variance(std::size_t i, int what) const { return mean(i, what + 1) - mean(i, what)*mean(i, what); }

    /// And the nodes of the elements around; empty if there is none.
    std::vector<char> withNeighbours(const std::vector<char>& isOnSide) const
    {
        const int n = mesh_.dim + 1;
        std::vector<double> result(mesh_.nNodes, 0.0);
        bool isAny = false;
        for (int e = 0; e < mesh_.nElements; ++e)
        {
            const int* nodes = &mesh_.elements[std::size_t(e)*n];
            if (!mesh_.isOwnedElement[e] || std::none_of(nodes, nodes + n, [&](int i) { return isOnSide[i] != 0; })) continue;
            for (int a = 0; a < n; ++a) result[nodes[a]] = 1;
            isAny = true;
        }
        if (!halo_.any(isAny)) return {};
        halo_.sumToOwners(result, 1);
        halo_.update(result, 1);
        std::vector<char> isNear(mesh_.nNodes);
        std::transform(result.begin(), result.end(), isNear.begin(), [](double count) { return char(count > 0); });
        return isNear;
    }

    /// Level of the nodes if every cell is full or empty, whichever it is more of.
    void findSides(const MeshAdapter& adapter, const std::vector<double>& fraction)
    {
        std::vector<double> has(2*std::size_t(mesh_.nNodes), 0.0);  // cells less, more than half full
        std::vector<int> nodes;
        for (std::size_t c = 0; c < fraction.size(); ++c)
        {
            collectCell(adapter, int(c), nodes);
            for (int i : nodes) has[2*std::size_t(i) + (fraction[c] > 0.5)] = 1;
        }
        halo_.sumToOwners(has, 2);
        halo_.update(has, 2);
        side_.resize(mesh_.nNodes);
        for (std::size_t i = 0; i < side_.size(); ++i) side_[i] = sharpLevel*((has[2*i + 1] > 0) - (has[2*i] > 0));
    }

    /// Values of the cells carried to their nodes by the gradients, and what is needed of their variances.
    void carry()
    {
        const std::vector<Vec3> slope = gradients();
        means_ = cells_.toNodes(cells_.profile(), nMeans, [&](std::size_t k, int i, double* result)
        {
            const double carried = value_[k] + slope[k].dot(cells_.point(i) - centre_[k]);
            result[Carried] = carried;
            result[CarriedSquare] = carried*carried;
            result[Value] = value_[k];
            result[ValueSquare] = value_[k]*value_[k];
        });
    }

    /// A node whose cells differ much more than those of the nodes around do, and disagree about the node itself. Gradients are found without these. True if there are any.
    bool findTears()
    {
        const std::vector<double> around = cells_.toNodes(cells_.profile(), 1, [&](std::size_t k, int i, double* result)
        {
            const std::vector<int>& nodes = cells_.profile()[k].nodes;
            double sum = 0;
            for (int j : nodes) sum += j == i ? 0 : variance(j, Value);
            *result = sum/double(nodes.size() - 1);
        });
        bool isAny = false;
        for (std::size_t i = 0; i < isTorn_.size(); ++i)
        {
            if (!isKnown(i)) continue;
            isTorn_[i] = variance(i, Carried) > tornShare*variance(i, Value) + roundOff && variance(i, Value) > tornRatio*around[2*i];
            isAny |= isTorn_[i] != 0;
        }
        return halo_.any(isAny);
    }

    /// By least squares of the values of the cells around each cell's nodes, torn ones left out: exact of linear values.
    std::vector<Vec3> gradients() const
    {
        // moments about the node: value, and by direction r, r value, r r
        const std::vector<double> moments = cells_.toNodes(cells_.profile(), SurfaceCells::mostComponents, [&](std::size_t k, int i, double* m)
        {
            const Vec3 r = centre_[k] - cells_.point(i);
            *m++ = value_[k];
            for (int a = 0; a < 3; ++a)
            {
                *m++ = r[a];
                *m++ = r[a]*value_[k];
                for (int b = a; b < 3; ++b) *m++ = r[a]*r[b];
            }
        });
        std::vector<Vec3> result;
        for (std::size_t k = 0; k < cells_.profile().size(); ++k) result.push_back(gradient(int(k), moments));
        return result;
    }

    Vec3 gradient(int k, const std::vector<double>& moments) const
    {
        double weight = 0, mean = 0;
        Vec3 first = Vec3::Zero(), mixed = Vec3::Zero();
        Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
        for (int i : cells_.profile()[k].nodes)
        {
            if (isTorn_[i]) continue;
            const double* m = &moments[(SurfaceCells::mostComponents + 1)*std::size_t(i)];
            const double w = m[SurfaceCells::mostComponents];
            const Vec3 shift = cells_.point(i) - centre_[k];
            const double nodeMean = *m++;
            Vec3 r, rValue;
            Eigen::Matrix3d rr;
            for (int a = 0; a < 3; ++a)
            {
                r[a] = *m++;
                rValue[a] = *m++;
                for (int b = a; b < 3; ++b) rr(a, b) = rr(b, a) = *m++;
            }
            weight += w;
            mean += w*nodeMean;
            first += w*(r + shift);
            mixed += w*(rValue + nodeMean*shift);
            second += w*(rr + r*shift.transpose() + shift*r.transpose() + shift*shift.transpose());
        }
        if (weight <= 0) return Vec3::Zero();
        mean /= weight;
        first /= weight;
        const Eigen::Matrix3d spread = second/weight - first*first.transpose();
        // of least length where the cells lie in a plane or in a row
        Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix3d> solve;
        solve.setThreshold(1e-6);
        solve.compute(spread);
        return solve.solve(mixed/weight - mean*first);
    }

    const SimplexMesh& mesh_;
    const Halo& halo_;
    const SurfaceCells& cells_;
    std::vector<double> touches_, value_, side_, means_;
    std::vector<Vec3> centre_;
    std::vector<char> isTorn_;
};

} // namespace

std::vector<char> followProfiles(const MeshAdapter& adapter, const Halo& halo, const SurfaceCells& cells, const std::vector<double>& fraction, std::vector<double>& level)
{
    if (!halo.any(!cells.profile().empty())) return {};
    return ProfileLevel(adapter, halo, cells, fraction).run(level);
}

} // namespace flotsam
