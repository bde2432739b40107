# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged files of a run's folder: VTU, PVD, checkpoints and the record, from those of a whole run, whose
arrays are neither compressed nor many.
"""
import base64
import json
import re
import struct

from damage import FOREIGN, NOT_FILES, cut_short, replaced

DROP = object()


# Arrays.

def array(text, name):
    """The place of the encoded values of an array."""
    found = re.search(rb'<DataArray [^>]*Name="%s"[^>]*>\n([^\n]*)\n' % name.encode(), text)
    assert found, name
    return found.span(1)


def with_values(text, name, change):
    """`text` with the bytes of an array changed, and their count."""
    start, end = array(text, name)
    values = change(base64.b64decode(text[start:end])[8:])
    return text[:start] + base64.b64encode(struct.pack("<Q", len(values)) + values) + text[end:]


def with_header(text, name, header):
    """`text` with other bytes for the count of an array's bytes."""
    start, end = array(text, name)
    return text[:start] + base64.b64encode(header + base64.b64decode(text[start:end])[8:]) + text[end:]


def with_number(name, number, kind="<f", at=0):
    return lambda text: with_values(text, name, lambda values: values[:at] + struct.pack(kind, number) +
                                    values[at + struct.calcsize(kind):])


def without_array(text, name):
    found = re.search(rb'<DataArray [^>]*Name="%s".*?</DataArray>\n' % name.encode(), text, re.DOTALL)
    return text[:found.start()] + text[found.end():]


def swap(old, new):
    return lambda text: replaced(text, old, new)


def of_tag(name, old, new):
    """Changes an attribute of the tag of an array."""
    def change(text):
        tag = re.search(rb'<DataArray [^>]*Name="%s"[^>]*>' % name.encode(), text)
        return text[:tag.start()] + replaced(tag.group(), old, new) + text[tag.end():]
    return change


VTU = {
    "type": swap('type="UnstructuredGrid"', 'type="PolyData"'), "no_type": swap(' type="UnstructuredGrid"', ""),
    "root": lambda text: text.replace(b"VTKFile", b"VTKFill"), "no_grid": lambda text: text.replace(b"<UnstructuredGrid>", b"<Grid>").replace(b"</UnstructuredGrid>", b"</Grid>"),
    "turned": swap("LittleEndian", "BigEndian"), "short_words": swap("UInt64", "UInt32"),
    "compressor": swap("<VTKFile ", '<VTKFile compressor="vtkZLibDataCompressor" '), "compressor_unknown": swap("<VTKFile ", '<VTKFile compressor="mine" '),
    "doctype": swap("<VTKFile", '<!DOCTYPE a [<!ENTITY b "cccccccccc">]><VTKFile'), "comment": swap("<Piece", "<!-- a <Piece"),
    "cdata": swap("<Piece", "<![CDATA[ a ]]><Piece"), "entity": swap('Name="displacement"', 'Name="&displacement;"'),
    "deep": swap("<Piece", "<a>" * 100_000 + "<Piece"), "wide": swap("<FieldData>", "<FieldData>" + "<a/>" * 300_000 + "<b>"),
    "two_pieces": lambda text: text.replace(b"</Piece>", b"</Piece>" + text[text.index(b"<Piece"):text.index(b"</Piece>") + 8]),
    "no_piece": lambda text: text[:text.index(b"<Piece")] + text[text.index(b"</Piece>") + 8:],
    "points_none": lambda text: re.sub(rb'NumberOfPoints="\d+"', b'NumberOfPoints="0"', text),
    "points_many": lambda text: re.sub(rb'NumberOfPoints="\d+"', b'NumberOfPoints="99999999999"', text),
    "points_negative": lambda text: re.sub(rb'NumberOfPoints="\d+"', b'NumberOfPoints="-3"', text),
    "points_words": lambda text: re.sub(rb'NumberOfPoints="\d+"', b'NumberOfPoints="some"', text),
    "points_fewer": lambda text: re.sub(rb'NumberOfPoints="\d+"', b'NumberOfPoints="7"', text),
    "cells_many": lambda text: re.sub(rb'NumberOfCells="\d+"', b'NumberOfCells="4000000000"', text),
    "cells_more": lambda text: re.sub(rb'NumberOfCells="\d+"', b'NumberOfCells="14"', text),
    "connectivity_beyond": with_number("connectivity", 99, "<i"), "connectivity_negative": with_number("connectivity", -1, "<i"),
    "offsets_beyond": with_number("offsets", 99, "<i"), "offsets_fall": with_number("offsets", -1, "<i"), "offsets_stay": with_number("offsets", 2, "<i"),
    "types_unknown": with_number("types", 250, "<B"), "types_mixed": with_number("types", 5, "<B"), "types_polyhedron": with_number("types", 42, "<B"),
    "no_connectivity": lambda text: without_array(text, "connectivity"), "no_offsets": lambda text: without_array(text, "offsets"),
    "no_types": lambda text: without_array(text, "types"), "no_points": lambda text: without_array(text, "Points"),
    "points_nan": with_number("Points", float("nan")), "count_beyond": lambda text: with_header(text, "Points", b"\xff" * 8),
    "count_more": lambda text: with_header(text, "Points", struct.pack("<Q", 10_000)), "count_none": lambda text: with_header(text, "Points", bytes(8)),
    "values_fewer": lambda text: with_values(text, "Points", lambda values: values[:-4]),
    "base64": lambda text: text[:array(text, "Points")[0]] + b"****" + text[array(text, "Points")[0] + 4:],
    "points_of_words": of_tag("Points", 'type="Float32"', 'type="String"'), "points_of_bits": of_tag("Points", 'type="Float32"', 'type="Bit"'),
    "points_of_doubles": of_tag("Points", 'type="Float32"', 'type="Float64"'), "points_of_no_type": of_tag("Points", 'type="Float32"', ""),
    "components_none": of_tag("Points", 'NumberOfComponents="3"', 'NumberOfComponents="0"'), "components_two": of_tag("Points", 'NumberOfComponents="3"', 'NumberOfComponents="2"'),
    "components_many": of_tag("Points", 'NumberOfComponents="3"', 'NumberOfComponents="2000000000"'), "components_negative": of_tag("Points", 'NumberOfComponents="3"', 'NumberOfComponents="-3"'),
    "appended": of_tag("Points", 'format="binary"', 'format="appended" offset="9999999"'), "format": of_tag("Points", 'format="binary"', 'format="telegram"')}

