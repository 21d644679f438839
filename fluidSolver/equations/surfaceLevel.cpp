// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/surfaceLevel.hpp"

#include "core/roomyVector.hpp"
#include "equations/facingElements.hpp"
#include "equations/profileMeans.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

constexpr int mostRepeats = 12, patience = 3;
constexpr double tall = 2;              // a dual cell's thickness along gravity, over the side of the cube of its volume
constexpr double stubborn = 0.7;        // change over the last one from which a node does not converge (sheets, corners): it is not waited for

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

/// What the repeats need; kept from step to step.
struct SurfaceLevel::Repeats
{
    virtual ~Repeats() = default;
    virtual void run(const Arguments& in, std::vector<double>& work, std::vector<double>& level) = 0;
};

template<int D>
class SurfaceLevel::RepeatsIn : public SurfaceLevel::Repeats
{
public:
    RepeatsIn(const SimplexMesh& mesh, const Halo& halo, const std::array<double, 3>& gravity);
    void run(const Arguments& in, std::vector<double>& work, std::vector<double>& level) override;

private:
    void begin(const Arguments& in, std::vector<double>& work, const std::vector<double>& level);
    void findTall(const DualCells& cells);
    void levelTall(const Arguments& in, std::vector<double>& level);
    void findWanted();
    void findSlabs(const Arguments& in);
    double takeSlabs(const Arguments& in, int repeat, std::vector<double>& level);
    double change(const Arguments& in, int place, const std::vector<double>& level) const;

    const SimplexMesh& mesh_;
    const Halo& halo_;
    double down_[D] = {};                       // zero: no gravity
    std::vector<char> isTall_;                  // per owned node, where any is
    bool areTallKnown_ = false, isAnyTall_ = false; // on any rank: this one may own no node
    FacingElements<D> facing_;
    std::vector<double> atNode_, lastChange_;   // of the band: as if alpha were the value at the node; change of the last repeat
    std::vector<double> before_;                // of the facing nodes: their level before the repeat
    std::vector<int> wanted_, moved_;           // in the band; places
    std::vector<double> share_, mean_, found_;  // of the wanted ones
};

template<int D>
SurfaceLevel::RepeatsIn<D>::RepeatsIn(const SimplexMesh& mesh, const Halo& halo, const std::array<double, 3>& gravity)
:   mesh_(mesh), halo_(halo), facing_(mesh, halo)
{
    const double size = std::hypot(gravity[0], gravity[1], gravity[2]);
    for (int d = 0; d < D && size > 0; ++d) down_[d] = gravity[mesh.axes[d]]/size;
}

template<int D>
void SurfaceLevel::RepeatsIn<D>::begin(const Arguments& in, std::vector<double>& work, const std::vector<double>& level)
{
    facing_.find(in.alpha, in.cover, work);
    const std::size_t nBand = facing_.band().size(), nNodes = facing_.nodes().size();
    for (std::vector<double>* v : {&atNode_, &lastChange_, &share_, &mean_, &found_}) reserveRoom(*v, nBand);
    reserveRoom(before_, nNodes);
    reserveRoom(wanted_, nBand);
    reserveRoom(moved_, nNodes);
    atNode_.resize(nBand);
    for (std::size_t k = 0; k < nBand; ++k) atNode_[k] = level[facing_.band()[k]];
    lastChange_.assign(nBand, 0.0);
    before_.resize(nNodes);
}

template<int D>
void SurfaceLevel::RepeatsIn<D>::findTall(const DualCells& cells)
{
    areTallKnown_ = true;
    isTall_.resize(mesh_.nOwned);
    for (int i = 0; i < mesh_.nOwned; ++i) isTall_[i] = 2*cells.halfWidth(i, down_) > tall*std::pow(cells.volume(i), 1./D);
    isAnyTall_ = halo_.any(std::find(isTall_.begin(), isTall_.end(), 1) != isTall_.end());
    if (!isAnyTall_) std::vector<char>().swap(isTall_);
}

/// Begins with a level surface in tall cells. There the values at the nodes say nothing about its direction: where diagonals alternate, cells of neighbouring columns
/// differ by a part of their height, which beside their width is a steep slope, or directions that cancel, for which a sheet would be taken. Of a front that
/// stands upright the levels of neighbouring columns then differ by many widths, and the first repeat has its direction.
template<int D>
void SurfaceLevel::RepeatsIn<D>::levelTall(const Arguments& in, std::vector<double>& level)
{
    if (!areTallKnown_) findTall(in.cells);
    if (!isAnyTall_) return;
    facing_.sumGradients(level);
    for (int i : facing_.band())
    {
        if (!isTall_[i]) continue;
        const double* sum = facing_.sum(facing_.place(i));
        double along = 0, normal[D], mean = in.alpha[i];
        for (int d = 0; d < D; ++d) along += sum[d]*down_[d];
        for (int d = 0; d < D; ++d) normal[d] = std::copysign(1, along)*down_[d];
        double found = thicknessInWidths(in.cells, i, normal, in.width[i]);
        frontsFromMeans(&mean, &found, 1);
        level[i] = in.width[i]*found - centroidHeight(in.cells, i, normal, D);
    }
    halo_.update(level, 1);
}

