#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged files of every format that sinew reads, tried through the commands that read them. Each must be
refused with exit code 2 and one line that says what to do, before --seconds of computing and --megabytes of
memory are spent, and nothing may be left beside it. Files with random damage may be sound by chance: they
are refused likewise or taken, and counted apart.

usage: hostile_files.py BIN SOURCE [--every K] [--jobs N] [--mutants N] [--seconds S]
                        [--megabytes M] [FORMAT ...]
"""
import argparse
import collections
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import damaged_meshes
import damaged_rigs
import damaged_runs
import damaged_scenes
from damage import mutants, put

ONE_LINE = re.compile(r"\Asinew: [^\n]*; [^\n]*\n\Z")
LONGEST = 60  # s, until a command counts as hanging

RIGGED = "body: {{mesh: {mesh}, radius: 0.03}}\nskeleton: {rig}\n"
BONES = "{bones: [{name: a, head: [0, 0, 0], tail: [0, 0, 1]}]}"
FEW = """body: {mesh: cube.obj, count: 20}
skeleton: {bones: [{name: a, head: [0.5, 0.5, 0], tail: [0.5, 0.5, 1]}]}
solver: {duration: 0.04}
output: {checkpoint_interval: 0, encoding: none}
"""

End = collections.namedtuple("End", "exit said seconds megabytes")


def ended(words, folder):
    """What became of a command, and what it took."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST))
        resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    with tempfile.TemporaryFile() as told:
        child = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=told, stdin=subprocess.DEVNULL, cwd=folder, preexec_fn=limit)
        watch = threading.Timer(5 * LONGEST, child.kill)
        watch.start()
        _, status, used = os.wait4(child.pid, 0)
        watch.cancel()
        child.returncode = os.waitstatus_to_exitcode(status)
        told.seek(0)
        said = told.read().decode(errors="replace")
    return End(child.returncode, said, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)


class Bench:
    """A folder for each file, with the programs at hand."""

    def __init__(self, programs, source, folder):
        self.sinew, self.source, self.folder = str(programs / "sinew"), source, folder
        (folder / "cube.obj").write_text("".join(f"v {k >> 2} {k >> 1 & 1} {k & 1}\n" for k in range(8)) + "".join(
            "f %d %d %d %d\n" % face for face in [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]))
        (folder / "few.yaml").write_text(FEW)
        self.run = folder / "run"
        subprocess.run([self.sinew, "simulate", folder / "few.yaml", "-o", self.run, "--quiet"], check=True, stdout=subprocess.DEVNULL)

    def new_folder(self):
        return Path(tempfile.mkdtemp(dir=self.folder))

    def lone(self, name, content, scene=None):
        """A file by itself, and the scene that names it."""
        place = self.new_folder()
        put(place / name, content)
        commands = [["info", name, "--quiet"]]
        if scene:
            (place / "scene.yaml").write_text(scene)
            commands.append(["check", "scene.yaml", "--quiet"])
        return place, commands

    def scene(self, content):
        place = self.new_folder()
        put(place / "file.yaml", content)
        shutil.copy(self.source / "data/meshes/box.obj", place / "box.obj")
        return place, [["check", "file.yaml", "--quiet"], ["simulate", "file.yaml", "-o", "out", "--quiet"]]

    def part_of_run(self, part, content, *commands):
        """A run's folder with one file of it damaged."""
        place = self.new_folder()
        shutil.copytree(self.run, place / "run")
        for name in ("few.yaml", "cube.obj"):
            shutil.copy(self.folder / name, place)
        (place / "run" / part).unlink()
        put(place / "run" / part, content)
        return place, [[*command.split(), "--quiet"] for command in commands]

    def stopped_run(self, part, content):
        place, commands = self.part_of_run(part, content, "simulate few.yaml -o run --resume")
        if part == "checkpoint/a.bin":
            (place / "run/checkpoint/b.bin").unlink()
            record = json.loads((place / "run/run.json").read_text())
            (place / "run/run.json").write_text(json.dumps(record | {"status": "stopped"}))
        return place, commands


def meshes(bench, name):
    whole, files = getattr(damaged_meshes, name)()
    scene = RIGGED.format(mesh=f"file.{name}", rig=BONES)
    return whole, files, lambda _, content: bench.lone(f"file.{name}", content, scene)


def bvh(bench):
    whole, files = damaged_rigs.bvh()
    scene = RIGGED.format(mesh=bench.source / "data/meshes/box.obj", rig="{file: file.bvh}")
    return whole, files, lambda _, content: bench.lone("file.bvh", content, scene)


def gltf(bench):
    whole, files = damaged_rigs.gltf()

    def tried(name, content):
        file = "file." + name.split(".")[-1] if "." in name else "file.glb"
        return bench.lone(file, content, RIGGED.format(mesh=file, rig=f"{{file: {file}}}"))
    return whole, files, tried


def scene(bench):
    whole, files = damaged_scenes.scene()
    return whole, files, lambda _, content: bench.scene(content)


