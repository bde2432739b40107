#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that sinew new writes run as they are.

usage: /usr/bin/python3 new_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import json
import re
import struct
import tempfile
import unittest
from pathlib import Path

from small_run import SOURCE, sinew

BAR = """v 0 0 0\nv 100 0 0\nv 0 100 0\nv 100 100 0\nv 0 0 500\nv 100 0 500\nv 0 100 500\nv 100 100 500
f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 2 4 8 6\nf 4 3 7 8\nf 3 1 5 7\n"""
SHEET = "v 0 0 0\nv .3 0 0\nv .3 .1 0\nv 0 .1 0\nf 1 2 3 4\n"


def scaled(glb, factor):
    """With all of it larger by its root, as exporters write other units."""
    length = struct.unpack_from("<I", glb, 12)[0]
    document = json.loads(glb[20:20 + length])
    for node in document["scenes"][0]["nodes"]:
        document["nodes"][node]["scale"] = 3 * [factor]
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    rest = glb[20 + length:]
    return struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest


def corners_of(obj, smaller):
    """Moved inward by so much along each axis; `obj` is a box from 0."""
    corners = [[float(x) for x in line.split()[1:]] for line in obj.splitlines() if line[0] == "v"]
    return [[x - smaller if x else smaller for x in corner] for corner in corners]


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

    def test_a_rig_in_centimeters_becomes_as_large_as_in_meters(self):
        small, large = SOURCE / "data/motions/fox.glb", self.folder / "large.glb"
        large.write_bytes(scaled(small.read_bytes(), 100))
        radii = []
        for glb, word in ((small, "glTF is in meters"), (large, "centimeters")):
            self.assertIn(word, self.make(glb, "--force")["unit"])
            radii.append(float(re.search(r"radius: (\S+)", self.scene.read_text()).group(1)))
            told = sinew("check", self.scene, check=0).stderr
            self.assertNotIn("unit", told)
            self.assertNotIn("beside", told)
        self.assertAlmostEqual(radii[0], radii[1], delta=1e-4)

    def test_pieces_within_each_other_fill_as_one_body(self):
        bar = self.write("bar.obj", BAR)
        self.make(bar)
        alone = self.runs("--set", "solver.duration=0.01", "--set", "output.interval=0.01", "--force")["particles"]
        twice = BAR + "".join(f"v {x} {y} {z}\n" for x, y, z in corners_of(BAR, 5))
        twice += "".join("f " + " ".join(str(int(i) + 8) for i in line.split()[1:]) + "\n"
                         for line in BAR.splitlines() if line[0] == "f")
        self.make(self.write("twice.obj", twice), "--force")
        self.assertGreater(self.runs("--set", "solver.duration=0.01", "--set", "output.interval=0.01", "--force")["particles"], 0.8 * alone)

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
