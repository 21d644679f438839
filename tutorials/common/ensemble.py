# SPDX-License-Identifier: GPL-3.0-or-later
"""flotsamEnsemble: one case with several values of its entries, and several seeds of its random bodies: what is held, with its interval of confidence, and the forces over the values."""
import argparse
import concurrent.futures
import csv
import itertools
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from collections import namedtuple

import clogging
import flotsam
import matplotlib
import numpy as np
from bodyHistory import CaseError

matplotlib.use("Agg")
import matplotlib.pyplot as plt

Entry = namedtuple("Entry", "file name values")     # name value; stands once in this file of the case
Member = namedtuple("Member", "folder values figures")     # values: of the entries, in their order; figures: of report.json

KEPT = ("0", "0.orig", "constant", "system")        # of the case, besides its files
STEPS = (("blockMesh", "system/blockMeshDict"), ("setFields", "system/setFieldsDict"), ("setExprFields", "system/setExprFieldsDict"),
         ("setExprBoundaryFields", "system/setExprBoundaryFieldsDict"))


def arguments():
    parser = argparse.ArgumentParser(prog="flotsamEnsemble", description="Runs copies of a case, each with other values of some entries, and writes ensemble.md, .csv, .png.",
                                     epilog="example: flotsamEnsemble myRack --vary system/parameters:pitch=0.06,0.08,0.1 --vary constant/bodies:seed=1,2,3 --over pitch")
    parser.add_argument("case", help="folder of the case; it stays as it is")
    parser.add_argument("--vary", action="append", required=True, type=entry, metavar="FILE:ENTRY=V1,V2,..", help="'ENTRY value;' stands once in FILE of the case; several: all combinations")
    parser.add_argument("--over", metavar="ENTRY", help="runs that differ in other entries alone are put together (default: the first of --vary)")
    parser.add_argument("--start", metavar="RUN", help="folder of a run of the same mesh with a state: every run goes on from its latest time, with the bodies that it has not (default: each makes its fields)")
    parser.add_argument("--output", default="ensemble", metavar="FOLDER", help="of the runs and the results (default: ensemble); runs that are complete there are not run again")
    parser.add_argument("--command", metavar="COMMAND", help="makes and runs a case, in its folder (default: blockMesh, setFields or setExprFields where there are their dictionaries, flotsamFoam)")
    parser.add_argument("-j", "--jobs", type=int, default=1, metavar="N", help="so many runs at a time")
    parser.add_argument("--report", default="", metavar="OPTIONS", help="of flotsamReport, in quotes: --report='--direction=x --structures rack'")
    return parser.parse_args()


def entry(text):
    match = re.fullmatch(r"([^:=]+):(\w+)=([^,]+(?:,[^,]+)*)", text)
    if not match:
        raise argparse.ArgumentTypeError(f"'{text}': FILE:ENTRY=VALUE,VALUE,.. is wanted, for instance system/parameters:pitch=0.06,0.08")
    return Entry(match[1], match[2], match[3].split(","))


# --- cases ------------------------------------------------------------------------------------------------------------

def withValue(text, name, value):
    """The text of a dictionary with another value of an entry; how many times the entry stands in it."""
    return re.subn(rf"(?m)(^|[{{;])([ \t]*{name}[ \t]+)[^;{{}}]*;", lambda m: f"{m[1]}{m[2]}{value};", text)


def checkEntries(case, entries):
    for e in entries:
        path = os.path.join(case, e.file)
        if not os.path.isfile(path):
            raise CaseError(f"{path}: no such file")
        with open(path, encoding="utf-8") as file:
            _, count = withValue(file.read(), e.name, e.values[0])
        if count != 1:
            raise CaseError(f"{path}: '{e.name} value;' stands {count} times in it, and must once: make it a parameter of its own, used as ${e.name}")


def startTime(run):
    """The folder of the latest time of a run that has a state to go on from."""
    states = [name for name in (os.listdir(run) if os.path.isdir(run) else []) if flotsam.isTime(name)
              and any(os.path.isfile(os.path.join(run, name, *place)) for place in (("flotsamState.h5",), ("uniform", "flotsamState.h5")))]
    if not os.path.isdir(os.path.join(run, "constant", "polyMesh")) or not states:
        raise CaseError(f"--start {run}: a run of flotsamFoam is wanted, with constant/polyMesh and a time that has flotsamState.h5 or uniform/flotsamState.h5; after a parallel run: reconstructPar -latestTime")
    latest = max(states, key=float)
    later = [name for name in os.listdir(os.path.join(run, "processor0")) if flotsam.isTime(name) and float(name) > float(latest)] if os.path.isdir(os.path.join(run, "processor0")) else []
    if later:
        raise CaseError(f"--start {run}: its processors have time {max(later, key=float)}, it has {latest}: reconstructPar -latestTime")
    return latest


