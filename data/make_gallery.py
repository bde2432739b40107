#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the pictures of runs for README files and the figures of the paper, in pictures/, from the scenes in configs.

usage: make_gallery.py SINEW RUNS [NAME ...]     SINEW: the program build/bin/sinew; RUNS: a folder that keeps
                                                 the runs, so that a second call only draws; NAME: only these
                                                 pictures. Needs Debian's ffmpeg, python3-pil, python3-matplotlib,
                                                 paraview, libqt5svg5 and chromium-driver
"""
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from PIL import Image

import paper_figures

DATA = Path(__file__).resolve().parent
sys.path.append(str(DATA.parent / "tests/tools"))
from page_driver import Browser  # noqa: E402

CONFIGS = DATA.parent / "configs"
SCREENSHOT = DATA.parent / "tests/campaigns/screenshot.sh"
# run: scene, and what of it is set otherwise
RUNS = {
    "box_bend": ("box_bend", []),
    "fox": ("creature_walk", []),
    "elastic_arm": ("arm_bend", ["--set", "material.model=bonded"]),
    "cells": ("box_bend", ["--set", "material.model=bonded", "--set", "output.volume=true", "--set",
                           "solver.duration=1.2", "--set", "output.interval=0.1"]),
    "paper": ("box_bend", []),
    "literal": ("paper_literal", []),
    "bend_and_twist": ("box_bend", ["--set", "motion.tracks=[{bone: upper, keys: [{time: 0}, {time: 0.4, euler: "
                                    "[0, 60, 0], twist: 60}]}]", "solver.duration=0.4"]),
    "bonded": ("box_bend", ["--set", "material.model=bonded"]),
    "groups": ("box_bend", ["--set", "material.model=bonded", "--set", "body.radius=none", "--set",
                            "body.count=200000", "--set", "hierarchy.enabled=true", "--set",
                            "solver.duration=1.2", "--set", "output.interval=0.1"]),
}
# picture: run, what `sinew render` is told, and which of its pictures is taken
PICTURES = {
    "box_bend": ("box_bend", [], "contact_sheet"),
    "fox": ("fox", ["--view", "surface", "--times", "0.25,0.5,0.75"], "surface_sheet"),
    "strain": ("box_bend", ["--view", "strain", "--times", "0.5,1,1.4"], "strain_sheet"),
    "forces": ("box_bend", ["--view", "forces", "--times", "0.5,1,1.4"], "forces_sheet"),
    "skin": ("elastic_arm", ["--view", "surface", "--array", "von_mises", "--times", "0.7,1.5"], "surface_sheet"),
    "halves": ("elastic_arm", ["--view", "halves", "--array", "von_mises", "--times", "0.7,1.5"], "halves_sheet"),
    "cut": ("elastic_arm", ["--view", "cut", "--array", "von_mises", "--times", "0.7,1.5"], "cut_sheet"),
    "lines": ("bonded", ["--view", "lines", "--times", "0.5,1.4"], "lines_sheet"),
    "compare": ("paper", ["--compare", "bonded", "--view", "strain", "--times", "0,1.4,3"],
                "compare_strain_sheet"),
    "paper_figure_3": ("bend_and_twist", ["--view", "binding", "--times", "0.2,0.4"], "binding_sheet"),
    "paper_figure_4": ("literal", ["--times", "0,0.5,1.5,3.5"], "contact_sheet"),
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
        keep(Path(folder) / f"{taken}.png", name)


def keep(picture, name):
    """All colors, in the smallest file, without a black border."""
    image = Image.open(picture).convert("RGB")
    image.crop(image.getbbox()).save(DATA / f"pictures/{name}.png", optimize=True)


def draw_movie(sinew, runs):
    """A moving picture for the front page, in all colors."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sinew, "render", "--no-pictures", "--view", "halves", "--array", "von_mises", "--width", "720",
                        "--height", "480", "-o", folder, simulated(sinew, runs, "elastic_arm")], check=True,
                       stdout=subprocess.DEVNULL)
        subprocess.run(["ffmpeg", "-y", "-loglevel", "error", "-i", Path(folder) / "halves.mp4", "-vf", "fps=15",
                        "-c:v", "libwebp_anim", "-loop", "0", "-quality", "70", DATA / "pictures/arm.webp"], check=True)


