#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes as finite elements: decks of CalculiX, what ccx makes of them, and runs held against its results. Laws
that need ccx are skipped where it is not installed.

usage: elements_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import csv
import json
import math
import shutil
import subprocess
import sys
import unittest

import small_run
from small_run import SOURCE, sinew

E, LENGTH, WIDE = 1e5, 0.4, 0.1
BOX = """v -0.05 -0.05 0
v 0.05 -0.05 0
v 0.05 0.05 0
v -0.05 0.05 0
v -0.05 -0.05 0.4
v 0.05 -0.05 0.4
v 0.05 0.05 0.4
v -0.05 0.05 0.4
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
"""
SCENE = """
body: {{mesh: bar.obj, radius: 0.01414}}
material: {{model: bonded, young_modulus: 1e5}}
{machine}
solver: {{method: static, duration: {duration}}}
output: {{interval: 1}}
"""
PULL = """
supports:
  - {name: below, hold: z, facing: [0, 0, -1]}
  - {name: above, hold: z, facing: [0, 0, 1], keys: [{time: 0}, {time: 1, translation: [0, 0, 0.0004]}]}
  - {name: left, hold: x, facing: [-1, 0, 0]}
  - {name: front, hold: y, facing: [0, -1, 0]}
"""
needs_ccx = unittest.skipUnless(shutil.which("ccx"), "ccx is not installed: tools/install_packages.sh test")


