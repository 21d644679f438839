# SPDX-License-Identifier: GPL-3.0-or-later
"""The same 2D scene in other units, at other sizes, on other axes and at other places: logs, a stone and a moored log before a rack, in a stream that a moving sill disturbs.

scaledScene.py write CASE [L M T [AXES [PLACE]]]     lengths, masses and times over those of the first scene; AXES, for instance -z,x,y: where its axes x (stream), y (up), z point
scaledScene.py compare CASE CASE TOLERANCE L M T [AXES [PLACE]]
"""
import sys
from pathlib import Path

import numpy as np

LENGTH, HEIGHT, WIDTH, LEVEL = 1.25, 0.3125, 0.0625, 0.1875     # sums of powers of two: no round-off in text, nor from other units that are powers of two
END = 0.1875


class Units:
    def __init__(self, words):
        self.L, self.M, self.T = (float(word) for word in (words[:3] or (1, 1, 1)))
        axes = (words[3] if len(words) > 3 else "x,y,z").split(",")
        self.place = np.array([float(x) for x in words[4].split(",")] if len(words) > 4 else (0, 0, 0))
        self.turn = np.zeros((3, 3))
        for k, axis in enumerate(axes):
            self.turn["xyz".index(axis[-1]), k] = -1 if axis[0] == "-" else 1

    def direction(self, x, y, z=0.0, scale=1.0):
        return "(" + " ".join(repr(float(v) + 0.0) for v in scale * (self.turn @ (x, y, z))) + ")"

    def point(self, x, y, z=WIDTH / 2):
        return "(" + " ".join(repr(float(v)) for v in self.L * (self.turn @ (x, y, z) + self.place)) + ")"

    def vector(self, x, y, z=0.0):
        return self.direction(x, y, z, self.L)

    def size(self, x, y, z=WIDTH):
        return "(" + " ".join(repr(float(v)) for v in self.L * np.abs(self.turn @ (x, y, z))) + ")"

    def number(self, value, length=0, mass=0, time=0):
        return repr(value * self.L**length * self.M**mass * self.T**time)


def block_mesh(u):
    corners = [u.point(x, y, z) for z in (0, WIDTH) for x, y in ((0, 0), (LENGTH, 0), (LENGTH, HEIGHT), (0, HEIGHT))]
    is_mirrored = np.linalg.det(u.turn) < 0
    order = "4 5 6 7 0 1 2 3" if is_mirrored else "0 1 2 3 4 5 6 7"
    patches = {"inlet": ["0 4 7 3"], "outlet": ["1 2 6 5"], "bed": ["0 1 5 4"], "top": ["3 7 6 2"], "frontBack": ["0 3 2 1", "4 5 6 7"]}
    types = {"bed": "wall", "frontBack": "empty"}
    text = [" ".join(f"({' '.join(f.split()[::-1]) if is_mirrored else f})" for f in faces) for faces in patches.values()]
    boundary = " ".join(f"{name} {{ type {types.get(name, 'patch')}; faces ({faces}); }}" for name, faces in zip(patches, text))
    return f"scale 1; vertices ({' '.join(corners)}); blocks (hex ({order}) (40 20 1) simpleGrading (1 1 1)); boundary ({boundary});"


def field(u, kind, dimensions, start, conditions):
    patches = " ".join(f"{name} {{ {condition} }}" for name, condition in conditions.items())
    return kind, f"dimensions {dimensions}; internalField uniform {start}; boundaryField {{ {patches} frontBack {{ type empty; }} }}"


def bodies(u):
    n, p, v = u.number, u.point, u.vector
    speed, rho = u.direction(0.2, 0, 0, u.L / u.T), {name: n(value, -3, 1) for name, value in (("wood", 600.0), ("stone", 2500.0))}
    disc = f"shape {{ type cylinder; end1 {v(0, 0, -WIDTH/2)}; end2 {v(0, 0, WIDTH/2)}; radius {n(0.03125, 1)}; }}"
    places = " ".join(f"{{ position {p(x, 0.19140625)}; releaseTime {n(time, time=1)}; }}" for x, time in ((0.5078125, 0.0), (0.421875, 0.0), (0.2578125, 0.0625)))
    return f"""
contact {{ default {{ stiffness {n(1e6, mass=1, time=-2)}; restitution 0.2; frictionAngle 30; }} }}
structures
{{
    rack {{ shape {{ type box; size {u.size(0.0625, 0.25, 1)}; }} position {p(0.7578125, 0.2421875)}; }}
    sill {{ shape {{ type box; size {u.size(0.125, 0.0625, 1)}; }} position {p(0.9453125, 0.1015625)};
        motion {{ type oscillating; direction {u.direction(0, 1)}; amplitude {n(0.015625, 1)}; period {n(0.25, time=1)}; rampTime {n(0.0625, time=1)}; }} }}
}}
bodies
{{
    bar {{ shape {{ type box; size {u.size(0.0625, 0.03125)}; }} density {rho['wood']}; position {p(0.6796875, 0.1953125)}; velocity {speed}; }}
    log {{ {disc} density {rho['wood']}; velocity {speed}; poses ( {places} ); }}
    stone {{ shape {{ type box; size {u.size(0.0625, 0.046875)}; }} density {rho['stone']}; position {p(0.3515625, 0.03125)}; }}
}}
restraints
{{
    mooring {{ type tether; body log.1; refAttachmentPt {p(0.421875, 0.19140625)}; anchor {p(0.25, 0.25)}; length {n(0.1796875, 1)}; stiffness {n(1e3, mass=1, time=-2)}; damping {n(1.0, mass=1, time=-1)}; }}
}}"""


