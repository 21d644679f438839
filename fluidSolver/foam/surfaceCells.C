// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/surfaceCells.H"

#include <cmath>
#include <utility>

namespace flotsam
{

namespace
{

constexpr double faceWeight = 1e-9;     // of full and empty cells whose face is the surface, and of those not trusted, beside partly filled ones
constexpr double flattest = 0.05;       // change of alpha over a cell below which there is no surface (a mixture)

} // namespace

SurfaceCells::SurfaceCells(const Foam::polyMesh& mesh, const MeshAdapter& adapter, const Halo& halo, const std::vector<double>& fraction)
:   cells_(mesh), adapter_(adapter), mesh_(adapter.mesh), halo_(halo)
{
    for (std::size_t c = 0; c < fraction.size(); ++c)
        if (kindOf(fraction[c]) == Partly) add(int(c), fraction[c]);
    const std::vector<double> touches = touchingCells(fraction);
    findProfiles(touches);
    addCellsAtFaces(fraction, touches);
    for (const SurfaceCell& p : cut_) length_ = std::max(length_, 4*diagonal(p));
    length_ = halo.max(length_);
}

SurfaceCells::Kind SurfaceCells::kindOf(double fraction)
{
    if (fraction > sharp && fraction < 1 - sharp) return Partly;
    return fraction > 0.5 ? Full : Empty;
}

std::vector<double> SurfaceCells::touchingCells(const std::vector<double>& fraction) const
{
    std::vector<double> touches(nKinds*std::size_t(mesh_.nNodes), 0.0);
    std::vector<int> nodes;
    for (std::size_t c = 0; c < fraction.size(); ++c)
    {
        collectCell(adapter_, int(c), nodes);
        for (int i : nodes) touches[nKinds*std::size_t(i) + kindOf(fraction[c])] += 1;
    }
    halo_.sumToOwners(touches, nKinds);
    halo_.update(touches, nKinds);
    return touches;
}

/// A profile over several cells (setExprFields with a smooth function, a field of interFoam) is no surface within each of them. Cells that a surface
/// cuts have full and empty cells beside them, those within a profile neither; what is joined to these through cells without full, or without
/// empty ones beside them belongs to the profile.
void SurfaceCells::findProfiles(const std::vector<double>& touches)
{
    const auto hasBeside = [&](const SurfaceCell& p, int kind)
    {
        return std::any_of(p.nodes.begin(), p.nodes.end(), [&](int i) { return touches[nKinds*std::size_t(i) + kind] > 0; });
    };
    enum { Kept, Profile, MayBeProfile };
    std::vector<int> kinds;
    for (const SurfaceCell& p : cut_)
    {
        const bool hasFull = hasBeside(p, Full), hasEmpty = hasBeside(p, Empty);
        kinds.push_back(hasFull && hasEmpty ? Kept : hasFull || hasEmpty ? MayBeProfile : Profile);
    }
    std::vector<double> isInProfile(mesh_.nNodes, 0.0);
    for (bool hasGrown = true; halo_.any(hasGrown);)
    {
        for (std::size_t k = 0; k < cut_.size(); ++k)
            if (kinds[k] == Profile)
                for (int i : cut_[k].nodes) isInProfile[i] = 1;
        halo_.sumToOwners(isInProfile, 1);
        halo_.update(isInProfile, 1);
        hasGrown = false;
        for (std::size_t k = 0; k < cut_.size(); ++k)
        {
            const std::vector<int>& nodes = cut_[k].nodes;
            if (kinds[k] != MayBeProfile || std::none_of(nodes.begin(), nodes.end(), [&](int i) { return isInProfile[i] > 0; })) continue;
            kinds[k] = Profile;
            hasGrown = true;
        }
    }
    std::vector<SurfaceCell> others;
    for (std::size_t k = 0; k < cut_.size(); ++k) (kinds[k] == Profile ? profile_ : others).push_back(std::move(cut_[k]));
    cut_.swap(others);
    for (SurfaceCell& p : profile_) p.weight = p.volume;
}

/// A surface that lies on faces leaves full and empty cells in places, beside cells with traces of either: their common nodes are on it. Without planes of
/// their own these nodes would keep their level in another unit, and the surface next to the traces would be tilted.
void SurfaceCells::addCellsAtFaces(const std::vector<double>& fraction, const std::vector<double>& touches)
{
    std::vector<int> nodes;
    const auto isOnFaces = [&](int i)
    {
        const double* t = &touches[nKinds*std::size_t(i)];
        return t[Partly] == 0 && t[Full] > 0 && t[Empty] > 0;
    };
    for (std::size_t c = 0; c < fraction.size(); ++c)
    {
        if (kindOf(fraction[c]) == Partly) continue;
        collectCell(adapter_, int(c), nodes);
        if (std::any_of(nodes.begin(), nodes.end(), isOnFaces)) add(int(c), fraction[c] > 0.5);
    }
}

void SurfaceCells::add(int c, double fraction)
{
    SurfaceCell p{c, 0, fraction, 0, 0, {}, true};
    p.volume = collectCell(adapter_, c, p.nodes);
    p.size = std::pow(p.volume, 1.0/mesh_.dim);
    cut_.push_back(std::move(p));
    setTrust(cut_.size() - 1, true);
}

bool SurfaceCells::setTrust(std::size_t k, bool isTrusted)
{
    SurfaceCell& p = cut_[k];
    const bool wasTrusted = std::exchange(p.isTrusted, isTrusted);
    p.weight = p.volume*((isTrusted ? p.fraction*(1 - p.fraction) : 0) + faceWeight); // slivers say little about the surface
    return isTrusted != wasTrusted;
}

double SurfaceCells::diagonal(const SurfaceCell& p) const
{
    double sum = 0;
    for (int d = 0; d < mesh_.dim; ++d)
    {
        double low = 1e300, high = -1e300;
        for (int i : p.nodes)
        {
            low = std::min(low, mesh_.x[std::size_t(i)*mesh_.dim + d]);
            high = std::max(high, mesh_.x[std::size_t(i)*mesh_.dim + d]);
        }
        sum += (high - low)*(high - low);
    }
    return std::sqrt(sum);
}

std::array<double, 3> SurfaceCells::gradient(const SurfaceCell& p, const std::vector<double>& field) const
{
    const int dim = mesh_.dim, n = dim + 1;
    std::array<double, 3> g{};
    for (int k = adapter_.cellStart[p.cell]; k < adapter_.cellStart[p.cell + 1]; ++k)
    {
        const std::size_t e = adapter_.cellElements[k];
        for (int a = 0; a < n; ++a)
            for (int d = 0; d < dim; ++d) g[d] += mesh_.volume[e]/p.volume*field[mesh_.elements[e*n + a]]*mesh_.gradN[(e*n + a)*dim + d];
    }
    return g;
}

void SurfaceCells::dropMixtures(const std::vector<double>& alpha)
{
    const auto isMixture = [&](const SurfaceCell& p)
    {
        const auto g = gradient(p, alpha);
        return std::hypot(g[0], g[1], g[2])*p.size < flattest;
    };
    for (std::vector<SurfaceCell>* cells : {&cut_, &profile_}) cells->erase(std::remove_if(cells->begin(), cells->end(), isMixture), cells->end());
}

Vec3 SurfaceCells::centre(const SurfaceCell& p) const
{
    const Foam::point& at = cells_.cellCentres()[p.cell];
    Vec3 x = Vec3::Zero();
    for (int d = 0; d < mesh_.dim; ++d) x[d] = at[mesh_.axes[d]];
    return x;
}

Vec3 SurfaceCells::point(int node) const
{
    Vec3 x = Vec3::Zero();
    for (int d = 0; d < mesh_.dim; ++d) x[d] = mesh_.x[std::size_t(node)*mesh_.dim + d];
    return x;
}

} // namespace flotsam
