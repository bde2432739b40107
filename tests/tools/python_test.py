#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python package: the same bits as the commands, no copies, no leaks, errors with a cure.

usage: python_test.py BIN SOURCE      folder of the programs, folder of the project; PYTHONPATH names the package's
"""
import gc
import json
import os
import resource
import signal
import subprocess
import sys
import threading
import time
import unittest

import meshio
import numpy
import sinew

from small_run import SOURCE, SmallRun
from small_run import sinew as command

BAR = {
    "material": {"model": "bonded"},
    "skeleton": {"bones": [{"name": "low", "head": [0, 0, 0], "tail": [0, 0, 0.1]},
                           {"name": "high", "parent": "low", "tail": [0, 0, 0.2]}]},
    "motion": {"tracks": [{"bone": "high", "keys": [{"time": 0}]}]},
}


def grid(nx, ny, nz, spacing):
    """A face-centered cubic packing of particles whose diameter is `spacing`."""
    side = spacing * 2 ** 0.5
    cells = numpy.stack(numpy.meshgrid(range(nx), range(ny), range(nz), indexing="ij"), -1).reshape(-1, 1, 3)
    corners = numpy.array([[0, 0, 0], [0.5, 0.5, 0], [0.5, 0, 0.5], [0, 0.5, 0.5]])
    return side * (cells + corners).reshape(-1, 3)


class Scenes(SmallRun):
    def test_fill_is_as_the_command(self):
        body = sinew.fill(SOURCE / "data/meshes/arm.ply", radius=0.01)
        command("fill", SOURCE / "data/meshes/arm.ply", "--radius", "0.01", "-o", self.folder / "arm.vtu", check=0)
        filled = meshio.read(self.folder / "arm.vtu")
        numpy.testing.assert_array_equal(body.points, filled.points)
        numpy.testing.assert_array_equal(body.component, filled.point_data["component"])
        self.assertEqual(body.mass, filled.point_data["mass"][0])
        self.assertEqual(len(body), len(body.points))
        small = sinew.fill(SOURCE / "data/meshes/arm.ply", count=500, unit="cm", packing="hcp")
        self.assertAlmostEqual(len(small) / 500, 1, delta=0.1)
        glass = [sinew.fill(SOURCE / "data/meshes/arm.ply", count=500, packing="random", seed=seed) for seed in (1, 1, 2)]
        numpy.testing.assert_array_equal(glass[0].points, glass[1].points)
        self.assertNotEqual(glass[0].points.tobytes(), glass[2].points.tobytes())

    def test_paths_and_names_of_any_letters(self):
        for word in ("ü", "骨", "🦴", "it's \"so\"", "a\\b"):
            folder = self.folder / word
            folder.mkdir()
            mesh = folder / f"{word}.obj"
            mesh.write_bytes((SOURCE / "data/meshes/box.obj").read_bytes())
            self.assertEqual(len(sinew.fill(mesh, count=100)), len(sinew.fill(str(mesh), count=100)))
            bones = [{"name": word, "head": [0, 0, 0], "tail": [0, 0, 1]}]
            scene = sinew.make_scene({"body": {"mesh": mesh, "radius": 0.05}, "skeleton": {"bones": bones},
                                      "solver": {"duration": 0.01}, "output": {"interval": 0.01}},
                                     folder=folder)
            self.assertEqual(sinew.Simulation(scene).bones, [word])
            self.assertEqual(len(sinew.simulate(scene, folder / "run")), 2)

    def test_a_scene_is_filled_as_it_says(self):
        scene = sinew.read_scene(self.scene)
        self.assertEqual(sinew.fill(scene).radius, 0.025)
        with self.assertRaises(TypeError):
            sinew.fill(scene, radius=0.01)

    def test_steps_are_as_the_commands(self):
        self.simulate("--set", "output.double_precision=true")
        simulation = sinew.Simulation(sinew.read_scene(self.scene))
        end = meshio.read(sorted((self.out / "particles").glob("*.vtu"))[-1])
        simulation.run_until(0.4)
        numpy.testing.assert_array_equal(simulation.positions, end.points)
        numpy.testing.assert_array_equal(simulation.velocities, end.point_data["velocity"])
        surface = meshio.read(sorted((self.out / "surface").glob("*.vtu"))[-1])
        numpy.testing.assert_array_equal(simulation.surface, surface.points)
        numpy.testing.assert_array_equal(simulation.faces, surface.cells_dict["triangle"])

    def test_runs_and_metrics_are_as_the_files(self):
        run = sinew.simulate(sinew.read_scene(self.scene, {"body.radius": 0.04}), self.out)
        self.assertEqual(len(run), 13)
        self.assertAlmostEqual(run[-1].time, 0.4)
        numpy.testing.assert_allclose(run.times, [run[i].time for i in range(13)])
        moved = numpy.linalg.norm(run[6].positions - run.rest, axis=1)
        numpy.testing.assert_allclose(moved, run[6].displacement, atol=1e-6)
        command("measure", self.out, check=0)
        columns = sinew.measure(self.out)
        table = numpy.genfromtxt(self.out / "metrics.csv", delimiter=",", names=True)
        for name in ("time", "volume_error", "kinetic_energy"):
            numpy.testing.assert_allclose(columns[name], table[name], rtol=1e-12)
        with self.assertRaises(IndexError):
            run[13]

    def test_errors_are_those_of_the_commands(self):
        for cause, part in ((lambda: sinew.read_scene("none.yaml"), "none.yaml"),
                            (lambda: sinew.read_scene(self.scene, {"body.radus": 1}), "radius"),
                            (lambda: sinew.fill("none.obj", radius=1), "none.obj"),
                            (lambda: sinew.open_run(self.folder), "run"),
                            (lambda: sinew.Body([[0, 0]], 1), "(n, 3)"),
                            (lambda: sinew.Body([], 1), "(n, 3)"),
                            (lambda: sinew.Body([[0, 0, float("nan")]], 1), "finite"),
                            (lambda: sinew.Body([[0, 0, 0]], -1), "radius")):
            with self.assertRaises(sinew.Error) as raised:
                cause()
            self.assertIn(part, str(raised.exception))
            self.assertEqual(raised.exception.exit_code, 2)


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
        with self.assertRaisesRegex(sinew.Error, "body.radius and body.count are both missing"):
            sinew.fill(V, F)

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

    def test_any_array_by_its_name(self):
        frame = self.run_[6]
        for name in ("J", "velocity", "force"):  # written
            numpy.testing.assert_array_equal(frame[name], frame.dataset()[name])
        command("measure", self.out, "--arrays", "stress, strain", check=0)
        measured = meshio.read(sorted((self.out / "values").glob("*.vtu"))[6])
        for name in ("stress", "strain"):
            numpy.testing.assert_allclose(frame.array(name), measured.point_data[name], rtol=1e-6, atol=1e-6 * abs(frame[name]).max())
        with self.assertRaisesRegex(sinew.Error, "output.arrays: force_radial"):
            frame["force_radial"]
        with self.assertRaisesRegex(sinew.Error, "stress"):
            frame["strss"]

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
        self.assertEqual(names, ["particles", "surface", "volume", "bones", "frames"])
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
        with self.assertRaisesRegex(sinew.Error, "no series 'bone'"):
            simulation.dataset("bone")

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


class Examples(SmallRun):
    def example(self, name, *words, before=()):
        done = subprocess.run([*before, sys.executable, SOURCE / "lib/examples" / name, *map(str, words)],
                              capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_a_chart_of_a_run(self):
        self.simulate()
        self.example("chart.py", self.out, self.folder / "chart.png")
        self.assertGreater((self.folder / "chart.png").stat().st_size, 5000)

    def test_a_study_of_parameters(self):
        rows = self.example("parameter_study.py", self.scene).splitlines()[1:]
        far = [float(row.split()[1]) for row in rows]
        self.assertEqual(len(far), 3)
        self.assertTrue(all(distance > 0 for distance in far))

    def test_a_force_of_ones_own(self):
        words = self.example("own_force.py", SOURCE / "data/meshes/tentacle.ply").split()
        self.assertGreater(float(words[3]), 0.01)  # downwind

    def test_a_picture_by_vtk(self):
        self.example("vtk_scene.py", self.scene, self.folder / "pose.png", before=[SOURCE / "tests/tools/on_display.sh"])
        self.assertGreater((self.folder / "pose.png").stat().st_size, 5000)


class Made(unittest.TestCase):
    """Bodies and scenes made in Python."""

    def setUp(self):
        self.body = sinew.Body(grid(3, 3, 10, 0.02) - [0.04, 0.04, 0], 0.01)
        self.scene = sinew.make_scene(BAR, self.body)

    def test_a_pose_moves_the_body(self):
        simulation = sinew.Simulation(self.scene, self.body)
        self.assertEqual(simulation.bones, ["low", "high"])
        half = numpy.radians(45) / 2
        simulation.set_pose({"high": (numpy.cos(half), 0, numpy.sin(half), 0)}, over=0.5)
        simulation.run_until(1)
        top = self.body.points[:, 2] > 0.22
        expected = (self.body.points[top] - [0, 0, 0.1]) @ numpy.array([[1, 0, -1], [0, 2 ** 0.5, 0], [1, 0, 1]]) \
            / 2 ** 0.5 + [0, 0, 0.1]
        self.assertLess(abs(simulation.positions[top] - expected).max(), 0.01)
        for wrong, part in (({"none": (1, 0, 0, 0)}, "take one of low, high"), ({"high": (0, 0, 0, 0)}, "quaternion")):
            with self.assertRaises(sinew.Error) as raised:
                simulation.set_pose(wrong)
            self.assertIn(part, str(raised.exception))
        before = simulation.positions.copy()
        simulation.set_pose({"low": (1, 0, 0, 0)})  # high stays as it is
        simulation.run_until(1.2)
        self.assertLess(abs(simulation.positions - before).max(), 0.003)

    def test_a_pose_begins_where_the_motion_of_the_scene_is(self):
        keys = [{"time": 0}, {"time": 0.2, "axis": [0, 1, 0], "angle": 30}]
        scene = sinew.make_scene(BAR | {"motion": {"tracks": [{"bone": "high", "keys": keys}]}}, self.body)
        simulation = sinew.Simulation(scene, self.body)
        simulation.run_until(0.6)
        before = simulation.positions.copy()
        simulation.set_pose({"low": (1, 0, 0, 0)})
        simulation.run_until(0.8)
        self.assertLess(abs(simulation.positions - before).max(), 0.003)

    def test_groups_refuse_a_pose_and_go_on(self):
        for dynamic in (False, True):
            words = {"hierarchy": {"enabled": True, "dynamic": dynamic, "min_particles": 64}}
            simulation = sinew.Simulation(sinew.make_scene(BAR | words, self.body), self.body)
            with self.assertRaises(sinew.Error) as raised:
                simulation.set_pose({"high": (1, 0, 0, 0)})
            self.assertIn("groups of particles", str(raised.exception))
            self.assertIn("set hierarchy.enabled to false", str(raised.exception))
            simulation.step(2)

    def test_forces_of_ones_own_accelerate(self):
        """Newton's second law for the first step, and a body that is pushed alike moves as in gravity."""
        pushed = sinew.Simulation(self.scene, self.body, own_forces=True)
        fallen = sinew.Simulation(sinew.make_scene(BAR | {"solver": {"gravity": [0, 0, -2]}}, self.body), self.body)
        pushed.set_forces(numpy.full((len(self.body), 3), (0, 0, -2)) * self.body.mass)
        for simulation in (pushed, fallen):
            simulation.step(50)
        numpy.testing.assert_allclose(pushed.positions, fallen.positions, atol=1e-9)
        forces = numpy.zeros((len(self.body), 3))
        forces[7] = (0.1, 0, 0)
        other = sinew.Simulation(self.scene, self.body, own_forces=True)
        other.set_forces(forces)
        other.step()
        moved = numpy.abs(other.positions - self.body.points).max(1)
        self.assertEqual(numpy.argmax(moved), 7)
        for bad in (numpy.zeros((3, 3)), numpy.full((len(self.body), 3), numpy.nan)):
            with self.assertRaises(sinew.Error):
                other.set_forces(bad)

    def test_bones_reactions_and_arrays_while_stepping(self):
        scene = sinew.read_scene(SOURCE / "configs/box_bend.yaml", {"body.radius": 0.04})
        simulation = sinew.Simulation(scene)
        at_rest = simulation.bone_frames
        self.assertEqual(at_rest.shape, (len(simulation.bones), 4, 4))
        simulation.run_until(0.5)
        for frame in simulation.bone_frames:
            numpy.testing.assert_allclose(frame[:3, :3] @ frame[:3, :3].T, numpy.eye(3), atol=1e-12)
            numpy.testing.assert_array_equal(frame[3], [0, 0, 0, 1])
        self.assertGreater(abs(simulation.bone_frames - at_rest).max(), 0.1)
        self.assertEqual(simulation.reactions.shape, (len(simulation.bones), 6))
        strain, stress = simulation.array("strain"), simulation.array("stress")
        self.assertEqual((strain.shape, stress.shape), ((len(simulation.positions), 6),) * 2)
        self.assertGreater(numpy.nanmax(abs(strain)), 1e-3)
        self.assertEqual(simulation.array("J").shape, (len(simulation.positions),))
        on_skin = simulation.surface_array("J")
        self.assertEqual(on_skin.shape, (len(simulation.surface),))
        self.assertLessEqual(on_skin.max(), numpy.nanmax(simulation.array("J")))
        layers = simulation.array("surface_layer")
        self.assertEqual(layers.dtype, numpy.int32)
        self.assertEqual(set(layers), {1, 2})  # of three half-planes across
        for wrong in ("strian", "strain, stress", ""):
            with self.assertRaises(sinew.Error):
                simulation.array(wrong)
        with self.assertRaises(sinew.Error) as raised:
            sinew.Simulation(self.scene, self.body).array("strain")
        self.assertIn("surface", str(raised.exception))

    def test_reactions_answer_the_springs_of_bones(self):
        scene = sinew.read_scene(SOURCE / "configs/box_bend.yaml", {"body.radius": 0.04, "binding.bone_damping": 0})
        simulation = sinew.Simulation(scene)
        simulation.run_until(0.3)
        pulls = sum(simulation.array(f"force_{name}") for name in ("radial", "twist", "axial"))
        self.assertGreater(abs(pulls).max(), 0.01)
        numpy.testing.assert_allclose(-pulls.sum(0), simulation.reactions[:, :3].sum(0), atol=1e-9)

    def test_reactions_answer_gravity(self):
        """At rest, what the bones carry is the weight."""
        scene = sinew.make_scene(BAR | {"solver": {"gravity": [0, 0, -2]}, "material": {"damping_ratio": 1}}, self.body)
        simulation = sinew.Simulation(scene, self.body)
        simulation.run_until(3)
        weight = 2 * self.body.mass * len(self.body)
        numpy.testing.assert_allclose(simulation.reactions[:, :3].sum(0), [0, 0, -weight], atol=0.01 * weight)

    def test_a_saved_moment_goes_on_with_the_same_bits(self):
        simulation = sinew.Simulation(self.scene, self.body, own_forces=True)
        simulation.set_forces(numpy.full((len(self.body), 3), (0, 0, -2)) * self.body.mass)
        simulation.step(40)
        state, positions = simulation.save(), []
        for _ in range(2):
            simulation.step(30)
            positions.append(simulation.positions.copy())
            simulation.restore(state)
            self.assertEqual(simulation.steps, 40)
        numpy.testing.assert_array_equal(*positions)

    def test_positions_are_a_view(self):
        simulation = sinew.Simulation(self.scene, self.body)
        first = simulation.positions
        surface = sinew.Simulation(sinew.read_scene(SOURCE / "configs/box_bend.yaml", {"body.radius": 0.04}))
        views = [surface.surface, surface.forces, surface.velocities]
        surface.step(3)
        for view, again in zip(views, (surface.surface, surface.forces, surface.velocities)):
            self.assertEqual(view.ctypes.data, again.ctypes.data)
        simulation.step(3)
        self.assertEqual(first.ctypes.data, simulation.positions.ctypes.data)
        self.assertFalse(first.flags.writeable)
        self.assertEqual(self.body.points.ctypes.data, self.body.points.ctypes.data)
        del simulation
        gc.collect()
        self.assertTrue(numpy.isfinite(first).all())  # the view keeps its owner

    def test_other_threads_go_on(self):
        counted = 0
        simulation = sinew.Simulation(self.scene, self.body)
        worker = threading.Thread(target=simulation.step, args=(3000,))
        worker.start()
        busy = 0
        while worker.is_alive():
            counted += 1
            try:
                simulation.positions
            except sinew.Error:
                busy += simulation.steps > 0
            time.sleep(0)
        self.assertGreater(counted, 100)
        self.assertGreater(busy, 10)
        self.assertEqual(simulation.steps, 3000)

    def test_two_threads_that_step_take_turns(self):
        simulation = sinew.Simulation(self.scene, self.body)
        refused = []

        def steps():
            for _ in range(300):
                try:
                    simulation.step(1)
                except sinew.Error:
                    refused.append(1)
        threads = [threading.Thread(target=steps) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(simulation.steps, 4 * 300 - len(refused))

    def test_numbers_of_steps(self):
        simulation = sinew.Simulation(self.scene, self.body)
        simulation.step(0)
        with self.assertRaisesRegex(sinew.Error, "below 0"):
            simulation.step(-1)
        simulation.step(2)
        simulation.run_until(0)
        self.assertEqual(simulation.steps, 2)
        code = "import sinew, sys; exec(sys.argv[1]); simulation.step(2**63 - 1)"
        child = subprocess.Popen([sys.executable, "-c", code, self.code_of_simulation() + "simulation.step(3); print(1, flush=True)"],
                                 stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        child.stdout.readline()
        time.sleep(0.5)
        self.assertIsNone(child.poll(), "it steps on")
        child.kill()
        child.communicate()

    def code_of_simulation(self):
        return (f"body = sinew.Body([[0, 0, 0], [0.01, 0, 0], [0, 0.01, 0], [0, 0, 0.01]], 0.005)\n"
                f"simulation = sinew.Simulation(sinew.make_scene({BAR!r}, body), body)\n")

    def test_leaving_while_a_thread_steps(self):
        code = ("import sinew, threading, time\n" + self.code_of_simulation() +
                "thread = threading.Thread(target=simulation.step, args=(10**12,), daemon=True)\n"
                "thread.start()\ntime.sleep(0.2)\nprint(simulation.steps > 0)\n")
        for _ in range(5):
            done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=30)
            self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "True\n", ""))

    def test_objects_that_nobody_has_made(self):
        """Called in another process: what is tested is that it does not crash."""
        code = """import sinew
for kind in (sinew.Simulation, sinew.Body, sinew.Scene, *(getattr(sinew._sinew, name) for name in
             ("_Run", "_Frame", "_Dataset", "_Surface", "_Polygons", "_RunMeter", "_RunCells"))):
    thing = kind.__new__(kind)
    for name in dir(kind):
        if name.startswith("__") and name not in ("__len__", "__str__", "__getitem__", "__repr__"):
            continue
        for words in ((), (1,), ({},)):
            try:
                value = getattr(thing, name)
                value(*words)
            except (TypeError, RuntimeError, IndexError, ValueError, sinew.Error):
                pass
for use in (lambda: sinew.Simulation(sinew.Scene.__new__(sinew.Scene)), lambda: sinew.fill(sinew.Scene.__new__(sinew.Scene)),
            lambda: sinew.Simulation(sinew.make_scene({}), sinew.Body.__new__(sinew.Body))):
    try:
        use()
    except (TypeError, RuntimeError, sinew.Error):
        pass
print("alive")
"""
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=30)
        self.assertEqual((done.returncode, done.stdout), (0, "alive\n"), done.stderr)

    def test_numbers_that_cannot_be_computed_with(self):
        for bad in (1e155, -1e155, 1e308, float("inf"), float("nan")):
            with self.assertRaisesRegex(sinew.Error, "too large or not finite"):
                sinew.Body([[0, 0, 0], [bad, 0, 0]], 0.01)
            with self.assertRaisesRegex(sinew.Error, "too large or not finite|not above 0"):
                sinew.Body([[0, 0, 0]], abs(bad))
            with self.assertRaises(sinew.Error):
                sinew.make_scene({**BAR, "skeleton": {"bones": [{"name": "low", "head": [bad, 0, 0], "tail": [0, 0, 1]}]}},
                                 self.body)

    def test_simulations_leak_nothing(self):
        def used():
            gc.collect()
            return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        for _ in range(30):
            sinew.Simulation(self.scene, self.body).step()
        before = used()
        for _ in range(200):
            sinew.Simulation(self.scene, self.body).step()
        self.assertLess(used() - before, 2000)  # kB; 200 bodies of 360 particles have 60,000

    def test_ctrl_c_stops_stepping(self):
        code = ("import sinew, sys; sys.path.insert(0, sys.argv[1]); import numpy\n"
                "body = sinew.Body(numpy.load(sys.argv[2]), 0.01)\n"
                "scene = sinew.make_scene(eval(sys.argv[3]), body)\n"
                "simulation = sinew.Simulation(scene, body)\n"
                "print('ready', flush=True)\n"
                "try:\n  simulation.step(10**9)\n"
                "except KeyboardInterrupt:\n  print('stopped', simulation.steps > 0)\n")
        points = os.path.join(os.environ.get("TMPDIR", "/tmp"), f"points{os.getpid()}.npy")
        numpy.save(points, self.body.points)
        child = subprocess.Popen([sys.executable, "-c", code, ".", points, repr(BAR)], stdout=subprocess.PIPE, text=True)
        self.assertEqual(child.stdout.readline(), "ready\n")
        time.sleep(0.5)
        child.send_signal(signal.SIGINT)
        self.assertEqual(child.communicate(timeout=20)[0], "stopped True\n")
        os.remove(points)


if __name__ == "__main__":
    unittest.main(argv=["python_test", "-v", *sys.argv[3:]])
