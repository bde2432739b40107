# SPDX-License-Identifier: GPL-3.0-or-later
"""pvbatch plugin_paraview_test.py BIN SOURCE [TESTS]: the plugin for ParaView: what its reader gives of finished, running
and resumed runs, its filters of any surface and any points. SINEW_MODULE names the folder of the Python package; without
it, the filters call the command.
"""
import json
import math
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree as ET
from pathlib import Path

BIN, SOURCE = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
MODULE = os.environ.get("SINEW_MODULE")
if MODULE:
    sys.path.insert(0, MODULE)
os.environ["SINEW"] = str(BIN / "sinew")
sys.path[:0] = [str(SOURCE / "tools/paraview"), str(SOURCE / "tests/tools")]

import numpy
import sinew_paraview  # mends Python 3.11 for ParaView 5.11, which otherwise loads no plugin in Python
from paraview import servermanager
from paraview.simple import *
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkIOGeometry import vtkSTLWriter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from small_run import SmallRun
from small_run import sinew as command

LoadPlugin(sinew_paraview.__file__, ns=globals())


def fetched(source, time=None, port=0):
    source.UpdatePipeline(time) if time is not None else source.UpdatePipeline()
    return servermanager.Fetch(source, idx=port)


def blocks(data):
    return {data.GetMetaData(i).Get(data.NAME()): data.GetBlock(i) for i in range(data.GetNumberOfBlocks())}


def points(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def arrays(data):
    """Of numbers, by name."""
    return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays()) if data.GetArray(i)}


def read(path):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def field(data, name):
    array = data.GetFieldData().GetAbstractArray(name)
    return array.GetValue(0) if array and array.GetNumberOfValues() else None


class Messages:
    """What ParaView's window of messages would show."""

    def __enter__(self):
        self.window, self.before = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
        vtkOutputWindow.SetInstance(self.window)
        return self

    def __exit__(self, *_):
        vtkOutputWindow.SetInstance(self.before)
        self.text = self.window.GetOutput()


