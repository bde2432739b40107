#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What `sinew check` says of a body at rest, against runs: random lambda, a and b of the paper's law. The box of 2,965
particles turns its upper bone by 3 degrees and back within 0.6 s, and rests until 10 s.

usage: rest.py BIN SOURCE [COUNT [SEED]]     folder of the programs, folder of the project; 50 trials, seed 1

Creeps: over 0.01 radii from the start at the end, root mean square; unstable: over 0.5, or exit code 3. Runs that end
between 0.005 and 0.02, or between 0.4 and 0.6, count either way. Exits with 1 where check is wrong.
"""
import json
import math
import random
import subprocess
import sys
import tempfile
from pathlib import Path

SCENE = """
body: {{mesh: {source}/data/meshes/box.obj, radius: 0.010}}
material: {{density: 1000, young_modulus: 10000, lambda: {lam}, a: {a}, b: {b}}}
skeleton:
  bones:
    - {{name: lower, head: [0, 0, 0], tail: [0, 0, 0.34648232]}}
    - {{name: upper, parent: lower, tail: [0, 0, 0.69296465]}}
motion:
  tracks:
    - {{bone: upper, keys: [{{time: 0}}, {{time: 0.3, euler: [0, 3, 0]}}, {{time: 0.6, euler: [0, 0, 0]}}]}}
solver: {{duration: 10}}
output: {{interval: 1, only: displacement}}
"""
RADIUS = 0.010


def said_by_check(sinew, scene):
    done = subprocess.run([sinew, "check", scene, "--json"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["rest"]


def shift_of_run(sinew, scene, folder):
    """Root mean square at the end, in radii; infinite for a run that became unstable. A body that has collapsed after
    2 s is not followed: its particles have hundreds of neighbors, which takes minutes."""
    early = shift_at(sinew, scene, folder.with_suffix(".early"), 2)
    return early if early > 0.6 else shift_at(sinew, scene, folder, 10)


def shift_at(sinew, scene, folder, end):
    done = subprocess.run([sinew, "simulate", scene, "-o", folder, "--quiet", "--set", f"solver.duration={end}"],
                          capture_output=True, text=True)
    if done.returncode == 3:
        return math.inf
    if done.returncode != 0:
        sys.exit(done.stderr)
    subprocess.run([sinew, "measure", folder, "--quiet"], capture_output=True, check=True)
    names, *rows = (folder / "metrics.csv").read_text().splitlines()
    return float(rows[-1].split(",")[names.split(",").index("displacement_rms")]) / RADIUS


def states_of(shift):
    """The states that a run may be said to have."""
    states = set()
    if shift <= 0.02:
        states.add("stable")
    if 0.005 <= shift <= 0.6:
        states.add("creeps")
    if shift >= 0.4:
        states.add("unstable")
    return states


def triples(count, seed):
    numbers = random.Random(seed)
    for _ in range(count):
        lam = math.exp(numbers.uniform(math.log(0.01), math.log(2)))
        a = 2 if numbers.random() < 0.5 else numbers.uniform(2, 2.3)
        yield lam, a, numbers.uniform(max(a + 0.1, 2.3), 3)


def main():
    sinew, source = (Path(word).resolve() for word in sys.argv[1:3])
    sinew /= "sinew"
    count, seed = (int(word) for word in [*sys.argv[3:], *"50 1".split()[len(sys.argv) - 3:]])
    wrong = 0
    print("| lambda | a | b | check | run, radii | |\n|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for k, (lam, a, b) in enumerate(triples(count, seed)):
            scene = Path(folder) / f"{k}.yaml"
            scene.write_text(SCENE.format(source=source, lam=lam, a=a, b=b))
            said, shift = said_by_check(sinew, scene), shift_of_run(sinew, scene, Path(folder) / str(k))
            right = said in states_of(shift)
            wrong += not right
            print(f"| {lam:.3f} | {a:.3f} | {b:.3f} | {said} | {shift:.2g} | {'' if right else 'WRONG'} |", flush=True)
    print(f"\n{count - wrong} of {count} agree")
    sys.exit(wrong > 0)


if __name__ == "__main__":
    main()
