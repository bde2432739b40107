#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes whose rigs come from BVH and glTF files: the same motion as from YAML, in whole runs.

usage: /usr/bin/python3 rig_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import functools
import json
import math
import re
import struct
import sys
import tempfile
import unittest
from pathlib import Path

import meshio
import numpy as np

import small_run

SOURCE = small_run.SOURCE
KEY_TIME = {"bvh": 1 / 120, "glb": 1 / 60}  # s between the keys of our clips; ways between are straight


sinew = functools.partial(small_run.sinew, check=0)


def info(*words):
    return json.loads(sinew("info", *words, "--json").stdout)


class Run:
    """A simulated scene: its bones by name, and its particles, at every frame."""

    def __init__(self, folder, scene, *sets):
        self.out = Path(folder) / scene
        words = [word for one in ("output.double_precision=true", *sets) for word in ("--set", one)]
        sinew("simulate", SOURCE / f"configs/{scene}.yaml", "-o", self.out, "--force", *words)
        self.record = json.loads((self.out / "run.json").read_text())
        self.names = [bone["name"] for bone in self.record["bones"]]

    def frames(self, series):
        return [meshio.read(path) for path in sorted((self.out / series).glob("*.vtu"))]

    def bones(self):
        """Heads and axes (12 numbers) of the bones by name, frame by frame."""
        found = []
        for mesh in self.frames("frames"):
            axes = [mesh.point_data[f"axis_{axis}"] for axis in "xyz"]
            found.append(dict(zip(self.names, np.hstack([mesh.points, *axes]))))
        return found

    def ways(self):
        """Displacements of the particles, frame by frame."""
        return [mesh.point_data["displacement"] for mesh in self.frames("particles")]


class SameMotion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def expect_same_bones(self, run, other):
        """At frames, which are keys of all clips."""
        one, two = run.bones(), other.bones()
        self.assertEqual(len(one), len(two))
        self.assertEqual(set(one[0]), set(two[0]))
        for frame, (here, there) in enumerate(zip(one, two)):
            for name in here:
                self.assertLess(np.abs(here[name] - there[name]).max(), 1e-6, (frame, name))

    def test_box_bends_alike_by_yaml_bvh_and_glb(self):
        radius, length, fastest = 0.02, 0.35, math.radians(90) * 6
        yaml, bvh, glb = (Run(self.temporary.name, scene, f"body.radius={radius}", "solver.duration=1.6")
                          for scene in ("box_bend", "box_bend_bvh", "box_bend_glb"))
        self.assertEqual(yaml.record["particles"], glb.record["particles"])
        for kind, run in (("bvh", bvh), ("glb", glb)):
            self.expect_same_bones(yaml, run)
            # Between keys a straight way leaves the curve by h^2 / 8 of its acceleration. Bent far,
            # the body flows a little, and differently where its bones differ.
            apart = KEY_TIME[kind] ** 2 / 8 * fastest * length
            for frame, (one, other) in enumerate(zip(yaml.ways(), run.ways())):
                error = np.linalg.norm(one - other, axis=1)
                grown = 2 if frame <= 15 else 10
                self.assertLess(np.sqrt((error ** 2).mean()), grown * apart + 1e-6, (kind, frame))

    def test_fox_walks_alike_by_yaml_bvh_and_glb(self):
        sets = ["body.radius=0.012", "solver.duration=0.5", "binding.joint_zone=0"]
        yaml, bvh, glb = (Run(self.temporary.name, scene, *sets)
                          for scene in ("creature_walk", "fox_bvh", "fox_glb"))
        self.expect_same_bones(yaml, bvh)
        self.expect_same_bones(yaml, glb)
        moved = np.linalg.norm(glb.ways()[-1], axis=1).max()
        self.assertGreater(moved, 0.01)

    def test_weights_of_the_file_bind_the_particles(self):
        run = Run(self.temporary.name, "fox_glb", "body.radius=0.012", "solver.duration=0")
        other = Run(self.temporary.name, "fox_bvh", "body.radius=0.012", "solver.duration=0",
                    "binding.joint_zone=0")
        ours, nearest = meshio.read(run.out / "body.vtu"), meshio.read(other.out / "body.vtu")
        names, others = run.names, other.names
        same = [names[a] == others[b] for a, b in zip(ours.point_data["bone"], nearest.point_data["bone"])]
        self.assertGreater(np.mean(same), 0.8)  # the file's weights fall with the distance from a bone
        weight = ours.point_data["weight"]
        self.assertLess(weight.min(), 0.7)  # where two bones share
        self.assertGreater(np.mean(weight > 0.9), 0.2)

    def test_scenes_of_rigs_in_files_have_no_warnings(self):
        for scene in ("box_bend_bvh", "box_bend_glb", "fox_bvh", "fox_glb"):
            said = sinew("check", SOURCE / f"configs/{scene}.yaml").stderr.splitlines()
            # The paper's material is softer than asked along some bones: that is no matter of the rig.
            warnings = [line for line in said if line.startswith("sinew: ") and "than the modulus" not in line]
            self.assertEqual(warnings, [], scene)

    def test_parts_of_a_skin_are_one_body(self):
        glb = info(SOURCE / "data/motions/fox.glb", "--up", "y")
        ply = info(SOURCE / "data/meshes/creature.ply")
        for key in ("closed", "components", "points", "triangles"):
            self.assertEqual(glb[key], ply[key], key)
        self.assertAlmostEqual(glb["volume"] / ply["volume"], 1, 5)
        np.testing.assert_allclose(glb["box_size"], ply["box_size"], atol=1e-6)

    def test_speed_by_info_is_that_of_all_formats(self):
        speeds = [info(SOURCE / f"data/motions/{name}", "--radius", 0.01)["bone_speed"]
                  for name in ("box_bend.bvh", "box_bend.glb")]
        speeds.append(info(SOURCE / "configs/box_bend.yaml")["bone_speed"])
        self.assertAlmostEqual(speeds[0] / speeds[2], 1, 2)
        self.assertAlmostEqual(speeds[1] / speeds[2], 1, 1)


