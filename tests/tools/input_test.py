#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What commands are given: folders that hold other things, damaged runs, files of another kind.

usage: input_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import json
import os
import sys
import unittest

from small_run import SOURCE, SmallRun, sinew


class Input(SmallRun):
    def test_a_folder_of_other_files_is_no_place_for_a_run(self):
        self.out.mkdir()
        (self.out / "thesis.tex").write_text("mine")
        for words in [[], ["--force"], ["--resume"]]:
            self.assert_one_line(self.simulate(*words, check=2), 2, "'thesis.tex'", "with -o")
        self.assertEqual([file.name for file in self.out.iterdir()], ["thesis.tex"])
        before = set(os.listdir("/"))
        self.assert_one_line(sinew("simulate", self.scene, "-o", "/"), 2, "are of no run", "with -o")
        self.assertEqual(set(os.listdir("/")), before)

    def test_a_linked_folder_of_frames_is_refused(self):
        self.simulate("--set", "solver.duration=0")
        for name in ("particles", "checkpoint", "pictures"):
            elsewhere = self.folder / f"other_{name}"
            if (self.out / name).exists():
                (self.out / name).rename(elsewhere)
            else:
                elsewhere.mkdir()
            before = sorted(elsewhere.iterdir())
            (self.out / name).symlink_to(elsewhere)
            self.assert_one_line(self.simulate("--force", check=2), 2, f"{name}: is a link", "with -o")
            self.assertEqual(sorted(elsewhere.iterdir()), before)
            (self.out / name).unlink()
        self.simulate("--force", "--set", "solver.duration=0")
        self.folder.joinpath("other_values").mkdir()
        theirs = self.folder / "other_values/values_000000.vtu"
        theirs.write_text("mine")
        (self.out / "values").symlink_to(theirs.parent)
        self.assert_one_line(sinew("measure", self.out, "--arrays", "J"), 2, "values: is a link")
        self.assertEqual(theirs.read_text(), "mine")

    def test_damaged_and_missing_files_are_named(self):
        self.simulate()
        done = sinew("info", self.out, "--verify", "--json", check=0)
        found = json.loads(done.stdout)
        self.assertEqual((found["damaged"], found["missing"]), ([], []))
        self.assertEqual(found["verified"], 4 * 13 + 2 * 4 + 3)  # frames, lists of them; body, scene, bones.csv
        flipped, gone = self.out / "particles/particles_000003.vtu", self.out / "frames/frames_000007.vtu"
        bits = bytearray(flipped.read_bytes())
        bits[len(bits) // 2] ^= 1
        flipped.write_bytes(bits)
        gone.unlink()
        done = sinew("info", self.out, "--verify")
        self.assert_one_line(done, 2, "2 of 63 files", "--force")
        self.assertIn("damaged: particles/particles_000003.vtu\n", done.stdout)
        self.assertIn("missing: frames/frames_000007.vtu\n", done.stdout)
        self.simulate("--force")
        sinew("info", self.out, "--verify", check=0)
        described = sinew("info", self.out, check=0).stdout
        self.assertIn("status: finished\n", described)
        self.assertIn("frames: 13\n", described)
        (self.out / "checksums.sfv").write_text("body.vtu 12345\n")
        self.assert_one_line(sinew("info", self.out, "--verify"), 2, "checksums.sfv:1")
        (self.out / "checksums.sfv").unlink()
        self.assert_one_line(sinew("info", self.out, "--verify"), 2, "checksums.sfv")
        self.assert_one_line(sinew("info", self.folder, "--verify"), 2, "not the folder of a run")
        self.assert_one_line(sinew("info", self.scene, "--verify"), 2, "not the folder of a run")

    def test_a_mesh_in_the_place_of_a_scene_is_told(self):
        mesh, rig = SOURCE / "data/meshes/box.obj", SOURCE / "data/motions/walk.bvh"
        for command in ("run", "simulate", "check"):
            self.assert_one_line(sinew(command, mesh), 2, "this is a mesh, not a scene", f"sinew new {mesh}")
        self.assert_one_line(sinew("run", rig), 2, "this is a rig, not a scene", "sinew new MESH")

    def test_a_radius_is_a_positive_number(self):
        for radius in ("-1", "nan", "0", "inf", "1e301", "one"):
            done = sinew("info", SOURCE / "data/motions/walk.bvh", f"--radius={radius}")
            self.assert_one_line(done, 2, f"--radius: '{radius}' is no positive number")

    def test_a_clip_with_one_frame_more_is_used_with_a_warning(self):
        text = (SOURCE / "data/motions/walk.bvh").read_text()
        clip = self.folder / "walk.bvh"
        clip.write_text(text.replace("Frames: 241", "Frames: 240"))
        done = sinew("info", clip, check=0)
        self.assertIn("frames: 241\n", done.stdout)
        self.assertIn("walk.bvh:386:1: one frame more than the 240", done.stderr)
        scene = self.folder / "walk.yaml"
        scene.write_text((SOURCE / "configs/box_bend_bvh.yaml").read_text()
                         .replace("../data", str(SOURCE / "data")))
        bend = (SOURCE / "data/motions/box_bend.bvh").read_text()
        (self.folder / "bend.bvh").write_text(bend.replace("Frames: 301", "Frames: 300"))
        scene.write_text(scene.read_text().replace(str(SOURCE / "data/motions/box_bend.bvh"), "bend.bvh"))
        done = sinew("check", scene, check=0)
        self.assertEqual(done.stderr.count("one frame more than the 300"), 1)


if __name__ == "__main__":
    unittest.main(argv=["input_test", "-v", *sys.argv[3:]])