PARTICLES = {
    "displacement_nan": with_number("displacement", float("nan")), "displacement_infinite": with_number("displacement", float("inf"), at=8),
    "velocity_nan": with_number("velocity", float("nan")), "energy_nan": with_number("pair_energy", float("nan"), "<d"),
    "no_displacement": lambda text: without_array(text, "displacement"), "no_velocity": lambda text: without_array(text, "velocity"),
    "displacement_of_one": of_tag("displacement", 'NumberOfComponents="3"', 'NumberOfComponents="1"'),
    "displacement_renamed": of_tag("displacement", 'Name="displacement"', 'Name="displaced"')}

BODY = {
    "bone_beyond": with_number("bone", 99, "<i"), "bone_below": with_number("bone", -7, "<i"), "no_bone": lambda text: without_array(text, "bone"),
    "radius_none": with_number("radius", 0., "<d"), "radius_nan": with_number("radius", float("nan"), "<d"), "radius_differs": with_number("radius", 9., "<d", 8),
    "mass_negative": with_number("mass", -1., "<d"), "ids_differ": with_number("id", 5, "<i"), "points_nan": with_number("Points", float("nan"), "<d"),
    "weight_nan": with_number("weight", float("nan"), "<d"), "no_mass": lambda text: without_array(text, "mass")}

SURFACE = {
    "corner_beyond": with_number("connectivity", 99, "<i"), "bone_beyond": with_number("bone", 99, "<i"), "bone_below": with_number("bone", -7, "<i"),
    "of_vertices": with_number("types", 1, "<B"), "points_nan": with_number("Points", float("nan")), "displacement_nan": with_number("displacement", float("nan")),
    "no_bone": lambda text: without_array(text, "bone"), "no_displacement": lambda text: without_array(text, "displacement")}

FRAMES = {
    "axis_nan": with_number("axis_x", float("nan")), "axis_none": lambda text: with_values(text, "axis_x", lambda values: bytes(len(values))),
    "axis_infinite": with_number("axis_z", float("inf")), "no_axis": lambda text: without_array(text, "axis_y"), "head_nan": with_number("Points", float("nan")),
    "length_nan": with_number("length", float("nan")), "length_negative": with_number("length", -1.), "no_length": lambda text: without_array(text, "length")}


def vtu(run):
    """Of the second frame of the particles, and of what else a run is read from."""
    files = {}
    for place, changes in {"particles/particles_000001.vtu": VTU | PARTICLES, "body.vtu": BODY, "surface/surface_000000.vtu": SURFACE,
                           "frames/frames_000001.vtu": FRAMES}.items():
        whole = (run / place).read_bytes()
        common = FOREIGN | NOT_FILES | cut_short(whole) if place.startswith("particles") else {}
        for name, content in (common | {name: change(whole) for name, change in changes.items()}).items():
            files[place, name] = content
    files["surface/surface_000001.vtu", "points_nan"] = with_number("Points", float("nan"))((run / "surface/surface_000001.vtu").read_bytes())
    files["particles/particles_000001.vtu", "another_series"] = (run / "bones/bones_000001.vtu").read_bytes()
    return files


