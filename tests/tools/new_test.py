#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that sinew new writes run as they are.

usage: /usr/bin/python3 new_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import json
import tempfile
import unittest
from pathlib import Path

from small_run import SOURCE, sinew

BAR = """v 0 0 0\nv 100 0 0\nv 0 100 0\nv 100 100 0\nv 0 0 500\nv 100 0 500\nv 0 100 500\nv 100 100 500
f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 2 4 8 6\nf 4 3 7 8\nf 3 1 5 7\n"""
SHEET = "v 0 0 0\nv .3 0 0\nv .3 .1 0\nv 0 .1 0\nf 1 2 3 4\n"


class New(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)
        self.scene = self.folder / "scene.yaml"
        self.addCleanup(self.temporary.cleanup)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def make(self, *words):
        done = sinew("new", *words, "-o", self.scene, "--json", check=0)
        return json.loads(done.stdout)

    def runs(self, *sets):
        """Filled, moved and measured, without pictures; the metrics of a body that is not torn."""
        out = self.folder / "out"
        sinew("simulate", self.scene, "-o", out, "--quiet", *sets, check=0, timeout=200)
        limits = ["--fail-on", "inverted > 0.01", "--fail-on", "volume_error > 0.05"]
        sinew("measure", out, "--quiet", *limits, check=0, timeout=200)
        return json.loads((out / "run.json").read_text())

    def test_a_mesh_of_large_triangles_in_millimeters(self):
        made = self.make(self.write("bar.obj", BAR))
        self.assertTrue(Path(made["mesh"]).is_file())
        self.assertIn("millimeters", made["unit"])
        self.assertGreater(self.runs()["particles"], 2500)

    def test_a_mesh_with_two_limbs(self):
        self.make(SOURCE / "data/meshes/two_fingers.obj")
        self.assertIn("limb2_1", self.scene.read_text())
        self.runs()

    def test_a_shape_without_a_mesh(self):
        self.make("--shape", "capsule", "--size", "0.1,0.1,0.4")
        self.assertTrue(self.scene.with_suffix(".obj").is_file())
        self.runs()
        self.assertIn("box, sphere", sinew("new", "--shape", "egg", check=2).stderr)
        self.assertIn("three lengths", sinew("new", "--shape", "box", "--size", "1,2", check=2, cwd=self.folder).stderr)
        self.assertIn("--shape", sinew("new", check=2).stderr)

    def test_a_rig_alone_gets_a_skin(self):
        made = self.make(SOURCE / "data/motions/walk.bvh")
        self.assertIn("100 %", made["bones"])
        sinew("check", self.scene, check=0)

    def test_names_with_spaces_and_other_folders(self):
        mesh = self.write("a part: #1.obj", BAR)
        self.scene = self.folder / "sub/my scene.yaml"
        self.scene.parent.mkdir()
        self.make(mesh)
        sinew("check", self.scene, check=0)

    def test_a_sheet_becomes_a_layer(self):
        self.make(self.write("sheet.obj", SHEET))
        self.runs()

    def test_a_rig_gives_bones_weights_and_one_of_its_clips(self):
        self.make(SOURCE / "data/motions/fox.glb")
        text = self.scene.read_text()
        for line in ("method: file", "clip: walk", "also holds: 'wag'"):
            self.assertIn(line, text)
        sinew("check", self.scene, check=0)

    def test_a_rig_of_its_own_axes_lies_in_the_mesh(self):
        made = self.make(SOURCE / "data/meshes/creature.ply", SOURCE / "data/motions/walk.bvh")
        self.assertIn("100 %", made["bones"])
        sinew("check", self.scene, check=0)

    def test_the_same_scene_on_any_threads(self):
        texts = set()
        for threads in ("1", "2"):
            self.make(SOURCE / "data/meshes/arm.ply", "--threads", threads, "--force")
            texts.add(self.scene.read_text())
        self.assertEqual(len(texts), 1)

    def test_an_older_scene_is_kept(self):
        self.scene.write_text("mine")
        done = sinew("new", SOURCE / "data/meshes/box.obj", "-o", self.scene, check=2)
        self.assertIn("--force", done.stderr)
        self.assertEqual(self.scene.read_text(), "mine")


if __name__ == "__main__":
    unittest.main(argv=["new_test.py"])
