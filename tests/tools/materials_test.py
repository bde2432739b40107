#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of a body with moduli of their own: bars in series and in parallel, against closed forms.

usage: materials_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import csv
import functools
import json
import re
import sys
import tempfile
import unittest
from pathlib import Path

import small_run
from bars import write_box

SOURCE = small_run.SOURCE
E, LENGTH, WIDTH, R = 1e5, 0.692965, 0.155563, 0.01

BAR = """
body: {{mesh: {source}/data/meshes/box.obj, radius: 0.01}}
material: {{model: bonded, young_modulus: 1e5}}
{materials}
supports:
  - {{name: below, hold: z, facing: [0, 0, -1]}}
  - {{name: axis, hold: xy, center: [0, 0, 0.35], radius: 0.009}}
  - {{name: edge, hold: y, center: [0.07, 0, 0.35], radius: 0.012}}
  - name: above
    hold: z
    facing: [0, 0, 1]
    keys: [{{time: 0}}, {{time: 1, translation: [0, 0, 0.007]}}]
probes:
  - {{name: lower, low: [-1, -1, 0.1], high: [1, 1, 0.25]}}
  - {{name: upper, low: [-1, -1, 0.45], high: [1, 1, 0.6]}}
solver: {{method: static, duration: 1}}
output: {{interval: 1}}
"""

sinew = functools.partial(small_run.sinew, check=0)