def checkStart(options):
    """Of --start: what of --vary and the case does not go together with a state."""
    latest = startTime(options.start)
    for e in options.vary:
        if e.file.split("/")[0] in ("0", "0.orig"):
            raise CaseError(f"--vary {e.file}: with --start the fields and their boundary conditions are those of {os.path.join(options.start, latest)}")
    with open(os.path.join(options.case, "system", "controlDict"), encoding="utf-8") as file:
        text = file.read()
    if withValue(text, "startFrom", "latestTime")[1] != 1:
        raise CaseError(f"{options.case}/system/controlDict: 'startFrom' must stand once in it")
    end = re.search(r"(?m)^\s*endTime\s+([\d.eE+-]+)\s*;", text)
    if end and float(end[1]) <= float(latest) and not any(e.name == "endTime" for e in options.vary):
        raise CaseError(f"{options.case}/system/controlDict: endTime {end[1]} is not after {latest}, at which the runs go on")


def goOn(folder, start):
    """Lets a case go on from the latest time of a run. Its mesh, unless blockMesh alone makes it: then flotsamFoam tells whether it is the same."""
    latest = startTime(start)
    shutil.rmtree(os.path.join(folder, "0"), ignore_errors=True)
    shutil.copytree(os.path.join(start, latest), os.path.join(folder, latest))
    if not meshesItself(folder):
        shutil.rmtree(os.path.join(folder, "constant", "polyMesh"), ignore_errors=True)
        shutil.copytree(os.path.join(start, "constant", "polyMesh"), os.path.join(folder, "constant", "polyMesh"))
    path = os.path.join(folder, "system", "controlDict")
    with open(path, encoding="utf-8") as file:
        text, _ = withValue(file.read(), "startFrom", "latestTime")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def meshesItself(folder):
    return [os.path.isfile(os.path.join(folder, "system", name)) for name in ("blockMeshDict", "snappyHexMeshDict", "refineMeshDict")] == [True, False, False]


def makeCase(case, folder, entries, values):
    """A copy of the case without its results, with these values."""
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    for name in os.listdir(case):
        path = os.path.join(case, name)
        if os.path.isdir(path) and name in KEPT:
            shutil.copytree(path, os.path.join(folder, name), ignore=shutil.ignore_patterns("polyMesh") if os.path.isfile(os.path.join(case, "system", "blockMeshDict")) else None)
        elif os.path.isfile(path) and not name.startswith("log."):
            shutil.copy(path, folder)
    if os.path.isdir(os.path.join(folder, "0.orig")):
        shutil.rmtree(os.path.join(folder, "0"), ignore_errors=True)
        shutil.copytree(os.path.join(folder, "0.orig"), os.path.join(folder, "0"))
    for e, value in zip(entries, values):
        path = os.path.join(folder, e.file)
        with open(path, encoding="utf-8") as file:
            text, _ = withValue(file.read(), e.name, value)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)


def execute(folder, command, log):
    with open(os.path.join(folder, log), "w", encoding="utf-8") as out:
        code = subprocess.run(command, cwd=folder, shell=isinstance(command, str), stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT, check=False).returncode
    if code:
        raise CaseError(f"{command if isinstance(command, str) else ' '.join(command)} ended with exit code {code}: {os.path.join(folder, log)}")


def checkMesh(folder):
    """flotsamFoam lets a state go on on any mesh with as many cells."""
    for name in ("log.flotsamFoam", "log.command"):
        path = os.path.join(folder, name)
        if os.path.isfile(path):
            with open(path, encoding="utf-8", errors="replace") as file:
                if "the mesh is not that of the stored state" in file.read():
                    raise CaseError(f"{folder}: its mesh is not that of --start, whose points lie elsewhere: {path}")


def run(options, folder, values):
    """A member of the ensemble, run unless its report is there."""
    report = os.path.join(folder, "postProcessing", "flotsam", "report", "report.json")
    if not os.path.isfile(report):
        makeCase(options.case, folder, options.vary, values)
        tools = [tool for tool, file in STEPS if os.path.isfile(os.path.join(folder, file))]
        if options.start:
            goOn(folder, options.start)
            tools = ["blockMesh"] if meshesItself(folder) else []
        steps = [options.command] if options.command else [[tool] for tool in tools + ["flotsamFoam"]]
        for step in steps:
            execute(folder, step, "log." + ("command" if options.command else step[0]))
        checkMesh(folder)
        execute(folder, [sys.executable, os.path.join(os.path.dirname(os.path.abspath(__file__)), "caseReport.py"), "--no-pictures", *shlex.split(options.report)], "log.flotsamReport")
        print(f"{folder}: done", flush=True)
    with open(report, encoding="utf-8") as file:
        return Member(folder, values, json.load(file))


def runAll(options):
    """All combinations. One that fails leaves the others to be run; its message is printed and counted."""
    jobs = {}
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for values in itertools.product(*(e.values for e in options.vary)):
            name = "_".join(re.sub(r"[^\w.+-]+", "-", f"{e.name}-{value}") for e, value in zip(options.vary, values))
            jobs[pool.submit(run, options, os.path.join(options.output, name), values)] = name
    members, failed = [], 0
    for job in jobs:
        try:
            members.append(job.result())
        except CaseError as error:
            failed += 1
            print(f"flotsamEnsemble: {error}", file=sys.stderr)
    return members, failed


