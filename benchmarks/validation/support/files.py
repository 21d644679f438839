# SPDX-License-Identifier: GPL-3.0-or-later
"""Text of OpenFOAM dictionaries, so that a validation case is one short script."""
import math
from dataclasses import dataclass

import numpy as np


def dictionary(name, body, kind="dictionary"):
    return ("// SPDX-License-Identifier: GPL-3.0-or-later\nFoamFile\n{\n    version     2.0;\n    format      ascii;\n"
            f"    class       {kind};\n    object      {name};\n}}\n\n{body.strip()}\n")


# --- mesh -------------------------------------------------------------------------------------------------------------

@dataclass
class Axis:
    """Grid lines along one axis: n[i] cells between points[i] and points[i + 1], the last ratio[i] times as wide as the first."""
    points: list
    n: list
    ratio: list

    @property
    def cells(self):
        return sum(self.n)

    def grading(self):
        parts = zip(self.points, self.points[1:], self.n, self.ratio)
        return "(" + " ".join(f"({b - a:.9g} {n} {r:.9g})" for a, b, n, r in parts) + ")"


def even(low, high, n):
    return Axis([low, high], [n], [1])


def strip(length, step, growth):
    """(cells, ratio of the last to the first) of a strip whose cells widen from `step` by the factor `growth` a cell."""
    n = max(1, round(math.log(1 + length * (growth - 1) / step) / math.log(growth)))
    return n, growth**(n - 1)


def around(low, begin, end, high, step, growth, growthUp=None):
    """Cells of width `step` between begin and end, widening from there to low and high (growthUp: another factor to high)."""
    axis = Axis([], [], [])
    if begin > low:
        n, ratio = strip(begin - low, step, growth)
        axis = Axis([low], [n], [1 / ratio])
    axis.points += [begin, end]
    axis.n.append(max(1, round((end - begin) / step)))
    axis.ratio.append(1)
    if high > end:
        n, ratio = strip(high - end, step, growthUp or growth)
        axis.points.append(high)
        axis.n.append(n)
        axis.ratio.append(ratio)
    return axis


FACES = {"x-": "(0 4 7 3)", "x+": "(1 2 6 5)", "y-": "(0 1 5 4)", "y+": "(3 7 6 2)", "z-": "(0 3 2 1)", "z+": "(4 5 6 7)"}


def blockMesh(x, y, z, patches):
    """A box. patches: {name: (type, sides)}, sides as in "y- y+"."""
    corners = [(i, j, k) for k in (0, -1) for i, j in ((0, 0), (-1, 0), (-1, -1), (0, -1))]
    vertices = " ".join(f"({x.points[i]:.9g} {y.points[j]:.9g} {z.points[k]:.9g})" for i, j, k in corners)
    boundary = "\n".join(f"    {name} {{ type {kind}; faces ({' '.join(FACES[s] for s in sides.split())}); }}" for name, (kind, sides) in patches.items())
    return {"system/blockMeshDict": dictionary("blockMeshDict", f"""scale   1;
vertices ({vertices});
blocks
(
    hex (0 1 2 3 4 5 6 7) ({x.cells} {y.cells} {z.cells})
    simpleGrading
    (
        {x.grading()}
        {y.grading()}
        {z.grading()}
    )
);
boundary
(
{boundary}
);""")}


# --- fields, properties -----------------------------------------------------------------------------------------------

FIELDS = {"U": ("volVectorField", "[0 1 -1 0 0 0 0]", "(0 0 0)"), "p": ("volScalarField", "[1 -1 -2 0 0 0 0]", "0"),
          "p_rgh": ("volScalarField", "[1 -1 -2 0 0 0 0]", "0"), "alpha.water": ("volScalarField", "[0 0 0 0 0 0 0]", "0")}


def field(name, patches, value=None):
    """0/<name>; patches: {patch: entries}, a single word is the condition's type."""
    kind, units, zero = FIELDS[name]
    entries = {patch: text if " " in text else f"type {text};" for patch, text in patches.items()}
    boundary = "\n".join(f"    {patch} {{ {text} }}" for patch, text in entries.items())
    return {f"0/{name}": dictionary(name, f"dimensions      {units};\ninternalField   uniform {value or zero};\n"
                                    f"boundaryField\n{{\n{boundary}\n}}", kind)}


def fixed(value):
    return f"type fixedValue; value uniform {value};"


def openTank(wall, walls=("walls",), top="atmosphere", empty=()):
    """U, p_rgh and alpha.water of a tank at rest that is open at the top; wall: condition of the velocity on its walls; empty: patches across a plane."""
    def patches(wallCondition, topCondition):
        return {**{patch: wallCondition for patch in walls}, top: topCondition, **{patch: "empty" for patch in empty}}

    return merged(field("U", patches(wall, "type pressureInletOutletVelocity; value uniform (0 0 0);")),
                  field("p_rgh", patches("type fixedFluxPressure; value uniform 0;", "type totalPressure; p0 uniform 0;")),
                  field("alpha.water", patches("zeroGradient", "type inletOutlet; inletValue uniform 0; value uniform 0;")))


