# SPDX-License-Identifier: GPL-3.0-or-later
"""Smooth shapes as distance fields: negative inside, in meters, smoothly joined.

Only + - * / and square roots are used, which every machine rounds alike, so that the same shape
comes out everywhere, bit for bit. (The built-in sum() of floats differs between Pythons.)
"""

from math import inf, sqrt

SAMPLES = 4  # starts per span for the search of a limb's nearest place
SEARCHES = 3  # Newton steps of it


def spline(values):
    """Catmull-Rom cubics through `values`: per span the factors of 1, t, t^2, t^3."""
    ends = [2 * values[0] - values[1], *values, 2 * values[-1] - values[-2]]
    return [(b, 0.5 * (c - a), 0.5 * (2 * a - 5 * b + 4 * c - d), 0.5 * (3 * (b - c) + d - a))
            for a, b, c, d in zip(ends, ends[1:], ends[2:], ends[3:])]


def at(cubic, t):
    a, b, c, d = cubic
    return a + t * (b + t * (c + t * d))


def tube_cubics(*knots):
    """The cubics for x, y, z and radius of each span between knots."""
    return list(zip(*(spline(values) for values in zip(*knots))))


def tube(*knots):
    """A round limb along a smooth curve. Each knot is (x, y, z, radius)."""
    spans = tube_cubics(*knots)
    samples = [(*(at(cubic, i / SAMPLES) for cubic in span[:3]), s + i / SAMPLES)
               for s, span in enumerate(spans) for i in range(SAMPLES + (s + 1 == len(spans)))]

    def nearest_sample(x, y, z):
        least, nearest = inf, 0.0
        for sx, sy, sz, t in samples:
            sx -= x
            sy -= y
            sz -= z
            square = sx * sx + sy * sy + sz * sz
            if square < least:
                least, nearest = square, t
        return nearest

    last = len(spans) - 1

    def field(x, y, z):
        t = nearest_sample(x, y, z)
        for search in range(SEARCHES + 1):
            s = int(t) if t < last else last
            (xa, xb, xc, xd), (ya, yb, yc, yd), (za, zb, zc, zd), radius = spans[s]
            u = t - s
            px = x - (xa + u * (xb + u * (xc + u * xd)))
            py = y - (ya + u * (yb + u * (yc + u * yd)))
            pz = z - (za + u * (zb + u * (zc + u * zd)))
            if search == SEARCHES:
                break
            vx = xb + u * (2 * xc + 3 * u * xd)
            vy = yb + u * (2 * yc + 3 * u * yd)
            vz = zb + u * (2 * zc + 3 * u * zd)
            speed = vx * vx + vy * vy + vz * vz
            bend = 2 * (px * (xc + 3 * u * xd) + py * (yc + 3 * u * yd) + pz * (zc + 3 * u * zd))
            t += (px * vx + py * vy + pz * vz) / (speed - bend if bend < speed / 2 else speed / 2)
            t = 0.0 if t < 0 else min(t, last + 1.0)
        way = sqrt(px * px + py * py + pz * pz)
        per_way = 1 / way if way > 0 else 0.0
        return way - at(radius, u), px * per_way, py * per_way, pz * per_way

    low = [min(s[i] for s in samples) - max(k[3] for k in knots) for i in range(3)]
    high = [max(s[i] for s in samples) + max(k[3] for k in knots) for i in range(3)]
    return field, low, high


def ellipsoid(center, radii, along=(1, 0, 0), beside=(0, 1, 0)):
    """Half-axes `radii` along `along`, then across it towards `beside`, then across both.

    The distance is a good one near the surface and along the axes, not everywhere.
    """
    u = unit(along)
    v = unit(cross(cross(u, beside), u))
    w = cross(u, v)
    cx, cy, cz = center
    (ux, uy, uz), (vx, vy, vz), (wx, wy, wz) = u, v, w
    ru, rv, rw = (1 / (r * r) for r in radii)

    def field(x, y, z):
        x, y, z = x - cx, y - cy, z - cz
        a = ux * x + uy * y + uz * z
        b = vx * x + vy * y + vz * z
        c = wx * x + wy * y + wz * z
        size = sqrt(a * a * ru + b * b * rv + c * c * rw)
        a, b, c = a * ru, b * rv, c * rw
        slope = sqrt(a * a + b * b + c * c)
        if slope == 0:
            return -min(radii), 0.0, 0.0, 0.0
        a, b, c = a / slope, b / slope, c / slope
        return (size * (size - 1) / slope, a * ux + b * vx + c * wx, a * uy + b * vy + c * wy,
                a * uz + b * vz + c * wz)

    reach = [sqrt(sum_of(axis[i] * r * axis[i] * r for axis, r in zip((u, v, w), radii)))
             for i in range(3)]
    return field, [c - d for c, d in zip(center, reach)], [c + d for c, d in zip(center, reach)]


def flattened(part, center, direction, factor):
    """`part` pressed together along `direction`, towards the plane through `center`."""
    field, low, high = part
    ux, uy, uz = unit(direction)
    cx, cy, cz = center
    stretch = 1 / factor - 1

    def pressed(x, y, z):
        off = stretch * (ux * (x - cx) + uy * (y - cy) + uz * (z - cz))
        d, gx, gy, gz = field(x + off * ux, y + off * uy, z + off * uz)
        rise = stretch * (ux * gx + uy * gy + uz * gz)
        return d, gx + rise * ux, gy + rise * uy, gz + rise * uz

    return pressed, low, high


def sum_of(values):
    total = 0.0
    for value in values:
        total += value
    return total


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
    return (a[0] / length, a[1] / length, a[2] / length)


class Body:
    """Parts joined one after the other, each with a fillet about as wide as its `blend` (m).

    A part is its field, distance and slope (x, y, z) at a place, and its box.
    """

    def __init__(self, title):
        self.title = title
        self.parts = []  # (box's low and high corner, blend, field)

    def add(self, part, blend):
        field, low, high = part
        self.parts.append((*low, *high, blend, field))

    def box(self):
        return ([min(part[i] for part in self.parts) for i in range(3)],
                [max(part[i + 3] for part in self.parts) for i in range(3)])

    def distance(self, x, y, z):
        return self.field(x, y, z)[0]

    def field(self, x, y, z):
        near, sx, sy, sz = inf, 0.0, 0.0, 0.0
        for lx, ly, lz, hx, hy, hz, blend, part in self.parts:
            dx = lx - x if x < lx else x - hx if x > hx else 0.0
            dy = ly - y if y < ly else y - hy if y > hy else 0.0
            dz = lz - z if z < lz else z - hz if z > hz else 0.0
            reach = near + blend
            if reach > 0 and dx * dx + dy * dy + dz * dz >= reach * reach:
                continue  # too far to show
            d, gx, gy, gz = part(x, y, z)
            overlap = blend - abs(near - d)
            share = overlap * overlap / (2 * blend * blend) if overlap > 0 else 0.0
            if d < near:
                near, share = d, 1 - share
            if overlap > 0:
                near -= overlap * overlap * overlap / (6 * blend * blend)
            sx, sy, sz = sx + share * (gx - sx), sy + share * (gy - sy), sz + share * (gz - sz)
        return near, sx, sy, sz
