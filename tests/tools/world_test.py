#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes with a world around the body: what their runs leave, and what check says of them.

usage: world_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import csv
import functools
import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import meshio

import small_run

SOURCE = small_run.SOURCE

SCENE = """
body:
  mesh: {source}/data/meshes/box.obj
  radius: 0.025
skeleton:
  bones:
    - {{name: lower, head: [0, 0, 0], tail: [0, 0, 0.34648]}}
    - {{name: upper, parent: lower, tail: [0, 0, 0.69296]}}
world:
  drag: 0.5
  obstacles:
    - name: floor
      shape: plane
      friction: 0.5
    - name: stamp
      shape: mesh
      mesh: {source}/data/meshes/box.obj
      keys:
        - {{time: 0, translation: [0.17, 0, 0]}}
        - {{time: 0.1, translation: [0.13, 0, 0], axis: [0, 0, 1], angle: 5}}
    - {{name: ring, shape: capsule, from: [-0.3, 0, 0.9], to: [0.3, 0, 0.9], radius: 0.02, bone: upper}}
  pins:
    - {{center: [0, 0, 0.66], radius: 0.06, bone: upper}}
  fields:
    - name: wind
      acceleration: [0, 3, 0]
      low: [-1, -1, 0.3]
      high: [1, 1, 1]
      falloff: 0.05
  muscles:
    - name: flexor
      bone: upper
      strength: 500
      keys: [{{time: 0, activation: 0}}, {{time: 0.1, activation: 1}}]
solver:
  duration: 0.2
"""


FALL = """
body: {{mesh: {source}/data/meshes/box.obj, radius: 0.025}}
material: {{model: bonded, young_modulus: 1e5}}
world: {{obstacles: [{{name: floor, shape: plane, point: [0, 0, -0.1]}}]}}
solver: {{duration: 0.3, gravity: [0, 0, -9.81]}}
output: {{interval: 0.05, double_precision: true}}
"""

sinew = functools.partial(small_run.sinew, check=0)


