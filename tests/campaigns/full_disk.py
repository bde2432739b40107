#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lets the disk of a small run become full at its n-th request for space, n = 1, 2, ...: the run ends with
4 and one line that names a file of it, what is there is sound, and once there is space it resumes and
leaves the same as a run with space enough.

usage: full_disk.py BIN SOURCE SHIM [--points N] [--seed 1] [--small-disk N]
SHIM: failing_writes.so; --points: only N of the requests, at random; --small-disk: N times on a disk of
32 MB in memory as well, which another program fills up meanwhile (asks for the right to mount)
"""
import argparse
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from runs import Run, assert_series_are_sound


def lines_of(log):
    return len(log.read_text().splitlines())


class Campaign:
    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, folder

    def run(self, name, way):
        return Run(self.arguments.bin, self.arguments.source, self.folder, name, way, duration=0.1,
                   checkpoints=0)  # after each step: not by the clock, so that runs ask alike

    def on_full_disk(self, run, full_at, once=False):
        environment = dict(os.environ, LD_PRELOAD=str(self.arguments.shim), SINEW_DISK=str(run.out),
                           SINEW_FULL_AT=str(full_at), SINEW_REQUESTS=str(self.folder / "requests"))
        if once:
            environment["SINEW_FULL_ONCE"] = "1"
        return subprocess.run(run.command(2), env=environment, capture_output=True, text=True, timeout=100)

    def requests(self, way):
        run = self.run("counted", way)
        done = self.on_full_disk(run, 0)
        assert done.returncode == 0, done.stderr
        shutil.rmtree(run.out)
        return int((self.folder / "requests").read_text())

    def fill_up(self, way, number, once, whole):
        run, where = self.run("full", way), (way, number, "once" if once else "for ever")
        done = self.on_full_disk(run, number, once)
        errors = [line for line in done.stderr.splitlines()
                  if line.startswith("sinew: ") and not line.startswith("sinew: warning: ")]
        if done.returncode == 0:  # never asked so often, or asked again: nothing may lack, of the log neither
            assert lines_of(run.out / "log.txt") == lines_of(whole.out / "log.txt"), where
        else:
            assert done.returncode == 4 and len(errors) == 1, (where, done.returncode, done.stderr)
            assert str(run.out) in errors[0], (where, errors)
            assert_series_are_sound(run.out)
            run.to_end(1, "--resume")
        run.assert_same_as(whole)
        shutil.rmtree(run.out)
        return done.returncode == 4

    def go(self, way):
        whole = self.run("whole", way)
        whole.to_end(2)
        last = self.requests(way)
        numbers = list(range(1, last + 1))
        if self.arguments.points:
            numbers = sorted(random.Random(self.arguments.seed).sample(numbers, self.arguments.points))
        failed = sum(self.fill_up(way, number, number % 2 == 0, whole) for number in numbers)
        print(f"{way}: {last} requests, {len(numbers)} tried, {failed} runs stopped: all resumable", flush=True)
        assert failed > 0.8 * len(numbers)
        shutil.rmtree(whole.out)


class SmallDisk:
    """A disk in memory that can be filled up."""

    def __init__(self, place):
        self.place = place
        place.mkdir()
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=32m", "tmpfs", place], check=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        subprocess.run(["umount", self.place], check=True)

    def fill_up(self, left):
        with (self.place / "ballast").open("wb", buffering=0) as ballast:
            try:
                while True:
                    ballast.write(bytes(1 << 16))
            except OSError:
                ballast.truncate(max(ballast.tell() - left, 0))

    def clear(self):
        (self.place / "ballast").unlink(missing_ok=True)


def on_small_disk(arguments, way, folder, disk, chance):
    whole = Run(arguments.bin, arguments.source, folder, "whole", way, checkpoints=0.05)
    whole.to_end(2)
    stopped = 0
    for _ in range(arguments.small_disk):
        run = Run(arguments.bin, arguments.source, disk.place, "run", way, checkpoints=0.05)
        child = subprocess.Popen(run.command(2), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        time.sleep(chance.uniform(0, 0.6))
        disk.fill_up(chance.randrange(300000))
        _, said = child.communicate(timeout=100)
        assert child.returncode in (0, 4), (way, child.returncode, said)
        stopped += child.returncode == 4
        assert_series_are_sound(run.out)
        disk.clear()
        run.to_end(1, "--resume")
        run.assert_same_as(whole)
        shutil.rmtree(run.out)
    print(f"{way}: {stopped} of {arguments.small_disk} runs met a full disk: all resumable", flush=True)


def main():
    parser = argparse.ArgumentParser()
    for name in ("bin", "source", "shim"):
        parser.add_argument(name, type=lambda text: Path(text).resolve())
    parser.add_argument("--points", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--small-disk", type=int, default=0)
    arguments = parser.parse_args()
    for way in ["lists in double"] if arguments.points else ["lists in double", "world"]:
        with tempfile.TemporaryDirectory() as folder:
            Campaign(arguments, Path(folder).resolve()).go(way)
    if arguments.small_disk:
        with tempfile.TemporaryDirectory() as folder, SmallDisk(Path(folder) / "disk") as disk:
            for way in ("lists in double", "world"):
                on_small_disk(arguments, way, Path(folder), disk, random.Random(arguments.seed))
                shutil.rmtree(Path(folder) / "whole")


if __name__ == "__main__":
    sys.exit(main())
