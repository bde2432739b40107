#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Folders and files from elsewhere, and surroundings of which nobody has thought.

usage: foreign_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import unittest

from small_run import BIN, SOURCE, SmallRun, sinew

ESCAPE = "\x1b]0;owned\x07"
CONTROL = "\x9b31m"


class Links(SmallRun):
    """What a run folder from elsewhere may contain: links that lead to files of the user."""
    FILES = [".report.html.tmp", ".metrics.csv.tmp", ".metrics_bones.csv.tmp", ".metrics.json.tmp", ".run.json.tmp"]
    OF_RUN = [".body.vtu.tmp", ".scene.yaml.tmp", ".view.py.tmp", ".view.pvsm.tmp", ".particles.pvd.tmp", ".particles.vtu.series.tmp",
              "bones.csv", "log.txt", "checksums.sfv", "probes.csv", "particles/.particles_000000.vtu.tmp", ".run.json.tmp",
              "checkpoint/.a.bin.tmp"]

    def setUp(self):
        super().setUp()
        self.mine = self.folder / "mine"
        self.mine.write_text("precious")
        self.simulate("--quiet")

    def plant(self, names, link=os.symlink):
        for name in names:
            (self.out / name).parent.mkdir(exist_ok=True)
            (self.out / name).unlink(missing_ok=True)
            link(self.mine, self.out / name)

    def assert_kept(self):
        self.assertEqual(self.mine.read_text(), "precious")

    def test_measuring_writes_through_no_link(self):
        self.plant(self.FILES)
        sinew("measure", self.out, check=0)
        self.assert_kept()
        self.assertTrue((self.out / "report.html").is_file())

    def test_a_run_writes_through_no_link(self):
        for link in (os.symlink, os.link):
            self.plant(self.OF_RUN, link)
            self.simulate("--quiet", "--force")
            self.assert_kept()
            self.assert_series_are_whole(self.record()["frames"])

    def test_a_lock_that_has_another_name_is_refused(self):
        self.plant([".lock"], os.link)
        self.assertIn(".lock", self.simulate("--force", check=4).stderr)
        self.assert_kept()

    def test_pictures_go_into_no_folder_elsewhere(self):
        away = self.folder / "away"
        away.mkdir()
        (self.out / "pictures").symlink_to(away)
        done = sinew("render", self.out, "--no-movie")
        self.assert_one_line(done, 2, "pictures", "is a link to another folder")
        self.assertEqual(list(away.iterdir()), [])

    def test_other_tables_are_written_through_no_link(self):
        for target, words in {"out.data": ["export", self.out, "--to", "lammps", "--times", "0", "-o"],
                              "body.vtu": ["fill", self.scene, "-o"]}.items():
            target = self.folder / target
            (self.folder / f".{target.name}.tmp").symlink_to(self.mine)
            sinew(*words, target, check=0)
            self.assert_kept()
            self.assertTrue(target.is_file())


class Images(SmallRun):
    """A model from elsewhere is packed into a picture book for others: with its own pictures only."""
    PNG = bytes.fromhex("89504e470d0a1a0a0000000d4948445200000001000000010806000000"
                        "1f15c4890000000d49444154789c6360000000000500010d0a2db40000000049454e44ae426082")

    def images_of(self, texture):
        model = self.folder / "model"
        model.mkdir(exist_ok=True)
        text = (SOURCE / "data/meshes/box.obj").read_text()
        first = text.index("\nf ")
        text = "mtllib m.mtl\n" + text[:first] + "\nusemtl m" + text[first:]
        (model / "box.obj").write_text(text)
        (model / "m.mtl").write_text(f"newmtl m\nmap_Kd {texture}\n")
        self.scene.write_text(self.scene.read_text().replace(str(SOURCE / "data/meshes/box.obj"), str(model / "box.obj")))
        self.simulate("--force", "--set", "output.export=true")
        data = (self.out / "surface.glb").read_bytes()
        size = int.from_bytes(data[12:16], "little")
        return json.loads(data[20:20 + size]).get("images", [])

    def test_only_pictures_below_the_model_are_embedded(self):
        (self.folder / "model").mkdir()
        (self.folder / "secret.png").write_bytes(self.PNG)
        (self.folder / "model/own.png").write_bytes(self.PNG)
        (self.folder / "model/link.png").symlink_to("../secret.png")
        self.assertEqual(len(self.images_of("own.png")), 1)
        for texture in ("../secret.png", self.folder / "secret.png", "link.png", "x/../../secret.png"):
            self.assertEqual(self.images_of(texture), [], texture)


