#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that sinew new writes run as they are.

usage: /usr/bin/python3 new_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import base64
import json
import math
import re
import struct
import tempfile
import unittest
from pathlib import Path

from small_run import SOURCE, sinew

BAR = """v 0 0 0\nv 100 0 0\nv 0 100 0\nv 100 100 0\nv 0 0 500\nv 100 0 500\nv 0 100 500\nv 100 100 500
f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 2 4 8 6\nf 4 3 7 8\nf 3 1 5 7\n"""
COARSER = 2.5  # than new writes: a fortieth of the work
SHEET = "v 0 0 0\nv .3 0 0\nv .3 .1 0\nv 0 .1 0\nf 1 2 3 4\n"
GAP = """HIERARCHY
ROOT hips
{
  OFFSET 0 100 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT thighL
  {
    OFFSET 10 -10 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 -80 0
    }
  }
  JOINT thighR
  {
    OFFSET -10 -10 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 -80 0
    }
  }
  JOINT spine
  {
    OFFSET 0 30 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 50 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.1
0 100 0 0 0 0 0 0 0 0 0 0 0 0 0
0 100 0 0 0 0 0 20 0 0 20 0 0 0 0
"""


def cup(wall):
    """Of square walls, open above: an outer box and a smaller one from its floor to its rim."""
    outer = [(x, y, z) for z in (0, 100) for y in (0, 80) for x in (0, 80)]
    inner = [(x, y, z) for z in (wall, 100) for y in (wall, 80 - wall) for x in (wall, 80 - wall)]
    faces = [(1, 3, 4, 2), (1, 2, 6, 5), (2, 4, 8, 6), (4, 3, 7, 8), (3, 1, 5, 7)]
    walls = faces + [tuple(8 + i for i in reversed(face)) for face in faces]
    rim = [(5, 6, 14, 13), (6, 8, 16, 14), (8, 7, 15, 16), (7, 5, 13, 15)]
    return "".join("v %g %g %g\n" % p for p in outer + inner) + "".join("f %d %d %d %d\n" % f for f in walls + rim)


def edited(glb, edit):
    """The file after `edit` changed its JSON."""
    length = struct.unpack_from("<I", glb, 12)[0]
    document = json.loads(glb[20:20 + length])
    edit(document)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    rest = glb[20 + length:]
    return struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest


def scaled(glb, factor):
    """The file, larger by its root, as exporters write other units."""
    def scale(document):
        for node in document["scenes"][0]["nodes"]:
            document["nodes"][node]["scale"] = 3 * [factor]
    return edited(glb, scale)


def add_numbers(document, kind, numbers, count):
    """A new accessor of so many elements, in a buffer of its own."""
    data = struct.pack(f"<{len(numbers)}f", *numbers)
    document["buffers"].append({"byteLength": len(data), "uri": "data:;base64," + base64.b64encode(data).decode()})
    document["bufferViews"].append({"buffer": len(document["buffers"]) - 1, "byteLength": len(data)})
    document["accessors"].append({"bufferView": len(document["bufferViews"]) - 1, "componentType": 5126,
                                  "type": kind, "count": count})
    return len(document["accessors"]) - 1


def first_key_of(document, animation):
    """An animation named 'pose' of the first keys of another."""
    def one(accessor):
        first = {**document["accessors"][accessor], "count": 1}
        document["accessors"].append(first | {"max": first["min"]} if "min" in first else first)
        return len(document["accessors"]) - 1
    samplers = [{**sampler, "input": one(sampler["input"]), "output": one(sampler["output"])}
                for sampler in animation["samplers"]]
    return {**animation, "name": "pose", "samplers": samplers}


