# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene on several processes: its beginning on one and on several, then the whole of it on several, judged as on one."""
import os
import shutil

import caseFiles
import ranks
import scenes
import table
from runner import cases, environment, execute


class DividedCase(caseFiles.SceneCase):
    """A scene on n processes; n = 1: on one. beginning: its first steps alone, nothing judged."""

    def __init__(self, scene, root, n, division, beginning):
        super().__init__(scene, root)
        self.n, self.beginning = n, beginning
        self.word, self.divided = ranks.division(scene, n, division) if n > 1 else ("", {})

    def files(self, run, folder):
        return {**super().files(run, folder), **self.divided}

    def _control(self):
        made = super()._control()
        if not self.beginning:
            return made
        s, (first, end) = self.scene, ranks.beginning(self.scene)
        text = made["system/controlDict"]
        for entry, value in (("deltaT ", first), ("endTime ", end), ("writeInterval ", end), ("maxDeltaT ", s.endTime), ("writePrecision ", 14), ("timePrecision ", 12)):
            text = _replaced(text, entry, value)
        return {**made, "system/controlDict": text}

    def prepare(self, run, do):
        super().prepare(run, do)
        if self.n > 1:
            do("decomposePar")
        self.do = do

    def errors(self, run, folder):
        if self.n > 1:
            self.do("reconstructPar")
        return {} if self.beginning else super().errors(run, folder)


def _replaced(text, entry, value):
    return "\n".join(f"{entry}  {value:.14g};" if line.startswith(entry) else line for line in text.split("\n"))


def _run(seed, number, options, root, n, beginning):
    s = scenes.scene(seed, number)
    s.seed = seed
    s.options += [options.options] * bool(options.options) + [ranks.CONVERGED] * beginning
    case = DividedCase(s, root, n, options.division, beginning)
    limit = options.limit or (600 if s.family in scenes.APART else 60) * n
    parallel = {"launcher": ranks.launcher(n), "arguments": ["-parallel"]} if n > 1 else {}
    variant = f"{'begin' if beginning else 'whole'}{n}"
    run = cases.Run("flotsamFoam", number, variant, timeLimit=limit, options=parallel)
    with_ = os.path.join(options.runs, f"seed{seed}")
    row = execute.execute(case, run, with_, environment.provenance(root), keep=True)
    row["folder"] = os.path.join(with_, f"flotsamFoam-{variant}_{number}")
    return s, case, row


def one(seed, number, options, root):
    """Row of a scene; `alike`: difference of the beginning from that of one process."""
    begun = [_run(seed, number, options, root, n, True) for n in (1, options.ranks)]
    s, case, row = _run(seed, number, options, root, options.ranks, False)
    row.update(seed=seed, number=number, family=s.family,
               scene=", ".join(s.what + [f"{len(s.bodies)} bodies"] * bool(s.bodies) + s.options + [f"divided: {case.word}"]))
    notes = []
    for _, _, begin in begun:
        if begin["status"] != "ok":
            notes.append(f"beginning: {begin['status']}")
    if not notes:
        found, steps = ranks.difference(s, root, *(begin["folder"] for _, _, begin in begun))
        worst = max(found, key=found.get) if found else ""
        row["alike"] = f"{found[worst]:.1e} ({worst})" if found else f"{steps[0]} and {steps[1]} steps"
        if not found or not found[worst] <= ranks.ALIKE:
            notes.append("beginning " + row["alike"])
    row["verdict"] = "; ".join([v for v in (table.verdict(row),) if v != "passed" or not notes] + notes)
    if row["verdict"] == "passed" and not options.keep and not options.number:
        for folder in [row["folder"]] + [begin["folder"] for _, _, begin in begun]:
            shutil.rmtree(folder)
    return row
