#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How far the skin of a run lies from linear-blend skinning of its file: of glTF by a reader and a skinner of their own,
of FBX and COLLADA by Blender's import and evaluation. Compressed glTF is not read.

usage: exact_skinning.py FILE RUN      the file that the scene animates, the folder of the run

Prints the mean and the largest distance of a frame, in diagonals of the body at rest. The vertices of the file are
found in the skin at rest; the file's axes in the scene are those that fit the last frames best, and the preroll is the
tenth of a second that does. The run's frames before the clip begins and after it ends do not count.
"""
import base64
import itertools
import json
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml
from pathlib import Path

import meshio
import numpy as np
import yaml
from scipy.spatial import cKDTree

TYPES = {5120: ("i1", 127), 5121: ("u1", 255), 5122: ("i2", 32767), 5123: ("u2", 65535), 5125: ("u4", 1), 5126: ("f4", 1)}
SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
FRAMES, LONGEST_PREROLL = 30, 3.0
MIN_FOUND = 0.5  # of the vertices: shells become layers, whose vertices are others
ROTATIONS = [np.diag(signs)[:, axes] for axes in map(list, itertools.permutations(range(3)))
             for signs in itertools.product((1, -1), repeat=3)]
ROTATIONS = [turn for turn in ROTATIONS if np.linalg.det(turn) > 0]


def matrix(translation, rotation, scale):
    x, y, z, w = np.array(rotation, float) / np.linalg.norm(rotation)
    turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    whole = np.eye(4)
    whole[:3, :3], whole[:3, 3] = turn * np.array(scale, float), translation
    return whole


def between(a, b, s, path):
    """On the straight way from key to key, of rotations on the shortest one."""
    if path != "rotation":
        return a + s * (b - a)
    cosine = a @ b
    if cosine < 0:
        b, cosine = -b, -cosine
    angle = np.arccos(min(cosine, 1))
    if angle < 1e-3:
        return a + s * (b - a)
    return (np.sin((1 - s) * angle) * a + np.sin(s * angle) * b) / np.sin(angle)


def cubic(values, k, s, step):
    start, out, end, into = values[k, 1], values[k, 2] * step, values[k + 1, 1], values[k + 1, 0] * step
    return ((2 * s**3 - 3 * s * s + 1) * start + (s**3 - 2 * s * s + s) * out
            + (3 * s * s - 2 * s**3) * end + (s**3 - s * s) * into)


def json_of(path):
    """JSON of a glTF file, and where its binary part begins."""
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0] if data[:4] == b"glTF" else 0
    return json.loads(data[20:20 + length] if length else data), data, length


class GltfFile:
    def __init__(self, path, clip):
        self.json, data, length = json_of(path)
        self.buffers = [data[28 + length:] if "uri" not in one else
                        base64.b64decode(one["uri"].split(",", 1)[1]) if one["uri"].startswith("data:") else
                        (path.parent / one["uri"]).read_bytes() for one in self.json["buffers"]]
        self.parent = {child: k for k, node in enumerate(self.json["nodes"]) for child in node.get("children", [])}
        clips = self.json["animations"]
        chosen = next((one for one in clips if one.get("name") == clip), clips[0])
        joined = [chosen] if "name" in chosen else [one for one in clips if "name" not in one]
        self.tracks = {}
        for one, channel in ((one, channel) for one in joined for channel in one["channels"]):
            sampler, target = one["samplers"][channel["sampler"]], channel["target"]
            mode = sampler.get("interpolation", "LINEAR")
            times, values = self.accessor(sampler["input"])[:, 0], self.accessor(sampler["output"])
            if mode == "CUBICSPLINE":
                values = values.reshape(len(times), 3, -1)
            if "node" in target and target["path"] != "weights":
                self.tracks[target["node"], target["path"]] = times, values, mode
        self.end = max(times[-1] for times, _, _ in self.tracks.values())

    def accessor(self, index):
        one = self.json["accessors"][index]
        kind, divisor = TYPES[one["componentType"]]
        size, view = SIZES[one["type"]], self.json["bufferViews"][one["bufferView"]]
        first = view.get("byteOffset", 0) + one.get("byteOffset", 0)
        stride = view.get("byteStride", np.dtype(kind).itemsize * size)
        rows = np.array([np.frombuffer(self.buffers[view["buffer"]], kind, size, first + k * stride)
                         for k in range(one["count"])], float)
        return np.maximum(rows / divisor, -1) if one.get("normalized") else rows

    def value(self, node, path, time, rest):
        if time is None or (node, path) not in self.tracks:
            return rest
        times, values, mode = self.tracks[node, path]
        key = (lambda k: values[k, 1]) if mode == "CUBICSPLINE" else (lambda k: values[k])
        if time <= times[0] or time >= times[-1]:
            return key(0 if time <= times[0] else -1)
        k = int(np.searchsorted(times, time, "right")) - 1
        step = times[k + 1] - times[k]
        s = (time - times[k]) / step
        if mode == "STEP":
            return values[k]
        return cubic(values, k, s, step) if mode == "CUBICSPLINE" else between(values[k], values[k + 1], s, path)

    def places(self, time):
        """Matrices of the nodes; without a time those of the file."""
        places = {}

        def place(k):
            if k not in places:
                node = self.json["nodes"][k]
                own = np.array(node["matrix"], float).reshape(4, 4).T if "matrix" in node else matrix(
                    self.value(k, "translation", time, node.get("translation", [0, 0, 0])),
                    self.value(k, "rotation", time, node.get("rotation", [0, 0, 0, 1])),
                    self.value(k, "scale", time, node.get("scale", [1, 1, 1])))
                places[k] = place(self.parent[k]) @ own if k in self.parent else own
            return places[k]
        return [place(k) for k in range(len(self.json["nodes"]))]

    def skin(self, time, bound=True):
        """All vertices at a time; `bound`: moved by their joints, else as the mesh has them."""
        places, parts = self.places(time), []
        for k, node in enumerate(self.json["nodes"]):
            for part in self.json["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
                found = part["attributes"]
                points = self.accessor(found["POSITION"])
                points = np.c_[points, np.ones(len(points))]
                if "skin" not in node or "JOINTS_0" not in found:
                    parts.append(points @ places[k].T)
                elif not bound:
                    parts.append(points)
                else:
                    skin = self.json["skins"][node["skin"]]
                    inverse = self.accessor(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
                    joints = np.array([places[joint] @ inverse[n] for n, joint in enumerate(skin["joints"])])
                    weights = self.accessor(found["WEIGHTS_0"])
                    weights /= np.maximum(weights.sum(1, keepdims=True), 1e-9)
                    own = joints[self.accessor(found["JOINTS_0"]).astype(int)]
                    parts.append(np.einsum("nk,nkij,nj->ni", weights, own, points))
        return np.vstack(parts)[:, :3]


# The vertices of what is shown, at rest and in each frame of a take, in the scene of Blender.
SCRIPT = r"""
import bpy, numpy, sys
source, target, take, seconds = sys.argv[sys.argv.index("--") + 1:]
for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
if source.endswith(".fbx"):
    bpy.ops.import_scene.fbx(filepath=source, anim_offset=0.0)
