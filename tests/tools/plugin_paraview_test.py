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

sys.path.insert(0, str(Path(__file__).parent))
from plugin_support import *


OF_PARTICLES = '{"series": {"particles": {"cells": "vertex"}}}'


class Reader(SmallRun):
    def same_as_paraview(self, folder):
        """All series of a run, as ParaView's own reader has them."""
        run = SinewRun(FileName=str(folder / "run.json"))
        run.UpdatePipelineInformation()
        names = [path.stem for path in folder.glob("*.pvd")]
        times = list(run.TimestepValues)
        for moment in (times[0], times[len(times) // 2], times[-1]):
            found = blocks(fetched(run, moment))
            self.assertEqual(sorted(found), sorted(names))
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
                      "--set", "body.radius=0.04", "--set", "output.skin_lbs=true")
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
        words = ["simulate", "--quiet", self.scene, "-o", self.out, "--set", "body.radius=0.0125", "--set", "solver.duration=60",
                 "--set", "output.interval=0.05", "--set", "output.checkpoint_interval=0.5"]
        going = subprocess.Popen([BIN / "sinew", *words])
        try:
            self.wait_for(lambda: (self.out / "particles.pvd").is_file() and self.rows() >= 3)
            going.send_signal(signal.SIGSTOP)  # it would end while ParaView begins
            run = SinewRun(FileName=str(self.out / "run.json"))
            run.UpdatePipelineInformation()
            first = len(run.TimestepValues)
            self.assertGreaterEqual(first, 3)
            going.send_signal(signal.SIGCONT)
            self.wait_for(lambda: self.rows() > first)
            keeper = GetTimeKeeper()
            self.assertTrue(run.GetClientSideObject().GetNeedsUpdate())
            self.assertGreater(len(run.TimestepValues), first)
            self.assertIn(run.TimestepValues[-1], list(keeper.TimestepValues))  # the window's list of times
            self.assertIn("particles", blocks(fetched(run, run.TimestepValues[-1])))
        finally:
            going.send_signal(signal.SIGKILL)
            going.wait()
        command(*words, "--resume", check=0)
        run.UpdatePipelineInformation()
        self.same_as_paraview(self.out)

    def test_a_record_lists_what_is_read(self):
        """That of an older run by its arrays, and none until it is written."""
        self.simulate("--set", "body.radius=0.04", "--set", "output.skin_lbs=true")
        record = json.loads((self.out / "run.json").read_text())
        names = {"particles", "surface", "bones", "frames", "skin_lbs"}
        for changed, expected in (({}, names), ({"series": None}, names), ({"series": None, "arrays": None}, set()),
                                  ({"series": {"surface": {}, "../particles": {}, "bones": 1}}, {"surface"}), (7, set())):
            (self.out / "run.json").write_text(json.dumps({**record, **changed} if isinstance(changed, dict) else changed))
            run = SinewRun(FileName=str(self.out / "run.json"))
            run.UpdatePipelineInformation()
            self.assertEqual(set(run.Series.GetAvailable()), expected)

    def test_the_live_source_has_the_newest_frame_of_all(self):
        self.simulate("--set", "body.radius=0.04")
        text = (self.out / "surface.pvd").read_text()
        source = SinewSeries(FileName=str(self.out / "run.json"), Series="particles", Vectors="force_bone", ArrowLength=0.1)
        last = fetched(source)
        self.assertAlmostEqual(field(last, "TimeValue"), 0.4)
        arrows = arrays(last.GetPointData())["arrow"]
        self.assertAlmostEqual(numpy.linalg.norm(arrows, axis=1).max(), 0.1)
        self.assertFalse(source.GetClientSideObject().GetNeedsUpdate())
        lines = text.splitlines(keepends=True)
        (self.out / "surface.pvd").write_text("".join(lines[:6] + lines[-2:]))  # of a run that has written three frames
        self.assertTrue(source.GetClientSideObject().GetNeedsUpdate())
        third = fetched(source)
        self.assertAlmostEqual(field(third, "TimeValue"), 2 / 30, places=5)
        self.assertLess(numpy.linalg.norm(arrays(third.GetPointData())["arrow"], axis=1).max(), 0.1)  # the largest was before
        (self.out / "particles.pvd").unlink()
        with Messages() as messages:
            source.UpdatePipeline()
        self.assertEqual(messages.text, "")

    def test_rounding_is_drawn_as_zero(self):
        grid = blocks(fetched(self.small_run()))["particles"]
        values = {"strain_eq": 1e-12, "displacement": 1e-12, "force_pair": 1e-12, "radius": 1e-12}
        for name, factor in values.items():
            array = grid.GetPointData().GetArray(name)
            before = vtk_to_numpy(array)
            before[:] = factor * (1 + numpy.random.default_rng(1).random(before.shape))
        sinew_paraview.run_files.without_rounding(grid)
        found = {name: abs(vtk_to_numpy(grid.GetPointData().GetArray(name))).max() for name in values}
        self.assertEqual((found["strain_eq"], found["displacement"]), (0, 0))
        self.assertGreater(found["force_pair"], 0)  # whose scale nobody knows
        self.assertGreater(abs(vtk_to_numpy(grid.GetPointData().GetArray("id"))).max(), 0)

    def small_run(self):
        self.simulate("--set", "body.radius=0.04")
        return SinewRun(FileName=str(self.out / "run.json"))

    def test_the_macro_shows_a_run_by_its_state(self):
        run = self.small_run()
        sys.path.append(str(SOURCE / "tools/paraview/macros"))
        import show_run
        moved = self.folder / "moved"
        self.out.rename(moved)
        run.FileName = str(moved / "run.json")
        show_run.show_run(run)
        names = {name for name, _ in GetSources()}
        self.assertLessEqual({"cut-away body", "bone tubes", "surface.pvd"}, names)
        self.assertEqual(FindSource("surface.pvd").FileName, str(moved / "surface.pvd"))
        with self.assertRaisesRegex(RuntimeError, "select a run"):
            show_run.show_run(FindSource("surface.pvd"))

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
            self.assertNotIn("vtkXML", messages.text)  # its readers are not given what may crash them
            self.assertIn(f"{frames[index]}: cannot be read; see sinew info {self.out} --verify", messages.text)

    def test_what_is_no_run_is_refused_in_words(self):
        (self.folder / "run.json").write_text(OF_PARTICLES)
        with Messages() as messages:
            SinewTables(FileName=str(self.folder / "run.json"), Table="probes").UpdatePipeline()
        self.assertIn("probes.csv: is not there", messages.text)
        (self.folder / "particles.pvd").write_text("<VTKFile")
        with Messages() as messages:
            SinewRun(FileName=str(self.folder / "run.json")).UpdatePipeline()
        self.assertIn("particles.pvd", messages.text)
        self.assertIn("restore it from a copy", messages.text)


    def refused(self, show):
        """The one line that is shown, maybe several times, within seconds."""
        begin = time.monotonic()
        with Messages() as messages:
            show()
        self.assertLess(time.monotonic() - begin, 20)
        lines = set(filter(None, messages.text.splitlines()))
        self.assertEqual(len(lines), 1, messages.text)
        return lines.pop()

    def placed(self, path, content):
        """Puts bytes, or what a function makes, in the place of a file."""
        if path.is_dir() and not path.is_symlink():
            path.rmdir()
        path.unlink(missing_ok=True)
        path.write_bytes(content) if isinstance(content, bytes) else content(path)

    def test_series_that_are_none_are_refused_in_a_line(self):
        run = self.folder / "run.json"
        run.write_text(OF_PARTICLES)
        pvd = self.folder / "particles.pvd"

        def naming(time, head="<?xml version='1.0'?>"):
            return f'{head}<VTKFile><Collection><DataSet timestep="{time}" file="a.vtu"/></Collection></VTKFile>'.encode()
        outside = self.folder.parent / f"{self.folder.name}.pvd"
        outside.write_bytes(naming(0))
        self.addCleanup(outside.unlink)
        for content in (naming("abc"), naming("nan"), naming(0, "<?xml version='1.0' encoding='nonsense'?>"),
                        naming(0, "<?xml version='1.0' encoding='utf-32'?>"), b"<VTKFile", b"", os.mkfifo,
                        os.mkdir, lambda path: path.symlink_to(path), lambda path: path.symlink_to("/dev/zero"),
                        lambda path: path.symlink_to(outside)):
            self.placed(pvd, content)
            line = self.refused(lambda: SinewRun(FileName=str(run)).UpdatePipeline())
            self.assertRegex(line, r"^ERROR: SinewRun: .*particles\.pvd: .*restore it from a copy, or run the scene again")

    def test_frames_outside_of_the_folder_are_not_read(self):
        self.simulate("--set", "body.radius=0.04")
        run, pvd = self.out / "run.json", self.out / "particles.pvd"
        frame = sorted((self.out / "particles").glob("*.vtu"))[0]
        other = self.folder / "other.vtu"
        other.write_bytes(frame.read_bytes())
        (self.out / "link.vtu").symlink_to(other)
        os.mkfifo(self.out / "pipe.vtu")
        for name, is_read in ((frame.relative_to(self.out), True), ("../other.vtu", False), (other, False),
                              ("link.vtu", False), ("pipe.vtu", False), ("particles", False)):
            pvd.write_text(f'<VTKFile><Collection><DataSet timestep="0" file="{name}"/></Collection></VTKFile>')
            source = SinewRun(FileName=str(run))
            source.UpdatePipelineInformation()
            source.Series = ["particles"]
            if is_read:
                self.assertGreater(blocks(fetched(source))["particles"].GetNumberOfPoints(), 0)
            else:
                self.assertIn("cannot be read; see sinew info", self.refused(source.UpdatePipeline))

    def table(self, *rows, name="bones"):
        (self.folder / "run.json").write_text("{}")
        path = self.folder / f"{name}.csv"
        if rows:
            path.write_text("\n".join(rows))
        source = SinewTables(FileName=str(self.folder / "run.json"), Table=name)
        source.UpdatePipeline()
        found = servermanager.Fetch(source)
        return {found.GetColumnName(i): [found.GetValue(row, i).ToDouble() for row in range(found.GetNumberOfRows())]
                for i in range(found.GetNumberOfColumns())}

    def test_a_torn_row_alone_is_left_out(self):
        rows = ["time,bone,x,y", "0,a,1,2", "0,b,3,", "1,a,5,6"]
        whole = self.table(*rows, "")
        self.assertEqual((whole["time"], whole["a x"], whole["b x"][:1]), ([0, 1], [1, 5], [3]))
        for torn in ("2,a,7.1e,9\n", "2,a,7\n", "x,a,7,9\n", "2,a,7,1", "2,\"a"):
            numpy.testing.assert_equal(self.table(*rows, torn), whole)
        self.assertEqual(self.table("time,volume", "0,1", "1,2e", "", name="metrics"), {"time": [0], "volume": [1]})
        self.assertEqual(self.table("time,bone,x", ""), {"time": []})

    def test_tables_take_the_time_of_their_rows(self):
        names = ",".join(f"c{i}" for i in range(21))
        rows = [f"{at},b{bone}," + ",".join(["1.25"] * 21) for at in range(10) for bone in range(1500)]
        begin = time.process_time()
        found = self.table(f"time,bone,{names}", *rows, "")
        self.assertEqual(len(found), 1 + 21 * 1500)
        self.assertLess(time.process_time() - begin, 10)

    def test_tables_that_are_none_are_refused_in_a_line(self):
        path = self.folder / "bones.csv"
        for content in (os.mkfifo, os.mkdir, lambda path: path.symlink_to("/dev/zero"), lambda path: path.symlink_to(path),
                        b"time,bone,x\n0,a," + b"1" * 200_000 + b"\n",
                        b"time,bone,x\n" + b"".join(b"%d,b%d,1\n" % (i, i) for i in range(1000))):
            self.placed(path, content)
            self.assertRegex(self.refused(self.table), r"^ERROR: SinewTables: .*restore it from a copy, or run the scene again")


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
            sinew_paraview.packing.write_polygons(sinew_paraview.packing.polygons_of(surface)[0], str(path))
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
        sinew_paraview.packing.write_polygons(sinew_paraview.packing.polygons_of(servermanager.Fetch(grouped))[0], str(path))
        numpy.testing.assert_array_equal(points(found), points(self.filled_by_command(path, "--radius", 0.05)))
        self.assertEqual(len(set(arrays(found.GetPointData())["component"])), 2)

    def test_ghosts_and_hidden_cells_are_left_out_and_told(self):
        script = """
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkAppendFilter
append = vtkAppendFilter()
for begin in (0, 2):  # each of 3 x 2 x 2 boxes, of which 2 x 2 are in both
    boxes = vtkImageData()
    boxes.SetExtent(begin, begin + 3, 0, 2, 0, 2)
    append.AddInputData(boxes)
append.SetMergePoints(MERGED)
append.Update()
output.VTKObject.ShallowCopy(append.GetOutput())
flags = numpy.zeros(24, numpy.uint8)
flags[12::3] = 1
flags[:HIDDEN] = 32
flags = numpy_to_vtk(flags, deep=1)
flags.SetName("vtkGhostType")
output.VTKObject.GetCellData().AddArray(flags)
"""
        for merged, hidden, left_out, volume in ((0, 0, 4, 20), (1, 0, 4, 20), (1, 12, 16, 8)):
            source = ProgrammableSource(OutputDataSetType="vtkUnstructuredGrid")
            source.Script = script.replace("MERGED", str(merged)).replace("HIDDEN", str(hidden))
            found = fetched(ClosestPacking(Input=source, Radius=0.2), port=1)
            self.assertAlmostEqual(field(found, "volume"), volume, 9)
            self.assertEqual((field(found, "open_edges"), field(found, "crowded_edges")), (0, 0))
            self.assertIn(f"hidden: {left_out}", field(found, "warnings"))

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


if __name__ == "__main__":
    unittest.main(argv=["plugin_paraview_test", "-v", *sys.argv[3:]])