def vtu(bench):
    return (bench.run / "particles/particles_000001.vtu").read_bytes(), damaged_runs.vtu(bench.run), lambda name, content: \
        bench.part_of_run(name[0] if isinstance(name, tuple) else "particles/particles_000001.vtu", content, "measure run")


def pvd(bench):
    return (bench.run / "particles.pvd").read_bytes(), damaged_runs.pvd(bench.run), lambda _, content: \
        bench.part_of_run("particles.pvd", content, "measure run")


def checkpoint(bench):
    return (bench.run / "checkpoint/a.bin").read_bytes(), damaged_runs.checkpoint(bench.run), lambda _, content: \
        bench.stopped_run("checkpoint/a.bin", content)


def record(bench):
    return (bench.run / "run.json").read_bytes(), damaged_runs.record(bench.run), lambda _, content: \
        bench.part_of_run("run.json", content, "measure run", "simulate few.yaml -o run --resume")


FORMATS = {name: (lambda bench, name=name: meshes(bench, name)) for name in ("obj", "off", "stl", "ply", "vtk", "vti")}
FORMATS |= {"bvh": bvh, "gltf": gltf, "scene": scene, "vtu": vtu, "pvd": pvd, "checkpoint": checkpoint, "record": record}


def names_below(place):
    return {path.relative_to(place) for path in place.rglob("*")
            if path.relative_to(place).parts[0] not in ("out", "run")}


Trial = collections.namedtuple("Trial", "refused commands slowest largest wrong")


def tried(bench, name, place, commands, arguments, may_be_sound):
    """What the commands made of a file, whose folder goes."""
    before, ends, wrong = names_below(place), {}, []
    for words in commands:
        end = ends[words[0]] = ended([bench.sinew, *words], place)
        taken = may_be_sound and end.exit in (0, 3)
        if not taken and (end.exit != 2 or not ONE_LINE.match(end.said) or "unforeseen" in end.said):
            wrong.append(f"{name}: {' '.join(words)} ended with {end.exit}: {end.said[:300]!r}")
        if end.seconds > arguments.seconds or end.megabytes > arguments.megabytes:
            wrong.append(f"{name}: {' '.join(words)} took {end.seconds:.2f} s and {end.megabytes:.0f} MB")
    if names_below(place) != before:
        wrong.append(f"{name}: left {names_below(place) - before}")
    shutil.rmtree(place)
    return Trial(any(end.exit == 2 for end in ends.values()), len(commands),
                 max((end.seconds, f"{name}: {word}") for word, end in ends.items()),
                 max((end.megabytes, f"{name}: {word}") for word, end in ends.items()), wrong)


def told(trials, kind):
    refused, slowest, largest = sum(t.refused for t in trials), max(t.slowest for t in trials), max(t.largest for t in trials)
    print(f"{kind}: {len(trials)} files, {refused} refused, {sum(t.commands for t in trials)} commands, "
          f"slowest {slowest[0]:.2f} s ({slowest[1]}), largest {largest[0]:.0f} MB ({largest[1]})", flush=True)
    for wrong in [wrong for trial in trials for wrong in trial.wrong]:
        print("WRONG", wrong, flush=True)


def try_format(bench, name, arguments, pool):
    whole, files, place_for = FORMATS[name](bench)

    def damaged(file):
        return tried(bench, f"{name} {file}", *place_for(file, files[file]), arguments, may_be_sound=False)

    def mutated(k_and_content):
        k, content = k_and_content
        return tried(bench, f"{name} mutant {k}", *place_for("mutant", content), arguments, may_be_sound=True)

    trials = list(pool.map(damaged, list(files)[::arguments.every]))
    told(trials, name)
    by_chance = list(pool.map(mutated, enumerate(mutants(whole, arguments.mutants, name))))
    if by_chance:
        told(by_chance, f"{name}, random damage")
    return trials, by_chance


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("bin", type=lambda text: Path(text).resolve())
    parser.add_argument("source", type=lambda text: Path(text).resolve())
    parser.add_argument("formats", nargs="*", default=list(FORMATS))
    parser.add_argument("--every", type=int, default=1, help="try each K-th file only")
    parser.add_argument("--jobs", type=int, default=2, help="commands at a time")
    parser.add_argument("--mutants", type=int, default=0, help="files with random damage, of each format")
    parser.add_argument("--seconds", type=float, default=2, help="of computing, at most")
    parser.add_argument("--megabytes", type=float, default=1000, help="at most")
    arguments = parser.parse_intermixed_args()
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(arguments.jobs) as pool:
        bench = Bench(arguments.bin, arguments.source, Path(folder))
        tallies = [try_format(bench, name, arguments, pool) for name in arguments.formats]
    wrong = sum(len(trial.wrong) for pair in tallies for trials in pair for trial in trials)
    print(f"{sum(len(trials) for trials, _ in tallies)} damaged files, {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
