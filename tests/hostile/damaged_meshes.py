# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged OBJ, OFF, STL, PLY and VTK files, from good ones of a tetrahedron."""
import math
import struct

from damage import FOREIGN, NOT_FILES, cut_short, replaced

POINTS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
LINES = "".join("%d %d %d\n" % point for point in POINTS)

OBJ = ("".join("v %d %d %d\n" % point for point in POINTS) +
       "".join("f %d %d %d\n" % tuple(c + 1 for c in face) for face in FACES)).encode()
OFF = ("OFF\n4 4 0\n" + LINES + "".join("3 %d %d %d\n" % face for face in FACES)).encode()
STL_TEXT = ("solid a\n" + "".join(
    "facet normal 0 0 0\nouter loop\n" + "".join("vertex %d %d %d\n" % POINTS[c] for c in face) +
    "endloop\nendfacet\n" for face in FACES) + "endsolid a\n").encode()
STL = b"seed".ljust(80) + struct.pack("<I", 4) + b"".join(
    struct.pack("<12fH", 0, 0, 0, *(x for c in face for x in POINTS[c]), 0) for face in FACES)
PLY_HEAD = (b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
            b"element face 4\nproperty list uchar int vertex_indices\nend_header\n")
PLY = PLY_HEAD + LINES.encode() + "".join("3 %d %d %d\n" % face for face in FACES).encode()
PLY_BINARY = (PLY_HEAD.replace(b"ascii", b"binary_little_endian") +
              b"".join(struct.pack("<3f", *point) for point in POINTS) +
              b"".join(struct.pack("<B3i", 3, *face) for face in FACES))
VTK_HEAD = b"# vtk DataFile Version 3.0\nseed\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
VTK = VTK_HEAD + LINES.encode() + b"CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n"
VTK_BINARY = (VTK_HEAD.replace(b"ASCII", b"BINARY") + b"".join(struct.pack(">3f", *point) for point in POINTS) +
              b"\nCELLS 1 5\n" + struct.pack(">5i", 4, 0, 1, 2, 3) + b"\nCELL_TYPES 1\n" + struct.pack(">i", 10))
VTI = (b'<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian"><ImageData WholeExtent="0 2 0 2 0 2" Origin="0 0 0" '
       b'Spacing="1 1 1"><Piece Extent="0 2 0 2 0 2"><PointData Scalars="d"><DataArray type="Float32" Name="d" format="ascii">' +
       b"1 " * 13 + b"-1 " + b"1 " * 13 + b"</DataArray></PointData></Piece></ImageData></VTKFile>\n")


def obj():
    files = dict(FOREIGN) | NOT_FILES
    vertex = {"nan": "nan 0 0", "infinite": "inf 0 0", "too_large": "1e999 0 0", "two_numbers": "0 0", "none": "",
              "words": "a b c", "comma": "0,0 0 0", "hexadecimal": "0x1p2 0 0", "two_signs": "--1 0 0",
              "zero_byte": "0 \0 0", "not_utf8": "0 \xff 0", "overflowing_exponent": "1e99999999999 0 0"}
    for name, text in vertex.items():
        files[f"vertex_{name}"] = replaced(OBJ, "v 0 0 0", f"v {text}".encode("latin-1"))
    face = {"zero": "0 1 2", "beyond": "1 2 5", "far_beyond": "1 2 99999999999999999999", "before": "1 2 -5",
            "fraction": "1.5 2 3", "words": "a b c",
            "no_index": "/1 /2 /3", "nan": "nan 1 2", "least": "1 2 -9223372036854775808", "sign": "1 2 -",
            "half_a_slash": "1 2 x/1", "above_32_bits": "1 2 4294967297"}
    for name, text in face.items():
        files[f"face_{name}"] = replaced(OBJ, "f 1 3 2", f"f {text}")
    files["no_faces"] = OBJ[:OBJ.index(b"f ")]
    files["no_vertices"] = OBJ[OBJ.index(b"f "):]
    files["comments"] = b"# a mesh\n" * 100
    files["joined_for_ever"] = OBJ + b"f 1 2 \\\n" * 1000
    files["bytes_within"] = OBJ[:20] + bytes(range(128, 256)) + OBJ[20:]
    return OBJ, files


