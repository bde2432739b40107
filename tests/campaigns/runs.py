# SPDX-License-Identifier: GPL-3.0-or-later
"""Small runs for the campaigns: scenes, commands, and whether two runs left the same."""
import json
import re
import subprocess
from pathlib import Path

HEAD = """
body: {{mesh: {source}/data/meshes/box.obj, radius: 0.025}}
skeleton:
  bones:
    - {{name: lower, head: [0, 0, 0], tail: [0, 0, 0.34648]}}
    - {{name: upper, parent: lower, tail: [0, 0, 0.69296]}}
output: {{checkpoint_interval: {checkpoints}}}
"""
BEND = HEAD + """
motion:
  tracks:
    - {{bone: upper, keys: [{{time: 0}}, {{time: 1, axis: [0, 1, 0], angle: 50}}]}}
solver: {{duration: {duration}}}
"""
WORLD = HEAD + """
motion:
  tracks:
    - {{bone: upper, keys: [{{time: 0}}, {{time: 1, axis: [0, 1, 0], angle: 30}}]}}
world:
  drag: 0.5
  obstacles:
    - {{name: floor, shape: plane, friction: 0.5}}
    - {{name: ring, shape: capsule, from: [-0.3, 0, 0.9], to: [0.3, 0, 0.9], radius: 0.02, bone: upper}}
  pins: [{{center: [0, 0, 0.66], radius: 0.06, bone: upper}}]
  fields: [{{name: wind, acceleration: [0, 3, 0], low: [-1, -1, 0.3], high: [1, 1, 1], falloff: 0.05}}]
  muscles:
    - {{name: flexor, bone: upper, strength: 500, keys: [{{time: 0, activation: 0}}, {{time: 0.5, activation: 1}}]}}
solver: {{duration: {duration}}}
"""
EXTRAS = ["--set", "output.skin_lbs=true", "--set", "output.skin_dqs=true", "--set", "output.export=true"]
# A scene, and what is set in it beside.
WAYS = {
    "lists in double": (BEND, EXTRAS),
    "lists in single": (BEND, ["--set", "solver.precision=single"]),
    "world": (WORLD, EXTRAS),
    "velocity Verlet": (BEND, ["--set", "solver.integrator=velocity_verlet"]),
    "cells": (BEND, ["--set", "solver.neighbor_search=cells"]),
    "bonds that creep and break": (BEND, ["--set", "material.model=bonded", "--set", "material.yield_strain=0.01",
                                          "--set", "material.creep_rate=20", "--set", "material.breaking_strain=0.05"])}


class Run:
    """A scene on its way into a folder."""

    def __init__(self, binaries, source, folder, name, way, duration=2, checkpoints=0.02):
        text, self.words = WAYS[way]
        self.binaries, self.way, self.out = binaries, way, folder / name
        self.scene = folder / (way.replace(" ", "_") + ".yaml")
        self.scene.write_text(text.format(source=source, duration=duration, checkpoints=checkpoints))

    def command(self, threads, *more):
        return [self.binaries / "sinew-simulate", self.scene, "-o", self.out, *self.words,
                "--threads", str(threads), *more]

    def begun(self):
        return (self.out / "run.json").exists()

    def to_end(self, threads, *more):
        done = subprocess.run(self.command(threads, *more), capture_output=True, text=True, timeout=600)
        assert done.returncode == 0, (self.way, done.returncode, done.stderr)

    def record(self):
        return json.loads((self.out / "run.json").read_text())

    def assert_same_as(self, whole):
        assert self.record()["state_hash"] == whole.record()["state_hash"], (self.way, "another state")
        mine, its = files_of(self.out), files_of(whole.out)
        assert sorted(mine) == sorted(its), (self.way, sorted(set(mine) ^ set(its)))
        other = [str(name) for name in mine if mine[name] != its[name]]
        assert not other, (self.way, other)
        done = subprocess.run([self.binaries / "sinew-info", self.out, "--verify"], capture_output=True, text=True,
                              timeout=60)
        assert done.returncode == 0, (self.way, done.stdout, done.stderr)


def files_of(out):
    """All that a run tells, but when, where and how it was done (body.vtu: how long filling took)."""
    beside = {"run.json", "log.txt", ".lock", "view.pvsm", "body.vtu", "checkpoint/a.bin",
              "checkpoint/b.bin"}
    files = {str(file.relative_to(out)): file.read_bytes() for file in out.rglob("*") if file.is_file()}
    if sums := files.get("checksums.sfv"):
        files["checksums.sfv"] = b"\n".join(line for line in sums.split(b"\n") if not line.startswith(b"body.vtu "))
    return {name: content for name, content in files.items() if name not in beside}


def assert_series_are_sound(out):
    """At any moment: every row leads to a whole file, and times ascend."""
    for series in out.glob("*.vtu.series"):
        for row in json.loads(series.read_text())["files"]:
            assert (out / row["name"]).exists(), f"{series} names {row['name']}, which is not there"
    for pvd in out.glob("*.pvd"):
        text = pvd.read_text()
        assert text.endswith("</VTKFile>\n"), f"{pvd} is torn"
        times = [float(time) for time in re.findall(r'timestep="([^"]*)"', text)]
        assert times == sorted(set(times)), f"stale or doubled rows in {pvd}"
        for name in re.findall(r'file="([^"]*)"', text):
            with (out / name).open("rb") as frame:
                frame.seek(-11, 2)
                assert frame.read() == b"</VTKFile>\n", f"{name} is torn"
