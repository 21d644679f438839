# SPDX-License-Identifier: GPL-3.0-or-later
"""Heave decay of a floating sphere, H0 = 0.1 D (Kramer et al. 2021). N: elements a diameter."""
import numpy as np

from runner import foam, refinement
from runner.cases import Run
from support.compare import relative, small
from support.files import around, blockMesh, bodies, control, gravity, level, merged, openTank, twoFluids

SOURCE = "Kramer et al. 2021, experiment"
DIAMETER, DROP, PERIOD, END = 0.3, 0.03, 0.7561, 2.3

title = """Sphere of 0.3 m, 7.056 kg, half immersed at rest, released 0.03 m above (Kramer et al. 2021, 95 % band of the experiment). Basin 8 x 8 m (13 x 8.44 m in the experiment), 0.9 m deep, slip walls
(long waves come back after 2.7 s; from walls at 2 m after 1.3 s, and lift the mean by 0.012 H0); N elements a diameter within 0.2 m of the sphere, wider elsewhere; three periods. The body is of uniform density."""

REFINED, SHORT, STEP = "refined", "5 ms", 0.01       # the longest step [s]
BOX = [((-0.2, -0.2, -0.21), (0.2, 0.2, 0.21))]
runs = [*(Run("flotsamFoam", n, quick=n == 8, timeLimit=3600) for n in (8, 12, 16)),
        *(Run("flotsamFoam", n, SHORT, timeLimit=3600, options={"step": STEP / 2}) for n in (8, 12, 16)),
        *(Run("flotsamFoam", n, REFINED, timeLimit=3600, options={"levels": 1}) for n in (16,))]


def resolution(run):
    return f"{run.n} a diameter{', ' + run.variant if run.variant else ''}"


def files(run, _folder):
    levels = run.options.get("levels", 0)
    h = DIAMETER / run.n * 2**levels
    side = around(-4, -0.2, 0.2, 4, h, 1.2)
    height = around(-0.9, -0.22, 0.22, 0.4, h, 1.25)
    density = 7.056 / (np.pi / 6 * DIAMETER**3)
    return merged(
        refinement.dictionaries(BOX[:levels], "tan1 tan2 normal"),
        blockMesh(side, side, height, {"walls": ("wall", "x- x+ y- y+ z-"), "atmosphere": ("patch", "z+")}),
        openTank("slip"),
        level("(0 0 1)"),
        twoFluids(1e-6, 1.48e-5, 998.2, 1.2), gravity(z=-9.82),
        bodies(f"bodies {{ sphere {{ shape {{ type sphere; radius 0.15; }} density {density:.10g}; position (0 0 {_rest(density) + DROP:.8g}); }} }}"),
        control(END, 1e-3, maxDeltaT=run.options.get("step", STEP)))


def _rest(density):
    """Height of the centre at rest: the cap below the water weighs as much as the sphere."""
    r, share = DIAMETER / 2, density / 998.2
    depth = np.roots([-np.pi / 3, np.pi * r, 0, -share * 4 / 3 * np.pi * r**3])
    draft = next(d.real for d in depth if abs(d.imag) < 1e-9 and 0 < d.real < 2 * r)
    return r - draft


def prepare(run, do):
    do("blockMesh")
    refinement.refine(run.options.get("levels", 0), do)
    do("setAlphaField")


def _extremum(t, z, around_, sign):
    near = np.abs(t - around_) < 0.15
    c = np.polyfit(t[near] - around_, z[near], 4)
    fine = np.linspace(-0.15, 0.15, 3001)
    values = sign * np.polyval(c, fine)
    return around_ + fine[values.argmax()], sign * values.max()


def errors(_run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    density = history["sphere"].mass / history["sphere"].volume
    t, z = history.time / PERIOD, (history["sphere"].position[:, 2] - _rest(density)) / DROP
    table = foam.reference(root, "sphereHeaveKramer")      # noqa: F821
    table = table[table[:, 0] < t[-1]]
    own = np.interp(table[:, 0], t, z)
    beyond = np.maximum(0, np.maximum(own - table[:, 3], table[:, 2] - own))
    found = [small("height over time, rms over the drop", float(np.sqrt(np.mean((own - table[:, 1])**2))), source=SOURCE),
             small("largest distance from the experiment's band", beyond.max(), 0.02, "H0", SOURCE)]
    for name, about, sign in (("first trough", 0.51, -1), ("first crest", 1.01, 1), ("second trough", 1.52, -1)):
        mine, published = _extremum(t, z, about, sign), _extremum(*table[:, :2].T, about, sign)
        found.append(relative(name, mine[1], published[1], 0.02, "H0", SOURCE, scale=1))
        if name == "second trough":
            found.append(relative("time of the second trough", mine[0], published[0], 0.01, "Te0", SOURCE))
    return {"comparisons": found}
