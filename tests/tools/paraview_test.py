# SPDX-License-Identifier: GPL-3.0-or-later
"""pvbatch paraview_test.py BIN DIR [TESTS]: what ParaView itself makes of the run in DIR, and `sinew view` in the folder BIN.
Works on any run."""
import functools
import math
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ET

from paraview import servermanager
from paraview.simple import *
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkIOImage import vtkPNGReader

VIEW, RUN = os.path.abspath(sys.argv[1] + "/sinew-view"), os.path.abspath(sys.argv[2])

# Per series: VTK's cell type, cells per point, and each array's place, unit and component names.
X, Q = "XYZ", "WXYZ"
SERIES = {
    "particles": (1, {
        "id": ("point", "1", ""), "bone": ("point", "1", ""), "radius": ("point", "m", ""),
        "displacement": ("point", "m", X), "velocity": ("point", "m/s", X),
        "force": ("point", "N", X), "force_pair": ("point", "N", X),
        "force_damping": ("point", "N", X), "force_bone": ("point", "N", X),
        "neighbors": ("point", "1", ""),
        "kinetic_energy": ("field", "J", ""), "pair_energy": ("field", "J", ""),
        "bone_energy": ("field", "J", ""), "gravity_energy": ("field", "J", ""),
        "work_of_bones": ("field", "J", ""), "dissipation": ("field", "J", ""),
        "contact_energy": ("field", "J", ""), "work_of_world": ("field", "J", "")}),
    "surface": (5, {
        "displacement": ("point", "m", X), "normal": ("point", "1", X),
        "bone": ("point", "1", "")}),
    "bones": (3, {
        "axis": ("cell", "1", ""), "bone": ("cell", "1", ""), "parent": ("cell", "1", "")}),
    "frames": (1, {
        "bone": ("point", "1", ""), "parent": ("point", "1", ""), "length": ("point", "m", ""),
        "orientation": ("point", "1", Q), "axis_x": ("point", "1", X),
        "axis_y": ("point", "1", X), "axis_z": ("point", "1", X),
        "twist": ("point", "degree", ""), "velocity": ("point", "m/s", X),
        "angular_velocity": ("point", "rad/s", X), "reaction_force": ("point", "N", X),
        "reaction_moment": ("point", "N m", X)}),
}
FIELDS = {"TimeValue": ("field", "s", ""), "CYCLE": ("field", "1", "")}


def rows_of(series):
    rows = ET.parse(os.path.join(RUN, series + ".pvd")).getroot().iter("DataSet")
    return [(float(row.get("timestep")), row.get("file")) for row in rows]


def opened(series):
    return OpenDataFile(os.path.join(RUN, series + ".pvd"))


def fetched(source, time):
    source.UpdatePipeline(time)
    return servermanager.Fetch(source)


def place_of(data, place):
    return {"point": data.GetPointData, "cell": data.GetCellData, "field": data.GetFieldData}[place]()


def values(array):
    width = array.GetNumberOfComponents()
    tuples = [array.GetTuple(i) for i in range(array.GetNumberOfTuples())]
    return [row[0] for row in tuples] if width == 1 else tuples


def turned(q, v):
    """v turned by the quaternion q, W X Y Z."""
    w, u = q[0], q[1:]
    cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    a = [2 * part for part in cross]
    b = [u[1] * a[2] - u[2] * a[1], u[2] * a[0] - u[0] * a[2], u[0] * a[1] - u[1] * a[0]]
    return [v[k] + w * a[k] + b[k] for k in range(3)]


