#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Exported surfaces keep the look of their mesh: texture coordinates, normals, colors, materials, images.

usage: export_test.py BIN SOURCE      reads surface.glb and surface.obj by itself, from the formats' descriptions
"""
import json
import math
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

BIN, SOURCE = (Path(place).resolve() for place in sys.argv[1:3])
SCENE = """
body: {{mesh: {mesh}, radius: 0.03, {axes}}}
skeleton:
  bones:
    - {{name: lower, head: [0.1, 0.1, 0], tail: [0.1, 0.1, 0.3]}}
    - {{name: upper, parent: lower, tail: [0.1, 0.1, 0.6]}}
motion:
  tracks:
    - {{bone: upper, keys: [{{time: 0}}, {{time: 0.2, axis: [0, 1, 0], angle: 40}}]}}
solver: {{duration: 0.2}}
output: {{interval: 0.1, export: true}}
"""
SIZE = (0.2, 0.2, 0.6)  # x y z of the scene, m
MATERIALS = [{"name": "checked", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0},
              "doubleSided": True},
             {"name": "red", "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]},
              "emissiveFactor": [0.5, 0, 0]}]


def png():
    """Two by two pixels."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"\0\xff\0\0\0\xff\0" + b"\0\0\0\xff\xff\xff\xff"
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 2, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def box():
    """Its sides: axis, sign, and four corners with texture coordinates, in the scene's axes."""
    for axis in range(3):
        for sign in (0, 1):
            first, second = [other for other in range(3) if other != axis]
            corners = []
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                place = [0, 0, 0]
                place[axis], place[first], place[second] = sign * SIZE[axis], u * SIZE[first], v * SIZE[second]
                corners.append((tuple(place), (u / 4 + axis / 8, v / 2 + sign / 4)))
            outward = sign == (0 if axis == 1 else 1)
            yield axis, sign, corners if outward else corners[::-1]


def to_gltf(scene):
    """From x forward and z up to z forward and y up."""
    x, y, z = scene
    return y, z, x


class Builder:
    """The binary part of a GLB."""

    def __init__(self):
        self.bytes, self.views, self.accessors = b"", [], []

    def view(self, data):
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        self.bytes += data + b"\0" * (-len(data) % 4)
        return len(self.views) - 1

    def floats(self, rows, kind):
        accessor = {"bufferView": self.view(b"".join(struct.pack(f"<{len(row)}f", *row) for row in rows)),
                    "componentType": 5126, "count": len(rows), "type": kind}
        if kind == "VEC3":
            accessor |= {"min": [min(column) for column in zip(*rows)], "max": [max(column) for column in zip(*rows)]}
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def indices(self, all):
        self.accessors.append({"bufferView": self.view(struct.pack(f"<{len(all)}H", *all)), "componentType": 5123,
                               "count": len(all), "type": "SCALAR"})
        return len(self.accessors) - 1


def write_glb(path):
    """The box: its sides checked, its ends red; standing in a node that is moved and turned about y."""
    build = Builder()
    primitives = []
    for material, wanted in ((0, (0, 1)), (1, (2,))):
        places, normals, coordinates, colors, indices = [], [], [], [], []
        for axis, sign, corners in box():
            if axis not in wanted:
                continue
            normal = [0, 0, 0]
            normal[axis] = 2 * sign - 1
            first = len(places)
            indices += [first, first + 1, first + 2, first, first + 2, first + 3]
            for place, uv in corners:
                x, y, z = to_gltf(place)
                nx, ny, nz = to_gltf(normal)
                # The node turns by a quarter about y, x' = z and z' = -x, and then moves by 1 along x.
                places.append((-z, y, x - 1))
                normals.append((-nz, ny, nx))
                coordinates.append(uv)
                colors.append((1, 0.5, uv[0], 1))
        attributes = {"POSITION": build.floats(places, "VEC3"), "NORMAL": build.floats(normals, "VEC3"),
                      "TEXCOORD_0": build.floats(coordinates, "VEC2")}
        if material == 0:
            attributes["COLOR_0"] = build.floats(colors, "VEC4")
        primitives.append({"attributes": attributes, "indices": build.indices(indices), "material": material})
    half = math.sqrt(0.5)
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                "nodes": [{"name": "crate", "mesh": 0, "rotation": [0, half, 0, half], "translation": [1, 0, 0]}],
                "meshes": [{"primitives": primitives}], "materials": MATERIALS,
                "textures": [{"source": 0, "sampler": 0}], "samplers": [{"magFilter": 9728}],
                "images": [{"bufferView": build.view(png()), "mimeType": "image/png", "name": "check"}],
                "accessors": build.accessors, "bufferViews": build.views,
                "buffers": [{"byteLength": len(build.bytes)}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(build.bytes))
                     + struct.pack("<I4s", len(text), b"JSON") + text
                     + struct.pack("<I4s", len(build.bytes), b"BIN\0") + build.bytes)


