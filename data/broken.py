# SPDX-License-Identifier: GPL-3.0-or-later
"""Ways to break a closed mesh. A mesh is (points, faces); each way gives another one."""

import random
from math import fsum, sqrt

FINEST = 2.0 ** -30  # m; points on this grid are exact also when moved by 1e6 m


def snapped(mesh):
    points, faces = mesh
    return [tuple(round(x / FINEST) * FINEST for x in p) for p in points], faces


def some_of(count, share, seed):
    """The same `share` of the numbers below `count` every time, at random."""
    draw = random.Random(seed)
    order = sorted(range(count), key=[draw.random() for _ in range(count)].__getitem__)
    return set(order[:round(share * count)])


def with_holes(mesh, share):
    points, faces = mesh
    gone = some_of(len(faces), share, seed=1)
    return points, [face for i, face in enumerate(faces) if i not in gone]


def with_flips(mesh, share):
    points, faces = mesh
    turned = some_of(len(faces), share, seed=2)
    return points, [face[::-1] if i in turned else face for i, face in enumerate(faces)]


def inverted(mesh):
    points, faces = mesh
    return points, [face[::-1] for face in faces]


def doubled(mesh, back=False):
    """Every face twice, the second time with the same or the other side out."""
    points, faces = mesh
    return points, faces + (inverted(mesh)[1] if back else faces)


def soup(mesh, jitter=0.0):
    """Every triangle with points of its own, moved by up to `jitter` of the mesh's size."""
    points, faces = mesh
    draw, reach = random.Random(3), jitter * size_of(mesh)
    loose = [tuple(x + reach * (2 * draw.random() - 1) for x in points[corner])
             for face in faces for corner in face]
    return loose, [(i, i + 1, i + 2) for i in range(0, len(loose), 3)]


def moved(mesh, shift):
    points, faces = mesh
    return [tuple(x + s for x, s in zip(p, shift)) for p in points], faces


def scaled(mesh, factor):
    points, faces = mesh
    return [tuple(factor * x for x in p) for p in points], faces


def together(one, other):
    (points, faces), (more, others) = one, other
    n = len(points)
    return points + more, faces + [tuple(corner + n for corner in face) for face in others]


def with_copy(mesh, share):
    """And again, further along x by `share` of its length there."""
    low, high = box_of(mesh)
    return together(mesh, moved(mesh, (share * (high[0] - low[0]), 0, 0)))


def touching_copy(mesh):
    """And again, its hindmost point in x on the foremost one here."""
    first, last = min(mesh[0]), max(mesh[0])
    return together(mesh, moved(mesh, [b - a for a, b in zip(first, last)]))


def nested(mesh, cavity):
    """With a smaller shell inside, which turns its outside in if it bounds a cavity."""
    inner = shrunk(mesh)
    return together(mesh, inverted(inner) if cavity else inner)


def shrunk(mesh):
    """Points moved inwards by a twentieth of the radius of a ball with this volume per area."""
    points, faces = mesh
    way = 0.05 * 3 * volume_of(mesh) / area_of(mesh)
    normals = [[0.0, 0.0, 0.0] for _ in points]
    for face in faces:
        n = normal(points, face)
        for corner in face:
            for i in range(3):
                normals[corner][i] += n[i]
    return [tuple(x - way * c / length(n) for x, c in zip(p, n))
            for p, n in zip(points, normals)], faces


def open_base(mesh):
    """Without the faces that reach into the lowest tenth."""
    points, faces = mesh
    low, high = box_of(mesh)
    level = low[2] + 0.1 * (high[2] - low[2])
    return points, [face for face in faces if all(points[corner][2] > level for corner in face)]


def box_of(mesh):
    return ([min(p[i] for p in mesh[0]) for i in range(3)],
            [max(p[i] for p in mesh[0]) for i in range(3)])


def size_of(mesh):
    low, high = box_of(mesh)
    return max(h - l for l, h in zip(low, high))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


def normal(points, face):
    """Outward, as long as twice the face's area."""
    a, b, c = (points[corner] for corner in face)
    return cross([y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)])


def area_of(mesh):
    points, faces = mesh
    return fsum(length(normal(points, face)) for face in faces) / 2


def volume_of(mesh):
    points, faces = mesh
    return fsum(x * n for face in faces
               for x, n in zip(points[face[0]], normal(points, face))) / 6


BREAKS = {
    "closed": lambda mesh: mesh,  # to compare with
    "holes_5": lambda mesh: with_holes(mesh, 0.05),
    "holes_20": lambda mesh: with_holes(mesh, 0.20),
    "flipped_10": lambda mesh: with_flips(mesh, 0.10),
    "inverted": inverted,
    "doubled": doubled,
    "doubled_reversed": lambda mesh: doubled(mesh, back=True),
    "soup": soup,
    "soup_jitter": lambda mesh: soup(mesh, jitter=1e-4),
    "overlapping": lambda mesh: with_copy(mesh, 0.25),
    "nested_out": lambda mesh: nested(mesh, cavity=False),
    "nested_in": lambda mesh: nested(mesh, cavity=True),
    "open_base": open_base,
    "two_bodies": lambda mesh: with_copy(mesh, 1.5),
    "touching": touching_copy,
    "far_away": lambda mesh: moved(mesh, (1e6, 1e6, 1e6)),
    "tiny": lambda mesh: scaled(mesh, 1e-6),
    "huge": lambda mesh: scaled(mesh, 1e6),
}
