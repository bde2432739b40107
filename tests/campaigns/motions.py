#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What becomes of motion files that nobody has edited: new, check, run, and the distance of the body from exact skinning.

usage: motions.py BIN OUT FILE... [--coarser N] [--no-movie] [--set KEY=VALUE ...]     folder of the programs; folder for
           scenes, runs and the table OUT/motions.tsv, to which lines are added; N: radii times so large as sinew new
           chooses

A file is sound where its run ends, a bone turns by a degree, the body moves by 1 % of its size, under 1 % of its
particles are inverted, its volume is within 5 %, and its surface within 3 % of its diagonal of linear-blend skinning
(mean over points and frames). off_file is the same distance from another reader's skinning (exact_skinning.py). Files
whose line is in the table are left out.
"""
import argparse
import csv
import json
import re
import shutil
import subprocess
import sys
import time
import xml.etree.ElementTree as xml
from pathlib import Path

import meshio
import numpy as np

COLUMNS = ["file", "new", "exit", "status", "bones", "clip", "particles", "work", "new_s", "run_s", "frames", "inverted", "volume_error",
           "turned", "moved", "taken_anew", "limited", "off_skinning", "off_file", "meets", "deepest_r", "sound", "said"]
MAX_SECONDS = 1500  # of a run


def parse():
    parser = argparse.ArgumentParser()
    parser.add_argument("bin", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("files", type=Path, nargs="+")
    parser.add_argument("--coarser", type=float, default=1)
    parser.add_argument("--no-movie", action="store_true")
    parser.add_argument("--set", action="append", default=[])
    return parser.parse_args()


def call(words, log, seconds=MAX_SECONDS):
    """Exit code (124 when stopped), standard output, the last lines of standard error, seconds."""
    begun = time.monotonic()
    try:
        done = subprocess.run(words, capture_output=True, text=True, timeout=seconds, errors="replace")
        code, out, err = done.returncode, done.stdout, done.stderr
    except subprocess.TimeoutExpired as late:
        code, out, err = 124, "", (late.stderr or b"").decode(errors="replace")
    with log.open("a") as text:
        text.write("$ " + " ".join(map(str, words)) + "\n" + out + err + f"= {code}\n")
    said = [line for line in err.splitlines() if line.startswith("sinew")]
    return code, out, " | ".join(said[-2:]), time.monotonic() - begun


def series(path):
    return [path.parent / row.get("file") for row in xml.parse(path).iter("DataSet")]


def off_skinning(run):
    """Mean distance of the surface from linear-blend skinning over all frames, in diagonals at rest, and the diagonal."""
    now, exact = (series(run / name) for name in ("surface.pvd", "skin_lbs.pvd"))
    at = range(0, len(now), max(1, len(now) // 60))
    rest = meshio.read(now[0])
    diagonal = np.linalg.norm(np.ptp(rest.points - rest.point_data["displacement"], axis=0))
    return float(np.mean([np.linalg.norm(meshio.read(now[k]).points - meshio.read(exact[k]).points, axis=1).mean()
                          for k in at]) / diagonal), diagonal


def measure(run, row):
    record = json.loads((run / "run.json").read_text())
    row |= {"status": record.get("status"), "particles": record.get("particles"), "frames": record.get("frames"),
            "taken_anew": len(record.get("taken_anew", [])), "limited": record.get("limited", 0)}
    with (run / "metrics.csv").open() as text:
        frames = list(csv.DictReader(text))
    value = lambda frame, name: abs(float(frame[name] or "nan"))  # noqa: E731
    row["inverted"] = max(value(frame, "inverted") for frame in frames) / row["particles"]
    row["volume_error"] = max(value(frame, "volume_error") for frame in frames)
    row["turned"] = max(value(frame, "bone_angle") for frame in frames)
    row["off_skinning"], size = off_skinning(run)
    row["moved"] = max(value(frame, "displacement_max") for frame in frames) / size
    row["sound"] = int(row["exit"] == 0 and row["inverted"] < 0.01 and row["volume_error"] < 0.05
                       and row["turned"] > 1 and row["moved"] > 0.01 and row["off_skinning"] < 0.03)


def off_file(path, run):
    done = subprocess.run([sys.executable, Path(__file__).with_name("exact_skinning.py"), path, run],
                          capture_output=True, text=True)
    found = re.search(r"([\d.]+) from exact skinning", done.stdout)
    return float(found[1]) if found else (done.stderr.strip().splitlines() or ["?"])[-1][-80:]


def try_file(path, options):
    name = path.parent.name + "_" + re.sub(r"\W", "_", path.name)
    folder = options.out / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    log, scene, sinew = folder / "log.txt", folder / (path.stem + ".yaml"), options.bin / "sinew"
    row = {"file": f"{path.parent.name}/{path.name}"}
    row["new"], made, row["said"], row["new_s"] = call([sinew, "new", path, "-o", scene], log)
    if row["new"] != 0:
        return row
    row["bones"] = (re.findall(r"^bones: (\d+)", made, re.M) or [""])[0]
    row["clip"] = (re.findall(r"^  clip: (.*)$", scene.read_text(), re.M) or [""])[0].split("  #")[0]
    words = [word for pair in options.set for word in ("--set", pair)]
    if options.coarser != 1:
        radius = float(re.search(r"^  radius: (\S+)", scene.read_text(), re.M)[1])
        words += ["--set", f"body.radius={radius * options.coarser}"]
    code, out, _, _ = call([sinew, "check", scene, "--json", *words], log)
    if code == 0:
        checked = json.loads(out)
        meets = checked.get("intrusions", [])
        row |= {"work": float(checked.get("steps", 0)) * checked["particles"], "meets": len(meets),
                "deepest_r": max((one["depth"] for one in meets), default=0)}
    run = folder / "run"
    row["exit"], _, row["said"], row["run_s"] = call(
        [sinew, "run", scene, "-o", run, *words, "--set", "output.skin_lbs=true", *["--no-movie"] * options.no_movie], log)
    try:
        measure(run, row)
        row["off_file"] = off_file(path, run)
    except (OSError, KeyError, ValueError) as error:
        row["said"] += f" | {error}"
    return row


def text_of(value):
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def main():
    options = parse()
    options.out.mkdir(parents=True, exist_ok=True)
    table = options.out / "motions.tsv"
    if not table.exists():
        table.write_text("\t".join(COLUMNS) + "\n")
    known = {line.split("\t")[0] for line in table.read_text().splitlines()}
    for path in options.files:
        if f"{path.parent.name}/{path.name}" in known:
            continue
        row = try_file(path.resolve(), options)
        line = "\t".join(text_of(row.get(column, "")).replace("\t", " ") for column in COLUMNS)
        with table.open("a") as text:
            text.write(line + "\n")
        print(line, flush=True)


if __name__ == "__main__":
    main()
