# SPDX-License-Identifier: GPL-3.0-or-later
"""Readers of ascii OpenFOAM output (numpy only) and of our bodies.h5."""
import glob
import os
import re
import sys

import numpy as np


def field(path):
    """internalField of an ascii volume field: n values or n x 3; a uniform one comes back as a scalar or one vector."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    text = text[text.index("internalField"):]
    uniform = re.match(r"internalField\s+uniform\s+([^;]+);", text)
    if uniform:
        return np.array(uniform.group(1).strip("() ").split(), float).squeeze()
    head = re.match(r"internalField\s+nonuniform\s+List<(\w+)>\s*(\d+)\s*\(", text)
    kind, n = head.group(1), int(head.group(2))
    body = text[head.end():]
    if kind == "scalar":
        return np.array(body.split(None, n)[:n], float)
    body = body[:body.index("\n)")]
    return np.array(body.replace("(", " ").replace(")", " ").split(), float).reshape(n, -1)


def table(folder, pattern):
    """Numbers of the files of a function object, below postProcessing; comment lines and brackets dropped."""
    rows = []
    files = sorted(glob.glob(os.path.join(folder, "postProcessing", pattern)))
    if not files:
        raise RuntimeError(f"no postProcessing/{pattern}")
    for name in files:
        with open(name, encoding="utf-8") as file:
            for line in file:
                if line.strip() and not line.startswith("#"):
                    rows.append([float(x) for x in line.replace("(", " ").replace(")", " ").split()])
    n = min(map(len, rows))
    return np.array([row[:n] for row in rows])


def sampled(folder, function):
    """(time, folder) of a function object that writes a folder per time, ascending."""
    base = os.path.join(folder, "postProcessing", function)
    if not os.path.isdir(base):
        raise RuntimeError(f"no postProcessing/{function}")
    return sorted((float(t), os.path.join(base, t)) for t in os.listdir(base))


def resultReader(root):
    """tutorials/common/flotsam.py, which reads our fields and bodies.h5."""
    common = os.path.join(os.path.dirname(root), "tutorials", "common")
    if common not in sys.path:
        sys.path.insert(0, common)
    import flotsam
    return flotsam


def history(root, folder):
    """Series of our bodies and structures."""
    return resultReader(root).history(os.path.join(folder, "postProcessing", "flotsam"))


def reference(root, name):
    """Numbers of validation/reference/<name>.csv; lines beginning with # or a letter are text."""
    with open(os.path.join(root, "validation", "reference", name + ".csv"), encoding="utf-8") as file:
        return np.array([[float(x) for x in line.split(",")] for line in file if line.strip() and not (line[0] == "#" or line[0].isalpha())])