def files(u):
    n = u.number
    wet = [u.L * (u.turn @ corner + u.place) for corner in ((-9, -9, -9), (9, LEVEL, 9))]
    low, high = (" ".join(repr(float(x)) for x in side) for side in (np.minimum(*wet), np.maximum(*wet)))
    level = float(u.turn[:, 1] @ (u.L * (u.turn @ (0, LEVEL, 0) + u.place)))
    stream, still = "uniform " + u.direction(0.2, 0, 0, u.L / u.T), "type pressureInletOutletVelocity; value uniform (0 0 0);"
    flux = "type fixedFluxPressure; value uniform 0;"
    yield "system/blockMeshDict", ("dictionary", block_mesh(u))
    yield "system/setFieldsDict", ("dictionary", "defaultFieldValues (volScalarFieldValue alpha.water 0); regions (boxToCell "
                                   f"{{ box ({low}) ({high}); fieldValues (volScalarFieldValue alpha.water 1); }});")
    yield "0/U", field(u, "volVectorField", "[0 1 -1 0 0 0 0]", stream[8:], {"inlet": f"type fixedValue; value {stream};", "outlet": still, "top": still, "bed": "type noSlip;"})
    yield "0/p_rgh", field(u, "volScalarField", "[1 -1 -2 0 0 0 0]", 0, {"inlet": flux, "outlet": "type fixedValue; value uniform 0;", "top": "type totalPressure; p0 uniform 0; value uniform 0;", "bed": flux})
    yield "0/alpha.water", field(u, "volScalarField", "[0 0 0 0 0 0 0]", 0, {name: "type zeroGradient;" for name in ("inlet", "outlet", "top", "bed")})
    yield "constant/g", ("uniformDimensionedVectorField", f"dimensions [0 1 -2 0 0 0 0]; value {u.direction(0, -9.81, 0, u.L / u.T**2)};")
    yield "constant/hRef", ("uniformDimensionedScalarField", f"dimensions [0 1 0 0 0 0 0]; value {level!r};")
    phases = " ".join(f"{name} {{ transportModel Newtonian; nu {n(nu, 2, time=-1)}; rho {n(rho, -3, 1)}; }}" for name, nu, rho in (("water", 1e-6, 1000.0), ("air", 1.5e-5, 1.0)))
    yield "constant/transportProperties", ("dictionary", f"phases (water air); {phases}")
    yield "constant/bodies", ("dictionary", bodies(u))
    end = n(END, time=1)
    yield "system/controlDict", ("dictionary", f"application flotsamFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {end}; deltaT {n(0.004, time=1)}; writeControl adjustableRunTime;"
                                 f" writeInterval {end}; writeFormat ascii; writePrecision 17; timePrecision 12; adjustTimeStep yes; maxCo 0.5; maxDeltaT {n(0.01, time=1)}; minDeltaT {n(1e-9, time=1)};")
    yield "system/fvSolution", ("dictionary", "flotsam { tolerance 1e-11; forceTolerance 1e-11; contactTolerance 1e-6; maxContactRepeats 50; contactTrial 0; }")
    yield "system/fvSchemes", ("dictionary", "ddtSchemes { default Euler; } gradSchemes { default Gauss linear; } divSchemes { default none; } laplacianSchemes { default Gauss linear corrected; }"
                               " interpolationSchemes { default linear; } snGradSchemes { default corrected; }")


def write(case, u):
    for name, (kind, text) in files(u):
        path = Path(case) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"FoamFile {{ version 2.0; format ascii; class {kind}; object {path.name}; }}\n{text}\n")


def compare(first, second, tolerance, u):
    """Every step of both: relative to the largest value of each quantity."""
    import h5py
    force = u.M * u.L / u.T**2
    quantities = {"position": u.L, "velocity": u.L / u.T, "fluidForce": force, "contactForce": force, "wetFraction": 1}
    worst, where = 0.0, ""
    with h5py.File(f"{first}/postProcessing/flotsam/bodies.h5") as a, h5py.File(f"{second}/postProcessing/flotsam/bodies.h5") as b:
        if len(a["run/time"]) != len(b["run/time"]):
            sys.exit(f"FAILED: {second}: {len(b['run/time'])} records instead of {len(a['run/time'])}")
        for member in [f"{kind}/{name}" for kind in ("structures", "bodies") for name in a[kind]]:
            for quantity, scale in quantities.items():
                x, y = a[member][quantity][:], b[member][quantity][:] / scale
                y = (y - (u.place if quantity == "position" else 0)) @ u.turn if y.ndim == 2 else y
                error = np.abs(x - y).max() / max(np.abs(x).max(), 1e-300)
                if error > worst:
                    worst, where = error, f"{quantity} of {member}"
        touched = max(np.abs(a[f"bodies/{name}/contactForce"][:]).max() for name in a["bodies"])
    print(f"{second}: differs by {worst:.1e}" + (f" ({where})" if where else ""))
    if not touched > 0:
        sys.exit(f"FAILED: {first}: nothing touched")
    if not worst <= tolerance:
        sys.exit(f"FAILED: {second} is another flow than {first}")


if sys.argv[1] == "write":
    write(sys.argv[2], Units(sys.argv[3:]))
else:
    compare(sys.argv[2], sys.argv[3], float(sys.argv[4]), Units(sys.argv[5:]))
