#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole commands on small scenes: what they leave behind, and how they end.

usage: run_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import csv
import json
import os
import pty
import re
import resource
import shlex
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

BIN, SOURCE = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()

SCENE = """
body:
  mesh: {mesh}
  radius: 0.025
skeleton:
  bones:
    - name: lower
      head: [0, 0, 0]
      tail: [0, 0, 0.34648]
    - name: upper
      parent: lower
      tail: [0, 0, 0.69296]
motion:
  tracks:
    - bone: upper
      keys:
        - time: 0
        - time: 0.2
          axis: [0, 1, 0]
          angle: 30
        - time: 0.4
          axis: [0, 1, 0]
          angle: 0
solver:
  duration: 0.4
"""

SERIES = ["particles", "surface", "bones", "frames"]


def sinew(*words, check=None, **options):
    done = subprocess.run([BIN / "sinew", *map(str, words)], capture_output=True, text=True,
                          timeout=60, **options)
    if check is not None and done.returncode != check:
        raise AssertionError(f"{words} ended with {done.returncode}:\n{done.stdout}\n{done.stderr}")
    return done


class Commands(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)
        self.scene = self.folder / "small.yaml"
        self.scene.write_text(SCENE.format(mesh=SOURCE / "data/meshes/box.obj"))
        self.out = self.folder / "run"

    def tearDown(self):
        self.temporary.cleanup()

    def simulate(self, *words, check=0):
        return sinew("simulate", self.scene, "-o", self.out, *words, check=check)

    def record(self, folder=None):
        return json.loads(((folder or self.out) / "run.json").read_text())

    def wait_for(self, child, file):
        for _ in range(1000):
            if (self.out / file).exists():
                return
            self.assertIsNone(child.poll(), "the run ended by itself")
            time.sleep(0.02)
        self.fail(f"no {file} after 20 s")

    def assert_one_line(self, done, exit_code, *parts):
        self.assertEqual(done.returncode, exit_code, done.stderr)
        said = [line for line in done.stderr.splitlines() if line.startswith("sinew: ")]
        errors = [line for line in said if not line.startswith("sinew: warning: ")]
        self.assertEqual(len(errors), 1, done.stderr)
        self.assertIn("; ", errors[0])
        for part in parts:
            self.assertIn(part, errors[0])

    def assert_series_are_whole(self, frames):
        """Every series has these frames, in the order of their times, and nothing torn beside."""
        for name in SERIES:
            expected = [f"{name}/{name}_{i:06}.vtu" for i in range(frames)]
            pvd = (self.out / f"{name}.pvd").read_text()
            self.assertEqual(re.findall(r'file="([^"]*)"', pvd), expected)
            times = [float(time) for time in re.findall(r'timestep="([^"]*)"', pvd)]
            self.assertEqual(times, sorted(times))
            for file in expected:
                self.assertTrue((self.out / file).read_bytes().endswith(b"</VTKFile>\n"), file)
            self.assertEqual(len(list((self.out / name).iterdir())), frames, name)

    def test_run_leaves_everything_behind(self):
        sinew("run", self.scene, "-o", self.out, "--no-movie", check=0)
        for name in ["scene.yaml", "run.json", "log.txt", "body.vtu", "metrics.csv", "metrics.json",
                     "report.html", "view.py", "live.py", "pictures/contact_sheet.png"]:
            self.assertGreater((self.out / name).stat().st_size, 0, name)
        for name in SERIES:
            self.assertEqual(len(list((self.out / name).glob("*.vtu"))), 13, name)
        rows = list(csv.DictReader((self.out / "metrics.csv").open()))
        self.assertEqual(len(rows), 13)
        self.assertEqual(list(rows[0])[0], "time")
        record = self.record()
        for key in ["version", "command", "host", "particles", "steps", "frames", "time_step",
                    "particle_steps_per_second", "seconds", "state_hash", "arrays", "instruction_set"]:
            self.assertIn(key, record)
        self.assertEqual((record["precision"], record["neighbour_search"]), ("double", "lists"))
        self.assertGreaterEqual(record["lists"]["sifts"], record["lists"]["rebuilds"])
        self.assertGreater(record["lists"]["rebuilds"], 0)
        self.assertEqual(record["status"], "finished")
        self.assertEqual(record["frames"], 13)
        self.assertEqual(list(self.folder.rglob("*.tmp")), [])

    def test_bones_csv_has_a_row_per_bone_and_frame(self):
        self.simulate()
        rows = list(csv.DictReader((self.out / "bones.csv").open()))
        self.assertEqual([row["bone"] for row in rows], 13 * ["lower", "upper"])
        self.assertEqual(list(rows[0]), ["time", "bone"] + [f"{what}_{axis}" for what in ("force", "moment")
                                                            for axis in "xyz"] + ["power"])
        self.assertEqual(float(rows[0]["power"]), 0)
        self.assertGreater(max(float(row["power"]) for row in rows if row["bone"] == "upper"), 0)
        self.assertEqual({float(row["power"]) for row in rows if row["bone"] == "lower"}, {0})  # it rests

    def test_skinning_and_export_are_written_on_request(self):
        asked = [f"--set=output.{key}=true" for key in ("skin_lbs", "skin_dqs", "export")]
        self.simulate(*asked)
        for name in ("skin_lbs", "skin_dqs"):
            self.assertEqual(len(list((self.out / name).glob("*.vtu"))), 13)
            self.assertIn(f"{name}_000012.vtu", (self.out / f"{name}.pvd").read_text())
        cache = (self.out / "surface.pc2").read_bytes()
        version, points, start, rate, samples = struct.unpack("<iiffi", cache[12:32])
        self.assertEqual((cache[:12], version, start, rate, samples), (b"POINTCACHE2\0", 1, 0, 1, 13))
        self.assertEqual(len(cache), 32 + 12 * points * samples)
        vertices = [line.split()[1:] for line in (self.out / "surface.obj").read_text().splitlines()
                    if line.startswith("v ")]
        self.assertEqual(len(vertices), points)
        rest = struct.unpack(f"<{3 * points}f", cache[32:32 + 12 * points])
        for found, expected in zip(rest, [float(x) for vertex in vertices for x in vertex]):
            self.assertAlmostEqual(found, expected, 6)
        moving = (self.out / "surface.glb").read_bytes()
        size = struct.unpack("<I", moving[12:16])[0]
        document = json.loads(moving[20:20 + size])
        self.assertEqual(len(document["meshes"][0]["primitives"][0]["targets"]), 12)
        self.assertEqual(document["buffers"][0]["byteLength"], len(moving) - size - 28)
        again = json.loads(sinew("info", self.out / "surface.glb", "--up", "y", "--json", check=0).stdout)
        self.assertEqual((again["points"], again["closed"]), (points, True))
        self.simulate("--force")
        for name in ("skin_lbs.pvd", "skin_dqs.pvd", "surface.pc2", "surface.obj", "surface.glb"):
            self.assertFalse((self.out / name).exists(), name)

    def test_bindings_are_all_of_the_scenes_choice(self):
        text = self.scene.read_text()
        hashes = set()
        for binding in ["{}", "{method: inside}", "{core_radius: 0.06}", "{joint_zone: 1, method: inside}",
                        "{explicit: [{bone: upper, low: [-1, -1, 0.3], high: [1, 1, 1]}]}",
                        "{explicit: [{bone: lower, ids: [0, 1]}, {centre: [0, 0, 0.6], radius: 0.1}]}"]:
            self.scene.write_text(text + "binding: " + binding + "\n")
            # Flesh without a bone may move a quarter of a radius per step in the scene, bone or no bone.
            self.simulate("--force", "--set", "solver.time_step_factor=0.1")
            self.assertEqual(self.record()["status"], "finished")
            hashes.add(self.record()["state_hash"])
            again = self.folder / "again"
            sinew("simulate", self.out / "scene.yaml", "-o", again, "--force", check=0)
            self.assertEqual(self.record(again)["state_hash"], self.record()["state_hash"])
            sinew("measure", self.out, check=0)
        self.assertGreaterEqual(len(hashes), 5)  # inside a bar the nearest bone is the nearest

    def test_mistakes_of_bindings_name_their_line(self):
        bad = self.folder / "bad.yaml"
        for binding, *parts in [("explicit: [{bone: uper, ids: [0]}]", "uper", "did you mean upper"),
                                ("explicit: [{bone: upper, ids: [123456789]}]", "no particle 123456789"),
                                ("explicit: [{bone: upper, ids: [0.5]}]", "no particle 0.5"),
                                ("explicit: [{bone: upper, ids: []}]", "without values"),
                                ("explicit: [{bone: upper, low: [0, 0, 0]}]", "one corner"),
                                ("explicit: [{bone: upper, radius: 1}]", "centre"),
                                ("explicit: [{bone: upper}]", "names no particles"),
                                ("explicit: {bone: upper}", "must be a list"),
                                ("method: file", "no glTF file"), ("method: near", "nearest")]:
            bad.write_text(self.scene.read_text() + f"binding:\n  {binding}\n")
            line = len(self.scene.read_text().splitlines()) + 2
            self.assert_one_line(sinew("simulate", bad, "-o", self.out), 2, f"{bad}:{line}:", *parts)

    def test_default_folder_is_out_and_the_scenes_name(self):
        sinew("simulate", self.scene, "--set", "solver.duration=0", check=0, cwd=self.folder)
        self.assertTrue((self.folder / "out/small/particles.pvd").exists())

    def test_used_folder_is_refused_unless_forced_or_resumed(self):
        self.simulate()
        before = self.record()["state_hash"]
        keep = self.out / "notes.txt"
        keep.write_text("mine")
        self.assert_one_line(self.simulate(check=2), 2, "--force")
        self.assertIn("finished", self.simulate("--resume").stderr)
        self.simulate("--force")
        self.assertEqual(self.record()["state_hash"], before)
        self.assertEqual(keep.read_text(), "mine")

    def test_broken_scene_leaves_the_old_run_alone(self):
        self.simulate()
        self.simulate("--force", "--set", "body.mesh=missing.obj", check=2)
        self.assertEqual(self.record()["status"], "finished")

    def test_resolved_scene_gives_the_same_run(self):
        self.simulate("--set", "material.lambda=0.8")
        again = self.folder / "again"
        sinew("simulate", self.out / "scene.yaml", "-o", again, check=0)
        self.assertEqual(self.record(again)["state_hash"], self.record()["state_hash"])

    def test_record_tells_how_the_steps_were_done(self):
        for words, used in [
                (["solver.precision=single"], ("single", "lists")),
                (["solver.neighbour_search=cells"], ("double", "cells")),
                (["solver.precision=single", "solver.neighbour_search=cells"], ("double", "cells")),
                (["material.damping_form=central"], ("double", "cells")),
                (["binding.force=anchor"], ("double", "cells"))]:
            sets = [part for word in ["solver.duration=0.1", *words] for part in ["--set", word]]
            self.simulate("--force", *sets)
            record = self.record()
            self.assertEqual((record["precision"], record["neighbour_search"]), used, words)
            self.assertEqual(record["lists"]["rebuilds"] > 0, used[1] == "lists", words)
            self.assertEqual(record["instruction_set"] == "plain", used[1] == "cells", words)

    def test_precision_and_search_change_no_result_much(self):
        reference = None
        for word in ["neighbour_search=cells", "neighbour_search=lists", "precision=single"]:
            self.simulate("--force", "--set", "solver." + word)
            sinew("measure", self.out, check=0)
            rows = list(csv.DictReader((self.out / "metrics.csv").open()))
            most = max(float(row["displacement_max"]) for row in rows)
            reference = reference or most
            self.assertAlmostEqual(most / reference, 1, places=3)

    def test_state_does_not_depend_on_the_number_of_threads(self):
        hashes = set()
        for threads in [1, 2, 3, 8]:
            self.simulate("--force", "--threads", threads, "--set", "body.radius=0.012",
                          "--set", "solver.duration=0.1")
            hashes.add(self.record()["state_hash"])
        self.assertEqual(len(hashes), 1)

    def test_body_filled_before_is_used_again_only_if_it_fits(self):
        self.out.mkdir()
        sinew("fill", self.scene, "-o", self.out / "body.vtu", check=0)
        self.simulate("--set", "solver.duration=0")
        count = self.record()["particles"]
        self.simulate("--force", "--set", "solver.duration=0", "--set", "body.radius=0.02")
        self.assertGreater(self.record()["particles"], count)

    def test_unstable_run_ends_with_3_and_keeps_its_good_frames(self):
        done = self.simulate("--set", "solver.time_step=0.0166", "--set", "solver.duration=2", check=3)
        self.assert_one_line(done, 3, "particle", "solver.time_step")
        self.assertEqual(self.record()["status"], "unstable")
        self.assertGreater(self.record()["frames"], 0)
        self.assert_series_are_whole(self.record()["frames"])
        self.assertIn("blowup.vtu", done.stderr)
        text = (self.out / "blowup.vtu").read_text()
        offender = re.search(r'Name="offender"[^>]*RangeMin="([^"]*)" RangeMax="([^"]*)"', text)
        self.assertEqual(offender.groups(), ("0", "1"))
        moved = re.search(r'Name="moved"[^>]*RangeMax="([^"]*)"', text)
        self.assertGreater(float(moved[1]), 0.25)
        for file in self.out.rglob("*.vtu"):
            self.assertNotRegex(file.read_text(), r'Range(Min|Max)="[^"]*(nan|inf)', file)
        self.simulate("--force")
        self.assertFalse((self.out / "blowup.vtu").exists())

    def test_disk_that_fills_up_while_frames_are_written_ends_with_4(self):
        words = ["--set", "body.radius=0.012", "--set", "solver.duration=0.4"]
        self.simulate(*words)
        frames = sorted((self.out / "particles").glob("*.vtu"))
        limit = frames[1].stat().st_size  # stands for the full disk: larger files fail
        bad = next(i for i, file in enumerate(frames) if file.stat().st_size > limit)
        limited = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        done = sinew("simulate", self.scene, "-o", self.out, "--force", *words, preexec_fn=limited)
        self.assert_one_line(done, 4, frames[bad].name, "cannot be written: File too large",
                             "free some space")
        self.assertEqual(self.record()["status"], "failed")
        self.assertEqual(self.record()["frames"], bad)
        self.assert_series_are_whole(bad)

    def test_limits_decide_the_exit_code_of_measure(self):
        self.simulate()
        sinew("measure", self.out, "--fail-on", "volume_error > 0.5", check=0)
        done = sinew("measure", self.out, "--fail-on", "displacement_max > 0.001", check=1)
        self.assertIn("displacement_max", done.stderr)
        checks = json.loads((self.out / "metrics.json").read_text())["checks"]
        self.assertFalse(checks[0]["pass"])
        self.assert_one_line(sinew("measure", self.out, "--fail-on", "volume_eror > 1"), 2,
                             "volume_error")

    def everything(self, folder):
        return {file.relative_to(folder): file.read_bytes() for name in SERIES
                for file in [*(folder / name).iterdir(), folder / f"{name}.pvd", folder / "bones.csv"]}

    def assert_same_as_unbroken(self, *words):
        whole = self.folder / "whole"
        sinew("simulate", self.scene, "-o", whole, *words, check=0)
        self.assertEqual(self.record()["state_hash"], self.record(whole)["state_hash"])
        self.assertEqual(self.everything(self.out), self.everything(whole))

    def test_wall_time_stops_a_run_that_resumes_with_the_same_bits(self):
        words = ["--set", "solver.precision=single", "--set", "solver.duration=2"]
        done = self.simulate(*words, "--set", "solver.wall_time=0.05", check=130)
        self.assertIn("--resume", done.stderr)
        self.assertEqual(self.record()["status"], "stopped")
        self.assert_series_are_whole(self.record()["frames"])
        self.assertIn("going on from step", self.simulate("--resume", "--threads", 1, *words).stderr)
        self.assertEqual((self.record()["status"], self.record()["resumed"]), ("finished", 1))
        self.assert_same_as_unbroken(*words)

    def test_another_scene_or_a_broken_checkpoint_is_not_resumed(self):
        self.simulate("--set", "solver.wall_time=0.01", "--set", "solver.duration=2", check=130)
        done = self.simulate("--resume", "--set", "solver.duration=3", check=2)
        self.assert_one_line(done, 2, "duration: 2", "duration: 3")
        for file in (self.out / "checkpoint").iterdir():
            file.write_bytes(file.read_bytes()[:-1])
        self.assert_one_line(self.simulate("--resume", "--set", "solver.duration=2", check=2), 2, "torn")
        self.simulate("--force", "--set", "solver.duration=0")
        self.assertEqual(list((self.out / "checkpoint").iterdir()), [])

    def test_run_whose_disk_was_full_resumes_when_there_is_space(self):
        words = ["--set", "body.radius=0.012", "--set", "output.checkpoint_interval=0"]
        whole = self.folder / "sizes"
        sinew("simulate", self.scene, "-o", whole, *words, check=0)
        sizes = sorted(file.stat().st_size for file in (whole / "particles").glob("*.vtu"))
        limit = max(sizes[1], (whole / "checkpoint/a.bin").stat().st_size + 1000)
        self.assertLess(limit, sizes[-1])
        limited = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        done = sinew("simulate", self.scene, "-o", self.out, *words, preexec_fn=limited)
        self.assert_one_line(done, 4, "cannot be written")
        self.assertIn("going on from step", self.simulate("--resume", *words).stderr)
        self.assert_same_as_unbroken(*words)

    def test_other_content_of_the_scenes_files_is_not_resumed(self):
        mesh = self.folder / "mine.obj"
        mesh.write_bytes((SOURCE / "data/meshes/box.obj").read_bytes())
        words = ["--set", f"body.mesh={mesh}", "--set", "solver.duration=2"]
        self.simulate(*words, "--set", "solver.wall_time=0.01", check=130)
        mesh.write_text(mesh.read_text() + "# another text, the same mesh\n")
        self.assertIn("going on from", self.simulate(*words, "--set", "solver.wall_time=0.01", "--resume",
                                                     check=130).stderr)
        self.simulate(*words, "--resume")
        lines = mesh.read_text().splitlines()
        vertex = next(i for i, line in enumerate(lines) if line.startswith("v "))
        word = lines[vertex].split()
        lines[vertex] = " ".join([word[0], str(float(word[1]) + 0.001), *word[2:4]])
        self.simulate(*words, "--force", "--set", "solver.wall_time=0.01", check=130)
        mesh.write_text("\n".join(lines) + "\n")
        self.assert_one_line(self.simulate(*words, "--resume", check=2), 2, "body is another")

    def test_lock_names_its_process_and_is_taken_over_when_that_died(self):
        words = ["simulate", self.scene, "-o", self.out, "--set", "solver.duration=1000"]
        with subprocess.Popen([BIN / "sinew", *words], stderr=subprocess.DEVNULL) as child:
            self.wait_for(child, "particles/particles_000002.vtu")
            holder = f"process {child.pid} on {socket.gethostname()}"
            self.assertEqual((self.out / ".lock").read_text(), holder + "\n")
            for word in ["--force", "--resume"]:
                self.assert_one_line(sinew("simulate", self.scene, "-o", self.out, word), 2, holder)
            child.kill()
        said = self.simulate("--force").stderr
        self.assertIn(f"taking over from {holder}", said)
        self.assertEqual((self.out / ".lock").read_text(), "")
        self.assertNotIn("taking over", self.simulate("--force").stderr)

    def test_run_killed_while_it_removes_an_older_one_can_be_replaced(self):
        self.simulate("--set", "output.checkpoint_interval=0")
        (self.out / "run.json").rename(self.out / ".run.json.old")  # the first thing it does
        (self.out / "checkpoint/a.bin").unlink()
        (self.out / "particles.pvd").unlink()
        self.assert_one_line(self.simulate(check=2), 2, "--force")
        self.simulate("--force")
        self.assertFalse((self.out / ".run.json.old").exists())
        self.assert_series_are_whole(self.record()["frames"])

    def test_resume_command_can_be_typed(self):
        odd = self.folder / "it's mine.yaml"
        odd.write_text(self.scene.read_text())
        self.out = self.folder / "a run"
        done = sinew("simulate", odd, "-o", self.out, "--set", "solver.wall_time=0.01", "--set",
                     "solver.gravity=[0, 0, -1]", check=130)
        command = done.stderr.split("go on with: ")[1].splitlines()[0]
        self.assertTrue(command.startswith("sinew simulate "))
        typed = subprocess.run(command.replace("sinew", shlex.quote(str(BIN / "sinew")), 1), shell=True,
                               capture_output=True, text=True, timeout=60)
        self.assertEqual(typed.returncode, 0, typed.stderr)
        self.assertEqual(self.record()["status"], "finished")

    def test_interrupt_finishes_the_frame_and_says_how_to_go_on(self):
        for name in [signal.SIGINT, signal.SIGTERM]:
            self.out = self.folder / name.name
            words = ["simulate", self.scene, "-o", self.out, "--set", "solver.duration=1000"]
            with subprocess.Popen([BIN / "sinew", *words], stderr=subprocess.PIPE, text=True) as child:
                self.wait_for(child, "particles/particles_000002.vtu")
                self.assert_one_line(sinew("simulate", self.scene, "-o", self.out, "--force"), 2,
                                     "another sinew")
                child.send_signal(name)
                said = child.stderr.read()
                self.assertEqual(child.wait(30), 130)
            self.assertIn("--resume", said)
            self.assertEqual(self.record()["status"], "stopped")
            self.assert_series_are_whole(self.record()["frames"])
            sinew("measure", self.out, check=0)

    def test_interrupt_from_a_terminal_stops_a_whole_run(self):
        words = ["sinew", "run", str(self.scene), "-o", str(self.out), "--set", "solver.duration=1000"]
        pid, terminal = pty.fork()
        if pid == 0:
            os.execv(BIN / "sinew", words)
        for _ in range(1000):
            if (self.out / "particles/particles_000002.vtu").exists():
                break
            time.sleep(0.02)
        os.write(terminal, b"\x03")  # Ctrl-C goes to all programs of the terminal
        said = b""
        try:
            while part := os.read(terminal, 4096):
                said += part
        except OSError:
            pass  # the terminal closes with its last program
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]), 130)
        self.assertEqual(self.record()["status"], "stopped")
        self.assertIn(b"sinew run ", said)
        self.assertIn(b"--resume", said)

    def test_files_that_are_no_runs_are_never_touched(self):
        self.out.mkdir()
        (self.out / "pictures").mkdir()
        (self.out / "pictures/holiday.png").write_text("mine")
        (self.out / "surface").mkdir()
        (self.out / "surface/notes").write_text("mine")
        self.simulate("--set", "solver.duration=0")
        self.simulate("--force", "--set", "solver.duration=0")
        self.assertEqual((self.out / "pictures/holiday.png").read_text(), "mine")
        self.assertEqual((self.out / "surface/notes").read_text(), "mine")
        foreign = self.folder / "foreign"
        foreign.mkdir()
        (foreign / "scene.yaml").write_text(self.scene.read_text())
        for words in [[], ["--force"], ["--resume"]]:
            done = sinew("simulate", foreign / "scene.yaml", "-o", foreign, *words)
            self.assert_one_line(done, 2, "scene.yaml")
        self.assertEqual((foreign / "scene.yaml").read_text(), self.scene.read_text())
        (foreign / "scene.yaml").unlink()
        (foreign / "body.vtu").write_text("mine")
        done = sinew("simulate", self.scene, "-o", foreign, "--force")
        self.assert_one_line(done, 2, "body.vtu")
        self.assertEqual((foreign / "body.vtu").read_text(), "mine")

    def test_deeply_nested_files_are_refused(self):
        self.simulate("--set", "solver.duration=0")
        deep = "<a>" * 400000 + "</a>" * 400000
        for name in ["body.vtu", "particles.pvd"]:
            (self.out / name).write_text(f'<?xml version="1.0"?><VTKFile type="Collection">{deep}</VTKFile>')
            self.assert_one_line(sinew("measure", self.out), 2, name)
            self.simulate("--force", "--set", "solver.duration=0")

    def test_run_dies_with_its_parts(self):
        words = [BIN / "sinew", "run", self.scene, "-o", self.out, "--set", "solver.duration=1000"]
        with subprocess.Popen(words, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL) as child:
            self.wait_for(child, "particles/particles_000001.vtu")
            child.kill()
        time.sleep(1)
        words = subprocess.run(["pgrep", "-f", f"sinew-simulate.*{self.out}"], capture_output=True)
        self.assertEqual(words.stdout, b"")

    def test_places_that_cannot_be_written_end_with_4(self):
        self.assert_one_line(sinew("simulate", self.scene, "-o", "/proc/run"), 4, "/proc/run")
        self.assert_one_line(sinew("fill", self.scene, "-o", "/proc/body.vtu"), 4, "/proc/body.vtu")
        with open("/dev/full", "w") as full:
            done = subprocess.run([BIN / "sinew", "info", SOURCE / "data/meshes/box.obj"], stdout=full,
                                  stderr=subprocess.PIPE, text=True)
        self.assert_one_line(done, 4)

    def test_fill_replaces_neither_its_input_nor_a_special_file(self):
        mesh = self.folder / "mine.obj"
        mesh.write_bytes((SOURCE / "data/meshes/box.obj").read_bytes())
        before = mesh.read_bytes()
        words = ["fill", mesh, "--radius", "0.02", "-o"]
        self.assert_one_line(sinew(*words, mesh), 2, "mine.obj")
        self.assertEqual(mesh.read_bytes(), before)
        pipe = self.folder / "pipe.vtu"
        os.mkfifo(pipe)
        self.assert_one_line(sinew(*words, pipe), 4, "pipe")
        self.assertTrue(pipe.is_fifo())

    def test_disk_too_small_for_the_run_is_said_before_it_begins(self):
        done = self.simulate("--set", "solver.duration=3e4", "--set", "body.radius=0.003", check=4)
        self.assert_one_line(done, 4, "needs about")
        self.assertFalse((self.out / "particles.pvd").exists())

    def test_mistakes_reached_through_a_scene_name_its_line(self):
        self.assert_one_line(self.simulate("--set", "body.mesh=none.obj", check=2), 2, "none.obj")
        bad = self.folder / "bad.yaml"
        bad.write_text(self.scene.read_text().replace("box.obj", "nobox.obj"))
        self.assert_one_line(sinew("check", bad), 2, f"{bad}:3:", "nobox.obj")
        bad.write_text(self.scene.read_text().replace("0.025", "1e-9"))
        self.assert_one_line(sinew("fill", bad), 2, f"{bad}:4:")
        bad.write_text(self.scene.read_text().replace("bone: upper", "bone: uper"))
        self.assert_one_line(sinew("simulate", bad, "-o", self.out), 2, f"{bad}:15:", "uper")

    def test_foreign_and_damaged_run_folders_are_refused(self):
        self.assert_one_line(sinew("measure", self.folder), 2, "not the folder of a run")
        self.simulate("--set", "solver.duration=0.1")
        (self.out / "particles/particles_000002.vtu").write_bytes(b"<VTKFile torn")
        self.assert_one_line(sinew("measure", self.out), 2, "particles_000002.vtu")
        self.assert_one_line(sinew("render", self.out), 2, "particles_000002.vtu")

    def test_check_warns_with_number_and_cure(self):
        done = sinew("check", self.scene, "--set", "material.b=2.83", "--json", check=0)
        self.assertEqual(json.loads(done.stdout)["warnings"], 2)
        self.assertIn("times the volume", done.stderr)  # the scene's particles are coarse
        self.assertIn("2.83", done.stderr)
        self.assertIn("material.b", done.stderr)
        text = self.scene.read_text()
        for old, new, word in [("angle: 30", "twist: 30", "cuts the body"),
                               ("axis: [0, 1, 0]\n          angle: 30", "axis: [0, 0, 1]\n          angle: 30",
                                "cuts the body"),
                               ("0.34648]\n    - name: upper\n      parent: lower\n      tail: [0, 0, 0.69296]",
                                "0.05]\n    - name: upper\n      parent: lower\n      tail: [0, 0, 0.1]",
                                "farther from it than"),
                               ("time: 0.2", "time: 0.02", "cannot follow"),
                               ("- time: 0\n", "- time: 0\n          twist: 9\n", "begin at rest"),
                               ("- bone: upper", "- bone: upper\n      interpolation: step", "jumps"),
                               ("skeleton:\n  bones:\n", "skeleton:\n  bones:\n    - name: idle\n"
                                "      head: [9, 9, 9]\n      tail: [9, 9, 10]\n", "no particle follows")]:
            doubtful = self.folder / "doubtful.yaml"
            changed = text.replace(old, new, 1)
            if word == "cuts the body" and "twist" in new:
                changed = changed.replace("axis: [0, 1, 0]\n          twist", "twist", 1)
            self.assertNotEqual(changed, text)
            doubtful.write_text(changed)
            self.assertIn(word, sinew("check", doubtful, check=0).stderr)

    def test_check_tells_how_steps_are_done_and_warns_of_cells(self):
        found = json.loads(sinew("check", self.scene, "--set", "solver.precision=single", "--json",
                                 check=0).stdout)
        self.assertEqual((found["precision"], found["neighbour_search"]), ("single", "lists"))
        for key, value in [("material.damping_form", "symmetric"), ("binding.force", "anchor"),
                           ("binding.twist_form", "open_loop")]:
            done = sinew("check", self.scene, "--set", f"{key}={value}", "--json", check=0)
            self.assertEqual(json.loads(done.stdout)["neighbour_search"], "cells")
            warning = next(line for line in done.stderr.splitlines() if "cells" in line)
            for part in [f"{key} is {value}", "times slower", f"use {key}"]:
                self.assertIn(part, warning)
        asked = sinew("check", self.scene, "--set", "solver.neighbour_search=cells", check=0)
        self.assertNotIn("times slower", asked.stderr)

    def test_explicit_euler_without_damping_has_no_step(self):
        done = sinew("check", self.scene, "--set", "solver.integrator=explicit_euler", "--set",
                     "material.damping=0")
        self.assert_one_line(done, 2, "no stable time step")

    def test_every_command_explains_itself(self):
        for command in ["run", "check", "fill", "simulate", "measure", "render", "view", "info"]:
            help_text = sinew(command, "--help", check=0).stdout
            self.assertIn("Examples:", help_text)
            self.assertIn("--threads", help_text)
            self.assertIn("sinew 0.", sinew(command, "--version", check=0).stdout)


if __name__ == "__main__":
    unittest.main(argv=["run_test", "-v", *sys.argv[3:]])
