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


VIEW = np.array([[1, 0, 0], [0.05, 0.35, 0.94], [0, -0.94, 0.35]])  # right, up, toward the eye
LIGHT = np.array([-0.4, 0.6, 0.7])


def panel(axes, title):
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_title(title)


def spheres(axes, points, values, radius, **how):
    """Far ones first; each with a light spot."""
    from matplotlib.collections import EllipseCollection
    seen = points @ VIEW.T
    order = np.argsort(seen[:, 2])
    for size, shift, colors in ((2.0, 0.0, None), (0.7, -0.3, (1, 1, 1, 0.25))):
        sizes = np.full(len(order), size * radius)
        circles = EllipseCollection(sizes, sizes, 0, units="xy", offsets=seen[order, :2] + shift * radius * np.array([1, -1]),
                                    transOffset=axes.transData, linewidths=0, **how)
        if colors is None:
            circles.set_array(np.asarray(values, float)[order])
            colored = circles
        else:
            circles.set_facecolor(colors)
        axes.add_collection(circles)
    low, high = seen.min(axis=0) - radius, seen.max(axis=0) + radius
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    return colored


def triangles(axes, points, faces, color, edges=None):
    from matplotlib.collections import PolyCollection
    seen = points @ VIEW.T
    corners = seen[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True) + 1e-30
    front = normals[:, 2] > 0
    shade = 0.35 + 0.65 * np.clip(normals[front] @ LIGHT, 0, 1)
    order = np.argsort(corners[front].mean(axis=1)[:, 2])
    colors = np.clip(shade[order, None] * np.array(color), 0, 1)
    axes.add_collection(PolyCollection(corners[front][order][:, :, :2], facecolors=colors, edgecolors=colors if edges is None else edges,
                                       linewidths=0.3))
    axes.autoscale_view()


def outer_faces(cells):
    """Of tetrahedra, those that two do not share."""
    sides = np.concatenate([cells[:, corners] for corners in ([0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3])])
    _, first, count = np.unique(np.sort(sides, axis=1), axis=0, return_index=True, return_counts=True)
    return sides[first[count == 1]]


def draw(names):
    import matplotlib.pyplot as plt
    figure, panels = plt.subplots(3, 2, figsize=(13, 10))
    body, found, cells = names["body"], names["found"], names["cells"]
    spheres(panels[0, 0], body.points, body.neighbors, body.radius, cmap="viridis")
    panel(panels[0, 0], "1. particles, by their number of neighbors")
    triangles(panels[0, 1], found.mesh.vertices, found.mesh.faces, (0.75, 0.8, 0.9))
    for edge in found.mesh.vertices[found.edges] @ VIEW.T:
        panels[0, 1].plot(*edge[:, :2].T, color="crimson", linewidth=2.5)
    panel(panels[0, 1], "2. a torn mesh and its open edges")
    inside = names["inside"]
    shown = spheres(panels[1, 0], names["points"][inside], 1000 * names["depth"][inside], 0.004, cmap="plasma")
    figure.colorbar(shown, ax=panels[1, 0], shrink=0.6, label="mm")
    panel(panels[1, 0], "4. points inside, by their depth")
    positions, strain = names["frames"][-1]
    shown = spheres(panels[1, 1], positions[:, [0, 2, 1]] * [1, -1, 1], np.nan_to_num(strain), names["run"].radius, cmap="viridis")
    figure.colorbar(shown, ax=panels[1, 1], shrink=0.6)
    panel(panels[1, 1], "6. strain of the bent arm, from above")
    panels[2, 0].plot(names["table"]["time"], 100 * names["table"]["volume_error"])
    panels[2, 0].set(title="7. volume error, %", xlabel="time, s")
    middles = cells.points[cells.cells].mean(axis=1)
    triangles(panels[2, 1], cells.points, outer_faces(cells.cells[middles[:, 1] > 0]), (0.6, 0.75, 1), (0.15, 0.25, 0.45))
    panel(panels[2, 1], "10. tetrahedra, cut open")
    figure.tight_layout()
    figure.savefig(SOURCE / "data/pictures/python_recipes.png", dpi=80)


if __name__ == "__main__":
    draw(recipes())
