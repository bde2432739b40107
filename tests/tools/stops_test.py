#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How runs end before their time, and how they go on.

usage: stops_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import json
import os
import pty
import re
import resource
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import time
import unittest
from pathlib import Path

from small_run import BIN, HAS_GROUPS, SERIES, SOURCE, SmallRun, sinew


class Stops(SmallRun):
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

    def test_a_run_killed_before_it_had_its_record_is_begun_anew(self):
        self.out.mkdir()
        (self.out / ".run.json.tmp").write_text("{")
        self.simulate()
        self.assertFalse((self.out / ".run.json.tmp").exists())

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

    def everything(self, folder):
        return {file.relative_to(folder): file.read_bytes() for name in SERIES
                for file in [*(folder / name).iterdir(), folder / f"{name}.pvd", folder / f"{name}.vtu.series", folder / "bones.csv"]}

    def assert_same_as_unbroken(self, *words):
        whole = self.folder / "whole"
        sinew("simulate", self.scene, "-o", whole, *words, check=0)
        self.assertEqual(self.record()["state_hash"], self.record(whole)["state_hash"])
        self.assertEqual(self.everything(self.out), self.everything(whole))

    def test_frames_end_with_the_duration(self):
        ways = ["solver.integrator=velocity_verlet", "solver.neighbor_search=cells", "solver.precision=single",
                "solver.time_step=1e-3"] + ["hierarchy.enabled=true"] * HAS_GROUPS
        for way in ways:
            words = ["--set", "output.interval=0.15", "--set", way]
            self.simulate("--force", *words)
            for name in SERIES:
                times = re.findall(r'timestep="([^"]*)"', (self.out / f"{name}.pvd").read_text())
                self.assertEqual(times, ["0", "0.15", "0.3", "0.4"], (way, name))
            self.assertEqual(self.record()["frames"], 4)
            checked = json.loads(sinew("check", self.scene, *words, "--json", check=0).stdout)
            self.assertEqual((checked["frames"], checked["steps"]), (4, self.record()["steps"]))
            sinew("measure", self.out, check=0)
            rows = (self.out / "metrics.csv").read_text().splitlines()
            self.assertEqual(rows[-1].split(",")[rows[0].split(",").index("time")], "0.4")

    def test_wall_time_stops_a_run_that_resumes_with_the_same_bits(self):
        words = ["--set", "solver.precision=single", "--set", "solver.duration=2", "--set", "output.interval=0.03"]
        done = self.simulate(*words, "--set", "solver.wall_time=0.05", check=130)
        self.assertIn("--resume", done.stderr)
        self.assertEqual(self.record()["status"], "stopped")
        self.assert_series_are_whole(self.record()["frames"])
        self.assertIn("going on from step", self.simulate("--resume", "--threads", 1, *words).stderr)
        self.assertEqual((self.record()["status"], self.record()["resumed"]), ("finished", 1))
        self.assert_same_as_unbroken(*words)

    def test_damage_before_a_resumption_shows_after_it(self):
        words = ["--set", "solver.duration=2", "--set", "output.checkpoint_interval=0"]
        with subprocess.Popen([BIN / "sinew", "simulate", self.scene, "-o", self.out, *words],
                              stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL) as child:
            self.wait_for(child, "particles/particles_000009.vtu")
            child.kill()
        sinew("info", self.out, "--verify", check=0)
        frame = self.out / "surface/surface_000001.vtu"
        whole = frame.read_bytes()
        frame.write_bytes(whole[:2000] + bytes([whole[2000] ^ 4]) + whole[2001:])
        self.assertIn("going on from step", self.simulate("--resume", *words).stderr)
        done = sinew("info", self.out, "--verify")
        self.assert_one_line(done, 2, "1 of 255 files")
        self.assertIn("damaged: surface/surface_000001.vtu\n", done.stdout)
        frame.write_bytes(whole)
        sinew("info", self.out, "--verify", check=0)

    def test_another_scene_or_a_broken_checkpoint_is_not_resumed(self):
        self.simulate("--set", "solver.wall_time=0.01", "--set", "solver.duration=2", check=130)
        done = self.simulate("--resume", "--set", "solver.duration=3", check=2)
        self.assert_one_line(done, 2, "duration: 2", "duration: 3")
        for file in (self.out / "checkpoint").iterdir():
            file.write_bytes(file.read_bytes()[:-1])
        self.assert_one_line(self.simulate("--resume", "--set", "solver.duration=2", check=2), 2, "truncated")
        self.simulate("--force", "--set", "solver.duration=0")
        self.assertEqual(list((self.out / "checkpoint").iterdir()), [])

    def test_run_whose_disk_was_full_resumes_when_there_is_space(self):
        words = ["--set", "body.radius=0.012", "--set", "output.checkpoint_interval=0", "--set", "output.arrays=F,strain,stress"]
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
        self.assert_one_line(self.simulate(*words, "--resume", check=2), 2, "binds it, has changed", "--force", "with -o")

    def test_a_body_of_another_count_is_not_resumed(self):
        mesh = self.folder / "mine.obj"
        words = ["--set", f"body.mesh={mesh}", "--set", "solver.duration=2"]
        box = (SOURCE / "data/meshes/box.obj").read_text()
        mesh.write_text(box)
        self.simulate(*words, "--set", "solver.wall_time=0.01", check=130)
        for factor in (1.5, 0.5):  # more particles of the same radius, and fewer
            scaled = [" ".join(["v", *(str(factor * float(x)) for x in line.split()[1:4])])
                      if line.startswith("v ") else line for line in box.splitlines()]
            mesh.write_text("\n".join(scaled) + "\n")
            done = self.simulate(*words, "--resume", check=2)
            self.assert_one_line(done, 2, "the run has 237 particles", "--force", "with -o")
            self.assertNotIn("remove the file", done.stderr)
        mesh.write_text(box)
        done = self.simulate(*words, "--resume", "--set", "body.count=500", check=2)
        self.assert_one_line(done, 2, "section body has 'radius: 0.025'", "'radius: auto'", "--force", "with -o")

    def test_a_finished_run_is_of_the_scene_it_was_run_from(self):
        """Else the results of one scene would pass for those of another."""
        mesh, box = self.folder / "mine.obj", (SOURCE / "data/meshes/box.obj").read_text()
        mesh.write_text(box)
        words = ["--set", f"body.mesh={mesh}", "--set", "solver.duration=0.05", "--set", "output.interval=0.05"]
        self.simulate(*words)
        before = (self.out / "run.json").read_bytes()
        self.assertIn("finished already", self.simulate(*words, "--resume", "--set", "solver.wall_time=9").stderr)
        for key, value in {"material.young_modulus": 1e6, "material.model": "bonded", "body.radius": 0.03,
                           "solver.duration": 9, "output.interval": 0.01,
                           "body.mesh": SOURCE / "data/meshes/arm.ply"}.items():
            for command in ("simulate", "run"):
                done = sinew(command, self.scene, "-o", self.out, *words, "--resume", "--set", f"{key}={value}")
                section, name = key.split(".")
                self.assert_one_line(done, 2, f"section {section} has '{name}: ", "--force", "with -o")
        self.scene.write_text(self.scene.read_text().replace("angle: 30", "angle: 31"))
        self.assert_one_line(self.simulate(*words, "--resume", check=2), 2, "section motion", "angle: 31")
        self.scene.write_text(self.scene.read_text().replace("angle: 31", "angle: 30"))
        mesh.write_text(box.replace("v -0.0777", "v -0.0767", 1))
        self.assert_one_line(self.simulate(*words, "--resume", check=2), 2, "the mesh, or what fills", "--force")
        mesh.write_text(box + "# another text, the same mesh\n")
        self.simulate(*words, "--resume")
        self.assertEqual((self.out / "run.json").read_bytes(), before)
        self.assertFalse((self.out / "report.html").exists())

    def test_a_finished_run_is_of_the_clip_it_was_run_with(self):
        clip, bend = self.folder / "clip.bvh", (SOURCE / "data/motions/box_bend.bvh").read_text()
        clip.write_text(bend)
        self.scene.write_text(f"body: {{mesh: {SOURCE / 'data/meshes/box.obj'}, radius: 0.03}}\n"
                              "skeleton: {file: clip.bvh}\nmotion: {file: clip.bvh}\nsolver: {duration: 0.05}\n")
        self.simulate()
        self.assertIn("finished already", self.simulate("--resume").stderr)
        clip.write_text(re.sub("Frame Time:.*", "Frame Time: 0.5", bend))
        self.assert_one_line(self.simulate("--resume", check=2), 2, "the motion of its bones", "--force")

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

    def with_stages(self, command, *words):
        """The command with a simulation that is asked to stop as it ends, and drawing that leaves a file."""
        programs = self.folder / "programs"
        programs.mkdir()
        shutil.copy(BIN / f"sinew-{command}", programs)
        for name, text in {"simulate": "trap '' TERM\nkill -TERM $PPID\nsleep 0.2\necho >> simulated\necho '{}'",
                           "render": "touch drawn", "measure": "touch measured"}.items():
            (programs / f"sinew-{name}").write_text(f"#!/bin/sh\n{text}\n")
            (programs / f"sinew-{name}").chmod(0o755)
        return subprocess.run([programs / f"sinew-{command}", self.scene, "-o", self.out, *words], cwd=self.folder,
                              capture_output=True, text=True, timeout=60)

    def test_a_signal_between_two_stages_ends_a_run(self):
        done = self.with_stages("run")
        self.assertEqual(done.returncode, 130, done.stderr)
        self.assertIn("--resume", done.stderr)
        self.assertFalse((self.folder / "drawn").exists() or (self.folder / "measured").exists())

    def test_a_signal_between_two_runs_ends_a_study(self):
        done = self.with_stages("converge", "--radii", "0.03,0.025", "--threads", "1")
        self.assertEqual(done.returncode, 130, done.stderr)
        self.assertIn("--resume", done.stderr)
        self.assertEqual((self.folder / "simulated").read_text(), "\n")

    def test_a_run_whose_state_of_paraview_cannot_be_made_goes_on(self):
        words = ["simulate", self.scene, "-o", self.out, "--set", "solver.duration=1000"]
        with subprocess.Popen([BIN / "sinew", *words], stderr=subprocess.PIPE, text=True) as child:
            self.wait_for(child, "particles/particles_000002.vtu")
            (self.out / "body.vtu").write_text("no VTU")
            child.send_signal(signal.SIGINT)
            said = child.stderr.read()
            self.assertEqual(child.wait(60), 130, said)
        self.assertIn("warning: view.pvsm is not written: ", said)
        self.assertEqual(self.record()["status"], "stopped")
        self.assert_series_are_whole(self.record()["frames"])

    def test_interrupt_finishes_the_frame_and_says_how_to_go_on(self):
        for name in [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]:
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

    def test_a_signal_while_it_prepares_leaves_nothing(self):
        """A body whose filling takes longer than any of these moments; elsewhere a folder that was there."""
        fine = ["--set", "body.radius=0.0007"]
        there = self.folder / "there"
        there.mkdir()
        for command in (["simulate", self.scene, *fine, "-o", self.folder / "a/b"], ["run", self.scene, *fine, "-o", there],
                        ["converge", self.scene, "--radii", "0.0007,0.0006", "-o", self.folder / "study"],
                        ["check", self.scene, *fine], ["fill", self.scene, *fine, "-o", self.folder / "body.vtu"]):
            for name in (signal.SIGINT, signal.SIGTERM):
                for moment in (0.1, 0.4, 0.9):
                    with subprocess.Popen([BIN / "sinew", *map(str, command)], stderr=subprocess.PIPE, text=True) as child:
                        time.sleep(moment)
                        child.send_signal(name)
                        said = child.stderr.read()
                        self.assertEqual(child.wait(30), 130, (command, name, moment, said))
                    self.assertIn("sinew: stopped; give the same command again\n", said)
                    left = {path.relative_to(self.folder).as_posix() for path in self.folder.rglob("*")}
                    self.assertLessEqual(left, {"small.yaml", "there", "there/.lock"}, (command, name, moment))
                    self.assertEqual((there / ".lock").read_text() if (there / ".lock").exists() else "", "")

    def run_in_a_terminal(self):
        """A whole run that has left some frames, and the terminal it is in."""
        words = ["sinew", "run", str(self.scene), "-o", str(self.out), "--set", "solver.duration=1000"]
        pid, terminal = pty.fork()
        if pid == 0:
            os.execv(BIN / "sinew", words)
        for _ in range(1000):
            if (self.out / "particles/particles_000002.vtu").exists():
                break
            time.sleep(0.02)
        return pid, terminal

    def test_interrupt_from_a_terminal_stops_a_whole_run(self):
        pid, terminal = self.run_in_a_terminal()
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

    def test_an_interrupt_while_it_draws_leaves_nothing_half_done(self):
        words = [BIN / "sinew", "run", self.scene, "-o", self.out, "--set", "solver.duration=1.5"]
        with subprocess.Popen(words, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL) as child:
            self.wait_for(child, "pictures/body_000000.png")
            child.terminate()
            self.assertEqual(child.wait(30), 130)
        self.assertEqual([file.name for file in (self.out / "pictures").glob(".*")], [])
        self.assertEqual(self.record()["status"], "finished")
        for process in Path("/proc").glob("[0-9]*/cmdline"):
            try:
                words = process.read_bytes()
            except OSError:  # it ended just now
                continue
            self.assertFalse(b"sinew-render" in words and bytes(self.out) in words)

    def test_a_terminal_that_is_closed_stops_a_whole_run(self):
        pid, terminal = self.run_in_a_terminal()
        os.close(terminal)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]), 4)  # nor can it tell anyone
        self.assertEqual(self.record()["status"], "stopped")
        self.assert_series_are_whole(self.record()["frames"])

    def test_a_run_under_nohup_outlives_its_terminal(self):
        deaf = lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN)
        words = [BIN / "sinew", "run", self.scene, "-o", self.out, "--set", "solver.duration=1000"]
        with subprocess.Popen(words, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL, preexec_fn=deaf,
                              start_new_session=True) as child:
            self.wait_for(child, "particles/particles_000001.vtu")
            os.killpg(child.pid, signal.SIGHUP)
            frames = len(list((self.out / "particles").iterdir()))
            self.wait_for(child, f"particles/particles_{frames + 2:06}.vtu")
            child.terminate()
            self.assertEqual(child.wait(30), 130)

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

    def test_disk_too_small_for_the_run_is_said_before_it_begins(self):
        done = self.simulate("--set", "solver.duration=3e4", "--set", "body.radius=0.003", check=4)
        self.assert_one_line(done, 4, "needs about")
        self.assertFalse((self.out / "particles.pvd").exists())


if __name__ == "__main__":
    unittest.main(argv=["stops_test", "-v", *sys.argv[3:]])
