# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene as an OpenFOAM case: what runner.execute asks of a case."""
import math
import os
import re

import numpy as np

from support import files

import judge

WRITES = 16
SAMPLES = 4     # a side of a cell, for the fractions of the liquid


class SceneCase:
    figures = {}

    def __init__(self, scene, root):
        self.scene, self.root = scene, root
        self.name, self.folder = f"scene{scene.number}", ""

    def files(self, _run, folder):
        s = self.scene
        self._caseFolder = folder
        axes = [files.Axis([0, s.size[d]], [s.cells[d]], [s.ratio[d]]) for d in range(3)]
        parts = [files.blockMesh(*axes, self._patches()), files.gravity(*s.gravity), self._control()]
        parts.append(files.oneFluid(s.mu[0] / s.rho[0], s.rho[0]) if s.oneFluid else files.twoFluids(s.mu[0] / s.rho[0], s.mu[1] / s.rho[1], *s.rho))
        if s.bodies or s.structures:
            parts.append(files.bodies(self._solids()))
        if s.outlet == "level":
            parts.append(files.referenceHeight(s.inflowDepth * s.length))
        return files.merged(*parts, s.files, {"system/fvSolution": files.dictionary("fvSolution", "flotsam { " + " ".join(s.options) + " }")})

    def parameters(self, _run):
        return {}

    def prepare(self, _run, do):
        do("blockMesh")
        points = movePoints(self.scene, os.path.join(self._caseFolder, "constant", "polyMesh", "points"))
        self.mesh = judge.Cells(points, self.scene.cells)
        for path, text in self._fields().items():
            os.makedirs(os.path.join(self._caseFolder, "0"), exist_ok=True)
            with open(os.path.join(self._caseFolder, path), "w", encoding="utf-8") as out:
                out.write(text)

    def errors(self, _run, folder):
        return judge.figures(self.scene, self.mesh, self.root, folder)

    def _patches(self):
        s = self.scene
        sides = {"walls": ["y-"], "inlet": [], "outlet": [], "top": []}
        sides["walls"] += [] if s.inflow else ["x-", "x+"]
        if s.inflow:
            sides["inlet"], sides["outlet"] = ["x-"], ["x+"]
        sides["top" if s.openTop else "walls"].append("y+")
        if s.dim == 3:
            sides["walls"] += ["z-", "z+"]
        patches = {name: ("wall" if name == "walls" else "patch", " ".join(faces)) for name, faces in sides.items() if faces}
        return {**patches, **({"frontAndBack": ("empty", "z- z+")} if s.dim == 2 else {})}

    def _control(self):
        s = self.scene
        largest = s.maxCo * s.h / s.speed
        longest = s.endTime / 4 if s.firstStep > largest else s.endTime / 20
        bodies = {"maxBodyCo": s.maxBodyCo} if s.maxBodyCo != 0.5 else {}
        return files.control(s.endTime, s.firstStep, maxCo=s.maxCo, maxDeltaT=longest, writeInterval=s.endTime / WRITES,
                             adjust=not s.fixedStep, **bodies)

    def _fields(self):
        """Of the start: {path: text}."""
        s = self.scene
        opening = "type pressureInletOutletVelocity; value uniform (0 0 0);"
        alpha, velocity = self._start()
        u = {"walls": s.walls, "blocks": s.blockWall, "top": opening, "outlet": opening, "frontAndBack": "empty", "inlet": self._inlet()}
        p = {"walls": "type fixedFluxPressure; value uniform 0;", "top": "type totalPressure; p0 uniform 0; value uniform 0;", "frontAndBack": "empty",
             "outlet": "type prghTotalPressure; p0 uniform 0; value uniform 0;" if not s.oneFluid else "type totalPressure; p0 uniform 0; value uniform 0;",
             "inlet": "type fixedFluxPressure; value uniform 0;"}
        p["blocks"] = p["walls"]
        if s.outlet == "velocity":
            u["outlet"], p["outlet"] = self._inlet(), p["inlet"]
        elif s.outlet == "level":
            p["outlet"] = "type fixedValue; value uniform 0;"
        a = {"walls": "zeroGradient", "blocks": "zeroGradient", "frontAndBack": "empty",
             **{name: f"type inletOutlet; inletValue uniform {value}; value uniform {value};" for name, value in (("top", 0), ("outlet", 0), ("inlet", 1))}}
        if s.discharge:
            u["inlet"], a["inlet"] = self._discharge()
        names = self._patches()
        chosen = lambda entries: {name: entries[name] for name in names}       # noqa: E731
        fields = [("U", u, velocity), ("p_rgh", p, None)] + ([] if s.oneFluid else [("alpha.water", a, alpha)])
        return {path: text if values is None else filled(text, values)
                for name, entries, values in fields for path, text in files.field(name, chosen(entries)).items()}

    def _inlet(self):
        """Water below inflowDepth, a wall above."""
        s = self.scene
        if s.oneFluid or not s.inflow:
            return files.fixed(f"({s.inflow:.9g} 0 0)")
        y = self.mesh.faceHeights()
        values = "\n".join(f"({s.inflow if level < s.inflowDepth * s.length else 0:.9g} 0 0)" for level in y)
        return f"type fixedValue; value nonuniform List<vector> {len(y)} ( {values} );"

    def _discharge(self):
        """U and alpha of an inlet whose discharge jumps, from bed to top."""
        s = self.scene
        q, rows, factor = s.inflow * s.inflowDepth * s.length * s.size[2], [(0, 1)], 1
        for share, next_ in s.discharge:
            rows += [(share * s.endTime, factor), (share * s.endTime + 1e-9 * s.endTime, next_)]
            factor = next_
        table = " ".join(f"({t:.12g} {q * f:.9g})" for t, f in rows)
        return (f"type variableHeightFlowRateInletVelocity; flowRate table ({table}); alpha alpha.water; value uniform (0 0 0);",
                "type variableHeightFlowRate; lowerBound 0; upperBound 0.99; value uniform 0;")

    def _start(self):
        """Fractions of the cells by sample points, velocity of the liquid in them."""
        s = self.scene
        alpha, velocity = np.zeros(self.mesh.n), np.zeros((self.mesh.n, 3))
        places = (np.arange(SAMPLES) + 0.5) / SAMPLES
        grid = [(a, b, c) for a in places for b in places for c in (places if s.dim == 3 else [0.5])]
        for where in grid:
            x = self.mesh.inside(*where)
            x[:, 0] -= s.slant * x[:, 1]
            wet = np.zeros(self.mesh.n, bool)
            for inside, v in s.liquid:
                isIn = inside(x / s.length)
                velocity[isIn & ~wet] += v / len(grid)
                wet |= isIn
            alpha += wet / len(grid)
        return alpha, velocity

    def _solids(self, bodies=None):
        """constant/bodies, with these bodies (none: all)."""
        s = self.scene
        text = ""
        if s.bodies:
            text += f"contact {{ default {{ {self._contact()} }} }}\n"
        if s.blockType == "patch":
            text += "wallPatches (walls blocks);\n"
        motions = [f" motion {{ {x.motion(s.length)} }}" if hasattr(x, "motion") else "" for x in s.structures]
        text += "structures\n{\n" + "".join(self._solid(x, x.entries + m) for x, m in zip(s.structures, motions)) + "}\n"
        text += "bodies\n{\n"
        for b in s.bodies if bodies is None else bodies:
            text += self._solid(b, f"density {b.density:.9g}; velocity {_vector(b.velocity)}; angularVelocity {_vector(b.spin)}; releaseTime {b.release:.6g}; {b.entries}")
        text += "}\n"
        if s.restraints:
            text += "restraints\n{\n" + "".join(f"    {line(s.length, s.speed)}\n" for line in s.restraints) + "}\n"
        return text

    def _contact(self):
        """Drawn once."""
        s = self.scene
        if not hasattr(self, "_law"):
            law = s.contact or f"restitution {s.rng.uniform(0.1, 0.9):.3g}; frictionAngle {s.rng.uniform(0, 45):.3g};"
            thin = min(b.thin for b in s.bodies) * s.length
            mass = max((b.density + s.rho[0]) * b.volume for b in s.bodies) * s.length**3
            self._law = f"stiffness {mass * (s.speed / (0.05 * thin))**2:.6g}; {law}"
        return self._law

    def _solid(self, x, entries):
        s = self.scene
        place = (x.position + np.array([s.slant * x.position[1], 0, 0])) * s.length
        return (f"    {x.name} {{ shape {{ {x.shape(s.length)} }} position {_vector(place)}; "
                f"orientation {{ axis {_vector(x.axis)}; angleDeg {x.angle:.6g}; }} {entries} }}\n")


