#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the README's pictures of runs, in pictures/, from the scenes in configs.

usage: make_gallery.py SINEW RUNS [NAME ...]     SINEW: the program build/bin/sinew; RUNS: a folder that keeps
                                                 the runs, so that a second call only draws; NAME: only these
                                                 pictures. Needs Debian's python3-pil
"""
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

DATA = Path(__file__).resolve().parent
CONFIGS = DATA.parent / "configs"
LARGE = 250_000  # bytes, beyond which a picture is made smaller
# run: scene, and what of it is set otherwise
RUNS = {
    "box": ("box_bend", []),
    "twist": ("box_twist", []),
    "arm": ("arm_bend", []),
    "fox": ("creature_walk", []),
    "paper": ("box_bend", []),
    "bonded": ("box_bend", ["--set", "material.model=bonded"]),
    "groups": ("box_bend", ["--set", "material.model=bonded", "--set", "body.radius=none", "--set",
                            "body.count=200000", "--set", "hierarchy.enabled=true", "--set",
                            "solver.duration=1.2", "--set", "output.interval=0.1"]),
}
# picture: run, what `sinew render` is told, and which of its pictures is taken
PICTURES = {
    "box_bend": ("box", [], "contact_sheet"),
    "box_twist": ("twist", ["--times", "0,0.5,1"], "contact_sheet"),
    "arm": ("arm", ["--view", "surface", "--times", "0,0.6,1.5"], "surface_sheet"),
    "fox": ("fox", ["--view", "surface", "--times", "0.25,0.5,0.75"], "surface_sheet"),
    "strain": ("box", ["--view", "strain", "--times", "0.5,1,1.4"], "strain_sheet"),
    "forces": ("box", ["--view", "forces", "--times", "0.5,1,1.4"], "forces_sheet"),
    "compare": ("paper", ["--compare", "bonded", "--view", "strain", "--times", "0,1.4,3"],
                "compare_strain_sheet"),
    "groups": ("groups", ["--view", "section", "--array", "level", "--times", "0,0.6,1.2"], "section_sheet"),
}


def simulated(sinew, runs, name):
    scene, settings = RUNS[name]
    folder = runs / name
    if not (folder / "run.json").exists():
        subprocess.run([sinew, "simulate", "--quiet", CONFIGS / f"{scene}.yaml", "-o", folder,
                        *settings], check=True, stdout=subprocess.DEVNULL)
    return folder


def draw(sinew, runs, name):
    run, options, taken = PICTURES[name]
    options = [simulated(sinew, runs, word) if word in RUNS else word for word in options]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sinew, "render", "--no-movie", "--width", "960", "--height", "540", "-o", folder,
                        *options, simulated(sinew, runs, run)],
                       check=True, stdout=subprocess.DEVNULL)
        target = DATA / f"pictures/{name}.png"
        shutil.copy(Path(folder) / f"{taken}.png", target)
    if target.stat().st_size > LARGE:
        # without dither spheres in 256 colors look the same, at a third of the size
        few = Image.open(target).quantize(256, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
        few.save(target, optimize=True)


def main():
    sinew, runs = (Path(place).resolve() for place in sys.argv[1:3])
    for name in sys.argv[3:] or PICTURES:
        draw(sinew, runs, name)


if __name__ == "__main__":
    main()
