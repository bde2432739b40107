# SPDX-License-Identifier: GPL-3.0-or-later
"""Square bars that are pulled, bent and twisted at their ends by pins, through the product's own commands.

    bar = Bar(planes=9, axis="100", material={"model": "bonded"})
    figures = bar.stiffness("pull")        # E, E I or G J over those of the mesh and the modulus asked for
"""
import csv
import math
import tempfile
from pathlib import Path

import meshio
import numpy

from small_run import sinew

WIDTH = 0.1  # m
YOUNG_MODULUS = 1e5  # Pa
SLENDERNESS = 7
TURN = 0.02  # between the ends, radians
PULL = 0.002  # of the length
SQUARE_TORSION = 0.1406  # J / width^4 (Timoshenko and Goodier, Theory of Elasticity)

# Rotations (x, then y, then z; degrees) that bring a direction of the packing to the bar's axis.
ROTATIONS = {"100": [0, 0, 0], "110": [45, 0, 0], "111": [45, -35.264389682754654, 0], "random": [17, 38, 61]}

FACES = [(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4),
         (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6), (3, 0, 4), (3, 4, 7)]

SCENE = """
body:
  mesh: {mesh}
  radius: {radius}
  lattice_rotation: {rotation}
  packing: {packing}
  seed: {seed}
material: {material}
skeleton:
  bones:
    - {{name: foot, head: [0, 0, {grip}], tail: [0, 0, 0]}}
    - {{name: hand, head: [0, 0, {upper}], tail: [0, 0, {length}]}}
motion:
  tracks:
    - {{bone: foot, interpolation: linear, keys: [{{time: 0}}, {{time: {ramp}, {foot}}}]}}
    - {{bone: hand, interpolation: linear, keys: [{{time: 0}}, {{time: {ramp}, {hand}}}]}}
binding: {{stiffness: 0, twist_stiffness: 0, axial_stiffness: 0}}
world:
  drag: {drag}
  pins:
    - {{low: [-1, -1, -1], high: [1, 1, {grip}], bone: foot}}
    - {{low: [-1, -1, {upper}], high: [1, 1, 9], bone: hand}}
solver: {{duration: {duration}}}
output: {{interval: {duration}}}
"""

CONTRACTED = """
body:
  mesh: {mesh}
  radius: {radius}
  lattice_rotation: {rotation}
  packing: {packing}
  seed: {seed}
material: {material}
skeleton: {{bones: [{{name: axis, head: [0, 0, 0], tail: [0, 0, {length}]}}]}}
binding: {{stiffness: 0, twist_stiffness: 0, axial_stiffness: 0}}
world:
  drag: {drag}
  muscles:
    - {{name: whole, direction: [0, 0, 1], strength: {strength}, low: [-1, -1, -1], high: [1, 1, 9],
       keys: [{{time: 0, activation: 0}}, {{time: {ramp}, activation: 1}}]}}
solver: {{duration: {duration}}}
output: {{interval: {duration}}}
"""


def write_box(path, width, length, at=(0, 0, 0)):
    """Upright, the middle of its base `at` a place."""
    half = width / 2
    corners = [(x, y, z) for z in (0, length) for x, y in ((-half, -half), (half, -half), (half, half), (-half, half))]
    lines = ["v {:.17g} {:.17g} {:.17g}".format(*(x + by for x, by in zip(corner, at))) for corner in corners]
    lines += ["f {} {} {}".format(*(corner + 1 for corner in face)) for face in FACES]
    path.write_text("\n".join(lines) + "\n")


def motions(kind, length):
    """Of the foot and of the hand."""
    half = math.degrees(TURN) / 2
    if kind == "pull":
        return "translation: [0, 0, 0]", f"translation: [0, 0, {PULL * length}]"
    axis = "[0, 1, 0]" if kind == "bend" else "[0, 0, 1]"
    return f"axis: {axis}, angle: {-half}", f"axis: {axis}, angle: {half}"


class Bar:
    def __init__(self, planes, axis="100", material=None, poisson_ratio=0.25, packing="fcc", seed=1):
        self.packing, self.seed = packing, seed
        self.planes = planes
        self.radius = WIDTH / planes / math.sqrt(2)
        self.length = SLENDERNESS * WIDTH
        self.rotation = ROTATIONS[axis]
        self.material = {"model": "bonded", "young_modulus": YOUNG_MODULUS, **(material or {})}
        self.shear_modulus = YOUNG_MODULUS / (2 * (1 + poisson_ratio))

    def run(self, kind, folder, *words, ramp=2):
        """Pulled, bent or twisted until it rests; options of sinew simulate follow. `ramp`: how long that takes, in
        periods over 2 pi of the slowest motion."""
        speed = math.sqrt(YOUNG_MODULUS / 1000)
        lowest = 22.4 * WIDTH / math.sqrt(12) * speed / self.length**2  # rad/s: of a clamped bar
        grip = 2.3 * self.radius
        foot, hand = motions(kind, self.length)
        return self.settled(SCENE, lowest, folder, words, ramp, grip=grip,
                            upper=self.length - grip, foot=foot, hand=hand)

    def contract(self, strength, folder, *words):
        """The free bar, whose muscle pulls along it with this stress (Pa)."""
        lowest = math.pi * math.sqrt(YOUNG_MODULUS / 1000) / self.length
        return self.settled(CONTRACTED, lowest / 2, folder, words, 2, strength=strength)

    def settled(self, template, lowest, folder, words, ramp, **values):
        """`lowest`: angular frequency of the slowest motion, rad/s."""
        mesh, scene = folder / "bar.obj", folder / "bar.yaml"
        write_box(mesh, WIDTH, self.length)
        scene.write_text(template.format(
            mesh=mesh, radius=self.radius, rotation=self.rotation, packing=self.packing, seed=self.seed, length=self.length,
            material="{" + ", ".join(f"{key}: {value}" for key, value in self.material.items()) + "}",
            drag=2 * lowest, ramp=ramp / lowest, duration=(20 + ramp) / lowest, **values))
        sinew("simulate", scene, "-o", folder / "run", "--quiet", *words, check=0, timeout=1200)
        return folder / "run"

    def stiffness(self, kind):
        with tempfile.TemporaryDirectory() as temporary:
            run = self.run(kind, Path(temporary))
            rest = meshio.read(run / "body.vtu").points
            end = meshio.read(sorted((run / "particles").glob("*.vtu"))[-1])
            with (run / "bones.csv").open() as file:
                hand = [row for row in csv.DictReader(file) if row["bone"] == "hand"][-1]
        moved = numpy.asarray(end.point_data["displacement"], dtype=float)
        middle = abs(rest[:, 2] - self.length / 2) < self.length / 4
        x, y, z = (rest[middle] - [0, 0, self.length / 2]).T
        one = numpy.ones_like(x)

        def fitted(value, *functions):
            return numpy.linalg.lstsq(numpy.column_stack(functions), value, rcond=None)[0]

        u, v, w = moved[middle].T
        if kind == "pull":
            return float(hand["pin_force_z"]) / fitted(w, z, one)[0] / (YOUNG_MODULUS * WIDTH**2)
        if kind == "bend":
            curvature = -fitted(w, x * z, x, z, one)[0]
            return float(hand["pin_moment_y"]) / curvature / (YOUNG_MODULUS * WIDTH**4 / 12)
        twist = (fitted(v, x * z, x, z, one)[0] - fitted(u, y * z, y, z, one)[0]) / 2
        return float(hand["pin_moment_z"]) / twist / (self.shear_modulus * SQUARE_TORSION * WIDTH**4)
