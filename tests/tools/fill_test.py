#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""sinew fill and sinew info on meshes as people have them: open, turned, doubled, in millimeters.

usage: fill_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import json
import math
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

BIN, SOURCE = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()


def sphere(levels=4, radius=1.0):
    """Points and triangles, outward: an octahedron whose faces are cut in four again and again."""
    points = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    for _ in range(levels):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                sums = [p + q for p, q in zip(points[a], points[b])]
                length = math.sqrt(sum(x * x for x in sums))
                middles[key] = len(points)
                points.append(tuple(x / length for x in sums))
            return middles[key]

        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = finer
    return [tuple(radius * x for x in p) for p in points], faces


def cube():
    """Points and triangles of the cube from 0 to 1, outward."""
    points = [(float(i & 1), float(i >> 1 & 1), float(i >> 2)) for i in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return points, [f for a, b, c, d in quads for f in [(a, b, c), (a, c, d)]]


def torn(mesh, by):
    """Each face with corners of its own, off their place by up to `by` along each axis."""
    points, faces = mesh
    corners = [tuple(x + by * math.sin(7 * n + 3 * axis) for axis, x in enumerate(points[i]))
               for n, i in enumerate(i for face in faces for i in face)]
    return corners, [(n, n + 1, n + 2) for n in range(0, len(corners), 3)]


def moved(mesh, by):
    return [tuple(x + d for x, d in zip(p, by)) for p in mesh[0]], mesh[1]


def together(a, b):
    return a[0] + b[0], a[1] + [tuple(len(a[0]) + i for i in face) for face in b[1]]


def turned(mesh):
    return mesh[0], [tuple(reversed(face)) for face in mesh[1]]


class Meshes(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = Path(self.temporary.name)

    def write(self, mesh, name="mesh.obj"):
        points, faces = mesh
        path = self.folder / name
        path.write_text("".join("v %r %r %r\n" % p for p in points) +
                        "".join("f %d %d %d\n" % tuple(i + 1 for i in f) for f in faces))
        return path

    def run_sinew(self, *words, check=0):
        done = subprocess.run([BIN / "sinew", *map(str, words), "--json"], capture_output=True,
                              text=True, timeout=120)
        self.assertEqual(done.returncode, check, f"{words}\n{done.stdout}\n{done.stderr}")
        if check == 0:
            return json.loads(done.stdout)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertRegex(done.stderr, r"^sinew: .+; .+\n$")
        return done.stderr

    def fill(self, mesh, *words, check=0):
        path = mesh if isinstance(mesh, Path) else self.write(mesh)
        return self.run_sinew("fill", path, "-o", self.folder / "body.vtu", *words, check=check)

    def test_the_same_filling_gives_the_same_bytes(self):
        bodies = set()
        for _ in range(2):
            self.fill(SOURCE / "data/meshes/arm.ply", "--count", 2000)
            bodies.add((self.folder / "body.vtu").read_bytes())
        self.assertEqual(len(bodies), 1)

    def test_a_closed_mesh_agrees_with_cgal_at_every_site(self):
        for packing in ["fcc", "hcp"]:
            found = self.fill(sphere(), "--radius", 0.05, "--packing", packing, "--verify")
            self.assertEqual(found["mismatches"], 0)
            self.assertGreater(found["verified_sites"], found["particles"])
            self.assertTrue(found["closed"])
            self.assertAlmostEqual(found["total_mass"] / (1000 * found["mesh_volume"]), 1, 12)
            self.assertEqual(found["warnings"], [])

    def test_the_report_lies_in_the_body_too(self):
        import meshio
        found = self.fill(sphere(), "--radius", 0.05)
        body = meshio.read(self.folder / "body.vtu")
        meta = json.loads(bytes(body.field_data["sinew_meta"]).decode())
        self.assertEqual(meta["fill"]["particles"], found["particles"])
        self.assertEqual(meta["fill"]["neighbors"], found["neighbors"])
        self.assertEqual(len(body.points), found["particles"])

    def test_turned_and_doubled_meshes_are_filled_the_same(self):
        ball = sphere()
        expected = self.fill(ball, "--radius", 0.05)["particles"]
        for mesh in [turned(ball), together(ball, ball), together(ball, turned(ball))]:
            self.assertEqual(self.fill(mesh, "--radius", 0.05)["particles"], expected)
        self.assertEqual(self.fill(together(ball, ball), "--radius", 0.05)["faces_doubled"], 2048)

    def test_solids_that_share_faces_fill_as_one_body_and_are_told_apart(self):
        import meshio
        cells = [moved(cube(), (i % 2, i // 2 % 2, i // 4)) for i in range(8)]
        all_of_them = cells[0]
        for cell in cells[1:]:
            all_of_them = together(all_of_them, cell)
        origin = ("--lattice-origin", "0.0123,0.0077,0.0051", "--radius", 0.06)
        found = self.fill(all_of_them, *origin)
        component = meshio.read(self.folder / "body.vtu").point_data["component"]
        self.assertEqual(sorted(set(component)), list(range(8)))
        block = [tuple(2 * x for x in p) for p in cube()[0]], cube()[1]
        self.assertEqual(found["particles"], self.fill(block, *origin)["particles"])
        self.assertEqual(found["warnings"], self.fill(block, *origin)["warnings"])
        info = self.run_sinew("info", self.write(all_of_them))
        self.assertEqual((info["faces_shared"], info["closed"], info["volume"]), (24, True, 8))

    def test_the_volume_of_parts_that_overlap_is_told_once(self):
        info = self.run_sinew("info", self.write(together(cube(), moved(cube(), (0.5, 0.25, 0)))))
        self.assertAlmostEqual(info["volume"], 2 - 0.5 * 0.75, delta=0.02)

    def test_what_tetrahedra_lack_of_thin_walls_is_told(self):
        plate = [(x, y, 0.01 * z + 0.3 * x + 0.2 * y) for x, y, z in cube()[0]], cube()[1]
        for radius, lost in [(0.003, False), (0.009, True)]:
            found = self.run_sinew("fill", self.write(plate), "--radius", radius, "--to", "tetrahedra", "-o", self.folder / "cells.vtu")
            warning = [text for text in found["warnings"] if "tetrahedra" in text]
            self.assertEqual(len(warning), lost, found["warnings"])
            self.assertGreater(found["volume"], (0.5 if lost else 0.98) * found["body_volume"])
        keeps = float(warning[0].split("a radius of ")[1].split()[0])
        found = self.run_sinew("fill", self.write(plate), "--radius", keeps, "--to", "tetrahedra", "-o", self.folder / "cells.vtu")
        self.assertGreater(found["volume"], 0.99 * found["body_volume"])

    def test_an_open_mesh_is_filled_and_told(self):
        points, faces = sphere()
        found = self.fill((points, faces[:-40]), "--radius", 0.05)
        self.assertFalse(found["closed"])
        self.assertGreater(found["holes"], 0)
        self.assertEqual(found["mass_from"], "particles")
        self.assertIn("open", found["warnings"][0])
        whole = self.fill((points, faces), "--radius", 0.05)["particles"]
        self.assertAlmostEqual(found["particles"] / whole, 1, 2)
        closed = self.fill((points, faces[:-40]), "--radius", 0.05, "--close-holes")
        self.assertTrue(closed["closed"])
        self.assertEqual(closed["holes_closed"], found["holes"])
        self.assertIn("closed", self.fill((points, faces[:-40]), "--radius", 0.05, "--verify",
                                          check=2))

    def test_welding_joins_points_that_almost_meet(self):
        ball = sphere()
        whole = self.fill(ball, "--radius", 0.05)
        loose = self.fill(torn(ball, 1e-5), "--radius", 0.05)
        self.assertFalse(loose["closed"])
        found = self.fill(torn(ball, 1e-5), "--radius", 0.05, "--weld", 0.001)
        self.assertTrue(found["closed"])
        self.assertEqual(found["points_merged"], 3 * len(ball[1]) - len(ball[0]))
        self.assertAlmostEqual(found["mesh_volume"] / whole["mesh_volume"], 1, 4)
        self.assertEqual(found["warnings"], [])

    def test_a_skin_replaces_an_open_mesh(self):
        points, faces = sphere()
        alpha = 0.5
        found = self.fill((points, faces[:-40]), "--radius", 0.05, "--wrap", alpha)
        self.assertTrue(found["closed"])
        self.assertGreater(found["faces_wrapped"], 100)
        self.assertEqual(found["faces_read"], len(faces) - 40)
        for size in found["box_size"]:  # alpha / 30 outside of the mesh
            self.assertAlmostEqual(size, 2 + 2 * alpha / 30, 1)
            self.assertGreater(size, 2)
        self.assertEqual(found["warnings"], [])
        self.assertIn("--wrap 0", self.fill((points, faces), "--radius", 0.05, "--wrap", 0, check=2))

    def test_units_scale_lengths(self):
        ball = sphere(3)
        meters = self.fill(ball, "--radius", 0.1)
        large = ([tuple(1000 * x for x in p) for p in ball[0]], ball[1])
        found = self.fill(large, "--radius", 0.1, "--unit", "mm")
        self.assertEqual(found["particles"], meters["particles"])
        self.assertAlmostEqual(found["box_size"][0], 2, 12)
        found = self.fill(large, "--radius", 0.1, "--scale", 0.001)
        self.assertEqual(found["particles"], meters["particles"])
        self.assertIn("unit", " ".join(self.fill(large, "--radius", 100)["warnings"]))

    def test_a_count_is_met(self):
        for words in [[], ["--keep", "sphere"], ["--thickness", 0.2]]:
            found = self.fill(sphere(), "--count", 20000, *words)
            self.assertAlmostEqual(found["particles"] / 20000, 1, 1, words)

    def test_keeping_whole_spheres_leaves_a_skin_free(self):
        import meshio
        for words, within in [(["--keep", "sphere"], 0.05), (["--clearance", 0.2], 0.2),
                              (["--keep", "sphere", "--clearance", 0.1], 0.15)]:
            self.fill(sphere(5), "--radius", 0.05, *words)
            points = meshio.read(self.folder / "body.vtu").points
            farthest = max(math.dist(p, (0, 0, 0)) for p in points)
            self.assertLess(farthest, 1 - within)
            self.assertGreater(farthest, 1 - within - 0.06)

    def test_a_sheet_is_refused_and_filled_with_a_thickness(self):
        sheet = ([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)])
        self.assertIn("thickness", self.fill(sheet, "--radius", 0.02, check=2))
        found = self.fill(sheet, "--radius", 0.02, "--thickness", 0.2)
        volume = found["packed_volume"]  # the sheet, half cylinders and quarter balls around it
        self.assertAlmostEqual(volume / (0.2 + 4 * math.pi * 0.01 / 2 + 4 / 3 * math.pi * 0.001),
                               1, 1)

    def test_bodies_are_kept_apart(self):
        import meshio
        ball = sphere(3)
        pair = together(ball, moved(ball, (3, 0, 0)))
        found = self.fill(pair, "--radius", 0.1)
        self.assertEqual(found["bodies"], 2)
        self.assertEqual(found["touching_groups"], 2)
        body = meshio.read(self.folder / "body.vtu")
        for point, component in zip(body.points, body.point_data["component"]):
            self.assertEqual(component, int(point[0] > 1.5))

    def test_bodies_that_fuse_are_told(self):
        near = together(cube(), moved(cube(), (1.05, 0, 0)))
        between_layers = f"{1.025 + 0.05 / math.sqrt(2)},0.5,0.5"  # one on either side of the gap
        found = self.fill(near, "--radius", 0.05, "--lattice-origin", between_layers)
        self.assertEqual(found["bodies"], 2)
        self.assertEqual(found["touching_groups"], 1)
        self.assertIn("2 separate bodies touch", " ".join(found["warnings"]))
        far = self.fill(together(cube(), moved(cube(), (1.3, 0, 0))), "--radius", 0.05)
        self.assertEqual(far["touching_groups"], 2)
        self.assertNotIn("touch", " ".join(far["warnings"]))

    def test_nested_shells_follow_the_rule(self):
        ball = sphere(3)
        nested = together(ball, sphere(3, 0.5))
        full = self.fill(ball, "--radius", 0.05)["particles"]
        self.assertEqual(self.fill(nested, "--radius", 0.05)["particles"], full)
        hollow = self.fill(nested, "--radius", 0.05, "--rule", "hollow")
        self.assertAlmostEqual(hollow["particles"] / full, 7 / 8, 1)
        self.assertEqual(hollow["cavities"], 1)
        self.assertEqual(self.fill(together(ball, turned(sphere(3, 0.5))),
                                   "--radius", 0.05)["particles"], hollow["particles"])

    def test_the_lattice_may_be_moved_and_turned(self):
        plain = self.fill(sphere(), "--radius", 0.05)
        shifted = self.fill(sphere(), "--radius", 0.05, "--lattice-origin", "0.03,0.02,0.01")
        turned_by = self.fill(sphere(), "--radius", 0.05, "--lattice-rotation", "10,20,30")
        for found in [shifted, turned_by]:
            self.assertNotEqual(found["inertia"], plain["inertia"])
            self.assertAlmostEqual(found["particles"] / plain["particles"], 1, 1)
            self.assertAlmostEqual(found["smallest_distance"], 1, 9)

    def test_what_cannot_be_filled_is_refused_with_a_cure(self):
        self.assertIn("fits", self.fill(sphere(), "--radius", 1e-7, check=2))
        self.assertIn("fits", self.fill(sphere(), "--radius", 5, check=2))
        self.assertIn("--radius", self.fill(sphere(), check=2))
        self.assertIn("--radius -1", self.fill(sphere(), "--radius", -1, check=2))
        self.assertIn("--unit mile", self.fill(sphere(), "--radius", 1, "--unit", "mile", check=2))

    def test_info_says_what_is_wrong_and_draws_it(self):
        import meshio
        points, faces = sphere()
        broken = self.write((points, faces[:-3] + [tuple(reversed(faces[0]))]))
        drawing = self.folder / "defects.vtu"
        found = self.run_sinew("info", broken, "-o", drawing)
        self.assertFalse(found["closed"])
        self.assertEqual(found["holes"], 1)
        self.assertEqual(found["open_edges"], 5)
        self.assertEqual(found["faces_doubled"], 1)
        self.assertEqual(found["self_intersections"], 0)
        self.assertGreater(found["radius_for_1e3"], found["radius_for_1e6"])
        self.assertGreater(found["thinnest_part"], 1)
        cells = {block.type: block.data for block in meshio.read(drawing).cells}
        self.assertEqual(len(cells["line"]), 5)
        self.assertEqual(len(cells["triangle"]), len(faces) - 3)

    def test_info_tells_what_a_repair_did(self):
        points, faces = sphere()
        open_ball = self.write((points, faces[:-40]))
        self.assertNotIn("holes_closed", self.run_sinew("info", open_ball))
        found = self.run_sinew("info", open_ball, "--close-holes")
        self.assertEqual(found["holes"], 0)
        self.assertGreater(found["holes_closed"], 0)
        self.assertEqual(found["triangles"], len(faces) - 40 + found["faces_added"])
        wrapped = self.run_sinew("info", open_ball, "--wrap", 0.5)
        self.assertEqual(wrapped["faces_wrapped"], wrapped["triangles"])

    def test_info_and_fill_say_the_same_of_a_size(self):
        tiny = self.write(([tuple(1e-5 * x for x in p) for p in sphere(2)[0]], sphere(2)[1]))
        told = self.run_sinew("info", tiny)["warnings"]
        self.assertIn("unit", told[0])
        self.assertEqual(self.fill(tiny, "--radius", 1e-6)["warnings"][0], told[0])

    def test_info_of_a_closed_mesh(self):
        found = self.run_sinew("info", SOURCE / "data/meshes/box.obj")
        self.assertTrue(found["closed"])
        self.assertAlmostEqual(found["volume"], 0.016769744422619713, 12)
        self.assertAlmostEqual(found["thinnest_part"], 0.15556, 4)

    def test_every_scene_of_ours_agrees_with_cgal(self):
        scenes = sorted((SOURCE / "configs").glob("*.yaml"))
        self.assertGreater(len(scenes), 3)
        for scene in scenes:
            found = self.run_sinew("fill", scene, "-o", self.folder / "body.vtu", "--verify")
            self.assertEqual(found["mismatches"], 0, scene)
            self.assertEqual(found["warnings"], [], scene)

    def test_gltf_is_read(self):
        points, faces = sphere(3)
        import base64
        import struct
        data = b"".join(struct.pack("<3f", *p) for p in points)
        data += b"".join(struct.pack("<3H", *f) for f in faces)
        low = [min(p[i] for p in points) for i in range(3)]
        high = [max(p[i] for p in points) for i in range(3)]
        document = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0, "scale": [2, 2, 2]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3",
                 "min": low, "max": high},
                {"bufferView": 1, "componentType": 5123, "count": 3 * len(faces), "type": "SCALAR"}],
            "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 12 * len(points)},
                            {"buffer": 0, "byteOffset": 12 * len(points),
                             "byteLength": 6 * len(faces)}],
            "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," +
                         base64.b64encode(data).decode()}]}
        path = self.folder / "ball.gltf"
        path.write_text(json.dumps(document))
        found = self.fill(path, "--radius", 0.1, "--verify")
        self.assertAlmostEqual(found["box_size"][0], 4, 6)
        self.assertEqual(found["mismatches"], 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
