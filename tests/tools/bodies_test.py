#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of several bodies, each with a mesh, a place and a stiffness of its own.

usage: bodies_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import tempfile
import unittest
from pathlib import Path

import meshio
import numpy

from small_run import sinew

HIGH, WIDE, YOUNG, GRAVITY, DENSITY = 0.6, 0.2, 1e4, 0.2, 1000

SCENE = """
body: {{mesh: cube.obj, radius: {radius}}}
{bodies}
material: {{model: {model}, young_modulus: 1e4, damping: 40, damping_form: paper}}
skeleton:
  bones: [{{name: base, head: [0, 0, 0], tail: [0, 0, 0.05]}}]
binding: {{explicit: [{{bone: none, low: [-1, -1, 0.05], high: [9, 9, 9]}}]}}
motion: {{tracks: [{{bone: base, keys: [{{time: 0}}]}}]}}
world: {{pins: [{{low: [-1, -1, -1], high: [9, 9, 0.03]}}]}}
solver: {{duration: {duration}, gravity: [0, 0, {gravity}]}}
output: {{interval: {duration}, double_precision: true}}
"""


def cube(x, y, z, at=(0, 0, 0), first=1):
    """A box as OBJ text."""
    corners = [(at[0] + i * x, at[1] + j * y, at[2] + k * z) for k in (0, 1) for j in (0, 1) for i in (0, 1)]
    faces = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (2, 4, 8, 6), (4, 3, 7, 8), (3, 1, 5, 7)]
    return "".join(f"v {a} {b} {c}\n" for a, b, c in corners) + \
        "".join("f " + " ".join(str(i + first - 1) for i in face) + "\n" for face in faces)


class Bodies(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)
        self.write("cube.obj", cube(WIDE, WIDE, HIGH))

    def tearDown(self):
        self.temporary.cleanup()

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return self.folder / name

    def scene(self, bodies, name="scene.yaml", **changes):
        given = {"radius": 0.02, "model": "bonded", "duration": 0.02, "gravity": 0} | changes
        return self.write(name, SCENE.format(bodies=bodies, **given))

    def filled(self, scene):
        sinew("fill", scene, "-o", self.folder / "body.vtu", check=0)
        return meshio.read(self.folder / "body.vtu")

    def assert_refused(self, scene, *parts):
        done = sinew("check", scene)
        self.assertEqual(done.returncode, 2)
        for part in parts:
            self.assertIn(part, done.stderr)

    def test_bars_in_series_stretch_as_each_by_itself(self):
        """Hung in gravity, the strain at height z is density g (L - z) / E, of each bar's own E."""
        scene = self.scene(f"bodies: [{{mesh: cube.obj, offset: [0, 0, {HIGH}], young_modulus: 4e4}}]",
                           gravity=GRAVITY, duration=12)
        sinew("simulate", scene, "-o", self.folder / "run", check=0)
        rest, end = (meshio.read(self.folder / "run" / name).points
                     for name in ("body.vtu", "particles/particles_000001.vtu"))
        for low, high, modulus in ((0.15, 0.5, YOUNG), (0.7, 1.1, 4 * YOUNG)):
            inside = (rest[:, 2] > low) & (rest[:, 2] < high)
            fit = numpy.polyfit(rest[inside, 2], (end - rest)[inside, 2], 2)
            middle = (low + high) / 2
            expected = DENSITY * GRAVITY * (2 * HIGH - middle) / modulus
            self.assertAlmostEqual((2 * fit[0] * middle + fit[1]) / expected, 1, delta=0.05)

    def test_bodies_fill_as_one_mesh_of_them_all(self):
        self.write("both.obj", cube(WIDE, WIDE, HIGH) + cube(WIDE, WIDE, HIGH, (0.5, 0, 0.1), 9))
        one = self.filled(self.scene("").with_name("scene.yaml"))
        two = self.filled(self.scene("bodies: [{mesh: cube.obj, offset: [0.5, 0, 0.1]}]"))
        self.assertAlmostEqual(len(two.points) / len(one.points), 2, delta=0.1)
        whole = self.scene("", "whole.yaml")
        whole.write_text(whole.read_text().replace("cube.obj", "both.obj"))
        numpy.testing.assert_array_equal(self.filled(whole).points, two.points)

    def test_places_are_as_those_of_the_body(self):
        turned = self.filled(self.scene("bodies: [{mesh: cube.obj, unit: cm, scale: 100, "
                                        "rotation: [0, 90, 0], offset: [0.5, 0, 0.5]}]"))
        lying = turned.points[turned.points[:, 0] > 0.3]
        numpy.testing.assert_allclose(lying.min(0), (0.5, 0, 0.3), atol=0.03)
        numpy.testing.assert_allclose(lying.max(0), (0.5 + HIGH, WIDE, 0.5), atol=0.03)

    def test_a_body_within_another_has_its_own_stiffness(self):
        self.write("core.obj", cube(WIDE / 2, WIDE / 2, HIGH / 2))
        at = f"[{WIDE / 4}, {WIDE / 4}, {HIGH / 4}]"
        body = self.filled(self.scene(f"bodies: [{{mesh: core.obj, offset: {at}, young_modulus: 1e5}}]",
                                      radius=0.008))
        stiffness = body.point_data["stiffness"]
        self.assertEqual(set(stiffness), {1.0, 10.0})
        self.assertAlmostEqual(sum(stiffness == 10) / len(stiffness), 1 / 8, delta=0.02)

    def test_a_resolved_scene_runs_the_same_and_measures(self):
        scene = self.scene("bodies: [{mesh: cube.obj, offset: [0.3, 0, 0], young_modulus: 2e4}]", gravity=1)
        runs = [self.folder / "first", self.folder / "second"]
        sinew("simulate", scene, "-o", runs[0], check=0)
        sinew("simulate", runs[0] / "scene.yaml", "-o", runs[1], check=0)
        ends = [(run / "particles/particles_000001.vtu").read_bytes() for run in runs]
        self.assertEqual(ends[0], ends[1])
        sinew("measure", runs[1], check=0)

    def test_bad_bodies_name_their_line(self):
        self.write("open.obj", cube(WIDE, WIDE, HIGH).rsplit("f", 1)[0])
        self.assert_refused(self.scene("bodies: [{mesh: open.obj}]"), "scene.yaml:3", "close_holes")
        self.assert_refused(self.scene("bodies: [{mesh: none.obj}]"), "scene.yaml:3", "none.obj")
        self.assert_refused(self.scene("bodies: [{offset: [1, 0, 0]}]"), "bodies[0].mesh is missing")
        self.assert_refused(self.scene("bodies: [{mesh: cube.obj, radius: 1}]"), "radius")
        self.assert_refused(self.scene("bodies: {mesh: cube.obj}"), "must be a list")
        self.assert_refused(self.scene("bodies: [{mesh: cube.obj, young_modulus: 1}]", model="paper"),
                            "scene.yaml:3", "material.model")


if __name__ == "__main__":
    import sys
    unittest.main(argv=["bodies_test", "-v", *sys.argv[3:]])
