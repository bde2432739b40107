#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the seeds of the fuzz targets: small files of every form that each reader knows.

usage: make_seeds.py BIN CORPUS      folder of the programs, folder of the corpora
"""
import base64
import json
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

POINTS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]

BVH = """HIERARCHY
ROOT hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT chest
  {
    OFFSET 0 10 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 5 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.0333333
0 0 0 0 0 0 0 0 0
1 2 3 10 20 30 -10 5 90
"""

SCENES = {
    "small": """body: {mesh: a.obj, radius: 1/40}
skeleton:
  bones:
    - {name: lower, head: [0, 0, 0], tail: [0, 0, 0.3]}
    - {name: upper, parent: lower, tail: [0, 0, 0.7]}
motion:
  tracks:
    - bone: upper
      interpolation: step
      keys: [{time: 0}, {frame: 3, axis: [0, 1, 0], angle: 50}, {time: 1, euler: [1, 2, 3], translation: [0, 0, 1]}]
solver: {duration: 2, gravity: [0, 0, -9.81], precision: single}
output: {encoding: none, skin_lbs: true}
""",
    "world": """body:
  mesh: "a.obj"
  count: 1000
  packing: hcp
material: {model: bonded, poisson_ratio: 0.4}
skeleton: {bones: [{name: a, head: [0, 0, 0], tail: [0, 0, 1]}]}
binding:
  joint_zone: 2
  explicit: [{bone: a, ids: [0, 1]}, {low: [0, 0, 0], high: [1, 1, 1]}, {bone: a, center: [0, 0, 0], radius: 1}]
world:
  drag: 0.5
  obstacles:
    - {name: floor, shape: plane, friction: 0.5}
    - {name: ring, shape: capsule, from: [0, 0, 0], to: [1, 0, 0], radius: 0.1, bone: a}
    - {name: ball, shape: sphere, center: [1, 1, 1], radius: 0.1, keys: [{time: 0}, {time: 1, translation: [1, 0, 0]}]}
  pins: [{center: [0, 0, 0], radius: 0.1, bone: a}]
  fields: [{name: wind, acceleration: [0, 3, 0], low: [0, 0, 0], high: [1, 1, 1], falloff: 0.05}]
  muscles: [{name: m, bone: a, strength: 500, keys: [{time: 0, activation: 0}, {time: 1, activation: 1}]}]
"""}


def stl_text():
    facets = "".join("facet normal 0 0 0\nouter loop\n" +
                     "".join("vertex %g %g %g\n" % POINTS[corner] for corner in face) + "endloop\nendfacet\n"
                     for face in FACES)
    return f"solid seed\n{facets}endsolid seed\n".encode()


def stl_binary():
    facets = b"".join(struct.pack("<12fH", 0, 0, 0, *POINTS[a], *POINTS[b], *POINTS[c], 0) for a, b, c in FACES)
    return b"seed".ljust(80) + struct.pack("<I", len(FACES)) + facets


def ply(form):
    head = (f"ply\nformat {form} 1.0\ncomment seed\nelement vertex {len(POINTS)}\nproperty float x\n"
            "property float y\nproperty double z\nproperty uchar red\n"
            f"element face {len(FACES)}\nproperty list uchar int vertex_indices\nend_header\n").encode()
    if form == "ascii":
        return head + "".join("%g %g %g 7\n" % point for point in POINTS).encode() + \
            "".join("3 %d %d %d\n" % face for face in FACES).encode()
    order = "<" if "little" in form else ">"
    return head + b"".join(struct.pack(order + "ffdB", *point, 7) for point in POINTS) + \
        b"".join(struct.pack(order + "B3i", 3, *face) for face in FACES)


def gltf_parts():
    indices = struct.pack("<12H", *(corner for face in FACES for corner in face))
    data = indices + struct.pack("<12f", *(x for point in POINTS for x in point))
    return data, {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "scale": [2, 2, -2], "children": [1]}, {"translation": [1, 0, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}],
        "buffers": [{"byteLength": len(data)}],
        "bufferViews": [{"buffer": 0, "byteLength": 24}, {"buffer": 0, "byteOffset": 24, "byteLength": 48}],
        "accessors": [{"bufferView": 0, "componentType": 5123, "count": 12, "type": "SCALAR"},
                      {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 1]}]}


def gltf_looks():
    """With normals, texture coordinates, colors, a material and its image."""
    data, document = gltf_parts()
    png = b"\x89PNG\r\n\x1a\n"
    attributes = document["meshes"][0]["primitives"][0]["attributes"]
    for name, parts in (("NORMAL", 3), ("TEXCOORD_0", 2), ("TEXCOORD_1", 2), ("COLOR_0", 3)):
        document["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": 16 * parts})
        attributes[name] = len(document["accessors"])
        document["accessors"].append({"bufferView": attributes[name], "componentType": 5126, "count": 4,
                                      "type": f"VEC{parts}"})
        data += struct.pack(f"<{4 * parts}f", *(i / 8 for i in range(4 * parts)))
    document["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(png)})
    document["meshes"][0]["primitives"][0]["material"] = 0
    document |= {"materials": [{"name": "red", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
                 "textures": [{"source": 0}], "extensionsUsed": ["KHR_materials_unlit"],
                 "images": [{"bufferView": len(document["bufferViews"]) - 1, "mimeType": "image/png"},
                            {"uri": "data:image/png;base64," + base64.b64encode(png).decode()}],
                 "buffers": [{"byteLength": len(data) + len(png)}]}
    return data + png, document


def gltf_text():
    data, document = gltf_parts()
    document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    return json.dumps(document, indent=1).encode()


def gltf_binary(data, document):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def gltf_skin():
    """With two joints, of which one is turned by a clip."""
    data, document = gltf_parts()
    identity = [float(i % 5 == 0) for i in range(16)]
    attributes = document["meshes"][0]["primitives"][0]["attributes"]

    def accessor(content, component, count, kind, **more):
        nonlocal data
        document["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(content)})
        document["accessors"].append({"bufferView": len(document["bufferViews"]) - 1, "componentType": component,
                                      "count": count, "type": kind, **more})
        data += content
        return len(document["accessors"]) - 1

    attributes["JOINTS_0"] = accessor(struct.pack("<16H", *4 * [0, 1, 0, 0]), 5123, 4, "VEC4")
    attributes["WEIGHTS_0"] = accessor(struct.pack("<16f", *4 * [0.75, 0.25, 0, 0]), 5126, 4, "VEC4")
    bind = accessor(struct.pack("<32f", *2 * identity), 5126, 2, "MAT4")
    times = accessor(struct.pack("<2f", 0, 1), 5126, 2, "SCALAR", min=[0], max=[1])
    turns = accessor(struct.pack("<8f", 0, 0, 0, 1, 0, 0, 0.6, 0.8), 5126, 2, "VEC4")
    document["nodes"] = [{"mesh": 0, "skin": 0}, {"name": "a", "children": [2]}, {"name": "b", "translation": [0, 1, 0]}]
    document |= {"scenes": [{"nodes": [0, 1]}], "skins": [{"joints": [1, 2], "inverseBindMatrices": bind}],
                 "animations": [{"samplers": [{"input": times, "output": turns}],
                                 "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}}]}],
                 "buffers": [{"byteLength": len(data)}]}
    return data, document


PACKERS = {"quantized": ["gltfpack", "-kn"], "meshopt": ["gltfpack", "-c", "-kn"], "draco": ["draco_transcoder"]}


def packed(glb, program, *options):
    with tempfile.TemporaryDirectory() as temporary:
        plain, result = Path(temporary) / "plain.glb", Path(temporary) / "packed.glb"
        plain.write_bytes(glb)
        subprocess.run([program, "-i", plain, "-o", result, *options], check=True, stdout=subprocess.DEVNULL)
        return result.read_bytes()


def vtk_array(name, kind, values, components=1):
    return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="ascii">' +
            " ".join("%g" % value for value in values) + "</DataArray>")


def vtk_xml(kind, head, within):
    return (f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64"><{kind}{head}>'
            f"{within}</{kind}></VTKFile>\n").encode()


def vtk_files():
    """Of each kind of grid, legacy and XML."""
    flat = [x for point in POINTS for x in point]
    corners = [corner for face in FACES for corner in face]
    text = "# vtk DataFile Version {}\nseed\n{}\nDATASET {}\n"
    places = " ".join(map(str, flat))
    distances = [abs(i % 3 - 1) + abs(i // 3 % 3 - 1) + abs(i // 9 - 1) - 0.6 for i in range(27)]
    extent = '"0 2 0 2 0 2"'
    polygons = "".join("3 %d %d %d\n" % face for face in FACES)
    yield "polygons.vtk", (text.format("3.0", "ASCII", "POLYDATA") + f"POINTS 4 float\n{places}\nMETADATA\n\n"
                           f"POLYGONS 4 16\n{polygons}TRIANGLE_STRIPS 1 5\n4 0 1 2 3\nPOINT_DATA 4\n").encode()
    yield "cells.vtk", (text.format("5.1", "ASCII", "UNSTRUCTURED_GRID") + f"POINTS 4 double\n{places}\nCELLS 2 4\n"
                        "OFFSETS vtktypeint64\n0 4\nCONNECTIVITY vtktypeint64\n0 1 2 3\nCELL_TYPES 1\n10\nCELL_DATA 1\n"
                        "SCALARS MaterialIds int 1\nLOOKUP_TABLE default\n7\n").encode()
    yield "binary.vtk", (text.format("4.2", "BINARY", "UNSTRUCTURED_GRID") + "POINTS 4 float\n").encode() + struct.pack(
        ">12f", *flat) + b"\nCELLS 1 5\n" + struct.pack(">5i", 4, 0, 1, 2, 3) + b"\nCELL_TYPES 1\n" + struct.pack(">i", 10)
    image = text.format("3.0", "ASCII", "STRUCTURED_POINTS") + "DIMENSIONS 3 3 3\nORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 27\n"
    values = " ".join("%g" % value for value in distances)
    yield "image.vtk", f"{image}SCALARS d float 1\nLOOKUP_TABLE default\n{values}\n".encode()
    yield "field.vtk", f"{image}FIELD FieldData 1\nd 1 27 double\n{values}\n".encode()
    points = "<Points>" + vtk_array("p", "Float32", flat, 3) + "</Points>"
    yield "a.vtp", vtk_xml("PolyData", "", '<Piece NumberOfPoints="4" NumberOfPolys="4">' + points + "<Polys>" + vtk_array(
        "connectivity", "Int64", corners) + vtk_array("offsets", "Int64", [3, 6, 9, 12]) + "</Polys></Piece>")
    piece = ('<Piece NumberOfPoints="4" NumberOfCells="1">' + points + "<Cells>" + vtk_array(
        "connectivity", "Int64", range(4)) + vtk_array("offsets", "Int64", [4]) + vtk_array("types", "UInt8", [10]) + "</Cells></Piece>")
    yield "a.vtu", vtk_xml("UnstructuredGrid", "", piece)
    yield "pieces.vtu", vtk_xml("UnstructuredGrid", "", 2 * piece)
    yield "a.vti", vtk_xml("ImageData", f' WholeExtent={extent} Origin="0 0 0" Spacing="1 2 3"', f"<Piece Extent={extent}>"
                           '<PointData Scalars="d">' + vtk_array("d", "Float64", distances) + "</PointData></Piece>")


def frd(kind):
    """A result of CalculiX: one element of that type with its nodes on a line, at one moment."""
    count = {1: 8, 3: 4, 4: 20, 6: 10}[kind]
    numbers = lambda values: "".join("%12.5E" % value for value in values)
    nodes = "".join(" -1%10d%s\n" % (k + 1, numbers((k % 3, k % 5, k))) for k in range(count))
    names = ["%10d" % (k + 1) for k in range(count)]
    lines = "".join(" -2" + "".join(names[k:k + 10]) + "\n" for k in range(0, count, 10))
    text = f"    1C\n    2C{count:30d}{1:38d}\n{nodes} -3\n    3C{1:30d}{1:38d}\n -1{1:10d}{kind:5d}    0    1\n{lines} -3\n"
    for name, width in ("DISP", 3), ("STRESS", 6):
        text += f"  100CL  101 1.000000000{count:12d}                     0    1           1\n -4  {name:8s}    4    1\n"
        text += "".join(" -1%10d%s\n" % (k + 1, numbers([0.01 * k] * width)) for k in range(count)) + " -3\n"
    return (text + " 9999\n").encode()


MESSAGES = (
    {"do": "turn", "bone": "b", "axis": [0, 1, 0], "degrees": 30, "id": 1}, {"do": "aim", "bone": 1, "to": [1, 0, 2]},
    {"do": "reach", "bone": "b", "to": [1, 0.5, 1.5]}, {"do": "move", "bone": 0, "to": [0.5, 0.6, 0]},
    {"do": "grab", "bone": "a"}, {"do": "release"}, {"do": "undo"},
    {"do": "pull", "particle": 3, "to": [0.1, 0, 0], "relative": True, "id": 2}, {"do": "pull", "to": None},
    {"do": "set", "key": "tip", "value": 2, "id": 3}, {"do": "set", "key": "m", "value": 0.5},
    {"do": "set", "key": "friction of floor", "value": 0}, {"do": "set", "key": "solver.gravity", "value": "[0, 0, -9.81]"},
    {"do": "set", "settings": {"material.young_modulus": 2e4, "material.damping_ratio": "0.1"}, "id": "x"},
    {"do": "show", "particles": True, "skin": False, "field": "speed", "holds_range": True}, {"do": "pace", "value": 0.5},
    {"do": "step"}, {"do": "seek", "time": 0.1}, {"do": "rewind", "seconds": 0.05, "id": 4}, {"do": "reset"},
    {"do": "play"}, {"do": "pause"}, {"do": "save", "name": "mine", "id": 5}, {"do": "hello"})

RECORD = b"""{
  "program": "sinew", "version": "0.1.0", "command": ["sinew-simulate", "few.yaml"], "host": "here",
  "status": "finished", "particles": 5, "frames": 3, "steps": 12, "time_step": 0.0035, "state_hash": "0123456789abcdef",
  "seconds": {"filling": 0.01, "stepping": 1e-3}, "material": {"model": "paper", "radius": 0.25},
  "arrays": [{"name": "bone", "unit": "", "series": ["particles", "\\u00e9"]}]
}
"""


def run_files(binaries, put):
    """What runs of a few particles leave."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        cube = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        quads = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]
        (folder / "a.obj").write_text("".join("v %d %d %d\n" % point for point in cube) +
                                      "".join("f %d %d %d %d\n" % quad for quad in quads))
        (folder / "few.yaml").write_text("body: {mesh: a.obj, count: 5}\nskeleton: {bones: [{name: a, "
                                         "head: [0.5, 0.5, 0], tail: [0.5, 0.5, 1]}]}\nsolver: {duration: 0.04}\n"
                                         "output: {checkpoint_interval: 0}\n")
        for encoding in ("zlib", "lz4", "raw", "none"):
            out = folder / encoding
            subprocess.run([binaries / "sinew-simulate", folder / "few.yaml", "-o", out, "--quiet", "--set",
                            f"output.encoding={encoding}"], check=True, stdout=subprocess.DEVNULL)
            for series in ("particles", "surface", "bones", "frames"):
                put("vtu", f"{series}_{encoding}", (out / f"{series}/{series}_000001.vtu").read_bytes())
        put("pvd", "run", (out / "particles.pvd").read_bytes())
        put("checkpoint", "double", (out / "checkpoint/a.bin").read_bytes())
        for name, words in [("single", "solver.precision=single"), ("bonded", "material.model=bonded")]:
            subprocess.run([binaries / "sinew-simulate", folder / "few.yaml", "-o", folder / name, "--quiet",
                            "--set", words], check=True, stdout=subprocess.DEVNULL)
            put("checkpoint", name, (folder / name / "checkpoint/a.bin").read_bytes())


def main():
    binaries, corpus = Path(sys.argv[1]).resolve(), Path(sys.argv[2])

    def put(target, name, content):
        (corpus / target).mkdir(parents=True, exist_ok=True)
        (corpus / target / name).write_bytes(content)

    put("bvh", "two_joints", BVH.encode())
    points = "".join("%g %g %g\n" % point for point in POINTS)
    put("obj", "tetrahedron", ("".join("v " + line + "\n" for line in points.splitlines()) + "vt 0 0\nvn 0 0 1\n" +
                               "".join("f %d/1/1 %d//1 %d\n" % tuple(c + 1 for c in face) for face in FACES) +
                               "f -1 -2 \\\n -3\n").encode())
    put("off", "tetrahedron", ("OFF\n4 4 0\n" + points + "".join("3 %d %d %d\n" % face for face in FACES)).encode())
    put("off", "colored", ("COFF 4 1 0\n" + "".join(line + " 1 0 0 1\n" for line in points.splitlines()) +
                            "3 0 1 2 255 0 0\n").encode())
    put("stl", "text", stl_text())
    put("stl", "binary", stl_binary())
    for form in ("ascii", "binary_little_endian", "binary_big_endian"):
        put("ply", form, ply(form))
    put("gltf", "embedded.gltf", gltf_text())
    put("gltf", "binary.glb", gltf_binary(*gltf_parts()))
    put("gltf", "looks.glb", gltf_binary(*gltf_looks()))
    put("gltf", "skin.glb", gltf_binary(*gltf_skin()))
    for name, command in PACKERS.items():
        put("gltf", f"{name}.glb", packed(gltf_binary(*gltf_skin()), *command))
    for name, content in vtk_files():
        put("vtk", name, content)
    for name, kind in ("hexahedron8", 1), ("hexahedron20", 4), ("tetrahedron4", 3), ("tetrahedron10", 6):
        put("frd", name, frd(kind))
    for name, text in SCENES.items():
        put("scene", name, text.encode())
    put("record", "run", RECORD)
    put("play", "all_actions", "\n".join(map(json.dumps, MESSAGES)).encode())
    run_files(binaries, put)


if __name__ == "__main__":
    sys.exit(main())
