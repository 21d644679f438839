# SPDX-License-Identifier: GPL-3.0-or-later
"""results/validation.csv, a line per compared figure, and validation.md made from it. A new run replaces its own lines."""
import csv
import os
import textwrap

from .compare import shown

COLUMNS = ["case", "variant", "N", "resolution", "quantity", "value", "reference", "unit", "error", "errorUnit", "target", "verdict", "source",
           "nodes", "steps", "cpu", "load", "status", "commit", "machine", "compiler", "date"]
SHARED = ["variant", "N", "nodes", "steps", "cpu", "load", "status", "commit", "machine", "compiler", "date"]


def _text(value):
    return "" if value is None else f"{value:.6g}" if isinstance(value, float) else str(value)


def read(path):
    if not os.path.isfile(path):
        return []
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def put(path, case, run, row):
    """Stores a run's figures (row: what runner.execute returns, with `comparisons` where the run went well) at once."""
    shared = {name: _text(row.get(name, "")) for name in SHARED}
    shared["case"], shared["resolution"] = case.name, case.resolution(run)
    lines = []
    for c in row.get("comparisons", []):
        lines.append({**shared, "quantity": c.quantity, "value": _text(c.value), "reference": _text(c.reference), "unit": c.unit, "error": _text(c.error),
                      "errorUnit": c.errorUnit, "target": _text(c.target), "verdict": c.verdict, "source": c.source})
    if not lines:
        lines = [shared]
    mine = (case.name, run.variant, str(run.n))
    rest = [line for line in read(path) if (line["case"], line["variant"], line["N"]) != mine]
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, extrasaction="ignore", restval="")
        writer.writeheader()
        writer.writerows(rest + lines)


def screen(case, run, row):
    name = f"{case.name} {run.variant} N {run.n}:".replace("  ", " ")
    if row["status"] != "ok":
        return f"{name} FAILED, {row['status']}"
    lines = [f"{name} {row.get('nodes', '?')} nodes, {row['steps']} steps, {row['cpu']:.1f} s"]
    for c in row["comparisons"]:
        value, reference, error, target = shown(c)
        lines.append(f"    {c.quantity}: {value}" + (f" ({reference}), {error}" if reference else "") + (f", target {target}: {c.verdict}" if target else ""))
    return "\n".join(lines)


def _size(text, line, sign=""):
    if not text:
        return ""
    if line["errorUnit"] == "%" and line["error"]:
        return f"{100 * float(text):{sign}.3g} %"
    return f"{float(text):{sign}.3g} {line['unit']}".strip()


def _value(text, line):
    return f"{float(text):.5g} {line['unit']}".strip() if text else ""


def _named(line, lines):
    """The quantity of a line; one that begins with "the same" together with the quantity of the line before."""
    quantity = line["quantity"]
    return f"{lines[lines.index(line) - 1]['quantity']}, {quantity.removeprefix('the same, ')}" if quantity.startswith("the same, ") else quantity


def _summary(cases, lines):
    """Figures with a target: how many reached it on the finest run of each variant, and those that missed."""
    table = ["| case | finest N | commit | targets reached | of |", "|---|---|---|---|---|"]
    missed = ["| case | run | quantity | value or error | target |", "|---|---|---|---|---|"]
    for case in cases:
        mine = [line for line in lines if line["case"] == case.name and line["status"] == "ok"]
        finest = {v: max(int(line["N"]) for line in mine if line["variant"] == v) for v in {line["variant"] for line in mine}}
        mine = [line for line in mine if int(line["N"]) == finest[line["variant"]] and line["verdict"]]
        bad = [line for line in mine if line["verdict"] == "missed"]
        if mine:
            sizes, commits = (", ".join(dict.fromkeys(line[name] for line in mine)) for name in ("resolution", "commit"))
            table.append(f"| {case.name} | {sizes} | {commits} | {len(mine) - len(bad)} | {len(mine)} |")
        for line in bad:
            run = ", ".join(text for text in (line["variant"], line["resolution"]) if text)
            error = _size(line["error"] or line["value"], line, "+")
            missed.append(f"| {case.name} | {run} | {_named(line, lines)} | {error} | {_size(line['target'], line)} |")
    return "\n".join(table) + "\n\nTargets that these runs miss:\n\n" + "\n".join(missed)


def _wrapped(text):
    return textwrap.fill(" ".join(text.split()), 120, break_long_words=False, break_on_hyphens=False)


def write(path, cases, lines, command):
    """validation.md: a section per case, a line per figure."""
    parts = ["# Validation", "Computed figures beside published ones; default numerics in every case.\n"
             f"Regenerate: `{command}`; this page alone, from the rows there are: `{command} --report`.",
             _wrapped("Error: relative where a % stands, else in the unit shown. CPU s: user seconds of the solver on one core. commit: the program that was run; rows of "
                      "an older commit were not repeated since. The load of the machine is in validation.csv."),
             "## Summary", "The finest run of every variant of a case:", _summary(cases, lines)]
    for case in cases:
        mine = [line for line in lines if line["case"] == case.name]
        if not mine:
            continue
        order = {(r.variant, str(r.n)): i for i, r in enumerate(case.runs)}
        mine.sort(key=lambda line: order.get((line["variant"], line["N"]), len(order)))
        table = ["| run | resolution | quantity | ours | published | error | target | verdict | nodes | steps | CPU s | commit |",
                 "|---|---|---|---|---|---|---|---|---|---|---|---|"]
        before = None
        for line in mine:
            key = (line["variant"], line["N"])
            head = [line["variant"], line["resolution"]] if key != before else ["", ""]
            tail = [line["nodes"], line["steps"], f"{float(line['cpu']):.3g}" if line["cpu"] else "", line["commit"]] if key != before else [""] * 4
            before = key
            if line["status"] != "ok":
                table.append(f"| {head[0]} | {head[1]} | **FAILED**: {line['status']} | | | | | | {' | '.join(tail)} |")
                continue
            cells = [*head, line["quantity"], _value(line["value"], line), _value(line["reference"], line), _size(line["error"], line, "+"),
                     _size(line["target"], line), line["verdict"], *tail]
            table.append("| " + " | ".join(cells) + " |")
        parts += [f"## {case.name}", _wrapped(case.title), "\n".join(table)]
    with open(path, "w", encoding="utf-8") as out:
        out.write("\n\n".join(parts) + "\n")
