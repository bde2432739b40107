#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""One scene with particles of several sizes, and studies of several runs: limits against closed forms.

usage: study_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import csv
import json
import math
import sys
import tempfile
import unittest
from pathlib import Path

import small_run
from small_run import sinew

SOURCE = small_run.SOURCE
E, PULLED = 1e5, 0.0006  # Pa, m
# Odd numbers of half-planes across and along: the packing fits the box alike at each radius.
WIDTH, LENGTH, PLANES = 0.12, 0.6, [5, 7, 9]
RADII = [round(WIDTH / math.sqrt(2) / planes, 9) for planes in PLANES]

BAR = """
body:
  mesh: box.obj
  radius: 0.01
material:
  model: bonded
  young_modulus: 1e5
  damping_form: central
supports:
  - {name: below, hold: z, facing: [0, 0, -1]}
  - name: above
    hold: z
    facing: [0, 0, 1]
    keys:
      - time: 0
      - {time: 0.3, translation: [0, 0, 0.0006]}
world:
  drag: 20
solver:
  duration: 0.8
output:
  interval: 0.1
"""


def write_box(path):
    places = [(x * WIDTH / 2, y * WIDTH / 2, z * LENGTH) for z in (0, 1) for y in (-1, 1) for x in (-1, 1)]
    faces = ["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"]
    path.write_text("".join("v %.9f %.9f %.9f\n" % place for place in places) +
                    "".join(f"f {face}\n" for face in faces))


def result(study, name, kind):
    return next(one for one in study["results"] if (one["name"], one["kind"]) == (name, kind))


