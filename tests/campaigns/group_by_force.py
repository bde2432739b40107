#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How much of a body the paper's criterion would group, sets of particles whose mutual force is small, beside the
groups that sinew makes of what moves as one; and what a common motion of each set would lose.

usage: group_by_force.py BIN SOURCE OUT SCENE MODEL COUNT TIME...      needs NumPy, SciPy and VTK's Python

SCENE is a name in configs, MODEL paper or bonded, COUNT the number of particles. Runs the scene on one thread without
groups, with groups that stay and with groups that change, unless OUT has these runs; and takes the groups that begin
at other distances from joints. All sets are judged by the run without groups, as far as it came.

The run is cut into windows of 512 steps, the interval at which free particles may join sinew's groups. A particle is
quiet where the forces of all its pairs stay below a threshold throughout a window; `now`: as it begins, as far as a
rule can know. Sets are quiet particles that hang together (`by bones`: and follow one bone), of 4,096 or more.
`within`: particles whose pairs are all of one set, so that their forces need no computing. What the best motion of each
set, from its places as a window begins, leaves as it ends is the least that groups lose; root mean square over the
particles of all sets and windows, in radii. At the given times (s) and in the mean of all frames: shares alone.

Forces are in units of k r, with the stiffness k of a contact: 0.01 is a strain of 0.005. Those of bonds are of nearest
neighbors, with k for all of them, which is what bonds within the body have.
"""
import itertools
import json
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

THRESHOLDS = [1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 2e-2, 3e-2, 5e-2, 1e-1, 2e-1]
DISTANCES = [1.5, 1, 0.75, 0.6, 0.52, 0.35]  # of groups from moving joints, in widths
WINDOW_STEPS, MIN_PARTICLES = 512, 4096
GROUPS = ["hierarchy.enabled=true", "output.only=id, bone, group, level"]
WAYS = {"no groups": ["output.only=id, bone"], "groups that stay": GROUPS,
        "groups that change": [*GROUPS, "hierarchy.dynamic=true"]}


class Series:
    """A run: made where it is missing, read frame by frame."""

    def __init__(self, folder, command, words, whole=True):
        self.folder = folder
        if not self.path(0).exists():
            words = [*command, "-o", folder, "--threads=1", "--quiet", *(f"--set={word}" for word in words)]
            run = subprocess.Popen(words, stdout=subprocess.DEVNULL)
            while run.poll() is None:
                time.sleep(0.05)
                if not whole and self.path(0).exists():
                    run.terminate()
        self.record = json.loads((folder / "run.json").read_text())

    def path(self, number):
        return self.folder / "particles" / f"particles_{number:06d}.vtu"

    def frame(self, number):
        """Places, and groups and levels where there are any, by particle id."""
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.path(number)))
        reader.Update()
        points = reader.GetOutput().GetPointData()
        order = np.argsort(vtk_to_numpy(points.GetArray("id")))
        data = {name: vtk_to_numpy(points.GetArray(name)) for name in ("bone", "group", "level")
                if points.HasArray(name)}
        data["x"] = vtk_to_numpy(reader.GetOutput().GetPoints().GetData()).astype(float)
        return {name: values[order] for name, values in data.items()}


def lengths(x, pairs):
    return np.linalg.norm(x[pairs[:, 0]] - x[pairs[:, 1]], axis=1)


class Law:
    """Pairs that may act on each other, and their forces in k r."""

    def __init__(self, record, rest, model):
        self.k1, self.k2, self.a, self.b, self.k = (
            record["material"][name] for name in ("k1", "k2", "a", "b", "contact_stiffness"))
        self.r, self.bonded = record["radius"], model == "bonded"
        self.near = cKDTree(rest["x"]).query_pairs(2.1 * self.r, output_type="ndarray")
        self.rest_length = lengths(rest["x"], self.near)
        self.same_bone = self.near[rest["bone"][self.near[:, 0]] == rest["bone"][self.near[:, 1]]]

    def largest_force(self, x):
        """Of the pairs of each particle."""
        pairs = self.near if self.bonded else cKDTree(x).query_pairs(self.b, output_type="ndarray")
        d = lengths(x, pairs)
        force = (self.rest_length - d) / self.r if self.bonded else np.where(
            d < 2 * self.r, self.k1 * (4 * self.r**2 - d**2),
            np.where(d < self.a, 0, -self.k2 * (d - self.a) * (self.b - d))) / (self.k * self.r)
        largest = np.zeros(len(x))
        np.maximum.at(largest, pairs.ravel(), np.repeat(np.abs(force), 2))
        return largest


def sets_of(chosen, near):
    """Numbers of the sets that hang together, -1 for what is in none."""
    both = near[chosen[near[:, 0]] & chosen[near[:, 1]]]
    number = connected_components(coo_matrix((np.ones(len(both)), both.T), shape=(len(chosen),) * 2), False)[1]
    number[~chosen | (np.bincount(number)[number] < MIN_PARTICLES)] = -1
    return number


def within(number, near):
    """The share of particles whose pairs are all of one set."""
    inside = number >= 0
    inside[near[number[near[:, 0]] != number[near[:, 1]]].ravel()] = False
    return inside.mean()


def left_by(degree, before, after):
    """Squares of the distances that the best motion of a set leaves: a polynomial; 0: a rigid one."""
    X, x = before - before.mean(axis=0), after - after.mean(axis=0)
    if degree == 0:
        u, _, v = np.linalg.svd(X.T @ x)
        return np.sum((X @ u @ np.diag([1, 1, np.linalg.det(u @ v)]) @ v - x)**2, axis=1)
    X /= np.abs(X).max()
    terms = np.stack([np.prod(X**powers, axis=1) for powers in itertools.product(range(degree + 1), repeat=3)
                      if sum(powers) <= degree], axis=1)
    return np.sum((terms @ np.linalg.solve(terms.T @ terms, terms.T @ x) - x)**2, axis=1)


def row_of(name, windows, near, r):
    """`windows`: of each, the numbers of sets, and places before and after."""
    columns = [name, f"{100 * np.mean([within(number, near) for number, _, _ in windows]):.1f}"]
    for degree in (0, 1, 3):
        squares = [left_by(degree, x[number == one], y[number == one]) for number, x, y in windows
                   for one in np.unique(number[number >= 0])]
        columns.append(f"{np.sqrt(np.concatenate(squares).mean()) / r:.3f}" if squares else "")
    return f"| {' | '.join(columns)} |"


class Scene:
    """The runs of a scene, and the largest force of the pairs of each particle, frame by frame."""

    def __init__(self, binaries, scene, out, model, count):
        command = [binaries / "sinew-simulate", scene]
        words = [f"body.count={count}", "body.radius=auto", f"material.model={model}",
                 "output.double_precision=true", "output.encoding=none"]
        out /= f"{scene.stem}_{model}_{count}"
        self.runs = {way: Series(out / way.replace(" ", "_"), command, words + more) for way, more in WAYS.items()}
        self.from_distance = {f"groups that stay, from {distance} widths": Series(
            out / f"from_{distance}", command, [*words, *GROUPS, f"hierarchy.joint_distance={distance}"], whole=False
        ).frame(0)["group"] for distance in DISTANCES}
        full, frames = self.runs["no groups"], min(run.record["frames"] for run in self.runs.values())
        self.record, self.law = full.record, Law(full.record, full.frame(0), model)
        self.places = [full.frame(number)["x"] for number in range(frames)]
        self.largest = [self.law.largest_force(x) for x in self.places]

    def sets_at(self, first, last):
        """All ways to group a window, by name."""
        sets = {way: self.runs[way].frame(first)["group"] for way in list(WAYS)[1:]} | self.from_distance
        throughout, law = np.max(self.largest[first:last + 1], axis=0), self.law
        for threshold in THRESHOLDS:
            name = f"force below {threshold:.4f}"
            sets[name] = sets_of(throughout < threshold, law.near)
            sets[f"{name}, by bones"] = sets_of(throughout < threshold, law.same_bone)
            if first > 0:  # no force tells anything before the body moves
                sets[f"{name}, by bones, now"] = sets_of(self.largest[first] < threshold, law.same_bone)
        return sets

    def print_windows(self):
        length, windows = max(1, round(WINDOW_STEPS / self.record["steps_per_frame"])), {}
        for first in range(0, len(self.places) - length, length):
            for name, number in self.sets_at(first, first + length).items():
                windows.setdefault(name, []).append((number, self.places[first], self.places[first + length]))
        print("\n| sets, mean of windows | within, % | left, r: rigid | affine | cubic |\n|---|--:|--:|--:|--:|")
        for name in sorted(windows):
            print(row_of(name, windows[name], self.law.near, self.law.r))

    def print_shares(self, times):
        print("\n| within, %, at |", " | ".join(f"{at} s" for at in times), "| mean |")
        print("|---|" + "--:|" * (len(times) + 1))
        rows = {f"force below {threshold:g}": [within(sets_of(largest < threshold, self.law.near), self.law.near)
                                               for largest in self.largest] for threshold in THRESHOLDS}
        for way in list(WAYS)[1:]:
            rows[way] = [np.mean(self.runs[way].frame(number)["level"] == 2) for number in range(len(self.places))]
        for name, shares in rows.items():
            shown = [*(shares[round(float(at) / self.record["frame_interval"])] for at in times), np.mean(shares)]
            print("|", name, "|", " | ".join(f"{100 * share:.1f}" for share in shown), "|")


def main():
    binaries, source, out = (Path(word).resolve() for word in sys.argv[1:4])
    name, model, count, *times = sys.argv[4:]
    scene = Scene(binaries, source / "configs" / f"{name}.yaml", out, model, count)
    print(f"{name}, {model}: {scene.record['particles']} particles; stepping:",
          {way: round(run.record["seconds"]["stepping"], 1) for way, run in scene.runs.items()})
    scene.print_shares(times)
    scene.print_windows()


if __name__ == "__main__":
    main()