def off():
    files = dict(FOREIGN) | NOT_FILES | cut_short(OFF)
    counts = {"negative": "-4 4 0", "negative_faces": "4 -4 0", "huge": "999999999999 4 0", "huge_faces": "4 4000000000 0",
              "beyond_64_bits": "99999999999999999999999 4 0", "fraction": "4.5 4 0", "words": "four four 0",
              "one_too_many": "5 4 0", "one_face_too_many": "4 5 0", "one_too_few": "3 4 0", "nan": "nan 4 0",
              "none": "", "no_faces": "4 0 0", "no_points": "0 4 0", "nothing": "0 0 0", "swapped": "12 1 0"}
    for name, text in counts.items():
        files[f"counts_{name}"] = replaced(OFF, "4 4 0", text)
    face = {"beyond": "3 0 2 4", "negative": "3 0 2 -1", "no_corners": "0", "negative_size": "-3 0 2 1",
            "huge_size": "2000000000 0 2 1", "fraction": "3 0 2 1.5", "nan": "3 nan 2 1", "words": "a b c d"}
    for name, text in face.items():
        files[f"face_{name}"] = replaced(OFF, "3 0 2 1", text)
    for name, text in {"nan": "nan 0 0", "infinite": "0 -inf 0", "too_large": "0 0 1e999", "words": "a 0 0", "short": "0 0"}.items():
        files[f"vertex_{name}"] = replaced(OFF, "0 0 0\n", text + "\n")
    files["binary"] = replaced(OFF, "OFF", "OFF BINARY")
    files["of_four_dimensions"] = replaced(OFF, "OFF", "4OFF")
    files["of_n_dimensions"] = replaced(OFF, "OFF", "nOFF\n7")
    files["magic"] = replaced(OFF, "OFF", "OFX")
    return OFF, files


def stl():
    files = dict(FOREIGN) | NOT_FILES | {f"text_{name}": text for name, text in cut_short(STL_TEXT).items()}
    files |= cut_short(STL)
    count = STL.index(struct.pack("<I", 4), 80)
    for name, number in {"one_more": 5, "huge": 2 ** 32 - 1, "half": 2 ** 31, "none": 0, "swapped": 4 << 24}.items():
        files[f"count_{name}"] = STL[:count] + struct.pack("<I", number) + STL[count + 4:]
    for name, number in {"nan": math.nan, "infinite": math.inf, "minus_infinite": -math.inf}.items():
        files[f"corner_{name}"] = STL[:96] + struct.pack("<f", number) + STL[100:]
    for name, (old, new) in {"nan": ("vertex 0 0 0", "vertex nan 0 0"), "infinite": ("vertex 0 0 0", "vertex 0 inf 0"),
                             "too_large": ("vertex 0 0 0", "vertex 0 0 1e999"), "words": ("vertex 0 0 0", "vertex a b c"),
                             "two_numbers": ("vertex 0 0 0", "vertex 0 0"), "two_corners": ("vertex 0 0 0\n", ""),
                             "four_corners": ("endloop", "vertex 1 1 1\nendloop"), "open_facet": ("endfacet\n", ""),
                             "misspelt": ("vertex", "vertx"), "no_facets": (STL_TEXT[8:-11], "")}.items():
        files[f"text_{name}"] = replaced(STL_TEXT, old, new)
    return STL, files


def ply():
    files = dict(FOREIGN) | NOT_FILES | cut_short(PLY) | {f"binary_{n}": t for n, t in cut_short(PLY_BINARY).items()}
    head = {"format": ("ascii 1.0", "text 1.0"), "version": ("ascii 1.0", "ascii 9.0"), "no_format": ("format ascii 1.0\n", ""),
            "endless": ("end_header\n", ""), "no_x": ("property float x\n", ""), "two_x": ("property float y", "property float x"),
            "type": ("float x", "quad x"), "list_of_x": ("property float x", "property list uchar float x"),
            "count_negative": ("vertex 4", "vertex -4"), "count_huge": ("vertex 4", "vertex 999999999999999"),
            "count_beyond_64_bits": ("vertex 4", "vertex 99999999999999999999999"), "count_fraction": ("vertex 4", "vertex 4.5"),
            "count_word": ("vertex 4", "vertex four"), "one_more": ("vertex 4", "vertex 5"), "one_less": ("vertex 4", "vertex 3"),
            "faces_huge": ("face 4", "face 4000000000"), "one_face_more": ("face 4", "face 5"), "faces_negative": ("face 4", "face -1"),
            "property_of_nothing": ("element vertex 4\n", ""), "no_vertices": ("element vertex", "element point"),
            "two_vertices": ("element face", "element vertex"), "no_faces": ("element face", "element edge"),
            "floats_as_counts": ("list uchar int", "list float int"), "corners_of_floats": ("uchar int", "uchar float"),
            "no_corners": ("vertex_indices", "colors"), "words_missing": ("property float y", "property"),
            "magic": ("ply\n", "plz\n"), "unknown_word": ("element face", "elephant face")}
    for name, (old, new) in head.items():
        files[f"head_{name}"] = replaced(PLY, old, new)
    body = {"beyond": ("3 0 2 1", "3 0 2 4"), "negative": ("3 0 2 1", "3 0 2 -1"),
            "no_corners": ("3 0 2 1", "0"), "huge_size": ("3 0 2 1", "255 0 2 1"), "size_beyond_type": ("3 0 2 1", "300 0 2 1"),
            "words": ("3 0 2 1", "a b c d"), "fraction": ("3 0 2 1", "3 0 2 1.5"), "vertex_nan": ("0 0 0\n", "nan 0 0\n"),
            "vertex_infinite": ("0 0 0\n", "0 inf 0\n"), "vertex_short": ("0 0 0\n", "0 0\n"),
            "vertex_too_large": ("0 0 0\n", "0 0 1e999\n")}
    for name, (old, new) in body.items():
        files[f"body_{name}"] = replaced(PLY, old, new)
    start = PLY_BINARY.index(b"end_header\n") + 11
    for name, number in {"nan": math.nan, "infinite": math.inf}.items():
        files[f"binary_{name}"] = PLY_BINARY[:start] + struct.pack("<f", number) + PLY_BINARY[start + 4:]
    face = start + 48
    for name, record in {"beyond": (3, 0, 2, 4), "negative": (3, 0, -1, 1), "least": (3, 0, 2, -2 ** 31), "two_corners": (2, 0, 2, 1),
                         "huge_size": (255, 0, 2, 1), "no_corners": (0, 0, 2, 1)}.items():
        files[f"binary_{name}"] = PLY_BINARY[:face] + struct.pack("<B3i", *record) + PLY_BINARY[face + 13:]
    files["binary_turned"] = PLY_BINARY.replace(b"little", b"big")
    files["endless_head"] = PLY.replace(b"end_header", b"comment " + b"x" * 5_000_000)
    files["many_properties"] = PLY.replace(b"element face", b"property float w\n" * 200_000 + b"element face")
    return PLY, files


