#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""FBX and COLLADA: what sinew reads of files that Blender has written is what Blender's own import says.

usage: /usr/bin/python3 blender_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import functools
import json
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import small_run

sinew = functools.partial(small_run.sinew, check=0)

# A bar of three bones in centimeters with two takes of 1 s and 0.5 s at 25 frames per second, below an empty; a
# cube of another armature with bones of the same names; then what imports of the written files have.
SCRIPT = r"""
import bpy, json, math, sys
folder = sys.argv[sys.argv.index("--") + 1]
bpy.context.scene.render.fps = 25

def clear():
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    for action in list(bpy.data.actions):
        bpy.data.actions.remove(action)

def bar(name, place, bones):
    bpy.ops.object.armature_add(location=place)
    armature = bpy.context.object
    armature.name = name
    bpy.ops.object.mode_set(mode="EDIT")
    edit = armature.data.edit_bones
    edit[0].name, edit[0].tail = "a", (0, 0, 1)
    for one, two in zip("abc"[:bones - 1], "bc"):
        bone = edit.new(two)
        bone.head, bone.tail, bone.parent = edit[one].tail, edit[one].tail + edit[0].tail, edit[one]
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.mesh.primitive_cube_add(location=(place[0], place[1], bones / 2))
    mesh = bpy.context.object
    mesh.scale = 0.2, 0.2, bones / 2
    bpy.ops.object.transform_apply(scale=True)
    mesh.select_set(True)
    armature.select_set(True)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.parent_set(type="ARMATURE_NAME")
    for group in mesh.vertex_groups:
        group.add([v.index for v in mesh.data.vertices], 1 if group.name == "a" else 0.5, "REPLACE")
    return armature

def take(armature, name, frames):
    action = bpy.data.actions.new(name)
    armature.animation_data_create().action = action
    bone = armature.pose.bones["b"]
    bone.rotation_mode = "XYZ"
    for frame, angle in ((0, 0), (frames, 1)):
        bone.rotation_euler = angle, 0, 0
        bone.keyframe_insert("rotation_euler", frame=frame)
    track = armature.animation_data.nla_tracks.new()
    track.strips.new(name, 0, action).name = name
    armature.animation_data.action = None

def box():
    points = [thing.matrix_world @ v.co for thing in bpy.data.objects
              if thing.type == "MESH" and not thing.hide_viewport for v in thing.data.vertices]
    return [[f(p[i] for p in points) for i in range(3)] for f in (min, max)]

def told(read):
    clear()
    read()
    armatures = [thing for thing in bpy.data.objects if thing.type == "ARMATURE"]
    bpy.context.view_layer.update()
    for one in armatures:
        one.data.pose_position = "REST"
    return {"bones": sum(len(one.data.bones) for one in armatures), "box": box(),
            "lengths": sorted(round(action.frame_range[1] - action.frame_range[0]) for action in bpy.data.actions)}

clear()
bpy.ops.object.empty_add()
empty = bpy.context.object
first = bar("Bar", (0, 0, 0), 3)
first.parent = empty
take(first, "bend", 25)
take(first, "half turn", 12)
bpy.ops.wm.collada_export(filepath=folder + "/bar.dae")
bar("Other", (3, 0, 0), 2)
bpy.ops.mesh.primitive_cube_add(size=20)
bpy.context.object.hide_viewport = True
bpy.ops.export_scene.fbx(filepath=folder + "/-bar's \"two\".fbx", add_leaf_bones=True)
said = {"-bar's \"two\".fbx": told(lambda: bpy.ops.import_scene.fbx(filepath=folder + "/-bar's \"two\".fbx")),
        "bar.dae": told(lambda: bpy.ops.wm.collada_import(filepath=folder + "/bar.dae"))}
json.dump(said, open(folder + "/said.json", "w"))
"""


@unittest.skipUnless(shutil.which("blender"), "Blender is not installed: tools/install_packages.sh test")
class FilesOfBlender(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        subprocess.run(["blender", "-b", "--factory-startup", "--python-exit-code", "3", "--python-expr", SCRIPT, "--", cls.folder],
                       check=True, capture_output=True)
        cls.said = json.loads((cls.folder / "said.json").read_text())

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def info(self, name):
        found = json.loads(sinew("info", self.folder / name, "--json").stdout)
        said = self.said[name]
        self.assertEqual(found["bones"], said["bones"])
        (x, y, z), (X, Y, Z) = said["box"]  # glTF has y up
        for one, other in zip(found["box_low"] + found["box_size"], (x, z, -Y, X - x, Z - z, Y - y)):
            self.assertAlmostEqual(one, other, delta=1e-5)
        return found, said

    def test_fbx_has_the_bones_takes_and_box_of_an_import(self):
        found, said = self.info("-bar's \"two\".fbx")
        clips = {clip["name"]: clip for clip in found["clips"]}
        self.assertEqual({name: round(clip["duration"] * 25) for name, clip in clips.items()}, {"bend": 25, "half turn": 12})
        for clip in clips.values():
            self.assertAlmostEqual(clip["frame_time"], 1 / 25, delta=1e-6)
            self.assertEqual(clip["moves"], ["b"])
            self.assertLess(clip["begin"], 1e-6)

    def test_collada_has_the_bones_and_box_of_an_import(self):
        found, said = self.info("bar.dae")
        self.assertEqual(found["bones"], 3)

    def test_a_scene_is_made_of_it(self):
        done = sinew("new", self.folder / "-bar's \"two\".fbx", "-o", self.folder / "bar.yaml", "--clip", "bend", "--quick")
        self.assertIn("bones of the file itself", done.stdout)
        self.assertIn("converts it to meters", done.stdout)


if __name__ == "__main__":
    unittest.main(argv=["blender_test", "-v", *sys.argv[3:]])
