#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Assemblies of solids that touch: cells of boxes, prisms and balls, boxes stacked with parts of their faces in common,
cells that meet at edges and corners, in any direction. The sites of an assembly must be those of its solids, filled
one by one on the same lattice. Sites on the skin of a solid are left out: alone, no solid has them.

usage: PYTHONPATH=build/python python3 assemblies.py [--count 100] [--seed 1] [--largest 500]
"""
import argparse
import sys

import numpy as np
import sinew

CORNERS = np.array([(i & 1, i >> 1 & 1, i >> 2) for i in range(8)])
BOX = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
PRISMS = (((0, 3, 1), (4, 5, 7), (0, 1, 5, 4), (1, 3, 7, 5), (0, 4, 7, 3)),
          ((0, 2, 3), (4, 7, 6), (0, 4, 6, 2), (2, 6, 7, 3), (0, 3, 7, 4)))


def without_points(polygon, points):
    """The corners but for those in the place of the one before; none where fewer than three are left."""
    kept = [a for a, b in zip(polygon, polygon[-1:] + polygon[:-1]) if np.any(points[a] != points[b])]
    return kept if len(kept) > 2 else []


def solids_of_cells(chance, at, cells, filled):
    """Solids of a grid of cells, whose corners `at` gives: boxes, or two prisms each."""
    prisms = chance.random() < 0.4
    for cell in np.ndindex(*cells):
        if chance.random() > filled:
            continue
        points = np.array([at(*(np.array(cell) + corner)) for corner in CORNERS])
        for faces in PRISMS if prisms else (BOX,):
            polygons = [without_points(list(face), points) for face in faces]
            polygons = [polygon for polygon in polygons if polygon]
            if len(polygons) > 3:  # else the cell is flat, at the middle or an axis
                yield points, polygons


def grid(chance, cells, filled):
    """Cells of uneven sizes, their inner corners moved about."""
    lines = [np.concatenate([[0], np.cumsum(chance.uniform(0.7, 1.3, n))]) for n in cells]
    shift = chance.uniform(-0.15, 0.15, [n + 1 for n in cells] + [3])
    def at(i, j, k):
        return np.array([lines[0][i], lines[1][j], lines[2][k]]) + shift[i, j, k]
    return solids_of_cells(chance, at, cells, filled)


def ball(chance, cells, filled):
    """Cells of a ball: shells, slices and sectors about its axis, with collapsed edges at its middle and poles."""
    shells, slices, sectors = cells[0], max(cells[1], 2), max(cells[2], 3)
    def at(i, j, k):
        radius, polar, turn = i / shells, np.pi * j / slices, 2 * np.pi * (k % sectors) / sectors
        if i == 0:
            return np.zeros(3)
        if j in (0, slices):
            return np.array([0, 0, radius if j == 0 else -radius])
        return radius * np.array([np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)])
    return solids_of_cells(chance, at, (shells, slices, sectors), filled)


def stack(chance, count):
    """Boxes on boxes: each lies on a part of the face of the one below."""
    low, size = np.zeros(3), chance.uniform(0.6, 1.4, 3)
    for _ in range(count):
        yield low + CORNERS * size, [list(face) for face in BOX]
        axis, side = chance.integers(3), chance.integers(2)
        new = chance.uniform(0.6, 1.4, 3)
        shift = chance.uniform(-0.4, 0.4, 3)
        shift[axis] = size[axis] if side else -new[axis]
        low, size = low + shift, new


def assembly(chance, largest):
    kind = chance.choice(["grid", "grid", "ball", "stack"])
    filled = chance.choice([1, 1, 0.6])
    edge = int(chance.integers(1, max(2, round((largest / 1.5) ** (1 / 3))) + 1))
    cells = tuple(int(n) for n in chance.integers(1, edge + 1, 3)) if edge > 1 else (2, 1, 1)
    solids = list(stack(chance, int(chance.integers(2, 4))) if kind == "stack" else
                  grid(chance, cells, filled) if kind == "grid" else ball(chance, cells, filled))
    turn = np.linalg.qr(chance.normal(size=(3, 3)))[0] if chance.random() < 0.7 else np.eye(3)
    if np.linalg.det(turn) < 0:
        turn[:, 0] *= -1
    return kind, [(points @ turn.T, polygons) for points, polygons in solids]


def together(solids, shared):
    """One mesh; `shared`: on common points."""
    points = np.concatenate([points for points, _ in solids])
    first = np.cumsum([0] + [len(points) for points, _ in solids])
    polygons = [[first[s] + corner for corner in polygon]
                for s, (_, faces) in enumerate(solids) for polygon in faces]
    if shared:
        points, number = np.unique(points, axis=0, return_inverse=True)
        polygons = [[number.ravel()[corner] for corner in polygon] for polygon in polygons]
    return points, polygons


def sites(points, polygons, radius, origin):
    try:
        found = sinew.fill(points, polygons, radius=radius, lattice_origin=tuple(origin)).points
    except sinew.Error as error:
        if "particle" not in str(error):
            raise
        return set()
    return {tuple(row) for row in np.round((found - origin) / radius / np.sqrt(2)).astype(int)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--largest", type=int, default=500, help="solids")
    options = parser.parse_args()
    wrong = 0
    for seed in range(options.seed, options.seed + options.count):
        chance = np.random.default_rng(seed)
        kind, solids = assembly(chance, options.largest)
        if len(solids) < 2:
            continue
        points, polygons = together(solids, chance.random() < 0.5)
        extent = np.ptp(points, axis=0)
        radius = (np.prod(extent) / 20000 / 5.657) ** (1 / 3)
        origin = points.mean(axis=0) + chance.uniform(0, radius, 3)
        whole = sites(points, polygons, radius, origin)
        apart = set().union(*(sites(*solid, radius, origin) for solid in solids))
        differ = len(whole ^ apart)
        info = sinew.diagnose(points, polygons)
        wrong += differ > 0 or not info["closed"]
        print(f"{seed} {kind}: {len(solids)} solids, {len(apart)} sites, {differ} differ, "
              f"closed {info['closed']}, {info['faces_shared']} pairs shared", flush=True)
    print(f"{wrong} of {options.count} assemblies differ")
    sys.exit(wrong > 0)


if __name__ == "__main__":
    main()
