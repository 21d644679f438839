# SPDX-License-Identifier: GPL-3.0-or-later
"""Logs that a stream carries to a rack: shape of their jam and backwater rise over the Froude number. N: elements over a log's diameter."""
import numpy as np

from runner import foam
from runner.cases import Run
from support import jam, rackCase
from support.compare import Comparison, relative, small

SCHALKO, PITON = "Schalko et al. 2018, 2019, recalled", "Piton et al. 2020"
G, PITCH, NLOGS = 9.81, 0.10, 64
BAR, (DEPTH, WIDTH, HEIGHT, UPSTREAM, DOWNSTREAM) = rackCase.BAR, (rackCase.CHANNEL[i] for i in ("depth", "width", "height", "upstream", "downstream"))
FIRST, LAST = 2.0, 3.0          # the first log comes in [s]; means of the jam are over the last seconds
REACH = -1.85, -1.45            # whose mean depth is taken [m]: upstream of the carpet
FACTOR, OVERLAP = 1.5, 1e-3

#           Froude number at the outlet's depth, density of the logs, seed of their places
VARIANTS = {"F 0.20": (0.20, 600, 1), "F 0.36": (0.36, 600, 1), "F 0.36, other places": (0.36, 600, 2), "F 0.36, heavy logs": (0.36, 900, 1), "F 0.55": (0.55, 600, 1),
            "F 0.55, other places": (0.55, 600, 2)}

title = f"""tutorials/debrisRack with other parameters: channel {WIDTH:g} m wide, {DEPTH:g} m deep at the outlet, rack of four no-slip bars {BAR:g} m thick, {PITCH:g} m apart, {NLOGS} logs of
0.032 m x 0.16 m, 600 kg/m3 (heavy: 900), which come in one after the other 1.45 to 1.8 m upstream. Means over the last {LAST:g} s; clean: over the second before the first log. Depth upstream: mean over
{-REACH[0]:g} to {-REACH[1]:g} m; that of the clean rack, and the rise "from the force", by the momentum theorem from the force on rack, bed and sides and the outlet's depth: two seconds are
short for a level, and under a jam water runs in a jet, which is not even again at the outlet. Rise: over the depth of the clean rack. Published: h0 f 5.4 F0 (Vs/Vc)^(1/3)/a^(4/3), f 0.55 (natural
accumulations), Vc 3.1 F0 B h0^2, Vs/Vc at most 1, h0 and F0 upstream of the clean rack, Vs the wood held, a its bulk factor: volume between upper and lower envelope (of columns one log
diameter wide, mean across those that have logs) over that of the wood. Target: a factor of {FACTOR:g}, stated before the runs: their data scatter by 30 %, a by as much, equal tests by a
quarter. Thickness: at the rack, mean over a log's length. Buoyancy over drag of a log across the stream: (1 - rho_log/rho) g pi/4 D^2 L over 0.6 U^2 D L."""
runs = [Run("flotsamFoam", 2, name, quick=name == "F 0.55", timeLimit=7200) for name in VARIANTS]


def resolution(run):
    return f"{run.n} a diameter"


# --- the case: that of the tutorial ---------------------------------------------------------------------------------------

def _speed(run):
    return VARIANTS[run.variant][0] * (G * DEPTH)**0.5


def _logs(run):
    return jam.Logs(0.032, 0.16, VARIANTS[run.variant][1])


def files(run, _folder):
    """But system/parameters."""
    return rackCase.files(root, VARIANTS[run.variant][2], _end(run))    # noqa: F821 (root is set by the runner)


def _end(run):
    """5 s after the last log may have come to the rack."""
    return FIRST + NLOGS * _interval(run) + 1.8 / _speed(run) + 5


def _interval(run):
    """Between the logs: that of the tutorial, as the stream carries them away."""
    return 0.05 * rackCase.TUTORIAL_SPEED / _speed(run)


def parameters(run):
    speed, logs = _speed(run), _logs(run)
    return rackCase.parameters(root, {      # noqa: F821
        "discharge": f"{speed * WIDTH * DEPTH:.6g}", "nBars": 4, "pitch": PITCH,
        "nLogs": NLOGS, "logDiameter": logs.diameter, "logLength": logs.length, "logDensity": logs.density, "firstRelease": FIRST,
        "releaseInterval": f"{_interval(run):.4g}"}, run.n / 2)


prepare = rackCase.prepare


# --- published --------------------------------------------------------------------------------------------------------

def _kirschmer(speed):
    """Loss of head at the clean rack [m]."""
    return 1.79 * (BAR / (PITCH - BAR))**(4 / 3) * speed**2 / (2 * G)


