// SPDX-License-Identifier: GPL-3.0-or-later
/// Backward differentiation with variable step: du/dt at t^(n+1) = c0 u^(n+1) + c1 u^n + c2 u^(n-1).
#pragma once

namespace flotsam
{

struct TimeScheme
{
    double dt = 0;              ///< [s]
    double c0 = 0, c1 = 0, c2 = 0;  ///< [1/s]
    double extrapolation = 0;   ///< e in u* = (1+e) u^n - e u^(n-1), the advecting velocity at t^(n+1)

    /// order 1 or 2; the first step of a run is order 1 (dtOld = 0).
    static TimeScheme bdf(int order, double dt, double dtOld)
    {
        TimeScheme s;
        s.dt = dt;
        if (order == 1 || dtOld <= 0)
        {
            s.c0 = 1/dt;
            s.c1 = -1/dt;
            return s;
        }
        const double r = dt/dtOld;
        s.c0 = (1 + 2*r)/((1 + r)*dt);
        s.c1 = -(1 + r)/dt;
        s.c2 = r*r/((1 + r)*dt);
        s.extrapolation = r;
        return s;
    }
};

} // namespace flotsam
