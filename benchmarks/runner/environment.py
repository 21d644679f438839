# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the programs are, and where a result comes from."""
import functools
import os
import platform
import re
import shutil
import subprocess

OUR_PROGRAMS = ("flotsamFoam", "transportTable")


def _buildFolder(root):
    return os.path.abspath(os.environ.get("FLOTSAM_BUILD", os.path.join(os.path.dirname(root), "build"))) # runs have folders of their own


def settings():
    """Environment of every run: OpenFOAM's folder, Open MPI as root, one thread."""
    result = dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    if "WM_PROJECT_DIR" not in result and os.path.isfile("/usr/share/openfoam/etc/controlDict"):
        result["WM_PROJECT_DIR"] = "/usr/share/openfoam"
    return result


@functools.lru_cache(maxsize=1)
def rebuiltFolder(root):
    """Folder of the rebuilt peers; the first call may compile for a minute."""
    run = subprocess.run([os.path.join(root, "peers", "rebuild.sh")], capture_output=True, text=True, check=False)
    if run.returncode:
        raise RuntimeError("peers/rebuild.sh: " + (run.stderr.strip().splitlines() or ["failed"])[-1])
    return run.stdout.strip().splitlines()[-1]


def program(root, name, rebuilt):
    """Path of a solver. Raises RuntimeError with the reason when it is not there."""
    if name in OUR_PROGRAMS:
        path = shutil.which(name, path=os.path.join(_buildFolder(root), "bin"))
        if not path:
            raise RuntimeError(f"{name} is not in {_buildFolder(root)}/bin (FLOTSAM_BUILD)")
        return path
    if rebuilt and name in ("interFoam", "interIsoFoam", "overInterDyMFoam"):
        return os.path.join(rebuiltFolder(root), name)
    path = shutil.which(name)
    if not path:
        raise RuntimeError(f"{name} is not installed")
    return path


def _output(command, folder):
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False).stdout.strip()


def _machine():
    with open("/proc/cpuinfo", encoding="utf-8") as info:
        model = re.search(r"model name\s*:\s*(.*)", info.read())
    return f"{model.group(1) if model else platform.machine()} x{os.cpu_count()}"


def _compiler(root):
    try:
        with open(os.path.join(_buildFolder(root), "CMakeCache.txt"), encoding="utf-8") as cache:
            compiler = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", cache.read(), re.MULTILINE)
    except OSError:
        return ""
    return _output([compiler.group(1), "--version"], None).splitlines()[0] if compiler else ""


def provenance(root):
    """Commit of the program, machine and compiler. A + after the commit: sources have changed since it, or the program is older than it.
    FLOTSAM_COMMIT says it for a program built from another folder."""
    commit = os.environ.get("FLOTSAM_COMMIT")
    if not commit:
        commit = _output(["git", "rev-parse", "--short", "HEAD"], root)
        sources = ["../fluidSolver", "../demCoupling"]
        changed = _output(["git", "status", "--porcelain", "--untracked-files=no", "--", *sources], root)
        last = _output(["git", "log", "-1", "--format=%ct", "--", *sources], root)
        binary = os.path.join(_buildFolder(root), "bin", "flotsamFoam")
        isOld = os.path.isfile(binary) and last and os.path.getmtime(binary) < float(last)
        commit += "+" if changed or isOld else ""
    return {"commit": commit, "machine": _machine(), "compiler": _compiler(root)}