class Elements(small_run.SmallRun):
    def write(self, machine, duration=1, mesh=BOX):
        (self.folder / "bar.obj").write_text(mesh)
        self.scene.write_text(SCENE.format(machine=machine, duration=duration))

    def deck(self, *words):
        path = self.folder / "bar.inp"
        sinew("export", self.scene, "--to", "calculix", "-o", path, *words, check=0)
        return path

    def ccx(self, deck):
        done = subprocess.run(["ccx", "-i", deck.stem], cwd=deck.parent, capture_output=True, text=True, timeout=120)
        self.assertIn("Job finished", done.stdout, done.stdout[-2000:])
        return deck.with_suffix(".frd")

    def reactions(self, deck, support):
        """Sums of forces of a support, one per step."""
        lines = deck.with_suffix(".dat").read_text().splitlines()
        return [[float(word) for word in lines[i + 2].split()] for i, line in enumerate(lines)
                if f"set SUPPORT_{support} " in line]

    @needs_ccx
    def test_a_pulled_bar_has_its_modulus_of_boxes_and_of_tetrahedra(self):
        turned = BOX.replace("v 0.05 0.05 0.4", "v 0.05 0.05 0.4001")  # no box, by a hair
        for mesh in BOX, turned:
            self.write(PULL, mesh=mesh)
            deck = self.deck("--size", "0.06", "--linear")
            self.ccx(deck)
            force = self.reactions(deck, 1)[-1][2]
            self.assertLess(abs(force / (E * WIDE**2 * 0.0004 / LENGTH) - 1), 1e-3 if mesh is turned else 1e-6)

    @needs_ccx
    def test_supports_of_both_pull_alike(self):
        """The run's grips hold layers within the bar: half a layer from each end."""
        self.write(PULL)
        sinew("simulate", self.scene, "-o", self.out, "--set", "output.interval=0.25", check=0)
        frd = self.ccx(self.deck("--set", "output.interval=0.25"))
        sinew("measure", self.out, "--reference", frd, check=0)
        frames = json.loads((self.folder / "run_reference" / "reference.json").read_text())["frames"]
        self.assertEqual(len(frames), 4)
        for frame in frames:
            found, expected = frame["above: force"][2], frame["above: force by elements"][2]
            self.assertGreater(expected, 0)
            self.assertLess(abs(found / expected - 1), 0.15)
            self.assertLess(abs(frame["below: force by elements"][2] / expected + 1), 1e-4)
        self.assertAlmostEqual(frames[-1]["above: force by elements"][2], E * WIDE**2 * 0.0004 / LENGTH, delta=2e-3)
        self.assertIn("Load over displacement", (self.folder / "run_reference" / "report.html").read_text())

    @needs_ccx
    def test_loads_have_their_sums_and_pressures_push_inward(self):
        self.write("""
supports:
  - {name: below, facing: [0, 0, -1]}
loads:
  - {name: weight, gravity: [0, 0, -3], low: [-1, -1, 0.2], high: [1, 1, 1]}
  - {name: hook, force: [0.1, 0, 0], low: [-1, -1, 0.3], high: [1, 1, 1], keys: [{time: 0, factor: 0}, {time: 1, factor: 2}]}
  - {name: shear, traction: [0, 5, 0], facing: [0, 0, 1]}
  - {name: wind, pressure: 20, facing: [1, 0, 0], low: [-1, -1, 0.2], high: [1, 1, 1]}
""")  # what acts on held nodes themselves, ccx does not count
        deck = self.deck("--linear")
        self.ccx(deck)
        weight = 3 * 1000 * LENGTH / 2 * WIDE**2
        wind = 20 * LENGTH / 2 * WIDE
        for found, expected in zip(self.reactions(deck, 0), ([wind, -0.05, weight], [wind - 0.2, -0.05, weight])):
            for axis in range(3):
                self.assertAlmostEqual(found[axis], expected[axis], delta=1e-5 * weight)

    @needs_ccx
    def test_a_run_is_where_the_elements_are_that_are_moved_alike(self):
        """Of a body that is held throughout, both are exact."""
        self.write("""
supports:
  - {name: all, keys: [{time: 0}, {time: 1, translation: [0.1, 0, 0.02], axis: [0, 1, 0], angle: 30}]}
probes:
  - {name: tip, at: [0, 0, 0.4]}
""")
        sinew("simulate", self.scene, "-o", self.out, check=0)
        frd = self.ccx(self.deck())
        sinew("measure", self.out, "--reference", frd, check=0)
        compared = json.loads((self.folder / "run_reference" / "reference.json").read_text())
        last = compared["frames"][-1]
        self.assertEqual(last["time"], 1)
        self.assertLess(last["max_relative"], 1e-5)
        turned = [0.1 + 0.2 * math.sin(math.pi / 6), 0, 0.02 - 0.2 * (1 - math.cos(math.pi / 6))]
        for found, expected in zip(last["tip: displacement by elements"], turned):
            self.assertAlmostEqual(found, expected, delta=1e-3)
        with (self.folder / "run_reference" / "reference.csv").open() as file:
            row = list(csv.DictReader(file))[-1]
        self.assertEqual(float(row["max"]), last["max"])
        page = (self.folder / "run_reference" / "report.html").read_text()
        for part in "bar.frd", "Distance from the elements", "tip: displacement x":
            self.assertIn(part, page)
        done = sinew("measure", self.out, "--reference", frd, "--fail-on", "reference_particles_max > 1e-9")
        self.assertEqual(done.returncode, 1, done.stderr)

    @needs_ccx
    def test_a_bar_turns_by_a_quarter_without_growing_thin(self):
        self.write("""
supports:
  - {name: below, hold: xy, facing: [0, 0, -1]}
  - {name: foot, hold: z, low: [-0.01, -0.01, 0], high: [0.01, 0.01, 0.02]}
  - {name: above, hold: xy, facing: [0, 0, 1], keys: [{time: 0}, {time: 1, angle: 90}]}
probes:
  - {name: middle, at: [0.05, 0, 0.2]}
""")
        deck = self.deck()
        self.assertEqual(deck.read_text().count("*STEP"), 6)
        sinew("simulate", self.scene, "-o", self.out, check=0)
        sinew("measure", self.out, "--reference", self.ccx(deck), check=0)
        last = json.loads((self.folder / "run_reference" / "reference.json").read_text())["frames"][-1]
        for found in last["middle: displacement by elements"], last["middle: displacement"]:  # by half of it
            self.assertAlmostEqual(found[0], 0.05 * (math.sqrt(0.5) - 1), delta=5e-4)
            self.assertAlmostEqual(found[1], 0.05 * math.sqrt(0.5), delta=5e-4)

    @needs_ccx
    def test_a_bent_bar_is_near_the_elements_at_every_particle(self):
        self.write("supports:\n  - {name: below, facing: [0, 0, -1]}\n"
                   "loads:\n  - {name: end, force: [0.5, 0, 0], facing: [0, 0, 1]}\n", duration=0)
        sinew("simulate", self.scene, "-o", self.out, "--set", "body.radius=0.0078567", check=0)
        frd = self.ccx(self.deck())
        sinew("measure", self.out, "--reference", frd, "-o", self.folder / "compared", check=0)
        compared = json.loads((self.folder / "compared" / "reference.json").read_text())["frames"]
        self.assertEqual([frame["time"] for frame in compared], [0])
        self.assertLess(compared[0]["max_relative"], 0.09)  # of 9 layers
        self.assertGreater(compared[0]["largest_elements"], 0.01)

    @needs_ccx
    def test_results_of_other_bodies_and_times_are_refused(self):
        self.write(PULL)
        sinew("simulate", self.scene, "-o", self.out, check=0)
        self.write(PULL, mesh=BOX.replace("0.4", "0.2"))
        frd = self.ccx(self.deck("--linear"))
        self.assert_one_line(sinew("measure", self.out, "--reference", frd), 2, "of another body", "sinew export")
        self.write(PULL, duration=0)
        frd = self.ccx(self.deck("--linear"))
        compared = json.loads(sinew("measure", self.out, "--reference", frd, "--json", check=0).stdout)
        self.assertEqual(compared["frames"], 1)
        self.write(PULL.replace("time: 1,", "time: 0.3,"))
        frd = self.ccx(self.deck("--linear", "--set", "solver.duration=0.3", "--set", "output.interval=0.3"))
        self.assert_one_line(sinew("measure", self.out, "--reference", frd), 2, "no step at the time of a frame")

    @needs_ccx
    def test_modes_are_those_of_check(self):
        """Of a clamped bar of 11 layers, the two lowest pairs and the twist, beside Timoshenko's first."""
        clamp = "supports: [{name: below, facing: [0, 0, -1]}]"
        self.write(clamp)
        deck = self.deck("--frequency", "6")
        self.ccx(deck)
        rows = [line.split() for line in deck.with_suffix(".dat").read_text().splitlines()]
        elements = [float(row[3]) for row in rows if len(row) == 5 and row[0].isdigit()][:5]
        found = json.loads(sinew("check", self.scene, "--set", "body.radius=0.0064", "--modes", "5", "-o",
                                 self.folder / "modes.pvd", "--json", check=0).stdout)["modes"]
        self.assertEqual([mode["held_by"] for mode in found], 5 * ["supports"])
        for mode, expected in zip(found, elements):
            self.assertAlmostEqual(mode["frequency"] / expected, 1, delta=0.05)
        bending = 1.8751 ** 2 / (2 * math.pi * LENGTH ** 2) * math.sqrt(E * WIDE ** 2 / 12 / 1000)
        self.assertAlmostEqual(elements[0] / bending, 1, delta=0.04)  # shear bends it as well
        self.assertTrue((self.folder / "modes" / "modes_000011.vtu").is_file())
        (self.folder / "run.json").write_text("{}")  # a run's series would be replaced
        self.assert_one_line(sinew("check", self.scene, "-o", self.folder / "modes.pvd"), 2, "series of a run")
        self.assertTrue((self.folder / "modes" / "modes_000011.vtu").is_file())

    def test_what_a_deck_cannot_hold_is_refused_by_name(self):
        for machine, parts in (
                ("loads: [{name: weight, gravity: [0, 0, -1]}]", ["nothing holds the body", "supports"]),
                (PULL + "skeleton: {bones: [{name: a, head: [0, 0, 0], tail: [0, 0, 0.4]}]}", ["bones and finite elements", "supports"]),
                (PULL + "world: {obstacles: [{name: floor, shape: plane}]}", ["obstacles and finite elements"]),
                (PULL + "world: {pins: [{low: [-1, -1, -1], high: [1, 1, 0.1]}]}", ["pins and finite elements", "supports"]),
                (PULL + "world: {fields: [{name: f, acceleration: [0, 0, 1]}]}", ["fields and finite elements"]),
                (PULL.replace("facing: [0, 0, 1]", "ids: [1, 2]"), ["no particles", "small.yaml:"]),
                (PULL.replace("facing: [0, 0, 1]", "low: [1, 1, 1], high: [2, 2, 2]"), ["no node", "supports[1]"]),
                (PULL + "  - {name: again, hold: z, facing: [0, 0, 1]}", ["'above' and 'again' both hold"]),
                (PULL + "materials: [{name: skin, young_modulus: 1e6, facing: [0, 0, 1]}]",
                 ["surface has no elements", "a box"])):
            self.write(machine)
            self.assert_one_line(sinew("export", self.scene, "--to", "calculix", "-o", self.folder / "a.inp"), 2, *parts)
        for setting, parts in (("material.model=paper", ["the paper's model and finite elements", "bonded"]),
                               ("material.isotropic=false", ["isotropic"]), ("material.yield_strain=0.1", ["creep"]),
                               ("material.breaking_strain=0.1", ["break"]), ("solver.method=dynamic", ["static"])):
            self.write(PULL)
            self.assert_one_line(sinew("export", self.scene, "--to", "calculix", "--set", setting), 2, *parts)
        self.write(PULL, mesh=BOX.replace("f 4 1 5 8\n", ""))
        self.assert_one_line(sinew("export", self.scene, "--to", "calculix"), 2, "open", "close_holes")

    def test_a_deck_takes_any_file_name(self):
        self.write(PULL)
        sinew("export", self.scene, "--to", "calculix", "-o", self.folder / "bar.deck", check=0)
        self.assertEqual((self.folder / "bar.deck").read_bytes(), self.deck().read_bytes())

    def test_options_that_do_not_fit_are_refused(self):
        self.write(PULL)
        for words, parts in (
                (["--to", "calculix", "--size", "-1"], ["--size is -1"]),
                (["--to", "calculix", "--size", "1e-5"], ["elements", "--size"]),
                (["--to", "calculix", "--times", "1"], ["--times", "output.interval"]),
                (["--to", "calculix", "-o", self.scene], ["is an input"]),
                (["--to", "xyz"], ["is a scene", "folder of the run"])):
            self.assert_one_line(sinew("export", self.scene, *words), 2, *parts)
        self.assert_one_line(sinew("export", self.folder, "--to", "calculix"), 2, "is no scene", "DIR/scene.yaml")
        self.assert_one_line(sinew("export", self.folder, "--to", "xyz", "--size", "1"), 2, "--to calculix")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