def pvd(run):
    whole = (run / "particles.pvd").read_bytes()
    files = FOREIGN | NOT_FILES | cut_short(whole)
    first = b'timestep="0"'
    for name, time in {"nan": "nan", "infinite": "inf", "words": "soon", "none": "", "too_large": "1e999", "comma": "0,0", "other": "0.5", "twice": "0.1"}.items():
        files[f"time_{name}"] = replaced(whole, first, f'timestep="{time}"')
    file = b'file="particles/particles_000001.vtu"'
    for name, path in {"above": "../other/particles_000001.vtu", "above_within": "particles/../../other.vtu", "absolute": "/etc/passwd", "none": "",
                       "missing": "particles/none.vtu", "folder": "particles", "itself": "particles.pvd", "shell": "$(touch gone)", "pipe": "|touch gone",
                       "dots": "..", "zero": "particles&#0;", "long": "x" * 100_000, "address": "http://localhost/a.vtu", "other_series": "bones/bones_000001.vtu"}.items():
        files[f"file_{name}"] = replaced(whole, file, f'file="{path}"')
    files["no_time"] = replaced(whole, first, "")
    files["no_file"] = replaced(whole, file, "")
    files["no_rows"] = b"".join(line for line in whole.splitlines(True) if b"DataSet" not in line)
    files["no_collection"] = whole.replace(b"Collection>", b"Gallery>")
    files["root"] = whole.replace(b"VTKFile", b"VTKFill")
    files["unknown_entity"] = replaced(whole, file, b'file="&file;"')
    files["doctype"] = replaced(whole, b"<VTKFile", b'<!DOCTYPE a [<!ENTITY b SYSTEM "file:///etc/passwd">]><VTKFile')
    files["alias_bomb"] = replaced(whole, b"<VTKFile", b'<!DOCTYPE a [<!ENTITY b "cc"><!ENTITY d "&b;&b;&b;&b;">]><VTKFile')
    files["comment"] = replaced(whole, b"<Collection>", b"<!-- a <Collection>")
    files["deep"] = replaced(whole, b"<Collection>", b"<a>" * 200_000 + b"<Collection>")
    files["open"] = whole.replace(b"</Collection>", b"")
    files["not_utf8"] = replaced(whole, b"particles_", b"\xff\xfe_")
    files["two_attributes"] = replaced(whole, first, first + b" " + first)
    return files


# Checkpoints.

def hash_of(content):
    """FNV-1a, 64 bits."""
    value = 0xcbf29ce484222325
    for byte in content:
        value = (value ^ byte) * 0x100000001b3 & (2 ** 64 - 1)
    return value


class Fields:
    """The values of a checkpoint, in order: name, size of an element (0: one value, without a count), bytes."""

    def __init__(self, whole):
        self._text, self._at, self.all = whole, 24 + 24, []
        self.all.append(("program", 1, self._take(struct.unpack_from("<Q", whole, 24 + 16)[0])))
        for name in ("scene", "body", "motion", "count", "timestep", "number"):
            self._one(name, 8)
        self._state()
        if self._one("begun", 1) != b"\0":
            self._state()
        assert self._at == len(whole) - 8, (self._at, len(whole))

    def _take(self, count):
        self._at += count
        return self._text[self._at - count:self._at]

    def _one(self, name, size):
        self.all.append((name, 0, self._take(size)))
        return self.all[-1][2]

    def _count(self, name):
        return struct.unpack("<Q", self._one(name, 8))[0]

    def _list(self, name, size):
        values = self._take(size * struct.unpack("<Q", self._take(8))[0])
        self.all.append((name, size, values))
        return values

    def _state(self):
        self._one("steps", 8), self._one("kicked", 1), self._one("units", 8 * (1 + 9 + 1))
        self._list("order", 4)
        of_place, of_velocity = ((8, 8), (4, 4))[self._one("precision", 1)[0]]
        for name, size in ("position", of_place), ("velocity", of_velocity):
            for _ in range(3):
                self._list(name, size)
        for _ in range(self._count("parts")):
            part = self._list("part", 1).decode()
            for _ in range(self._count("columns")):
                column = self._list("column", 1).decode()
                self._list(f"{part}.{column}", (8, 4, 4, 8)[self._one("kind", 1)[0]])


CHECKPOINT_VERSION = 11


