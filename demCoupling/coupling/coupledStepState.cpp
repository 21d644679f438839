// SPDX-License-Identifier: GPL-3.0-or-later
/// The part of CoupledStep that is stored and continued, also with more solids than before.
#include "demCoupling/coupling/coupledStep.hpp"

#include <cmath>
#include <stdexcept>

namespace flotsam
{

/// Of the scene's poses and offsets exactly: no further correction of volumes. hasChanged: as Fluid::setGeometry().
void CoupledStep::restoreGeometry(bool hasChanged)
{
    if (scene_.isEmpty()) return;
    PhaseTimer t(timers_, Phase::Cut);
    builder_->chooseThin(scene_.solids());
    fluid_.setGeometry(&builder_->build(scene_.solids()), &scene_.solids(), hasChanged);
}

CoupledStep::Arrays CoupledStep::save() const
{
    Arrays arrays;
    arrays["liquid"] = {fluid_.keptLiquid()};
    if (scene_.isEmpty()) return arrays;
    scene_.save(arrays["solids"]);
    std::vector<double> loads;
    for (const auto& l : loads_)
        for (const Vec3* v : {&l.force, &l.moment}) loads.insert(loads.end(), v->data(), v->data() + 3);
    arrays["fluidLoads"] = loads;
    if (coupling_) arrays["bodies"] = coupling_->save();
    return arrays;
}

CoupledStep::Arrays CoupledStep::saveOfProcess() const
{
    Arrays arrays{{"massFluxes", fluid_.massFluxes().records()}, {"remainder", fluid_.state().remainder}};
    if (!scene_.isEmpty()) arrays["ghostFluxes"] = fluid_.ghostFluxes();
    return arrays;
}

namespace
{

/// Of a state; throws where it has none.
const std::vector<double>& arrayOf(const CoupledStep::Arrays& arrays, const char* name)
{
    const auto at = arrays.find(name);
    if (at == arrays.end()) throw std::runtime_error(std::string("restart: the stored state has no '") + name + "'; it was written by a run without solids or bodies");
    return at->second;
}

/// The loads of solids as save() has written them.
void takeLoads(const std::vector<double>& numbers, const std::vector<int>& known, std::vector<Fluid::SolidLoad>& loads)
{
    for (std::size_t k = 0; k < known.size() && 6*k + 5 < numbers.size(); ++k)
        for (int d = 0; d < 3; ++d)
        {
            loads[known[k]].force[d] = numbers[6*k + d];
            loads[known[k]].moment[d] = numbers[6*k + 3 + d];
        }
}

} // namespace

void CoupledStep::restoreFluid(FlowState state, const Arrays& arrays, Fields fields)
{
    fluid_.start(std::move(state), fields == Fields::Cells);
    if (fields != Fields::Cells) fluid_.setKeptLiquid(arrayOf(arrays, "liquid").at(0));
    if (fields != Fields::Exact) return;
    fluid_.massFluxes().setRecords(arrayOf(arrays, "massFluxes"));
    const auto left = arrays.find("remainder"); // states of older versions have none
    if (left != arrays.end()) fluid_.setRemainder(left->second);
}

void CoupledStep::restore(FlowState state, const Arrays& arrays, Fields fields)
{
    const std::size_t nRestraints = coupling_ ? coupling_->restraintLoads().size() : 0;
    restore(std::move(state), arrays, fields, StoredMembers::all(scene_.nStructures(), scene_.nBodies(), int(nRestraints)));
}

void CoupledStep::restore(FlowState state, const Arrays& arrays, Fields fields, const StoredMembers& stored)
{
    restoreFluid(std::move(state), arrays, fields);
    if (scene_.isEmpty()) return;
    const std::vector<int> known = stored.solids(scene_.nStructures());
    const std::vector<char> isNew = areNew(known, int(scene_.solids().size()));
    loads_.assign(scene_.solids().size(), {Vec3::Zero(), Vec3::Zero()});
    if (!known.empty())
    {
        scene_.restore(arrayOf(arrays, "solids"), known);
        if (fields == Fields::Exact) fluid_.setGhostFluxes(arrayOf(arrays, "ghostFluxes"));
        takeLoads(arrayOf(arrays, "fluidLoads"), known, loads_);
    }
    if (coupling_) coupling_->restore(stored.bodies.empty() ? std::vector<double>() : arrayOf(arrays, "bodies"), stored);
    scene_.hide(isNew);
    restoreGeometry(fields == Fields::Cells);
    if (known.size() < isNew.size()) putIn(isNew);
    fluid_.findWetFractions(wet_);
}

/// What is new takes its place, and the liquid there is gone: as at the start of a run, where fields count outside of solids alone. It does not come back elsewhere.
void CoupledStep::putIn(const std::vector<char>& isNew)
{
    const double before = fluid_.liquidVolume(), kept = fluid_.keptLiquid();
    const Cover was = builder_->cover();
    scene_.begin(fluid_.state().time, coupling_.get(), isNew);
    const Cover& cover = cutNew(isNew);
    bool isAnyThere = false;
    for (std::size_t s = 0; s < isNew.size(); ++s) isAnyThere = isAnyThere || (isNew[s] && (cover.solidVolume[s] > 0 || cover.solidArea[s] > 0));
    fluid_.setGeometry(&cover, &scene_.solids(), isAnyThere);
    fluid_.forgetCovered(was);
    displaced_ = before - fluid_.liquidVolume();
    if (std::isfinite(kept)) fluid_.setKeptLiquid(kept - displaced_/mesh_.thickness);
}

/// Those of the state keep the offsets that they have: found again they would differ by what the search leaves.
const Cover& CoupledStep::cutNew(const std::vector<char>& isNew)
{
    PhaseTimer t(timers_, Phase::Cut);
    std::vector<Solid>& solids = scene_.solids();
    std::vector<Solid::Kind> kinds;
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
        kinds.push_back(solids[s].kind);
        if (!isNew[s] && solids[s].kind == Solid::Kind::Free) solids[s].kind = Solid::Kind::Prescribed;
    }
    for (int k = 0; k < cutsFromNothing; ++k) builder_->buildExactVolume(solids);
    for (std::size_t s = 0; s < solids.size(); ++s) solids[s].kind = kinds[s];
    return builder_->cover();
}

} // namespace flotsam
