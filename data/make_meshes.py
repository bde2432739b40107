#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the meshes in data/meshes, always the same bytes. Needs nothing but Python."""

import math
from pathlib import Path

import bodies
from mesh_files import write_obj, write_ply
from polygonize import polygonize

MESHES = Path(__file__).resolve().parent / "meshes"
ORIGIN = ["Made by data/make_meshes.py. SPDX-License-Identifier: GPL-3.0-or-later"]


def grid_box(cells, low, size):
    """A closed box whose sides are grids of triangles: points shared, faces outward.

    Points go layer by layer along z; the diagonals alternate like a chessboard's colors, so that
    no direction is preferred.
    """
    points, number = [], {}
    for k in range(cells[2] + 1):
        for j in range(cells[1] + 1):
            for i in range(cells[0] + 1):
                place = (i, j, k)
                if any(p in (0, n) for p, n in zip(place, cells)):
                    number[place] = len(points)
                    points.append([a + s * p / n for a, s, p, n in zip(low, size, place, cells)])
    faces = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, cells[axis]):
            for b in range(cells[v]):
                for a in range(cells[u]):
                    quad = []
                    for p, q in ((a, b), (a + 1, b), (a + 1, b + 1), (a, b + 1)):
                        place = [0, 0, 0]
                        place[axis], place[u], place[v] = side, p, q
                        quad.append(number[tuple(place)])
                    if side == 0:
                        quad.reverse()
                    if (a + b) % 2:
                        quad = quad[1:] + quad[:1]
                    faces += [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]
    return points, faces


def paper_box():
    """The body of Komiya and Tokoi: 11 x 11 x 49 half-planes of closest packing at r = 0.010 m."""
    plane = math.sqrt(2) * 0.010
    size = [11 * plane, 11 * plane, 49 * plane]
    points, faces = grid_box((8, 10, 25), (-size[0] / 2, -size[1] / 2, 0.0), size)
    comment = ["The box of Komiya and Tokoi: 1062 points, lengths in meters.", *ORIGIN]
    write_obj(MESHES / "box.obj", comment, points, faces)


def skin_of_cells(cells, edge):
    """The surface of cubes (i, j, k) from k = 0 up, centered on 0 in x and y: points shared, outward."""
    half = [max(cell[axis] for cell in cells) / 2 + 0.5 if axis < 2 else 0 for axis in range(3)]
    points, number, faces = [], {}, []
    for cell in sorted(cells):
        for axis in range(3):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            for side in (0, 1):
                beyond = list(cell)
                beyond[axis] += 2 * side - 1
                if tuple(beyond) in cells:
                    continue
                quad = []
                for p, q in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    corner = list(cell)
                    corner[axis] += side
                    corner[u] += p
                    corner[v] += q
                    corner = tuple(corner)
                    if corner not in number:
                        number[corner] = len(points)
                        points.append([edge * (c - h) for c, h in zip(corner, half)])
                    quad.append(number[corner])
                if side == 0:
                    quad.reverse()
                faces += [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]
    return points, faces


def two_fingers():
    """A palm 0.16 m wide with two fingers on it, 0.06 m thick and 0.22 m long, 0.04 m apart."""
    cells = {(i, j, k) for i in range(8) for j in range(3) for k in range(14)
             if k < 3 or i not in (3, 4)}
    points, faces = skin_of_cells(cells, 0.02)
    comment = [f"Two fingers on a palm: {len(points)} points, lengths in meters.", *ORIGIN]
    write_obj(MESHES / "two_fingers.obj", comment, points, faces)


def smooth_body(name, body, cell):
    points, faces = polygonize(body, cell)
    comment = [f"{body.title}: {len(points)} points, lengths in meters.", *ORIGIN]
    write_ply(MESHES / name, comment, points, faces, real="float")


if __name__ == "__main__":
    MESHES.mkdir(exist_ok=True)
    paper_box()
    two_fingers()
    smooth_body("arm.ply", bodies.arm(), 0.005)
    smooth_body("creature.ply", bodies.creature(), 0.0066)
    smooth_body("tentacle.ply", bodies.tentacle(), 0.005)
