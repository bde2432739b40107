#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the box and the fox with their bones, weights and motions as rigs for animators.

usage: make_motions_gltf.py        always the same bytes; plain Python 3.10 or later

data/motions/box_bend.glb      the scene configs/box_bend.yaml, z up
data/motions/fox.glb           the scene configs/creature_walk.yaml, as glTF wants it: y up, z forward
"""

import json
import math
import struct
from pathlib import Path

from make_motions import joints_of, minus, pose, turned
from mesh_files import read_mesh
from scene_lines import read_scene

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

    def add(self, rows, kind, component=FLOAT, bounds=False, normalized=False):
        numbers = [x for row in rows for x in row]
        packed = struct.pack(f"<{len(numbers)}{FORMATS[component]}", *numbers)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(packed)})
        accessor = {"bufferView": len(self.views) - 1, "componentType": component, "count": len(rows), "type": kind}
        if bounds:  # as the numbers are in single precision
            single = struct.unpack(f"<{len(numbers)}f", packed)
            columns = [single[i::SIZES[kind]] for i in range(SIZES[kind])]
            accessor |= {"min": [min(c) for c in columns], "max": [max(c) for c in columns]}
        if normalized:
            accessor["normalized"] = True
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


def moved(x, y, z):
    """A matrix, column by column."""
    return (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1)


def box_mesh(buffer):
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


def box():
    buffer = Buffer()
    meshes, animations = [box_mesh(buffer)], [bend(buffer)]
    binds = buffer.add([moved(0, 0, 0), moved(0, 0, -JOINT)], "MAT4")
    nodes = [{"name": "rig", "children": [1, 4]},
             {"name": "lower", "children": [2]},
             {"name": "upper", "children": [3], "translation": [0, 0, JOINT]},
             {"name": "upper_end", "translation": [0, 0, TIP - JOINT]},
             {"name": "box", "mesh": 0, "skin": 0}]
    return buffer.data, whole(buffer, nodes=nodes, meshes=meshes,
                              skins=[{"joints": [1, 2], "inverseBindMatrices": binds}], animations=animations)


def whole(buffer, **parts):
    """The file's JSON; its scene shows node 0."""
    return {
        "asset": {"version": "2.0", "generator": "sinew, data/make_motions_gltf.py", "copyright": "GPL-3.0-or-later"},
        "scene": 0, "scenes": [{"nodes": [0]}], **parts,
        "accessors": buffer.accessors, "bufferViews": buffer.views, "buffers": [{"byteLength": len(buffer.data)}]}


# The fox: colors of its parts, red, green and blue; its parts by height and by bone.
COLORS = {"coat": (0.72, 0.29, 0.08), "socks": (0.06, 0.05, 0.05), "tip": (0.85, 0.83, 0.8)}
SOCKS = 0.05  # m above the ground
BRISK = 8  # how fast a bone's weight falls with distance: as its power
LEAST = 0.02  # part of the heaviest weight; less is none


def distance(point, joint):
    """To the segment from head to tail, m."""
    along, way = minus(joint.tail, joint.head), minus(point, joint.head)
    s = sum(a * b for a, b in zip(way, along)) / sum(a * a for a in along)
    s = max(0.0, min(1.0, s))
    return math.dist(way, [s * a for a in along])


def shares(point, joints):
    """The four heaviest bones and their weights, which are parts of 255 and sum to it."""
    near = sorted((distance(point, joint), i) for i, joint in enumerate(joints))[:4]
    weights = [(near[0][0] / d) ** BRISK if d > 0 else 1.0 for d, _ in near]
    weights = [w if w >= LEAST else 0.0 for w in weights]
    parts = [int(255 * w / sum(weights)) for w in weights]
    parts[0] += 255 - sum(parts)
    return [i if part else 0 for (_, i), part in zip(near, parts)], parts


def part_of(corners, points, bones, joints):
    if all(points[c][2] < SOCKS for c in corners):
        return "socks"
    return "tip" if all(joints[bones[c]].name == "tail_tip" for c in corners) else "coat"


