#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of the static method: every frame is an equilibrium, or the run says that there is none.

usage: static_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import csv
import functools
import json
import math
import sys
import tempfile
import unittest
from pathlib import Path

import small_run
from bars import write_box

SOURCE = small_run.SOURCE
E = 1e5

BAR = """
body:
  mesh: {source}/data/meshes/box.obj
  radius: 0.01
material: {{model: bonded, young_modulus: 1e5}}
solver: {{method: static, duration: 0.4}}
output: {{interval: 0.2}}
{machine}
"""

CLAMP = """
supports:
  - {name: clamp, facing: [0, 0, -1]}
loads:
  - name: side
    force: [FORCE, 0, 0]
    facing: [0, 0, 1]
    keys: [{time: 0, factor: 0}, {time: 0.4, factor: 1}]
probes:
  - {name: end, facing: [0, 0, 1]}
"""

SLENDER = """
body: {{mesh: {mesh}, radius: 0.01}}
material: {{model: bonded, young_modulus: 1e5}}
solver: {{method: static, duration: 1}}
output: {{interval: 1}}
supports:
  - {{name: base, facing: [0, 0, -1]}}
  - {{name: top, facing: [0, 0, 1], keys: [{{time: 0}}, {{time: 1, translation: [0, 0, {way}]}}]}}
"""
LAYER = 0.01 * 2 ** 0.5

sinew = functools.partial(small_run.sinew, check=0)