def oneFluid(nu, rho):
    return {"constant/transportProperties": dictionary("transportProperties", f"transportModel Newtonian;\nnu {nu:.9g};\nrho {rho:.9g};")}


def twoFluids(nuWater=1e-6, nuAir=1.48e-5, rhoWater=1000, rhoAir=1):
    return {"constant/transportProperties": dictionary("transportProperties", f"""phases (water air);
water {{ transportModel Newtonian; nu {nuWater:.9g}; rho {rhoWater:.9g}; }}
air   {{ transportModel Newtonian; nu {nuAir:.9g}; rho {rhoAir:.9g}; }}
sigma 0;""")}


def gravity(x=0, y=0, z=0):
    return {"constant/g": dictionary("g", f"dimensions [0 1 -2 0 0 0 0];\nvalue ({x:.12g} {y:.12g} {z:.12g});", "uniformDimensionedVectorField")}


def referenceHeight(level):
    """constant/hRef: p_rgh is zero in a liquid at rest up to this level."""
    return {"constant/hRef": dictionary("hRef", f"dimensions [0 1 0 0 0 0 0];\nvalue {level:.9g};", "uniformDimensionedScalarField")}


def bodies(text):
    return {"constant/bodies": dictionary("bodies", text)}


def parabola(expression):
    """Velocity of the patch `inlet`, an expression of pos()."""
    return {"system/setExprBoundaryFieldsDict": dictionary("setExprBoundaryFieldsDict", f"""U
{{
    field U;
    expressions ( {{ patch inlet; target value; expression #{{ {expression} #}}; }} );
}}""")}


def level(axis):
    """Water below zero on this axis, by setAlphaField: exact fractions of cells."""
    return {"system/setAlphaFieldDict": dictionary("setAlphaFieldDict", f"field alpha.water;\ntype plane;\ndirection {axis};\norigin (0 0 0);")}


def column(width, height):
    """Water in 0 <= x <= width, 0 <= y <= height, by setFields."""
    return {"system/setFieldsDict": dictionary("setFieldsDict", f"""defaultFieldValues (volScalarFieldValue alpha.water 0);
regions ( boxToCell {{ box (-1 -1 -1) ({width:.9g} {height:.9g} 1); fieldValues (volScalarFieldValue alpha.water 1); }} );""")}


# --- system -----------------------------------------------------------------------------------------------------------

SCHEMES = """// read by OpenFOAM's own tools; flotsamFoam takes nothing from here
ddtSchemes { default Euler; }
gradSchemes { default Gauss linear; }
divSchemes { default none; }
laplacianSchemes { default Gauss linear corrected; }
interpolationSchemes { default linear; }
snGradSchemes { default corrected; }"""


def control(endTime, deltaT, maxCo=0.5, maxDeltaT=None, writeInterval=None, adjust=True, functions="", **more):
    """system: controlDict, and default numerics."""
    limits = {"maxCo": maxCo, **({"maxDeltaT": maxDeltaT} if maxDeltaT else {}), **more} if adjust else more
    entries = "\n".join(f"{name:<15} {value};" for name, value in limits.items())
    text = f"""application     flotsamFoam;
startFrom       startTime;
startTime       0;
stopAt          endTime;
endTime         {endTime:.9g};
deltaT          {deltaT:.9g};
adjustTimeStep  {'yes' if adjust else 'no'};
{entries}
writeControl    adjustableRunTime;
writeInterval   {writeInterval or endTime:.9g};
writeFormat     ascii;
writePrecision  10;
timePrecision   9;
""" + (f"functions\n{{\n{functions}\n}}" if functions else "")
    return {"system/controlDict": dictionary("controlDict", text), "system/fvSchemes": dictionary("fvSchemes", SCHEMES),
            "system/fvSolution": dictionary("fvSolution", "flotsam\n{\n    // defaults\n}"),
            "constant/turbulenceProperties": dictionary("turbulenceProperties", "simulationType laminar;")}


def merged(*parts):
    result = {}
    for part in parts:
        result.update(part)
    return result


def stlBox(size):
    """Text of an ASCII STL file with six digits: a box around the origin, two triangles a side. size: three lengths [m]."""
    low, high = (np.array(size) * sign / 2 for sign in (-1, 1))
    text = "solid box\n"
    for d in range(3):
        for side, x in ((-1, low[d]), (1, high[d])):
            u, v = ((d + 1) % 3, (d + 2) % 3)[::side]
            corners = np.empty((4, 3))
            corners[:, d] = x
            corners[:, u] = [low[u], high[u], high[u], low[u]]
            corners[:, v] = [low[v], low[v], high[v], high[v]]
            for triangle in ((0, 1, 2), (0, 2, 3)):
                text += "facet normal 0 0 0\nouter loop\n" + "".join("vertex {:.6g} {:.6g} {:.6g}\n".format(*corners[k]) for k in triangle) + "endloop\nendfacet\n"
    return text + "endsolid box\n"