class Glb:
    """A GLB, read."""

    def __init__(self, path):
        data = path.read_bytes()
        magic, version, size = struct.unpack_from("<4sII", data)
        assert (magic, version, size) == (b"glTF", 2, len(data))
        count, = struct.unpack_from("<I", data, 12)
        self.json, self.binary = json.loads(data[20:20 + count]), data[28 + count:]
        assert self.json["buffers"][0]["byteLength"] == len(self.binary)

    def view(self, index):
        view = self.json["bufferViews"][index]
        return self.binary[view["byteOffset"]:view["byteOffset"] + view["byteLength"]]

    def accessor(self, index):
        accessor = self.json["accessors"][index]
        parts = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        form = f"<{parts}{'f' if accessor['componentType'] == 5126 else 'I'}"
        rows = list(struct.iter_unpack(form, self.view(accessor["bufferView"])))
        assert len(rows) == accessor["count"], accessor
        for end, choose in (("min", min), ("max", max)):
            if end in accessor:
                assert all(math.isclose(a, b, abs_tol=1e-7) for a, b in
                           zip(accessor[end], map(choose, zip(*rows)))), (end, accessor)
        return [row[0] for row in rows] if parts == 1 else rows

    def corners(self, primitive, attribute):
        values = self.accessor(primitive["attributes"][attribute])
        return [values[i] for i in self.accessor(primitive["indices"])]


def simulate(folder, mesh, axes):
    scene = folder / "scene.yaml"
    scene.write_text(SCENE.format(mesh=mesh, axes=axes))
    done = subprocess.run([BIN / "sinew", "simulate", "--quiet", scene, "-o", folder / "run"],
                          capture_output=True, text=True, timeout=100)
    assert done.returncode == 0, done.stderr
    return folder / "run"


def close(one, other, tolerance=1e-6):
    return all(abs(a - b) < tolerance for a, b in zip(one, other))


def cross(a, b):
    return tuple(a[k - 2] * b[k - 1] - a[k - 1] * b[k - 2] for k in range(3))


