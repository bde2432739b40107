# SPDX-License-Identifier: GPL-3.0-or-later
"""The zero set of a distance field as a closed mesh of well-shaped triangles.

Surface nets (Gibson 1998) on the cells of a grid that the surface passes, found by halving a cube;
then the points spread evenly while Newton steps hold them on the surface.
"""

from math import sqrt

CORNERS = [(i & 1, i >> 1 & 1, i >> 2 & 1) for i in range(8)]
EDGES = [(a, b) for a in range(8) for b in range(8) if a < b and bin(a ^ b).count("1") == 1]
FACES = [[c for c in range(8) if c >> axis & 1 == side] for axis in range(3) for side in (0, 1)]
STEEPNESS = 2  # most that a field changes per meter: pressed parts are not quite distances


def polygonize(body, cell):
    """Points and triangles (outward) of `body`, with edges of about `cell` meters."""
    grid = Grid(body, cell)
    points, faces = surface_net(grid)
    for rounds in (6, 4, 4):
        for _ in range(rounds):
            points = spread(body.field, points, faces)
        faces = flipped_to_better(points, faces)
    points = spread(body.field, points, faces)
    return [settled(body.field, p) for p in points], faces


class Grid:
    """Cells of side `cell` about the body's middle plane in y, numbered from the lowest."""

    def __init__(self, body, cell):
        low, high = body.box()
        self.cell = cell
        self.levels = 0
        while cell * 2 ** self.levels < max(h - l for l, h in zip(low, high)) + 8 * cell:
            self.levels += 1
        side = cell * 2 ** self.levels
        self.low = [(l + h - side) / 2 for l, h in zip(low, high)]
        self.distance = body.distance
        self.known = {}  # field at corners

    def place(self, corner):
        return [l + self.cell * c for l, c in zip(self.low, corner)]

    def at(self, corner):
        if corner not in self.known:
            self.known[corner] = self.distance(*self.place(corner))
        return self.known[corner]

    def cells_near_surface(self):
        """Lowest corners of the cells that the surface may pass, in ascending order."""
        cubes = [(0, 0, 0)]
        for level in range(self.levels, -1, -1):
            half = 2 ** level / 2
            within = STEEPNESS * sqrt(3) * half * self.cell
            cubes = [c for c in cubes
                     if abs(self.distance(*self.place([i + half for i in c]))) < within]
            if level > 0:
                step = 2 ** (level - 1)
                cubes = [(i + step * di, j + step * dj, k + step * dk)
                         for i, j, k in cubes for di, dj, dk in CORNERS]
        return sorted(cubes)


def surface_net(grid):
    """A point per sheet of the surface in each cell; a quad per grid edge that it crosses."""
    points, number, crossed = [], {}, []
    for low in grid.cells_near_surface():
        corners = [tuple(l + c for l, c in zip(low, corner)) for corner in CORNERS]
        values = [grid.at(corner) for corner in corners]
        for sheet in sheets([value < 0 for value in values]):
            for a, b in sheet:
                number[low, corners[a], corners[b]] = len(points)
            points.append(middle_of(grid, corners, values, sheet))
        crossed += [(corners[0], corners[1 << axis], axis, values[0] < 0) for axis in range(3)
                    if (values[0] < 0) != (values[1 << axis] < 0)]
    faces = []
    for start, end, axis, inside in crossed:
        quad = [number[cell, start, end] for cell in around(start, axis)]
        if not inside:
            quad.reverse()
        faces += halves(points, quad)
    return points, faces


def sheets(inside):
    """The crossed edges of a cell, those of one piece of the surface together.

    Two pieces meet where a face of the cell has inner corners across from each other only: they
    are held apart, else the mesh would join more than two faces at an edge.
    """
    sheet = {edge: {edge} for edge in EDGES if inside[edge[0]] != inside[edge[1]]}
    for face in FACES:
        crossings = [edge for edge in sheet if edge[0] in face and edge[1] in face]
        for one in crossings:
            for other in crossings:
                shared = [corner for corner in one if corner in other]
                if len(crossings) == 2 or any(inside[corner] for corner in shared):
                    joined = sheet[one] | sheet[other]
                    for edge in joined:
                        sheet[edge] = joined
    return [sorted(edges) for first, edges in sheet.items() if first == min(edges)]


