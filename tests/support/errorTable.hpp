// SPDX-License-Identifier: GPL-3.0-or-later
/// Errors on a sequence of meshes or time steps with the orders between neighbours, printed as a markdown table.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mpi.h>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace flotsam
{

class ErrorTable
{
public:
    explicit ErrorTable(std::string title, std::string sizeName = "h") : title_(std::move(title)), sizeName_(std::move(sizeName)) {}

    /// Coarse to fine; the same names in every row.
    void add(double size, const std::vector<std::pair<std::string, double>>& errors)
    {
        sizes_.push_back(size);
        rows_.push_back(errors);
    }

    /// Between row-1 and row.
    double order(const std::string& name, int row) const
    {
        return std::log(value(name, row - 1)/value(name, row))/std::log(sizes_[row - 1]/sizes_[row]);
    }
    double lastOrder(const std::string& name) const { return order(name, int(rows_.size()) - 1); }

    /// The least of those between neighbours.
    double leastOrder(const std::string& name) const
    {
        double least = order(name, 1);
        for (int row = 2; row < int(rows_.size()); ++row) least = std::min(least, order(name, row));
        return least;
    }

    /// Slope of the line through all rows, least squares in logarithms.
    double fittedOrder(const std::string& name) const
    {
        double x = 0, y = 0, xx = 0, xy = 0;
        const int n = int(rows_.size());
        for (int row = 0; row < n; ++row)
        {
            const double size = std::log(sizes_[row]), error = std::log(value(name, row));
            x += size;
            y += error;
            xx += size*size;
            xy += size*error;
        }
        return (n*xy - x*y)/(n*xx - x*x);
    }

    /// Shown by all rows and kept by the last two: the lesser of the two.
    double shownOrder(const std::string& name) const { return std::min(fittedOrder(name), lastOrder(name)); }

    double value(const std::string& name, int row) const
    {
        for (const auto& e : rows_[row]) if (e.first == name) return e.second;
        throw std::invalid_argument("ErrorTable: no column " + name);
    }

    /// On rank 0.
    void print() const
    {
        int rank = 0;
        MPI_Comm_rank(MPI_COMM_WORLD, &rank);
        if (rank != 0 || rows_.empty()) return;
        std::printf("\n%s\n| %s |", title_.c_str(), sizeName_.c_str());
        for (const auto& e : rows_[0]) std::printf(" %s | order |", e.first.c_str());
        std::printf("\n|---|");
        for (std::size_t k = 0; k < rows_[0].size(); ++k) std::printf("---|---|");
        for (std::size_t r = 0; r < rows_.size(); ++r)
        {
            std::printf("\n| %.4g |", sizes_[r]);
            for (const auto& e : rows_[r])
                if (r == 0) std::printf(" %.3e | |", e.second);
                else std::printf(" %.3e | %.2f |", e.second, order(e.first, int(r)));
        }
        std::printf("\n");
        std::fflush(stdout);
    }

private:
    std::string title_, sizeName_;
    std::vector<double> sizes_;
    std::vector<std::vector<std::pair<std::string, double>>> rows_;
};

} // namespace flotsam