class World(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)
        self.out = self.folder / "run"

    def tearDown(self):
        self.temporary.cleanup()

    def scene(self, text=SCENE):
        path = self.folder / "world.yaml"
        path.write_text(text.format(source=SOURCE))
        return path

    def column(self, name):
        with (self.out / "metrics.csv").open() as table:
            return [float(row[name]) for row in csv.DictReader(table)]

    def test_a_run_leaves_its_obstacles_and_forces(self):
        sinew("simulate", self.scene(), "-o", self.out)
        sinew("measure", self.out)
        rows = re.findall(r'file="([^"]*)"', (self.out / "obstacles.pvd").read_text())
        self.assertEqual(rows, [f"obstacles/obstacles_{i:06}.vtu" for i in range(7)])
        head = (self.out / rows[-1]).read_bytes()
        for name in [b"obstacle", b"velocity", b"normal", b"reaction_force", b"reaction_moment"]:
            self.assertIn(b'Name="' + name + b'"', head)
        self.assertIn(b'"force_world"', (self.out / "particles/particles_000003.vtu").read_bytes())
        record = json.loads((self.out / "run.json").read_text())
        self.assertIn("force_world", record["arrays"]["particles"])
        self.assertIn("obstacle", record["arrays"]["obstacles"])
        self.assertEqual(record["stepper"], "kernel")
        work = max(map(abs, self.column("work_of_world")))
        self.assertGreater(work, 0)
        self.assertGreater(max(self.column("contact_energy")), 0)
        lost = self.column("dissipation")[-1]
        self.assertLess(max(map(abs, self.column("energy_residual"))), 0.01 * max(work, lost))

    def test_its_resolved_scene_gives_the_same_run(self):
        sinew("simulate", self.scene(), "-o", self.out)
        again = self.folder / "again"
        sinew("simulate", self.out / "scene.yaml", "-o", again)
        hashes = [json.loads((folder / "run.json").read_text())["state_hash"]
                  for folder in (self.out, again)]
        self.assertEqual(*hashes)

    def test_an_empty_world_changes_nothing(self):
        hashes = []
        for name, world in ("without", ""), ("with", "world:\n  obstacles: []\n"):
            text = SCENE[:SCENE.index("world:")] + world + SCENE[SCENE.index("solver:"):]
            sinew("simulate", self.scene(text), "-o", self.folder / name)
            record = json.loads((self.folder / name / "run.json").read_text())
            hashes.append(record["state_hash"])
            self.assertEqual(record["neighbor_search"], "lists")
            self.assertFalse((self.folder / name / "obstacles.pvd").exists())
        self.assertEqual(*hashes)

    def test_a_run_is_measured_where_an_obstacles_mesh_is_gone(self):
        mesh = self.folder / "rock.obj"
        mesh.write_text((SOURCE / "data/meshes/box.obj").read_text())
        own = "shape: mesh\n      mesh: "
        sinew("simulate", self.scene(SCENE.replace(own + "{source}/data/meshes/box.obj", own + str(mesh))), "-o", self.out)
        mesh.unlink()
        sinew("measure", self.out)

    def test_check_finds_it_stable(self):
        done = sinew("check", self.scene())
        self.assertIn("rest: stable", done.stdout)
        self.assertIn("neighbor_search: lists", done.stdout)

    def test_check_counts_particles_that_begin_within_an_obstacle(self):
        done = sinew("check", self.scene(SCENE.replace("shape: plane", "shape: plane\n      point: [0, 0, 0.1]")))
        self.assertRegex(done.stderr, r"\d+ particles begin .* within obstacle 'floor'")

    def test_a_body_without_bones_falls_on_the_floor(self):
        scene, run = self.folder / "fall.yaml", self.folder / "fall"
        scene.write_text(FALL.format(source=SOURCE))
        sinew("check", scene)
        sinew("run", scene, "-o", run, "--no-movie")
        moved = [meshio.read(frame).point_data["displacement"] for frame in sorted((run / "particles").glob("*.vtu"))]
        step = json.loads((run / "run.json").read_text())["time_step"]  # Euler's velocities come first
        self.assertAlmostEqual(moved[2][:, 2].mean(), -9.81 * 0.1 * (0.1 + step) / 2, 9)
        rest = meshio.read(run / "body.vtu").points
        lowest = min((rest + one)[:, 2].min() for one in moved)
        self.assertGreater(lowest, -0.1)  # centers stay above the floor
        self.assertLess(lowest, -0.05)

    @unittest.skipUnless(small_run.HAS_GROUPS, "built without groups")
    def test_groups_keep_free_what_obstacles_press(self):
        scene = self.folder / "press.yaml"
        grouped = ["--set", "hierarchy.enabled=true", "hierarchy.min_particles=64"]
        scene.write_text(FALL.format(source=SOURCE) + "hierarchy: {dynamic: true}\n")
        done = small_run.sinew("check", scene, *grouped, check=2)
        for part in ["press.yaml:7:", "obstacle 'floor'", "no bone holds", "set hierarchy.dynamic to false"]:
            self.assertIn(part, done.stderr)
        scene.write_text(FALL.format(source=SOURCE).replace("point: [0, 0, -0.1]", "bone: foot") +
                         "skeleton: {bones: [{name: foot, head: [0, 0, 0], tail: [0, 0, 0.69]}]}\n")
        found = json.loads(sinew("check", scene, "--json", *grouped).stdout)
        self.assertGreater(found["free_near_obstacles"], 20)
        self.assertGreater(found["grouped"], 20)

    def test_mistakes_name_their_line(self):
        for old, new, said in [
                ("bone: upper}}\n  fields", "bone: uper}}\n  fields", "there is no bone 'uper'"),
                ("center: [0, 0, 0.66]", "center: [0, 0, 6]", "holds 0 particles"),
                ("meshes/box.obj\n      keys", "meshes/bix.obj\n      keys", "bix.obj")]:
            done = sinew("check", self.scene(SCENE.replace(old, new)), check=2)
            self.assertRegex(done.stderr, r"world.yaml:\d+:\d+: .*" + re.escape(said))

    def rest(self, *values):
        done = sinew("check", SOURCE / "configs/paper_literal.yaml", "--json", "--set", *values)
        return json.loads(done.stdout)["rest"], done.stderr

    def test_the_literal_range_holds_or_collapses_by_lambda(self):
        for size, lam, state in [(0.010, 0.05, "stable"), (0.010, 0.2, "creeps"), (0.010, 1, "unstable"),
                                 (0.006, 1, "unstable"), (0.006, 0.02, "stable")]:  # by fewer particles
            found, warned = self.rest(f"body.radius={size}", f"material.lambda={lam}")
            self.assertEqual(found, state, (size, lam))
            self.assertEqual("second neighbors" in warned, lam > 0.1)

    def test_a_body_whose_scene_knows_no_coarser_one_is_tried_itself(self):
        done = sinew("check", SOURCE / "configs/paper_literal.yaml", "--json", "--set", "body.radius=0.007",
                     "binding.explicit=[{bone: upper, center: [0, 0, 0.606], radius: 0.005}]")
        found = json.loads(done.stdout)
        self.assertEqual(found["rest_particles"], found["particles"])

    def test_check_says_of_rest_what_runs_show(self):
        done = subprocess.run([sys.executable, SOURCE / "tests/campaigns/rest.py", small_run.BIN, SOURCE, "6", "3"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def strangers(self, cohesion):
        """Pairs of neighbors that were none at rest, frame by frame, while two fingers part."""
        sinew("simulate", SOURCE / "configs/two_fingers.yaml", "-o", self.out, "--force",
              "--set", f"material.cohesion={cohesion}")
        sinew("measure", self.out)
        return self.column("new_neighbors")

    def test_fingers_part_where_strangers_do_not_attract_each_other(self):
        free, sticky = self.strangers("initial_neighbors"), self.strangers("all")
        self.assertGreater(max(free), 0)
        self.assertEqual(free[-1], 0)
        touching = [sum(1 for count in counts if count > 0) for counts in (free, sticky)]
        self.assertGreater(touching[1], touching[0])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
