# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged BVH, glTF and GLB files, from the good ones of data/motions/."""
import base64
import copy
import json
import math
import struct
from pathlib import Path

from damage import FOREIGN, NOT_FILES, cut_short, replaced

MOTIONS = Path(__file__).resolve().parents[2] / "data/motions"


def bvh():
    whole = (MOTIONS / "box_bend.bvh").read_bytes()
    files = dict(FOREIGN) | NOT_FILES | cut_short(whole)
    changes = {
        "more_frames": ("Frames: 301", "Frames: 302"), "fewer_frames": ("Frames: 301", "Frames: 299"),
        "no_frames": ("Frames: 301", "Frames: 0"), "negative_frames": ("Frames: 301", "Frames: -301"),
        "countless_frames": ("Frames: 301", "Frames: 99999999999999999999"), "many_frames": ("Frames: 301", "Frames: 2147483648"),
        "half_a_frame": ("Frames: 301", "Frames: 300.5"), "frames_of_words": ("Frames: 301", "Frames: many"),
        "no_count": ("Frames: 301\n", ""), "no_time": ("Frame Time: 0.0083333333333333332\n", ""),
        "time_zero": ("Time: 0.008", "Time: 0 0.008"), "time_negative": ("Time: 0.008", "Time: -0.008"),
        "time_nan": ("Time: 0.0083333333333333332", "Time: nan"), "time_infinite": ("Time: 0.0083333333333333332", "Time: inf"),
        "offset_nan": ("OFFSET 0", "OFFSET nan"), "offset_infinite": ("OFFSET 0", "OFFSET 1e999"), "offset_short": ("OFFSET 0 0 0", "OFFSET 0 0"),
        "offset_of_words": ("OFFSET 0", "OFFSET zero"), "no_offset": ("OFFSET 0 0 0\n", ""), "two_offsets": ("OFFSET 0 0 0\n", "OFFSET 0 0 0\nOFFSET 0 0 0\n"),
        "value_nan": ("0.0186458333", "nan"), "value_infinite": ("0.0186458333", "-inf"), "value_too_large": ("0.0186458333", "1e999"),
        "value_of_words": ("0.0186458333", "little"), "value_more": ("0.0186458333", "0.0186458333 7"), "value_less": ("0.0186458333", ""),
        "brace_less": ("}", ""), "brace_more": ("}\nMOTION", "}\n}\nMOTION"), "no_hierarchy": ("HIERARCHY", ""), "no_root": ("ROOT lower", ""),
        "root_in_root": ("JOINT upper", "ROOT upper"), "unknown_word": ("JOINT upper", "BONE upper"), "no_motion_word": ("MOTION", ""),
        "channels_many": ("CHANNELS 6", "CHANNELS 600"), "channels_negative": ("CHANNELS 6", "CHANNELS -6"), "channels_fewer": ("CHANNELS 6", "CHANNELS 5"),
        "channels_more": ("CHANNELS 3", "CHANNELS 4"), "channels_word": ("CHANNELS 6", "CHANNELS six"), "channel_unknown": ("Xposition", "Wposition"),
        "channel_twice": ("Xposition", "Yposition"), "channels_twice": ("JOINT", "CHANNELS 0\nJOINT"), "site_of_nothing": ("Site", "Sight"),
        "bytes_within": ("OFFSET", b"OFF\xff\xfe\0SET")}
    for name, (old, new) in changes.items():
        files[name] = replaced(whole, old, new)
    start = b"HIERARCHY\nROOT a {\nOFFSET 0 0 0\n"
    files["deep"] = start + b"JOINT a {\nOFFSET 0 1 0\n" * 100_000
    files["wide"] = start + b"JOINT a {\nOFFSET 0 1 0\n}\n" * 100_000 + b"}\n"
    files["long_line"] = replaced(whole, "Frame Time", "0 " * 2_000_000 + "\nFrame Time")
    return whole, files


def glb_parts():
    """The JSON and the binary part of box_bend.glb."""
    content = (MOTIONS / "box_bend.glb").read_bytes()
    size = struct.unpack("<I", content[12:16])[0]
    return json.loads(content[20:20 + size]), content[28 + size:]


def glb(document, data):
    text = document if isinstance(document, bytes) else json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


DROP = object()

