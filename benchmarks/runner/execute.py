# SPDX-License-Identifier: GPL-3.0-or-later
"""One run: case folder, mesh, the solver alone under the clock, errors. What goes wrong becomes the row's status."""
import datetime
import os
import re
import shutil
import subprocess
import threading

from . import environment


class RunFailed(RuntimeError):
    """The reason goes into the row."""


def execute(case, run, runsFolder, provenance, keep):
    """The row of one run."""
    folder = os.path.join(runsFolder, f"{run.label.replace(' ', '-')}_{run.n}")
    row = {"case": case.name, "solver": run.solver, "variant": run.variant, "N": run.n, "status": "ok", **provenance,
           "date": datetime.date.today().isoformat()}
    try:
        _makeCase(case, run, folder)
        case.prepare(run, lambda *command: _do(folder, command))
        row["load"] = os.getloadavg()[0]
        row["cpu"] = _timed(case, run, folder)
        row.update(_sizes(folder))
        row.update(case.errors(run, folder))
    except Exception as error:      # whatever it is, it is a row: a series goes on
        row["status"] = " ".join(str(error).split()) or type(error).__name__
        if os.path.isfile(os.path.join(folder, "log.solver")):
            row.update(_sizes(folder))
    if row["status"] == "ok" and not keep:
        shutil.rmtree(folder)
    return row


def _makeCase(case, run, folder):
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(os.path.join(folder, "system"))
    for base in (case.folder, os.path.join(case.folder, run.solver)):       # a solver's own files replace the common ones
        for part in ("0.orig", "constant", "system"):
            if os.path.isdir(os.path.join(base, part)):
                shutil.copytree(os.path.join(base, part), os.path.join(folder, part), dirs_exist_ok=True)
    if os.path.isdir(os.path.join(folder, "0.orig")):
        shutil.copytree(os.path.join(folder, "0.orig"), os.path.join(folder, "0"))
    for path, text in getattr(case, "files", lambda *_: {})(run, folder).items():
        os.makedirs(os.path.dirname(os.path.join(folder, path)), exist_ok=True)
        with open(os.path.join(folder, path), "w", encoding="utf-8") as out:
            out.write(text)
    entries = {"solver": run.solver, **case.parameters(run)}
    with open(os.path.join(folder, "system", "parameters"), "w", encoding="utf-8") as out:
        out.writelines(f"{name} {value};\n" for name, value in entries.items())


def _do(folder, command):
    """Preparation: output into log.<command>."""
    name = os.path.basename(command[0])
    with open(os.path.join(folder, "log." + name), "a", encoding="utf-8") as log:
        done = subprocess.run(command, cwd=folder, env=environment.settings(), stdout=log, stderr=subprocess.STDOUT, check=False)
    if done.returncode:
        raise RunFailed(f"{name} failed: {_reason(os.path.join(folder, 'log.' + name))}")


def _timed(case, run, folder):
    """User CPU seconds of the solver process alone (no mesh, no start fields; its function objects are counted)."""
    launcher = run.options.get("launcher", [])      # mpirun and its arguments
    command = [*launcher, environment.program(case.root, run.solver, run.rebuilt), *run.options.get("arguments", [])]
    log = os.path.join(folder, "log.solver")
    with open(log, "w", encoding="utf-8") as out:
        process = subprocess.Popen(command, cwd=folder, env=environment.settings(), stdout=out, stderr=subprocess.STDOUT)
        isLate = threading.Event()
        stop = process.terminate if launcher else process.kill     # mpirun kills its processes, after asking them to end
        watch = threading.Timer(run.timeLimit, lambda: (isLate.set(), stop()))
        watch.start()
        try:
            _, state, usage = os.wait4(process.pid, 0)
        except BaseException:       # the series is stopped: so is its solver
            stop()
            raise
        finally:
            watch.cancel()
        process.returncode = os.waitstatus_to_exitcode(state)
    if isLate.is_set():
        raise RunFailed(f"stopped after {run.timeLimit:g} s at t = {_lastTime(log)} s")
    if process.returncode:
        raise RunFailed(f"exit code {process.returncode} at t = {_lastTime(log)} s: {_reason(log)}")
    return usage.ru_utime


def _text(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read()


def _reason(log):
    """First lines of OpenFOAM's fatal error, or the last line of the log."""
    text = _text(log)
    error = re.search(r"--> FOAM FATAL (?:IO )?ERROR:?\s*(.*?)(?:\n\s*\n|\n\s*From|$)", text, re.DOTALL)
    if error and error.group(1).strip():
        return " ".join(error.group(1).split())[:300]
    lines = [line for line in text.splitlines() if line.strip()]
    return lines[-1].strip()[:200] if lines else "no output"


OUR_STEP = re.compile(r"^ +\d+ +([\d.eE+-]+) +[\d.eE+-]+ +[a-z]+ +\d+", re.MULTILINE)
PEER_STEP = re.compile(r"^Time = (\S+)", re.MULTILINE)


def _lastTime(log):
    text = _text(log)
    times = OUR_STEP.findall(text) or PEER_STEP.findall(text)
    return times[-1] if times else "0"


def _sizes(folder):
    """Steps; cells of the mesh; our unknown points."""
    text = _text(os.path.join(folder, "log.solver"))
    sizes = {"steps": len(OUR_STEP.findall(text) or PEER_STEP.findall(text))}
    nodes = re.search(r"(\d+) nodes,", text)
    if nodes:
        sizes["nodes"] = int(nodes.group(1))
    mesh = os.path.join(folder, "log.blockMesh")
    cells = re.findall(r"nCells:\s*(\d+)", _text(mesh)) if os.path.isfile(mesh) else []
    if cells:
        sizes["cells"] = int(cells[-1])
    return sizes
