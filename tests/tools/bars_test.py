#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bars that are pulled, bent and twisted through the product's own commands show the modulus asked for.

usage: bars_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import sys
import tempfile
import unittest
from pathlib import Path

import meshio
import numpy

from bars import YOUNG_MODULUS, Bar


class Stiffness(unittest.TestCase):
    def expect(self, bar, **shares):
        for kind, (low, high) in shares.items():
            with self.subTest(kind=kind, planes=bar.planes):
                found = bar.stiffness(kind)
                self.assertGreater(found, low)
                self.assertLess(found, high)

    def test_isotropic_bonds_show_the_modulus_asked_for(self):
        """Within 6 % pulled and 12 % bent and twisted from 9 planes on."""
        self.expect(Bar(9), pull=(0.94, 1.06), bend=(0.88, 1.12), twist=(0.88, 1.12))
        self.expect(Bar(9, "110"), pull=(0.94, 1.06), bend=(0.88, 1.12), twist=(0.88, 1.12))

    def test_thin_bars_lack_little(self):
        self.expect(Bar(5), pull=(0.94, 1.06), bend=(0.8, 1.12), twist=(0.88, 1.12))

    def test_a_mesh_that_ends_between_two_planes(self):
        self.expect(Bar(9.5), pull=(0.94, 1.06), bend=(0.88, 1.12), twist=(0.88, 1.12))

    def test_twelve_bonds_are_stiff_by_direction(self):
        """[100] is the soft direction of a cubic crystal, and its surfaces lack half a plane each."""
        self.expect(Bar(9, material={"isotropic": "false"}), pull=(0.56, 0.63))

    def test_a_volume_that_is_kept_changes_no_modulus(self):
        for ratio in (0.3, 0.45):
            bar = Bar(9, material={"model": "bonded_volume", "poisson_ratio": ratio}, poisson_ratio=ratio)
            self.expect(bar, pull=(0.9, 1.06))

    def test_stress_is_that_of_the_pull_up_to_the_surface(self):
        """E times the strain in every particle, those of faces and edges included."""
        bar = Bar(9)
        with tempfile.TemporaryDirectory() as temporary:
            run = bar.run("pull", Path(temporary), "--set", "output.arrays=stress")
            rest = meshio.read(run / "body.vtu").points
            end = meshio.read(sorted((run / "particles").glob("*.vtu"))[-1])
        middle = abs(rest[:, 2] - bar.length / 2) < bar.length / 8
        along = end.point_data["stress"][middle][:, 2]
        pulled = numpy.polyfit(rest[middle][:, 2], end.point_data["displacement"][middle][:, 2], 1)[0] * YOUNG_MODULUS
        self.assertLess(abs(along.mean() / pulled - 1), 0.03)
        self.assertLess(abs(along / pulled - 1).max(), 0.3)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