# Where in the document, and what stands there: of any glTF.
VALUES = {
    "asset": [DROP, [], "2.0", {}, {"version": "1.0"}, {"version": "3.0"}, {"version": 2}, {"version": "two"},
              {"version": "2.0", "minVersion": "2.9"}],
    "scene": [7, -1, "0", 0.5], "scenes": [[], {}, [{"nodes": [99]}], [{"nodes": [-1]}], [{"nodes": ["a"]}], [{"nodes": 0}], [7]],
    "nodes": [DROP, [], {}, "five", [None] * 5],
    "nodes.0.children": [[0], [99], [-1], [1.5], "1", [1, 1], [2, 4]], "nodes.2.children": [[1], [0]],
    "nodes.4.mesh": [9, -1, "box", 1e300], "nodes.4.skin": [9, -1, {}],
    "nodes.1.matrix": [[1] * 15, [1] * 17, ["a"] * 16, [1e39] * 16], "nodes.1.translation": [[0, 0], [0, 0, "x"], 7, [0, 0, 1e400]],
    "nodes.1.rotation": [[0, 0, 0, 0], [0, 0, 1]], "nodes.1.scale": [[0, 0, 0], [1, 1], "large"],
    "meshes": [DROP, [], {}, [{}], [{"primitives": []}], [{"primitives": [{}]}], [{"primitives": {}}]],
    "meshes.0.primitives.0.attributes": [{}, [], {"POSITION": 99}, {"POSITION": -1}, {"POSITION": 3}, {"POSITION": "0"}],
    "meshes.0.primitives.0.indices": [99, -1, 0, 4, "3"], "meshes.0.primitives.0.mode": [99, -1, "triangles"],
    "meshes.0.primitives.0.attributes.JOINTS_0": [DROP, 99, 2, 4], "meshes.0.primitives.0.attributes.WEIGHTS_0": [DROP, 99, 3],
    "skins": [{}, [{}], [{"joints": []}]], "skins.0.joints": [[1, 99], [1, -1], [1], [1, 1], ["a"], 1],
    "skins.0.inverseBindMatrices": [99, 0, -1, "a"],
    "animations": [{}],
    "animations.0.samplers.0.input": [99, -1, 5, 0, DROP], "animations.0.samplers.0.output": [99, -1, 4, 0, DROP],
    "animations.0.samplers.0.interpolation": ["BEZIER", 7, "CUBICSPLINE"], "animations.0.channels.0.sampler": [9, -1, DROP],
    "animations.0.channels.0.target.node": [99, -1, "upper"], "animations.0.channels.0.target.path": ["color", 7, "translation", DROP],
    "accessors": [DROP, [], {}], "accessors.0.count": [10 ** 9, -1, 0, 2 ** 63, 1.5, "many", DROP, 1063, 2 ** 31],
    "accessors.0.componentType": [5126.5, 9999, 5121, "float", DROP, -1], "accessors.0.type": ["VEC2", "VEC9", 3, DROP, "SCALAR"],
    "accessors.0.bufferView": [99, -1, 0.5, "0"], "accessors.0.byteOffset": [-4, 10 ** 9, 2 ** 63, "4", 8],
    "accessors.3.count": [6361, 10 ** 12, 6359], "accessors.3.componentType": [5126, 5125],
    "accessors.4.count": [150, 152, 0], "accessors.6.count": [1, 3], "accessors.6.type": ["MAT3", "VEC4"],
    "accessors.0.sparse": [{}, {"count": 10 ** 9, "indices": {"bufferView": 0, "componentType": 5125}, "values": {"bufferView": 0}},
                           {"count": 4, "indices": {"bufferView": 99, "componentType": 5125}, "values": {"bufferView": 0}},
                           {"count": 4, "indices": {"bufferView": 0, "componentType": 5126}, "values": {"bufferView": 0}},
                           {"count": 4, "indices": {"bufferView": 0, "componentType": 5125}, "values": {"bufferView": 0}}],
    "bufferViews": [DROP, [], {}], "bufferViews.0.byteLength": [2 ** 31, -1, 0, DROP, "all", 12743, 2 ** 64],
    "bufferViews.0.byteOffset": [-1, 10 ** 9, 2 ** 63, "0"], "bufferViews.0.byteStride": [1, 3, -4, 10 ** 9, 256],
    "bufferViews.0.buffer": [9, -1, DROP], "buffers": [DROP, [], {}], "buffers.0.byteLength": [2 ** 30, -1, 0, DROP, "all", 2 ** 64],
    "buffers.0.uri": ["nowhere.bin", "../../../../etc/passwd", "/etc/passwd", "http://localhost/a.bin", "file:///etc/passwd", "$(touch gone)", "a;touch gone",
                      "data:application/octet-stream;base64,****", "data:application/octet-stream;base64,AAAA", "data:,", "", 7, "\u0000", "a\nb", "."],
    "extensionsRequired": [["KHR_draco_mesh_compression"], ["KHR_mesh_quantization"], ["UNHEARD_of"], "all", [7]]}


