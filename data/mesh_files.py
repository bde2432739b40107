# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads and writes triangle meshes: points (x, y, z) and faces (three corners, from 0)."""

import struct

PLY_TYPES = {"float": "f", "double": "d"}


def write_obj(path, comment, points, faces):
    lines = [f"# {line}" for line in comment]
    lines += ["v " + " ".join(repr(x) for x in point) for point in points]
    lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in faces]
    path.write_text("\n".join(lines) + "\n", encoding="ascii", newline="\n")


def write_ply(path, comment, points, faces, real="double"):
    """Little-endian binary; `real` is the type of the coordinates, float or double."""
    header = ["ply", "format binary_little_endian 1.0", *(f"comment {line}" for line in comment),
              f"element vertex {len(points)}", *(f"property {real} {axis}" for axis in "xyz"),
              f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    point, face = struct.Struct("<3" + PLY_TYPES[real]), struct.Struct("<B3i")
    path.write_bytes(("\n".join(header) + "\n").encode("ascii")
                     + b"".join(point.pack(*p) for p in points)
                     + b"".join(face.pack(3, *f) for f in faces))


def read_mesh(path):
    """A mesh of triangles: an OBJ file, or a PLY file as write_ply makes it."""
    if path.suffix.lower() == ".ply":
        return read_ply(path)
    if path.suffix.lower() == ".obj":
        return read_obj(path)
    raise ValueError(f"{path}: neither .obj nor .ply; export the mesh as OBJ")


def read_obj(path):
    points, faces = [], []
    for line in path.read_text(encoding="utf-8").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append(tuple(float(word) for word in words[1:4]))
        if words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) for word in words[1:]]
            if len(corners) != 3:
                raise ValueError(f"{path}: a face has {len(corners)} corners; triangulate the mesh")
            faces.append(tuple(c - 1 if c > 0 else len(points) + c for c in corners))
    return points, faces


def read_ply(path):
    content = path.read_bytes()
    head, _, body = content.partition(b"end_header\n")
    lines = head.decode("ascii").splitlines()
    properties = [line.split()[1:] for line in lines if line.startswith("property")]
    counts = {line.split()[1]: int(line.split()[2]) for line in lines if line.startswith("element")}
    reals = {kind for kind, *_ in properties[:3]}
    if ("format binary_little_endian 1.0" not in lines or list(counts) != ["vertex", "face"]
            or [name for _, name in properties[:3]] != ["x", "y", "z"] or len(reals) != 1
            or not reals <= set(PLY_TYPES) or properties[3][:3] != ["list", "uchar", "int"]):
        raise ValueError(f"{path}: a PLY file of another kind; export the mesh as OBJ")
    point, face = struct.Struct("<3" + PLY_TYPES[reals.pop()]), struct.Struct("<B3i")
    split = counts["vertex"] * point.size
    faces = list(face.iter_unpack(body[split:split + counts["face"] * face.size]))
    if any(corners != 3 for corners, *_ in faces):
        raise ValueError(f"{path}: has faces that are no triangles; triangulate the mesh")
    return list(point.iter_unpack(body[:split])), [tuple(corners) for _, *corners in faces]