def draw_window(sinew, runs):
    """ParaView's window on the state that a run with cells leaves."""
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "window.png"
        subprocess.run([SCREENSHOT, picture, sinew, "view", simulated(sinew, runs, "cells")], check=True,
                       env={**os.environ, "HOME": folder})
        keep(picture, "paraview")


def draw_report(sinew, runs):
    """The first screen of the report."""
    run = simulated(sinew, runs, "box_bend")
    subprocess.run([sinew, "measure", "--quiet", run], check=True, stdout=subprocess.DEVNULL)
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "page.png"
        options = ["--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                   "--disable-background-networking", "--no-first-run", f"--user-data-dir={folder}/profile",
                   "--window-size=1280,1000", "--hide-scrollbars", "--virtual-time-budget=8000"]
        subprocess.run(["chromium", *options, f"--screenshot={picture}", (run / "report.html").as_uri()], check=True,
                       stderr=subprocess.DEVNULL)
        keep(picture, "report")


def draw_play(sinew, _):
    """The page of a session, wide and narrow, while the skin of a forearm is pulled at."""
    middle = """(() => { const ends = live.view.playback.bones, end = (k) => new THREE.Vector3().fromArray(ends, 12 + k);
        const [x, y] = pixelsOf(live.view, end(0).add(end(3)).multiplyScalar(0.5));
        const box = byId("stage").getBoundingClientRect(); return [x + box.left, y + box.top]; })()"""
    with tempfile.TemporaryDirectory() as folder:
        words = ["play", CONFIGS / "arm_bend.yaml", "--set", "material.model=bonded", "-o", folder, "--no-browser"]
        session = subprocess.Popen([sinew, *words], stdout=subprocess.PIPE, text=True)
        address = session.stdout.readline().split()[1]
        with Browser(1400, 860) as page:
            page.open(address)
            page.run("sinew.ready")
            while page.run("sinew.state().time") < 0.7:
                time.sleep(0.1)
            page.run("tell({ do: 'pause' })")
            time.sleep(1)
            page.run("wholeView(live.view)")
            x, y = page.run(middle)
            page.run("tell({ do: 'play' })")
            page.drag([(x, y), (x + 90, y + 40)], seconds=1, release=False)
            start = page.run("sinew.state().time")
            while page.run("sinew.state().time") < start + 0.5:
                time.sleep(0.1)
            page.run("tell({ do: 'pause' })")
            for width, height, name in ((1400, 860, "play"), (420, 900, "play_narrow")):
                page.resize(width, height)
                time.sleep(1)
                if width < 600:
                    page.run("wholeView(live.view)")
                    time.sleep(1)
                page.picture(Path(folder) / "page.png")
                keep(Path(folder) / "page.png", name)
        session.terminate()
        session.wait()


def draw_range(sinew, _):
    """Figure 1 of the paper."""
    paper_figures.interaction_range(sinew, CONFIGS / "paper_gap.yaml", 2.1, 2.6, DATA / "pictures/paper_figure_1.png")


def draw_force(sinew, _):
    """Figure 2 of the paper."""
    scenes = (CONFIGS / f"{name}.yaml" for name in ("paper_gap", "box_bend", "paper_literal"))
    paper_figures.force_curve(sinew, *scenes, DATA / "pictures/paper_figure_2.png")


def main():
    sinew, runs = (Path(place).resolve() for place in sys.argv[1:3])
    others = {"arm_moving": draw_movie, "paraview": draw_window, "report": draw_report, "play": draw_play, "paper_figure_1": draw_range,
              "paper_figure_2": draw_force}
    for name in sys.argv[3:] or [*PICTURES, *others]:
        if name in others:
            others[name](sinew, runs)
        else:
            draw(sinew, runs, name)


if __name__ == "__main__":
    main()