def human(unit):
    """A BVH file of somebody 1.73 m tall, lengths in so many units per meter."""
    leg = lambda side: {"Thigh": ((side * 0.1, -0.04, 0), {"Shin": ((0, -0.43, 0), {"Foot": (  # noqa: E731
        (0, -0.42, 0), {"Toe": ((0, -0.06, 0.14), {})})})})}
    arm = lambda side: {"Collar": ((side * 0.04, 0.1, 0), {"Arm": ((side * 0.14, 0, 0), {"Forearm": (  # noqa: E731
        (side * 0.29, 0, 0), {"Hand": ((side * 0.26, 0, 0), {})})})})}
    sides = lambda limb: {word + name: part for side, word in ((1, "left"), (-1, "right"))  # noqa: E731
                          for name, part in limb(side).items()}
    body = {**sides(leg), "spine": ((0, 0.12, 0), {"chest": ((0, 0.2, 0), {
        **sides(arm), "neck": ((0, 0.2, 0), {"head": ((0, 0.1, 0), {})})})})}
    count = 0

    def joint(name, offset, children, depth):
        nonlocal count
        count += 1
        space, length = "  " * depth, " ".join(f"{unit * x:g}" for x in offset)
        channels = "6 Xposition Yposition Zposition" if depth == 0 else "3"
        text = f"{space}{'JOINT' if depth else 'ROOT'} {name}\n{space}{{\n{space}  OFFSET {length}\n"
        text += f"{space}  CHANNELS {channels} Zrotation Xrotation Yrotation\n"
        for child, (place, parts) in children.items():
            text += joint(child, place, parts, depth + 1)
        if not children:
            end = 0.16 if name == "head" else 0
            text += f"{space}  End Site\n{space}  {{\n{space}    OFFSET 0 {unit * end:g} {unit * 0.05 * (not end):g}\n{space}  }}\n"
        return text + f"{space}}}\n"

    text = "HIERARCHY\n" + joint("hips", (0, 0.95, 0), body, 0)
    turns = " 0" * (3 * count)
    return text + f"MOTION\nFrames: 2\nFrame Time: 0.1\n" + 2 * (f"0 {unit * 0.95:g} 0" + turns + "\n")


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

    def coarsely(self, times):
        radius = float(re.search(r"radius: (\S+)", self.scene.read_text()).group(1))
        return "--set", f"body.radius={times * radius}"

    def check(self, times=COARSER):
        """What check says of the scene, coarsely."""
        return sinew("check", self.scene, *self.coarsely(times), check=0)

    def runs(self, *sets, times=COARSER):
        """Filled, moved and measured, without pictures, coarsely; the metrics of a body that is not torn."""
        out = self.folder / "out"
        sinew("simulate", self.scene, "-o", out, "--quiet", "--force", *self.coarsely(times), *sets, check=0, timeout=200)
        limits = ["--fail-on", "inverted > 0.01", "--fail-on", "volume_error > 0.05"]
        sinew("measure", out, "--quiet", *limits, check=0, timeout=200)
        return json.loads((out / "run.json").read_text())

    def test_a_mesh_of_large_triangles_in_millimeters(self):
        made = self.make(self.write("bar.obj", BAR))
        self.assertTrue(Path(made["mesh"]).is_file())
        self.assertIn("millimeters", made["unit"])
        self.assertGreater(self.runs()["particles"], 2500)

    def test_a_mesh_with_two_limbs(self):
        """Bones end at the tips of both fingers; what else is a limb differs between versions of CGAL."""
        self.make(SOURCE / "data/meshes/two_fingers.obj")
        bones = re.findall(r"parent: (\w+), .*tail: \[(.*?)\]", self.scene.read_text())
        tails = {tuple(map(float, tail.split(","))): parent for parent, tail in bones}
        for tip in ((-0.05, 0, 0.28), (0.05, 0, 0.28)):
            near = min(tails, key=lambda tail: math.dist(tail, tip))
            self.assertLess(math.dist(near, tip), 0.015)
            self.assertNotEqual(tails[near], "root", "one bone for a whole finger")
        self.runs()

    def test_the_small_hole_of_a_ring_is_closed_and_bones_follow_it(self):
        rows, columns = 48, 20
        points = [(q * math.cos(a), q * math.sin(a), 0.035 * math.sin(b)) for a in (2 * math.pi * i / rows for i in range(rows))
                  for b in (2 * math.pi * j / columns for j in range(columns)) for q in [0.1 + 0.035 * math.cos(b)]]
        faces = [(i * columns + j, (i + 1) % rows * columns + j, (i + 1) % rows * columns + (j + 1) % columns, i * columns + (j + 1) % columns)
                 for i in range(rows) for j in range(columns) if not (i < 6 and 12 <= j < 18)]
        ring = self.write("ring.ply", "ply\nformat ascii 1.0\n" + f"element vertex {len(points)}\n"
                          + "".join(f"property double {x}\n" for x in "xyz") + f"element face {len(faces)}\n"
                          + "property list uchar int vertex_indices\nend_header\n"
                          + "".join("%r %r %r\n" % p for p in points) + "".join("4 %d %d %d %d\n" % f for f in faces))
        made = self.make(ring)
        self.assertEqual(made["holes"], "1 hole of the mesh, closed (body.close_holes)")
        self.assertIn("close_holes: true", self.scene.read_text())
        tails = re.findall(r"tail: \[(.*?)\]", self.scene.read_text())
        for x, y, z in (map(float, tail.split(",")) for tail in tails):
            self.assertLess(math.hypot(math.hypot(x, y) - 0.1, z), 0.035, "a bone ends outside of the ring")

    def test_up_is_as_told(self):
        bar = self.write("bar.obj", BAR)
        for axis in ("y", "z"):
            self.make(bar, "--up", axis, "--force")
            self.assertIn(f"as --up says", self.scene.read_text())
        self.assertIn("give y or z", sinew("new", bar, "--up", "x", "--force", check=2, cwd=self.folder).stderr)

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
        self.check()

    def test_a_rig_whose_bones_lie_apart_gets_one_skin(self):
        self.make(self.write("gap.bvh", GAP))
        info = json.loads(sinew("info", self.scene.with_suffix(".obj"), "--json", "--quiet", check=0).stdout)
        self.assertEqual(info["components"], 1)

    def test_the_walls_of_a_cup_are_layers_thick(self):
        made = self.make(self.write("cup.obj", cup(4)))
        self.assertIn("hollow", made["bones"])
        self.assertIn("method: nearest", self.scene.read_text())
        said = self.check(1.6).stderr
        for word in ("reached from no bone", "one or two layers"):
            self.assertNotIn(word, said)
        self.runs("--set", "solver.duration=0.3", times=1.6)

    def test_a_plate_is_more_than_two_layers_thick(self):
        plate = "".join(f"v {x} {y} {z}\n" for z in (0, 0.008) for y in (0, 0.5) for x in (0, 0.5))
        self.make(self.write("plate.obj", plate + BAR[BAR.index("f "):]))
        radius = float(re.search(r"radius: (\S+)", self.scene.read_text()).group(1))
        self.assertLess(2 * radius + 2 * math.sqrt(8 / 3) * radius, 0.008)  # three layers fit

    def test_names_with_spaces_and_other_folders(self):
        mesh = self.write("a part: #1.obj", BAR)
        self.scene = self.folder / "sub/my scene.yaml"
        self.scene.parent.mkdir()
        self.make(mesh)
        self.check()

    def test_a_sheet_becomes_a_layer(self):
        self.make(self.write("sheet.obj", SHEET))
        self.runs()

    def test_an_open_shell_beside_a_body_becomes_a_layer(self):
        skirt = "".join(f"v {150 + 90 * math.cos(a)} {50 + 90 * math.sin(a)} {z}\n"
                        for z in (0, 300) for a in (k * math.pi / 12 for k in range(24)))
        skirt += "".join(f"f {9 + k} {9 + (k + 1) % 24} {33 + (k + 1) % 24} {33 + k}\n" for k in range(24))
        lines = [re.sub(r"v (\S+)", lambda m: f"v {float(m[1]) + 100:g}", line) for line in BAR.splitlines()]
        self.make(self.write("dressed.obj", "\n".join(line for line in lines if line[0] == "v") + "\n" + skirt
                             + "\n".join(line for line in lines if line[0] == "f") + "\n"))
        self.assertIn("along 1 open shell of", self.scene.read_text())
        self.check()

    def test_a_run_takes_the_work_that_drawing_does(self):
        self.make(SOURCE / "data/motions/fox.glb")
        checked = json.loads(sinew("check", self.scene, "--json", check=0).stdout)
        work = checked["particles"] * checked["steps"]
        self.assertLess(work, 5e8)
        self.assertTrue(work > 4e8 or checked["particles"] > 8e4, (work, checked["particles"]))

    def test_a_quick_scene_takes_a_thirtieth_of_the_work_and_new_says_how_long(self):
        found = self.make(SOURCE / "data/meshes/creature.ply", SOURCE / "data/motions/walk.bvh", "--quick")
        self.assertRegex(found["time"], r"^about \d+ s for a run on this machine, \S+ s of them steps$")
        checked = json.loads(sinew("check", self.scene, "--json", check=0).stdout)
        self.assertLess(checked["particles"] * checked["steps"], 5e8 / 30)
        self.assertLessEqual((checked["duration"], checked["frames"]), (2, 21))
        self.runs(times=1)
        slow = sinew("new", SOURCE / "data/meshes/two_fingers.obj", "-o", self.scene, "--force", check=0).stdout
        self.assertRegex(slow, "\ntime: about ")

    def test_a_rig_alone_is_as_tall_as_a_human(self):
        units = {"meters": 1, "centimeters": 100, "inches": 1 / 0.0254, "CMU": 0.45 / 0.0254, "millimeters": 1000}
        for word, unit in units.items():
            made = self.make(self.write(f"{word}.bvh", human(unit)), "--force")
            self.assertIn(word, made["unit"])
            self.assertAlmostEqual(float(made["unit"].split()[-2]), 1.73, delta=0.1)

    def test_a_rig_gives_bones_weights_and_one_of_its_clips(self):
        self.make(SOURCE / "data/motions/fox.glb")
        text = self.scene.read_text()
        for line in ("method: file", "clip: walk", "also holds: 'wag'"):
            self.assertIn(line, text)
        self.check()

    def test_a_clip_that_is_a_pose_is_passed_over(self):
        def pose_first(document):
            document["animations"].insert(0, first_key_of(document, document["animations"][0]))

        def pose_alone(document):
            document["animations"] = [first_key_of(document, document["animations"][0])]

        fox, glb = (SOURCE / "data/motions/fox.glb").read_bytes(), self.folder / "posed.glb"
        glb.write_bytes(edited(fox, pose_first))
        self.make(glb)
        for line in ("clip: walk", "also holds: 'pose', 'wag'"):
            self.assertIn(line, self.scene.read_text())
        glb.write_bytes(edited(fox, pose_alone))
        self.make(glb, "--force")
        self.assertIn("tracks:", self.scene.read_text())
        self.assertNotIn("clip:", self.scene.read_text())
        self.runs()

    def test_clips_that_move_no_flesh_or_change_sizes_come_after_others(self):
        def bind_eye(document, binary):
            skin, nodes = document["skins"][0], document["nodes"]
            nodes[skin["joints"][-1]].setdefault("children", []).append(len(nodes))
            nodes.append({"name": "eye", "translation": [0, 0, 0.01]})
            binds = document["accessors"][skin["inverseBindMatrices"]]
            view = document["bufferViews"][binds["bufferView"]]
            first = view.get("byteOffset", 0) + binds.get("byteOffset", 0)
            known = struct.unpack_from(f"<{16 * binds['count']}f", binary, first)
            skin["joints"].append(len(nodes) - 1)
            skin["inverseBindMatrices"] = add_numbers(document, "MAT4", known + known[-16:], len(skin["joints"]))

        def add_clips(document, sizes):
            trot, joints = document["animations"][0], document["skins"][0]["joints"]
            trot["name"] = "trot"
            turn = next(one for one in trot["channels"] if one["target"]["path"] == "rotation")
            eye = {"sampler": turn["sampler"], "target": {"node": joints[-1], "path": "rotation"}}
            scale = {"sampler": len(trot["samplers"]), "target": {"node": joints[1], "path": "scale"}}
            keys = {"input": add_numbers(document, "SCALAR", (0, 1), 2), "output": add_numbers(document, "VEC3", sizes, 2)}
            document["animations"][:0] = [
                {**trot, "name": "blink", "channels": [eye]},
                {**trot, "name": "grow", "channels": trot["channels"] + [scale], "samplers": trot["samplers"] + [keys]}]

        fox, glb = (SOURCE / "data/motions/fox.glb").read_bytes(), self.folder / "blinking.glb"
        binary = fox[28 + struct.unpack_from("<I", fox, 12)[0]:]

        def add_others(document):
            bind_eye(document, binary)
            add_clips(document, (1, 1, 1, 0.4, 0.4, 0.4))

        glb.write_bytes(edited(fox, add_others))
        self.make(glb)
        self.assertIn("clip: trot", self.scene.read_text())
        self.make(glb, "--force", "--clip", "grow")
        said = self.check()
        self.assertRegex(said.stdout + said.stderr, "the clip scales bone '.*' to 0.4 of its size: .*motion.clip")

    def test_a_clip_without_a_skin_moves_the_rig_and_the_weights_of_the_mesh(self):
        def without_skin(document):
            del document["skins"], document["meshes"]
            for node in document["nodes"]:
                node.pop("mesh", None), node.pop("skin", None)
            document["animations"] = [a for a in document["animations"] if a["name"] == "wag"]
            next(node for node in document["nodes"] if node.get("name") == "tail")["name"] = "coil"

        fox, clip = SOURCE / "data/motions/fox.glb", self.folder / "clip.glb"
        clip.write_bytes(edited(fox.read_bytes(), without_skin))
        told = json.loads(sinew("info", clip, "--json").stdout)
        self.assertEqual(told["bones"], 3)
        self.assertNotIn("points", told)
        self.make(fox, clip, "--count", "3000", "--duration", "0.25")
        text = self.scene.read_text()
        for line in ("clip.glb\n", "fox.glb\n", "method: file", "duration: 0.25", "About 3"):
            self.assertIn(line, text)
        told = sinew("check", self.scene, check=0)
        self.assertRegex(told.stderr, "moves 1 node that the skeleton lacks: 'coil'")
        self.assertRegex(told.stderr, "does not move [0-9]+ of 21 joints: ")

    def test_a_clip_of_other_names_has_a_table_in_the_scene(self):
        def of_mixamo(document):
            del document["skins"], document["meshes"]
            for node in document["nodes"]:
                node.pop("mesh", None), node.pop("skin", None)
                node["name"] = "mixamorig:" + node.get("name", "").upper()

        fox, clip = SOURCE / "data/motions/fox.glb", self.folder / "clip.glb"
        clip.write_bytes(edited(fox.read_bytes(), of_mixamo))
        self.make(fox, clip, "--clip", "wag", "--quick")
        for line in ('- [tail, "mixamorig:TAIL"]', "clip.glb\n", "fox.glb\n", "method: file"):
            self.assertIn(line, self.scene.read_text())
        told = sinew("check", self.scene, check=0)
        self.assertRegex(told.stderr, "motion.names moves all but [0-9]+ of 21 bones: ")
        wrong = self.scene.read_text().replace("mixamorig:TAIL", "tale")
        self.scene.write_text(wrong)
        self.assertRegex(sinew("check", self.scene).stderr, r"scene.yaml:[0-9]+:[0-9]+: there is no joint 'tale' in the clip; ")

    def test_meshes_are_chosen_by_their_names(self):
        fox = SOURCE / "data/motions/fox.glb"
        self.make(fox, "--meshes", "fox", "--quick")
        for line in ("fox.glb\n", "method: file"):
            self.assertIn(line, self.scene.read_text())
        wrong = sinew("new", fox, "--meshes", "foxs", "--force", "-o", self.scene)
        self.assertIn("there is no mesh 'foxs'; did you mean fox?", wrong.stderr)

    def test_a_clip_is_chosen_by_its_name(self):
        self.make(SOURCE / "data/motions/fox.glb", "--clip", "wag", "--quick")
        self.assertIn("clip: wag", self.scene.read_text())
        wrong = sinew("new", SOURCE / "data/motions/fox.glb", "--clip", "wagg", "--force", "-o", self.scene)
        self.assertEqual(wrong.returncode, 2)
        self.assertIn("did you mean wag?", wrong.stderr)

    def test_a_rig_in_centimeters_becomes_as_large_as_in_meters(self):
        small, large = SOURCE / "data/motions/fox.glb", self.folder / "large.glb"
        large.write_bytes(scaled(small.read_bytes(), 100))
        radii = []
        for glb, word in ((small, "glTF is in meters"), (large, "centimeters")):
            self.assertIn(word, self.make(glb, "--force")["unit"])
            radii.append(float(re.search(r"radius: (\S+)", self.scene.read_text()).group(1)))
            said = self.check().stderr
            for word in ("unit", "follows", "beside", "times as large"):
                self.assertNotIn(word, said)
        self.assertAlmostEqual(radii[0], radii[1], delta=1e-4)

    def test_a_clip_that_begins_late_begins_with_its_first_key(self):
        glb = bytearray((SOURCE / "data/motions/fox.glb").read_bytes())
        length = struct.unpack_from("<I", glb, 12)[0]
        document = json.loads(glb[20:20 + length])
        first = 28 + length  # of the binary chunk
        for accessor in {s["input"] for a in document["animations"] for s in a["samplers"]}:
            view = document["bufferViews"][document["accessors"][accessor]["bufferView"]]
            at = first + view.get("byteOffset", 0) + document["accessors"][accessor].get("byteOffset", 0)
            for k in range(document["accessors"][accessor]["count"]):
                struct.pack_into("<f", glb, at + 4 * k, struct.unpack_from("<f", glb, at + 4 * k)[0] + 8)
        late = self.folder / "late.glb"
        late.write_bytes(glb)
        self.make(late)
        self.assertRegex(self.scene.read_text(), r"start: 8\n")
        self.check()

    def test_pieces_within_each_other_fill_as_one_body(self):
        bar = self.write("bar.obj", BAR)
        self.make(bar)
        alone = self.runs("--set", "solver.duration=0.01", "--set", "output.interval=0.01")["particles"]
        twice = BAR + "".join(f"v {x} {y} {z}\n" for x, y, z in corners_of(BAR, 5))
        twice += "".join("f " + " ".join(str(int(i) + 8) for i in line.split()[1:]) + "\n"
                         for line in BAR.splitlines() if line[0] == "f")
        self.make(self.write("twice.obj", twice), "--force")
        self.assertGreater(self.runs("--set", "solver.duration=0.01", "--set", "output.interval=0.01")["particles"], 0.8 * alone)

    def test_a_rig_of_its_own_axes_lies_in_the_mesh(self):
        made = self.make(SOURCE / "data/meshes/creature.ply", SOURCE / "data/motions/walk.bvh")
        self.assertIn("100 %", made["bones"])
        self.check()

    def test_the_same_scene_on_any_threads(self):
        texts = set()
        for threads in ("1", "2"):
            self.make(SOURCE / "data/meshes/arm.ply", "--threads", threads, "--force")
            texts.add(self.scene.read_text())
        self.assertEqual(len(texts), 1)

    def test_thousands_of_joints_in_one_take_seconds(self):
        joint = "JOINT j{}\n{{\nOFFSET 0 0 0.1\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{{\nOFFSET 0 0 .1\n}}\n}}\n"
        rig, joints = self.folder / "wide.bvh", 3000
        rig.write_text("HIERARCHY\nROOT j0\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n" +
                       "".join(joint.format(i) for i in range(1, joints)) + "}\nMOTION\nFrames: 2\nFrame Time: .03\n" +
                       3 * joints * "0 " + "\n" + 3 * joints * "1 " + "\n")
        sinew("new", SOURCE / "data/meshes/box.obj", rig, "-o", self.folder / "wide.yaml", check=0, timeout=40)

    def test_an_older_scene_is_kept(self):
        self.scene.write_text("mine")
        done = sinew("new", SOURCE / "data/meshes/box.obj", "-o", self.scene, check=2)
        self.assertIn("--force", done.stderr)
        self.assertEqual(self.scene.read_text(), "mine")


if __name__ == "__main__":
    unittest.main(argv=["new_test.py"])