class FromGlb(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        folder = Path(cls.scratch.name)
        write_glb(folder / "crate.glb")
        cls.run_folder = simulate(folder, "crate.glb", "up: y, forward: z")
        cls.glb = Glb(cls.run_folder / "surface.glb")
        cls.primitives = cls.glb.json["meshes"][0]["primitives"]
        # Of each corner of the mesh: what it looks like, by its place and normal in glTF's axes.
        cls.expected = {}
        for axis, sign, corners in box():
            normal = [0, 0, 0]
            normal[axis] = 2 * sign - 1
            for place, uv in corners:
                key = tuple(round(x, 4) for x in to_gltf(place) + to_gltf(normal))
                cls.expected[key] = (uv, 1 if axis == 2 else 0)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def test_materials_textures_and_images_are_those_of_the_mesh(self):
        self.assertEqual(self.glb.json["materials"], MATERIALS)
        self.assertEqual(self.glb.json["textures"], [{"source": 0, "sampler": 0}])
        self.assertEqual(self.glb.json["samplers"], [{"magFilter": 9728}])
        image, = self.glb.json["images"]
        self.assertEqual((image["mimeType"], image["name"]), ("image/png", "check"))
        self.assertEqual(self.glb.view(image["bufferView"]), png())

    def test_corners_keep_coordinates_normals_colors_and_materials(self):
        seen = set()
        for primitive in self.primitives:
            for place, normal, uv, color in zip(*(self.glb.corners(primitive, name) for name in
                                                  ("POSITION", "NORMAL", "TEXCOORD_0", "COLOR_0"))):
                key = tuple(round(x, 4) + 0.0 for x in place + normal)
                expected, material = self.expected[key]
                self.assertTrue(close(uv, expected), key)
                self.assertEqual(primitive["material"], material)
                self.assertTrue(close(color, (1, 0.5, uv[0], 1) if material == 0 else (1, 1, 1, 1)), color)
                seen.add(key)
        self.assertEqual(seen, set(self.expected))

    def test_vertices_are_split_along_edges_and_nowhere_else(self):
        places = self.glb.accessor(self.primitives[0]["attributes"]["POSITION"])
        self.assertEqual(len(places), 24)

    def test_normals_stay_those_of_the_faces_around_them(self):
        first = self.primitives[0]["attributes"]
        self.assertEqual(len(self.primitives[0]["targets"]), 2)
        for target in self.primitives[0]["targets"]:
            moved = {}
            for name in ("POSITION", "NORMAL"):
                moved[name] = [tuple(map(sum, zip(*rows))) for rows in
                               zip(self.glb.accessor(first[name]), self.glb.accessor(target[name]))]
            around = [(0, 0, 0)] * len(moved["NORMAL"])
            for primitive in self.primitives:
                corners = self.glb.accessor(primitive["indices"])
                for face in zip(corners[::3], corners[1::3], corners[2::3]):
                    a, b, c = (moved["POSITION"][i] for i in face)
                    across = cross(tuple(map(float.__sub__, b, a)), tuple(map(float.__sub__, c, a)))
                    for i in face:
                        around[i] = tuple(map(float.__add__, map(float, around[i]), across))
            for normal, mean in zip(moved["NORMAL"], around):
                length = math.sqrt(sum(part * part for part in mean))
                self.assertTrue(close(normal, [part / length for part in mean], 1e-4), (normal, mean))

    def test_obj_has_the_same_look(self):
        lines = [line.split() for line in (self.run_folder / "surface.obj").read_text().splitlines()]
        table = {name: [tuple(map(float, line[1:])) for line in lines if line[0] == name]
                 for name in ("v", "vt", "vn")}
        material, seen = None, set()
        for line in lines:
            if line[0] == "usemtl":
                material = ["checked", "red"].index(line[1])
            if line[0] != "f":
                continue
            for corner in line[1:]:
                point, uv, normal = (table[name][int(index) - 1] for name, index in
                                     zip(("v", "vt", "vn"), corner.split("/")))
                key = tuple(round(x, 4) + 0.0 for x in to_gltf(point) + to_gltf(normal))
                expected, its_material = self.expected[key]
                self.assertTrue(close((uv[0], 1 - uv[1]), expected), key)
                self.assertEqual(material, its_material)
                seen.add(key)
        self.assertEqual(seen, set(self.expected))
        self.assertIn(["o", "crate"], lines)


class FromObj(unittest.TestCase):
    def test_glb_has_the_coordinates_normals_and_materials_of_an_obj(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            text, count, expected = "mtllib crate.mtl\n", 0, {}
            (folder / "crate.mtl").write_text("# of a crate\nnewmtl checked\nKd 1 1 1\nmap_Kd -s 1 1 1 check.png\n"
                                              "newmtl red\nKa 0 0 0\nKd 1 0 0.5\nd 0.25\n")
            (folder / "check.png").write_bytes(png())
            for axis, sign, corners in box():
                normal = [0, 0, 0]
                normal[axis] = 2 * sign - 1
                text += f"usemtl {'red' if axis == 2 else 'checked'}\n"
                for place, uv in corners:
                    text += "v {} {} {}\n".format(*place) + "vt {} {}\n".format(*uv)
                    expected[tuple(round(x, 4) for x in to_gltf(place) + to_gltf(normal))] = (uv, axis == 2)
                text += "vn {} {} {}\n".format(*normal)
                text += "f " + " ".join(f"{i}/{i}/-1" for i in range(count + 1, count + 5)) + "\n"
                count += 4
            (folder / "crate.obj").write_text(text)
            run = simulate(folder, "crate.obj", "up: z, forward: x")
            glb, seen = Glb(run / "surface.glb"), set()
            for primitive in glb.json["meshes"][0]["primitives"]:
                material = glb.json["materials"][primitive["material"]]["name"]
                for place, normal, uv in zip(*(glb.corners(primitive, name) for name in
                                               ("POSITION", "NORMAL", "TEXCOORD_0"))):
                    key = tuple(round(x, 4) + 0.0 for x in place + normal)
                    (u, v), is_red = expected[key]
                    self.assertTrue(close(uv, (u, 1 - v)), key)
                    self.assertEqual(material, "red" if is_red else "checked")
                    seen.add(key)
            self.assertEqual(seen, set(expected))
            materials = {one["name"]: one for one in glb.json["materials"]}
            self.assertEqual(materials["red"]["pbrMetallicRoughness"]["baseColorFactor"], [1, 0, 0.5, 0.25])
            self.assertEqual(materials["red"]["alphaMode"], "BLEND")
            texture = materials["checked"]["pbrMetallicRoughness"]["baseColorTexture"]["index"]
            image = glb.json["images"][glb.json["textures"][texture]["source"]]
            self.assertEqual(glb.view(image["bufferView"]), png())


if __name__ == "__main__":
    unittest.main(argv=["export_test", "-v", *sys.argv[3:]])
