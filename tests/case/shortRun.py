# SPDX-License-Identifier: GPL-3.0-or-later
"""shortRun.py TUTORIAL: checks the first steps of a tutorial in the current folder."""
import sys

import numpy as np

import flotsam
from tutorial import Report, history

name = sys.argv[1]
h = history(".")
report = Report(f"{name}, the first {h.time[-1]:g} s")

speed = np.linalg.norm(flotsam.fields(".", "last", ["U"])["U"], axis=1)
report.within("largest speed", speed.max(), 1e-6, 5, "m/s")
if "massError" in h.run:
    report.within("largest mass error", np.abs(h.run["massError"]).max(), 0, 1e-3)
if name in ("damBreak", "floatingBar", "slitDam", "bridgePier", "debrisRack", "debrisBoom"):
    alpha = flotsam.fields(".", "last", [flotsam.ALPHA])[flotsam.ALPHA]
    report.within("smallest phase value", alpha.min(), -1e-9, 1)
    report.within("largest phase value", alpha.max(), 0, 1 + 1e-9)

if name == "damBreak":
    # a column that collapses freely, before its front moves: a quarter of g t^2 at most has gone down at the wall
    level = flotsam.waterLevel(".", "last", [0.005], up=1)[0]
    report.within("level at the wall", level, 0.292 - 0.5 * 9.81 * 0.1**2, 0.292, "m")
elif name == "flowPastCylinder":
    # just started: the whole pressure of the acceleration, then the drag falls towards 5.58
    drag = 500 * h["cylinder"].fluidForce[-1, 0]
    report.within("drag coefficient", drag, 5, 15)
elif name == "fallingSphere":
    # experiment at 0.1 s: 0.053 m/s
    report.compare("speed", -h["sphere"].velocity[-1, 2], 0.053, 0.1, "m/s", "ten Cate et al. 2002")
elif name == "floatingBar":
    report.within("height of the centre", h["bar"].position[-1, 1], -0.005, 0.002, "m", "between its start and its swing")
elif name == "barAgainstPost":
    report.within("force on the post", h["post"].contactForce[-1, 0], 0.01, 1, "N")
    told = [line.split() for line in open("log.flotsamFoam", encoding="utf-8", errors="replace") if line.split()[:1] == ["post"]]
    report.compare("mean contact force on the post", h.mean("post", "contactForce", 0)[0], float(told[-1][4]), 1e-3, "N", "the summary's")
    speed = np.abs(h["bar"].velocity).max(axis=1)
    report.within("speed of the bar over its largest", speed[-1]/speed.max(), 0, 0.21, "", "it is held, or rebounds with the restitution, 0.2")
elif name == "slitDam":
    report.within("bars", len(h.bodies), 20, 20)
    report.within("pipes", len(h.structures), 7, 7)
    force = sum(h[pipe].fluidForce[-1, 0] for pipe in h.structures)
    report.within("water's force on the pipes", force, 5, 40, "N", "0.5 rho g b (0.17^2 - 0.05^2) = 36 N is the largest")
    held = np.array([h[bar].velocity[-1] for bar in h.bodies if bar.startswith("second")])
    report.within("speed of the bars not yet released", np.abs(held).max(), 0, 1e-12, "m/s")
elif name == "bridgePier":
    report.within("logs", len(h.bodies), 16, 16)
    report.compare("mass of a log with root wad", h["rooted.0"].mass, 650e-9 * np.pi * (35**2 * 24 + 12**2 * (260 - 24)), 1e-4, "kg")
    # the start field is near the flow around the pier: the force comes down from its first step's
    report.within("water's force on the pier", h["pier"].fluidForce[-1, 0], 0.5, 30, "N", "1.2 N in steady flow")
    speed = np.array([h[log].velocity[-1] for log in h.bodies])
    report.within("mean speed of the logs", speed[:, 0].mean(), 0.40, 0.45, "m/s", "they drift: 0.4375 m/s")
    report.within("largest vertical speed of a log", np.abs(speed[:, 2]).max(), 0, 0.05, "m/s", "they float at their draft")
elif name == "debrisRack":
    report.within("logs", len(h.bodies), 100, 100)
    came = [h[log] for log in h.bodies if h[log].awaited[-1] < 0.5]
    report.within("logs that came in", len(came), 2, 6, "", "due: at 0.010, 0.012, .. s; those that stand in each other's way wait")
    report.within("smallest speed along the channel", min(log.velocity[-1, 0] for log in came), 0.44, 0.46, "m/s", "0.45 m/s through the air")
    report.within("largest speed downward", max(-log.velocity[-1, 2] for log in came), 0.02, 9.81 * 0.012, "m/s", "free fall")
    report.within("speed of those to come", max(np.abs(h[log].velocity).max() for log in h.bodies if h[log].awaited[-1] > 0.5), 0, 0, "m/s")
elif name == "debrisBoom":
    report.within("bodies", len(h.bodies), 34, 34, "", "30 logs, 4 floats")
    report.within("logs that came in", sum(h[log].awaited[-1] < 0.5 for log in h.bodies), 2, 34, "", "as debrisRack")
    report.within("lines", len(h.restraints["names"]), 10, 10, "", "two rows")
    tables = {line: flotsam.stepTable(".", "restraints", line + ".dat") for line in h.restraints["names"]}
    for line, rows in tables.items():
        report.within(f"mean tension of {line}", rows[rows[:, 0] > 0.02, 4].mean(), 0.05, 10, "N", "the stream pulls the chain taut")
    ends = -sum(tables[line][-1, 1] for line in tables if line.startswith(("right", "left")))
    report.compare("held by the end lines in the last step", ends, -sum(h[f"float.{k}"].contactForce[-1, 0] for k in range(4)), 1e-6, "N", "on the floats, links cancel")
report.end()
