#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the meshes in data/meshes, always the same bytes. Needs nothing but Python."""

import math
from pathlib import Path

import bodies
from mesh_files import write_obj, write_ply
from polygonise import polygonise

MESHES = Path(__file__).resolve().parent / "meshes"
ORIGIN = ["Made by data/make_meshes.py. SPDX-License-Identifier: GPL-3.0-or-later"]


def grid_box(cells, low, size):
    """A closed box whose sides are grids of triangles: points shared, faces outward.

    Points go layer by layer along z; the diagonals alternate like a chessboard's colours, so that
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
    comment = ["The box of Komiya and Tokoi: 1062 points, lengths in metres.", *ORIGIN]
    write_obj(MESHES / "box.obj", comment, points, faces)


def smooth_body(name, body, cell):
    points, faces = polygonise(body, cell)
    comment = [f"{body.title}: {len(points)} points, lengths in metres.", *ORIGIN]
    write_ply(MESHES / name, comment, points, faces, real="float")


if __name__ == "__main__":
    MESHES.mkdir(exist_ok=True)
    paper_box()
    smooth_body("arm.ply", bodies.arm(), 0.005)
    smooth_body("creature.ply", bodies.creature(), 0.0066)
    smooth_body("tentacle.ply", bodies.tentacle(), 0.005)
