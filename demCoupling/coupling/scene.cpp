// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/scene.hpp"

#include <algorithm>
#include <utility>

namespace flotsam
{

Scene::Scene(std::vector<SceneStructure> structures, const std::vector<BodyDefinition>& bodies, const Vec3& gravity)
:   structures_(std::move(structures)), bodies_(bodies), gravity_(gravity)
{
    for (const SceneStructure& s : structures_)
    {
        solids_.push_back(s.solid);
        if (s.motion) isMoving_ = true;
    }
    for (const BodyDefinition& body : bodies_)
    {
        Solid solid;
        solid.name = body.name;
        solid.kind = Solid::Kind::Free;
        solid.isLoose = true;
        solid.shape = body.shape;
        solid.pose = body.pose;
        solid.motion = body.motion;
        solids_.push_back(solid);
    }
    for (const Solid& s : solids_) bounds_.push_back(s.shape->bounds());
}

namespace
{

constexpr double farAway = 1e9; // [m]; of bodies that have left or are to come: just outside the mesh they were the nearest solid to facets of others that leave

} // namespace

void Scene::place(double time, const BodyCoupling* coupling)
{
    for (std::size_t s = 0; s < structures_.size(); ++s)
        if (structures_[s].motion) structures_[s].motion(time, solids_[s].pose, solids_[s].motion);
    for (std::size_t b = 0; coupling && b < bodies_.size(); ++b) placeBody(b, *coupling);
}

void Scene::placeBody(std::size_t b, const BodyCoupling& coupling)
{
    Solid& solid = solids_[structures_.size() + b];
    const BodyState& state = coupling.predicted()[b];
    // a held body is an obstacle at rest
    solid.kind = coupling.isHeld(int(b)) ? Solid::Kind::Prescribed : Solid::Kind::Free;
    solid.pose = state.pose;
    solid.motion = coupling.isHeld(int(b)) ? Motion() : state.motion;
    if (!coupling.isThere(int(b))) solid.pose.position.setConstant(farAway);
}

void Scene::begin(double time, const BodyCoupling* coupling, const std::vector<char>& which)
{
    for (std::size_t s = 0; s < structures_.size(); ++s)
    {
        if (!which[s]) continue;
        solids_[s].pose = structures_[s].solid.pose;
        if (structures_[s].motion) structures_[s].motion(time, solids_[s].pose, solids_[s].motion);
    }
    for (std::size_t b = 0; coupling && b < bodies_.size(); ++b)
        if (which[structures_.size() + b]) placeBody(b, *coupling);
}

void Scene::findFreeBodies(const BodyCoupling& coupling, double newLoadShare, std::vector<FreeBody>& result) const
{
    result.clear();
    for (std::size_t b = 0; b < bodies_.size(); ++b)
    {
        if (coupling.isHeld(int(b))) continue;
        const BodyDefinition& definition = bodies_[b];
        const Eigen::Matrix3d R = solids_[structures_.size() + b].pose.orientation.toRotationMatrix();
        FreeBody body;
        body.mass = definition.mass;
        body.inertia = R*definition.principalInertia.asDiagonal()*R.transpose();
        const BodyState& state = coupling.smoothStates()[b];
        body.velocity = state.motion.velocity;
        body.angularVelocity = state.motion.angularVelocity;
        body.angularMomentum = state.angularMomentum;
        body.lastChange = coupling.lastChanges()[b];
        const Load &last = coupling.lastLoads()[b], &contact = coupling.contactGuess()[b];
        const double share = coupling.newLoadShare(int(b), newLoadShare);
        body.newLoadShare = share;
        body.force = share*definition.mass*gravity_ + (1 - share)*last.force + contact.force;
        body.moment = (1 - share)*last.moment + contact.moment;
        result.push_back(body);
    }
}

namespace
{

/// Of a box at a pose to a box in space [m], at least; 0: they may meet.
double gapBetween(const std::array<Vec3, 2>& box, const Pose& pose, const std::array<Vec3, 2>& other)
{
    const Vec3 centre = pose.position + pose.orientation*(0.5*(box[0] + box[1])),
        half = pose.orientation.toRotationMatrix().cwiseAbs()*(0.5*(box[1] - box[0]));
    return std::max(0.0, ((other[0] - centre - half).cwiseMax(centre - half - other[1])).maxCoeff());
}

} // namespace

std::pair<std::string, double> Scene::fastest(double time, double ahead) const
{
    std::pair<std::string, double> result{"", 0};
    const auto offer = [&](std::size_t s, double speed) { if (speed > result.second) result = {solids_[s].name, speed}; };
    for (std::size_t s = 0; s < solids_.size(); ++s)
    {
        const Solid& solid = solids_[s];
        const double speed = solid.kind == Solid::Kind::Fixed ? 0 : fastestCorner(bounds_[s], solid.pose, solid.motion);
        if (s >= structures_.size() || !structures_[s].motion)
        {
            offer(s, speed);
            continue;
        }
        Pose pose;
        Motion motion;
        structures_[s].motion(time, pose, motion);
        const double fastest = std::max(speed, fastestCorner(bounds_[s], pose, motion));
        const double gap = std::min(gapBetween(bounds_[s], solid.pose, meshBox_), gapBetween(bounds_[s], pose, meshBox_));
        if (gap <= fastest*ahead) offer(s, fastest);
    }
    return result;
}

void Scene::save(std::vector<double>& data) const
{
    constexpr std::size_t perSolid = 18;
    data.clear();
    data.reserve(perSolid*solids_.size());
    for (const Solid& s : solids_)
    {
        data.insert(data.end(), s.pose.position.data(), s.pose.position.data() + 3);
        const double* q = s.pose.orientation.coeffs().data();
        data.insert(data.end(), q, q + 4);
        data.insert(data.end(), s.motion.velocity.data(), s.motion.velocity.data() + 3);
        data.insert(data.end(), s.motion.angularVelocity.data(), s.motion.angularVelocity.data() + 3);
        data.push_back(s.offset);
        data.insert(data.end(), s.offsetSlope.data(), s.offsetSlope.data() + 3);
        data.push_back(double(s.kind));
    }
}

std::vector<Solid> Scene::stored(const std::vector<double>& data)
{
    constexpr std::size_t width = 18;
    if (data.size() % width != 0)
        throw std::runtime_error("restart: the stored state was written by another version of flotsamFoam; start the run anew");
    std::vector<Solid> solids(data.size()/width);
    const double* at = data.data();
    for (Solid& s : solids)
    {
        s.pose.position = Vec3(at[0], at[1], at[2]);
        std::copy(at + 3, at + 7, s.pose.orientation.coeffs().data());
        s.motion.velocity = Vec3(at[7], at[8], at[9]);
        s.motion.angularVelocity = Vec3(at[10], at[11], at[12]);
        s.offset = at[13];
        s.offsetSlope = Vec3(at[14], at[15], at[16]);
        s.kind = Solid::Kind(int(at[17]));
        at += width;
    }
    return solids;
}

void Scene::restore(const std::vector<double>& data)
{
    restore(data, StoredMembers::all(nStructures(), nBodies(), 0).solids(nStructures()));
}

void Scene::restore(const std::vector<double>& data, const std::vector<int>& known)
{
    const std::vector<Solid> was = stored(data);
    if (was.size() != known.size())
        throw std::runtime_error("restart: the stored state has " + std::to_string(was.size())
            + " solids, the case has " + std::to_string(known.size()) + "; restart with the constant/bodies of the first run");
    for (std::size_t k = 0; k < was.size(); ++k)
    {
        Solid& s = solids_[known[k]];
        s.pose = was[k].pose;
        s.motion = was[k].motion;
        s.offset = was[k].offset;
        s.offsetSlope = was[k].offsetSlope;
        s.kind = was[k].kind;
    }
}

void Scene::hide(const std::vector<char>& areHidden)
{
    for (std::size_t s = 0; s < solids_.size(); ++s)
        if (areHidden[s]) solids_[s].pose.position.setConstant(farAway);
}

} // namespace flotsam
