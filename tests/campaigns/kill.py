#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Kills a small run at random moments and resumes it each time, on another number of threads: the final
state, every frame and every row must be those of a run that was never stopped.

usage: kill.py BIN SOURCE [--kills 200] [--seed 1]      folder of the programs, folder of the project
"""
import argparse
import json
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SERIES = ["particles", "surface", "bones", "frames"]
WAYS = [[], ["--set", "solver.precision=single"],
        ["--set", "solver.integrator=velocity_verlet"],
        ["--set", "solver.neighbour_search=cells"],
        ["--set", "material.model=bonded", "--set", "material.breaking_strain=0.05"]]
SCENE = """
body: {{mesh: {mesh}, radius: 0.025}}
skeleton:
  bones:
    - {{name: lower, head: [0, 0, 0], tail: [0, 0, 0.34648]}}
    - {{name: upper, parent: lower, tail: [0, 0, 0.69296]}}
motion:
  tracks:
    - bone: upper
      keys:
        - {{time: 0}}
        - {{time: 1, axis: [0, 1, 0], angle: 50}}
solver: {{duration: 2}}
output: {{checkpoint_interval: 0.02}}
"""


def command(binaries, scene, out, way, threads, *words):
    return [binaries / "sinew-simulate", scene, "-o", out, *way, "--threads", str(threads), *words]


def files_of(out):
    """Everything the run tells of its frames."""
    told = {file.relative_to(out): file.read_bytes() for name in SERIES
            for file in [*(out / name).iterdir(), out / f"{name}.pvd"]}
    for name in SERIES:
        times = re.findall(r'timestep="([^"]*)"', (out / f"{name}.pvd").read_text())
        assert len(times) == len(set(times)), f"doubled rows in {name}.pvd"
    return told


def record_of(out):
    return json.loads((out / "run.json").read_text())


def kill_until_done(arguments, scene, out, way, kills, seconds, chance):
    """Resumes until the run ends by itself; kills it before, as long as kills are left."""
    done = 0
    while True:
        words = ["--resume"] if (out / "run.json").exists() else []
        child = subprocess.Popen(command(arguments.bin, scene, out, way, chance.randint(1, 3), *words),
                                 stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if done < kills:
            time.sleep(chance.uniform(0, seconds))
            child.send_signal(signal.SIGKILL)
        _, said = child.communicate(timeout=600)
        if child.returncode == 0:
            return done
        assert child.returncode == -signal.SIGKILL, said
        done += 1


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("bin", type=lambda text: Path(text).resolve())
    parser.add_argument("source", type=lambda text: Path(text).resolve())
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    chance = random.Random(arguments.seed)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        scene = folder / "small.yaml"
        scene.write_text(SCENE.format(mesh=arguments.source / "data/meshes/box.obj"))
        left, run = arguments.kills, 0
        while left > 0:
            way = WAYS[run % len(WAYS)]
            whole, out = folder / f"whole{run % len(WAYS)}", folder / f"run{run}"
            begun = time.monotonic()
            if not whole.exists():
                subprocess.run(command(arguments.bin, scene, whole, way, 2), check=True, timeout=600,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                seconds = time.monotonic() - begun
            killed = kill_until_done(arguments, scene, out, way, min(left, 5), max(seconds, 0.2), chance)
            assert record_of(out)["state_hash"] == record_of(whole)["state_hash"], (way, "another state")
            assert files_of(out) == files_of(whole), (way, "other frames")
            left -= max(killed, 1)
            run += 1
            print(f"run {run}: {killed} kills, {' '.join(way) or 'lists in double'}: the same bits", flush=True)
    print(f"{arguments.kills} kills: nothing lost")


if __name__ == "__main__":
    sys.exit(main())
