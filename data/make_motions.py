#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the clips in data/motions from the scenes in configs, always the same bytes.

Needs nothing but Python. A BVH file keeps no keys and no easing: it holds the pose of every joint
in each of 120 frames per second. Its y axis points up and its z axis forward, as is usual; its
lengths are meters.
"""

import math
from pathlib import Path

from scene_lines import read_scene

HERE = Path(__file__).resolve().parent
RATE = 120


def turned(v):
    """The scene's directions (x forward, z up) as the file's (z forward, y up)."""
    return [v[1], v[2], v[0]]


def minus(a, b):
    return [p - q for p, q in zip(a, b)]


def product(p, q):
    """Of two quaternions w, x, y, z."""
    (a, b, c, d), (e, f, g, h) = p, q
    return [a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g,
            a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e]


def about(axis, angle):
    half, length = math.radians(angle) / 2, math.hypot(*axis)
    return [math.cos(half)] + [math.sin(half) * a / length for a in axis]


def power(q, s):
    """The part s of the way from no rotation to q, the short way."""
    if q[0] < 0:
        q = [-a for a in q]
    sine = math.hypot(*q[1:])
    if sine == 0:
        return [1, 0, 0, 0]
    half = s * math.atan2(sine, q[0])
    return [math.cos(half)] + [math.sin(half) * a / sine for a in q[1:]]


def rotation(key):
    if "euler" in key:  # about the fixed axes x, y and z, one after the other
        q = [1, 0, 0, 0]
        for i, angle in enumerate(key["euler"]):
            q = product(about([float(i == k) for k in range(3)], angle), q)
        return q
    return about(key["axis"], key["angle"]) if "axis" in key else [1, 0, 0, 0]


def pose(keys, time):
    """Rotation and translation of a track at a time: smooth from key to key, held beyond."""
    after = next((i for i, key in enumerate(keys) if key["time"] > time), len(keys))
    start, end = keys[max(after - 1, 0)], keys[min(after, len(keys) - 1)]
    s = (time - start["time"]) / (end["time"] - start["time"]) if start is not end else 0
    s = s * s * (3 - 2 * s)
    p, q = rotation(start), rotation(end)
    back = [p[0]] + [-a for a in p[1:]]
    a, b = (key.get("translation", [0, 0, 0]) for key in (start, end))
    return product(power(product(q, back), s), p), [u + s * (v - u) for u, v in zip(a, b)]


def euler(q):
    """Angles z, y, x of q = Rz Ry Rx, degrees."""
    w, x, y, z = q
    z_angle = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    y_angle = math.asin(max(-1, min(1, 2 * (w * y - x * z))))
    x_angle = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    return [math.degrees(a) for a in (z_angle, y_angle, x_angle)]


def text(numbers):
    """Nine digits; what is less than rounding is 0."""
    return " ".join(f"{a:.9g}" if abs(a) > 5e-13 else "0" for a in numbers)


class Joint:
    """A bone of the scene. Its head is the joint, its tail an End Site where no child tells it."""

    def __init__(self, bone, others):
        self.name = bone["name"]
        self.parent = others.get(bone.get("parent"))
        self.head = bone.get("head") or self.parent.tail
        self.tail = bone["tail"]
        self.children = []
        self.keys = []
        if self.parent:
            self.parent.children.append(self)

    def tail_is_told(self):
        heads = [child.head for child in self.children]
        mean = [sum(a) / len(heads) for a in zip(*heads)]
        return bool(heads) and max(map(abs, minus(mean, self.tail))) < 1e-12

    def channels(self):
        moves = self.parent is None or any("translation" in key for key in self.keys)
        return (["Xposition", "Yposition", "Zposition"] if moves else []) + [
            "Zrotation", "Yrotation", "Xrotation"]

    def depth_first(self):
        yield self
        for child in self.children:
            yield from child.depth_first()

    def lines(self):
        offset = minus(self.head, self.parent.head) if self.parent else self.head
        channels = self.channels()
        yield f"{'JOINT' if self.parent else 'ROOT'} {self.name}"
        yield "{"
        yield f"  OFFSET {text(turned(offset))}"
        yield f"  CHANNELS {len(channels)} {' '.join(channels)}"
        if not self.tail_is_told():
            yield "  End Site"
            yield "  {"
            yield f"    OFFSET {text(turned(minus(self.tail, self.head)))}"
            yield "  }"
        for child in self.children:
            yield from ("  " + line for line in child.lines())
        yield "}"

    def values(self, time):
        q, shift = pose(self.keys, time) if self.keys else ([1, 0, 0, 0], [0, 0, 0])
        angles = euler([q[0]] + turned(q[1:]))
        if len(self.channels()) == 3:
            return angles
        offset = minus(self.head, self.parent.head) if self.parent else self.head
        return turned([a + b for a, b in zip(offset, shift)]) + angles


def joints_of(scene):
    joints = {}
    for bone in scene["skeleton"]["bones"]:
        joints[bone["name"]] = Joint(bone, joints)
    for track in scene["motion"]["tracks"]:
        joints[track["bone"]].keys = track["keys"]
    return joints.values()


def write_bvh(path, joints):
    roots = [joint for joint in joints if joint.parent is None]
    lines = ["HIERARCHY"] + [line for root in roots for line in root.lines()]
    order = [joint for root in roots for joint in root.depth_first()]
    last = max(key["time"] for joint in joints for key in joint.keys)
    frames = round(last * RATE) + 1
    lines += ["MOTION", f"Frames: {frames}", f"Frame Time: {1 / RATE:.17g}"]
    for frame in range(frames):
        lines.append(" ".join(text(joint.values(frame / RATE)) for joint in order))
    path.write_text("\n".join(lines) + "\n")


def main():
    (HERE / "motions").mkdir(exist_ok=True)
    for scene, clip in (("box_bend", "box_bend"), ("creature_walk", "walk")):
        joints = joints_of(read_scene(HERE.parent / "configs" / f"{scene}.yaml"))
        write_bvh(HERE / "motions" / f"{clip}.bvh", joints)


if __name__ == "__main__":
    main()