class Surroundings(SmallRun):
    def closed(self, redirections, *words):
        line = 'exec "$@" ' + redirections
        return subprocess.run(["sh", "-c", line, "sh", BIN / "sinew", *map(str, words)], timeout=120,
                              stdout=subprocess.DEVNULL).returncode

    def test_closed_descriptors_are_no_files_of_a_run(self):
        self.simulate("--quiet")
        bones = (self.out / "bones.csv").read_bytes()
        for redirections in ("<&- >&- 2>&-", "<&- 2>&-", ">&-", "2>&-"):
            self.assertEqual(self.closed(redirections, "simulate", self.scene, "-o", self.out, "--force"), 0)
            self.assertEqual((self.out / "bones.csv").read_bytes(), bones)
            self.assertRegex((self.out / "log.txt").read_text(), r"\A[\x20-\x7e\n]*finished")
            self.assertEqual(self.closed(redirections, "render", self.out, "--no-movie"), 0)
            self.assertEqual(self.closed(redirections, "run", self.scene, "-o", self.out, "--force", "--no-movie"), 0)

    def test_drawing_with_too_few_addresses_is_refused(self):
        self.simulate("--quiet")
        for limit in (200, 400, 600, 700, 800, 950):
            bound = lambda: resource.setrlimit(resource.RLIMIT_AS, (limit * 10**6, limit * 10**6))
            done = sinew("render", self.out, "--no-movie", "--quiet", preexec_fn=bound)
            self.assertIn(done.returncode, (0, 2), f"{limit} MB: {done.stderr}")
            if done.returncode == 2:
                self.assert_one_line(done, 2, "MB")

    def assert_stopped_early(self):
        record = self.record()
        self.assertEqual(record["status"], "stopped")
        self.assertLess(record["frames"], 2000)
        self.assert_series_are_whole(record["frames"])
        self.assertTrue((self.out / "checkpoint").is_dir())

    LONG = ["--set", "solver.duration=200", "--set", "output.interval=0.05"]

    def test_a_reader_that_leaves_stops_a_run_which_goes_on(self):
        """It reads the lines before the first step; a line at a tenth of the frames has no reader."""
        child = subprocess.Popen([BIN / "sinew", "simulate", self.scene, "-o", self.out, *self.LONG],
                                 stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.wait_for(child, "frames/frames_000001.vtu")
        child.stderr.close()
        self.assertEqual(child.wait(timeout=200), 130)
        self.assert_stopped_early()

    def test_a_reader_that_left_before_the_first_line_stops_a_run_in_order(self):
        reader, writer = os.pipe()
        os.close(reader)
        done = subprocess.run([BIN / "sinew", "simulate", self.scene, "-o", self.out, *self.LONG], timeout=200,
                              stdout=subprocess.DEVNULL, stderr=writer)
        os.close(writer)
        self.assertEqual(done.returncode, 130)
        self.assert_stopped_early()


class Terminal(SmallRun):
    """Texts from files that a terminal would obey."""
    def assert_harmless(self, done):
        for text in (done.stdout, done.stderr):
            self.assertNotRegex(text, r"[\x00-\x09\x0b-\x1f\x7f-\x9f]")
        return done

    def test_records_and_checksums_and_names(self):
        self.simulate("--quiet")
        record = self.record()
        record["status"] = "fini" + ESCAPE + CONTROL
        record["version"] = record["host"] = ESCAPE + CONTROL
        (self.out / "run.json").write_text(json.dumps(record, ensure_ascii=False))
        (self.out / "checksums.sfv").write_text(f"; {ESCAPE}\n{ESCAPE}{CONTROL} 00000000\n")
        for words in (["info", self.out], ["info", self.out, "--verify"], ["info", self.out, "--json"],
                      ["measure", self.out], ["render", self.out, "--no-movie"], ["simulate", self.scene, "-o", self.out]):
            self.assert_harmless(sinew(*words, sound=False))

    def test_names_of_files(self):
        strange = self.folder / f"box{ESCAPE}{CONTROL}.obj"
        shutil.copy(SOURCE / "data/meshes/box.obj", strange)
        made = self.assert_harmless(sinew("new", strange, "-o", self.folder / f"s {ESCAPE}.yaml"))
        self.assertEqual(made.returncode, 0, made.stderr)
        for words in (["info", strange], ["info", strange, "--json"], ["fill", strange], ["check", strange],
                      ["check", self.folder / f"no{ESCAPE}.yaml"], ["new", strange, "--force"]):
            self.assert_harmless(sinew(*words, cwd=self.folder))

    def test_commands_to_be_typed_are_quoted(self):
        strange = self.folder / "my box's; touch owned .obj"
        shutil.copy(SOURCE / "data/meshes/box.obj", strange)
        said = sinew("check", strange).stderr
        command = re.search(r"sinew new (.*)", said)[1]
        listed = subprocess.run(["bash", "-c", f"printf '%s\\n' {command}"], capture_output=True, text=True)
        self.assertEqual(listed.stdout, f"{strange}\n")
        scene = self.folder / "a 'scene'\x1b.yaml"
        said = sinew("new", strange, "-o", scene, check=0).stdout
        command = re.search(r"run: sinew run (.*)", said)[1]
        listed = subprocess.run(["bash", "-c", f"printf '%s\\n' {command}"], capture_output=True, text=True)
        self.assertEqual(listed.stdout, f"{scene}\n")


class Nesting(SmallRun):
    def test_records_of_deep_brackets_are_refused(self):
        self.simulate("--quiet")
        for depth in (100, 10_000, 200_000):
            text = json.dumps({**self.record(), "unknown": "@"}).replace('"@"', "[" * depth + "]" * depth)
            kept = (self.out / "run.json").read_text()
            (self.out / "run.json").write_text(text)
            for command in ("info", "measure", "render"):
                self.assertEqual(sinew(command, self.out).returncode, 2)
                self.assertEqual((self.out / "run.json").read_text(), text)
            (self.out / "run.json").write_text(kept)


if __name__ == "__main__":
    unittest.main(argv=["foreign_test", "-v", *sys.argv[3:]])
