# SPDX-License-Identifier: GPL-3.0-or-later
"""results/stability.csv, a row per scene, and stability.md made from it: a line per family, then what failed and how to repeat it."""
import contextlib
import csv
import fcntl
import os
import re

import judge

FIGURES = list(judge.BOUNDS)
COLUMNS = ["seed", "number", "family", "scene", "verdict", *FIGURES, "nodes", "cpu", "load", "status", "commit", "machine", "compiler", "date"]


def verdict(row):
    if row["status"] != "ok":
        return "unfinished" if row["status"].startswith("stopped after") else "stopped"
    return ", ".join(row["failed"]) or "passed"


def shown(value):
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def screen(row):
    figures = " ".join(f"{name} {shown(row[name])}" for name in FIGURES if name in row)
    text = figures if row["status"] == "ok" else row["status"]
    verdict = row["verdict"] if row["verdict"] == "passed" else row["verdict"].upper()
    alike = f"; alike {row['alike']}" if "alike" in row else ""
    return f"{row['number']!s:>5} {row['family']} ({row['scene']}): {verdict}; {row.get('cpu', 0):.1f} s{alike}; {text}"


def _order(row):
    """Families apart, whose scenes have names, follow the others."""
    family, number = re.fullmatch(r"([a-zA-Z]*)(\d+)", row["number"]).groups()
    return int(row["seed"]), family, int(number)


def read(path):
    if not os.path.isfile(path):
        return []
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


@contextlib.contextmanager
def locked(path):
    """Two series at once: one reads and writes the files of the results at a time. The lock is on their folder: files are replaced."""
    folder = os.open(os.path.dirname(path), os.O_RDONLY)
    try:
        fcntl.flock(folder, fcntl.LOCK_EX)
        yield
    finally:
        os.close(folder)


def put(path, row):
    """Stores at once, beside what others have stored meanwhile."""
    mine = (str(row["seed"]), str(row["number"]))
    with locked(path):
        rows = [r for r in read(path) if (r["seed"], r["number"]) != mine] + [{name: shown(row.get(name, "")) for name in COLUMNS}]
        rows.sort(key=_order)
        with open(path + ".new", "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS)
            writer.writeheader()
            writer.writerows(rows)
        os.replace(path + ".new", path)


def _worst(rows, name):
    values = [float(r[name]) for r in rows if r.get(name) and r["status"] == "ok"]
    return f"{max(values):.2g}" if values else ""


def write(path, csvPath, families, bounds):
    """The page, from the rows there are by then."""
    with locked(path):
        _writePage(path, read(csvPath), families, bounds)


def _writePage(path, rows, families, bounds):
    passed = sum(r["verdict"] == "passed" for r in rows)
    commits, machines = (", ".join(dict.fromkeys(r[name] for r in rows)) for name in ("commit", "machine"))
    lines = ["# Numerical stability", "",
             f"Random scenes, each judged by properties that any stable solution has: **{passed} of {len(rows)} passed** (commit {commits}; {machines}).",
             "Regenerate: `benchmarks/stability/run` (scenes 0 to 259), `benchmarks/stability/run --from 260` (the next 260);",
             "families jam, shapes, passing, tied, refined, mixed: `benchmarks/stability/run --family jam --count 20`;",
             "one scene again: `benchmarks/stability/run --seed S NUMBER`; this page alone: `benchmarks/stability/run --report`.", "",
             "## Bounds", "", "| figure | bound | what it is |", "|---|---|---|"]
    lines += [f"| {name} | {'' if limit is None else limit} | {text} |" for name, (limit, text) in bounds.items()]
    lines += ["", "## Worst figures by family", "", "Of the scenes that ended; empty: the figure does not apply.", "",
              "| family | scenes | passed | " + " | ".join(FIGURES) + " |", "|---|---|---|" + "---|" * len(FIGURES)]
    for family in [*families, "all"]:
        mine = [r for r in rows if family in (r["family"], "all")]
        if mine:
            passed = sum(r["verdict"] == "passed" for r in mine)
            lines.append(f"| {family} | {len(mine)} | {passed} | " + " | ".join(_worst(mine, name) for name in FIGURES) + " |")
    lines += ["", "## Scenes that failed", "", "| seed | number | family | scene | verdict | figure or message |", "|---|---|---|---|---|---|"]
    for r in rows:
        if r["verdict"] != "passed":
            text = r["status"] if r["status"] != "ok" else ", ".join(f"{name} {r[name]}" for name in r["verdict"].split(", "))
            lines.append(f"| {r['seed']} | {r['number']} | {r['family']} | {r['scene']} | {r['verdict']} | {text} |")
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
