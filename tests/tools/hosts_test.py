#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs on two hosts, which are network namespaces of this machine with a cable between them: the same
result, and what happens when a host dies or the cable is cut.

usage: hosts_test.py BIN SOURCE [TEST ...]      folder of the programs, folder of the project
"""
import os
import subprocess
import sys
import time
import unittest

from small_run import BIN, SOURCE, SmallRun, sinew

import meshio
import numpy as np

LAUNCHER = """#!/bin/sh
# What mpirun starts instead of ssh: a host's own network, name and processes.
case $1 in 10.77.0.1) host={0} ;; *) host={1} ;; esac
shift
exec ip netns exec $host unshare --uts --pid --fork --kill-child sh -c "hostname $host; $*"
"""


def do(*words):
    subprocess.run(list(map(str, words)), check=True, capture_output=True)


class Hosts:
    def __init__(self, folder):
        self.folder = folder
        self.names = [f"sinew{os.getpid()}{letter}" for letter in "ab"]
        self.cables = [f"sn{os.getpid()}{letter}" for letter in "ab"]

    def begin(self):
        for name in self.names:
            do("ip", "netns", "add", name)
        first, second = zip(self.cables, self.names)
        do("ip", "link", "add", first[0], "netns", first[1], "type", "veth", "peer", "name", second[0], "netns", second[1])
        for number, (cable, name) in enumerate((first, second), 1):
            do("ip", "-n", name, "addr", "add", f"10.77.0.{number}/24", "dev", cable)
            self.connect(number - 1, "up")
            do("ip", "-n", name, "link", "set", "lo", "up")
        launcher = self.folder / "launcher"
        launcher.write_text(LAUNCHER.format(*self.names))
        launcher.chmod(0o755)
        (self.folder / "hosts").write_text("10.77.0.1 slots=1\n10.77.0.2 slots=1\n")
        os.environ["OMPI_MCA_plm_rsh_agent"] = str(launcher)

    def connect(self, number, how):
        do("ip", "-n", self.names[number], "link", "set", self.cables[number], how)

    def processes(self, number):
        return subprocess.run(["ip", "netns", "pids", self.names[number]], capture_output=True, text=True).stdout.split()

    def kill(self, number):
        subprocess.run(["kill", "-KILL", *self.processes(number)], check=False)  # some may have ended meanwhile

    def end(self):
        for name in self.names:
            subprocess.run(["ip", "netns", "del", name], capture_output=True)


class OnTwoHosts(SmallRun):
    def setUp(self):
        super().setUp()
        os.environ["OMPI_MCA_orte_tmpdir_base"] = self.temporary.name
        self.hosts = Hosts(self.folder)
        self.addCleanup(self.hosts.end)
        try:
            self.hosts.begin()
            do("ip", "netns", "exec", self.hosts.names[0], "unshare", "--uts", "--pid", "--fork", "true")
        except (OSError, subprocess.CalledProcessError) as error:
            self.skipTest(f"network namespaces are not allowed here: {error}")

    def on_hosts(self, scene, *words):
        """A run that sinew simulate begins on the first host, with a rank on each."""
        name = self.hosts.names[0]
        command = [BIN / "sinew", "simulate", scene, "-o", self.out, "--engine", "lammps", "--ranks", 2,
                   "--hosts", self.folder / "hosts", *words]
        return subprocess.Popen(["ip", "netns", "exec", name, "unshare", "--uts", "sh", "-c",
                                 f'hostname {name}; exec "$@"', "sh", *map(str, command)],
                                stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)

    def assert_ends_soon(self, break_it):
        words = ["--set", "output.checkpoint_interval=0", "--set", "solver.duration=20"]
        with self.on_hosts(self.scene, *words) as child:
            self.wait_for(child, "checkpoint/b.bin")
            self.assertTrue(self.hosts.processes(1))
            break_it()
            said = child.stderr.read()  # after 10 s of patience on a machine with time to spare
            self.assertEqual(child.wait(120), 2)
        self.assertIn("sinew: LAMMPS ended before the run did: a host, or the network to it, does not answer", said)
        self.assertIn("--resume", said)
        self.assertEqual(self.record()["status"], "failed")
        self.assert_series_are_whole(self.record()["frames"])
        return words

    def assert_goes_on(self, words):
        before = self.record()["steps"]
        with self.on_hosts(self.scene, *words, "--resume", "--set", "solver.wall_time=0.5") as child:
            said = child.stderr.read()
            self.assertEqual(child.wait(120), 130, said)
        self.assertIn("going on from step", said)
        self.assertGreater(self.record()["steps"], before)
        self.assert_series_are_whole(self.record()["frames"])

    def test_box_bend_is_that_of_one_machine(self):
        words = ["--set", "solver.duration=0.5", "--set", "output.double_precision=true"]
        scene, whole = SOURCE / "configs/box_bend.yaml", self.folder / "whole"
        sinew("simulate", scene, "-o", whole, *words, check=0)
        with self.on_hosts(scene, *words) as child:
            said = child.stderr.read()
            self.assertEqual(child.wait(180), 0, said)
        last = f"surface/surface_{self.record()['frames'] - 1:06}.vtu"
        apart = np.abs(meshio.read(self.out / last).points - meshio.read(whole / last).points).max()
        self.assertLess(apart / 0.010, 1e-9)

    def test_a_host_that_dies_ends_the_run_which_goes_on(self):
        self.assert_goes_on(self.assert_ends_soon(lambda: self.hosts.kill(1)))

    def test_a_cut_cable_ends_the_run_on_both_hosts(self):
        words = self.assert_ends_soon(lambda: self.hosts.connect(1, "down"))
        for _ in range(300):
            if not self.hosts.processes(1):
                break
            time.sleep(0.1)
        self.assertEqual(self.hosts.processes(1), [])
        self.hosts.connect(1, "up")
        self.assert_goes_on(words)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
