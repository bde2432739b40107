#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""whole_runs.py BIN [ROUNDS] [--update-readme]: seconds per frame of whole runs, from mesh to pictures, movie and report.

Minima over the rounds; the hash of the last state stands beside them. Some minutes a round.
"""
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
README = Path(__file__).parent / "README.md"
SCENES = [("box_bend", []), ("arm_bend", []),
          ("creature_walk", ["body.count=100000", "material.model=bonded", "output.interval=0.05"]),
          ("box_bend", ["body.count=1000000", "solver.duration=0.1", "output.interval=0.01"])]
STAGES = ("simulation", "pictures", "measuring", "movie")


def run(bin_folder, scene, sets, out):
    words = [word for one in sets for word in ("--set", one)]
    done = subprocess.run([bin_folder / "sinew", "run", SOURCE / f"configs/{scene}.yaml", "-o", out, "--force", "--quiet",
                           "--json", *words], capture_output=True, text=True, check=True)
    told = json.loads(done.stdout)
    time = next(line for line in told["summary"] if line.startswith("time: "))
    stages = {name: float(re.search(rf"{name} ([\d.]+)", time)[1]) for name in STAGES}
    record = json.loads((out / "run.json").read_text(encoding="utf-8"))
    return told["seconds_per_frame"], stages, record


def row(scene, sets, found):
    best, stages, record = min(found, key=lambda one: one[0])
    hashes = {one[2]["state_hash"] for one in found}
    assert len(hashes) == 1, hashes
    name = scene + (", bonded" if any("bonded" in one for one in sets) else "")
    return [name, f"{record['particles']:,}", str(record["frames"]), f"{best:.3g}",
            *(f"{stages[name]:.1f}" for name in STAGES), hashes.pop()[:8]]


def main():
    words = [word for word in sys.argv[1:] if word != "--update-readme"]
    bin_folder, rounds = Path(words[0]).resolve(), int(words[1]) if len(words) > 1 else 3
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for scene, sets in SCENES:
            rows.append(row(scene, sets, [run(bin_folder, scene, sets, Path(folder) / "run") for _ in range(rounds)]))
    head = ["scene", "particles", "frames", "s per frame", *(f"{name}, s" for name in STAGES), "state"]
    lines = [head, ["---"] + ["--:"] * (len(head) - 1), *rows]
    table = "".join("| " + " | ".join(line) + " |\n" for line in lines)
    print(table)
    if "--update-readme" in sys.argv:
        text = README.read_text(encoding="utf-8")
        begin, end = "<!-- whole runs -->\n", "<!-- /whole runs -->"
        README.write_text(text.partition(begin)[0] + begin + table + end + text.partition(end)[2], encoding="utf-8")


if __name__ == "__main__":
    main()