# --- results ----------------------------------------------------------------------------------------------------------

Group = namedtuple("Group", "value runs held came low high scatter forces")     # scatter: standard deviation of the runs' shares; forces: {name: (mean, deviation) along the stream [N]}


def together(members, which):
    """A Group for each value of one entry."""
    groups = []
    for value in dict.fromkeys(m.values[which] for m in members):
        figures = [m.figures for m in members if m.values[which] == value]
        bodies = [f["bodies"] for f in figures if "held" in f.get("bodies", {})]
        held, came = sum(b["held"] for b in bodies), sum(b["held"] + b["passed"] for b in bodies)
        low, high = clogging.confidence(held, came) if came else (np.nan, np.nan)
        shares = [b["retention"] for b in bodies if "retention" in b]
        forces = {name: _spread([np.dot(f["direction"], f["forces"][name]["water"]) + np.dot(f["direction"], f["forces"][name]["bodies"]) for f in figures]) for name in figures[0]["forces"]}
        groups.append(Group(value, len(figures), held, came, low, high, np.std(shares, ddof=1) if len(shares) > 1 else np.nan, forces))
    return groups


def _spread(values):
    return np.mean(values), np.std(values, ddof=1) if len(values) > 1 else np.nan


def table(groups, name):
    forces = list(groups[0].forces)
    lines = [f"| {name} | runs | held | of | share | 95 % | scatter of runs |" + "".join(f" force on {f} [N] |" for f in forces), "|" + "---|" * (7 + len(forces))]
    for g in groups:
        share = f"{g.held / g.came:.3g} | {g.low:.2f} to {g.high:.2f}" if g.came else "none came |"
        scatter = "" if np.isnan(g.scatter) else f"{g.scatter:.2g}"
        lines.append(f"| {g.value} | {g.runs} | {g.held} | {g.came} | {share} | {scatter} |" + "".join(f" {_withDeviation(*g.forces[f])} |" for f in forces))
    return "\n".join(lines)


def _withDeviation(mean, deviation):
    return f"{mean:.4g}" if np.isnan(deviation) else f"{mean:.4g} +- {deviation:.2g}"


def plot(groups, name, file):
    try:
        x = [float(g.value) for g in groups]
    except ValueError:
        x = list(range(len(groups)))    # words
    figure, (shares, forces) = plt.subplots(1, 2, figsize=(11, 4))
    _plotShares(shares, [(place, g) for place, g in zip(x, groups) if g.came])
    for one in groups[0].forces:
        forces.errorbar(x, [g.forces[one][0] for g in groups], [np.nan_to_num(g.forces[one][1]) for g in groups], fmt="o-", capsize=3, label=one)
    forces.set(ylabel="force along the stream [N]", title="water and bodies, with the runs' standard deviation")
    if groups[0].forces:
        forces.legend(fontsize=8)
    for axis in (shares, forces):
        axis.set(xlabel=name)
        axis.grid(alpha=0.3)
        if x == list(range(len(groups))):
            axis.set_xticks(x, [g.value for g in groups])
    figure.tight_layout()
    figure.savefig(file, dpi=110)


def _plotShares(axis, points):
    axis.set(ylabel="share held", ylim=(-0.03, 1.03), title="with what chance leaves open (95 %)")
    if points:
        share = np.array([g.held / g.came for _, g in points])
        errors = [share - [g.low for _, g in points], [g.high for _, g in points] - share]
        axis.errorbar([place for place, _ in points], share, np.clip(errors, 0, None), fmt="o-", capsize=3)


def writeRows(members, entries, file):
    with open(file, "w", encoding="utf-8", newline="") as out:
        rows = csv.writer(out, lineterminator="\n")
        rows.writerow([e.name for e in entries] + ["held", "passed", "retention", "folder"])
        for m in members:
            bodies = m.figures.get("bodies", {})
            rows.writerow([*m.values, bodies.get("held"), bodies.get("passed"), bodies.get("retention"), m.folder])


def main():
    options = arguments()
    names = [e.name for e in options.vary]
    try:
        if options.over and options.over not in names:
            raise CaseError(f"--over {options.over}: one of --vary's entries is wanted: {', '.join(names)}")
        checkEntries(options.case, options.vary)
        if options.start:
            checkStart(options)
        members, failed = runAll(options)
        if not members:
            raise CaseError("no run has come to its end")
    except CaseError as error:
        sys.exit(f"flotsamEnsemble: {error}")
    which = names.index(options.over) if options.over else 0
    groups = together(members, which)
    text = f"# {os.path.basename(os.path.abspath(options.case))}\n\n{table(groups, names[which])}\n\n![share held and forces](ensemble.png)\n"
    writeRows(members, options.vary, os.path.join(options.output, "ensemble.csv"))
    plot(groups, names[which], os.path.join(options.output, "ensemble.png"))
    with open(os.path.join(options.output, "ensemble.md"), "w", encoding="utf-8") as out:
        out.write(text)
    print(text + f"\n{len(members)} runs, {failed} failed. Written: {os.path.abspath(options.output)}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
