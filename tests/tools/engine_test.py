#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs that LAMMPS steps under mpirun: the same result on any number of ranks, and every end a run can have.

usage: engine_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

import meshio
import numpy as np

from small_run import BIN, SOURCE, SmallRun, sinew

ON_LAMMPS = ["--engine", "lammps", "--ranks"]
ENDLESS = ["--set", "solver.duration=1000"]
RADIUS = 0.025


SURROUNDINGS = {
    "volume": "material:\n  model: bonded_volume\n",
    "world": """
world:
  drag: 0.5
  obstacles:
    - name: floor
      shape: plane
      point: [0.2, 0, 0]
      normal: [-1, 0, 0]
      friction: 0.5
      friction_keys:
        - time: 0
          factor: 1
        - time: 0.3
          factor: 0.2
    - name: ball
      shape: sphere
      center: [0.25, 0, 0.5]
      radius: 0.1
      keys:
        - time: 0
        - time: 0.4
          translation: [-0.05, 0, 0]
  pins:
    - low: [-1, -1, -1]
      high: [1, 1, 0.05]
  fields:
    - name: wind
      shape: uniform
      acceleration: [0, 2, 0]
""",
    "machine": """
supports:
  - name: grip
    low: [-1, -1, -1]
    high: [1, 1, 0.05]
    keys:
      - time: 0
      - time: 0.4
        translation: [0, 0, -0.01]
loads:
  - name: pull
    force: [0, 1, 0]
    low: [-1, -1, 0.6]
    high: [1, 1, 1]
""",
}


REFUSED = {
    "muscles": "world:\n  muscles:\n    - name: flexor\n      bone: upper\n      strength: 100\n",
    "pressures": "loads:\n  - name: push\n    pressure: 10\n",
    "obstacles of meshes": f"world:\n  obstacles:\n    - name: wall\n      shape: mesh\n      mesh: {SOURCE}/data/meshes/box.obj\n",
}


def ranks_of(folder):
    """The processes of sinew-lammps that work for a run."""
    ranks = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            words = (process / "cmdline").read_bytes().split(b"\0")
        except OSError:  # it ended just now
            continue
        if words[0].endswith(b"/sinew-lammps") and bytes(folder) in b"".join(words):
            ranks.append(int(process.name))
    return ranks


