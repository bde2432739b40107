#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes data/motions/box_bend.glb: the box, its two bones and the motion of configs/box_bend.yaml as one rig.

usage: make_motions_gltf.py        always the same bytes; plain Python 3.10 or later
"""

import json
import math
import struct
from pathlib import Path

from mesh_files import read_mesh

DATA = Path(__file__).resolve().parent
JOINT, TIP = 0.34648232, 0.69296465  # heights of the upper bone's ends, m
ZONE = 0.07778174593052024  # from the joint to where one bone alone moves the skin: half the box's width, m
KEYS = [(0, 0), (1, 90), (1.5, 90), (2.5, 0)]  # s, degrees about y; the bone rests at each (smoothstep)
RATE = 60  # keys per second in the file, straight ways (slerp) between
FLOAT, UINT8, UINT16 = 5126, 5121, 5123
SIZES = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}
FORMATS = {FLOAT: "f", UINT8: "B", UINT16: "H"}


class Buffer:
    """The file's numbers and the accessors that find them again."""

    def __init__(self):
        self.data, self.views, self.accessors = b"", [], []

    def add(self, rows, kind, component=FLOAT, bounds=False):
        numbers = [x for row in rows for x in row]
        packed = struct.pack(f"<{len(numbers)}{FORMATS[component]}", *numbers)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(packed)})
        accessor = {"bufferView": len(self.views) - 1, "componentType": component, "count": len(rows), "type": kind}
        if bounds:  # as the numbers are in single precision
            single = struct.unpack(f"<{len(numbers)}f", packed)
            columns = [single[i::SIZES[kind]] for i in range(SIZES[kind])]
            accessor |= {"min": [min(c) for c in columns], "max": [max(c) for c in columns]}
        self.accessors.append(accessor)
        self.data += packed + bytes(-len(packed) % 4)
        return len(self.accessors) - 1


def angle(time):
    """Of the upper bone, rad."""
    for (start, a), (end, b) in zip(KEYS, KEYS[1:]):
        if time <= end:
            s = max(0.0, (time - start) / (end - start))
            return math.radians(a + (b - a) * s * s * (3 - 2 * s))
    return math.radians(KEYS[-1][1])


def weights(point):
    """Of lower and upper, linear over the zone about the joint."""
    upper = min(1.0, max(0.0, 0.5 + (point[2] - JOINT) / (2 * ZONE)))
    return (1 - upper, upper, 0.0, 0.0)


def moved_up(height):
    """A matrix, column by column."""
    return (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, height, 1)


def mesh(buffer):
    points, faces = read_mesh(DATA / "meshes" / "box.obj")
    attributes = {"POSITION": buffer.add(points, "VEC3", bounds=True),
                  "JOINTS_0": buffer.add([(0, 1, 0, 0)] * len(points), "VEC4", UINT8),
                  "WEIGHTS_0": buffer.add([weights(p) for p in points], "VEC4")}
    corners = buffer.add([(corner,) for face in faces for corner in face], "SCALAR", UINT16)
    return {"name": "box", "primitives": [{"attributes": attributes, "indices": corners}]}


def bend(buffer):
    times = [k / RATE for k in range(round(KEYS[-1][0] * RATE) + 1)]
    rotations = [(0.0, math.sin(angle(t) / 2), 0.0, math.cos(angle(t) / 2)) for t in times]
    sampler = {"input": buffer.add([(t,) for t in times], "SCALAR", bounds=True),
               "output": buffer.add(rotations, "VEC4"), "interpolation": "LINEAR"}
    return {"name": "bend", "samplers": [sampler],
            "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}}]}


def document():
    buffer = Buffer()
    meshes, animations = [mesh(buffer)], [bend(buffer)]
    binds = buffer.add([moved_up(0), moved_up(-JOINT)], "MAT4")
    nodes = [{"name": "rig", "children": [1, 4]},
             {"name": "lower", "children": [2]},
             {"name": "upper", "children": [3], "translation": [0, 0, JOINT]},
             {"name": "upper_end", "translation": [0, 0, TIP - JOINT]},
             {"name": "box", "mesh": 0, "skin": 0}]
    return buffer.data, {
        "asset": {"version": "2.0", "generator": "sinew, data/make_motions_gltf.py", "copyright": "GPL-3.0-or-later"},
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": nodes, "meshes": meshes,
        "skins": [{"joints": [1, 2], "inverseBindMatrices": binds}], "animations": animations,
        "accessors": buffer.accessors, "bufferViews": buffer.views, "buffers": [{"byteLength": len(buffer.data)}]}


def glb(data, content):
    text = json.dumps(content, separators=(",", ":")).encode("ascii")
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def main():
    folder = DATA / "motions"
    folder.mkdir(exist_ok=True)
    (folder / "box_bend.glb").write_bytes(glb(*document()))


if __name__ == "__main__":
    main()
