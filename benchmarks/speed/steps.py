# SPDX-License-Identifier: GPL-3.0-or-later
"""Processor time of a time step of fixed length, free of start-up and of the first steps: peers print their clock at every step; of ours, runs of few
and of many steps are subtracted phase by phase."""
import os
import re
import statistics
import subprocess
import threading

from runner import environment
from runner.execute import RunFailed

PHASES = ["flow assembly", "flow solve", "phase field", "cut", "DEM", "exchange", "output", "other"]
SUMMARY_ROW = r"^  %s +([\d.]+) +[\d.]+ +([\d.]+) +[\d.]+$"        # wall, processor seconds
OUR_STEP = re.compile(r"^ +\d+ +[\d.eE+-]+ +[\d.eE+-]+ +[a-z]+ +(\d+) +(\d+) ", re.MULTILINE)
OUR_TIMES = re.compile(r"^ +\d+ +[\d.eE+-]+ +[\d.eE+-]+ +[a-z]+ .*\| *(?:\d+ +){5}(\d+) +\| *([\d.eE+-]+) ", re.MULTILINE)   # other %, wall s
EXECUTION_TIME = re.compile(r"^ExecutionTime = ([\d.]+) s", re.MULTILINE)
SUMMARY_NODES = re.compile(r"^Summary:.* (\d+) nodes", re.MULTILINE)
PEER_STEP = re.compile(r"^Time = \S+.*?^ExecutionTime", re.MULTILINE | re.DOTALL)
PEER_ITERATIONS = re.compile(r"Solving for p_rgh,.*No Iterations (\d+)")


def write(folder, stepSize, count, start=0, writeLast=False):
    """system/steps, which controlDict includes last. writeLast: fields of the last step, ascii."""
    with open(os.path.join(folder, "system", "steps"), "w", encoding="utf-8") as out:
        out.write(f"adjustTimeStep no; deltaT {stepSize:.10g}; endTime {start + count * stepSize:.10g}; "
                  f"writeControl timeStep; writeInterval {count if writeLast else 1000000}; writeFormat ascii; writePrecision 16;\n")


def do(folder, *command):
    """A step of the preparation."""
    log = os.path.join(folder, "log." + os.path.basename(command[0]))
    with open(log, "w", encoding="utf-8") as out:
        done = subprocess.run(command, cwd=folder, env=environment.settings(), stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT, check=False)
    if done.returncode:
        raise RunFailed(f"{os.path.basename(command[0])} ended with exit code {done.returncode}: {log}")


def run(command, folder, limit=3600, extra=None):
    """User CPU seconds of one process (or of mpirun and its children), its peak memory [kB] and its output."""
    log = os.path.join(folder, "log.solver")
    with open(log, "w", encoding="utf-8") as out:
        process = subprocess.Popen(command, cwd=folder, env={**environment.settings(), **(extra or {})}, stdin=subprocess.DEVNULL, stdout=out,
                                   stderr=subprocess.STDOUT)
        watch = threading.Timer(limit, process.kill)
        watch.start()
        try:
            _, status, usage = os.wait4(process.pid, 0)
        except BaseException:
            process.kill()
            raise
        finally:
            watch.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RunFailed(f"{os.path.basename(command[0])} ended with exit code {process.returncode}: {log}")
    with open(log, encoding="utf-8", errors="replace") as file:
        return {"user": usage.ru_utime, "peak": usage.ru_maxrss, "log": file.read()}


def phases(log):
    """{phase: (wall, processor seconds)} of our summary table."""
    rows = {p: re.search(SUMMARY_ROW % p, log, re.MULTILINE) for p in [*PHASES, "all"]}
    if not rows["all"]:
        raise RunFailed("the run printed no summary table")
    return {p: (float(row.group(1)), float(row.group(2))) for p, row in rows.items() if row}


def iterations(log, first):
    """Mean linear iterations a step after the first ones; peers: of the pressure, all correctors."""
    ours = OUR_STEP.findall(log)
    counts = [int(i) for i, _ in ours] or [sum(map(int, PEER_ITERATIONS.findall(block))) for block in PEER_STEP.findall(log)]
    return statistics.mean(counts[first:]) if len(counts) > first else None


def _otherShare(log, first):
    """Share of a step that belongs to no phase, from the step lines after the first ones: the summary's `other` has the start-up in it."""
    lines = OUR_TIMES.findall(log)[first:]
    return sum(float(wall) * int(rest) / 100 for rest, wall in lines) / sum(float(wall) for _, wall in lines)


def _ours(command, folder, write_, few, many, extra):
    write_(few)
    first = run(command, folder, extra=extra)
    write_(many)
    last = run(command, folder, extra=extra)
    before, after = phases(first["log"]), phases(last["log"])
    row = {p: (after[p][1] - before[p][1]) / (many - few) for p in PHASES if p in after and p != "other"}
    share = _otherShare(last["log"], few)
    row["other"] = sum(row.values()) * share / (1 - share)
    return {**row, "cpu": sum(row.values()), "peak": last["peak"], "startup": first["user"], "iterations": iterations(last["log"], few),
            "nodes": int(SUMMARY_NODES.search(last["log"]).group(1))}


def _peers(command, folder, write_, few, many):
    write_(many)
    result = run(command, folder)
    clock = [float(t) for t in EXECUTION_TIME.findall(result["log"])]
    if len(clock) != many:
        raise RunFailed(f"{len(clock)} steps instead of {many} in {folder}")
    return {"cpu": (clock[-1] - clock[few - 1]) / (many - few), "peak": result["peak"], "startup": clock[few - 1], "iterations": iterations(result["log"], few)}


def measure(command, folder, stepSize, few, many, start=0, writeLast=False, extra=None):
    """{cpu: processor seconds a step, <phase>: the same by phase (ours), iterations, peak [kB], startup: processor seconds up to the first timed step}.
    extra: of our program's environment."""
    def write_(count):
        write(folder, stepSize, count, start, writeLast and count == many)
    isOurs = os.path.basename(command[0]) == "flotsamFoam"
    return _ours(command, folder, write_, few, many, extra) if isOurs else _peers(command, folder, write_, few, many)


def medians(rows):
    """Entry by entry over repeats."""
    return {key: statistics.median(row[key] for row in rows) for key in rows[0] if all(row[key] is not None for row in rows)}
