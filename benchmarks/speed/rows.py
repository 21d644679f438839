# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of speed.csv: one per scene, size and solver; a new measurement replaces its row. Times are processor microseconds per point and step,
points being our nodes and the peers' cells."""
import csv
import os

from steps import PHASES

KEY = ["scene", "size", "solver"]
COLUMNS = [*KEY, "cells", "nodes", "steps", "dt", "repeats", "total", "ratio", *PHASES, "iterations", "peakMB", "startup", "load", "status", "commit", "machine", "compiler", "date"]


def perPoint(measured, cells):
    """Seconds a step, kB -> what the table holds."""
    count = measured.get("nodes", cells)
    row = {"nodes": int(measured["nodes"]) if "nodes" in measured else "", "total": 1e6 * measured["cpu"] / count, "iterations": measured.get("iterations", ""),
           "peakMB": measured["peak"] / 1024, "startup": measured["startup"]}
    row.update({p: 1e6 * measured[p] / count for p in PHASES if p in measured})
    return row


def markdown(head, lines):
    cells = [[str(c) for c in line] for line in [head] + lines]
    width = [max(len(line[i]) for line in cells) for i in range(len(head))]
    text = ["| " + " | ".join(c.ljust(w) for c, w in zip(line, width)) + " |" for line in cells]
    return "\n".join([text[0], "|" + "|".join("-" * (w + 2) for w in width) + "|"] + text[1:])


def number(row, column):
    try:
        return float(row.get(column, ""))
    except ValueError:
        return None


def _shown(value):
    return f"{value:.5g}" if isinstance(value, float) else str(value)


def line(row):
    name = f"{row['scene']} {row['size'] or ''} {row['solver']}:"
    if row["status"] != "ok":
        return f"{name} FAILED, {row['status']}"
    return f"{name} {row['total']:.2f} us per point and step, {row['iterations']:.1f} iterations, {row['peakMB']:.0f} MB"


class Rows:
    def __init__(self, path):
        self._path, self._rows = path, {}
        if os.path.isfile(path):
            with open(path, newline="", encoding="utf-8") as file:
                self._rows = {tuple(row[k] for k in KEY): row for row in csv.DictReader(file)}

    def put(self, row):
        """Stores at once: a long series that is stopped keeps what it has."""
        self._rows[tuple(str(row[k]) for k in KEY)] = {column: _shown(row.get(column, "")) for column in COLUMNS}
        with open(self._path, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS)
            writer.writeheader()
            writer.writerows(self.all())

    def all(self):
        return sorted(self._rows.values(), key=lambda r: (not r["scene"].startswith("dam break"), r["scene"], int(r["size"]), r["solver"]))
