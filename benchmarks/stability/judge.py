# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run must fulfil, from the program's own output: bounds that hold for any stable solution, none tuned to a scene."""
import os
import re

import numpy as np

from runner import foam

# figure: (largest allowed, what it is)
BOUNDS = {
    "water": (3, "largest speed of the liquid over that which energy allows; beside bodies heavier than it over their energy in as much liquid"),
    "gas": (10, "largest speed in the gas over the same"),
    "energy": (0.05, "largest rise of the mechanical energy above an earlier value, over the energy there is; scenes without forcing"),
    "alpha": (1e-4, "largest excess of the phase field over 0 and 1"),
    "volume": (1e-6, "liquid made or lost, over the liquid there is"),
    "bodies": (2, "largest speed of a body over that which energy allows"),
    "outside": (0, "bodies whose centre went through a wall"),
    "overlap": (0.1, "deepest overlap of contact surfaces over the thinnest body"),
    "steps": (10, "time steps over those that the Courant number asks for at the speed which energy allows"),
    "rejected": (0.05, "share of steps that were repeated smaller"),
    "fastest": (3, "jam: mean velocity of an element's fluid in any step, over that which energy allows; of gas a quarter"),
    "collapsed": (0, "jam: steps shorter than a hundredth of the median step, other than to meet a write time"),
    "unsolved": (0.01, "share of steps whose linear solve did not converge"),
}


class Cells:
    """Centres and volumes of a structured mesh's cells, from its points (nz x ny x nx x 3)."""

    def __init__(self, points, cells):
        self.points, self.cells = points, cells
        self.n = int(np.prod(cells))
        self.centre = self.inside(0.5, 0.5, 0.5)
        c = self._corners()
        tets = [(0, 1, 3, 7), (0, 1, 5, 7), (0, 2, 3, 7), (0, 2, 6, 7), (0, 4, 5, 7), (0, 4, 6, 7)]
        self.volume = sum(np.abs(np.einsum("ij,ij->i", c[b] - c[a], np.cross(c[p] - c[a], c[q] - c[a]))) / 6 for a, b, p, q in tets)

    def _corners(self):
        """Corner 1 a + 2 b + 4 c of each cell."""
        def part(offset, n):
            return slice(offset, offset + n)
        nx, ny, nz = self.cells
        return [self.points[part(k >> 2, nz), part(k >> 1 & 1, ny), part(k & 1, nx)].reshape(-1, 3) for k in range(8)]

    def inside(self, a, b, c):
        """Points of the cells at the same local coordinates 0 .. 1."""
        weights = [(x if k >> d & 1 else 1 - x) for k in range(8) for d, x in enumerate((a, b, c))]
        corners = self._corners()
        return sum(np.prod(weights[3 * k:3 * k + 3]) * corners[k] for k in range(8))

    def faceHeights(self):
        """y of the faces at x-, in blockMesh's order."""
        nx, ny, nz = self.cells
        y = self.inside(0, 0.5, 0.5).reshape(nz, ny, nx, 3)[:, :, 0, 1]
        return y.T.reshape(-1) if nz > 1 else y.reshape(-1)


def figures(s, mesh, root, folder):
    """{figure: value} of a finished run, `failed`: names of those beyond their bounds."""
    found = {**_fields(s, mesh, root, folder), **_history(s, root, folder), **_log(s, folder)}
    limits = {name: limit for name, (limit, _) in BOUNDS.items()}
    found["failed"] = [name for name, limit in limits.items() if name in found and not found[name] <= limit]     # nan fails
    return found


def _times(folder):
    names = [n for n in os.listdir(folder) if re.fullmatch(r"\d[\d.eE+-]*", n) and os.path.isfile(os.path.join(folder, n, "U"))]
    return sorted(names, key=float)


def _cellValues(path, n):
    values = foam.field(path)
    return np.broadcast_to(values, (n, 3) if values.shape == (3,) else (n,)) if values.ndim < 1 + (os.path.basename(path) == "U") else values


def _fields(s, mesh, root, folder):
    water, gas, excess, liquid, energies, times = 0.0, 0.0, 0.0, 0.0, [], []
    for name in _times(folder):
        where = os.path.join(folder, name)
        u = _cellValues(os.path.join(where, "U"), mesh.n)
        alpha = np.ones(mesh.n) if s.oneFluid else _cellValues(os.path.join(where, "alpha.water"), mesh.n)
        solid = _cellValues(os.path.join(where, "solid"), mesh.n) if os.path.isfile(os.path.join(where, "solid")) else np.zeros(mesh.n)
        speed = np.linalg.norm(u, axis=1)
        if not (np.isfinite(speed).all() and np.isfinite(alpha).all()):
            return {"water": np.nan, "alpha": np.nan}
        isFluid = solid < 0.999
        water = max(water, speed[isFluid & (alpha > 0.5)].max(initial=0))
        gas = max(gas, speed[isFluid].max(initial=0))
        if os.path.isfile(os.path.join(where, "pointAlpha")):
            point = foam.field(os.path.join(where, "pointAlpha"))
            excess = max(excess, point.max() - 1, -point.min())
        liquid = max(liquid, float((mesh.volume * (1 - solid) * alpha).sum()))
        if float(name) == 0 and (s.bodies or s.structures):
            continue        # without the solids' fraction
        times.append(float(name))
        energies.append(_energy(s, mesh, u, alpha, solid))
    result = {"water": water / _liquidSpeed(s), "gas": gas / s.speed, "alpha": excess}
    if not s.forced and energies:
        total = np.array(energies) + _bodyEnergy(s, root, folder, times)
        result["energy"] = float((total - np.minimum.accumulate(total)).max() / _available(s, liquid))
    return result