else:
    bpy.ops.wm.collada_import(filepath=source)
scene = bpy.context.scene
scene.render.fps_base = 1
meshes = [thing for thing in bpy.data.objects if thing.type == "MESH" and not thing.hide_viewport and not thing.hide_get()]
armatures = [thing for thing in bpy.data.objects if thing.type == "ARMATURE"]
for thing in bpy.data.objects:
    if thing.animation_data is None:
        continue
    for track in thing.animation_data.nla_tracks:
        track.mute = True
    for action in bpy.data.actions:
        if (action.name.startswith(thing.name + "|") and take in action.name.split("|")) or action.name in (take, f"{take}_{thing.name}"):
            thing.animation_data.action = action
ranges = [thing.animation_data.action.frame_range for thing in bpy.data.objects if thing.animation_data and thing.animation_data.action]
first, last = int(min(one[0] for one in ranges)), int(max(one[1] for one in ranges))

def vertices():
    graph, parts = bpy.context.evaluated_depsgraph_get(), []
    for thing in meshes:
        now = thing.evaluated_get(graph)
        mesh = now.to_mesh()
        points = numpy.empty(3 * len(mesh.vertices))
        mesh.vertices.foreach_get("co", points)
        parts.append(numpy.c_[points.reshape(-1, 3), numpy.ones(len(mesh.vertices))] @ numpy.array(now.matrix_world).T)
        now.to_mesh_clear()
    return numpy.vstack(parts)[:, :3]

for one in armatures:
    one.data.pose_position = "REST"
rest = vertices()
for one in armatures:
    one.data.pose_position = "POSE"
