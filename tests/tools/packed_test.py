#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compressed versions of a rig have its skeleton, and its surface to the precision of their format.

usage: /usr/bin/python3 packed_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import json
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import small_run

RIGS = [small_run.SOURCE / "data/motions" / name for name in ("fox.glb", "box_bend.glb")]


def told(file):
    return json.loads(small_run.sinew("info", file, "--json", check=0).stdout)


def with_float_weights(glb):
    """draco_transcoder drops weights that are whole numbers."""
    size = struct.unpack_from("<I", glb, 12)[0]
    document, data = json.loads(glb[20:20 + size]), bytearray(glb[28 + size:])
    for mesh in document["meshes"]:
        for primitive in mesh["primitives"]:
            accessor = document["accessors"][primitive["attributes"]["WEIGHTS_0"]]
            if accessor["componentType"] != 5121:
                continue
            view = document["bufferViews"][accessor["bufferView"]]
            start, count = view.get("byteOffset", 0), 4 * accessor["count"]
            floats = struct.pack(f"<{count}f", *(byte / 255 for byte in data[start:start + count]))
            document["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(floats)})
            accessor.update(bufferView=len(document["bufferViews"]) - 1, componentType=5126)
            accessor.pop("normalized", None)
            data += floats
    document["buffers"][0]["byteLength"] = len(data)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    parts = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(parts)) + parts


class Packed(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)

    def expect_same(self, program, *options, bits):
        if not shutil.which(program):
            self.skipTest(f"{program} is not installed: tools/install_packages.sh test")
        for rig in RIGS:
            packed = Path(self.temporary.name) / rig.name
            plain = Path(self.temporary.name) / "plain.glb"
            plain.write_bytes(with_float_weights(rig.read_bytes()))
            subprocess.run([program, "-i", plain, "-o", packed, *options], check=True, capture_output=True)
            self.assertNotEqual(packed.read_bytes(), rig.read_bytes())
            one, other = told(rig), told(packed)
            lengths = [{bone["name"]: bone["length"] for bone in info["skeleton"]} for info in (one, other)]
            self.assertEqual(set(lengths[0]), set(lengths[1]))
            for name, length in lengths[0].items():
                self.assertAlmostEqual(lengths[1][name], length, delta=1e-6)
            self.assertEqual(one["triangles"], other["triangles"])
            precision = 2 * max(one["box_size"]) / 2**bits
            for key in ("box_low", "box_size"):
                for a, b in zip(one[key], other[key]):
                    self.assertAlmostEqual(a, b, delta=precision)
            self.assertAlmostEqual(other["volume"] / one["volume"], 1, delta=one["area"] * precision / one["volume"])

    def test_of_draco(self):
        self.expect_same("draco_transcoder", bits=11)

    def test_of_meshopt(self):
        self.expect_same("gltfpack", "-c", "-kn", bits=14)

    def test_of_quantized_numbers(self):
        self.expect_same("gltfpack", "-kn", bits=14)

    def test_of_meshopt_in_whole_numbers_alone(self):
        self.expect_same("gltfpack", "-cc", "-kn", "-noq", bits=20)


if __name__ == "__main__":
    unittest.main(argv=["packed_test", "-v", *sys.argv[3:]])
