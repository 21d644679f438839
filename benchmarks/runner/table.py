# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of a case's results in a CSV file, one per (solver, variant, N); a new run replaces its row."""
import csv
import os

BEFORE = ["case", "solver", "variant", "N", "cells", "nodes", "steps", "cpu", "load"]
AFTER = ["status", "commit", "machine", "compiler", "date"]


def shown(value):
    return f"{value:.5g}" if isinstance(value, float) else str(value)


def number(row, column):
    """The value of a column, None where there is none."""
    try:
        return float(row.get(column, ""))
    except ValueError:
        return None


def key(row):
    return row["solver"], row["variant"], int(row["N"])


class Rows:
    def __init__(self, path, case):
        self._path = path
        self._columns = BEFORE + list(case.figures) + AFTER
        self._order = {(r.solver, r.variant, r.n): i for i, r in enumerate(case.runs)}
        self._rows = {}
        self._read()

    def _read(self):
        if os.path.isfile(self._path):
            with open(self._path, newline="", encoding="utf-8") as file:
                self._rows = {key(row): row for row in csv.DictReader(file)}

    def put(self, row):
        """Stores at once: a long series that is stopped keeps what it has."""
        self._read()
        self._rows[key(row)] = {column: shown(row.get(column, "")) for column in self._columns}
        with open(self._path, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, self._columns, extrasaction="ignore", restval="")
            writer.writeheader()
            writer.writerows(self.all())

    def all(self):
        """In the case's order; rows of runs the case no longer has are dropped."""
        return sorted((r for r in self._rows.values() if key(r) in self._order), key=lambda r: self._order[key(r)])


def line(case, row):
    """What the screen shows of a run."""
    name = f"{case.name} {row['solver']} {row['variant']} N {row['N']}:".replace("  ", " ")
    if row["status"] != "ok":
        return f"{name} FAILED, {row['status']}"
    figures = " ".join(f"{column} {shown(row[column])}" for column in case.figures if column in row)
    return f"{name} {row['steps']} steps, {row['cpu']:.2f} s, {figures}"
