#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's material beside the bonded one and theory: a bar is pulled by a fifth and let go, slowly. Draws its load
over its displacement, and writes where the paper's bar leaves elasticity.

usage: paper_figure.py BIN OUT PICTURE.png      writes OUT/paper.json and the picture
"""
import csv
import itertools
import json
import math
import subprocess
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from cases import Case, bar

W, L, E, LAYERS = 0.1, 0.3, 1e5, 9
PULLED, SECONDS = 0.2, 4  # of the length; a tenth of a percent of the speed of sound
# [110] of the packing along the bar, where twelve bonds pull as their mean over all directions does within 5 %.
SCENE = """
body: {{mesh: body.obj, radius: {radius}, lattice_rotation: [45, 0, 0]}}
material: {{model: {model}, young_modulus: {modulus}, {direction}density: 1000}}
supports:
  - {{name: below, hold: z, facing: [0, 0, -1]}}
  - name: above
    hold: z
    facing: [0, 0, 1]
    interpolation: linear
    keys: [{{time: 0}}, {{time: {seconds}, translation: [0, 0, {by}]}}, {{time: {end}}}]
world: {{drag: 5}}
solver: {{duration: {end}}}
output: {{interval: 0.05, only: displacement}}
"""


def pulled(binaries, folder, model):
    """Strain between the grips, and load over E and the section, frame by frame."""
    case = Case("body", "", bar(W, L), W, [LAYERS], "", "", {}, "")
    case.write(folder)
    scene = folder / "scene.yaml"
    direction = "modulus_direction: [0, 0, 1], " if model == "paper" else ""
    scene.write_text(SCENE.format(radius=case.radii()[0], model=model, modulus=E, direction=direction, seconds=SECONDS,
                                  by=PULLED * L, end=2 * SECONDS))
    subprocess.run([binaries / "sinew", "simulate", scene, "--quiet", "--force", "-o", folder / "run"], check=True,
                   stdout=subprocess.DEVNULL)
    with (folder / "run" / "supports.csv").open() as file:
        rows = list(csv.DictReader(file))
    above, below = ([row for row in rows if row["name"] == name] for name in ("above", "below"))
    gauge = float(above[0]["pivot_z"]) - float(below[0]["pivot_z"])
    return (np.array([float(row["displacement_z"]) / gauge for row in above]),
            np.array([float(row["force_z"]) / (E * W * W) for row in above]))


def neighbors():
    """Unit vectors to the twelve neighbors, and those to the six second ones, [110] along z."""
    turn = math.sqrt(0.5) * np.array([[math.sqrt(2), 0, 0], [0, 1, -1], [0, 1, 1]])
    first = [v for v in itertools.product((-1, 0, 1), repeat=3) if sum(map(abs, v)) == 2]
    second = [v for v in itertools.product((-2, 0, 2), repeat=3) if sum(map(abs, v)) == 2]
    return np.array(first) @ turn.T / math.sqrt(2), np.array(second) @ turn.T / math.sqrt(2)


def paper_force(d):
    """Eq. 1 over its slope, with distances in 2r: a = 1, b = 1.3; tension positive."""
    a, b = 1.0, 1.3
    return np.where(d < a, (d * d - 1) / 2, np.where(d < b, (d - a) * (b - d) / (b - a), 0.0))


def spring_force(d, rest):
    return d - rest


def uniform_pull(model, strains):
    """Load over E of a lattice in uniform strain, free across: by halving for both of its sides."""
    first, second = neighbors()

    def stress(stretch):
        pull = np.zeros(3)
        for vectors, force in ((first, paper_force if model == "paper" else lambda d: spring_force(d, 1)),
                               (second, None if model == "paper" else lambda d: spring_force(d, math.sqrt(2)) / 4)):
            if force is None:
                continue
            now = vectors * stretch
            d = np.linalg.norm(now, axis=1)
            pull += ((force(d) / d)[:, None] * now * vectors).sum(axis=0)
        return pull  # nominal, in one unit for both

    def side(stretch, axis):
        low, high = 0.8, 1.05
        for _ in range(50):
            stretch[axis] = (low + high) / 2
            low, high = (low, stretch[axis]) if stress(stretch)[axis] > 0 else (stretch[axis], high)

    def load(strain):
        stretch = np.array([1.0, 1.0, 1 + strain])
        for _ in range(30):
            side(stretch, 0), side(stretch, 1)
        return stress(stretch)[2]

    small = 1e-4
    modulus = (load(small) - load(-small)) / (2 * small)
    return np.array([load(strain) for strain in strains]) / modulus


def facts_of(strain, load):
    """Of the paper's bar: its modulus at a hundredth, where it leaves E by a tenth, its peak, and what is left."""
    top = int(np.argmax(strain))
    peak = int(np.argmax(load))
    going = range(2, peak + 1)
    left = next((k for k in going if load[k] < 0.9 * strain[k]), peak)
    at = int(np.argmin(abs(strain[:top] - 0.02)))
    return {"at": float(strain[at]), "modulus": float(load[at] / strain[at]), "leaves": float(strain[left]),
            "peak": float(strain[peak]), "load": float(load[peak]), "after": float(load[top] / load[peak])}


def draw(curves, picture):
    strains = np.linspace(0, PULLED * 1.04, 60)
    figure, axes = plt.subplots(figsize=(8, 4.6), dpi=110)
    axes.plot(100 * strains, 100 * strains, color="0.55", lw=1, label="elasticity: E times the strain")
    for model, color in ("bonded", "#0072b2"), ("paper", "#d55e00"):
        axes.plot(100 * strains, 100 * uniform_pull(model, strains), color=color, lw=1, ls="--",
                  label=f"{model}: its lattice in uniform strain")
        axes.plot(100 * curves[model][0], 100 * curves[model][1], color=color, lw=1.8, label=f"{model}: the run")
    axes.set_xlabel("displacement of the grip over the length between the grips (%)")
    axes.set_ylabel("load over E and the section (%)")
    axes.axhline(0, color="0.8", lw=0.8)
    axes.legend(frameon=False)
    for side in "top", "right":
        axes.spines[side].set_visible(False)
    figure.tight_layout()
    figure.savefig(picture, metadata={"Software": None})


def main():
    binaries, out, picture = (Path(word).resolve() for word in sys.argv[1:4])
    curves = {model: pulled(binaries, out / "paper" / model, model) for model in ("paper", "bonded")}
    facts = facts_of(*curves["paper"])
    facts["bonded"] = float(max(abs(curves["bonded"][1][-1]), 0))
    draw(curves, picture)
    (out / "paper.json").write_text(json.dumps(facts, indent=1) + "\n")
    print(facts)


if __name__ == "__main__":
    main()