def _energy(s, mesh, u, alpha, solid):
    """Kinetic energy of both fluids, potential energy of the liquid as far as it is heavier than the gas [J]."""
    v = mesh.volume * (1 - solid)
    rho = s.rho[0] * alpha + (0 if s.oneFluid else s.rho[1]) * (1 - alpha)
    outweighs = 0 if s.oneFluid else s.rho[0] - s.rho[1]
    return float((v * (0.5 * rho * (u**2).sum(axis=1) - outweighs * alpha * (mesh.centre @ s.gravity))).sum())


def _liquidSpeed(s):
    """What energy allows the liquid: a body heavier than it squeezes it out of the gap that it closes, and hands it its own energy per volume [m/s]."""
    return s.speed * np.sqrt(max([1] + [b.density / s.rho[0] for b in s.bodies]))


def _around(s):
    """Density of the fluid whose weight does not count [kg/m3]."""
    return s.rho[0] if s.oneFluid else s.rho[1]


def _bodyEnergy(s, root, folder, times):
    total = np.zeros(len(times))
    if not s.bodies:
        return total
    history = foam.history(root, folder)
    for b in s.bodies:
        m = history[b.name]
        mass = m.mass
        speed2 = sum(np.interp(times, history.time, m.velocity[:, d])**2 for d in range(3))
        height = sum(np.interp(times, history.time, m.position[:, d]) * s.gravity[d] for d in range(3))
        spin2 = sum(np.interp(times, history.time, m.angularVelocity[:, d])**2 for d in range(3))
        total += 0.5 * mass * speed2 - (mass - _around(s) * m.volume) * height + 0.5 * mass * spin2 * (0.5 * b.radius * s.length)**2
    return total


def _available(s, liquid):
    """Energy scale: all the mass there is at the speed that energy allows [J]."""
    mass = s.rho[0] * liquid + sum(b.density * b.volume * s.length**3 for b in s.bodies)
    return 0.5 * mass * s.speed**2


def _history(s, root, folder):
    history = foam.history(root, folder)
    run = history.run
    volume = np.abs(run["massError"]).max() if not s.oneFluid and not s.isFull else 0   # a tank without gas: liquid fills what the cut bodies leave, whose volume varies with their place
    steps = len(history.time) - 1
    courant = min(s.maxCo, 0.5) if s.bodies or any(hasattr(x, "motion") for x in s.structures) else s.maxCo
    asked = s.endTime / (courant * s.h / s.speed) + 50
    found = {"volume": float(volume), "steps": steps / asked}
    if not s.bodies:
        return found
    found["overlap"] = float(run["largestOverlap"].max()) / min(b.thin * s.length for b in s.bodies)
    found["bodies"] = max(float(np.linalg.norm(history[b.name].velocity, axis=1).max()) for b in s.bodies) / s.speed
    found["outside"] = sum(_wentThrough(s, history[b.name].position) for b in s.bodies)
    return found


def _wentThrough(s, x):
    """Whether a body's centre is beyond a wall before it is beyond an opening."""
    at = x - np.outer(x[:, 1] * s.slant, [1, 0, 0])
    for place in at:
        if (s.openTop and place[1] > s.size[1]) or (s.inflow and not 0 < place[0] < s.size[0]):
            return False
        if any(not 0 <= place[d] <= s.size[d] for d in range(s.dim)):
            return True
    return False


def _log(s, folder):
    with open(os.path.join(folder, "log.solver"), encoding="utf-8", errors="replace") as file:
        text = file.read()
    steps = int(re.search(r"Summary: (\d+) steps", text).group(1))
    count = {name: int(re.search(name + r"\s+(\d+)", text).group(1)) for name in ("rejected steps", "non-converged linear solves")}
    ofSteps = _steps(s, text) if s.family == "jam" else {}
    return {**ofSteps, "rejected": count["rejected steps"] / max(steps, 20), "unsolved": count["non-converged linear solves"] / max(steps, 20)}


STEP = re.compile(r"^ +\d+ +([\d.eE+-]+) +([\d.eE+-]+) +(\w+) .*?\| +\S+ +([\d.eE+-]+) ", re.MULTILINE)
START = 0.05        # of the time: bars that are put into moving water


def _steps(s, text):
    """From the line of every step: what the few written fields miss."""
    lines = STEP.findall(text)
    time, dt, courant = (np.array([float(line[k]) for line in lines]) for k in (0, 1, 3))
    isChosen, isLate = np.array([line[2] != "write" for line in lines]), time > START * s.endTime
    isShort = isChosen & (dt < 0.01 * np.median(dt))
    return {"fastest": float((courant / dt)[isLate].max(initial=0)) * s.h / s.speed, "collapsed": int(isShort.sum())}
