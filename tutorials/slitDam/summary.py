# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of results."""
import flotsam
import flume
import numpy as np


def writeSummary(runs, file):
    barred, free = runs["with bars"], runs["without bars"]
    history, mean, h = barred["history"], flume.finalMean, flume.setup
    captured = flume.captureRatio(history)
    rows = [
        ("bars held at the slit at the end", f"{100 * captured[-1]:.0f} %", f"of {len(history.bodies)}", ""),
        ("bars held at 4 s", f"{100 * np.interp(4, history.time, captured):.0f} %", "", ""),
        ("depth upstream, with bars", float(100 * barred["up"]), "cm", ""),
        ("depth upstream, without bars", float(100 * free["up"]), "cm", ""),
        ("depth downstream, with bars", float(100 * barred["down"]), "cm", ""),
        ("depth downstream, without bars", float(100 * free["down"]), "cm", ""),
        ("outflow, with bars", float(1000 * barred["outflow"]), "l/s", f"{1000 * h['discharge']:.1f} l/s enter: the pool still changes"),
        ("outflow, without bars", float(1000 * free["outflow"]), "l/s", ""),
        ("discharge coefficient of the slit, without bars", float(free["coefficient"]), "", f"{flume.LONG_GAP:.2f} long gap .. 1 free jet"),
        ("share of the slit's capacity the bars take", float(100 * (1 - barred["coefficient"] / free["coefficient"])), "%", ""),
    ]
    for name, run in runs.items():
        rows.append((f"force of the water on the pipes, {name}", float(mean(run, run["water"]).sum()), "N", ""))
        rows.append((f"force of the bars on the pipes, {name}", float(mean(run, run["contact"]).sum()), "N", ""))
        rows.append((f"both, {name}", float((mean(run, run["water"]) + mean(run, run["contact"])).sum()), "N",
                     f"{run['momentum']:.1f} N: momentum theorem"))
    for k, (w, c) in enumerate(zip(mean(barred, barred["water"]), mean(barred, barred["contact"]))):
        rows.append((f"pipe {k + 1}, with bars: water, bars", f"{w:.2f}, {c:.2f}", "N", ""))
    text = f"""Means over the last second ({history.time[-1]:.1f} s). Resolution `{h['resolution']}`, {1000 * h['discharge']:.0f} l/s in a flume
{h['width']} m wide with a slope of 1/{1 / h['slope']:.0f}. Depths {-flume.UPSTREAM} m upstream and {flume.DOWNSTREAM} m downstream of the pipes,
normal to the bed. Held: centre less than {flume.REACH} m upstream of the pipes.

With bars:

| 4 s | 7 s |
|---|---|
| ![4 s](bars_4s.png) | ![7 s](bars_7s.png) |

Without bars:

| 4 s | 7 s |
|---|---|
| ![4 s, without bars](noBars_4s.png) | ![7 s, without bars](noBars_7s.png) |

Bed and water surface, the bars from the side:

![profiles](profiles.png)

![series](series.png)
"""
    flotsam.writeSummary(file, "Driftwood at a slit dam", rows, text)