class Materials(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)
        self.out = self.folder / "run"

    def tearDown(self):
        self.temporary.cleanup()

    def pull(self, materials, out=None, check=0):
        path = self.folder / "bar.yaml"
        path.write_text(BAR.format(source=SOURCE, materials=materials))
        return sinew("simulate", path, "-o", out or self.out, check=check)

    def last(self, name, row_of, column, out=None):
        with open((out or self.out) / name, newline="") as file:
            rows = [row for row in csv.DictReader(file) if row["name"] == row_of]
        return float(rows[-1][column])

    def force(self, out=None):
        return self.last("supports.csv", "above", "force_z", out)

    def test_in_series_strains_are_as_compliances(self):
        plain = self.folder / "plain"
        self.pull("", out=plain)
        self.pull("materials: [{name: bone, young_modulus: 4e5, point: [0, 0, 0.3465], "
                  "normal: [0, 0, 1]}]")
        soft = self.last("probes.csv", "lower", "strain_zz")
        hard = self.last("probes.csv", "upper", "strain_zz")
        self.assertAlmostEqual(soft / hard, 4, delta=0.08)
        self.assertAlmostEqual(self.force() / self.force(plain), 1.6, delta=0.03)

    def test_in_parallel_forces_add(self):
        plain = self.folder / "plain"
        self.pull("", out=plain)
        self.pull("materials: [{name: bone, young_modulus: 4e5, point: [0.0001, 0, 0], "
                  "normal: [1, 0, 0]}]")
        # Half of the planes beside the middle one, whose bonds are of both.
        self.assertAlmostEqual(self.force() / self.force(plain), 2.5, delta=0.35)

    def test_the_same_modulus_makes_no_difference(self):
        plain = self.folder / "plain"
        self.pull("", out=plain)
        self.pull("materials: [{name: bone, young_modulus: 1e5, low: [-1, -1, 0.2], "
                  "high: [1, 1, 0.4]}]")
        one, other = (json.loads((out / "run.json").read_text())["state_hash"]
                      for out in (plain, self.out))
        self.assertEqual(one, other)

    def test_series_tell_the_material(self):
        self.pull("materials: [{name: bone, young_modulus: 4e5, point: [0, 0, 0.3465], "
                  "normal: [0, 0, 1]}, {name: tip, young_modulus: 2e5, facing: [0, 0, 1]}]")
        import meshio
        mesh = meshio.read(self.out / "particles" / "particles_000000.vtu")
        material = mesh.point_data["material"]
        self.assertEqual(set(material), {0, 1, 2})
        self.assertTrue(all(mesh.points[material == 1][:, 2] > 0.34))
        self.assertTrue(all(mesh.points[material == 2][:, 2] > 0.67))
        sinew("measure", self.out)

    def test_the_softness_of_the_papers_bar_is_told_before_and_after_it_is_pulled(self):
        """Along [100] twelve bonds pull with 0.9428 / 1.3505 of their mean, less 1.4 / 11 for 11 layers."""
        layer = R * 2 ** 0.5
        length = 25 * layer
        write_box(self.folder / "bar.obj", 11 * layer, length)
        path = self.folder / "bar.yaml"
        path.write_text(f"""
body: {{mesh: bar.obj, radius: {R}}}
material: {{model: paper, young_modulus: {E}}}
supports:
  - {{name: below, hold: z, facing: [0, 0, -1]}}
  - {{name: axis, hold: xy, center: [0, 0, {length / 2}], radius: 0.009}}
  - {{name: edge, hold: y, center: [0.07, 0, {length / 2}], radius: 0.02}}
  - {{name: above, hold: z, facing: [0, 0, 1], keys: [{{time: 0}}, {{time: 1, translation: [0, 0, {0.005 * length}]}}]}}
probes: [{{name: middle, low: [-1, -1, {0.4 * length}], high: [1, 1, {0.6 * length}]}}]
solver: {{method: static, duration: 1}}
output: {{interval: 1}}
""")
        before = sinew("check", path, "--json")
        checked = json.loads(before.stdout)
        self.assertRegex(before.stderr, "is pulled between 'below' and 'above' .* k?Pa, 39 % softer")
        (span,) = checked["along_spans"]
        self.assertFalse(span["bends"])
        self.assertAlmostEqual(span["young_modulus"] / E, 0.9428 / 1.3505, 3)
        said = sinew("simulate", path, "-o", self.out).stdout
        (shown,) = json.loads((self.out / "run.json").read_text())["moduli_at_probes"]
        self.assertAlmostEqual(shown["young_modulus"] / span["shown_modulus"], 1, delta=0.05)
        self.assertAlmostEqual(self.force() / (11 * layer) ** 2 / 0.005 / span["shown_modulus"]
                               / checked["grip_factor"], 1, delta=0.05)
        self.assertAlmostEqual(shown["young_modulus_asked"] / E, 1, 12)
        self.assertIn("young_modulus at middle: ", said)
        sinew("measure", self.out)
        report = (self.out / "report.html").read_text()
        for words in ("below to above", "at probe middle"):
            self.assertIn(words, report)
        self.assertNotIn("modulus", sinew("check", path, "--set", "material.model=bonded").stderr)

    def test_check_names_how_much_too_stiff_grips_make_a_bar(self):
        """A layer at each grip does not stretch: the shorter a bar, the more does that count."""
        layer = R * 2 ** 0.5
        moduli, named = [], []
        for layers in (13, 25):
            length = layers * layer
            write_box(self.folder / "short.obj", 11 * layer, length)
            path = self.folder / "bar.yaml"
            path.write_text(f"""
body: {{mesh: short.obj, radius: {R}}}
material: {{model: bonded, young_modulus: {E}}}
supports:
  - {{name: below, hold: z, facing: [0, 0, -1]}}
  - {{name: axis, hold: xy, center: [0, 0, {length / 2}], radius: 0.009}}
  - {{name: edge, hold: y, center: [0.07, 0, {length / 2}], radius: 0.02}}
  - {{name: above, hold: z, facing: [0, 0, 1], keys: [{{time: 0}}, {{time: 1, translation: [0, 0, {0.001 * length}]}}]}}
solver: {{method: static, duration: 1}}
output: {{interval: 1}}
""")
            named.append(json.loads(sinew("check", path, "--json").stdout)["grip_factor"])
            self.assertAlmostEqual(named[-1], layers / (layers - 2), 4)
            sinew("simulate", path, "-o", self.out, "--force")
            moduli.append(self.force() / (0.001 * (11 * layer) ** 2))
        self.assertAlmostEqual(moduli[0] / moduli[1] / (named[0] / named[1]), 1, delta=0.01)

    def test_check_names_how_far_a_skin_that_keeps_its_volume_less_gives_way(self):
        """A cube of seven layers under a pressure all around: the factor is a fit of measured ones."""
        layer, nu, pressure = R * 2 ** 0.5, 0.45, 100
        side, middle = 7 * layer, 3.5 * layer
        write_box(self.folder / "cube.obj", side, side)
        path = self.folder / "cube.yaml"
        path.write_text(f"""
body: {{mesh: cube.obj, radius: {R}}}
material: {{model: bonded_volume, young_modulus: {E}, poisson_ratio: {nu}}}
supports:
  - {{name: a, center: [0, 0, {middle}], radius: 0.004}}
  - {{name: b, hold: yz, center: [{2 * layer}, 0, {middle}], radius: 0.015}}
  - {{name: c, hold: z, center: [0, {2 * layer}, {middle}], radius: 0.015}}
loads: [{{name: all, pressure: {pressure}, keys: [{{time: 0, factor: 0}}, {{time: 1, factor: 1}}]}}]
solver: {{method: static, duration: 1}}
output: {{interval: 1}}
""")
        sinew("simulate", path, "-o", self.out)
        sinew("measure", self.out)
        with open(self.out / "metrics.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        volume = [float(row["particle_volume"]) for row in rows]
        bulk = E / (3 * (1 - 2 * nu))
        factor = json.loads(sinew("check", path, "--json").stdout)["bulk_compression_factor"]
        self.assertAlmostEqual((1 - volume[1] / volume[0]) / (pressure / bulk) / factor, 1, delta=0.1)
        skin = float(rows[1]["volume_error"]) / (pressure / bulk)
        told = re.search(r"mostly (\S+) to (\S+) times", sinew("check", path, "--verbose").stdout)
        self.assertTrue(float(told[1]) - 0.1 < skin < float(told[2]) + 0.1, (skin, *told.groups()))

    def test_check_names_what_a_crack_takes_and_where_friction_ends(self):
        path = self.folder / "bar.yaml"
        path.write_text(BAR.format(source=SOURCE, materials=""))
        plain = json.loads(sinew("check", path, "--json").stdout)
        self.assertNotIn("friction_floor", plain)
        self.assertNotIn("crack_energy_factor", plain)
        said = json.loads(sinew("check", path, "--json", "--set", "material.fracture_energy=1",
                                "--set", "solver.method=dynamic", "--set", "material.friction=0.2").stdout)
        self.assertAlmostEqual(said["friction_floor"], 0.364, 3)
        self.assertAlmostEqual(said["crack_energy_factor"], 3.4, 6)

    def test_what_cannot_differ_is_refused(self):
        path = self.folder / "bar.yaml"
        path.write_text(BAR.format(source=SOURCE,
                                   materials="materials: [{name: bone, young_modulus: 4e5}]"))
        refused = sinew("check", path, "--set", "material.model=paper", check=2)
        self.assertIn("parts of other stiffness and bonds of nearest neighbors alone", refused.stderr)
        path.write_text(BAR.format(source=SOURCE, materials="materials: [{name: none, "
                                   "young_modulus: 4e5, center: [9, 9, 9], radius: 1}]"))
        self.assertIn("no particle", sinew("check", path, check=2).stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
