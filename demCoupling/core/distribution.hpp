// SPDX-License-Identifier: GPL-3.0-or-later
/// Distributions of sizes and densities between two bounds, drawn by inversion: one random number a value.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace flotsam
{

struct Distribution
{
    enum class Kind { Uniform, Normal, LogNormal, Values };
    Kind kind = Kind::Uniform;
    double smallest = 0, largest = 0;   ///< nothing is drawn outside
    double mean = 0, deviation = 0;     ///< of Normal and LogNormal, as they are without the bounds
    std::vector<double> values;         ///< of Values: each as likely as any other

    /// Probability of less than x without the bounds; uniform: with them.
    double below(double x) const;

    /// Of the values between the bounds the one that the share u, 0 <= u < 1, of all are less than.
    double quantile(double u) const;
};

inline double Distribution::below(double x) const
{
    const auto standard = [](double z) { return 0.5*std::erfc(-z/std::sqrt(2.0)); };
    if (kind == Kind::Normal) return standard((x - mean)/deviation);
    if (kind == Kind::LogNormal)
    {
        // the logarithm is normal; its variance and mean from those of x
        const double variance = std::log1p(deviation*deviation/(mean*mean));
        return standard((std::log(x/mean) + 0.5*variance)/std::sqrt(variance));
    }
    return (x - smallest)/(largest - smallest);
}

inline double Distribution::quantile(double u) const
{
    if (kind == Kind::Values) return values[std::min(values.size() - 1, static_cast<std::size_t>(u*static_cast<double>(values.size())))];
    if (kind == Kind::Uniform) return smallest + u*(largest - smallest);
    const double wanted = below(smallest) + u*(below(largest) - below(smallest));
    double low = smallest, high = largest;
    for (int i = 0; i < 100; ++i)
    {
        const double middle = 0.5*(low + high);
        (below(middle) < wanted ? low : high) = middle;
    }
    return 0.5*(low + high);
}

} // namespace flotsam
