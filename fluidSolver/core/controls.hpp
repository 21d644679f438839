// SPDX-License-Identifier: GPL-3.0-or-later
/// Every number a user may set, with its default. foam/controlsReader reads, checks and prints them from one table.
#pragma once

#include <array>

namespace flotsam
{

/// constant/transportProperties and constant/g
struct FluidProperties
{
    bool isTwoPhase = true;
    double rhoLiquid = 1000, rhoGas = 1;    ///< [kg/m^3]
    double muLiquid = 1e-3, muGas = 1.8e-5; ///< dynamic viscosity [Pa s]
    double sigma = 0;                       ///< surface tension [N/m]; must be 0 for now
    std::array<double, 3> gravity{0, 0, 0}; ///< space frame [m/s^2]
    double pRefValue = 0;                   ///< pressure where no boundary prescribes one: mean in the gas, in the liquid without gas [Pa]
};

/// system/fvSolution, sub-dictionary flotsam
struct NumericsControls
{
    // time
    int timeOrder = 2;              ///< 1: BDF1, 2: BDF2
    int surfaceTimeOrder = 2;       ///< of the inertia where the density changes steeply in time
    // stabilisation (paper eq 5)
    double tauFactor = 0.25;        ///< tau of SUPG and PSPG over Tezduyar's where inertia counts
    double tauContFactor = 1;       ///< multiplies tau_cont
    bool tauContWithTimeStep = true; ///< tau_cont = rho h^2/(12 T), T with the time step (docs/numerics.md), else rho (nu + |a| h/2)
    double penaltyRate = 6;         ///< largest 1/dt in tau_cont and in the walls' normal penalty, over sqrt(g/element length)
    double tauContBulk = 0.1;       ///< share of the time step's rate 2/dt in that T in elements of one density, away from the liquid's surface
    bool viscousResidual = true;    ///< mu lap u in the residual of SUPG, PSPG and u'
    // embedded boundary
    bool nitsche = true;            ///< false: the paper's pure penalty
    double nitscheGamma = 4;        ///< non-symmetric Nitsche: coefficient of mu/h
    double separation = 0.7;        ///< no-slip solids: what they take where an unresolved stream along them slows down, over what the pressure takes
    double wallInflow = 0;          ///< share of the term that gives fluid which enters through a solid's wall the wall's velocity (docs/numerics/3-solids.md, 3.2.1)
    double wallGamma = 16;          ///< nitscheGamma on no-slip patches whose layer is resolved; 0: their velocity is prescribed at the nodes
    bool wallLaw = false;           ///< on no-slip patches at least the traction of a turbulent layer
    double wallRoughness = 0;       ///< sand roughness in the wall law [m]
    double mixingDepth = 0;         ///< depth of the stream whose eddy viscosity is added, see EddyViscosity; 0: none [m]
    double penalty = 1e3;           ///< pure penalty pbar [Pa s/m] (paper eq 5), used when nitsche is false
    double ghostVelocity = 0.05, ghostConvection = 0.01, ghostPressure = 0.05;
    // phase field
    bool dualCellTransport = true;  ///< false: the paper's SUPG form (eq 9)
    double interfaceWidth = 0.2;  ///< delta over local element length
    double mobility = 0;            ///< gamma over |u|max of the optional model flux
    double profileKeeping = 0.3;    ///< rate at which cells above each other come to agree about the surface, over sqrt(g/h)
    double transportCourant = 0.9;  ///< limit of dt sum(outflow)/V of a sub-step
    double densityClip = 0.002;     ///< of alpha at both ends: liquidShare()
    bool balancedGravity = true;    ///< false: rho_e g
    int gravityLayers = 6;          ///< rings over which interface planes are handed on at least
    int gasDepth = 0;               ///< rings of elements around the water in which the gas is computed; 0: everywhere
    bool criticalInlet = true;      ///< a level that floats at an inlet does not fall below the critical one of its discharge
    // linear solver
    double tolerance = 1e-4;        ///< residual of the scaled system over its right-hand side
    double forceTolerance = 1e-4;   ///< with solids or asked forces on patches: the same over the forces that change the motion
    bool carryRemainder = true;     ///< what a solve leaves of inertia and volume goes into the right-hand side of the next step's
    int maxIterations = 200;
    int restart = 100;
    // coupling
    double contactTolerance = 1e-2; ///< relative change of the contact impulse that ends the repeats
    int maxContactRepeats = 8;
    double contactTrial = 0.1;      ///< residual of the solves that a new contact load is likely to follow, over what that load changes
    double demTimeStep = 0;         ///< [s]; 0: chosen from stiffness and masses
};

/// system/controlDict
struct TimeControls
{
    bool adjustTimeStep = true;
    double deltaT = 1e-3;           ///< [s]
    double maxCo = 0.5;             ///< advective Courant number |u| dt/h
    double maxBodyCo = 0.5;         ///< of the bodies' surfaces
    double maxDeltaT = 1e30;        ///< [s]
    double minDeltaT = 1e-9;        ///< a step that would need less ends the run

    bool operator==(const TimeControls& o) const
    {
        return adjustTimeStep == o.adjustTimeStep && deltaT == o.deltaT && maxCo == o.maxCo && maxBodyCo == o.maxBodyCo && maxDeltaT == o.maxDeltaT
            && minDeltaT == o.minDeltaT;
    }
};

} // namespace flotsam
