# SPDX-License-Identifier: GPL-3.0-or-later
"""What a benchmark case is: the folder cases/<name> with an OpenFOAM case (0.orig, constant, system) and case.py, which defines

title, figures   what is computed; {column: (label, unit)} of what errors() returns
mainError        the column that stands for accuracy in plots and tables; moreErrors: further such columns, may be missing
runs             list of Run: solvers, resolutions, variants
parameters(run)  entries of system/parameters, included by the case's dictionaries, may be missing
files(run, folder)  {path: text} of further files of the case folder, may be missing
prepare(run, do) mesh and start fields: do("blockMesh") runs a command in the case folder, which is all it does where it is missing; time not counted
errors(run, folder)  {column: value} from the finished run, the same formula for all solvers
targets          list of Target, may be missing
problem(variant) names the problem that a variant belongs to: only runs of one problem are compared; may be missing
problemsApart    True: a picture for each problem; may be missing
"""
import importlib.util
import os
from dataclasses import dataclass, field


@dataclass
class Run:
    solver: str
    n: int                      # resolution; what it counts is said by the case
    variant: str = ""           # names what is not default
    options: dict = field(default_factory=dict)
    quick: bool = False         # also with --quick
    timeLimit: float = 1500     # wall seconds; a run that takes longer is a failed row
    rebuilt: bool = False       # the mesh is non-orthogonal: the solvers of interFoam's kind as rebuilt by peers/rebuild.sh

    @property
    def label(self):
        return self.solver + (" " + self.variant if self.variant else "")


def series(solver, sizes, quick=1, **rest):
    """Runs of one solver at several resolutions, of which the first `quick` are also in the quick set."""
    return [Run(solver, n, quick=i < quick, **rest) for i, n in enumerate(sizes)]


@dataclass
class Target:
    column: str                 # of the rows: a figure, or cpu
    limit: float                # at most; of errors with either sign the size counts
    text: str
    n: int = 0                  # resolution it holds for; 0: every one
    variant: str = None         # likewise; None: every one
    isLeast: bool = False       # at least, with its sign

    def holdsFor(self, row):
        return (not self.n or int(row["N"]) == self.n) and (self.variant is None or row["variant"] == self.variant)

    def isReached(self, value):
        return value >= self.limit if self.isLeast else abs(value) <= self.limit


ORDER = ["damBreak2D", "cylinder2D1", "sloshing2D", "hydrostatic", "advection", "heaveCylinder2D", "marin3D"]


def names(root, part="cases", order=None):
    order = ORDER if order is None else order
    found = [n for n in os.listdir(os.path.join(root, part)) if os.path.isfile(os.path.join(root, part, n, "case.py"))]
    return sorted(found, key=lambda n: (order.index(n) if n in order else len(order), n))


def load(root, name, part="cases"):
    path = os.path.join(root, part, name)
    if not os.path.isfile(os.path.join(path, "case.py")):
        raise SystemExit(f"{part}: no case '{name}'; there are: {', '.join(names(root, part))}")
    spec = importlib.util.spec_from_file_location(name, os.path.join(path, "case.py"))
    case = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(case)
    for part, default in (("parameters", lambda _run: {}), ("prepare", lambda _run, do: do("blockMesh"))):
        if not hasattr(case, part):
            setattr(case, part, default)
    case.name, case.folder, case.root = name, path, root
    return case
