# SPDX-License-Identifier: GPL-3.0-or-later
"""Torque-free tumbling of a box with three different moments of inertia, ten seconds."""
import numpy as np

from runner import foam
from runner.cases import Run
from support import gas
from support.compare import small

title = """Box 0.20 x 0.06 x 0.02 m (590 kg/m3) spinning at (3, 0, 4) rad/s without weight in a gas of 1e-4 kg/m3, 10 s (4.6 periods of its tumbling). Exact: Jacobi elliptic functions.
Two caps of the time step show its order."""

runs = [Run("flotsamFoam", 1, f"dt {dt:g} s", {"dt": dt}, quick=dt == 0.01, timeLimit=2400) for dt in (0.01, 0.005, 0.0025)]


def resolution(_run):
    return "12 x 12 x 12 cells"


def files(run, _folder):
    text = """bodies
{
    box { shape { type box; size (0.2 0.06 0.02); } density 590; position (0 0 0); angularVelocity (3 0 4); }
}"""
    return gas.files(((-0.15, 0.15),) * 3, (12, 12, 12), (0, 0, 0), text, 10, run.options["dt"])


def _toBody(q, v):
    """Vectors v in space, seen from the frames q (w x y z)."""
    w, u = q[:, :1], -q[:, 1:]
    return v + 2 * np.cross(u, np.cross(u, v) + w * v)


def errors(_run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    table = foam.reference(root, "asymmetricTop")      # noqa: F821
    body = history["box"]
    spin = _toBody(body.orientation, body.angularVelocity)
    own = np.stack([np.interp(table[:, 0], history.time, spin[:, d]) for d in range(3)], axis=1)
    q = np.stack([np.interp(table[:, 0], history.time, _continuous(body.orientation)[:, d]) for d in range(4)], axis=1)
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    turned = np.degrees(2 * np.arccos(np.minimum(1, np.abs((q * table[:, 4:8]).sum(axis=1)))))
    inertia = np.array([4.72e-5, 0.00047672, 0.00051448])
    energy = 0.5 * (inertia * spin**2).sum(axis=1)
    momentum = np.linalg.norm(inertia * spin, axis=1)
    return {"comparisons": [
        small("attitude, largest error", turned.max(), 2, "degrees", "exact"),
        small("angular velocity in the body, largest error over 5 rad/s", np.abs(own - table[:, 1:4]).max() / 5, 0.01, "", "exact"),
        small("energy, largest change", np.abs(energy / energy[0] - 1).max(), 1e-3, "", "exact"),
        small("angular momentum, largest change", np.abs(momentum / momentum[0] - 1).max(), 1e-3, "", "exact"),
        small("drift of the centre", np.abs(body.position).max(), 1e-6, "m", "exact")]}


def _continuous(q):
    """Signs chosen so that neighbours in time are near each other."""
    same = np.sign((q[1:] * q[:-1]).sum(axis=1))
    return q * np.r_[1, np.cumprod(same)][:, None]