frames = []
for frame in range(first, min(last, first + int(float(seconds) * scene.render.fps)) + 1):
    scene.frame_set(frame)
    frames.append(vertices())
numpy.savez(target, rest=rest, frames=numpy.array(frames, "f4"), first=first, fps=scene.render.fps)
"""


class BlenderFile:
    def __init__(self, path, clip, seconds=10):
        with tempfile.TemporaryDirectory() as folder:
            link, target = Path(folder, "input" + path.suffix.lower()), Path(folder, "said.npz")
            link.symlink_to(path.resolve())
            subprocess.run(["blender", "-b", "--factory-startup", "--python-exit-code", "3", "--python-expr", SCRIPT, "--",
                            link, target, clip or "", str(seconds)], check=True, capture_output=True)
            said = np.load(target)
            self.rest, self.frames, self.first, self.fps = (said[name] for name in ("rest", "frames", "first", "fps"))
        self.end = (self.first + len(self.frames) - 1) / self.fps

    def skin(self, time, bound=True):
        if time is None:
            return self.rest
        place = np.clip(time * self.fps - self.first, 0, len(self.frames) - 1)
        k = min(int(place), len(self.frames) - 2) if len(self.frames) > 1 else 0
        return self.frames[k] + (place - k) * (self.frames[min(k + 1, len(self.frames) - 1)] - self.frames[k])


def file_of(path, clip):
    if path.suffix.lower() in (".fbx", ".dae"):
        return BlenderFile(path, clip)
    if {"KHR_draco_mesh_compression", "EXT_meshopt_compression"} & set(json_of(path)[0].get("extensionsUsed", [])):
        sys.exit(f"exact_skinning.py: {path.name}: compressed")
    return GltfFile(path, clip)


def found_in(rest, file):
    """The point of the skin at rest that each vertex is, and whether there is one."""
    size, tree, best = np.linalg.norm(np.ptp(rest, axis=0)), cKDTree(rest), None
    for points in (file.skin(None), file.skin(None, bound=False)):
        for turn in ROTATIONS:
            there = points @ turn.T
            there *= size / np.linalg.norm(np.ptp(there, axis=0))
            there += (rest.min(0) + rest.max(0) - there.min(0) - there.max(0)) / 2
            away, nearest = tree.query(there)
            if best is None or away.mean() < best[0]:
                best = away.mean(), nearest, away < 1e-3 * size
    return best[1], best[2]


def main():
    path, run = Path(sys.argv[1]), Path(sys.argv[2])
    scene = yaml.safe_load((run / "scene.yaml").read_text())
    motion, scale = scene["motion"], scene["skeleton"].get("scale", 1)
    file, start = file_of(path, motion.get("clip")), motion.get("start") or 0
    rows = [(float(row.get("timestep")), run / row.get("file")) for row in xml.parse(run / "surface.pvd").iter("DataSet")]
    rest = meshio.read(rows[0][1])
    rest = rest.points - rest.point_data["displacement"]
    nearest, there = found_in(rest, file)
    if there.mean() < MIN_FOUND:
        sys.exit(f"exact_skinning.py: {path.name}: {there.mean():.3f} of its vertices are found in the skin of {run}")

    def off(row, turn, preroll):
        exact = file.skin(start + max(0, row[0] - preroll))[there] @ turn.T * scale
        return np.linalg.norm(meshio.read(row[1]).points[nearest[there]] - exact, axis=1).mean()

    late = [rows[len(rows) * k // 8] for k in (5, 6, 7)]
    turn = min(ROTATIONS, key=lambda one: sum(off(row, one, 0) for row in late))
    given = motion.get("preroll")
    prerolls = np.arange(0, LONGEST_PREROLL, 0.1) if isinstance(given, str) else [given or 0]
    spread = [rows[len(rows) * k // 8] for k in range(1, 8)]  # the end may be still
    preroll = min(prerolls, key=lambda one: sum(off(row, turn, one) for row in spread))
    counted = [row for row in rows if 0 <= row[0] - preroll <= file.end - start]
    distances = [off(row, turn, preroll) for row in counted[::max(1, len(counted) // FRAMES)]]
    size = np.linalg.norm(np.ptp(rest, axis=0))
    print(f"{path.name}: {there.mean():.3f} of {len(there)} vertices found, preroll {preroll:.1f} s, "
          f"{np.mean(distances) / size:.4f} from exact skinning, at most {max(distances) / size:.4f}")


if __name__ == "__main__":
    main()
