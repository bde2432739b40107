#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Static scenes by Newton's method, by relaxation, and by what `auto` takes: seconds of each, and iterations.

usage: statics.py BIN [NAME ...]      folder of the programs; scenes whose names contain one of the words
"""
import json
import math
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SPACING = 0.01 * 2**0.5  # of layers along an axis of the packing, radius 0.01 m


def box(layers):
    x, y, z = ((n - 1) / 2 * SPACING + 0.003 for n in layers)
    corners = [(x * (1 if k & 1 else -1), y * (1 if k & 2 else -1), z * (1 if k & 4 else -1)) for k in range(8)]
    faces = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]
    return "".join("v %r %r %r\n" % c for c in corners) + "".join("f %d %d %d %d\n" % f for f in faces)


def moved(*keys):
    """A grip that is so at equal times up to 1 s."""
    timed = [{"time": (n + 1) / len(keys), **key} for n, key in enumerate(keys)]
    return {"supports": [{"name": "grip", "facing": [0, 0, 1], "interpolation": "linear", "keys": [{"time": 0}] + timed}]}


def shifted(*by):
    return moved({"translation": list(by)})


def twisted(angle):
    return moved({"axis": [0, 0, 1], "angle": angle})


def bent(angle, length):
    """Along an arc of constant curvature."""
    keys = []
    for part in range(1, 17):
        now = math.radians(angle) * part / 16
        keys.append({"axis": [0, 1, 0], "angle": math.degrees(now), "translation": [
            length / now * (1 - math.cos(now)), 0, length / now * math.sin(now) - length]})
    return moved(*keys)


def force(*value):
    ramp = [{"time": 0, "factor": 0}, {"time": 1, "factor": 1}]
    return [{"name": "tip", "facing": [0, 0, 1], "force": list(value), "keys": ramp}]


def scenes():
    """Yields name, layers, keys of the scene."""
    for across, along in ((5, 31), (7, 49), (9, 25)):
        size, length = (across, across, along), (along - 1) * SPACING
        name = f"{across}x{across}x{along} "
        yield name + "pulled", size, shifted(0, 0, 0.1 * length)
        yield name + "sheared", size, shifted(0.3 * length, 0, -0.05 * length)
        yield name + "bent by 45", size, bent(45, length)
        yield name + "under a force", size, {"loads": force(0.02 * (across * SPACING)**2 * 1e5 * across / along, 0, 0)}
    volume = {"material": {"model": "bonded_volume", "young_modulus": 1e5, "poisson_ratio": 0.45}}
    yield "5x5x31 bent by 90", (5, 5, 31), bent(90, 30 * SPACING)
    yield "5x5x31 bent by 180", (5, 5, 31), bent(180, 30 * SPACING)
    yield "5x5x31 twisted by 180", (5, 5, 31), twisted(180)
    yield "7x7x31 volume, bent by 90", (7, 7, 31), bent(90, 30 * SPACING) | volume
    yield "7x7x31 volume, pulled", (7, 7, 31), shifted(0, 0, 0.05) | volume
    yield "11x11x11 pressed", (11, 11, 11), shifted(0, 0, -0.02)
    yield "15x15x15 sheared", (15, 15, 15), shifted(0.05, 0, 0)
    yield "9x9x25 under its weight", (9, 9, 25), {"solver": {"gravity": [2, 0, 0]}}


def write(folder, layers, keys):
    (folder / "box.obj").write_text(box(layers))
    scene = {"body": {"mesh": "box.obj", "radius": 0.01}, "material": {"model": "bonded", "young_modulus": 1e5}} | keys
    scene["supports"] = [{"name": "clamp", "facing": [0, 0, -1]}] + keys.get("supports", [])
    scene["solver"] = {"method": "static", "duration": 1} | keys.get("solver", {})
    scene["output"] = {"interval": 0.25}
    path = folder / "scene.yaml"
    path.write_text(json.dumps(scene))
    return path


def run(sinew, scene, solver):
    """Seconds, and the sum of iterations."""
    out = scene.parent / solver
    begun = time.monotonic()
    done = subprocess.run([sinew, "simulate", scene, "-o", out, "--json", "--set", f"solver.static_solver={solver}"],
                          capture_output=True, text=True)
    seconds = time.monotonic() - begun
    if done.returncode:
        return seconds, done.stderr.strip().splitlines()[-1][:160]
    rows = (out / "run.json").read_text()
    return seconds, json.loads(rows)


def main():
    sinew, words = Path(sys.argv[1]) / "sinew", sys.argv[2:]
    print("| scene | auto | newton | relaxation | auto over the faster |\n| --- | --: | --: | --: | --: |")
    for name, layers, keys in scenes():
        if words and not any(word in name for word in words):
            continue
        with tempfile.TemporaryDirectory() as folder:
            scene = write(Path(folder), layers, keys)
            found = {solver: run(sinew, scene, solver) for solver in ("auto", "newton", "relaxation")}
        for solver, (_, told) in found.items():
            if isinstance(told, str):
                print(f"{name}, {solver}: {told}", file=sys.stderr)
        auto, newton, relaxation = (found[solver][0] for solver in ("auto", "newton", "relaxation"))
        print(f"| {name} | {auto:.1f} | {newton:.1f} | {relaxation:.1f} | {auto / min(newton, relaxation):.2f} |", flush=True)


if __name__ == "__main__":
    main()
