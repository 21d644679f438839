// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/fluidAnswer.hpp"

#include <Eigen/Eigenvalues>

namespace flotsam
{

double radiusOfInertia(const BodyDefinition& body) { return std::sqrt(body.principalInertia.maxCoeff()/body.mass); }

Vector6 asVector(const Load& load)
{
    Vector6 v;
    v << load.force, load.moment;
    return v;
}

Load asLoad(const Vector6& v) { return {v.head<3>(), v.tail<3>()}; }

FluidAnswer::FluidAnswer(const std::vector<BodyDefinition>& bodies, const CouplingControls& controls)
:   bodies_(bodies), controls_(controls), shares_(bodies.size(), LoadShare::Identity()), areKnown_(bodies.size(), 0)
{}

void FluidAnswer::setShares(const std::vector<LoadShare>& shares)
{
    shares_ = shares;
    for (std::size_t b = 0; b < shares_.size(); ++b) areKnown_[b] = !shares_[b].isIdentity(0);
}

void FluidAnswer::drop(int b)
{
    shares_[b].setIdentity();
    areKnown_[b] = 0;
}

double FluidAnswer::expected(int b) const { return 1 + controls_.liquidDensity*bodies_[b].volume/bodies_[b].mass; }

bool FluidAnswer::isLight(int b) const { return expected(b) >= leastRatio; }

std::vector<int> FluidAnswer::components(int b) const
{
    const BodyDefinition& body = bodies_[b];
    std::vector<int> result;
    for (int k = 0; k < 6; ++k)
        if (!body.isPlanar || (k % 3 == body.planeAxis) == (k >= 3)) result.push_back(k);
    return result;
}

/// P = M^1/2 S M^-1/2 with S = M^1/2 C M^1/2, symmetric, of eigenvalues between 0 and 1.
void FluidAnswer::set(int b, const LoadShare& measured, const Eigen::Quaterniond& orientation)
{
    constexpr double least = 1e-3;  // what solves are exact to: less would be noise, and a share too small diverges
    const BodyDefinition& body = bodies_[b];
    const Eigen::Matrix3d R = orientation.toRotationMatrix();
    LoadShare root = LoadShare::Identity()*std::sqrt(body.mass), inverse = LoadShare::Identity()/std::sqrt(body.mass);
    root.bottomRightCorner<3, 3>() = R*body.principalInertia.cwiseSqrt().asDiagonal()*R.transpose();
    inverse.bottomRightCorner<3, 3>() = R*body.principalInertia.cwiseSqrt().cwiseInverse().asDiagonal()*R.transpose();
    const LoadShare s = inverse*measured*root;
    const Eigen::SelfAdjointEigenSolver<LoadShare> eigen(0.5*(s + s.transpose()));
    const LoadShare& v = eigen.eigenvectors();
    shares_[b] = root*(v*eigen.eigenvalues().cwiseMax(least).cwiseMin(1).asDiagonal()*v.transpose())*inverse;
    areKnown_[b] = 1;
}

std::vector<BodyShare> FluidAnswer::known() const
{
    std::vector<BodyShare> result;
    for (int b = 0; b < int(shares_.size()); ++b)
        if (isKnown(b)) result.push_back({b, shares_[b]});
    return result;
}

void FluidAnswer::findEngineLoads(const std::vector<Load>& given, const std::vector<Load>& contact, std::vector<Load>& loads) const
{
    loads = given;
    for (int b = 0; b < int(loads.size()); ++b)
        if (isKnown(b)) loads[b] = asLoad(asVector(loads[b]) + asVector(contact[b]) - shares_[b]*asVector(contact[b]));
}

} // namespace flotsam