template<int D>
void SurfaceLevel::RepeatsIn<D>::findWanted()
{
    wanted_.clear();
    for (std::size_t k = 0; k < facing_.band().size(); ++k)
    {
        const int l = facing_.place(facing_.band()[k]);
        const double* sum = facing_.sum(l);
        double square = 0;
        for (int d = 0; d < D; ++d) square += sum[d]*sum[d];
        if (facing_.isWanted(l) && std::sqrt(square) > 1e-12*sum[D]) wanted_.push_back(int(k));
    }
}

/// The level of the wanted nodes from the sums around them, which become unit vectors.
template<int D>
void SurfaceLevel::RepeatsIn<D>::findSlabs(const Arguments& in)
{
    for (std::vector<double>* v : {&share_, &mean_, &found_}) v->resize(wanted_.size());
    for (std::size_t m = 0; m < wanted_.size(); ++m)
    {
        const int i = facing_.band()[wanted_[m]];
        double *sum = facing_.sum(facing_.place(i)), length = 0;
        for (int d = 0; d < D; ++d) length += sum[d]*sum[d];
        length = std::sqrt(length);
        for (int d = 0; d < D; ++d) sum[d] /= length;
        // where the neighbours do not agree on a direction (sheets, corners) there is no slab of the cell to take the mean over
        share_[m] = std::clamp((length/sum[D] - 0.5)/0.45, 0., 1.);
        mean_[m] = in.alpha[i];
        found_[m] = thicknessInWidths(in.cells, i, sum, in.width[i]);
    }
    frontsFromMeans(mean_.data(), found_.data(), int(wanted_.size()));
    for (std::size_t m = 0; m < wanted_.size(); ++m)
    {
        const int k = wanted_[m], i = facing_.band()[k];
        const double slab = in.width[i]*found_[m] - centroidHeight(in.cells, i, facing_.sum(facing_.place(i)), D);
        found_[m] = share_[m]*slab + (1 - share_[m])*atNode_[k];
    }
}

/// Of a facing node's level in this repeat, as much as it is of alpha, four times: far from the surface the level is of little use.
template<int D>
double SurfaceLevel::RepeatsIn<D>::change(const Arguments& in, int place, const std::vector<double>& level) const
{
    const int i = facing_.nodes()[place];
    return 4*in.alpha[i]*(1 - in.alpha[i])*std::abs(level[i] - before_[place])/in.width[i];
}

/// Returns the largest change of this rank's nodes, those apart that do not converge.
template<int D>
double SurfaceLevel::RepeatsIn<D>::takeSlabs(const Arguments& in, int repeat, std::vector<double>& level)
{
    for (std::size_t l = 0; l < before_.size(); ++l) before_[l] = level[facing_.nodes()[l]];
    double largest = 0;
    for (std::size_t m = 0; m < wanted_.size(); ++m)
    {
        const int k = wanted_[m], i = facing_.band()[k];
        level[i] = found_[m];
        const double own = change(in, facing_.place(i), level);
        if (repeat < patience || own < stubborn*lastChange_[k]) largest = std::max(largest, own);
        lastChange_[k] = own;
    }
    return largest;
}

/// Each time for the nodes beside those that have moved by more than the tolerance.
template<int D>
void SurfaceLevel::RepeatsIn<D>::run(const Arguments& in, std::vector<double>& work, std::vector<double>& level)
{
    begin(in, work, level);
    levelTall(in, level);
    for (int repeat = 0; repeat < mostRepeats; ++repeat)
    {
        facing_.sumGradients(level);
        findWanted();
        findSlabs(in);
        const double largest = takeSlabs(in, repeat, level);
        halo_.update(level, 1);
        if (halo_.max(largest) < in.tolerance) break;
        moved_.clear();
        for (std::size_t l = 0; l < before_.size(); ++l)
            if (change(in, int(l), level) >= in.tolerance) moved_.push_back(int(l));
        facing_.wantNeighbours(moved_);
    }
}

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

SurfaceLevel::SurfaceLevel(const SimplexMesh& mesh, const Halo& halo, const std::array<double, 3>& gravity) : mesh_(mesh)
{
    if (mesh.dim == 2) repeats_ = std::make_unique<RepeatsIn<2>>(mesh, halo, gravity);
    else repeats_ = std::make_unique<RepeatsIn<3>>(mesh, halo, gravity);
}

SurfaceLevel::~SurfaceLevel() = default;

void SurfaceLevel::find(const std::vector<double>& alpha, const std::vector<double>& width, const DualCells* cells, const Cover* cover, double tolerance,
    std::vector<double>& work, std::vector<double>& level)
{
    const double clip = std::log(highestOfBand/lowestOfBand);
    level.resize(mesh_.nNodes);
    for (int i = 0; i < mesh_.nNodes; ++i)
        level[i] = width[i]*(alpha[i] <= lowestOfBand ? -clip : alpha[i] >= highestOfBand ? clip : std::log(alpha[i]/(1 - alpha[i])));
    if (cells) repeats_->run({alpha, width, *cells, cover, tolerance}, work, level);
}

} // namespace flotsam
