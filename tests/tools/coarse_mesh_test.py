#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Coarse meshes are measured as fine ones: the same bodies of six and of many faces, pressed and bent.

usage: coarse_mesh_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import csv
import functools
import sys
import tempfile
import unittest
from pathlib import Path

import small_run

CUBE, SIDE = 0.2, 0.12  # of a section; m
PRESSED = """
body: {mesh: MESH, radius: 0.008, lattice_rotation: [11, 23, 37]}
material: {model: bonded_volume, young_modulus: 1e5, poisson_ratio: 0.45}
supports: [{name: middle, center: [0, 0, 0.1], radius: 0.03}]
loads: [{name: sea, pressure: 1000, keys: [{time: 0, factor: 0}, {time: 1, factor: 1}]}]
solver: {method: static, duration: 1}
output: {interval: 1}
"""
BENT = """
body: {mesh: MESH, radius: 0.008}
material: {model: bonded, young_modulus: 1e5}
skeleton:
  bones: [{name: lower, head: [0, 0, 0], tail: [0, 0, 0.18]}, {name: upper, parent: lower, tail: [0, 0, 0.36]}]
motion: {tracks: [{bone: upper, keys: [{time: 0}, {time: 1, axis: [0, 1, 0], angle: 60}]}]}
solver: {method: static, duration: 1}
output: {interval: 1}
"""

sinew = functools.partial(small_run.sinew, check=0)


def write_box(path, side, length, cut):
    """Upright, each side of its section cut in so many parts, and its length in parts as long."""
    points, faces = {}, []
    parts = (cut, cut, round(cut * length / side))

    def number(place):
        return points.setdefault(place, len(points) + 1)

    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for at in (0, parts[axis]):
            for i in range(parts[u]):
                for j in range(parts[v]):
                    face = []
                    for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        place = [0, 0, 0]
                        place[axis], place[u], place[v] = at, i + du, j + dv
                        face.append(number(tuple(place)))
                    faces.append(face if at else face[::-1])
    lines = ["v {} {} {}".format(side * (x / parts[0] - 0.5), side * (y / parts[1] - 0.5), length * z / parts[2])
             for x, y, z in points]
    path.write_text("\n".join(lines + ["f {} {} {} {}".format(*face) for face in faces]) + "\n")


class CoarseMesh(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def last(self, scene, side, length, cut):
        """Metrics of the last frame."""
        write_box(self.folder / "box.obj", side, length, cut)
        path, out = self.folder / "box.yaml", self.folder / f"run{cut}"
        path.write_text(scene.replace("MESH", "box.obj"))
        sinew("simulate", path, "-o", out)
        sinew("measure", out)
        with (out / "metrics.csv").open() as file:
            return {name: float(value) for name, value in list(csv.DictReader(file))[-1].items() if value}

    def test_a_pressed_cube_of_six_faces_has_the_volume_of_one_of_many(self):
        coarse, fine = (self.last(PRESSED, CUBE, CUBE, cut)["volume_error"] for cut in (1, 16))
        self.assertAlmostEqual(coarse / fine, 1, delta=0.1)  # of the six corners' volume alone 4.3

    def test_a_bent_bar_of_six_faces_has_the_volume_area_and_sections_of_one_of_many(self):
        coarse, fine = (self.last(BENT, SIDE, 3 * SIDE, cut) for cut in (1, 12))
        for name in "volume_ratio", "area_ratio":
            self.assertAlmostEqual(coarse[name], fine[name], delta=0.002, msg=name)
        for name in "bulge", "candy_wrapper":
            self.assertAlmostEqual(coarse[name], fine[name], delta=0.03, msg=name)

    def test_check_names_faces_that_a_machine_bends(self):
        path = self.folder / "box.yaml"
        path.write_text(PRESSED.replace("MESH", "box.obj"))
        for cut, told in (1, True), (16, False):
            write_box(self.folder / "box.obj", CUBE, CUBE, cut)
            self.assertEqual("longer than four particles" in sinew("check", path).stderr, told)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