class Reader(SmallRun):
    def same_as_paraview(self, folder):
        """All series of a run, as ParaView's own reader has them."""
        run = SinewRun(FileName=str(folder / "run.json"))
        run.UpdatePipelineInformation()
        names = [path.stem for path in folder.glob("*.pvd")]
        times = list(run.TimestepValues)
        for moment in (times[0], times[len(times) // 2], times[-1]):
            found = blocks(fetched(run, moment))
            self.assertEqual(sorted(found), sorted(set(names) & set(sinew_paraview.run_files.SERIES)))
            for name, block in found.items():
                own = fetched(OpenDataFile(str(folder / f"{name}.pvd")), moment)
                numpy.testing.assert_array_equal(points(block), points(own))
                theirs = arrays(own.GetPointData())
                self.assertEqual(set(arrays(block.GetPointData())), set(theirs))
                for array, values in arrays(block.GetPointData()).items():
                    numpy.testing.assert_array_equal(values, theirs[array])
                self.assertEqual(set(arrays(block.GetCellData())), set(arrays(own.GetCellData())))
        return run

    def test_a_finished_run(self):
        self.simulate("--set", "output.volume=true", "--set", "output.bonds=true", "--set", "material.model=bonded",
                      "--set", "body.radius=0.04")
        run = self.same_as_paraview(self.out)
        self.assertEqual(len(run.TimestepValues), 13)
        run.Series = ["particles"]
        run.Arrays = ["particles: velocity"]
        found = blocks(fetched(run, 0.2))
        self.assertEqual(list(found), ["particles"])
        self.assertEqual([name for name in arrays(found["particles"].GetPointData())], ["velocity"])
        self.assertEqual(type(OpenDataFile(str(self.out / "run.json"))).__name__, "SinewRun")
        extracted = ExtractBlock(Input=SinewRun(FileName=str(self.out / "run.json")), Selectors=["/Root/bones"])
        self.assertEqual(len(set(blocks(fetched(extracted)))), 1)

    def test_a_run_that_goes_on(self):
        """Reloading it, or what ParaView asks every second, brings the frames that were added."""
        words = ["simulate", "--quiet", self.scene, "-o", self.out, "--set", "body.radius=0.015", "--set", "solver.duration=12",
                 "--set", "output.interval=0.05", "--set", "output.checkpoint_interval=0.5"]
        going = subprocess.Popen([BIN / "sinew", *words])
        try:
            self.wait_for(lambda: (self.out / "particles.pvd").is_file() and self.rows() >= 3)
            run = SinewRun(FileName=str(self.out / "run.json"))
            run.UpdatePipelineInformation()
            first = len(run.TimestepValues)
            self.assertGreaterEqual(first, 3)
            self.wait_for(lambda: self.rows() > first)
            keeper = GetTimeKeeper()
            self.assertEqual(len(keeper.TimestepValues), first)
            self.assertTrue(run.GetClientSideObject().GetNeedsUpdate())
            self.assertGreater(len(keeper.TimestepValues), first)  # the window's list of times
            self.assertGreater(len(run.TimestepValues), first)
            self.assertIn("particles", blocks(fetched(run, run.TimestepValues[-1])))
        finally:
            going.send_signal(signal.SIGKILL)
            going.wait()
        command(*words, "--resume", check=0)
        run.UpdatePipelineInformation()
        self.same_as_paraview(self.out)

    def rows(self):
        return len(ET.parse(self.out / "particles.pvd").getroot().findall(".//DataSet"))

    def wait_for(self, true, patience=60):
        begin = time.monotonic()
        while not true():
            self.assertLess(time.monotonic() - begin, patience)
            time.sleep(0.05)

    def test_tables_have_a_row_for_each_time(self):
        self.simulate("--set", "body.radius=0.04")
        command("measure", "--quiet", self.out, check=0)
        for name, columns in (("metrics", "volume_error"), ("bones", "upper moment_y")):
            table = SinewTables(FileName=str(self.out / "run.json"), Table=name)
            table.UpdatePipeline()
            found = servermanager.Fetch(table)
            self.assertEqual(found.GetNumberOfRows(), 13)
            self.assertIn(columns, [found.GetColumnName(i) for i in range(found.GetNumberOfColumns())])
            moments = vtk_to_numpy(found.GetColumnByName("time"))
            numpy.testing.assert_allclose(moments, numpy.linspace(0, 0.4, 13), atol=1e-9)
        lines = (self.out / "bones.csv").read_text().splitlines()
        names = lines[0].split(",")
        upper = [line.split(",") for line in lines[1:] if line.split(",")[names.index("bone")] == "upper"]
        numpy.testing.assert_array_equal(vtk_to_numpy(found.GetColumnByName("upper moment_y")),
                                         [float(row[names.index("moment_y")]) for row in upper])

    def test_tables_of_supports_and_probes(self):
        """Each beside the others, by its name, which may be a number."""
        scene = self.folder / "pull.yaml"
        text = (SOURCE / "configs/bar_pull.yaml").read_text().replace("../data", str(SOURCE / "data"))
        scene.write_text(text.replace("name: middle", "name: '7'").replace("name: corner", "name: '8'"))
        command("simulate", "--quiet", scene, "-o", self.out, "--set", "solver.duration=0.1", "output.interval=0.05", check=0)
        for name, columns in (("probes", ["7 z", "8 displacement_z"]), ("supports", ["grip force_z", "clamp force_z", "hand power"])):
            table = SinewTables(FileName=str(self.out / "run.json"), Table=name)
            table.UpdatePipeline()
            found = servermanager.Fetch(table)
            names = [found.GetColumnName(i) for i in range(found.GetNumberOfColumns())]
            self.assertEqual(found.GetNumberOfRows(), 3)
            self.assertLessEqual({"time", *columns}, set(names))

    def test_tables_are_read_again(self):
        self.simulate("--set", "body.radius=0.04")
        table = SinewTables(FileName=str(self.out / "run.json"), Table="metrics")
        with Messages() as messages:
            table.UpdatePipeline()
        self.assertIn("sinew measure", messages.text)
        command("measure", "--quiet", self.out, check=0)
        self.assertTrue(table.GetClientSideObject().GetNeedsUpdate())
        table.UpdatePipeline()
        self.assertEqual(servermanager.Fetch(table).GetNumberOfRows(), 13)

    def test_damaged_frames_are_named(self):
        self.simulate("--set", "body.radius=0.04")
        frames = sorted((self.out / "particles").glob("*.vtu"))
        for index, content in ((0, b""), (5, frames[5].read_bytes()[:3000])):
            frames[index].write_bytes(content)
        run = SinewRun(FileName=str(self.out / "run.json"))
        run.UpdatePipelineInformation()
        self.assertIn("velocity", arrays(blocks(fetched(run, run.TimestepValues[3]))["particles"].GetPointData()))
        for index in (0, 5):
            with Messages() as messages:
                run.UpdatePipeline(run.TimestepValues[index])
            self.assertIn(f"{frames[index]}: cannot be read; see sinew info {self.out} --verify", messages.text)

    def test_what_is_no_run_is_refused_in_words(self):
        (self.folder / "run.json").write_text("{}")
        with Messages() as messages:
            SinewTables(FileName=str(self.folder / "run.json"), Table="probes").UpdatePipeline()
        self.assertIn("probes.csv: is not there", messages.text)
        (self.folder / "particles.pvd").write_text("<VTKFile")
        with Messages() as messages:
            SinewRun(FileName=str(self.folder / "run.json")).UpdatePipeline()
        self.assertIn("particles.pvd", messages.text)
        self.assertIn("restore it from a copy", messages.text)


class Packing(SmallRun):
    def filled_by_command(self, mesh, *words):
        command("fill", mesh, *words, "-o", self.folder / "filled.vtu", check=0)
        return read(self.folder / "filled.vtu")

    def same_sites(self, source, mesh, words, **properties):
        packing = ClosestPacking(Input=source, **properties)
        found, own = fetched(packing), self.filled_by_command(mesh, *words)
        numpy.testing.assert_array_equal(points(found), points(own))
        for name in ("id", "radius", "mass", "neighbors", "component"):
            numpy.testing.assert_array_equal(arrays(found.GetPointData())[name], arrays(own.GetPointData())[name])
        return packing, found

    def test_every_mesh_of_data(self):
        for mesh in sorted((SOURCE / "data/meshes").iterdir()):
            packing, found = self.same_sites(OpenDataFile(str(mesh)), mesh, ["--count", 3000], Count=3000)
            self.assertIn("python3-sinew" if MODULE else str(BIN / "sinew"), field(found, "found_by"))
            self.assertEqual(field(found, "particles"), found.GetNumberOfPoints())
            self.assertGreater(arrays(found.GetPointData())["distance"].min(), 0)
            self.assertEqual(field(fetched(packing, port=1), "open_edges"), 0)

    def test_options_are_those_of_the_command(self):
        mesh = SOURCE / "data/meshes/arm.ply"
        words = ["--radius", 0.01, "--packing", "hcp", "--lattice-rotation", "[10, 20, 30]", "--rule", "hollow"]
        self.same_sites(OpenDataFile(str(mesh)), mesh, words, Radius=0.01, Packing="hcp", Rotation=[10, 20, 30],
                        NestedShells="hollow")

    def test_tetrahedra_fill_the_volume(self):
        packing = ClosestPacking(Input=OpenDataFile(str(SOURCE / "data/meshes/box.obj")), Radius=0.02, Output="tetrahedra")
        found = fetched(packing)
        self.assertEqual(found.GetCellType(0), 10)
        corners = points(found)[vtk_to_numpy(found.GetCells().GetConnectivityArray()).reshape(-1, 4)]
        volume = abs(numpy.linalg.det(corners[:, 1:] - corners[:, :1])).sum() / 6
        self.assertAlmostEqual(volume / (0.15556349 ** 2 * 0.69296465), 1, delta=0.01)

    def clipped(self, height):
        sphere = Sphere(ThetaResolution=40, PhiResolution=40)
        clip = Clip(Input=sphere, ClipType="Plane", Invert=1)
        clip.ClipType.Normal, clip.ClipType.Origin = [0, 0, 1], [0, 0, height]
        return clip

    def test_a_sphere_clipped_above_its_middle(self):
        clip = self.clipped(0.2)
        for properties, words in (({}, []), ({"CloseHoles": 1}, ["--close-holes"])):
            packing = ClosestPacking(Input=clip, Radius=0.04, **properties)
            found = fetched(packing)
            surface = fetched(ExtractSurface(Input=clip))
            path = self.folder / "clipped.vtp"
            sinew_paraview.packing.write_polygons(sinew_paraview.packing.polygons_of(surface), str(path))
            numpy.testing.assert_array_equal(points(found), points(self.filled_by_command(path, "--radius", 0.04, *words)))
            self.assertEqual(field(found, "closed"), bool(words))
            self.assertLess(points(found)[:, 2].max(), 0.2 if words else 0.3)
        defects = fetched(ClosestPacking(Input=clip, Radius=0.04), port=1)
        self.assertEqual(set(arrays(defects.GetCellData())["defect"]), {0, 1})
        self.assertEqual(field(defects, "holes"), 1)

    def test_several_files_as_one(self):
        names = []
        for index, center in enumerate(((0, 0, 0), (0.7, 0, 0), (3, 0, 0))):  # of which two overlap
            sphere = Sphere(ThetaResolution=30, PhiResolution=30, Center=center)
            writer = vtkSTLWriter()
            writer.SetFileName(str(self.folder / f"{index}.stl"))
            writer.SetInputData(fetched(sphere))
            writer.SetFileTypeToBinary()
            writer.Write()
            names.append(str(self.folder / f"{index}.stl"))
        grouped = GroupDatasets(Input=[OpenDataFile(name) for name in names])
        packing = ClosestPacking(Input=grouped, Radius=0.05)
        found = fetched(packing)
        path = self.folder / "all.vtp"
        sinew_paraview.packing.write_polygons(sinew_paraview.packing.polygons_of(servermanager.Fetch(grouped)), str(path))
        numpy.testing.assert_array_equal(points(found), points(self.filled_by_command(path, "--radius", 0.05)))
        self.assertEqual(len(set(arrays(found.GetPointData())["component"])), 2)

    def test_a_contour_is_a_surface(self):
        wavelet = Wavelet(WholeExtent=[-8, 8, -8, 8, -8, 8])
        contour = Contour(Input=wavelet, ContourBy=["POINTS", "RTData"], Isosurfaces=[200])
        self.assertGreater(fetched(ClosestPacking(Input=contour, Radius=0.5)).GetNumberOfPoints(), 100)
        self.assertGreater(fetched(ClosestPacking(Input=wavelet, Radius=1)).GetNumberOfPoints(), 500)  # its outer faces

    def test_what_is_refused_is_said_with_its_cure(self):
        sphere = Sphere(ThetaResolution=20, PhiResolution=20)
        for source, properties, words in (
                (sphere, {}, "set Radius, or Count"), (sphere, {"Radius": 0.1, "Count": 10}, "given twice"),
                (sphere, {"Radius": 3}, "radius"), (Plane(), {"Radius": 0.1}, "thickness"),
                (Line(), {"Radius": 0.1}, "has no polygons"), (sphere, {"Radius": -1}, "radius")):
            with Messages() as messages:
                packing = ClosestPacking(Input=source, **properties)
                packing.UpdatePipeline()
            self.assertIn(words, messages.text)
            self.assertNotIn("Traceback", messages.text)
            self.assertEqual(servermanager.Fetch(packing).GetNumberOfPoints(), 0)
        self.assertEqual(field(fetched(ClosestPacking(Input=sphere), port=1), "closed"), 1)  # the mesh is diagnosed all the same

    @unittest.skipIf(MODULE, "of the command alone")
    def test_a_command_that_is_none(self):
        for path, words in (("/nowhere/sinew", "/nowhere/sinew: No such file"), ("/bin/true", "does not answer as sinew does")):
            os.environ["SINEW"] = path
            with Messages() as messages:
                ClosestPacking(Input=Sphere(), Radius=0.1).UpdatePipeline()
            self.assertIn(words, messages.text)
            self.assertIn("set SINEW", messages.text)
        os.environ["SINEW"] = str(BIN / "sinew")


def cloud(positions, ids=None, name="id"):
    """Points of a source."""
    source = ProgrammableSource(OutputDataSetType="vtkPolyData")
    source.Script = (f"import numpy\nfrom vtkmodules.util.numpy_support import numpy_to_vtk\n"
                     f"from vtkmodules.vtkCommonCore import vtkPoints\n"
                     f"values = numpy.frombuffer(bytes.fromhex('{numpy.ascontiguousarray(positions, float).tobytes().hex()}')).reshape(-1, 3)\n"
                     "places = vtkPoints()\nplaces.SetData(numpy_to_vtk(values, deep=1))\noutput.VTKObject.SetPoints(places)\n")
    if ids is not None:
        source.Script += (f"ids = numpy_to_vtk(numpy.array({list(map(int, ids))}), deep=1)\nids.SetName('{name}')\n"
                          "output.VTKObject.GetPointData().AddArray(ids)\n")
    return source


TIMES = [0, 1, 2, 3]


def packed(count):
    """A face-centered cubic packing."""
    cells = numpy.stack(numpy.meshgrid(*[range(count)] * 3, indexing="ij"), -1).reshape(-1, 1, 3)
    return (cells + numpy.array([[0, 0, 0], [0.5, 0.5, 0], [0.5, 0, 0.5], [0, 0.5, 0.5]])).reshape(-1, 3)


class Deformed(SmallRun):
    def setUp(self):
        super().setUp()
        random = numpy.random.default_rng(7)
        self.random = random
        self.rest = packed(5) + 0.05 * random.random((500, 3))

    def deformation(self, rest, now, ids=(None, None), **properties):
        return arrays(fetched(Deformation(Input=cloud(now, ids[1]), Reference=cloud(rest, ids[0]), **properties)).GetPointData())

    def test_affine_motion_in_closed_form(self):
        U, _, V = numpy.linalg.svd(self.random.random((3, 3)))
        R, V = U * [1, 1, numpy.linalg.det(U)], V * [[1], [1], [numpy.linalg.det(V)]]
        stretches = numpy.array([1.3, 1.1, 0.8])
        F = R @ V.T @ numpy.diag(stretches) @ V
        found = self.deformation(self.rest, self.rest @ F.T + [3, -2, 1])
        near = dict(rtol=0, atol=1e-12)
        numpy.testing.assert_allclose(found["F"].reshape(-1, 3, 3), numpy.broadcast_to(F, (500, 3, 3)), **near)
        numpy.testing.assert_allclose(found["J"], stretches.prod(), **near)
        E = (F.T @ F - numpy.eye(3)) / 2
        numpy.testing.assert_allclose(found["strain"], numpy.tile(E[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]], (500, 1)), **near)
        numpy.testing.assert_allclose(found["stretch"], numpy.tile(stretches, (500, 1)), **near)
        numpy.testing.assert_allclose(found["D2min"], 0, **near)
        turned = R @ V.T @ V  # R of F = R U
        numpy.testing.assert_allclose(found["R"].reshape(-1, 3, 3), numpy.broadcast_to(turned, (500, 3, 3)), **near)
        angle = numpy.degrees(numpy.arccos((numpy.trace(turned) - 1) / 2))
        numpy.testing.assert_allclose(found["rotation"], angle, rtol=0, atol=1e-6)

    def test_points_are_matched_by_ids(self):
        order = self.random.permutation(500)
        moved = 1.5 * self.rest[order][:450]  # in another order, and some are lost
        found = self.deformation(self.rest, moved, (numpy.arange(500), order[:450]))
        self.assertEqual(len(found["J"]), 450)
        known = numpy.isfinite(found["J"])  # not at corners that have lost their neighbors
        self.assertGreater(known.sum(), 430)
        numpy.testing.assert_allclose(found["J"][known], 1.5 ** 3, rtol=1e-12)

    def test_what_tells_points_apart(self):
        order = self.random.permutation(500)
        now = 1.2 * self.rest[order]
        sources = [cloud(self.rest, numpy.arange(500), "tag"), cloud(now, order, "tag")]
        found = fetched(Deformation(Reference=sources[0], Input=sources[1], IdArray="tag"))
        numpy.testing.assert_allclose(arrays(found.GetPointData())["J"], 1.2 ** 3, rtol=1e-12)
        self.assertIn("python3-sinew" if MODULE else "NumPy", field(found, "found_by"))
        for ids, properties, words in (((range(500), None), {}, "at rest have ids"), ((None, range(500)), {}, "later moment have ids"),
                                       ((range(500), range(500)), {"IdArray": "tag"}, "no array tag"),
                                       ((range(500), range(500, 1000)), {}, "no id is in both")):
            with Messages() as messages:
                self.deformation(self.rest, now, ids, **properties)
            self.assertIn(words, messages.text)

    def test_the_package_and_numpy_find_the_same(self):
        if not MODULE:
            self.skipTest("without the package")
        from sinew_parts import deformation
        now = self.rest + 0.05 * self.random.random((500, 3))
        now[::9] = numpy.nan
        rest = numpy.vstack([self.rest, [[50, 0, 0], [50.5, 0, 0]]])  # too few to have a gradient
        now = numpy.vstack([now, rest[-2:]])
        for cutoff in (0.85, 1.3):
            one = deformation.ByNumPy(rest, cutoff).gradients(now)
            other = deformation.ByModule(deformation.package("RestShape"), rest, cutoff).gradients(now)
            self.assertGreater(numpy.isfinite(one[1]).sum(), 300)
            self.assertTrue(numpy.isnan(one[0][-2:]).all())
            for a, b in zip(one, other):
                numpy.testing.assert_allclose(a, b, rtol=0, atol=1e-12)

    def test_moments_of_one_filter_are_those_of_fresh_ones(self):
        """Whatever it keeps between moments, and however its properties and its input change."""
        self.simulate()
        run = SinewRun(FileName=str(self.out / "run.json"))
        kept = Deformation(Input=run)
        for time, properties in ((0.2, {}), (0.1, {}), (0.1, {"ReferenceTime": 0.2}), (0.3, {"ReferenceTime": 0.2}),
                                 (0.3, {"ReferenceTime": 0.2, "Cutoff": 0.09}), (0.2, {"Cutoff": 0.09})):
            kept.ReferenceTime, kept.Cutoff = properties.get("ReferenceTime", 0), properties.get("Cutoff", 0)
            found, fresh = (fetched(one, time) for one in (kept, Deformation(Input=run, **properties)))
            for name, values in arrays(fresh.GetPointData()).items():
                numpy.testing.assert_array_equal(arrays(found.GetPointData())[name], values, name)
        moved = Transform(Input=run)
        kept = Deformation(Input=moved, Cutoff=0.12)
        before = points(fetched(kept, 0.2))
        moved.Transform.Scale = [2, 2, 2]
        after = fetched(kept, 0.2)
        numpy.testing.assert_allclose(points(after), 2 * before, rtol=1e-6)
        expected = arrays(fetched(Deformation(Input=run, Cutoff=0.06), 0.2).GetPointData())["J"]
        numpy.testing.assert_allclose(arrays(after.GetPointData())["J"], expected, rtol=1e-4)

    def growing(self):
        """At 0, 1, 2 and 3 s the rest times 1, 2, 3 and 4."""
        script = cloud(self.rest, range(500)).Script
        return ProgrammableSource(OutputDataSetType="vtkPolyData", ScriptRequestInformation=f"""
info = self.GetExecutive().GetOutputInformation(0)
for time in {TIMES}:
    info.Append(self.GetExecutive().TIME_STEPS(), float(time))
for time in ({TIMES[0]}, {TIMES[-1]}):
    info.Append(self.GetExecutive().TIME_RANGE(), float(time))""", Script=script + """
info = self.GetExecutive().GetOutputInformation(0)
time = info.Get(self.GetExecutive().UPDATE_TIME_STEP()) if info.Has(self.GetExecutive().UPDATE_TIME_STEP()) else 0.0
places.SetData(numpy_to_vtk(values * (1 + time), deep=1))
output.VTKObject.GetInformation().Set(output.VTKObject.DATA_TIME_STEP(), time)
""")

    def assert_grown(self, source, time, reference=0):
        data = fetched(source, time)
        for one in (blocks(data).values() if hasattr(data, "GetBlock") else [data]):
            numpy.testing.assert_allclose(arrays(one.GetPointData())["J"], ((1 + time) / (1 + reference)) ** 3, rtol=1e-10)

    def test_filters_that_share_a_source(self):
        base = self.growing()
        first, second = Deformation(Input=base), Deformation(Input=base, ReferenceTime=3)
        found = fetched(GroupDatasets(Input=[first, second]), 2)
        for block, expected in ((0, 27), (1, 27 / 64)):
            numpy.testing.assert_allclose(arrays(found.GetBlock(block).GetPointData())["J"], expected, rtol=1e-10)
        self.assert_grown(first, 1)
        self.assert_grown(second, 1, 3)
        self.assert_grown(Deformation(Input=base, Reference=base), 1)
        beside = Deformation(Input=Transform(Input=base), Reference=Transform(Input=base))
        for time in (1, 3, 0, 2):
            self.assert_grown(beside, time)

    def test_inputs_that_change(self):
        base, other = self.growing(), cloud(2 * self.rest, range(500))
        one = Deformation(Input=base)
        one.Reference = other
        numpy.testing.assert_allclose(arrays(fetched(one, 3).GetPointData())["J"], 8, rtol=1e-10)
        one.Reference = None
        self.assert_grown(one, 3)
        scaled, plain = Transform(Input=base), Transform(Input=base)
        scaled.Transform.Scale = [2, 2, 2]
        two = Deformation(Input=scaled)
        for source in (scaled, plain):
            source.UpdatePipeline(1)
        base.Script += "\n"
        for source in (scaled, plain):
            source.UpdatePipeline(1)
        self.assert_grown(two, 1)
        two.Input = plain
        self.assert_grown(two, 1)
        self.assert_grown(two, 2)

    def test_a_moment_that_cannot_be_read(self):
        files = []
        for time in range(4):
            files.append(str(self.folder / f"points_{time}.vtp"))
            SaveData(files[-1], cloud(self.rest * (1 + time), range(500)))
        (self.folder / "points_2.vtp").unlink()
        found = Deformation(Input=OpenDataFile(files))
        self.assert_grown(found, 1)
        for properties, time in (({}, 2), ({"ReferenceTime": 2}, 1), ({"ReferenceTime": 1}, 2)):
            with Messages() as messages:
                for one in (found, Deformation(Input=OpenDataFile(files))):
                    for name, value in properties.items():
                        setattr(one, name, value)
                    one.UpdatePipeline(time)
            self.assertNotIn("Traceback", messages.text)
        found.ReferenceTime = 0
        self.assert_grown(found, 3)

    def test_ids_of_other_kinds(self):
        order = self.random.permutation(500)

        def named(positions, ids, of_input):
            source = cloud(positions)
            source.Script += (f"from vtkmodules.vtkCommonCore import vtkStringArray\nnames = vtkStringArray()\nnames.SetName('id')\n"
                              f"for i in {list(map(int, ids))}:\n    names.InsertNextValue('atom %d' % i)\n"
                              "output.VTKObject.GetPointData().AddArray(names)\n") if of_input == "texts" else (
                              f"ids = numpy_to_vtk(numpy.array({list(map(int, ids))}), deep=1, array_type=12)\nids.SetName('numbers')\n"
                              "output.VTKObject.GetPointData().SetGlobalIds(ids)\n") if of_input == "global" else (
                              f"ids = numpy_to_vtk(numpy.array({[[int(i), 0] for i in ids]}), deep=1)\nids.SetName('id')\n"
                              "output.VTKObject.GetPointData().AddArray(ids)\n")
            return source

        for kind in ("texts", "global"):
            rest, now = named(self.rest, range(500), kind), named(2 * self.rest[order], order, kind)
            numpy.testing.assert_allclose(arrays(fetched(Deformation(Input=now, Reference=rest)).GetPointData())["J"], 8, rtol=1e-10)
        pairs = [named(self.rest, range(500), "pairs")] * 2
        mixed = cloud(self.rest, range(500)), named(self.rest, range(500), "texts")
        for (rest, now), words in ((pairs, "2 numbers"), (mixed, "texts at the other")):
            with Messages() as messages:
                Deformation(Input=now, Reference=rest).UpdatePipeline()
            self.assertIn(words, messages.text)
            self.assertNotIn("Traceback", messages.text)
        self.simulate()
        with Messages() as messages:
            Deformation(Input=SinewRun(FileName=str(self.out / "run.json")), IdArray="nonsense").UpdatePipeline(0.1)
        self.assertIn("no array nonsense", messages.text)

    def test_points_of_grids_and_of_several_data_sets(self):
        grid = ProgrammableSource(OutputDataSetType="vtkRectilinearGrid", Script="""
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
axis = numpy_to_vtk(numpy.arange(5.0), deep=1)
output.VTKObject.SetDimensions(5, 5, 5)
for name in "XYZ":
    getattr(output.VTKObject, "Set%sCoordinates" % name)(axis)
""")
        found = arrays(fetched(Deformation(Input=grid, Reference=grid, Cutoff=1.8)).GetPointData())
        numpy.testing.assert_allclose(found["J"], 1, rtol=1e-12)
        halves = [GroupDatasets(Input=[cloud(scale * self.rest[:250], range(250)), cloud(scale * self.rest[250:], range(250, 500))])
                  for scale in (1, 2)]
        found = arrays(fetched(Deformation(Input=halves[1], Reference=halves[0])).GetPointData())
        numpy.testing.assert_allclose(found["J"], 8, rtol=1e-10)
        numpy.testing.assert_array_equal(found["id"], numpy.arange(500))

    def test_what_an_affine_motion_does_not_explain(self):
        """Neighbors of a point that moves by itself: D2min is the mean of its own motion's square over them."""
        now = self.rest.copy()
        now[222] += [0, 0, 0.1]
        found = self.deformation(self.rest, now, Cutoff=0.85)
        far = numpy.linalg.norm(self.rest - self.rest[222], axis=1) > 0.9
        numpy.testing.assert_allclose(found["D2min"][far], 0, atol=1e-20)
        self.assertAlmostEqual(found["D2min"][222], 0.01, delta=0.003)

    def test_mirrored_and_flat_clouds(self):
        found = self.deformation(self.rest, self.rest * [1, 1, -1])
        numpy.testing.assert_allclose(found["J"], -1, rtol=1e-12)
        numpy.testing.assert_allclose(numpy.linalg.det(found["R"].reshape(-1, 3, 3)), 1, rtol=1e-12)
        found = self.deformation(self.rest * [1, 1, 0], self.rest)
        self.assertTrue(numpy.isnan(found["J"]).all())

    def test_a_run_against_its_first_moment(self):
        """As sinew measures it."""
        self.simulate("--set", "output.arrays=F, J", "--set", "body.radius=0.02", "--set", "output.double_precision=true")
        particles = ExtractBlock(Input=SinewRun(FileName=str(self.out / "run.json")), Selectors=["/Root/particles"])
        measured = arrays(fetched(OpenDataFile(str(self.out / "particles.pvd")), 0.2).GetPointData())
        found = arrays(fetched(Deformation(Input=particles), 0.2).GetPointData())
        whole = SinewRun(FileName=str(self.out / "run.json"))
        numpy.testing.assert_array_equal(arrays(fetched(Deformation(Input=whole), 0.2).GetPointData())["F"], found["F"])
        other = fetched(Deformation(Input=particles, Reference=whole, ReferenceTime=0), 0.2)
        numpy.testing.assert_array_equal(arrays(other.GetPointData())["F"], found["F"])
        at_first = arrays(fetched(Deformation(Input=particles, ReferenceTime=0.2)).GetPointData())
        inverse = numpy.linalg.inv(found["F"].reshape(-1, 3, 3))
        self.assertLess(numpy.nanmedian(abs(at_first["F"].reshape(-1, 3, 3) - inverse)), 0.01)
        self.assertGreater(numpy.nanmax(abs(at_first["J"] - 1)), 0.02)
        self.assertGreater(numpy.isfinite(found["F"]).all(1).sum(), 100)
        known = numpy.isfinite(found["J"])
        numpy.testing.assert_allclose(found["F"][known], measured["F"][known], atol=1e-6)
        numpy.testing.assert_array_equal(found["J_of_input"], measured["J"])
        self.assertGreater(abs(measured["J"] - 1).max(), 0.02)

    def test_a_dump_of_lammps(self):
        """A block of atoms that LAMMPS shears: F by the box's own numbers."""
        steps = self.folder / "in.shear"
        steps.write_text("""units lj
lattice fcc 1.0
region all prism 0 4 0 4 0 4 0 0 0
create_box 1 all
create_atoms 1 box
mass 1 1.0
pair_style zero 2.0
pair_coeff * *
dump 1 all custom 1 %s id x y z
dump_modify 1 sort id format float %%.17g
run 0
change_box all xy delta 0.6 remap units box
change_box all z scale 1.1 remap units box
reset_timestep 1
run 0
""" % (self.folder / "shear.dump"))
        done = subprocess.run(["lmp", "-in", steps, "-log", "none", "-screen", "none"], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
        moments = []
        for part in (self.folder / "shear.dump").read_text().split("ITEM: TIMESTEP")[1:]:
            rows = part.split("ITEM: ATOMS id x y z\n")[1].strip().splitlines()
            moments.append(numpy.array([list(map(float, row.split())) for row in rows]))
        (rest, now), side = moments, 4 * 4 ** (1 / 3)
        found = self.deformation(rest[:, 1:], now[:, 1:], (rest[:, 0], now[:, 0]))
        numpy.testing.assert_allclose(found["F"], numpy.tile([1, 0.6 / side, 0, 0, 1, 0, 0, 0, 1.1], (len(rest), 1)), atol=1e-12)

    def test_what_is_refused(self):
        for rest, now, ids, properties, words in (
                (self.rest, self.rest[:10], (None, None), {}, "no ids"),
                (self.rest, self.rest, ([1] * 500, range(500)), {}, "same id"),
                (self.rest, self.rest, (None, None), {"Cutoff": -1}, "cutoff"),
                (self.rest * 0, self.rest, (None, None), {}, "upon each other")):
            with Messages() as messages:
                self.deformation(rest, now, ids, **properties)
            self.assertIn(words, messages.text)
            self.assertNotIn("Traceback", messages.text)
        broken = self.rest.copy()
        broken[3, 1] = numpy.nan
        with Messages() as messages:
            self.deformation(broken, self.rest)
        self.assertIn("not finite", messages.text)
        with Messages() as messages:
            Deformation(Input=cloud(self.rest)).UpdatePipeline()
        self.assertIn("one moment", messages.text)


if __name__ == "__main__":
    unittest.main(argv=["plugin_paraview_test", "-v", *sys.argv[3:]])
