// SPDX-License-Identifier: GPL-3.0-or-later
/// Error, cost and conservation of the phase transport: Zalesak's disc (one turn), the reversed vortex, a reversed deformation in 3D.
/// usage: transportTable [largest n, default 128 [3D: yes or no, default no [Courant number, default 0.5 [delta/h, default the program's [case [meshes]]]]]]
/// With a case ("zalesak", "vortex T=2", "vortex T=4", "vortex T=8", "deformation 3D") only this one, on n cells a side only; on several meshes, whose nodes are moved
/// otherwise, a line for each and, last, means (of alpha the extremes).
#include "support/transportScene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

using namespace flotsam;

namespace
{

struct Problem
{
    std::string name;
    int dim, smallest, largest;     ///< n without a case given
    double period, fastest;         ///< fastest: speed of the Courant number, 0: the field's largest
    VelocityField field;
    LiquidShape liquid;
    bool isReversed;                ///< by cos(pi t/period)
};

std::vector<Problem> problems()
{
    std::vector<Problem> all{{"zalesak", 2, 32, 1 << 20, 2*M_PI, 1, rotationField(), slottedDisc(), false}};
    for (const int period : {2, 4, 8})
    {
        all.push_back({"vortex T=" + std::to_string(period), 2, 32, 1 << 20, double(period), 0, vortexField(), disc({0.5, 0.75, 0}, 0.15, 2), true});
    }
    all.push_back({"deformation 3D", 3, 16, 64, 3, 0, deformationField(), disc({0.35, 0.35, 0.35}, 0.15, 3), true});
    return all;
}

TransportResult resultOf(const Problem& problem, int n, double width, double courant, int seed)
{
    TransportScene scene(MPI_COMM_WORLD, problem.dim, n, width, problem.field, seed);
    if (problem.fastest > 0)
    {
        scene.fastest = problem.fastest;
    }
    scene.fill(problem.liquid);
    return runPeriod(scene, problem.period, courant, [&problem](double t) { return problem.isReversed ? std::cos(M_PI*t/problem.period) : 1; });
}

void print(const Problem& problem, int n, double width, const TransportResult& r)
{
    int rank;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (rank != 0)
    {
        return;
    }
    std::printf("%-14s n %4d delta %.2f | error %.4f mass %+.1e redistributed %.1e alpha [%.1e, 1%+.1e] limited %ld "
                "| %.3f us/node/step, %d steps, band %.3f roof %.3f\n", problem.name.c_str(), n, width, r.error, r.massError,
        r.redistributed, r.lowest, r.highest - 1, r.limited, 1e6*r.secondsPerNodeStep, r.steps, r.bandShare, r.roofShare);
    std::fflush(stdout);
}

/// Mean of the errors and costs, extremes of what must not happen.
TransportResult summary(const std::vector<TransportResult>& all)
{
    TransportResult mean = all.front();
    const auto average = [&](auto TransportResult::*figure)
    {
        mean.*figure = 0;
        for (const TransportResult& r : all) mean.*figure += r.*figure/double(all.size());
    };
    for (auto figure : {&TransportResult::error, &TransportResult::redistributed, &TransportResult::secondsPerNodeStep, &TransportResult::bandShare,
             &TransportResult::roofShare})
    {
        average(figure);
    }
    for (const TransportResult& r : all)
    {
        mean.massError = std::abs(r.massError) > std::abs(mean.massError) ? r.massError : mean.massError;
        mean.lowest = std::min(mean.lowest, r.lowest);
        mean.highest = std::max(mean.highest, r.highest);
    }
    return mean;
}

void run(const Problem& problem, int n, double width, double courant, int nMeshes = 1)
{
    std::vector<TransportResult> all;
    for (int seed = 0; seed < nMeshes; ++seed)
    {
        all.push_back(resultOf(problem, n, width, courant, seed));
        print(problem, n, width, all.back());
    }
    if (nMeshes > 1)
    {
        print(problem, n, width, summary(all));
    }
}

} // namespace

int main(int argc, char** argv)
{
    MPI_Init(&argc, &argv);
    const int largest = argc > 1 ? std::atoi(argv[1]) : 128;
    const bool with3D = argc > 2 && std::string(argv[2]) == "yes";
    const double courant = argc > 3 ? std::atof(argv[3]) : 0.5;
    const double width = argc > 4 ? std::atof(argv[4]) : NumericsControls().interfaceWidth;
    const std::string only = argc > 5 ? argv[5] : "";
    const int nMeshes = argc > 6 ? std::max(1, std::atoi(argv[6])) : 1;
    for (const Problem& problem : problems())
    {
        if (problem.name == only)
        {
            run(problem, largest, width, courant, nMeshes);
        }
        for (int n = problem.smallest; only.empty() && n <= std::min(largest, problem.largest) && (problem.dim == 2 || with3D); n *= 2)
        {
            run(problem, n, width, courant);
        }
    }
    MPI_Finalize();
}