def vtk():
    files = dict(FOREIGN) | NOT_FILES | {f"binary_{n}": t for n, t in cut_short(VTK_BINARY, 6).items()}
    files |= {f"text_{n}": t for n, t in cut_short(VTK, 6).items()}
    changes = {"magic": ("# vtk", "# vtx"), "version": ("3.0", "three"), "coding": ("ASCII", "EBCDIC"), "no_dataset": ("DATASET", "DATABASE"),
               "kind": ("UNSTRUCTURED_GRID", "STRUCTURED_GRID"), "unknown_kind": ("UNSTRUCTURED_GRID", "GRID"), "points_huge": ("POINTS 4", "POINTS 1000000000000"),
               "points_negative": ("POINTS 4", "POINTS -4"), "points_fraction": ("POINTS 4", "POINTS 4.5"), "points_word": ("POINTS 4", "POINTS four"),
               "one_more": ("POINTS 4", "POINTS 5"), "one_less": ("POINTS 4", "POINTS 3"), "type": ("float", "quad"), "nan": ("0 0 0\n", "nan 0 0\n"),
               "infinite": ("0 0 0\n", "0 inf 0\n"), "too_large": ("0 0 0\n", "0 0 1e999\n"), "cells_huge": ("CELLS 1 5", "CELLS 1000000000000 5"),
               "size_huge": ("CELLS 1 5", "CELLS 1 5000000000000"), "size_more": ("CELLS 1 5", "CELLS 1 6"), "size_less": ("CELLS 1 5", "CELLS 1 4"),
               "cell_of_more": ("\n4 0", "\n5 0"), "cell_of_less": ("\n4 0", "\n3 0"), "cell_negative": ("\n4 0", "\n-4 0"), "beyond": ("0 1 2 3", "0 1 2 4"),
               "before": ("0 1 2 3", "0 1 2 -1"), "half": ("0 1 2 3", "0 1 2 1.5"), "no_types": ("CELL_TYPES 1\n10\n", ""), "two_types": ("CELL_TYPES 1\n10", "CELL_TYPES 2\n10 10"),
               "polyhedron": ("1\n10\n", "1\n42\n"), "vertex": ("1\n10\n", "1\n1\n"), "unknown_cell": ("1\n10\n", "1\n9999\n"), "word": ("CELLS 1 5", "SHELLS 1 5"),
               "version_five": ("3.0", "5.1"), "no_points": (VTK[VTK.index(b"POINTS"):VTK.index(b"CELLS")], "")}
    for name, (old, new) in changes.items():
        files[name] = replaced(VTK, old, new)
    return VTK, files


def vti():
    files = dict(FOREIGN) | NOT_FILES | cut_short(VTI)
    changes = {"extent_huge": ('WholeExtent="0 2 0 2 0 2"', 'WholeExtent="0 9999 0 9999 0 9999"'), "extent_larger": ('WholeExtent="0 2', 'WholeExtent="0 3'),
               "extent_turned": ('WholeExtent="0 2', 'WholeExtent="2 0'), "extent_words": ('WholeExtent="0 2', 'WholeExtent="a 2'), "flat": ('WholeExtent="0 2', 'WholeExtent="0 0'),
               "no_extent": ("WholeExtent", "Extent"), "spacing": ('Spacing="1 1 1"', 'Spacing="1 nan 1"'), "no_piece": ("Piece", "Peace"), "no_array": ("DataArray", "Data"),
               "one_sign": ("-1", "1"), "nan": ("-1", "nan"), "word": ("-1", "minus"), "other_grid": ('type="ImageData"', 'type="PolyData"'),
               "compressor": ("<VTKFile", '<VTKFile compressor="vtkLZMADataCompressor"'), "big_endian": ("LittleEndian", "BigEndian"), "string": ("Float32", "String"),
               "three_components": ('Name="d"', 'Name="d" NumberOfComponents="3"')}
    for name, (old, new) in changes.items():
        files[name] = VTI.replace(old.encode(), new.encode())
    return VTI, files