def sealed(fields, magic=b"SINEWCKP", mark=0x01020304, version=CHECKPOINT_VERSION):
    """With the right length and checksum, whatever the fields hold."""
    def put(name, size, values):
        if name == "program":
            return struct.pack("<8sQQ", b"program", 1, len(values)) + values
        return values if size == 0 else struct.pack("<Q", len(values) // size) + values

    body = b"".join(put(*field) for field in fields)
    text = struct.pack("<8sIIQ", magic, mark, version, 24 + len(body) + 8) + body
    return text + struct.pack("<Q", hash_of(text))


def section_changes(sections):
    """Name, and the sections in that checkpoint."""
    def other(name, values):
        return [(n, s, values(v) if n == name else v) for n, s, v in sections]

    for name in ("program", "scene", "body", "motion", "count", "timestep"):
        yield f"{name}_differs", other(name, lambda v: bytes([v[0] ^ 1]) + v[1:])
    huge, least = struct.pack("<q", 2 ** 62), struct.pack("<q", -1)
    yield "steps_negative", other("steps", lambda v: least)
    yield "steps_beyond", other("steps", lambda v: huge)
    yield "steps_of_an_hour", other("steps", lambda v: struct.pack("<q", 10 ** 9))
    nan = struct.pack("<d", float("nan"))
    for name in ("position", "velocity"):
        yield f"{name}_nan", other(name, lambda v: nan + v[8:])
        yield f"{name}_infinite", other(name, lambda v: struct.pack("<d", float("inf")) + v[8:])
        yield f"{name}_short", other(name, lambda v: v[:-8])
        yield f"{name}_none", other(name, lambda v: b"")
    yield "order_twice", other("order", lambda v: v[4:8] + v[4:])
    yield "order_beyond", other("order", lambda v: b"\xff\xff\xff\xff" + v[4:])
    yield "order_none", other("order", lambda v: b"")
    yield "pressures_more", other("pressures.numbers", lambda v: nan * 5)
    yield "work_nan", other("ledgers.bones_work", lambda v: nan)
    yield "work_none", other("ledgers.bones_work", lambda v: b"")
    yield "first_missing", sections[1:]
    yield "last_missing", sections[:-1]
    yield "none", []
    yield "doubled", sections + sections
    yield "turned", sections[::-1]
    yield "part_renamed", other("part", lambda v: v.replace(b"ledgers", b"lodgers"))
    yield "column_renamed", other("column", lambda v: v.replace(b"bones_work", b"bones_walk"))
    yield "kind_unknown", other("kind", lambda v: b"\7")
    yield "larger_elements", [(n, 4 if n == "position" else s, v) for n, s, v in sections]


def checkpoint(run):
    whole = (run / "checkpoint/a.bin").read_bytes()
    sections = Fields(whole).all
    assert sealed(sections) == whole
    files = FOREIGN | {name: NOT_FILES[name] for name in ("folder", "pipe")} | cut_short(whole, 16)
    files |= {"magic": sealed(sections, b"SINEWCKQ"), "mark": sealed(sections, mark=0x04030201), "version_0": sealed(sections, version=0),
              "version_next": sealed(sections, version=CHECKPOINT_VERSION + 1), "checksum": whole[:-1] + bytes([whole[-1] ^ 1]), "longer": whole + b"\0",
              "twice": whole + whole, "head_alone": whole[:24]}
    for k in range(24, len(whole) - 8, max(1, len(whole) // 12)):
        files[f"flipped_{k}"] = whole[:k] + bytes([whole[k] ^ 4]) + whole[k + 1:]
    for name, changed in section_changes(sections):
        files[f"sections_{name}"] = sealed(changed)
    at = whole.index(b"pieces") - 8  # the count of letters of a part's name
    for name, number in {"huge": 2 ** 62, "beyond": 2 ** 64 - 1, "more": 10 ** 6}.items():
        text = whole[:at] + struct.pack("<Q", number) + whole[at + 8:-8]
        files[f"count_{name}"] = text + struct.pack("<Q", hash_of(text))
    return files


# What else a run is read from.

def record(run):
    whole = (run / "run.json").read_bytes()
    document = json.loads(whole)
    files = FOREIGN | NOT_FILES | cut_short(whole)
    for name, text in {"list": b"[]", "null": b"null", "number": b"7", "word": b'"sinew"', "nothing": b"{}", "deep": b'{"program":' * 100_000,
                       "deep_lists": b'{"program": "sinew", "a": ' + b"[" * 300_000}.items():
        files[name] = text
    for key, value in {"program": "another", "program_number": 7}.items():
        files[f"{key}"] = json.dumps(document | {"program": value}).encode()
    for k, value in enumerate([{"seconds": 7}, {"seconds": {"stepping": "long"}}, {"resumed": "often"}, {"resumed": 1e300}, {"resumed": -1},
                               {"resumed": 2 ** 63}, {"started": [1]}, {"status": {}}, {"seconds": [1]}]):
        files[f"{next(iter(value))}_{k}"] = json.dumps(document | value).encode()
    files["not_utf8"] = replaced(whole, b'"sinew"', b'"sin\xffew"')
    return files
