// SPDX-License-Identifier: GPL-3.0-or-later
/// Writes a small body history with known values: a bar that moves along x at 1 m/s, a post at rest, and a line between them that breaks at the end.
/// Usage: writeHistoryExample FILE
#include "io/bodyHistory.hpp"

#include <iostream>

using namespace flotsam;

int main(int argc, char** argv)
{
    if (argc != 2)
    {
        std::cerr << "usage: " << argv[0] << " FILE\n";
        return 1;
    }
    TriSurface tetrahedron;
    tetrahedron.points = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const std::vector<HistoryMember> members{{"bar", false, 0.5, 1e-3, tetrahedron, 1.5, 0.25}, {"post", true, 0, 2e-3, tetrahedron}};
    BodyHistory history(argv[1], members, 0, {"mooring"});
    for (int i = 0; i <= 100; ++i)
    {
        const double time = 0.01 * i;
        std::vector<BodyRecord> records(2);
        records[0].pose.position.x() = time;
        records[0].motion.velocity.x() = 1;
        records[0].contacts = i >= 50;
        records[0].isAwaited = i < 10;
        records[0].hasLeft = i > 80;
        records[1].fluidForce = Vec3(time, 0, 2);
        if (i >= 20 && i < 24) // an impact of four steps
        {
            records[1].contactForce = Vec3(2, 0, 0);
            records[1].peakContactForce = Vec3(i == 21 ? 4 : 3, i == 21 ? 3 : 0, 0);
        }
        history.append(time, records, {{"dt", 0.01}});
        if (i % 50 != 0) continue;
        history.writeSurface(time, records);
        history.writeLines(time, {{records[0].pose.position, i < 100 ? Vec3(0, 2, 0) : records[0].pose.position, 3*time}});
    }
    return 0;
}