def middle_of(grid, corners, values, crossings):
    middle = [0.0, 0.0, 0.0]
    for a, b in crossings:
        t = values[a] / (values[a] - values[b])
        for i in range(3):
            middle[i] += corners[a][i] + t * (corners[b][i] - corners[a][i])
    return grid.place([m / len(crossings) for m in middle])


def around(low, axis):
    """The four cells around the edge from `low` along `axis`, turning left as seen from its end."""
    u, v = (axis + 1) % 3, (axis + 2) % 3
    cells = []
    for du, dv in ((0, 0), (-1, 0), (-1, -1), (0, -1)):
        cell = list(low)
        cell[u] += du
        cell[v] += dv
        cells.append(tuple(cell))
    return cells


def halves(points, quad):
    """Two triangles, cut along the shorter diagonal."""
    a, b, c, d = quad
    if square(points[a], points[c]) <= square(points[b], points[d]):
        return [(a, b, c), (a, c, d)]
    return [(b, c, d), (b, d, a)]


def square(p, q):
    return sum_of_squares(p[0] - q[0], p[1] - q[1], p[2] - q[2])


def sum_of_squares(x, y, z):
    return x * x + y * y + z * z


def spread(field, points, faces):
    """Each point at the middle of its neighbors, brought back to the surface."""
    sums = [[0.0, 0.0, 0.0, 0] for _ in points]
    for face in faces:
        for a, b in zip(face, face[1:] + face[:1]):  # every edge once in each direction
            total, q = sums[a], points[b]
            total[0] += q[0]
            total[1] += q[1]
            total[2] += q[2]
            total[3] += 1
    return [on_surface(field, [s / n for s in (x, y, z)]) for x, y, z, n in sums]


def on_surface(field, p):
    """One Newton step along the field's slope."""
    d, gx, gy, gz = field(*p)
    step = d / sum_of_squares(gx, gy, gz)
    return [p[0] - step * gx, p[1] - step * gy, p[2] - step * gz]


def settled(field, p):
    for _ in range(4):
        p = on_surface(field, p)
    return p


def flipped_to_better(points, faces):
    """Turns edges of two triangles where that makes their smallest angle larger."""
    faces = [list(face) for face in faces]
    beside = {}  # directed edge: its face
    for f, face in enumerate(faces):
        for a, b in zip(face, face[1:] + face[:1]):
            beside[a, b] = f
    for a, b in list(beside):
        if a < b and (a, b) in beside:
            flip(points, faces, beside, a, b)
    return [tuple(face) for face in faces]


def flip(points, faces, beside, a, b):
    f, g = beside[a, b], beside[b, a]
    c = third(faces[f], a, b)
    d = third(faces[g], a, b)
    if (c, d) in beside or (d, c) in beside:
        return
    before = min(sharpness(points, a, b, c), sharpness(points, b, a, d))
    after = min(sharpness(points, c, d, b), sharpness(points, d, c, a))
    if after <= before * 1.01 or not faces_agree(points, (c, d, b), (d, c, a)):
        return
    faces[f], faces[g] = [c, d, b], [d, c, a]
    del beside[a, b], beside[b, a]
    for face, number in ((faces[f], f), (faces[g], g)):
        for p, q in zip(face, face[1:] + face[:1]):
            beside[p, q] = number


def third(face, a, b):
    return next(p for p in face if p not in (a, b))


def normal(points, a, b, c):
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = points[a], points[b], points[c]
    ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
    return uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx


def faces_agree(points, one, other):
    """Whether two triangles are bent by less than 45 degrees against each other."""
    m, n = normal(points, *one), normal(points, *other)
    dot = m[0] * n[0] + m[1] * n[1] + m[2] * n[2]
    return dot > 0 and 2 * dot * dot > sum_of_squares(*m) * sum_of_squares(*n)


def sharpness(points, a, b, c):
    """Grows with the smallest angle: its squared sine, 0 for a needle, 3/4 for equal sides."""
    sides = sorted((square(points[a], points[b]), square(points[b], points[c]),
                    square(points[c], points[a])))
    if sides[1] == 0:
        return 0.0
    return sum_of_squares(*normal(points, a, b, c)) / (sides[1] * sides[2])
