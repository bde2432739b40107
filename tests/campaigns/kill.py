#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Kills small runs (SIGKILL) at random moments and resumes them each time on another number of threads:
after each kill every series is sound, and in the end the state, every frame and every row are those of a
run that was never stopped.

usage: kill.py BIN SOURCE [--kills 200] [--seed 1] [--keep FOLDER]
BIN: folder of the programs; SOURCE: of the project; --keep: copies every tenth killed run there, to be
opened with ParaView by open_series.py
"""
import argparse
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from runs import WAYS, Run, assert_series_are_sound

KILLS_PER_RUN = 5


class Campaign:
    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, folder
        self.chance = random.Random(arguments.seed)
        self.kills = 0
        self.whole = {}  # by way: a run that nobody stopped, and its seconds

    def run(self, name, way):
        return Run(self.arguments.bin, self.arguments.source, self.folder, name, way)

    def unbroken(self, way):
        if way not in self.whole:
            run, begun = self.run(f"whole{len(self.whole)}", way), time.monotonic()
            run.to_end(2)
            self.whole[way] = run, time.monotonic() - begun
        return self.whole[way]

    def keep(self, run):
        if self.arguments.keep and self.kills % 10 == 0 and run.begun():
            shutil.copytree(run.out, self.arguments.keep / f"kill{self.kills:03}",
                            ignore=shutil.ignore_patterns("checkpoint"))

    def kill_until_done(self, run, seconds, most):
        """Resumes until the run ends by itself; kills it before, as long as kills are left."""
        done = 0
        while True:
            words = ["--resume"] if run.begun() else []
            child = subprocess.Popen(run.command(self.chance.randint(1, 3), *words),
                                     stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            if done < most:
                time.sleep(self.chance.uniform(0, seconds))
                child.send_signal(signal.SIGKILL)
            _, said = child.communicate(timeout=600)
            if child.returncode == 0:
                return done
            assert child.returncode == -signal.SIGKILL, (run.way, child.returncode, said)
            done += 1
            self.kills += 1
            assert_series_are_sound(run.out)
            self.keep(run)

    def go(self):
        while self.kills < self.arguments.kills:
            way = list(WAYS)[len(self.whole) % len(WAYS) if len(self.whole) < len(WAYS)
                             else self.chance.randrange(len(WAYS))]
            whole, seconds = self.unbroken(way)
            run = self.run("broken", way)
            killed = self.kill_until_done(run, seconds, min(KILLS_PER_RUN, self.arguments.kills - self.kills))
            run.assert_same_as(whole)
            shutil.rmtree(run.out)
            print(f"{self.kills} kills; {way}, killed {killed} times: the same bits", flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("bin", type=lambda text: Path(text).resolve())
    parser.add_argument("source", type=lambda text: Path(text).resolve())
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path)
    with tempfile.TemporaryDirectory() as folder:
        Campaign(parser.parse_args(), Path(folder)).go()


if __name__ == "__main__":
    sys.exit(main())
