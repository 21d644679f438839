// SPDX-License-Identifier: GPL-3.0-or-later
/// Tabulated motions: through every point, smooth, without overshoot.
#include "demCoupling/core/motionTable.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

/// Opens, rests, opens on, and closes a little; moves aside the whole time.
const std::vector<MotionTable::Point> points{{1, {0, 0, 0}}, {1.5, {0.1, 0, 0.2}}, {3, {0.2, 0, 0.2}}, {4, {0.3, 0, 1}}, {4.2, {0.4, 0, 0.9}}};

}

TEST_CASE("the way meets the points, and stands before and after them")
{
    const MotionTable table(points);
    for (const auto& p : points) CHECK((table.at(p.time).first - p.displacement).norm() < 1e-15);
    for (const auto& [time, p] : {std::pair(-1.0, points.front()), std::pair(1.0, points.front()), std::pair(4.2, points.back()), std::pair(9.0, points.back())})
    {
        CHECK(table.at(time).first == p.displacement);
        CHECK(table.at(time).second.isZero(0));
    }
}

TEST_CASE("the velocity is the derivative of the way and does not jump")
{
    const MotionTable table(points);
    const double h = 1e-6;
    for (double time = 0.9; time < 4.4; time += 0.013) CHECK(((table.at(time + h).first - table.at(time - h).first)/(2*h) - table.at(time).second).norm() < 1e-7);
    for (const auto& p : points) CHECK((table.at(p.time + h).second - table.at(p.time - h).second).norm() < 1e-4);
}

TEST_CASE("between two points no component leaves what they span: what rests in the table rests")
{
    const MotionTable table(points);
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        for (double x = 0; x <= 1; x += 0.01)
        {
            const Vec3 a = points[i].displacement, b = points[i + 1].displacement, at = table.at(points[i].time + x*(points[i + 1].time - points[i].time)).first;
            CHECK((at.array() <= a.cwiseMax(b).array() + 1e-15).all());
            CHECK((at.array() >= a.cwiseMin(b).array() - 1e-15).all());
        }
}

TEST_CASE("away from the ends a steady motion is steady, and a smooth one is met the better the more points there are")
{
    std::vector<MotionTable::Point> steady;
    for (int i = 0; i < 6; ++i) steady.push_back({0.1*i*i, Vec3(0, 0.5*0.1*i*i, 0)});
    for (double time = 0.1; time < 1.6; time += 0.01) CHECK(MotionTable(steady).at(time).second[1] == near(0.5, 1e-12));
    const auto error = [](int n)
    {
        std::vector<MotionTable::Point> wave;
        for (int i = 0; i <= n; ++i) wave.push_back({double(i)/n, Vec3(0, 0, std::sin(double(i)/n))});
        double largest = 0;
        for (double time = 0.3; time < 0.7; time += 0.001) largest = std::max(largest, std::abs(MotionTable(wave).at(time).first[2] - std::sin(time)));
        return largest;
    };
    const double coarse = error(10), middle = error(20), fine = error(40);
    CHECK(coarse > 3.4*middle);
    CHECK(middle > 3.4*fine);
}
