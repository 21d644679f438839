# SPDX-License-Identifier: GPL-3.0-or-later
"""Channels in 2D, x along the stream, z up, on even square cells: files, and depths from the written alpha."""
import os

import numpy as np

from runner import foam
from support.files import blockMesh, dictionary, even, field, fixed, gravity, merged, twoFluids

G = 9.81    # [m/s^2]


def files(length, height, h, depth, speed, end, inlet=None, walls=("bed",)):
    """Water `depth` deep under air. end: (type, U, p_rgh, alpha.water) of the patch across the stream's end; inlet: (U, alpha.water) of the one where it enters, without: both fluids with `speed`;
    walls: slip, "inletWall" among them with the patch of wallAboveInlet()."""
    kind, *conditions = end
    pressure = "type fixedFluxPressure; value uniform 0;"
    velocity, phase = inlet or (fixed(f"({speed:.9g} 0 0)"), entering([1 if z < depth else 0 for z in heights(height, h)]))

    def patches(inlet, end, wall, top):
        return {"inlet": inlet, "end": end, **{name: wall for name in walls}, "atmosphere": top, "frontAndBack": "empty"}

    return merged(
        blockMesh(even(0, length, round(length / h)), even(0, h, 1), even(0, height, round(height / h)),
                  {"inlet": ("patch", "x-"), "end": (kind, "x+"), "bed": ("wall", "z-"), "atmosphere": ("patch", "z+"), "frontAndBack": ("empty", "y- y+")}),
        field("U", patches(velocity, conditions[0], "slip", "type pressureInletOutletVelocity; value uniform (0 0 0);"), f"({speed:.9g} 0 0)"),
        field("p_rgh", patches(pressure, conditions[1], pressure, "type totalPressure; p0 uniform 0; value uniform 0;")),
        field("alpha.water", patches(phase, conditions[2], "zeroGradient", "type inletOutlet; inletValue uniform 0; value uniform 0;")),
        {"system/setFieldsDict": dictionary("setFieldsDict", f"""defaultFieldValues (volScalarFieldValue alpha.water 0);
regions ( boxToCell {{ box (-1 -1 -1) ({2 * length:.9g} 1 {depth:.9g}); fieldValues (volScalarFieldValue alpha.water 1); }} );""")},
        twoFluids(), gravity(z=-G))


def heights(height, h):
    """Of the cells' centres above the bed, upwards [m]."""
    return [(k + 0.5) * h for k in range(round(height / h))]


def entering(alpha):
    """alpha.water of an inlet, by its faces upwards."""
    return f"type fixedValue; value nonuniform List<scalar> {len(alpha)} ({' '.join(f'{a:.6g}' for a in alpha)});"


def wallAboveInlet(level):
    """Makes the patch `inletWall` of the inlet's faces above the level: topoSet, createPatch -overwrite."""
    return {"system/topoSetDict": dictionary("topoSetDict", f"""actions
(
    {{ name above; type faceSet; action new; source patchToFace; patch inlet; }}
    {{ name above; type faceSet; action subset; source boxToFace; box (-1 -1 {level:.9g}) (1 1 1e9); }}
);"""),
            "system/createPatchDict": dictionary("createPatchDict", """pointSync false;
patches ( { name inletWall; patchInfo { type wall; } constructFrom set; set above; } );""")}


def depths(case, nx, h):
    """Written times after the start, ascending, and of each the depth in every column of cells [m]."""
    times = sorted((t for t in os.listdir(case) if t[0].isdigit() and not t.endswith(".orig") and float(t) > 0), key=float)
    return np.array([float(t) for t in times]), np.array([foam.field(os.path.join(case, t, "alpha.water")).reshape(-1, nx).sum(axis=0) * h for t in times])
