# SPDX-License-Identifier: GPL-3.0-or-later
"""Small meshes (points, faces) made here: two closed ones to break, and some with no clear inside.

About 0.2 m across.
"""

import random
from math import cos, pi, sin, sqrt

from broken import together


def sphere(radius=0.1, halvings=4):
    """An octahedron's faces cut into four again and again, all points on the sphere."""
    points = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    middles = {}

    def middle(a, b):
        key = min(a, b), max(a, b)
        if key not in middles:
            sums = [x + y for x, y in zip(points[a], points[b])]
            length = sqrt(sums[0] * sums[0] + sums[1] * sums[1] + sums[2] * sums[2])
            middles[key] = len(points)
            points.append(tuple(s / length for s in sums))
        return middles[key]

    for _ in range(halvings):
        cut = []
        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            cut += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = cut
    return [tuple(radius * x for x in p) for p in points], faces


def grid(rows, columns, place, number):
    """Triangles between places (row, column); `number` tells which of them are the same point."""
    points = [place(i, j) for i in range(rows) for j in range(columns)]
    faces = []
    for i, j in ((i, j) for i in range(rows) for j in range(columns)):
        corners = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)]
        if None not in corners:
            faces += [tuple(corners[:3]), (corners[0], corners[2], corners[3])]
    return points, faces


def torus(ring=0.07, tube=0.03, around=48, across=24):
    def place(i, j):
        u, v = 2 * pi * i / around, 2 * pi * j / across
        out = ring + tube * cos(v)
        return out * cos(u), out * sin(u), tube * sin(v)

    return grid(around, across, place, lambda i, j: i % around * across + j % across)


def sheet(cells=20, side=0.2):
    def number(i, j):
        return None if max(i, j) > cells else i * (cells + 1) + j

    return grid(cells + 1, cells + 1, lambda i, j: (side * i / cells, side * j / cells, 0.0),
                number)


def moebius(around=60, across=8, ring=0.08, width=0.05):
    """A band with half a turn in it: it has one side only."""
    def place(i, j):
        u, w = 2 * pi * i / around, width * (j / across - 0.5)
        out = ring + w * cos(u / 2)
        return out * cos(u), out * sin(u), w * sin(u / 2)

    def number(i, j):
        if j > across:
            return None
        return i * (across + 1) + j if i < around else across - j

    return grid(around, across + 1, place, number)


def random_triangles(count=1000, side=0.2, reach=0.02):
    draw = random.Random(4)
    points = []
    for _ in range(count):
        middle = [side * draw.random() for _ in range(3)]
        points += [tuple(m + reach * (2 * draw.random() - 1) for m in middle) for _ in range(3)]
    return points, [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(count)]


def box(low, high):
    points = [tuple((low, high)[corner >> i & 1][i] for i in range(3)) for corner in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return points, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


def joined(one, other):
    """Both, with equal points made one."""
    points, faces = together(one, other)
    number = {p: i for i, p in reversed(list(enumerate(points)))}
    return points, [tuple(number[points[corner]] for corner in face) for face in faces]


def boxes_at_an_edge():
    """Four faces at their common edge."""
    return joined(box((0, 0, 0), (0.1, 0.1, 0.1)), box((0.1, 0.1, 0), (0.2, 0.2, 0.1)))


def boxes_at_a_point():
    return joined(box((0, 0, 0), (0.1, 0.1, 0.1)), box((0.1, 0.1, 0.1), (0.2, 0.2, 0.2)))


def boxes_at_a_face():
    """Two closed boxes; their common side is there twice, once from each."""
    return together(box((0, 0, 0), (0.1, 0.1, 0.1)), box((0.1, 0, 0), (0.2, 0.1, 0.1)))


def box_with_wall():
    """A box of two rooms: three faces meet at each edge of the wall between them."""
    points, faces = joined(box((0, 0, 0), (0.1, 0.1, 0.1)), box((0.1, 0, 0), (0.2, 0.1, 0.1)))
    wall = [face for face in faces if all(points[corner][0] == 0.1 for corner in face)]
    return points, [face for face in faces if face not in wall[2:]]


SHAPES = {
    "sheet": sheet,
    "moebius": moebius,
    "random_triangles": random_triangles,
    "non_manifold_edge": boxes_at_an_edge,
    "non_manifold_point": boxes_at_a_point,
    "non_manifold_wall": box_with_wall,
    "touching_boxes": boxes_at_a_face,
}