def changed(document, place, value):
    other = copy.deepcopy(document)
    *way, last = [int(word) if word.isdigit() else word for word in place.split(".")]
    here = other
    for word in way:
        here = here[word]
    if value is DROP:
        del here[last]
    else:
        here[last] = value
    return other


def gltf():
    document, data = glb_parts()
    whole = glb(document, data)
    files = {f"{name}.glb": text for name, text in (FOREIGN | NOT_FILES | cut_short(whole)).items()}
    for place, values in VALUES.items():
        for k, value in enumerate(values):
            files[f"{place.replace('.', '_')}_{k}.glb"] = glb(changed(document, place, value), data)
    head = {"magic": (0, b"glTX"), "version_1": (4, struct.pack("<I", 1)), "version_3": (4, struct.pack("<I", 3)),
            "length_less": (8, struct.pack("<I", 40)), "length_more": (8, struct.pack("<I", len(whole) + 4)),
            "length_huge": (8, b"\xff\xff\xff\xff"), "chunk_huge": (12, b"\xff\xff\xff\xff"), "chunk_less": (12, struct.pack("<I", 4)),
            "chunk_none": (12, bytes(4)), "chunk_type": (16, b"XXXX"), "chunk_binary_first": (16, b"BIN\0")}
    for name, (at, text) in head.items():
        files[f"head_{name}.glb"] = whole[:at] + text + whole[at + len(text):]
    files["head_alone.glb"], files["first_chunk_alone.glb"] = whole[:12], whole[:20]
    views = document["bufferViews"]

    def with_number(view, number, at=0):
        start = views[view]["byteOffset"] + at
        return glb(document, data[:start] + number + data[start + len(number):])

    for name, number in {"nan": math.nan, "infinite": math.inf}.items():
        for view, what in {0: "point", 2: "weight", 4: "time", 5: "turn", 6: "bind"}.items():
            files[f"{what}_{name}.glb"] = with_number(view, struct.pack("<f", number))
    files["weight_negative.glb"] = with_number(2, struct.pack("<f", -1))
    files["joint_beyond.glb"] = with_number(1, b"\x09")
    files["corner_beyond.glb"] = with_number(3, b"\xff\xff")
    files["times_fall.glb"] = with_number(4, struct.pack("<f", 2.4))
    files["time_negative.glb"] = with_number(4, struct.pack("<f", -2.4))
    files["turn_none.glb"] = with_number(5, bytes(16))
    files["bind_none.glb"] = with_number(6, bytes(64))
    files.update(gltf_texts(document, data))
    return whole, files


def gltf_texts(document, data):
    """Of JSON itself."""
    document = changed(document, "buffers.0.uri", "data:application/octet-stream;base64," + base64.b64encode(data).decode())
    text = json.dumps(document).encode()
    files = {f"{name}.gltf": part for name, part in cut_short(text).items()}
    for name, (old, new) in {
            "comma": (b",", b",,"), "no_quotes": (b'"asset"', b"asset"), "nan": (b'"scene": 0', b'"scene": NaN'),
            "comment": (b"{", b"{/* a */"), "not_utf8": (b"sinew", b"sin\xffew"), "control": (b"sinew", b"sin\x01ew"),
            "base64": (b";base64,", b";base64,?!")}.items():
        files[f"json_{name}.gltf"] = replaced(text, old, new)
    files["json_twice.gltf"] = text + text
    files["json_list.gltf"] = b"[" + text + b"]"
    files["json_null.gltf"] = b"null"
    files["json_deep_lists.gltf"] = replaced(text, b'"scene": 0', b'"extras": ' + b"[" * 200_000 + b"]" * 200_000 + b', "scene": 0')
    files["json_deep.gltf"] = b'{"asset":' * 100_000
    files["json_wide.gltf"] = b'{"asset": {"version": "2.0"}, "nodes": [' + b"{}," * 2_000_000 + b"{}]}"
    files["json_utf16.gltf"] = text[:20_000].decode().encode("utf-16")
    return files
