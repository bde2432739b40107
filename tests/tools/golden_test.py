#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shipped scenes, coarse and cut short, end in the very state that golden_hashes.json holds, in both
precisions. Scenes with groups of particles are cut short only, since coarse bodies have none.

usage: golden_test.py BIN SOURCE [SCENE ...] [--update]    --update writes the hashes found

A hash stands for every bit of every position and velocity. It does not depend on threads or on the
processor's instructions, as far as the code is sinew's own; it does depend on how the C library rounds
sin, cos, tan and their like. glibc has several versions of these and chooses by processor, so that these
runs ask it for those without fused multiply-adds, which every x86-64 has. Where they still round
differently (another C library or machine type) nothing can be told: leaves with 77, skipped.
"""
import argparse
import hashlib
import json
import math
import os
import re
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

HASHES = Path(__file__).with_name("golden_hashes.json")
WITHOUT_FMA = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2"}
SHORT = ["--set", "solver.duration=0.2", "--set", "output.interval=0.1"]
COARSE = ["--set", "body.count=3000"]
SKIPPED = 77


def rounding_of_libm():
    """A hash of many values of the functions that runs use."""
    values = hashlib.sha256()
    for k in range(20000):
        x = 1e-3 * k + 1e-7 * k * k
        for f in (math.sin, math.cos, math.tan, math.atan, math.exp):
            values.update(struct.pack("d", f(x % 50)))
        for f in (math.acos, math.asin, lambda part: math.atan2(part, x + 0.1), lambda part: math.log(part + 1.5)):
            values.update(struct.pack("d", f(k / 20000)))
    return values.hexdigest()[:16]


def restarted_without_fma():
    """The rounding that the runs below see: the C library chooses when a program starts."""
    done = subprocess.run([sys.executable, __file__, "--rounding"], env={**os.environ, **WITHOUT_FMA},
                          check=True, capture_output=True, text=True)
    return done.stdout.strip()


def says(scene, line):
    return re.search(rf"^ *{line}$", scene.read_text(), re.MULTILINE) is not None


def run(binaries, scene, precision):
    """The record of a short run."""
    grouped = says(scene, "hierarchy:")
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([binaries / "sinew-simulate", "--quiet", "--force", scene, "-o", folder, *SHORT,
                               *([] if grouped else COARSE), "--set", f"solver.precision={precision}"],
                              env={**os.environ, **WITHOUT_FMA}, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        record = json.loads((Path(folder) / "run.json").read_text())
        assert not grouped or record["hierarchy"]["grouped"] > 0, f"{scene} has no groups"
        return record


def hashes_of(binaries, scene):
    """By precision; scenes that go by cells know only one, and so do those whose frames are equilibria: loads this
    small are lost in the rounding of the other."""
    double = run(binaries, scene, "double")
    hashes = {"double": double["state_hash"]}
    if double["neighbor_search"] == "lists" and not says(scene, "method: static"):
        hashes["single"] = run(binaries, scene, "single")["state_hash"]
    return hashes


def shipped(source):
    return [file.stem for file in sorted((source / "configs").glob("*.yaml"))]


def compare(name, found, held):
    """Tells what differs; returns whether nothing does."""
    for precision, state in found.items():
        if held.get(precision) != state:
            print(f"configs/{name}.yaml in {precision} precision ends in state {state}, not {held.get(precision)}.\n"
                  "Something changed what is computed, be it by the last bit: the model, the integrator, the\n"
                  "filling, the binding, the motion, the scene itself or a compiler that rounds differently.\n"
                  "If that was the intention, look at the scene, then take the new states with\n"
                  f"    {sys.argv[0]} {sys.argv[1]} {sys.argv[2]} --update")
    return found == held


def main():
    if sys.argv[1:] == ["--rounding"]:
        print(rounding_of_libm())
        return 0
    parser = argparse.ArgumentParser()
    parser.add_argument("bin", type=Path)
    parser.add_argument("source", type=Path)
    parser.add_argument("scenes", nargs="*")
    parser.add_argument("--update", action="store_true")
    arguments = parser.parse_args()
    known = json.loads(HASHES.read_text()) if HASHES.exists() else {"scenes": {}}
    rounding = restarted_without_fma()
    if not arguments.update and known.get("rounding") != rounding:
        print("the C library's sin, cos and their like round differently from those the hashes were taken with")
        return SKIPPED
    names = arguments.scenes or shipped(arguments.source)
    found = {name: hashes_of(arguments.bin, arguments.source / "configs" / f"{name}.yaml") for name in names}
    if arguments.update:
        kept = known["scenes"] if known.get("rounding") == rounding else {}
        scenes = {name: found.get(name, kept.get(name)) for name in shipped(arguments.source)}
        HASHES.write_text(json.dumps({"rounding": rounding, "scenes": scenes}, indent=1) + "\n")
        return 0
    same = [compare(name, found[name], known["scenes"].get(name, {})) for name in names]
    return 0 if all(same) else 1


if __name__ == "__main__":
    sys.exit(main())
