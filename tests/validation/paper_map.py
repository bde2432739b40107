#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The constants that the paper leaves free: lambda, b and a over the bend of configs/box_bend.yaml and back. Writes a
table and a chart.

usage: paper_map.py BIN SOURCE PAGE.md PICTURE.png      folder of the programs, folder of the project
"""
import csv
import itertools
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

RADIUS, HOLD = 0.010, 1.5  # m; s: the end of the hold
LAMBDAS, RANGES, BEGINNINGS = (0.02, 0.05, 0.1, 0.2, 0.5, 1), (2.4, 2.6, 2.75, 2.8284271247461903), (2, 2.1)
COLUMNS = {"off": "radii off at the end", "broken": "neighbors parted at the hold, %",
           "volume": "volume, max and min", "opening": "longest edge of the skin at the hold, over its rest",
           "inverted": "inverted particles, max"}


def bent(sinew, scene, folder, values):
    """What COLUMNS name of one run; None for one that became unstable."""
    done = subprocess.run([sinew, "simulate", scene, "-o", folder, "--quiet", "--set", *values], capture_output=True,
                          text=True)
    if done.returncode == 3:
        return None
    if done.returncode != 0:
        sys.exit(done.stderr)
    subprocess.run([sinew, "measure", folder, "--quiet"], check=True, capture_output=True)
    with (folder / "metrics.csv").open() as file:
        rows = [{key: float(value or "nan") for key, value in row.items()} for row in csv.DictReader(file)]
    held = min(rows, key=lambda row: abs(row["time"] - HOLD))
    volumes = [row["volume_ratio"] for row in rows]
    return {"off": rows[-1]["displacement_rms"] / RADIUS, "broken": 100 * held["broken_neighbors"],
            "volume": (max(volumes), min(volumes)), "opening": held["edge_stretch_max"],
            "inverted": max(row["inverted"] for row in rows)}


def grid(sinew, scene):
    found = {}
    for a, b, lam in itertools.product(BEGINNINGS, RANGES, LAMBDAS):
        with tempfile.TemporaryDirectory() as folder:
            values = [f"material.lambda={lam}", f"material.a={a}", f"material.b={b}"]
            found[a, b, lam] = bent(sinew, scene, Path(folder) / "run", values)
    return found


def table(found):
    lines = ["| a | b | lambda | " + " | ".join(COLUMNS.values()) + " |", "|--:|--:|--:|--:|--:|--:|--:|--:|"]
    for (a, b, lam), run in found.items():
        cells = ["unstable"] + [""] * 4
        if run:
            most, least = run["volume"]
            cells = [f"{run['off']:.2f}", f"{run['broken']:.1f}", f"{most:.3f}, {least:.3f}", f"{run['opening']:.2f}",
                     f"{run['inverted']:.0f}"]
        lines.append(f"| {a:g} | {b:.3g} | {lam:g} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def chart(found, picture):
    figure, axes = plt.subplots(1, 3, figsize=(13, 4), constrained_layout=True)
    values = [("off at the end, radii", lambda run: run["off"]),
              ("neighbors parted at the hold, %", lambda run: run["broken"]),
              ("volume, largest change, %", lambda run: 100 * max(abs(one - 1) for one in run["volume"]))]
    colors = plt.cm.viridis([0.1, 0.4, 0.65, 0.85])
    for ax, (title, value) in zip(axes, values):
        for (a, b), color in zip(itertools.product(BEGINNINGS, RANGES), itertools.cycle(colors)):
            points = [(lam, value(found[a, b, lam])) for lam in LAMBDAS if found[a, b, lam]]
            ax.plot(*zip(*points), "o-" if a == 2 else "s:", color=color, markersize=4,
                    label=f"b = {b:.3g} r" if a == 2 else f"b = {b:.3g} r, a = {a:g} r")
        ax.set_xscale("log")
        ax.set_xticks(LAMBDAS, [f"{lam:g}" for lam in LAMBDAS])
        ax.minorticks_off()
        ax.set_xlabel("lambda")
        ax.set_title(title, fontsize=10)
        ax.grid(alpha=0.3)
    axes[0].set_yscale("log")
    axes[0].set_yticks([0.1, 0.2, 0.5, 1, 2], ["0.1", "0.2", "0.5", "1", "2"])
    for ax in axes[1:]:
        ax.set_ylim(bottom=0)
    axes[0].legend(fontsize=7, frameon=False)
    figure.savefig(picture, dpi=110)


def main():
    sinew, source, page, picture = Path(sys.argv[1]) / "sinew", Path(sys.argv[2]), Path(sys.argv[3]), sys.argv[4]
    found = grid(sinew, source / "configs/box_bend.yaml")
    head, mark = page.read_text().split("<!-- table -->\n")[0], "<!-- table -->\n"
    page.write_text(head + mark + table(found))
    chart(found, picture)


if __name__ == "__main__":
    main()