def _vector(v):
    return f"({v[0]:.9g} {v[1]:.9g} {v[2]:.9g})"


def filled(text, values):
    """A field's text with values of the cells."""
    rows = "\n".join(_vector(v) for v in values) if values.ndim == 2 else "\n".join(f"{v:.9g}" for v in values)
    kind = "vector" if values.ndim == 2 else "scalar"
    return re.sub(r"internalField[^;]*;", lambda _: f"internalField   nonuniform List<{kind}> {len(values)}\n(\n{rows}\n);", text, count=1)


def movePoints(s, path):
    """Shifts the inner points of the mesh at random, slants all; writes them and returns them (nz x ny x nx x 3)."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    start = re.search(r"\n\d+\s*\n?\(", text)
    body = text[start.end():text.rindex(")", 0, text.rindex(")") + 1)]
    n = [c + 1 for c in s.cells]
    x = np.array(body.replace("(", " ").replace(")", " ").split(), float).reshape(n[2], n[1], n[0], 3)
    if s.moved:
        for d in range(s.dim):
            axis = 2 - d
            gap = np.minimum(np.diff(x[..., d], axis=axis, prepend=np.nan), np.inf)
            width = np.fmin(gap, np.roll(gap, -1, axis=axis))
            shift = s.moved * s.rng.uniform(-1, 1, size=x.shape[:3] if s.dim == 3 else (1, *x.shape[1:3])) * np.nan_to_num(width)
            for e in range(s.dim):      # nodes of a side stay on it
                edge = [slice(None)] * 3
                edge[2 - e] = [0, -1]
                if e == d:
                    shift[tuple(edge)] = 0
            x[..., d] += shift
    x[..., 0] += s.slant * x[..., 1]
    rows = "\n".join(f"({a:.12g} {b:.12g} {c:.12g})" for a, b, c in x.reshape(-1, 3))
    with open(path, "w", encoding="utf-8") as out:
        out.write(text[:start.end()] + "\n" + rows + "\n)\n")
    return x