def fox_mesh(buffer, joints):
    """One primitive for each color; points on their borders stand in both."""
    points, faces = read_mesh(DATA / "meshes" / "creature.ply")
    held = [shares(p, joints) for p in points]
    bones = [chosen[0] for chosen, _ in held]
    primitives = []
    for material, part in enumerate(COLORS):
        own = [face for face in faces if part_of(face, points, bones, joints) == part]
        used = sorted({corner for face in own for corner in face})
        place = {corner: i for i, corner in enumerate(used)}
        attributes = {"POSITION": buffer.add([turned(points[c]) for c in used], "VEC3", bounds=True),
                      "JOINTS_0": buffer.add([held[c][0] for c in used], "VEC4", UINT8),
                      "WEIGHTS_0": buffer.add([held[c][1] for c in used], "VEC4", UINT8, normalized=True)}
        corners = buffer.add([(place[c],) for face in own for c in face], "SCALAR", UINT16)
        primitives.append({"attributes": attributes, "indices": corners, "material": material})
    return {"name": "fox", "primitives": primitives}


def fox_nodes(joints):
    """Node 0 shows the mesh and the root; joint i is node i + 1; ends that no joint tells follow."""
    nodes = [{"name": "rig", "children": []}]
    nodes += [{"name": joint.name, "translation": turned(minus(joint.head, joint.parent.head if joint.parent else [0] * 3))}
              for joint in joints]
    for i, joint in enumerate(joints):
        above = nodes[joints.index(joint.parent) + 1 if joint.parent else 0]
        above.setdefault("children", []).append(i + 1)
        if not joint.tail_is_told():
            nodes[i + 1].setdefault("children", []).append(len(nodes))
            nodes.append({"name": joint.name + "_end", "translation": turned(minus(joint.tail, joint.head))})
    nodes[0]["children"].append(len(nodes))
    return nodes + [{"name": "fox", "mesh": 0, "skin": 0}]


def clip(buffer, name, joints, moving, nodes):
    last = max(key["time"] for joint in moving for key in joint.keys)
    times = [k / RATE for k in range(round(last * RATE) + 1)]
    given = buffer.add([(t,) for t in times], "SCALAR", bounds=True)
    samplers, channels = [], []

    def add(joint, path, rows, kind):
        channels.append({"sampler": len(samplers), "target": {"node": joints.index(joint) + 1, "path": path}})
        samplers.append({"input": given, "output": buffer.add(rows, kind), "interpolation": "LINEAR"})

    for joint in moving:
        poses = [pose(joint.keys, t) for t in times]
        if any("axis" in key for key in joint.keys):
            add(joint, "rotation", [turned(q[1:]) + q[:1] for q, _ in poses], "VEC4")
        if any("translation" in key for key in joint.keys):
            rest = nodes[joints.index(joint) + 1]["translation"]
            add(joint, "translation", [[a + b for a, b in zip(rest, turned(shift))] for _, shift in poses], "VEC3")
    return {"name": name, "samplers": samplers, "channels": channels}


def fox():
    buffer = Buffer()
    joints = list(joints_of(read_scene(DATA.parent / "configs" / "creature_walk.yaml")))
    moving = [joint for joint in joints if joint.keys]
    meshes, nodes = [fox_mesh(buffer, joints)], fox_nodes(joints)
    clips = [clip(buffer, "walk", joints, moving, nodes),
             clip(buffer, "wag", joints, [joint for joint in moving if joint.name.startswith("tail")], nodes)]
    binds = buffer.add([moved(*[-a for a in turned(joint.head)]) for joint in joints], "MAT4")
    return buffer.data, whole(
        buffer, nodes=nodes, meshes=meshes, animations=clips,
        skins=[{"joints": list(range(1, len(joints) + 1)), "inverseBindMatrices": binds}],
        materials=[{"name": name, "pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": 0}}
                   for name, color in COLORS.items()])


def glb(data, content):
    text = json.dumps(content, separators=(",", ":")).encode("ascii")
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def main():
    folder = DATA / "motions"
    folder.mkdir(exist_ok=True)
    (folder / "box_bend.glb").write_bytes(glb(*box()))
    (folder / "fox.glb").write_bytes(glb(*fox()))


if __name__ == "__main__":
    main()
