# SPDX-License-Identifier: GPL-3.0-or-later
"""pvbatch volume_paraview_test.py BIN SOURCE [TESTS]: what ParaView's filters make of the series volume of every scene in
configs, and what the plugin's reader has of its run.

Their time is as shipped, that of groups cut short; bodies other than boxes have 3,000 particles. SINEW_FIGURES=1 in
the environment prints the figures of lib/sinew/volume/README.md.
"""
import csv
import functools
import os
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ET
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy
from paraview import servermanager
from paraview.simple import *
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

BIN, SOURCE = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
COMMON = ["output.volume=true", "output.arrays=J, strain, energy_density"]
COARSE = ["body.radius=none", "body.count=3000"]
SCENES = {path.stem: [] for path in sorted((SOURCE / "configs").glob("*.yaml"))}
for _name in ("arm_bend", "creature_walk", "fox_bvh", "fox_glb", "tentacle_curl", "two_fingers"):
    SCENES[_name] = COARSE
SCENES["hierarchy"] = ["hierarchy.enabled=false", "solver.duration=0.6"] + COARSE
BONDED = ["bar_pull", "hierarchy", "limb_press", "tentacle_curl"]
BREAKING = ["material.breaking_strain=0.04", "solver.duration=0.6"]
BOX = (0.15556349, 0.15556349, 0.69296465)  # m, data/meshes/box.obj


def sinew(*words):
    done = subprocess.run([BIN / "sinew", *map(str, words)], capture_output=True, text=True, timeout=300)
    if done.returncode:
        raise AssertionError(f"{words} ended with {done.returncode}:\n{done.stderr}")


def duration_of(scene, settings):
    lines = [*settings, *(SOURCE / f"configs/{scene}.yaml").read_text().replace(": ", "=").split("\n")]
    return next(float(line.split("=")[1]) for line in lines if "duration=" in line)


def simulate(folder, scene, settings):
    """Three moments of a run, measured."""
    sets = [*COMMON, *settings, f"output.interval={duration_of(scene, settings) / 2}"]
    sinew("simulate", SOURCE / f"configs/{scene}.yaml", "-o", folder, *(word for one in sets for word in ("--set", one)))
    sinew("measure", "--quiet", folder)


def setUpModule():
    global scratch, RUNS
    scratch = tempfile.TemporaryDirectory()
    RUNS = Path(scratch.name)
    tasks = [(RUNS / name, name, settings) for name, settings in SCENES.items()]
    tasks.append((RUNS / "breaking", "bar_pull", BREAKING))
    with ThreadPoolExecutor(2) as pool:
        for done in [pool.submit(simulate, *task) for task in tasks]:
            done.result()


def tearDownModule():
    scratch.cleanup()


@functools.cache
def opened(run, series="volume"):
    return PVDReader(FileName=str(RUNS / run / f"{series}.pvd"))


def times_of(run):
    rows = ET.parse(RUNS / run / "volume.pvd").getroot().iter("DataSet")
    return [float(row.get("timestep")) for row in rows]


def fetched(source, time):
    source.UpdatePipeline(time)
    return servermanager.Fetch(source)


def points_of(data):
    return vtk_to_numpy(data.GetPoints().GetData()).astype(float)


def values_of(data, name, cells=False):
    array = (data.GetCellData() if cells else data.GetPointData()).GetArray(name)
    return vtk_to_numpy(array).astype(float)


def magnitudes(vectors):
    return numpy.linalg.norm(vectors, axis=1)


def metrics_of(run):
    with open(RUNS / run / "metrics.csv", encoding="utf-8") as file:
        return [{name: float(value) if value else numpy.nan for name, value in row.items()} for row in csv.DictReader(file)]


def integrals(source, time, *names):
    """Volume, and of arrays of points."""
    data = fetched(IntegrateVariables(Input=source), time)
    return [values_of(data, "Volume", cells=True)[0], *(values_of(data, name)[0] for name in names)]


def at_rest(source):
    return WarpByVector(Input=source, Vectors=["POINTS", "displacement"], ScaleFactor=-1)


def place_at_rest(source, axis):
    return Calculator(Input=source, ResultArrayName="place", Function=f"coords{axis}-displacement_{axis}")


