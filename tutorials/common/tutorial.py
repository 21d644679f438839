# SPDX-License-Identifier: GPL-3.0-or-later
"""What the validate and pictures scripts of the tutorials share: parameters of a case, and the verdict with its exit code."""
import math
import os
import re
import subprocess
import sys

import flotsam


def parameters(case, file):
    """Top-level 'name value;' entries of a dictionary, macros expanded by OpenFOAM; numbers as float, the rest as text."""
    text = subprocess.run(["foamDictionary", "-expand", file], cwd=case, check=True, capture_output=True, text=True).stdout
    result = {}
    for name, value in re.findall(r"^(\w+)\s+([^;{}]+);", text, re.MULTILINE):
        try:
            result[name] = float(value)
        except ValueError:
            result[name] = value
    return result


def history(case):
    """Time series of a case's bodies and structures."""
    return flotsam.history(os.path.join(case, "postProcessing", "flotsam"))


def resultsFolder(case="."):
    """Folder for pictures and summary of a case, made."""
    folder = os.path.join(case, "results")
    os.makedirs(folder, exist_ok=True)
    return folder


class Report:
    def __init__(self, title):
        self.title = title
        self.rows = []
        self.failed = []

    def compare(self, what, value, reference, tolerance, unit="", source=""):
        """Relative error against a reference that is not zero."""
        error = (value - reference) / reference
        self._add(what, value, f"{reference:.6g}", f"{100 * error:+.2f} %", f"{100 * tolerance:g} %", unit, abs(error) <= tolerance, source)

    def within(self, what, value, low, high, unit="", source=""):
        self._add(what, value, f"{low:g} .. {high:g}", "", "", unit, low <= value <= high, source)

    def show(self, what, value, unit="", source=""):
        """A number without a verdict."""
        self._add(what, value, "", "", "", unit, None, source)

    def _add(self, what, value, reference, error, tolerance, unit, good, source):
        if good is not None and not (good and math.isfinite(value)):
            allowed = f"{reference} within {tolerance}" if tolerance else reference
            self.failed.append(f"{what} is {value:.6g} {unit}".rstrip() + f", allowed {allowed}")
            good = False
        self.rows.append((what, f"{value:.6g}", reference, error, tolerance, unit, {True: "ok", False: "FAILED", None: ""}[good], source))

    def table(self):
        """Markdown, also readable on a screen."""
        head = ("quantity", "computed", "reference", "error", "allowed", "unit", "", "reference is")
        width = [max(len(r[i]) for r in [head] + self.rows) for i in range(len(head))]
        lines = [head, tuple("-" * w for w in width)] + self.rows
        return "\n".join("| " + " | ".join(c.ljust(w) for c, w in zip(line, width)) + " |" for line in lines)

    def end(self):
        print(f"\n{self.title}\n\n{self.table()}\n")
        if self.failed:
            print("NOT BELIEVABLE:\n  " + "\n  ".join(self.failed))
        else:
            print("All within what is allowed.")
        sys.exit(1 if self.failed else 0)