def _schalko(speed, depth, wood, bulk):
    """Backwater rise [m] of a natural accumulation of logs without organic fine material."""
    froude = speed / (G * depth)**0.5
    characteristic = 3.1 * froude * WIDTH * depth**2
    return depth * 0.55 * 5.4 * froude * min(1, wood / characteristic)**(1 / 3) / bulk**(4 / 3)


# --- evaluation -------------------------------------------------------------------------------------------------------

def errors(run, case):
    reader = foam.resultReader(root)    # noqa: F821
    import driftwood    # these two are beside the reader, whose folder is in the path now
    import momentum
    h = reader.history(case)
    spans = {"clean": (FIRST - 1, FIRST), "jammed": (h.time[-1] - LAST, h.time[-1])}
    held, passed = rackCase.held(h, driftwood, _speed(run))
    shape = _shape(run, h, driftwood, held)
    times = [t for t in reader.times(case) if t > 0]
    levels = np.array([driftwood.reachDepth(case, t, *REACH, HEIGHT) for t in times])
    force = _force(h, driftwood, momentum)
    level = {name: _mean(np.array(times), levels, span) for name, span in spans.items()}
    balance = {name: _depthUpstream(_speed(run), _mean(h.time, force, span)) for name, span in spans.items()}
    return {"comparisons": [*_jam(run, shape, held, passed), *_backwater(run, level, balance, shape, held),
                            small("deepest overlap of a contact", h.run["largestOverlap"].max(), OVERLAP, "m"),
                            small("water made or lost, over the largest volume", driftwood.massError(h), driftwood.MASS)]}


def _shape(run, h, driftwood, held):
    bodies = [h["bodies/" + name] for name, stays in zip(h.bodies, held) if stays]
    directions = driftwood.turned(np.array([b.orientation[-1] for b in bodies]), np.array([1.0, 0, 0]))
    return jam.shape(_logs(run), np.array([b.position[-1] for b in bodies]), directions, WIDTH)


def _force(h, driftwood, momentum):
    """What holds the water back over time [N]: the rack, against water and logs, and bed and sides, which rub on logs."""
    water, logs = (force.sum(0) for force in driftwood.forcesOn(h, h.structures))
    return water + logs - momentum.wallForce(h, momentum.Reach(-UPSTREAM, DOWNSTREAM, WIDTH, HEIGHT))


def _mean(time, values, span):
    """Trapezoidal: steps may differ."""
    chosen = (time > span[0] - 1e-9) & (time < span[1] + 1e-9)
    return np.trapz(values[chosen], time[chosen]) / np.ptp(time[chosen])


def _depthUpstream(speed, force):
    """From the momentum theorem with the depth that the outlet keeps [m], subcritical."""
    q = speed * DEPTH

    def thrust(depth):
        return 1000 * WIDTH * (G * depth**2 / 2 + q**2 / depth)
    depths = np.linspace((q**2 / G)**(1 / 3), 3 * DEPTH, 20001)
    return np.interp(thrust(DEPTH) + force, thrust(depths), depths)


def _head(speed, depth):
    return depth + (speed * DEPTH / depth)**2 / (2 * G)


def _jam(run, shape, held, passed):
    logs, speed = _logs(run), _speed(run)
    thickness = shape.atRack(logs.length)
    return [small("buoyancy over drag of a log", jam.buoyancyToDrag(logs, speed), source=PITON), small("logs held", held.sum()), small("logs that passed", passed.sum()),
            small("length of the jam", shape.length, unit="m"), small("its thickness at the rack", thickness, unit="m"),
            small("the same over a log's diameter: layers", thickness / logs.diameter), small("compactness: thickness at the rack over length", thickness / shape.length),
            small("bulk factor a", shape.bulk(shape.thickness)), small("bulk factor of the jam's outline as seen from the side", shape.bulk(shape.outline))]


def _backwater(run, level, balance, shape, held):
    speed, approach = _speed(run), balance["clean"]
    wood = held.sum() * _logs(run).volume
    rise = level["jammed"] - approach
    expected, seen = (_schalko(speed * DEPTH / approach, approach, wood, shape.bulk(t)) for t in (shape.thickness, shape.outline))
    return [relative("head lost at the clean rack", _head(speed, approach) - _head(speed, DEPTH), _kirschmer(speed), unit="m", source="Kirschmer 1926"),
            small("depth upstream of the clean rack", approach, unit="m"), small("Froude number there", speed * DEPTH / approach / (G * approach)**0.5),
            Comparison("backwater rise", rise, expected, (rise - expected) / expected, unit="m", source=SCHALKO),
            Comparison("the same, factor between the two", max(rise / expected, expected / rise), target=FACTOR, errorUnit="", source=SCHALKO),
            small("the same, over the depth", rise / approach),
            small("the same, from the force", balance["jammed"] - approach, unit="m"),
            small("the same, over the formula with the bulk factor of the outline", rise / seen, source=SCHALKO)]