class OfEveryScene(unittest.TestCase):
    def for_each_frame(self, check):
        for run in SCENES:
            for time in times_of(run):
                with self.subTest(run, time=time):
                    check(opened(run), time, run)

    def test_a_slice_has_all_arrays_everywhere(self):
        def check(source, time, run):
            low, high = numpy.array(fetched(source, time).GetBounds()).reshape(3, 2).T
            plane = Slice(Input=source, SliceType="Plane", Triangulatetheslice=1)
            plane.SliceType.Origin = list((low + high) / 2)
            plane.SliceType.Normal = [float(axis == numpy.argmax(high - low)) for axis in range(3)]
            cut = fetched(plane, time)
            self.assertGreater(cut.GetNumberOfCells(), 100)
            crushed = values_of(fetched(source, time), "J").min() <= 0.05
            for k in range(cut.GetPointData().GetNumberOfArrays()):
                name = cut.GetPointData().GetArrayName(k)
                if not (crushed and name == "von_mises"):  # what is flat has no true stress
                    self.assertTrue(numpy.isfinite(values_of(cut, name)).all(), name)
            if time == 0 and "box" in run:
                area = values_of(fetched(IntegrateVariables(Input=plane), time), "Area", cells=True)[0]
                self.assertLess(abs(area / (BOX[0] * BOX[1]) - 1), 0.002)

        self.for_each_frame(check)

    def test_a_contour_of_places_at_rest_is_a_plane_there(self):
        def check(source, time, _):
            low, high = numpy.array(fetched(source, 0).GetBounds()).reshape(3, 2).T
            axis = int(numpy.argmax(high - low))
            value = float(low[axis] + 0.4321 * (high - low)[axis])
            sheet = fetched(Contour(Input=place_at_rest(source, "XYZ"[axis]), ContourBy=["POINTS", "place"],
                                    Isosurfaces=[value], ComputeScalars=1), time)
            self.assertGreater(sheet.GetNumberOfCells(), 100)
            place = (points_of(sheet) - values_of(sheet, "displacement"))[:, axis]
            self.assertLess(abs(place - value).max(), 1e-6 * (high - low).max())

        self.for_each_frame(check)

    def test_a_contour_of_strain_parts_less_from_more(self):
        def check(source, time, _):
            strain = values_of(fetched(source, time), "strain_eq")
            value = float(numpy.median(strain))
            if not strain.max() - strain.min() > 1e-6:
                return
            sheet = fetched(Contour(Input=source, ContourBy=["POINTS", "strain_eq"], Isosurfaces=[value],
                                    ComputeScalars=1), time)
            self.assertGreater(sheet.GetNumberOfCells(), 100)
            self.assertLess(abs(values_of(sheet, "strain_eq") - value).max(), 1e-5 * strain.max())

        self.for_each_frame(check)

    def test_stream_lines_follow_the_displacement(self):
        for run in SCENES:
            with self.subTest(run):
                moved = {time: magnitudes(values_of(fetched(opened(run), time), "displacement")) for time in times_of(run)}
                time = max(moved, key=lambda one: moved[one].mean())
                data = fetched(opened(run), time)
                middle = points_of(data)[numpy.argsort(moved[time])[len(moved[time]) * 3 // 4]]
                size = float(numpy.ptp(points_of(data), axis=0).max())
                tracer = StreamTracer(Input=opened(run), SeedType="Point Cloud", Vectors=["POINTS", "displacement"],
                                      MaximumStreamlineLength=size)
                tracer.SeedType.Center, tracer.SeedType.Radius, tracer.SeedType.NumberOfPoints = list(middle), 0.05 * size, 50
                lines = fetched(tracer, time)
                self.assertGreater(lines.GetNumberOfCells(), 10)
                self.assertGreater(self.share_along(lines), 0.98)

    @staticmethod
    def share_along(lines):
        """Share of the length of lines that points along the displacement, to 10 degrees, where there is some."""
        points, vectors = points_of(lines), values_of(lines, "displacement")
        along = total = 0
        for c in range(lines.GetNumberOfCells()):
            ids = lines.GetCell(c).GetPointIds()
            row = [ids.GetId(k) for k in range(ids.GetNumberOfIds())]
            steps, means = numpy.diff(points[row], axis=0), (vectors[row][1:] + vectors[row][:-1]) / 2
            lengths = magnitudes(steps) * (magnitudes(means) > 0.02 * magnitudes(vectors).max())
            cosines = abs((steps * means).sum(axis=1)) / numpy.maximum(lengths * magnitudes(means), 1e-300)
            along += lengths[cosines > numpy.cos(numpy.radians(10))].sum()
            total += lengths.sum()
        return along / total

    def test_the_volume_is_that_of_the_mesh_and_follows_it(self):
        for run in SCENES:
            with self.subTest(run):
                rows = metrics_of(run)
                volumes = [integrals(opened(run), time)[0] for time in times_of(run)]
                start = volumes[0] / rows[0]["volume"] - 1
                later = max(abs(volume / volumes[0] - row["volume_ratio"]) for volume, row in zip(volumes, rows))
                self.figure(run, start, later)
                self.assertLess(abs(start), 0.003)
                self.assertLess(later, 0.006)

    def test_the_energy_is_that_of_the_pairs(self):
        for run in BONDED:
            with self.subTest(run):
                known = [row["pair_energy"] for row in metrics_of(run)]
                for time, energy in zip(times_of(run), known):
                    found = integrals(at_rest(opened(run)), time, "energy_density")[1]
                    self.figure(run, time, energy, found)
                    self.assertLess(abs(found - energy), 0.015 * energy + 1e-3 * max(known))

    @staticmethod
    def figure(*values):
        if os.environ.get("SINEW_FIGURES"):
            print("|", " | ".join(value if isinstance(value, str) else f"{value:.5g}" for value in values), "|", flush=True)


class Plugin(unittest.TestCase):
    def test_the_reader_has_all_series_of_every_scene(self):
        sys.path.append(str(SOURCE / "tools/paraview"))
        import sinew_paraview
        LoadPlugin(sinew_paraview.__file__, ns=globals())
        for run in sorted(RUNS.iterdir()):
            source = OpenDataFile(str(run / "run.json"))
            series = {path.stem for path in run.glob("*.pvd")}
            self.assertGreaterEqual(series, {"particles", "surface", "volume", "bones", "frames"})
            for time in times_of(run):
                found = fetched(source, time)
                blocks = {found.GetMetaData(i).Get(found.NAME()): found.GetBlock(i) for i in range(found.GetNumberOfBlocks())}
                self.assertEqual(set(blocks), series, run.name)
                for name, block in blocks.items():
                    own = fetched(opened(run, name), time)
                    numpy.testing.assert_array_equal(points_of(block), points_of(own), f"{run.name} {name}")
                    self.assertEqual(block.GetNumberOfCells(), own.GetNumberOfCells())


class Torn(unittest.TestCase):
    def torn(self, run, time):
        """Cells, and how many of them ParaView's threshold keeps as torn."""
        cells = fetched(opened(run), time).GetNumberOfCells()
        chosen = Threshold(Input=opened(run), Scalars=["CELLS", "torn"], LowerThreshold=1, UpperThreshold=1)
        return cells, fetched(chosen, time)

    def test_no_cell_is_torn_at_rest(self):
        for run in [*SCENES, "breaking"]:
            self.assertEqual(self.torn(run, 0)[1].GetNumberOfCells(), 0, run)

    def test_cells_are_torn_where_bonds_broke(self):
        cells, torn = self.torn("breaking", times_of("breaking")[-1])
        self.assertGreater(torn.GetNumberOfCells(), 100)
        self.assertLess(torn.GetNumberOfCells(), cells)
        broken = values_of(torn, "broken_bonds")
        particles = values_of(torn, "id") >= 0
        self.assertGreater((broken[particles] > 0).mean(), 0.5)

    def test_what_does_not_break_is_not_torn(self):
        for run in BONDED:
            self.assertEqual(self.torn(run, times_of(run)[-1])[1].GetNumberOfCells(), 0, run)


class Affine(unittest.TestCase):
    """A motion x = F X + c of the particles, through files in double precision."""
    F = numpy.array([[1.2, 0.3, -0.1], [-0.4, 0.9, 0.2], [0.1, 0.25, 1.1]])
    SHIFT = numpy.array([0.3, -2, 5])

    def test_it_is_exact_at_all_points_of_the_cells(self):
        run = RUNS / "affine"
        sinew("simulate", SOURCE / "configs/box_bend.yaml", "-o", run, "--set", "body.radius=0.02", "--set",
              "output.double_precision=true", "--set", "solver.duration=0.1", "--set", "output.interval=0.1")
        self.move(run / "particles/particles_000001.vtu")
        sinew("export", run, "--to", "volume")
        rest, data = (fetched(opened("affine"), time) for time in times_of("affine")[:2])
        moved = points_of(rest) @ self.F.T + self.SHIFT
        self.assertGreater((values_of(data, "id") < 0).sum(), 200)
        self.assertLess(abs(points_of(data) - moved).max(), 1e-12 * abs(moved).max())
        self.assertLess(abs(values_of(data, "displacement") - (moved - points_of(rest))).max(), 1e-12 * abs(moved).max())
        self.assertLess(abs(values_of(data, "J", cells=True) - numpy.linalg.det(self.F)).max(), 1e-9)

    def move(self, file):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(file))
        reader.Update()
        data = reader.GetOutput()
        rest = points_of(data) - values_of(data, "displacement")
        moved = rest @ self.F.T + self.SHIFT
        data.GetPoints().SetData(numpy_to_vtk(moved, deep=True))
        displacement = numpy_to_vtk(moved - rest, deep=True)
        displacement.SetName("displacement")
        data.GetPointData().AddArray(displacement)
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetFileName(str(file))
        writer.SetInputData(data)
        writer.Write()


if __name__ == "__main__":
    unittest.main(argv=["volume_paraview_test", "-v", *sys.argv[3:]])
