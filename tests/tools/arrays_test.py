#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python package: meshes as arrays in, results as arrays out, without copies.

usage: arrays_test.py BIN SOURCE      folder of the programs, folder of the project; PYTHONPATH names the package's
"""
import gc
import importlib.util
import json
import os
import re
import sys
import unittest

import meshio
import numpy
import sinew

from small_run import SOURCE, SmallRun
from small_run import sinew as command


def read_arrays(name):
    mesh = meshio.read(SOURCE / "data/meshes" / name)
    return mesh.points, mesh.cells_dict["triangle"]


def tetrahedron():
    """Three right angles at the origin, oriented outward; volume 1/6."""
    return numpy.array([[0., 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]), numpy.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def box():
    """A unit cube of quads."""
    V = numpy.array([[x, y, z] for z in (0., 1) for y in (0., 1) for x in (0., 1)])
    return V, numpy.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])


class Arrays(SmallRun):
    """Meshes that are in no file."""

    def test_arrays_fill_as_their_file(self):
        V, F = read_arrays("arm.ply")
        of_file = sinew.fill(SOURCE / "data/meshes/arm.ply", radius=0.01)
        forms = [(V, F), (V.astype(numpy.longdouble), F.astype(numpy.uint64)), (numpy.asfortranarray(V), F[:, ::1].astype(numpy.int16)),
                 (V.tolist(), F.tolist()), (numpy.repeat(V, 2, 0)[::2], numpy.asfortranarray(F)),
                 (V, numpy.insert(F, 0, 3, axis=1).ravel())]  # the last as VTK has it
        for vertices, faces in forms:
            body = sinew.fill(vertices, faces, radius=0.01)
            numpy.testing.assert_array_equal(body.points, of_file.points)
            numpy.testing.assert_array_equal(body.component, of_file.component)
            self.assertEqual(body.mass, of_file.mass)
        V.setflags(write=False)
        F.setflags(write=False)
        numpy.testing.assert_array_equal(sinew.fill((V, F), radius=0.01).points, of_file.points)
        numpy.testing.assert_array_equal(body.vertices, sinew.repair(V, F).vertices)

    def test_meshes_of_other_packages(self):
        from vtkmodules.vtkIOPLY import vtkPLYReader
        path = SOURCE / "data/meshes/arm.ply"
        expected = sinew.fill(path, radius=0.01).points
        reader = vtkPLYReader()
        reader.SetFileName(str(path))
        reader.Update()
        V, F = read_arrays("arm.ply")
        like_trimesh = type("Trimesh", (), {"vertices": V, "faces": F})()
        for mesh in (reader.GetOutput(), meshio.read(path), like_trimesh):
            numpy.testing.assert_array_equal(sinew.fill(mesh, radius=0.01).points, expected)

    def test_a_scene_of_trimesh_is_all_of_its_meshes(self):
        V, F = tetrahedron()
        part = lambda V, F: type("Trimesh", (), {"vertices": V, "faces": F})()
        cloud = type("PointCloud", (), {"vertices": V})()
        scene = lambda *parts: type("Scene", (), {"geometry": {}, "dump": lambda self: list(parts)})()
        body = sinew.fill(scene(part(V, F), cloud, part(V + [2, 0, 0], F)), radius=0.05)
        numpy.testing.assert_array_equal(body.points, sinew.fill(numpy.concatenate((V, V + [2, 0, 0])), numpy.concatenate((F, F + 4)),
                                                                 radius=0.05).points)
        with self.assertRaisesRegex(sinew.Error, "shows no meshes"):
            sinew.fill(scene(cloud), radius=0.05)

    def test_numbers_of_corners_before_them_are_told(self):
        for V, F in (tetrahedron(), box()):
            body = sinew.fill(V, numpy.insert(F, 0, F.shape[1], axis=1), radius=0.05)
            numpy.testing.assert_array_equal(body.points, sinew.fill(V, F, radius=0.05).points)
            self.assertIn("begins with its number of corners", body.warnings[0])

    def test_ghosts_of_vtk_are_left_out_and_told(self):
        from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
        from vtkmodules.vtkCommonCore import vtkPoints
        from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
        V, F = tetrahedron()
        mesh, points, polygons = vtkPolyData(), vtkPoints(), vtkCellArray()
        points.SetData(numpy_to_vtk(V, deep=1))
        polygons.SetData(3, numpy_to_vtkIdTypeArray(numpy.concatenate((F, [[0, 1, 2]])).ravel(), deep=1))
        mesh.SetPoints(points)
        mesh.SetPolys(polygons)
        flags = numpy_to_vtk(numpy.array([0, 0, 2, 0, 32], numpy.uint8), deep=1)
        flags.SetName("vtkGhostType")
        mesh.GetCellData().AddArray(flags)
        body = sinew.fill(mesh, radius=0.05)
        numpy.testing.assert_array_equal(body.points, sinew.fill(V, F, radius=0.05).points)
        self.assertIn("1 of 5", body.warnings[0])

    def test_repaired_arrays_by_number(self):
        mesh = sinew.repair(*tetrahedron())
        self.assertEqual((len(mesh), mesh[0].shape, mesh[-1].shape), (2, (4, 3), (4, 3)))

    def test_polygons_and_lists_of_lists(self):
        V, quads = box()
        expected = sinew.fill(V, [[*face] for quad in quads for face in (quad[[0, 1, 2]], quad[[0, 2, 3]])], radius=0.05)
        mixed = [list(quad) for quad in quads[:5]] + [list(quads[5][[0, 1, 2]]), quads[5][[0, 2, 3]]]
        for faces in (quads, mixed, numpy.array([number for face in mixed for number in (len(face), *face)])):
            numpy.testing.assert_array_equal(sinew.fill(V, faces, radius=0.05).points, expected.points)

    def test_scenes_of_arrays_run_and_write_their_mesh(self):
        V, F = read_arrays("box.obj")
        words = {"skeleton": {"bones": [{"name": "low", "head": [0, 0, 0], "tail": [0, 0, 0.6]}]}, "solver": {"duration": 0.01},
                 "body": {"radius": 0.04}, "output": {"interval": 0.01}}
        scene = sinew.make_scene(words, mesh=(V, F))
        self.assertGreater(len(sinew.Simulation(scene).surface), 100)
        run = sinew.simulate(scene, self.out)
        numpy.testing.assert_array_equal(run.rest, sinew.fill(V, F, radius=0.04).points)
        again = sinew.simulate(sinew.read_scene(self.out / "scene.yaml"), self.folder / "again")
        numpy.testing.assert_array_equal(run[-1].positions, again[-1].positions)
        written = next((self.out / "meshes").iterdir())
        numpy.testing.assert_array_equal(meshio.read(written).points, V)

    def test_a_body_and_a_mesh_in_one_scene(self):
        V, F = box()
        body = sinew.fill(V, F, radius=0.1)
        scene = sinew.make_scene({"skeleton": {"bones": [{"name": "a", "head": [0, 0, 0], "tail": [0, 0, 1]}]},
                                  "solver": {"duration": 0.1}}, body=body, mesh=(V, F))
        self.assertIn("radius: 0.1 ", str(scene))

    def test_distance_and_winding_number_in_closed_form(self):
        V, F = tetrahedron()
        points = numpy.random.default_rng(3).random((500, 3)) * 2 - 0.5
        inside = (points > 0).all(1) & (points.sum(1) < 1)
        numpy.testing.assert_allclose(sinew.winding_number(V, F, points), inside, atol=1e-12)
        signed = sinew.distance(V, F, points, signed=True)
        numpy.testing.assert_array_equal(signed < 0, inside)
        depth = numpy.minimum(points.min(1), (1 - points.sum(1)) / 3 ** 0.5)  # of points inside
        numpy.testing.assert_allclose(-signed[inside], depth[inside], atol=1e-12)
        below = points[:, :2].min(1) > 0
        below &= (points[:, 2] < 0) & (points[:, :2].sum(1) < 1)
        numpy.testing.assert_allclose(sinew.distance((V, F), points[below]), -points[below, 2], atol=1e-12)
        # One open face of a cube less: from its center a sixth of the sphere is open.
        V, F = box()
        self.assertAlmostEqual(sinew.winding_number(V, F[:5], [[0.5, 0.5, 0.5]])[0], 5 / 6, places=12)
        self.assertAlmostEqual(sinew.winding_number(V, F[:5], [[1, 0.5, 0.5]])[0], 0.5, places=9)  # on the cap that is not there
        self.assertTrue(numpy.isnan(sinew.winding_number(V, F, [[0, 0.5, 0.5]])[0]))

    def test_deformation_of_any_points_in_closed_form(self):
        random = numpy.random.default_rng(5)
        points = numpy.stack(numpy.meshgrid(*[numpy.arange(8.0)] * 3), -1).reshape(-1, 3) + 0.2 * random.random((512, 3))
        rest = sinew.RestShape(points, 2.0)
        self.assertEqual(len(rest), 512)
        self.assertRegex(repr(rest), r"<sinew.RestShape of 512 points, \d+ pairs>")
        F = numpy.eye(3) + 0.3 * random.random((3, 3))
        for order in ("C", "F"):
            now = numpy.asarray(points @ F.T + [1, 2, 3], order=order)
            found, left = rest.gradients(now)
            numpy.testing.assert_allclose(found, numpy.tile(F, (512, 1, 1)), rtol=0, atol=1e-12)
            numpy.testing.assert_allclose(left, 0, atol=1e-24)
        now[::7] = numpy.nan
        found, left = rest.gradients(now)
        self.assertTrue(numpy.isnan(found[::7]).all() and numpy.isnan(left[::7]).all())
        known = numpy.isfinite(left)
        self.assertGreater(known.sum(), 420)
        numpy.testing.assert_allclose(found[known], numpy.tile(F, (known.sum(), 1, 1)), rtol=0, atol=1e-12)
        self.assertTrue(numpy.isnan(sinew.RestShape(points * [1, 1, 0], 2.0).gradients(points)[0]).all())
        for arguments, words in (((points, 0), "cutoff"), ((points, numpy.nan), "cutoff"), ((points[:, :2], 1), "points"),
                                 ((points * numpy.nan, 1), "points[0]")):
            with self.assertRaisesRegex(sinew.Error, re.escape(words)):
                sinew.RestShape(*arguments)
        for given in (points[:5], points[0], points * numpy.inf, points > 0):
            with self.assertRaisesRegex(sinew.Error, "now"):
                rest.gradients(given)
        masked = numpy.ma.masked_greater(points, 7)
        for ask in (lambda: sinew.RestShape(masked, 2), lambda: rest.gradients(masked)):
            with self.assertRaisesRegex(sinew.Error, "masked"):
                ask()
        with self.assertRaisesRegex(sinew.Error, "smaller cutoff"):
            sinew.RestShape(numpy.tile(points, (300, 1)), 100)
        self.assertEqual(len(sinew.RestShape(numpy.zeros((0, 3)), 1).gradients(numpy.zeros((0, 3)))[0]), 0)

    def test_diagnosis_says_what_is_wrong_and_where(self):
        V, F = read_arrays("arm.ply")
        whole = sinew.diagnose(V, F)
        self.assertTrue(whole["closed"])
        self.assertEqual((whole["open_edges"], len(whole.edges), whole.warnings), (0, 0, []))
        broken = sinew.diagnose(V, numpy.vstack([F[1:100, ::-1], F[100:], [[0, 0, 1]]]))
        self.assertEqual(broken["open_edges"], 3)
        self.assertEqual(list(broken.edge_defects), ["open"] * 3)
        self.assertEqual(set(broken.edges.ravel()), set(F[0]))  # vertices keep their order where none is dropped
        self.assertEqual(broken.turned.sum(), 99)
        self.assertEqual(broken["faces_collapsed"], 1)
        self.assertIn("the surface is open: 1 hole with a border of ", broken.warnings[0])
        self.assertIn(f"99 of {len(F) - 1} faces pointed against those beside them", broken.warnings[1])
        command("info", SOURCE / "data/meshes/arm.ply", check=0)
        told = json.loads(command("info", "--json", SOURCE / "data/meshes/arm.ply", check=0).stdout)
        self.assertEqual(dict(sinew.info(SOURCE / "data/meshes/arm.ply")), {key: told[key] for key in told if key != "warnings"})
        for key in whole:
            self.assertEqual(whole[key], told[key], key)
        drawn = whole.to_vtk()
        self.assertEqual(drawn.GetNumberOfCells(), len(F))

    def test_repair_closes_what_it_is_asked_to(self):
        V, F = read_arrays("arm.ply")
        vertices, faces = sinew.repair(V, F[5:], close_holes=True)
        self.assertTrue(sinew.diagnose(vertices, faces)["closed"])
        self.assertFalse(sinew.repair(V, F[5:]).closed)
        welded = sinew.repair(V[F].reshape(-1, 3), numpy.arange(3 * len(F)).reshape(-1, 3))
        self.assertEqual((len(welded.vertices), welded.closed), (len(V), True))
        self.assertEqual(welded.changes["points_merged"], 3 * len(F) - len(V))

    def test_tetrahedra_fill_the_volume(self):
        V, F = read_arrays("box.obj")
        cells = sinew.tetrahedra(V, F, radius=0.02)
        corners = cells.points[cells.cells]
        volume = numpy.linalg.det(corners[:, 1:] - corners[:, :1]) / 6
        self.assertTrue((volume > 0).all())
        self.assertAlmostEqual(volume.sum() / sinew.diagnose(V, F)["volume"], 1, delta=0.01)

    def test_new_and_check_are_as_the_commands(self):
        V, F = read_arrays("box.obj")
        made = sinew.new((V, F), scene=self.folder / "made.yaml")
        self.assertIn("bones", made.reasons)
        numpy.testing.assert_array_equal(meshio.read(made.mesh).points, V)
        checked = sinew.check(made.scene, self.folder)
        told = json.loads(command("check", made.path, "--json", check=0).stdout)
        for key in ("particles", "mass", "young_modulus", "frames", "steps"):
            self.assertEqual(checked[key], told[key])
        self.assertEqual(set(checked) | {"warnings"}, set(told))
        with self.assertRaisesRegex(sinew.Error, "there already"):
            sinew.new((V, F), scene=made.path)
        of_file = sinew.new(SOURCE / "data/motions/fox.glb", scene=self.folder / "fox.yaml")
        self.assertEqual(of_file.scene.duration, sinew.read_scene(self.folder / "fox.yaml").duration)

    def test_wrong_arrays_are_named(self):
        V, F = tetrahedron()
        nan = V.copy()
        nan[2, 1] = numpy.nan
        for vertices, faces, words in (
                (V[:, :2], F, r"vertices have the shape \(4, 2\)"), (V.ravel(), F, "vertices have the shape"),
                (nan, F, r"vertices\[2\] is too large or not finite"), (V * 1j, F, "vertices are of type complex128"),
                (V.astype("U"), F, "vertices are of type"), (None, F, "vertices are no array"), (numpy.zeros((0, 3)), F, "vertices are empty"),
                (V.astype(object), F, "vertices are of type object"),
                (V, F - 1, r"faces\[0\] has the corner -1"), (V, F + 1, r"faces\[1\] has the corner 4"),
                (V, F.astype(numpy.uint64) + 2 ** 63, "has the corner"), (V, F.astype(float), "faces are of type float64"),
                (V, F > 0, "faces are of type bool"), (V, F[:, :2], r"faces have the shape \(4, 2\)"), (V, F[:0], "faces are empty"),
                (V, [], "faces are empty"), (V, [[0, 1, 2], [0, 1]], r"faces\[1\] has 2 corners"), (V, None, "faces are missing"),
                (V, [[0, 1, 2], "abc"], "faces"), (V, numpy.array([3, 0, 1]), "faces in one row"), (V, 7, "faces are 7"),
                (V, F[None], "faces have the shape"), (V, [[0, 1, 2], [0.5, 1, 2, 3]], "faces")):
            for use in (lambda: sinew.fill(vertices, faces, radius=0.1), lambda: sinew.tetrahedra(vertices, faces, radius=0.1)):
                with self.assertRaisesRegex(sinew.Error, words) as raised:
                    use()
            self.assertEqual(raised.exception.exit_code, 2)
        for points, words in ((V[:, :2], "points have the shape"), (nan, r"points\[2\]"), ("abc", "points")):
            with self.assertRaisesRegex(sinew.Error, words):
                sinew.distance(V, F, points)
        masked = numpy.ma.masked_array(V, V > 0.5)
        for words, use in (("body.radius and body.count are both missing", lambda: sinew.fill(V, F)),
                           ("given twice", lambda: sinew.fill(V, F, radius=0.1, count=10)),
                           ("radius is 1j", lambda: sinew.fill(V, F, radius=1j)), ("vertices are masked", lambda: sinew.fill(masked, F, 0.1)),
                           ("faces are masked", lambda: sinew.fill(V, numpy.ma.masked_equal(F, 3), 0.1)),
                           ("is a path", lambda: sinew.diagnose("arm.ply")), ("use diagnose", lambda: sinew.info((V, F))),
                           ("give radius=0.5", lambda: sinew.fill(V, numpy.float32(0.5)))):
            with self.assertRaisesRegex(sinew.Error, words):
                use()

    def test_results_are_not_copied(self):
        body = sinew.fill(*read_arrays("arm.ply"), radius=0.01)
        for name in ("points", "component", "neighbors", "vertices", "faces"):
            first, second = getattr(body, name), getattr(body, name)
            self.assertEqual(first.ctypes.data, second.ctypes.data)
            self.assertFalse(first.flags.writeable)
            self.assertFalse(first.flags.owndata)
        from vtkmodules.util.numpy_support import vtk_to_numpy
        grid = body.to_vtk()
        points = body.points
        self.assertEqual(vtk_to_numpy(grid.GetPoints().GetData()).ctypes.data, points.ctypes.data)
        del body
        gc.collect()
        numpy.testing.assert_array_equal(vtk_to_numpy(grid.GetPoints().GetData()), points)


class Results(SmallRun):
    """Runs as arrays."""

    def setUp(self):
        super().setUp()
        scene = sinew.read_scene(self.scene, {"body.radius": 0.04, "output.volume": True, "output.arrays": "J"})
        self.run_ = sinew.simulate(scene, self.out)

    def test_slices_and_series(self):
        run = self.run_
        self.assertEqual([frame.time for frame in run[3:9:2]], [run[i].time for i in (3, 5, 7)])
        numpy.testing.assert_array_equal(run[-4:].times, run.times[-4:])
        self.assertEqual(len(run[2:][:3][1:]), 2)
        for name in ("rest", "times", "faces"):
            self.assertEqual(getattr(run, name).ctypes.data, getattr(run, name).ctypes.data)
        surfaces = run.frames("surface")
        self.assertEqual(len(surfaces), 13)
        numpy.testing.assert_array_equal(surfaces[5].points, run[5].surface)
        numpy.testing.assert_array_equal(surfaces[5].cells, run.faces)
        for series in run.series:
            own = meshio.read(sorted((self.out / series).glob("*.vtu"))[-1])
            numpy.testing.assert_array_equal(run[-1].dataset(series).points, own.points)
            for name, values in own.point_data.items():
                numpy.testing.assert_array_equal(run[-1].dataset(series)[name], values)
        for wrong in (lambda: run[13], lambda: run[5:][9]):
            with self.assertRaises(IndexError):
                wrong()
        with self.assertRaisesRegex(sinew.Error, "no series 'bonds'; take one of particles"):
            run.frames("bonds")
        with self.assertRaisesRegex(sinew.Error, "no array 'strss'"):
            run[0].dataset()["strss"]

    def test_frames_of_series_that_have_more(self):
        """With output.every, fewer frames have particles."""
        scene = sinew.read_scene(self.scene, {"body.radius": 0.04, "output.every": 3})
        run = sinew.simulate(scene, self.folder / "every")
        self.assertEqual(len(run), 5)
        surfaces = run.frames("surface")
        self.assertEqual(len(surfaces), 13)
        numpy.testing.assert_allclose(surfaces.times, numpy.linspace(0, 0.4, 13), atol=1e-9)
        numpy.testing.assert_array_equal(surfaces[3].points, run[1].surface)
        self.assertEqual(len(run.metrics["time"]), 5)

    def test_tables_of_damaged_runs(self):
        text = (self.out / "bones.csv").read_text()
        (self.out / "bones.csv").write_text(text[:-20])
        self.assertEqual(len(sinew.open_run(self.out).bones["time"]), 25)
        lines = text.splitlines(keepends=True)
        for torn in ("0.5,upper,1e", lines[-1][:-1], lines[-1].replace(",", ",x", 2), "0.5,\"upper"):
            (self.out / "bones.csv").write_text("".join(lines[:-1]) + torn)
            self.assertEqual({len(column) for column in map(list, dict(sinew.open_run(self.out).bones).values())}, {25}, torn)
        (self.out / "bones.csv").write_text(lines[0] + lines[1].replace("lower", "7"))
        self.assertEqual(list(sinew.open_run(self.out).bones["bone"]), ["7"])
        for place in (os.mkfifo, os.mkdir, lambda path: path.symlink_to(path), lambda path: path.write_text("a" * 200_000 + "\n")):
            (self.out / "bones.csv").rename(self.folder / f"old{id(place)}")
            place(self.out / "bones.csv")
            with self.assertRaisesRegex(sinew.Error, "bones.csv: .*restore it from a copy, or run the scene again"):
                sinew.open_run(self.out).bones
        (self.out / "bones.csv").unlink()
        with self.assertRaisesRegex(sinew.Error, "bones.csv: No such file"):
            sinew.open_run(self.out).bones

    def test_any_array_by_its_name(self):
        frame = self.run_[6]
        for name in ("J", "velocity", "force"):  # written
            numpy.testing.assert_array_equal(frame[name], frame.dataset()[name])
        command("measure", self.out, "--arrays", "stress, strain", check=0)
        measured = meshio.read(sorted((self.out / "values").glob("*.vtu"))[6])
        for name in ("stress", "strain"):
            numpy.testing.assert_allclose(frame.array(name), measured.point_data[name], rtol=1e-6, atol=1e-6 * abs(frame[name]).max())
        self.assertIn("velocity", frame)
        self.assertEqual(list(frame), list(frame.dataset().point_arrays))
        with self.assertRaisesRegex(sinew.Error, "output.arrays: force_radial"):
            frame["force_radial"]
        with self.assertRaisesRegex(sinew.Error, "stress"):
            frame["strss"]

    def test_results_outlive_what_is_done_to_them(self):
        """Tables are copies; a run is found from another folder."""
        before = os.getcwd()
        os.chdir(self.out.parent)
        try:
            run = sinew.open_run(self.out.name)
            os.chdir("/")
            self.assertIn("particles", run.series)
            self.assertGreater(len(run[-1].dataset("bones").points), 0)
            for one in (run.bones, run.metrics):
                one["time"][:] = -1
            for one in (run.bones, run.metrics):
                self.assertGreater(max(one["time"]), 0)
        finally:
            os.chdir(before)

    def test_bones_and_tables(self):
        frame = self.run_[6]
        self.assertEqual(self.run_.bone_names, ["lower", "upper"])
        numpy.testing.assert_allclose(frame.bone_frames[:, :3, 3], frame.dataset("frames").points, atol=1e-7)
        self.assertEqual(frame.reactions.shape, (2, 6))
        table = numpy.genfromtxt(self.out / "bones.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
        bones = self.run_.bones
        numpy.testing.assert_array_equal(bones["moment_y"], table["moment_y"])
        self.assertEqual(list(bones["bone"][:2]), ["lower", "upper"])
        numpy.testing.assert_array_equal(self.run_.metrics["volume_error"], sinew.measure(self.out)["volume_error"])
        try:
            import pandas
        except ImportError:
            self.assertIsInstance(bones, dict)
        else:
            self.assertIsInstance(bones, pandas.DataFrame)

    def test_vtk_has_the_same_arrays(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        frame = self.run_[-1]
        blocks = frame.to_vtk()
        names = [blocks.GetMetaData(i).Get(blocks.NAME()) for i in range(blocks.GetNumberOfBlocks())]
        self.assertEqual(names, ["particles", "surface", "bones", "frames", "volume"])
        for index, name in enumerate(names):
            block, data = blocks.GetBlock(index), frame.dataset(name)
            self.assertEqual(vtk_to_numpy(block.GetPoints().GetData()).ctypes.data, data.points.ctypes.data)
            self.assertEqual(block.GetNumberOfCells(), len(data.cells) + len(data.lines))
            for array, values in data.point_arrays.items():
                numpy.testing.assert_array_equal(vtk_to_numpy(block.GetPointData().GetArray(array)), values)
            for i, cell in enumerate(data.cells[:5]):
                self.assertEqual([block.GetCell(i).GetPointId(k) for k in range(len(cell))], list(cell))
        self.assertEqual(frame.dataset().units["velocity"], "m/s")

    def test_a_simulation_has_what_its_files_would(self):
        scene = sinew.read_scene(self.scene, {"body.radius": 0.04, "output.volume": True, "output.arrays": "J",
                                              "output.double_precision": True})
        simulation = sinew.Simulation(scene)
        run = sinew.simulate(scene, self.folder / "double")
        for index in (0, 6, 12):
            simulation.run_until(run.times[index])
            for series in ("particles", "surface", "bones", "frames", "volume"):
                now, written = simulation.dataset(series), run[index].dataset(series)
                numpy.testing.assert_array_equal(now.points, written.points)
                self.assertEqual(set(now), set(written) - {"TimeValue", "CYCLE"})
                for name in now:
                    numpy.testing.assert_array_equal(now[name], written[name])
        self.assertEqual(simulation.to_vtk().GetNumberOfBlocks(), 4)
        plain = sinew.Simulation(sinew.read_scene(self.scene, {"body.radius": 0.04}))
        points = sinew.Body(plain.positions, 0.04)
        bare = sinew.Simulation(sinew.make_scene({"skeleton": {"bones": [{"name": "low", "head": [0, 0, 0], "tail": [0, 0, 0.1]}]}}, points),
                                points)
        for use, series, words in ((simulation, "bone", "no series 'bone'"), (plain, "volume", "output.volume"),
                                   (bare, "surface", "no surface")):
            with self.assertRaisesRegex(sinew.Error, words):
                use.dataset(series)
        self.assertEqual(len(bare.dataset("particles").points), len(points))

    def test_what_objects_are(self):
        body = sinew.fill(self.run_.scene)
        for thing, words in ((self.run_, "13 frames, 0 to 0.4 s"), (self.run_[3], "Frame 3 at 0.1 s"), (self.run_[3:5], "2 of frames"),
                             (self.run_[0].dataset("bones"), "bones at 0 s"), (body, f"{len(body)} particles of radius 0.04 m"),
                             (self.run_.scene, "Scene of 0.4 s"), (sinew.Simulation(self.run_.scene), "2 bones"),
                             (sinew.repair(*tetrahedron()), "4 vertices, 4 faces, closed"),
                             (sinew.diagnose(*tetrahedron()), "closed: True")):
            self.assertIn(words, repr(thing))

    def test_packages_that_are_missing_are_named(self):
        body, missing = sinew.fill(self.run_.scene), []
        for module, use in (("trimesh", body.to_trimesh), ("pyvista", body.to_pyvista), ("pyvista", self.run_[0].to_pyvista)):
            try:
                __import__(module)
            except ImportError:
                missing.append(module)
                with self.assertRaisesRegex(sinew.Error, f"{module} is not installed"):
                    use()
            else:
                self.assertIsNotNone(use())
        if missing:
            self.skipTest(f"without {', '.join(sorted(set(missing)))}")


class Page(SmallRun):
    """The recipes of lib/python/README.md, one after the other, and its table of arrays."""

    def importable(self, *names):
        return all(importlib.util.find_spec(name) for name in names)

    def test_recipes_and_table(self):
        page = (SOURCE / "lib/python/README.md").read_text()
        recipes = re.findall(r"### (\d+)\. .*?\n(.*?)(?=\n##)", page, re.S)
        self.assertEqual([number for number, _ in recipes], [str(i) for i in range(1, 11)])
        (self.folder / "data").symlink_to(SOURCE / "data")
        names, before = {}, os.getcwd()
        os.chdir(self.folder)
        try:
            for number, text in recipes:
                for code in re.findall(r"```python\n(.*?)```", text, re.S):
                    if "to_pyvista" not in code or self.importable("pyvista", "trimesh"):
                        exec(compile(code, f"recipe {number}", "exec"), names)
            self.check_table(page, names)
        finally:
            os.chdir(before)
        self.assertEqual(names["inside"].tolist(), (names["depth"] > 0).tolist())
        self.assertEqual(names["found"]["holes"], 1)

    def check_table(self, page, names):
        sizes = {}
        rows = re.findall(r"^\| `(.+?)` \| \((.+?)\).*? \| (\w+) \|", page, re.M)
        self.assertGreater(len(rows), 20)
        for expression, shape, kind in rows:
            array = eval(expression, names)
            self.assertEqual(array.dtype.name, kind, expression)
            wanted = [size.strip() for size in shape.split(",") if size.strip()]
            self.assertEqual(array.ndim, len(wanted), expression)
            for size, length in zip(wanted, array.shape):
                owner = expression.split(".")[0].split("[")[0]
                self.assertEqual(length, int(size) if size.isdigit() else sizes.setdefault((owner, size), length), expression)


if __name__ == "__main__":
    unittest.main(argv=["arrays_test", "-v", *sys.argv[3:]])
