#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Clamped bars under their own weight hang as beam theory says, and swing as fast, through whole commands: pins,
gravity, fields and the stepper. The theory is integrated here; it knows nothing of particles.

usage: beams_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import math
import sys
import tempfile
import unittest
from pathlib import Path

import meshio
import numpy

from bars import WIDTH, YOUNG_MODULUS, Bar, write_box
from small_run import sinew

PLANES = 5
SLENDERNESS = 10
DENSITY = 1000  # kg/m^3
LENGTH = SLENDERNESS * WIDTH
RADIUS = WIDTH / PLANES / math.sqrt(2)
BENDING_STIFFNESS = YOUNG_MODULUS * WIDTH**4 / 12
WEIGHT = DENSITY * WIDTH**2  # kg/m

SCENE = """
body: {{mesh: {mesh}, radius: {radius}}}
material: {{model: bonded, young_modulus: {modulus}, density: {density}, damping: {damping}}}
skeleton: {{bones: [{{name: wall, head: [0, 0, 0], tail: [0, 0, {length}]}}]}}
binding: {{stiffness: 0, twist_stiffness: 0, axial_stiffness: 0}}
world:
  drag: {drag}
  pins: [{{low: [-1, -1, -1], high: [1, 1, {grip}]}}]
  fields: [{{name: weight, shape: uniform, acceleration: [{acceleration}, 0, 0], keys: {keys}}}]
solver: {{duration: {duration}, integrator: {integrator}}}
output: {{interval: {interval}, only: displacement}}
"""


def elastica(load):
    """Where the end of a clamped rod of length 1 and bending stiffness 1 is under a load per length across it: how
    far it moves with the load, and how far back. By shooting from the clamp, where the curvature is sought with
    which the end has none."""
    steps = 400

    def slopes(s, y):
        angle, curvature = y[:2]
        return numpy.array((curvature, -load * (1 - s) * math.cos(angle), math.sin(angle), math.cos(angle)))

    def end(curvature):
        y, h = numpy.array((0, curvature, 0, 0.0)), 1 / steps
        for k in range(steps):  # Runge and Kutta's
            s = k * h
            a = slopes(s, y)
            b = slopes(s + h / 2, y + h / 2 * a)
            c = slopes(s + h / 2, y + h / 2 * b)
            y = y + h / 6 * (a + 2 * b + 2 * c + slopes(s + h, y + h * c))
        return y

    low, high = 0, load / 2
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if end(middle)[1] < 0 else (low, middle)
    return end(low)[2], 1 - end(low)[3]


class Cantilever:
    def __init__(self, acceleration, duration, interval, drag=0, keys="[]", integrator="symplectic_euler"):
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary)
            write_box(folder / "bar.obj", WIDTH, LENGTH)
            (folder / "bar.yaml").write_text(SCENE.format(
                mesh=folder / "bar.obj", radius=RADIUS, modulus=YOUNG_MODULUS, density=DENSITY, length=LENGTH,
                damping=0 if drag == 0 else 0.5, drag=drag, grip=2.3 * RADIUS, acceleration=acceleration, keys=keys,
                duration=duration, interval=interval, integrator=integrator))
            sinew("simulate", folder / "bar.yaml", "-o", folder / "run", "--quiet", check=0)
            rest = meshio.read(folder / "run" / "body.vtu").points
            held = rest[rest[:, 2] < 2.3 * RADIUS][:, 2].max()
            self.free = LENGTH - held - RADIUS / math.sqrt(2)  # what is around its particles is held as well
            end = rest[:, 2] > rest[:, 2].max() - 0.1 * RADIUS
            self.moved = [meshio.read(file).point_data["displacement"][end].mean(axis=0)
                          for file in sorted((folder / "run" / "particles").glob("*.vtu"))]


def lowest_frequency(free):
    """rad/s"""
    return 3.516 * math.sqrt(BENDING_STIFFNESS / WEIGHT) / free**2


class Beams(unittest.TestCase):
    """Their bending stiffness is that of such a bar that is bent by pins at both ends."""

    @classmethod
    def setUpClass(cls):
        cls.stiffness = Bar(PLANES).stiffness("bend")

    def test_hang_as_the_elastica_under_their_weight(self):
        for load in (0.4, 4):
            lowest = lowest_frequency(LENGTH)
            free = Cantilever(0, 0.001, 0.001, drag=1).free
            acceleration = load * BENDING_STIFFNESS / (WEIGHT * free**3)
            bar = Cantilever(acceleration, 16 / lowest, 16 / lowest, drag=2 * lowest)
            across, back = elastica(load / self.stiffness)
            moved = bar.moved[-1] / bar.free
            print(f"stiffness {self.stiffness:.3f} load {load}: {moved[0]:.4f}, {-moved[2]:.4f}; elastica {across:.4f}, {back:.4f}")
            self.assertLess(abs(moved[0] / across - 1), 0.06)
            self.assertLess(abs(-moved[2] / back - 1), 0.1)

    def test_swing_at_their_lowest_frequency(self):
        lowest = lowest_frequency(LENGTH)
        for integrator in ("symplectic_euler", "velocity_verlet"):
            period = 2 * math.pi / lowest
            keys = f"[{{time: 0, strength: 1}}, {{time: {period / 2}, strength: 0}}]"
            bar = Cantilever(0.02, 5 * period, period / 40, keys=keys, integrator=integrator)
            swing = numpy.array([moved[0] for moved in bar.moved])[20:]
            times = numpy.arange(len(swing)) * period / 40
            crossings = [times[k] + period / 40 * swing[k] / (swing[k] - swing[k + 1])
                         for k in range(len(swing) - 1) if swing[k] < 0 <= swing[k + 1]]
            found = 2 * math.pi * (len(crossings) - 1) / (crossings[-1] - crossings[0])
            expected = lowest_frequency(bar.free) * math.sqrt(self.stiffness)
            print(f"{integrator}: {found:.4f} rad/s, expected {expected:.4f}")
            self.assertLess(abs(found / expected - 1), 0.04)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
