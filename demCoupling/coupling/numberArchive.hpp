// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies' states as plain numbers in a fixed order: what is written and what is read is said once, by pass().
#pragma once

#include "demCoupling/core/restraint.hpp"
#include "demCoupling/core/rigidBody.hpp"

#include <type_traits>
#include <vector>

namespace flotsam
{

class NumberWriter
{
public:
    template <class Number> void number(const Number& value) { numbers_.push_back(static_cast<double>(value)); }
    std::vector<double>& numbers() { return numbers_; }
    void clear() { numbers_.clear(); }      ///< keeps its memory

private:
    std::vector<double> numbers_;
};

/// Of numbers that a NumberWriter has written; as many as are asked for must be there.
class NumberReader
{
public:
    explicit NumberReader(const double* first) : at_(first) {}
    template <class Number> void number(Number& value) { value = static_cast<Number>(*at_++); }

private:
    const double* at_;
};

template <class Archive, class... Parts> void passAll(Archive& archive, Parts&... parts);

/// Numbers, enumerations, what bodies have, and lists of them: lists have their length already.
template <class Archive, class T>
void pass(Archive& archive, T& value)
{
    using Type = std::remove_const_t<T>;
    if constexpr (std::is_arithmetic_v<Type> || std::is_enum_v<Type>) archive.number(value);
    else if constexpr (std::is_same_v<Type, Eigen::Quaterniond>)
    {
        archive.number(value.w());
        for (int d = 0; d < 3; ++d) archive.number(value.coeffs()[d]);
    }
    else if constexpr (std::is_same_v<Type, Vec3>)
        for (int d = 0; d < 3; ++d) archive.number(value[d]);
    else if constexpr (std::is_same_v<Type, Load>)
        passAll(archive, value.force, value.moment);
    else if constexpr (std::is_same_v<Type, Motion>)
        passAll(archive, value.velocity, value.angularVelocity);
    else if constexpr (std::is_same_v<Type, RestraintLoad>)
        passAll(archive, value.force, value.tension, value.largest, value.length, value.isBroken);
    else if constexpr (std::is_same_v<Type, LoadShare>)
        for (int k = 0; k < value.size(); ++k) archive.number(value.data()[k]);
    else if constexpr (std::is_same_v<Type, BodyState>)
        passAll(archive, value.pose.position, value.pose.orientation, value.motion, value.angularMomentum);
    else for (auto& part : value) pass(archive, part);
}

/// One after the other.
template <class Archive, class... Parts>
void passAll(Archive& archive, Parts&... parts)
{
    (pass(archive, parts), ...);
}

} // namespace flotsam
