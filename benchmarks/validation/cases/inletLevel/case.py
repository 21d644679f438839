# SPDX-License-Identifier: GPL-3.0-or-later
"""A uniform stream stays uniform behind an inlet, whatever form of inlet brings it. N: elements over the depth."""
import math

import numpy as np

from runner.cases import Run
from support import channel
from support.compare import relative
from support.files import bodies, control, fixed, gravity, merged, referenceHeight

DEPTH, SPEED, LENGTH, HEIGHT = 2.0, 2.0, 30.0, 4.0
END, INTERVAL = 6.0, 0.5
SILL, SILL_END, SILL_INTERVAL, LATE = 1.0, 60.0, 1.0, 30.0     # height [m]; from LATE on the surge of the start has left the channel
SLOPE, SLOPE_END, SLOPE_LATE, DOWN = 0.05, 30.0, 20.0, 20.0     # of the bed; downstream of the inlet [m]
CRITICAL = ((SPEED * DEPTH)**2 / (channel.G * math.cos(math.atan(SLOPE))))**(1 / 3)      # depth on that bed [m]


def dammed():
    """Level upstream of the sill that has the head of the critical depth on it, above DEPTH [m]; by iteration."""
    discharge = SPEED * DEPTH
    head = SILL + 1.5 * (discharge**2 / channel.G)**(1 / 3)
    depth = head
    for _ in range(60):
        depth = head - (discharge / depth)**2 / (2 * channel.G)
    return depth - DEPTH


def steepDepth():
    """DOWN metres behind the critical depth on the steep bed, with the same head [m]; the supercritical one, by iteration."""
    g = channel.G * math.cos(math.atan(SLOPE))
    head = 1.5 * CRITICAL + DOWN * SLOPE
    depth = 0.5 * CRITICAL
    for _ in range(60):
        depth = SPEED * DEPTH / math.sqrt(2 * g * (head - depth))
    return depth


title = f"""A stream of {SPEED:g} m/s, {DEPTH:g} m deep (Froude number 0.45), in a horizontal slip channel of {LENGTH:g} m under gas, 2D; at its end p_rgh of that level. Greatest and least depth in a column of cells, all along the channel, every
{INTERVAL:g} s until {END:g} s; reference: {DEPTH:g} m, a uniform stream is a solution. Inlets: default: the level floats (variableHeightFlowRate, upperBound 0.99); upperBound 0.9: the same with that; below a wall: the discharge is given (flowRateInletVelocity)
through a patch that ends at the level, with a wall above it; profile: the velocity is given all over the patch, the gas too, with alpha a profile. The targets are for the first and the last of them, those that docs/dictionaries.md advises.
sill: a box {SILL:g} m high and 3 m long, 18.5 m downstream; level at the inlet every {SILL_INTERVAL:g} s from {LATE:g} to {SILL_END:g} s; reference: head of the critical depth on the sill ({dammed():+.3f} m), with nothing lost in front of it.
steep: the same start on a bed of {SLOPE:g} (gravity is tilted), a free overfall at its end; mean depths from {SLOPE_LATE:g} to {SLOPE_END:g} s at the inlet (critical: {CRITICAL:.3f} m) and {DOWN:g} m downstream (same head: {steepDepth():.3f} m)."""

FORMS = {"": 0.0025, "upperBound 0.9": None, "below a wall": None, "profile": 0.001}      # forms of the inlet, and the largest error of the depth allowed
runs = [*(Run("flotsamFoam", n, form, quick=(n == 5 and form == ""), options={"form": form}) for form in FORMS for n in (5, 10, 20)),
        *(Run("flotsamFoam", 10, f"{form} sill".strip(), options={"form": form, "sill": True}) for form in ("", "upperBound 0.9", "below a wall")),
        *(Run("flotsamFoam", n, "steep", options={"form": "", "steep": True}) for n in (5, 10, 20))]


def resolution(run):
    return f"{run.n} over the depth"


def _profile(h):
    return channel.entering([0.5 * (1 + math.tanh((DEPTH - z) / (0.2 * h))) for z in channel.heights(HEIGHT, h)])


def _inlet(form, h):
    """(U, alpha.water)"""
    flow, start = SPEED * DEPTH * h, f"value uniform ({SPEED:g} 0 0);"
    if form == "profile":
        return fixed(f"({SPEED:g} 0 0)"), _profile(h)
    if form == "below a wall":
        return f"type flowRateInletVelocity; volumetricFlowRate constant {flow:.9g}; {start}", fixed(1)
    bound = 0.9 if form == "upperBound 0.9" else 0.99
    return f"type variableHeightFlowRateInletVelocity; flowRate {flow:.9g}; alpha alpha.water; {start}", f"type variableHeightFlowRate; lowerBound 0; upperBound {bound}; value uniform 0;"


def files(run, _folder):
    h, form, hasSill, isSteep = DEPTH / run.n, run.options["form"], run.options.get("sill"), run.options.get("steep")
    isWalled = form == "below a wall"
    pressure = "type prghTotalPressure; p0 uniform 0; value uniform 0;" if isSteep else fixed(0)
    outlet = ("patch", "type pressureInletOutletVelocity; value uniform (0 0 0);", pressure, "type inletOutlet; inletValue uniform 0; value uniform 0;")
    sill = bodies(f"structures {{ sill {{ shape {{ type box; size (3 4 {2 * SILL:g}); }} position (20 0 0); wall slip; }} }}")
    angle = math.atan(SLOPE)
    tilted = gravity(x=channel.G * math.sin(angle), z=-channel.G * math.cos(angle))
    return merged(
        channel.files(LENGTH, HEIGHT, h, DEPTH, SPEED, outlet, _inlet(form, h), ("bed", "inletWall") if isWalled else ("bed",)),
        channel.wallAboveInlet(DEPTH) if isWalled else {}, sill if hasSill else {},
        tilted if isSteep else referenceHeight(DEPTH),
        control(SILL_END if hasSill else SLOPE_END if isSteep else END, 0.005, writeInterval=SILL_INTERVAL if hasSill or isSteep else INTERVAL))


def prepare(run, do):
    do("blockMesh")
    if run.options["form"] == "below a wall":
        do("topoSet")
        do("createPatch", "-overwrite")
    do("setFields")


def errors(run, case):
    h = DEPTH / run.n
    time, depth = channel.depths(case, round(LENGTH / h), h)
    if run.options.get("sill"):
        level, bound = depth[time >= LATE, 0] - DEPTH, 0.03 if run.variant == "sill" else None
        found = {"mean level at the inlet": level.mean(), "highest level at the inlet": level.max(), "lowest level at the inlet": level.min()}
        return {"comparisons": [relative(name, value, dammed(), bound, "m", "critical depth on the sill") for name, value in found.items()]}
    if run.options.get("steep"):
        late = depth[time >= SLOPE_LATE].mean(axis=0)
        places = (("depth at the inlet", late[0], CRITICAL, 0.05), (f"depth {DOWN:g} m downstream", late[round(DOWN / h)], steepDepth(), 0.05))
        return {"comparisons": [relative(name, value, reference, bound, "m", "same head") for name, value, reference, bound in places]}
    bound = FORMS[run.options["form"]]
    return {"comparisons": [relative(name, value, DEPTH, bound, "m", "uniform stream") for name, value in (("greatest depth", depth.max()), ("least depth", depth.min()))]}