class OnLammps(SmallRun):
    def setUp(self):
        super().setUp()
        self.text = self.scene.read_text()
        # Open MPI removes the folder of its sessions when it ends, also from under another that begins.
        os.environ["OMPI_MCA_orte_tmpdir_base"] = self.temporary.name

    def start(self, *words):
        return subprocess.Popen([BIN / "sinew", "simulate", self.scene, "-o", self.out, *map(str, words)],
                                stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)

    def points(self, folder, frame):
        return meshio.read(folder / f"particles/particles_{frame:06}.vtu").points

    def largest_distance(self, a, b, frame):
        return np.abs(self.points(a, frame) - self.points(b, frame)).max() / RADIUS

    def assert_nothing_left(self):
        for _ in range(100):
            if not ranks_of(self.out):
                break
            time.sleep(0.05)
        self.assertEqual(ranks_of(self.out), [])

    def test_any_number_of_ranks_gives_the_result_of_the_built_in_engine(self):
        words = ["--set", "output.double_precision=true"]
        whole = self.folder / "whole"
        sinew("simulate", self.scene, "-o", whole, *words, check=0)
        last = self.record(whole)["frames"] - 1
        for ranks in (1, 2, 3):
            self.simulate(*ON_LAMMPS, ranks, *words, "--force")
            self.assertEqual((self.record()["status"], self.record()["ranks"]), ("finished", ranks))
            self.assert_series_are_whole(last + 1)
            self.assertLess(self.largest_distance(self.out, whole, last), 1e-9)
            self.assertFalse((self.out / ".engine").exists())
        sinew("measure", self.out, check=0)

    def test_the_papers_box_is_bent_alike_for_a_thousand_steps(self):
        words = [SOURCE / "configs/box_bend.yaml", "--set", "solver.duration=1.8",
                 "--set", "output.double_precision=true"]
        whole = self.folder / "whole"
        sinew("simulate", *words, "-o", whole, check=0)
        last, steps = self.record(whole)["frames"] - 1, self.record(whole)["steps"]
        self.assertGreaterEqual(steps, 1000)
        for ranks in (1, 2, 4):
            sinew("simulate", *words, "-o", self.out, *ON_LAMMPS, ranks, "--force", check=0)
            self.assertEqual(self.record()["steps"], steps)
            self.assertLess(self.largest_distance(self.out, whole, last) * RADIUS / 0.010, 1e-9)
            shares = self.record()["particles_on_ranks"]
            self.assertEqual(len(shares), ranks)
            self.assertLess(max(shares), 1.1 * sum(shares) / ranks)  # a layer is 2 % of the body

    def test_each_rank_writes_its_part_of_a_frame(self):
        words = ["--set", "output.every=2", "--set", "material.model=bonded"]
        self.simulate(*ON_LAMMPS, 3, *words)
        gathered = self.folder / "gathered"
        sinew("simulate", self.scene, "-o", gathered, *ON_LAMMPS, 3, *words, "--gather", check=0)
        frames = len(list((self.out / "particles").iterdir()))
        for folder, pieces in ((self.out, 3), (gathered, 1)):
            text = (folder / f"particles/particles_{frames - 1:06}.vtu").read_bytes()
            self.assertEqual(text.count(b"<Piece "), pieces)
        ids = meshio.read(self.out / f"particles/particles_{frames - 1:06}.vtu").point_data["id"]
        self.assertEqual(ids.tolist(), list(range(len(ids))))
        self.assertLess(self.largest_distance(self.out, gathered, frames - 1), 1e-6)
        for folder in (self.out, gathered):
            sinew("measure", folder, check=0)
        self.assert_same_numbers(*(folder / "metrics.csv" for folder in (self.out, gathered)))
        self.assertNotIn("damaged", sinew("info", self.out, check=0).stdout)
        points = self.folder / "points.xyz"
        sinew("export", self.out, "--to", "xyz", "-o", points, check=0)
        self.assertTrue(points.stat().st_size > 1000)

    def assert_same_numbers(self, a, b):
        rows = [[line.split(",") for line in path.read_text().splitlines()] for path in (a, b)]
        self.assertEqual(rows[0][0], rows[1][0])
        for ours, others in zip(*(row[1:] for row in rows), strict=True):
            for name, x, y in zip(rows[0][0], map(float, ours), map(float, others)):
                self.assertTrue(x == y or x != x and y != y or abs(x - y) <= 1e-3 * max(abs(x), abs(y)) or abs(x - y) < 1e-5, (name, x, y))

    def test_what_surrounds_a_body_acts_as_in_the_built_in_engine(self):
        words = ["--set", "output.double_precision=true", "--set", "solver.duration=0.8"]
        for name, more in SURROUNDINGS.items():
            self.scene.write_text(self.text + more)
            whole, self.out = self.folder / f"{name}_whole", self.folder / name
            sinew("simulate", self.scene, "-o", whole, *words, check=0)
            self.simulate(*ON_LAMMPS, 2, *words)
            last, steps = self.record(whole)["frames"] - 1, self.record(whole)["steps"]
            self.assertEqual((self.record()["steps"], self.record()["status"]), (steps, "finished"), name)
            self.assertGreaterEqual(steps, 200, name)
            self.assertLess(self.largest_distance(self.out, whole, last), 1e-9, name)
            ours, theirs = (meshio.read(run / f"particles/particles_{last:06}.vtu") for run in (self.out, whole))
            for array in set(ours.point_data) & {"force", "force_world"}:
                apart = np.abs(ours.point_data[array] - theirs.point_data[array]).max()
                self.assertLess(apart, 1e-8 * np.abs(theirs.point_data[array]).max(), (name, array))

    def test_frames_are_gathered_where_they_need_the_whole_body(self):
        self.simulate(*ON_LAMMPS, 2, "--set", "output.arrays=J")
        self.assertEqual((self.out / "particles/particles_000002.vtu").read_bytes().count(b"<Piece "), 1)

    def test_shorter_steps_where_bones_are_fast_are_taken_on_both(self):
        fast = self.folder / "fast.yaml"
        fast.write_text(self.scene.read_text().replace("angle: 30", "angle: 30\n          translation: [0.5, 0, 0]"))
        words = ["--set", "output.double_precision=true", "--set", "solver.integrator=velocity_verlet",
                 "--set", "output.interval=0.15"]
        whole = self.folder / "whole"
        sinew("simulate", fast, "-o", whole, *words, check=0)
        sinew("simulate", fast, "-o", self.out, *words, *ON_LAMMPS, 2, check=0)
        self.assertTrue(self.record()["shorter_steps"])
        self.assertLess(self.largest_distance(self.out, whole, self.record()["frames"] - 1), 1e-8)

    def test_what_it_cannot_do_is_refused_by_name_before_the_start(self):
        for setting, name in [("solver.precision=single", "single precision"),
                              ("material.relaxation_shares=[0.5]", "relax"),
                              ("material.yield_strain=0.1", "creep"), ("material.breaking_strain=0.1", "break"),
                              ("solver.neighbor_search=cells", "cells"), ("solver.method=static", "equilibria")]:
            model = "paper" if name in ("single precision", "cells") else "bonded"
            words = ["--set", setting, "--set", f"material.model={model}"]
            if name == "relax":
                words += ["--set", "material.relaxation_times=[1]"]
            done = self.simulate(*ON_LAMMPS, 2, *words, check=2)
            self.assert_one_line(done, 2, name, "and engine lammps exclude each other", "without --engine")
            self.assertFalse(self.out.exists())
        for name, more in REFUSED.items():
            self.scene.write_text(self.text + more)
            done = self.simulate(*ON_LAMMPS, 2, check=2)
            self.assert_one_line(done, 2, "small.yaml:", name + " and engine lammps exclude each other", "without --engine")
        self.scene.write_text(self.text)
        self.assert_one_line(self.simulate("--ranks", 2, check=2), 2, "--engine lammps")
        self.assert_one_line(self.simulate("--engine", "gromacs", check=2), 2, "gromacs", "built-in or lammps")
        self.assert_one_line(self.simulate(*ON_LAMMPS, 2, "--hosts", "none.txt", check=2), 2, "none.txt", "slots=")

    def test_what_is_not_installed_is_named(self):
        words = ["simulate", self.scene, "-o", self.out, *ON_LAMMPS, 2]
        self.assert_one_line(sinew(*words, env={"PATH": "/nowhere"}), 2, "mpirun", "openmpi-bin")
        alone = self.folder / "sinew-simulate"
        shutil.copy(BIN / "sinew-simulate", alone)
        done = subprocess.run([alone, *map(str, words[1:])], capture_output=True, text=True)
        self.assert_one_line(done, 2, "sinew-lammps", "liblammps-dev")

    def test_a_full_disk_ends_the_run_with_4(self):
        limited = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (40_000, 40_000))
        done = sinew("simulate", self.scene, "-o", self.out, *ON_LAMMPS, 1, "--set", "body.radius=0.02",
                     "--set", "output.encoding=zlib", preexec_fn=limited)
        self.assert_one_line(done, 4, "cannot be written: File too large", "free some space")
        self.assert_nothing_left()

    def test_more_ranks_than_fit_into_memory_are_refused(self):
        done = self.simulate(*ON_LAMMPS, 100_000, check=2)
        self.assert_one_line(done, 2, "100000 ranks", "of memory", "--hosts")

    def test_hosts_are_those_of_a_file(self):
        hosts = self.folder / "hosts"
        hosts.write_text("localhost slots=2\n")
        self.simulate(*ON_LAMMPS, 2, "--hosts", hosts, "--set", "solver.duration=0.1")
        self.assertEqual(self.record()["status"], "finished")
        done = self.simulate(*ON_LAMMPS, 3, "--hosts", hosts, "--force", check=2)
        self.assert_one_line(done, 2, "slots", "--resume")

    def test_a_killed_rank_ends_the_run_which_goes_on_with_another_number(self):
        words = ["--set", "output.checkpoint_interval=0", "--set", "solver.duration=2"]
        for rank in (0, 1):
            self.out = self.folder / f"killed{rank}"
            with self.start(*ON_LAMMPS, 2, *words) as child:
                self.wait_for(child, "checkpoint/b.bin")
                os.kill(sorted(ranks_of(self.out))[rank], signal.SIGKILL)
                begun = time.time()
                said = child.stderr.read()
                self.assertEqual(child.wait(30), 2)
            self.assertLess(time.time() - begun, 20)
            self.assertIn("sinew: LAMMPS ended before the run did: process rank", said)
            self.assertIn("signal 9", said)
            self.assertIn("--resume", said)
            self.assertEqual(self.record()["status"], "failed")
            self.assert_nothing_left()
            self.assert_series_are_whole(self.record()["frames"])
        self.assertIn("going on from step", self.simulate(*ON_LAMMPS, 3, *words, "--resume").stderr)
        whole = self.folder / "whole"
        sinew("simulate", self.scene, "-o", whole, *words, check=0)
        last = self.record(whole)["frames"] - 1
        self.assert_series_are_whole(last + 1)
        self.assertLess(self.largest_distance(self.out, whole, last), 1e-6)  # written in single precision

    def test_words_of_mpirun_that_go_over_several_lines_are_one_reason(self):
        """As Open MPI 5 says it; the real mpirun of this system may keep to one line."""
        said = ("-" * 74 + "\nprterun noticed that process rank 1 with PID 9 on node here exited\non signal 9 (Killed).\n"
                + "-" * 74 + "\nmore\n")
        mpirun = self.folder / "bin/mpirun"
        mpirun.parent.mkdir()
        mpirun.write_text(f"#!/bin/sh\ncat >&2 <<'END'\n{said}END\nexit 137\n")
        mpirun.chmod(0o755)
        path = {**os.environ, "PATH": f"{mpirun.parent}:{os.environ['PATH']}"}
        done = sinew("simulate", self.scene, "-o", self.out, *ON_LAMMPS, 2, check=2, env=path)
        self.assertIn("process rank 1 with PID 9 on node here exited on signal 9 (Killed); go on", done.stderr)

    def test_a_stopped_run_says_how_to_go_on_and_may_do_so_without_lammps(self):
        for name in (signal.SIGINT, signal.SIGTERM):
            self.out = self.folder / name.name
            with self.start(*ON_LAMMPS, 2, *ENDLESS) as child:
                self.wait_for(child, "particles/particles_000002.vtu")
                child.send_signal(name)
                begun = time.time()
                said = child.stderr.read()
                self.assertEqual(child.wait(30), 130)
            self.assertLess(time.time() - begun, 20)
            self.assertIn("--engine lammps --ranks 2", said)
            self.assertIn("--resume", said)
            self.assertEqual(self.record()["status"], "stopped")
            self.assert_series_are_whole(self.record()["frames"])
            self.assert_nothing_left()
        done = self.simulate("--resume", *ENDLESS, "--set", "solver.wall_time=0.2", check=130)
        self.assertIn("going on from step", done.stderr)

    def test_wall_time_stops_between_frames(self):
        words = ["--set", "output.interval=500", "--set", "solver.wall_time=1.5"]
        done = self.simulate(*ON_LAMMPS, 1, *ENDLESS, *words, check=130)
        self.assertIn("--resume", done.stderr)
        self.assertEqual(self.record()["frames"], 1)
        self.assertGreater(self.record()["steps"], 0)

    def test_an_unstable_run_ends_with_3_and_names_its_particles(self):
        done = self.simulate(*ON_LAMMPS, 2, "--set", "solver.time_step=0.0166", "--set", "solver.duration=2", check=3)
        self.assert_one_line(done, 3, "particle", "solver.time_step")
        self.assertEqual(self.record()["status"], "unstable")
        self.assertGreater(self.record()["frames"], 0)
        self.assert_series_are_whole(self.record()["frames"])
        self.assertTrue((self.out / "blowup.vtu").exists())

    def test_ranks_end_with_a_run_that_is_killed(self):
        with self.start(*ON_LAMMPS, 2, *ENDLESS) as child:
            self.wait_for(child, "particles/particles_000002.vtu")
            self.assertEqual(len(ranks_of(self.out)), 2)
            child.kill()
        self.assert_nothing_left()
        self.assertEqual(self.simulate(*ON_LAMMPS, 2, "--force").returncode, 0)

    def test_a_whole_run_goes_through(self):
        sinew("run", self.scene, "-o", self.out, "--no-movie", *ON_LAMMPS, 2, check=0)
        self.assertEqual(self.record()["stepper"], "lammps")
        self.assertTrue(self.record()["engine_version"].startswith("LAMMPS "))
        self.assertNotIn("instruction_set", self.record())
        self.assertEqual((self.out / "particles/particles_000002.vtu").read_bytes().count(b"<Piece "), 2)
        self.assertIn("pictures", sinew("render", self.out, "--no-movie", check=0).stdout)
        self.assertTrue((self.out / "report.html").exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
