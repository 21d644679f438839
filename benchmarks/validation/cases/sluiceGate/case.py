# SPDX-License-Identifier: GPL-3.0-or-later
"""Free flow under a sluice gate: contraction of the jet behind its sharp edge. N: elements over the opening."""
import os

import numpy as np

from runner import foam
from runner.cases import Run
from support.compare import relative, small
from support.files import around, blockMesh, bodies, control, dictionary, even, field, gravity, merged, twoFluids

G, OPENING, DEPTH, HEIGHT, THICK, END, LATE = 9.81, 0.06, 0.3, 0.42, 0.015, 5.0, 2.25
FREE_STREAMLINE = 0.61      # of the opening, upstream 4 to 6 times as deep
DISCHARGE = 0.617 * OPENING * np.sqrt(2 * G * DEPTH / (1 + 0.617 * OPENING / DEPTH))     # [m^2/s]
PLACES = {"": 0.5, "nearer": 0.15, "beyond": 0.9}   # edge of the gate from a node, in elements

title = f"""{DISCHARGE:.4f} m2/s under a gate {THICK} m thick, opening about {OPENING} m (a node, and half an element more; 0.15 and 0.9 in the variants nearer and beyond; patch: the gate left out of the mesh, its edge on a node), about {DEPTH} m deep in
front of it, 2D, slip walls. Depth of the jet 1.7 to 5 openings behind the gate's edge, means from {LATE} to {END:g} s; free-streamline theory: {FREE_STREAMLINE} of the opening. Nothing takes energy: the jet's mean head is that in front of the gate."""

runs = [Run("flotsamFoam", n, kind, quick=(n == 8 and kind == ""), timeLimit=2400) for n in (8, 16) for kind in ("", "nearer", "beyond", "patch")]


def resolution(run):
    return f"{run.n} over the opening"


def _beyond(run):
    """Of the edge, from a node [m]."""
    return PLACES.get(run.variant, 0) * OPENING / run.n


def _axes(run):
    h = OPENING / run.n
    return around(-0.9, -0.15, 0.3, 0.6, h, 1.08), around(0, 0, 1.5 * OPENING, HEIGHT, h, 1.08)


def _mesh(run):
    x, z = _axes(run)
    files = blockMesh(x, even(0, OPENING / run.n, 1), z, {"inlet": ("patch", "x-"), "outlet": ("patch", "x+"), "bed": ("wall", "z-"), "atmosphere": ("patch", "z+"), "frontAndBack": ("empty", "y- y+")})
    if run.variant == "patch":
        text = files["system/blockMeshDict"]
        end = text.rindex(");")
        files["system/blockMeshDict"] = text[:end] + "    gate { type wall; faces (); }\n);\n"
    return files


def files(run, _folder):
    gate = {"gate": "slip"} if run.variant == "patch" else {}
    pressure, zero = "type fixedFluxPressure; value uniform 0;", "value uniform (0 0 0);"
    air = {"outlet": f"type pressureInletOutletVelocity; {zero}", "atmosphere": f"type pressureInletOutletVelocity; {zero}"}
    past = _beyond(run)
    plate = bodies(f"""structures
{{
    gate {{ shape {{ type box; size ({THICK} 1 1); centre ({THICK / 2 + past:.9g} 0 {OPENING + 0.5 + past:.9g}); }} wall slip; }}
}}""")
    return merged(
        _mesh(run),
        field("U", {"inlet": f"type variableHeightFlowRateInletVelocity; alpha alpha.water; flowRate {DISCHARGE * OPENING / run.n:.9g}; {zero}", "bed": "slip", "frontAndBack": "empty", **air, **gate}),
        field("p_rgh", {"inlet": pressure, "bed": pressure, "frontAndBack": "empty", **{p: pressure for p in gate},
                        **{p: "type totalPressure; p0 uniform 0; value uniform 0;" for p in air}}),
        field("alpha.water", {"inlet": "type variableHeightFlowRate; lowerBound 0; upperBound 0.9; value uniform 0;", "bed": "zeroGradient", "frontAndBack": "empty", **{p: "zeroGradient" for p in gate},
                              **{p: "type inletOutlet; inletValue uniform 0; value uniform 0;" for p in air}}),
        {"system/setFieldsDict": dictionary("setFieldsDict", f"""defaultFieldValues (volScalarFieldValue alpha.water 0);
regions ( boxToCell {{ box (-10 -1 -1) (0 1 {DEPTH}); fieldValues (volScalarFieldValue alpha.water 1); }} );"""),
         "system/topoSetDict": dictionary("topoSetDict", f"""actions
(
    {{ name fluid; type cellSet; action new; source boxToCell; box (0 -1 {OPENING}) ({THICK} 1 9); }}
    {{ name fluid; type cellSet; action invert; }}
);""")},
        twoFluids(), gravity(z=-G), {} if gate else plate, control(END, 0.001, writeInterval=0.25, functions="""    centres { type writeCellCentres; libs (fieldFunctionObjects); writeControl onEnd; }
    volumes { type writeCellVolumes; libs (fieldFunctionObjects); writeControl onEnd; }"""))


def prepare(run, do):
    do("blockMesh")
    if run.variant == "patch":
        do("topoSet")
        do("subsetMesh", "-overwrite", "-patch", "gate", "fluid")
    do("setFields")


def _depths(case, low, high):
    """Between two x [m]: mean depth at the late times."""
    times = [t for t in os.listdir(case) if t[0].isdigit() and LATE <= float(t)]
    last = max(times, key=float)
    centre, volume = foam.field(os.path.join(case, last, "C"))[:, 0], foam.field(os.path.join(case, last, "V"))
    here = (centre > low) & (centre < high)
    return float(np.mean([(foam.field(os.path.join(case, t, "alpha.water"))[here] * volume[here]).sum() / volume[here].sum() for t in times])) * HEIGHT


def errors(run, case):
    before, jet = _depths(case, -0.6, -0.3), _depths(case, 0.1, 0.3)
    head = [d + (DISCHARGE / d)**2 / (2 * G) for d in (before, jet)]
    return {"comparisons": [
        relative("depth of the jet over the opening", jet / (OPENING + _beyond(run)), FREE_STREAMLINE, 0.1 if run.n == 8 else 0.05, "", "free-streamline theory"),
        small("head lost under the gate", 1 - head[1] / head[0], 0.1, "of the head", "no viscosity")]}
