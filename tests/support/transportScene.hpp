// SPDX-License-Identifier: GPL-3.0-or-later
/// A box with a prescribed velocity field: what the verification and the benchmark of the phase transport share.
#pragma once

#include "equations/dualCellTransport.hpp"
#include "support/boxMesh.hpp"

#include <array>
#include <functional>

namespace flotsam
{

using Point = std::array<double, 3>;

/// Width of the interface over the element size where no test needs another: the program's default.
inline const double defaultWidth = NumericsControls().interfaceWidth;

/// Signed distance to a liquid body [m], negative inside.
using LiquidShape = std::function<double(const Point&)>;
using VelocityField = std::function<Point(const Point&)>;

struct TransportScene
{
    NumericsControls controls;
    SimplexMesh mesh;
    NodeGraph graph;
    Halo halo;
    DualCellTransport transport;
    std::vector<double> volume;             ///< of the dual cells
    std::vector<double> velocity, fineScale;///< at unit amplitude; together divergence-free as the flow solver's are
    std::vector<double> alpha;
    std::vector<BoundaryPatch> patches;     ///< given velocity; gas enters
    std::vector<PatchValues> values;
    double fastest = 0;                     ///< largest speed at unit amplitude

    /// Unit square or cube with n cells a direction, interior nodes moved by 0.15 cells; seed: other moves.
    TransportScene(MPI_Comm comm, int dim, int n, double width, const VelocityField& field, int seed = 0);

    Point point(int i) const;

    /// alpha = mean of 1/(1+exp(distance/width)) over the dual cells.
    void fill(const LiquidShape& shape);

    /// One step with amplitude times the field.
    TransportReport advance(double dt, double amplitude);

    /// int |alpha - reference| over int reference.
    double distanceTo(const std::vector<double>& reference) const;

private:
    std::vector<double> imbalance(double& size) const;
    void makeDivergenceFree();
    std::vector<double> scaledVelocity_, scaledFineScale_;
};

/// What a run through a whole period left.
struct TransportResult
{
    double error = 0;           ///< int |alpha - start| / int start
    double massError = 0;       ///< relative change of int alpha, apart from what crossed the boundary
    double redistributed = 0;   ///< largest of a step, relative
    double lowest = 0, highest = 1;
    long limited = 0;
    int steps = 0;
    double secondsPerNodeStep = 0;
    double bandShare = 0, roofShare = 0;
};

/// `steps` equal steps over `period`, amplitude(t) at the middle of each.
TransportResult runPeriod(TransportScene& scene, double period, double courant, const std::function<double(double)>& amplitude);

/// The classical cases on the unit square and cube.
VelocityField vortexField();            ///< Rider & Kothe 1998, stream function sin^2 sin^2 / pi; reversed by cos(pi t/T)
VelocityField rotationField();          ///< angular velocity 1 about the centre (2D: z)
VelocityField deformationField();       ///< LeVeque 1996, 3D
LiquidShape disc(const Point& centre, double radius, int dim);
LiquidShape slottedDisc();              ///< Zalesak 1979: radius 0.15 at (0.5, 0.75), slot 0.05 wide up to 0.85

} // namespace flotsam
