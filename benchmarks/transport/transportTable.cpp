// SPDX-License-Identifier: GPL-3.0-or-later
/// Error, cost and conservation of the phase transport: Zalesak's disc (one turn) and the reversed vortex.
/// usage: transportTable [largest n, default 128 [3D: yes or no, default no [Courant number, default 0.5 [delta/h, default 0.25 0.35 0.5]]]]
#include "support/transportScene.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

using namespace flotsam;

namespace
{

void print(const char* name, int n, double width, const TransportScene& scene, const TransportResult& r)
{
    if (scene.halo.rank() == 0)
    {
        std::printf("%-14s n %4d delta %.2f | error %.4f mass %+.1e redistributed %.1e alpha [%.1e, 1%+.1e] limited %ld "
                    "| %.3f us/node/step, %d steps, band %.3f roof %.3f\n", name, n, width, r.error, r.massError, r.redistributed,
            r.lowest, r.highest - 1, r.limited, 1e6*r.secondsPerNodeStep, r.steps, r.bandShare, r.roofShare);
        std::fflush(stdout);
    }
}

} // namespace

int main(int argc, char** argv)
{
    MPI_Init(&argc, &argv);
    const int largest = argc > 1 ? std::atoi(argv[1]) : 128;
    const bool with3D = argc > 2 && std::string(argv[2]) == "yes";
    const double courant = argc > 3 ? std::atof(argv[3]) : 0.5;
    const std::vector<double> widths = argc > 4 ? std::vector<double>{std::atof(argv[4])} : std::vector<double>{0.25, 0.35, 0.5};
    for (const double width : widths)
    {
        for (int n = 32; n <= largest; n *= 2)
        {
            {
                TransportScene scene(MPI_COMM_WORLD, 2, n, width, rotationField());
                scene.fastest = 1;
                scene.fill(slottedDisc());
                print("zalesak", n, width, scene, runPeriod(scene, 2*M_PI, courant, [](double) { return 1; }));
            }
            for (const double period : {2., 8.})
            {
                TransportScene scene(MPI_COMM_WORLD, 2, n, width, vortexField());
                scene.fill(disc({0.5, 0.75, 0}, 0.15, 2));
                print(period < 4 ? "vortex T=2" : "vortex T=8", n, width, scene,
                    runPeriod(scene, period, courant, [period](double t) { return std::cos(M_PI*t/period); }));
            }
        }
        for (int n = 32; with3D && n <= std::min(largest, 64); n *= 2)
        {
            TransportScene scene(MPI_COMM_WORLD, 3, n, width, deformationField());
            scene.fill(disc({0.35, 0.35, 0.35}, 0.15, 3));
            print("deformation 3D", n, width, scene, runPeriod(scene, 3, courant, [](double t) { return std::cos(M_PI*t/3); }));
        }
    }
    MPI_Finalize();
}