def bvh():
    return (SOURCE / "data/motions/box_bend.bvh").read_text()


def glb_parts():
    """The JSON and the binary part of box_bend.glb."""
    content = (SOURCE / "data/motions/box_bend.glb").read_bytes()
    size = struct.unpack("<I", content[12:16])[0]
    return json.loads(content[20:20 + size]), content[28 + size:]


def glb(document, data):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


class HostileFiles(unittest.TestCase):
    """Damaged rigs end with exit code 2 and one line, on their own and reached through a scene."""

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def refuse(self, file, *words):
        done = small_run.sinew(*words)
        self.assertEqual(done.returncode, 2, (file, done.stderr))
        self.assertRegex(done.stderr, r"\Asinew: [^\n]*; [^\n]*\n\Z", file)
        self.assertIn(file, done.stderr)

    def expect_refused(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        self.refuse(name, "info", path)
        scene = self.folder / "scene.yaml"
        scene.write_text(f"body: {{mesh: {SOURCE}/data/meshes/box.obj, radius: 0.03}}\nskeleton: {{file: {name}}}\n")
        self.refuse("scene.yaml:2:", "check", scene)

    def test_bvh(self):
        text = bvh()
        for name, content in {
                "truncated": text[:len(text) // 2], "half_a_joint": text[:60], "empty": "", "text": "hello\n",
                "bytes": bytes(range(256)),
                "fewer_frames": text.replace("Frames: 301", "Frames: 299"),
                "countless_frames": text.replace("Frames: 301", "Frames: 99999999999999999999"),
                "no_frame_time": re.sub("Frame Time: .*", "Frame Time: 0", text),
                "negative_frame_time": re.sub("Frame Time: .*", "Frame Time: -0.01", text),
                "nan": text.replace("OFFSET 0", "OFFSET nan", 1), "infinite": text.replace("OFFSET 0", "OFFSET 1e999", 1),
                "braces": text.replace("}", "", 1), "channels": text.replace("CHANNELS 6", "CHANNELS 600"),
                "deep": "HIERARCHY\nROOT a {\nOFFSET 0 0 0\n" + "JOINT a {\nOFFSET 0 1 0\n" * 100000}.items():
            self.expect_refused(f"{name}.bvh", content)

    def test_glb(self):
        document, data = glb_parts()
        whole = glb(document, data)

        def changed(change):
            other = json.loads(json.dumps(document))
            change(other)
            return glb(other, data)

        animation, accessors = document["animations"][0], document["accessors"]
        times = animation["samplers"][0]["input"]
        for name, content in {
                "truncated": whole[:len(whole) // 2], "header": whole[:20], "empty": b"", "text": b"hello",
                "cycle": changed(lambda d: d["nodes"][2].update(children=[1])),
                "node": changed(lambda d: d["skins"][0].update(joints=[1, 99])),
                "count": changed(lambda d: d["accessors"][times].update(count=10 ** 9)),
                "negative": changed(lambda d: d["accessors"][times].update(count=-1)),
                "times": changed(lambda d: d["accessors"][times].update(count=accessors[times]["count"] - 1)),
                "view": changed(lambda d: d["bufferViews"][0].update(byteLength=2 ** 31)),
                "buffer": changed(lambda d: d["buffers"][0].update(byteLength=2 ** 30)),
                "missing_buffer": changed(lambda d: d["buffers"][0].update(uri="nowhere.bin")),
                "no_buffer": changed(lambda d: d.pop("buffers")),
                "nan": glb(document, struct.pack("<f", math.nan) * (len(data) // 4))}.items():
            self.expect_refused(f"{name}.glb", content)
        deep = '{"asset":' * 100000
        self.expect_refused("deep.gltf", deep)


class Info(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return self.folder / name

    def test_bvh_of_motion_capture(self):
        text = re.sub("lower", "mixamorig:Hips", bvh().replace("\n", "\r\n").replace("  ", "\t").rstrip())
        file = self.write("clip.bvh", text)
        lines = sinew("info", file, "--radius", 0.01).stdout.splitlines()
        for line in ("bones: 2", "frames: 301", "duration: 2.5 s", "clip: clip"):
            self.assertIn(line, lines)
        self.assertTrue(lines[-2].startswith("mixamorig:Hips: 0.346") and lines[-1].startswith("  upper: 0.346"), lines)

    def test_several_clips_are_all_told(self):
        found = sinew("info", SOURCE / "data/motions/fox.glb").stdout.splitlines()
        self.assertEqual([line for line in found if line.startswith("clip: ")], ["clip: walk", "clip: wag"])
        told = info(SOURCE / "data/motions/fox.glb")
        self.assertEqual([clip["name"] for clip in told["clips"]], ["walk", "wag"])
        self.assertEqual([clip["frames"] for clip in told["clips"]], [121, 121])
        self.assertEqual([line for line in found if "moves" in line],
                         [f"  moves: {len(clip['moves'])} of 21 bones in 2 s" for clip in told["clips"]])
        self.assertLess(len(told["clips"][1]["moves"]), len(told["clips"][0]["moves"]))
        self.assertEqual(told["skeleton"][1], {"name": "chest", "parent": 0, "length": told["skeleton"][1]["length"]})

    def test_bones_may_be_named_as_anything(self):
        file = self.write("odd.bvh", bvh().replace("lower", "bones").replace("upper", "volume"))
        told = info(file)
        self.assertEqual((told["bones"], [bone["name"] for bone in told["skeleton"]]), (2, ["bones", "volume"]))

    def test_rigs_and_clips_of_yaml_alone(self):
        rig = info(self.write("rig.yaml", "bones:\n  - {name: a, head: [0, 0, 0], tail: [0, 0, 2]}\n"
                                          "  - {name: b, parent: a, length: 1}\n"))
        self.assertEqual((rig["bones"], rig["skeleton"][1]["parent"], rig["skeleton"][1]["length"]), (2, 0, 1))
        clip = info(self.write("clip.yml", "frame_rate: 25\ntracks:\n  - bone: b\n"
                                           "    keys: [{frame: 0}, {frame: 50, axis: [0, 1, 0], angle: 90}]\n"))
        self.assertEqual((clip["frames"], clip["duration"], clip["moves"]), (51, 2, ["b"]))
        done = sinew("info", self.write("bad.yaml", "tracks:\n  - {bone: b, keys: []}\n"), check=2)
        self.assertIn("bad.yaml:2:", done.stderr)


class Twist(unittest.TestCase):
    def test_of_270_degrees_arrives_unwrapped(self):
        """The lower bone turns about itself, and with it all the box."""
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "twist.yaml"
            text = (SOURCE / "configs/box_twist.yaml").read_text().replace("../data", f"{SOURCE}/data")
            for old, new in (("twist: 90", "twist: 270"), ("bone: upper", "bone: lower")):
                self.assertIn(old, text)
                text = text.replace(old, new)
            scene.write_text(text)
            out = Path(folder) / "run"
            sinew("simulate", scene, "-o", out, "--set", "body.radius=0.02", "--set", "output.interval=0.1")
            told = [meshio.read(path).point_data["twist"][0] for path in sorted((out / "frames").glob("*.vtu"))]
            self.assertAlmostEqual(told[-1], 270, 3)
            self.assertTrue(all(a <= b + 1e-3 for a, b in zip(told, told[1:])), told)
            end = meshio.read(sorted((out / "particles").glob("*.vtu"))[-1])
            rest = end.points - end.point_data["displacement"]
            turned = np.column_stack([rest[:, 1], -rest[:, 0], rest[:, 2]])  # 270 degrees about z
            self.assertLess(np.abs(end.points - turned).max(), 0.02)


if __name__ == "__main__":
    unittest.main(argv=["rig_test", "-v", *sys.argv[3:]])