class Series(unittest.TestCase):
    def test_times_are_those_of_the_pvd_and_the_same_for_all(self):
        times = [time for time, _ in rows_of("particles")]
        self.assertEqual(times, sorted(set(times)))
        for series in SERIES:
            self.assertEqual([time for time, _ in rows_of(series)], times, series)
            self.assertEqual(list(opened(series).TimestepValues), times, series)

    def test_series_file_opens_as_the_pvd_does(self):
        for series in SERIES:
            pvd, listed = opened(series), OpenDataFile(os.path.join(RUN, series + ".vtu.series"))
            times = [time for time, _ in rows_of(series)]
            self.assertEqual(list(listed.TimestepValues), times, series)
            for time in (times[0], times[-1]):
                one, other = fetched(pvd, time), fetched(listed, time)
                self.assertEqual(bytes(memoryview(one.GetPoints().GetData())),
                                 bytes(memoryview(other.GetPoints().GetData())))
                for place in ("point", "cell", "field"):
                    arrays = [{data.GetArrayName(i): bytes(memoryview(data.GetArray(i)))
                               for i in range(data.GetNumberOfArrays())}
                              for data in (place_of(one, place), place_of(other, place))]
                    self.assertEqual(*arrays, (series, time))

    def test_type_and_counts_are_the_same_in_every_frame(self):
        for series, (cell_type, _) in SERIES.items():
            source = opened(series)
            counts = set()
            for time, _ in rows_of(series):
                source.UpdatePipeline(time)
                info = source.GetDataInformation()
                self.assertEqual(info.GetDataSetTypeAsString(), "vtkUnstructuredGrid")
                counts.add((info.GetNumberOfPoints(), info.GetNumberOfCells()))
            self.assertEqual(len(counts), 1, series)
            data = fetched(source, 0)
            types = {data.GetCellType(i) for i in range(data.GetNumberOfCells())}
            self.assertEqual(types, {cell_type}, series)

    def test_counts_agree_between_the_series(self):
        particles, bones, frames = (fetched(opened(s), 0) for s in ("particles", "bones", "frames"))
        self.assertEqual(particles.GetNumberOfPoints(), particles.GetNumberOfCells())
        self.assertEqual(bones.GetNumberOfCells(), 4 * frames.GetNumberOfPoints())
        body = fetched(OpenDataFile(os.path.join(RUN, "body.vtu")), 0)
        self.assertEqual(body.GetNumberOfPoints(), particles.GetNumberOfPoints())

    def test_arrays_have_units_and_component_names(self):
        for series, (_, arrays) in SERIES.items():
            data = fetched(opened(series), rows_of(series)[-1][0])
            for name, (place, unit, components) in {**arrays, **FIELDS}.items():
                array = place_of(data, place).GetArray(name)
                with self.subTest(series=series, array=name):
                    self.assertIsNotNone(array)
                    self.assertEqual(array.GetInformation().Get(vtkDataArray.UNITS_LABEL()), unit)
                    names = [array.GetComponentName(k) for k in range(len(components))]
                    self.assertEqual(names, list(components))
            points = data.GetPoints().GetData()
            self.assertEqual(points.GetInformation().Get(vtkDataArray.UNITS_LABEL()), "m")

    def test_active_arrays_of_the_particles(self):
        data = fetched(opened("particles"), 0).GetPointData()
        self.assertEqual(data.GetScalars().GetName(), "bone")
        self.assertEqual(data.GetVectors().GetName(), "displacement")

    def test_every_file_knows_its_time(self):
        for series in SERIES:
            source = opened(series)
            for time, _ in rows_of(series)[::10]:
                field = fetched(source, time).GetFieldData()
                self.assertEqual(field.GetArray("TimeValue").GetValue(0), time)

    def test_displacement_leads_back_to_the_same_rest_state(self):
        source = opened("particles")
        rows = rows_of("particles")
        rests = []
        for time in (rows[0][0], rows[len(rows) // 2][0], rows[-1][0]):
            data = fetched(source, time)
            points = values(data.GetPoints().GetData())
            ways = values(data.GetPointData().GetArray("displacement"))
            rests.append([[p - w for p, w in zip(*pair)] for pair in zip(points, ways)])
        size = max(abs(part) for point in rests[0] for part in point)
        for rest in rests[1:]:
            apart = max(math.dist(a, b) for a, b in zip(rests[0], rest))
            self.assertLess(apart, 1e-6 * size)

    def test_orientation_turns_x_into_the_bones_axis(self):
        data = fetched(opened("frames"), rows_of("frames")[-1][0]).GetPointData()
        for q, axis in zip(values(data.GetArray("orientation")), values(data.GetArray("axis_x"))):
            self.assertLess(math.dist(turned(q, [1, 0, 0]), axis), 1e-6)


class Skin(unittest.TestCase):
    def test_the_surface_has_the_strain_of_the_particles(self):
        rows, largest = rows_of("surface"), 0
        for time, _ in (rows[0], rows[len(rows) // 2], rows[-1]):
            skin, particles = (fetched(opened(series), time).GetPointData().GetArray("strain_eq")
                               for series in ("surface", "particles"))
            self.assertEqual(skin.GetInformation().Get(vtkDataArray.UNITS_LABEL()), "1")
            self.assertTrue(all(map(math.isfinite, values(skin))))
            if particles:  # what several ranks have written lacks it
                self.assertLessEqual(max(values(skin)), max(values(particles)))
                self.assertGreaterEqual(min(values(skin)), min(values(particles)))
            largest = max(largest, *values(skin))
        self.assertGreater(largest, 0.01)


class Picking(unittest.TestCase):
    def test_threshold_on_bone_selects_its_particles(self):
        source = opened("particles")
        time = rows_of("particles")[-1][0]
        whole = fetched(source, time)
        bones = values(whole.GetPointData().GetArray("bone"))
        chosen = Threshold(Input=source, Scalars=["POINTS", "bone"])
        for bone in sorted(set(bones)):
            chosen.LowerThreshold = chosen.UpperThreshold = bone
            ids = values(fetched(chosen, time).GetPointData().GetArray("id"))
            self.assertEqual(ids, [i for i, other in enumerate(bones) if other == bone])


def pixels_of(path):
    """Width, height and rows of pixels."""
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    image = reader.GetOutput()
    width, height, _ = image.GetDimensions()
    pixels = values(image.GetPointData().GetScalars())
    return width, height, [pixels[y * width:(y + 1) * width] for y in range(height)]


@functools.cache
def picture(*arguments):
    """What sinew view draws."""
    return drawn_by_view(RUN, *arguments)


def drawn_by_view(run, *arguments):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "picture.png")
        subprocess.run([VIEW, run, "--picture", path, "--size", "800", "400", *arguments], check=True, cwd="/")
        return pixels_of(path)


LOAD_STATE = """
import sys
from paraview.simple import *
state, folder, picture = sys.argv[1:]
LoadState(state, data_directory=folder) if folder != "-" else LoadState(state)
SaveScreenshot(picture, GetLayout(), ImageResolution=[800, 400], SeparatorWidth=0)
print(*sorted(source.FileName for source in GetSources().values() if hasattr(source, "FileName")), sep="\\n")
print(GetAnimationScene().AnimationTime)
"""


def loaded(state, folder="-"):
    """What the state draws, the files it opens, and the time."""
    with tempfile.TemporaryDirectory() as work:
        script, path = os.path.join(work, "load.py"), os.path.join(work, "picture.png")
        with open(script, "w", encoding="utf-8") as text:
            text.write(LOAD_STATE)
        done = subprocess.run(["pvbatch", script, state, folder, path], check=True, cwd="/", capture_output=True,
                              text=True)
        *files, time = done.stdout.splitlines()
        return pixels_of(path), files, float(time), done.stderr


def drawn_share(rows, left, right):
    """Share of pixels that differ from the background, which only changes from row to row."""
    drawn = sum(max(abs(a - b) for a, b in zip(pixel, row[right - 1])) > 24
                for row in rows for pixel in row[left:right])
    return drawn / (len(rows) * (right - left))


def count(rows, columns, likeness):
    """Pixels in these columns that look so."""
    return sum(likeness(*pixel) for row in rows for pixel in row[columns])


def red(r, g, b):
    return r > 100 and r > 1.6 * g and r > 1.6 * b


def green(r, g, b):
    return g > 80 and g > 1.35 * r and g > 1.2 * b


def blue(r, g, b):
    return b > 100 and b > 1.5 * r and b > 1.35 * g


def dark(r, g, b):
    return max(r, g, b) < 110


class View(unittest.TestCase):
    def test_view_draws_the_body_left_and_the_bones_right(self):
        self.assert_shows_body_and_bones(*picture())

    def assert_shows_body_and_bones(self, width, height, rows):
        self.assertEqual((width, height), (800, 400))
        left, right = slice(0, width // 2), slice(width // 2, width)
        for half in (left, right):
            self.assertGreater(drawn_share(rows, half.start, half.stop), 0.04)
        colors = {pixel for row in rows for pixel in row[left]}
        self.assertGreater(len(colors), 1000)
        with self.subTest("axes of the bones"):
            for color in (red, green, blue):
                self.assertGreater(count(rows, right, color), 3, color.__name__)
        with self.subTest("time, and name and ends of the colors"):
            self.assertGreater(count(rows[-height // 10:], slice(0, width // 5), dark), 20)
            self.assertGreater(count(rows[:height // 5], left, dark), 25)
        with self.subTest("nothing is cut off"):
            for row in (rows[0], rows[-1]):
                self.assertLess(drawn_share([row], left.start, left.stop), 0.02)
                self.assertLess(drawn_share([row], right.start, right.stop), 0.02)

    def test_the_state_shows_the_same_without_a_script(self):
        drawn, files, time, said = loaded(os.path.join(RUN, "view.pvsm"))
        self.assert_shows_body_and_bones(*drawn)
        self.assertNotIn("ERR", said)
        self.assertIn(os.path.join(RUN, "particles.pvd"), files)
        self.assertIn(time, [row for row, _ in rows_of("particles")])

    def test_paraview_finds_the_files_of_a_state_whose_folder_was_moved(self):
        with tempfile.TemporaryDirectory() as work:
            away = os.path.join(work, "Läufe, viele")
            shutil.copytree(RUN, away)
            state = os.path.join(away, "view.pvsm")
            with open(state, encoding="utf-8") as file:
                text = file.read().replace(RUN, "/where/it/was")
            with open(state, "w", encoding="utf-8") as file:
                file.write(text)
            drawn, files, _, said = loaded(state, away)
            self.assertNotIn("ERR", said)
            self.assertEqual({os.path.dirname(name) for name in files}, {away})
            self.assert_shows_body_and_bones(*drawn)

    def test_view_draws_the_moment_asked_for(self):
        first, last = (picture("--time", str(time))[2]
                       for time in (rows_of("particles")[0][0], rows_of("particles")[-1][0] / 3))
        changed = sum(a != b for one, other in zip(first, last) for a, b in zip(one, other))
        self.assertGreater(changed, 0.02 * 800 * 400)

    def test_forces_are_shown_on_demand(self):
        bare, armed = picture()[2], picture("--forces")[2]
        orange = lambda r, g, b: r > 140 and 1.5 * b < g < 0.75 * r
        right = slice(400, 800)
        self.assertGreater(count(armed, right, orange), count(bare, right, orange) + 100)


class Cells(unittest.TestCase):
    """Of a run with the series volume, whose name does not stand in its first tests."""

    def test_the_cut_is_flat(self):
        """Spheres are shaded from one end to the other; a flat cut has the colors of the scale alone, in whole rows."""
        as_cells, as_spheres = picture(), self.picture_without_cells()
        self.assertLess(self.roughness(as_cells), 0.5 * self.roughness(as_spheres))

    def picture_without_cells(self):
        with tempfile.TemporaryDirectory() as work:
            away = os.path.join(work, "run")
            shutil.copytree(RUN, away)
            os.remove(os.path.join(away, "volume.pvd"))
            return drawn_by_view(away)

    @staticmethod
    def roughness(drawn):
        """Mean change of brightness from pixel to pixel in the left view, where both are drawn."""
        width, _, rows = drawn
        changes = [abs(sum(row[x]) - sum(row[x + 1])) for row in rows for x in range(width // 2 - 1)
                   if blue_to_yellow(row[x]) and blue_to_yellow(row[x + 1])]
        return sum(changes) / len(changes)


def blue_to_yellow(pixel):
    """Whether a pixel has a color of the scale: background, bones and text are gray."""
    return max(pixel) - min(pixel) > 60


if __name__ == "__main__":
    unittest.main(argv=["paraview_test", "-v", *sys.argv[3:]])