class Static(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)
        self.out = self.folder / "run"

    def tearDown(self):
        self.temporary.cleanup()

    def scene(self, machine):
        path = self.folder / "bar.yaml"
        path.write_text(BAR.format(source=SOURCE, machine=machine))
        return path

    def run_scene(self, machine, *more, check=0, out=None):
        return sinew("simulate", self.scene(machine), "-o", out or self.out, *more, check=check)

    def record(self, out=None):
        return json.loads(((out or self.out) / "run.json").read_text())

    def rows(self, name):
        with open(self.out / name, newline="") as file:
            return list(csv.DictReader(file))

    def test_the_reason_why_a_run_ended_before_its_first_frame_is_told(self):
        weight = "supports:\n  - {name: clamp, facing: [0, 0, -1]}\nloads:\n  - {name: weight, gravity: [0, 0, -9.81]}"
        for words, code, reason in ((["solver.wall_time=1e-9"], 130, "stopped; go on with"),
                                    (["solver.iterations=1"], 3, "is not in equilibrium")):
            for export in ("true", "false"):
                done = self.run_scene(weight, "--force", "--set", f"output.export={export}", "--set", *words, check=code)
                self.assertIn(reason, done.stderr)

    def test_a_cantilever_bends_as_timoshenko_says(self):
        width, length = 0.155563, 0.692965
        inertia, area = width ** 4 / 12, width ** 2
        deflection = 0.01 * length
        shear = 6 / 5 / (E / 2.5 * area)
        force = deflection / (length ** 3 / (3 * E * inertia) + length * shear)
        self.run_scene(CLAMP.replace("FORCE", str(force)))
        end = [float(row["displacement_x"]) for row in self.rows("probes.csv")]
        self.assertAlmostEqual(end[-1] / deflection, 1, delta=0.12)  # eleven planes, 0.1 at the end
        self.assertAlmostEqual(end[1] / end[2], 0.5, delta=1e-3)
        for time in ("0.2", "0.4"):
            both = [row for row in self.rows("supports.csv") if row["time"] == time]
            for axis in "xyz":
                sum_of = sum(float(row["force_" + axis]) for row in both)
                self.assertLess(abs(sum_of), 1e-6 * force)

    def test_the_record_tells_how_each_frame_came_to_rest(self):
        self.run_scene(CLAMP.replace("FORCE", "5"))
        steps = self.record()["load_steps"]
        self.assertEqual([step["frame"] for step in steps], [0, 1, 2])
        for step in steps[1:]:
            self.assertGreater(step["iterations"], 100)
            self.assertLessEqual(step["residual"], 1e-6)
        self.assertIn("at rest after", (self.out / "log.txt").read_text())
        sinew("measure", self.out)
        metrics = json.loads((self.out / "metrics.json").read_text())
        self.assertNotIn("nan", json.dumps(metrics).lower())

    def test_the_last_moment_is_the_duration(self):
        self.run_scene(CLAMP.replace("FORCE", "5"), "--set", "output.interval=0.25")
        ends = [row for row in self.rows("supports.csv") if row["name"] == "side"]
        self.assertEqual([row["time"] for row in ends], ["0", "0.25", "0.4"])
        self.assertAlmostEqual(float(ends[-1]["force_x"]), 5, 9)

    def test_what_does_not_come_to_rest_is_kept_and_resumed(self):
        machine = CLAMP.replace("FORCE", "5")
        whole = self.folder / "whole"
        self.run_scene(machine, out=whole)
        failed = self.run_scene(machine, "--set", "solver.iterations=1000", check=3)
        self.assertIn("not in equilibrium", failed.stderr)
        self.assertIn("solver.iterations", failed.stderr)
        self.assertEqual(self.record()["frames"], 1)
        self.assertEqual(self.record()["status"], "unstable")
        self.run_scene(machine, "--resume")
        self.assertEqual(self.record()["state_hash"], self.record(whole)["state_hash"])
        self.assertEqual(self.record()["load_steps"], self.record(whole)["load_steps"])
        self.assertEqual((self.out / "supports.csv").read_text(),
                         (whole / "supports.csv").read_text())

    def test_the_first_frame_may_fail_too(self):
        failed = self.run_scene(CLAMP.replace("{time: 0, factor: 0}", "{time: 0, factor: 1}").replace("FORCE", "5"),
                                "--set", "solver.iterations=10", "--set", "solver.duration=0", check=3)
        self.assertIn("not in equilibrium", failed.stderr)
        self.assertEqual(self.record()["frames"], 0)

    def test_rounding_hides_small_residuals_of_small_loads(self):
        machine = CLAMP.replace("FORCE", "2e-3")
        self.run_scene(machine)
        last = self.record()["load_steps"][-1]
        self.assertGreater(last["residual"], 1e-6)
        self.assertLess(last["residual"], 1e-4)
        asked = self.run_scene(machine, "--force", "--set", "solver.residual=1e-6", check=3)
        self.assertIn("rounding", asked.stderr)
        self.assertIn("make the load", asked.stderr)
        hidden = self.run_scene(CLAMP.replace("FORCE", "1e-12"), "--force", check=3)
        self.assertIn("rounding", hidden.stderr)

    def test_frames_do_not_depend_on_the_interval(self):
        """Pressed by 5 and 10 % of the length at once, a slender bar could fold."""
        for fraction in (0.05, 0.1):
            press = SLENDER.format(mesh=self.folder / "slender.obj", way=-fraction * 45 * LAYER)
            write_box(self.folder / "slender.obj", 9 * LAYER, 45 * LAYER)
            (self.folder / "press.yaml").write_text(press)
            forces = []
            for count in (1, 10):
                sinew("simulate", self.folder / "press.yaml", "-o", self.out, "--force", "--set",
                      f"output.interval=1/{count}")
                forces.append([float(row["force_z"]) for row in self.rows("supports.csv") if row["name"] == "top"][-1])
                self.assertEqual(self.record()["load_steps"][-1]["inverted"], 0)
            self.assertAlmostEqual(forces[0] / forces[1], 1, 5)
            # E A times the strain, within what clamped ends and layers at the surface add
            self.assertAlmostEqual(-forces[0] / (E * (9 * LAYER) ** 2 * fraction), 1, delta=0.15)

    def test_what_is_folded_is_not_to_be_trusted(self):
        write_box(self.folder / "slender.obj", 9 * LAYER, 45 * LAYER)
        (self.folder / "press.yaml").write_text(
            SLENDER.format(mesh=self.folder / "slender.obj", way=-0.45 * 45 * LAYER))
        folded = small_run.sinew("simulate", self.folder / "press.yaml", "-o", self.out)
        self.assertIn(folded.returncode, (0, 3))
        if folded.returncode == 0:
            self.assertIn("not to be trusted", folded.stderr)

    def test_a_grip_that_lifts_a_body_feels_nothing(self):
        self.run_scene("supports:\n  - name: grip\n    facing: [0, 0, 1]\n    keys: [{time: 0}, "
                       "{time: 0.4, translation: [0.1, 0, 0.5]}]")
        end = [row for row in self.rows("supports.csv") if row["time"] == "0.4"][0]
        self.assertLess(max(abs(float(end["force_" + axis])) for axis in "xyz"), 1e-6)
        self.assertAlmostEqual(float(end["displacement_z"]), 0.5, 9)

    def test_check_tells_iterations_instead_of_steps(self):
        said = sinew("check", self.scene(CLAMP.replace("FORCE", "5"))).stdout
        self.assertIn("max_iterations_per_frame: 200000", said)
        self.assertNotIn("time_step", said)

    def test_slender_bodies_bend_by_newtons_method_as_by_relaxation(self):
        """A bar of five layers, thirty times as long, whose packing is turned; the end bends by a third of it."""
        width, length = 5 * LAYER, 150 * LAYER
        write_box(self.folder / "slender.obj", width, length)
        scene = self.folder / "slender.yaml"
        scene.write_text(f"""
body: {{mesh: slender.obj, radius: 0.01, lattice_rotation: [31, 17, 9]}}
material: {{model: bonded, young_modulus: 1e5}}
supports: [{{name: base, facing: [0, 0, -1]}}]
loads: [{{name: end, facing: [0, 0, 1], force: [{E * width ** 4 / 12 / length ** 2}, 0, 0]}}]
probes: [{{name: end, facing: [0, 0, 1]}}]
solver: {{method: static, duration: 0}}
""")
        ends, iterations = [], []
        for solver in ("auto", "relaxation"):
            sinew("simulate", scene, "-o", self.out, "--force", "--set", f"solver.static_solver={solver}")
            ends.append([float(self.rows("probes.csv")[-1]["displacement_" + axis]) for axis in "xz"])
            iterations.append(self.record()["load_steps"][-1]["iterations"])
        for newton, relaxed in zip(*ends):
            self.assertAlmostEqual(newton / relaxed, 1, 4)
        # The elastica under P L^2 / (E I) = 1: five layers bend too far by a fifth, turned ones more.
        self.assertAlmostEqual(ends[0][0] / length, 0.36, delta=0.07)
        self.assertLess(iterations[0], 30)
        self.assertGreater(iterations[1], 10000)
        said = json.loads(sinew("check", scene, "--json").stdout)
        self.assertEqual(said["static_solver"], "newton")
        self.assertLess(said["factor_nonzeros"], 5e7)
        relaxed = json.loads(sinew("check", scene, "--json", "--set", "solver.static_solver=relaxation").stdout)
        self.assertLess(abs(math.log2(relaxed["foreseen_iterations_per_frame"] / iterations[1])), 1)

    def test_newtons_method_is_refused_where_it_does_not_apply(self):
        clamp = CLAMP.replace("FORCE", "5")
        self.refuse(clamp, "solver.static_solver=newton", "material.model=paper", says=["static_solver", "flow"])
        self.refuse(clamp, "solver.static_solver=newton", "solver.precision=single", says=["static_solver", "single"])
        self.refuse(clamp, "solver.static_solver=newton", "solver.method=dynamic", says=["solver.static_solver"])

    def refuse(self, machine, *settings, says):
        words = [word for one in settings for word in ("--set", one)]
        refused = self.run_scene(machine, *words, check=2)
        self.assertEqual(len(refused.stderr.strip().splitlines()), 1, refused.stderr)
        for word in says:
            self.assertIn(word, refused.stderr)
        self.assertFalse((self.out / "particles").exists())

    def test_what_has_no_meaning_is_refused(self):
        clamp = CLAMP.replace("FORCE", "5")
        self.refuse(clamp, "solver.integrator=explicit_euler", says=["solver.integrator"])
        self.refuse(clamp, "solver.time_step=0.001", says=["solver.time_step"])
        self.refuse(clamp, "solver.neighbor_search=cells", says=["solver.neighbor_search"])
        self.refuse(clamp, "solver.method=dynamic", "solver.residual=1e-5", says=["residual"])

    def test_bodies_that_are_not_held_are_refused(self):
        self.refuse("loads: [{name: all, force: [0, 0, 1]}]",
                    says=["no equilibrium", "the body can", "supports"])
        self.refuse("supports: [{name: roller, hold: z, facing: [0, 0, -1]}]",
                    says=["no equilibrium", "nothing holds it"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