class Studies(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.at = Path(cls.folder.name)
        cls.scene = cls.at / "bar.yaml"
        cls.scene.write_text(BAR)
        write_box(cls.at / "box.obj")
        cls.radii = ",".join(map(str, RADII))
        cls.out = cls.at / "study"
        cls.done = sinew("converge", cls.scene, "--radii", cls.radii, "-o", cls.out, check=0, timeout=200)
        cls.study = json.loads((cls.out / "study.json").read_text())

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_a_pulled_bar_tends_to_its_closed_form(self):
        expected = E * WIDTH ** 2 * PULLED / LENGTH
        for name, sign in ("above", 1), ("below", -1):
            force = result(self.study, f"{name}: force_z", "final")
            self.assertAlmostEqual(force["limit"] / expected, sign, delta=0.02)
            self.assertLess(abs(force["limit"] - sign * expected), force["error"])
            # The coarsest alone is off by more: its supports hold particles, half a layer within.
            self.assertGreater(abs(force["values"][0] / expected - sign), 0.05)

    def test_what_is_prescribed_has_no_error(self):
        moved = result(self.study, "above: displacement_z", "final")
        self.assertAlmostEqual(moved["limit"], PULLED, delta=1e-9)
        self.assertLess(moved["error"], 1e-9)

    def test_what_does_not_converge_is_told_so(self):
        ends = {"inverted": (0, math.inf), "broken_bonds": (0, 1), "stretch_max": (0, math.inf)}
        for one in self.study["results"]:
            low, high = ends.get(one["name"], (-math.inf, math.inf))
            self.assertTrue(one["limit"] is None or low <= one["limit"] <= high, one)
            self.assertEqual(len(one["values"]), len(RADII))
        lost = [one for one in self.study["results"] if one["limit"] is None and None not in one["values"]]
        self.assertIn("does not converge", (self.out / "report.html").read_text())
        self.assertFalse([one for one in lost if one["error"] is not None or one["order"] is not None])
        self.assertLessEqual({"center_x", "von_mises_left_out"}, {one["name"] for one in lost})  # rounding, and a count

    def test_the_runs_are_named_by_their_radii(self):
        self.assertTrue(self.study["by_radius"])
        self.assertEqual([run["radius"] for run in self.study["runs"]], RADII)
        for radius in RADII:
            self.assertTrue((self.out / f"radius_{radius}" / "particles.pvd").is_file())
        self.assertIn("above.force_z.final", self.done.stdout)

    def test_the_table_has_the_numbers_of_the_json(self):
        with open(self.out / "study.csv", newline="") as file:
            rows = {(row["name"], row["kind"]): row for row in csv.DictReader(file)}
        self.assertEqual(len(rows), len(self.study["results"]))
        force = result(self.study, "above: force_z", "final")
        row = rows["above: force_z", "final"]
        self.assertEqual([float(row[f"radius_{radius}"]) for radius in RADII], force["values"])
        self.assertEqual(float(row["limit"]), force["limit"])

    def test_measuring_the_runs_again_gives_the_same_study(self):
        again = self.at / "again"
        sinew("measure", *(self.out / f"radius_{radius}" for radius in RADII), "-o", again, check=0)
        self.assertEqual((again / "study.json").read_text(), (self.out / "study.json").read_text())
        page = (again / "report.html").read_text()
        self.assertIn("<h1>again</h1>", page)
        self.assertIn("Over the radius", page)
        self.assertIn("study.json", page)

    def test_a_study_goes_on_where_it_stopped(self):
        other = self.at / "other"
        two = ",".join(map(str, RADII[:2]))
        sinew("converge", self.scene, "--radii", two, "-o", other, check=0, timeout=200)
        begun = (other / f"radius_{RADII[0]}" / "run.json").read_text()
        done = sinew("converge", self.scene, "--radii", two, "-o", other)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--resume", done.stderr)
        sinew("converge", self.scene, "--radii", self.radii, "-o", other, "--resume", check=0, timeout=200)
        self.assertEqual((other / f"radius_{RADII[0]}" / "run.json").read_text(), begun)
        study = json.loads((other / "study.json").read_text())
        self.assertEqual(study["results"], self.study["results"])

    def test_a_resumed_study_of_another_scene_is_refused(self):
        done = sinew("converge", self.scene, "--radii", self.radii, "-o", self.out, "--resume",
                     "--set", "material.young_modulus=2e5")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("young_modulus", done.stderr)

    def test_a_run_that_fails_ends_the_study_with_its_reason(self):
        out = self.at / "fails"
        done = sinew("converge", self.scene, "--radii", self.radii, "-o", out, "--set", "solver.time_step=0.02")
        self.assertEqual(done.returncode, 3, done.stderr)
        said = [line for line in done.stderr.splitlines() if line.startswith("sinew: ")]
        self.assertEqual(len(said), 1, done.stderr)
        self.assertIn("use solver.time_step", said[0])
        self.assertFalse((out / "study.json").exists())

    def test_runs_that_differ_otherwise_have_no_limits(self):
        stiff = self.at / "stiff"
        sinew("simulate", self.scene, "-o", stiff, "--set", "material.young_modulus=2e5",
              "--set", "body.radius=0.02", check=0, timeout=200)
        out = self.at / "mixed"
        sinew("measure", *(self.out / f"radius_{radius}" for radius in RADII[:2]), stiff, "-o", out, check=0)
        study = json.loads((out / "study.json").read_text())
        self.assertFalse(study["by_radius"])
        self.assertIsNone(result(study, "above: force_z", "final")["limit"])
        self.assertEqual({one["name"] for one in study["settings"]}, {"radius", "young_modulus"})

    def test_bad_words_are_refused_with_the_cure(self):
        runs = [self.out / f"radius_{radius}" for radius in RADII]
        for words, said in [(["converge", self.scene, "--radii", "0.01"], "three"),
                            (["converge", self.scene, "--radii", "0.01,0.01"], "twice"),
                            (["converge", self.scene, "--radii", "0.01,-1"], "above 0"),
                            (["converge", self.scene, "--radii", "0.02,0.01", "--set", "body.radius=0.1"], "leave it out"),
                            (["measure", *runs], "-o"),
                            (["measure", *runs, "-o", runs[0]], "lost"),
                            (["measure", *runs, runs[0], "-o", self.at / "x"], "twice"),
                            (["measure", *runs, "-o", self.at / "x", "--fail-on", "volume > 1"], "--fail-on")]:
            done = sinew(*words)
            self.assertEqual(done.returncode, 2, words)
            self.assertIn(said, done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        done = sinew("simulate", self.scene, "-o", self.at / "x", "--set", "supports.0.hold=xy")
        self.assertEqual(done.returncode, 2)
        self.assertIn("'supports' is a list", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
