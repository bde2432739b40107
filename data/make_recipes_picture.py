#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws what the recipes of lib/python/README.md make: data/pictures/python_recipes.png.

usage: PYTHONPATH=build/python make_recipes_picture.py       in any folder; needs matplotlib and meshio
"""
import os
import re
import tempfile
from pathlib import Path

import matplotlib
import numpy as np

SOURCE = Path(__file__).resolve().parent.parent
matplotlib.use("Agg")


def recipes():
    """What the recipes leave, by their names."""
    page = (SOURCE / "lib/python/README.md").read_text()
    names = {}
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(SOURCE / "data", f"{folder}/data")
        os.chdir(folder)
        for code in re.findall(r"```python\n(.*?)```", page, re.S):
            if "to_pyvista" not in code:
                exec(code, names)
        names["frames"] = [(frame.positions.copy(), frame["strain_eq"]) for frame in names["run"]]
        names["table"] = {key: np.array(names["run"].metrics[key]) for key in ("time", "volume_error")}
        os.chdir(SOURCE)
    return names


def panel(figure, place, title, points, colors, size=7, **how):
    axes = figure.add_subplot(2, 3, place, projection="3d")
    shown = axes.scatter(*points.T, c=colors, s=size, linewidths=0, depthshade=False, **how)
    axes.set_box_aspect(np.ptp(points, axis=0), zoom=1.5)
    axes.view_init(35, -70)
    axes.set_axis_off()
    axes.set_title(title, y=0.92)
    return axes, shown


def draw(names):
    import matplotlib.pyplot as plt
    figure = plt.figure(figsize=(15, 7.5))
    body, found, cells = names["body"], names["found"], names["cells"]
    panel(figure, 1, "1. particles by their neighbors", body.points, body.neighbors)
    ends = found.mesh.vertices[found.edges]
    axes, _ = panel(figure, 2, "2. open edges of a torn mesh", found.mesh.vertices, "lightgray", 1)
    for edge in ends:
        axes.plot(*edge.T, color="crimson", linewidth=2)
    inside = names["inside"]
    panel(figure, 3, "4. points inside, by their depth", names["points"][inside], names["depth"][inside], 25)
    positions, strain = names["frames"][-1]
    _, shown = panel(figure, 4, "6. strain of the bent arm", positions, strain, 10, cmap="viridis")
    axes = figure.add_subplot(2, 3, 5)
    axes.plot(names["table"]["time"], 100 * names["table"]["volume_error"])
    axes.set(title="7. volume error, %", xlabel="time, s")
    middles = cells.points[cells.cells].mean(axis=1)
    cut = cells.cells[middles[:, 1] < 0]
    sides = np.concatenate([cut[:, corners] for corners in ([0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3])])
    axes = figure.add_subplot(2, 3, 6, projection="3d")
    axes.plot_trisurf(*cells.points.T, triangles=sides[::3], color="cornflowerblue", edgecolor="navy", linewidth=0.1)
    axes.set_box_aspect(np.ptp(cells.points, axis=0), zoom=1.5)
    axes.view_init(20, -250)
    axes.set_axis_off()
    axes.set_title("10. tetrahedra, cut open", y=0.92)
    figure.tight_layout()
    figure.savefig(SOURCE / "data/pictures/python_recipes.png", dpi=80)


if __name__ == "__main__":
    draw(recipes())
