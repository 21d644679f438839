// SPDX-License-Identifier: GPL-3.0-or-later
/// Which pairs of spheres are candidates for some twenty sub-steps, and which of these can touch within a few.
#include "demCoupling/liggghts/liggghtsNear.hpp"

#include <mpi.h>

#include "atom.h"
#include "lammps.h"
#include "neigh_list.h"

#include <algorithm>

namespace flotsam
{

namespace
{

constexpr double stepsOfFew = 10;       // as far as the look at the dashpots is ahead, which places the candidates anyway
constexpr double leastOfFew = 0.0005;   // of the skin, for bodies that are pushed from rest

Vec3 asVec(const double* v) { return Vec3(v[0], v[1], v[2]); }

} // namespace

void NearSpheres::forgetGaps()
{
    gaps_.assign(pairs_.size(), {-1, 0, 0});
    ways_.assign(reach_.size(), 0);
    largestWay_ = 0;
    selected_.clear(); // bodies may have been put elsewhere since
}

/// Bounds of how the gaps may have shrunk since they were looked at.
void NearSpheres::addWays()
{
    double largest = 0;
    for (size_t b = 0; b < selected_.size(); ++b)
    {
        const double way = wayFrom(selected_, b);
        ways_[b] += way;
        largest = std::max(largest, way);
    }
    largestWay_ += largest;
}

void NearSpheres::selectCandidates()
{
    const double largestReach = *std::max_element(reach_.begin(), reach_.end());
    candidates_.clear();
    candidateOthers_.clear();
    for (size_t k = 0; k < pairs_.size(); ++k)
    {
        const size_t body = bodyOf(pairs_[k].sphere);
        Gap& gap = gaps_[k];
        if (gap.least - (ways_[body] - gap.way) - (largestWay_ - gap.largestWay) <= reach_[body] + largestReach)
            addCandidates(pairs_[k], gap);
        else
            pairList(model_).numneigh[pairs_[k].sphere] = 0;
    }
    collectCandidates();
}

void NearSpheres::addCandidates(const Neighbours& all, Gap& gap)
{
    const LAMMPS_NS::Atom& atoms = *model_.instance.lammps().atom;
    const LAMMPS_NS::NeighList& list = pairList(model_);
    const int i = all.sphere;
    const int *touching = list.firstneigh[i], *const end = touching + list.numneigh[i], *flag = list.listgranhistory->firstneigh[i];
    const auto skipOpen = [&] { for (; touching != end && !*flag; ++touching) ++flag; };
    skipOpen();
    const Vec3 centre = asVec(atoms.x[i]);
    const double reachOfThis = reach_[bodyOf(i)];
    const size_t first = candidateOthers_.size();
    double leastGap = 1e300;
    for (size_t k = all.first; k < all.last; ++k)
    {
        const int other = others_[k], j = other & NEIGHMASK;
        const bool isTouching = touching != end && *touching == other;
        const double radii = atoms.radius[i] + atoms.radius[j], reach = radii + reachOfThis + reach_[bodyOf(j)];
        const double square = (centre - asVec(atoms.x[j])).squaredNorm();
        leastGap = std::min(leastGap, std::sqrt(square) - radii);
        if (isTouching || square <= reach * reach)
            candidateOthers_.push_back(other);
        if (isTouching)
        {
            ++touching;
            ++flag;
            skipOpen();
        }
    }
    gap = {leastGap, ways_[bodyOf(i)], largestWay_};
    if (candidateOthers_.size() > first)
        candidates_.push_back({i, first, candidateOthers_.size()});
    else
        list.numneigh[i] = 0;
}

/// The spheres that have to be in their places when the few are chosen.
void NearSpheres::collectCandidates()
{
    for (const Neighbours& n : candidates_)
        for (size_t k = n.first; k < n.last; ++k)
        {
            markActive(n.sphere);
            markActive(candidateOthers_[k] & NEIGHMASK);
        }
    near_.clear();
    for (const int i : listed_)
        if (isActive_[static_cast<size_t>(i)])
            near_.push_back(i);
}

/// With the candidates in their places.
void NearSpheres::selectFew()
{
    few_.resize(reach_.size());
    shortReach_.resize(reach_.size());
    for (size_t b = 0; b < reach_.size(); ++b)
    {
        few_[b] = placeOf(b);
        shortReach_[b] = std::min(wantedReach(b, stepsOfFew, leastOfFew), reach_[b]);
    }
    LAMMPS_NS::NeighList& list = pairList(model_);
    list.inum = 0;
    std::swap(fewPairs_, fewPairsBefore_);
    fewPairs_.clear(candidateOthers_.size());
    for (const int i : near_)
        isActive_[static_cast<size_t>(i)] = isHeld_[static_cast<size_t>(i)];
    for (const Neighbours& all : candidates_)
    {
        list.numneigh[all.sphere] = selectFew(all);
        if (list.numneigh[all.sphere] > 0)
            list.ilist[list.inum++] = all.sphere;
    }
    active_.clear();
    for (const int i : near_)
        if (isActive_[static_cast<size_t>(i)])
            active_.push_back(i);
}

/// Of one sphere, in the order of LIGGGHTS, with the springs of those in touch; their number.
int NearSpheres::selectFew(const Neighbours& all)
{
    const LAMMPS_NS::Atom& atoms = *model_.instance.lammps().atom;
    const LAMMPS_NS::NeighList& list = pairList(model_);
    const int i = all.sphere;
    int *&others = list.firstneigh[i], *&flags = list.listgranhistory->firstneigh[i];
    double*& springs = list.listgranhistory->firstdouble[i];
    const size_t first = fewPairs_.others.size();
    int jj = 0;
    const auto skipOpen = [&] { while (jj < list.numneigh[i] && !flags[jj]) ++jj; };
    skipOpen();
    for (size_t k = all.first; k < all.last; ++k)
    {
        const int other = candidateOthers_[k], j = other & NEIGHMASK;
        const bool isTouching = jj < list.numneigh[i] && others[jj] == other;
        const double reach = atoms.radius[i] + atoms.radius[j] + shortReach_[bodyOf(i)] + shortReach_[bodyOf(j)];
        if (!isTouching && (asVec(atoms.x[i]) - asVec(atoms.x[j])).squaredNorm() > reach * reach)
            continue;
        fewPairs_.add(other, isTouching ? flags[jj] : 0, isTouching ? asVec(springs + 3 * jj) : Vec3::Zero());
        if (isTouching)
        {
            ++jj;
            skipOpen();
        }
        markActive(i);
        markActive(j);
    }
    others = fewPairs_.others.data() + first;
    flags = fewPairs_.flags.data() + first;
    springs = fewPairs_.springs.data() + 3 * first;
    return static_cast<int>(fewPairs_.others.size() - first);
}

} // namespace flotsam
