# SPDX-License-Identifier: GPL-3.0-or-later
"""pvbatch plugin_deformation_test.py BIN SOURCE [TESTS]: the plugin's filter Deformation of any points, by the Python package
in the folder SINEW_MODULE.
"""
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from plugin_support import *


def cloud(positions, ids=None, name="id", ghosts=0):
    """Points of a source."""
    source = ProgrammableSource(OutputDataSetType="vtkPolyData")
    source.Script = (f"import numpy\nfrom vtkmodules.util.numpy_support import numpy_to_vtk\n"
                     f"from vtkmodules.vtkCommonCore import vtkPoints\n"
                     f"values = numpy.frombuffer(bytes.fromhex('{numpy.ascontiguousarray(positions, float).tobytes().hex()}')).reshape(-1, 3)\n"
                     "places = vtkPoints()\nplaces.SetData(numpy_to_vtk(values, deep=1))\noutput.VTKObject.SetPoints(places)\n")
    if ids is not None:
        source.Script += (f"ids = numpy_to_vtk(numpy.array({list(map(int, ids))}), deep=1)\nids.SetName('{name}')\n"
                          "output.VTKObject.GetPointData().AddArray(ids)\n")
    if ghosts:  # the last ones are copies of another piece's
        source.Script += (f"flags = numpy_to_vtk((numpy.arange(len(values)) >= len(values) - {ghosts}).astype(numpy.uint8), deep=1)\n"
                          "flags.SetName('vtkGhostType')\noutput.VTKObject.GetPointData().AddArray(flags)\n")
    return source


TIMES = [0, 1, 2, 3]


def packed(count):
    """A face-centered cubic packing."""
    cells = numpy.stack(numpy.meshgrid(*[range(count)] * 3, indexing="ij"), -1).reshape(-1, 1, 3)
    return (cells + numpy.array([[0, 0, 0], [0.5, 0.5, 0], [0.5, 0, 0.5], [0, 0.5, 0.5]])).reshape(-1, 3)


class WithoutThePackage(unittest.TestCase):
    @unittest.skipIf(MODULE, "with the package")
    def test_it_is_named_in_a_line(self):
        with Messages() as messages:
            Deformation(Input=cloud(packed(3)), Reference=cloud(packed(3))).UpdatePipeline()
        self.assertRegex(messages.text, r"^ERROR: Deformation: the Python package sinew is not found; install python3-sinew[^\n]*\n$")


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

    def test_copies_of_another_piece_do_not_count(self):
        now, ids = 1.2 * self.rest, list(range(500))
        late = cloud(numpy.vstack((now, now[:50] + 5)), ids + ids[:50], ghosts=50)  # copies that lag behind
        found = arrays(fetched(Deformation(Reference=cloud(self.rest, ids), Input=late)).GetPointData())
        self.assertEqual(len(found["J"]), 500)
        numpy.testing.assert_allclose(found["J"], 1.2 ** 3, rtol=1e-12)
        numpy.testing.assert_array_equal(found["id"], ids)

    def test_what_tells_points_apart(self):
        order = self.random.permutation(500)
        now = 1.2 * self.rest[order]
        sources = [cloud(self.rest, numpy.arange(500), "tag"), cloud(now, order, "tag")]
        found = fetched(Deformation(Reference=sources[0], Input=sources[1], IdArray="tag"))
        numpy.testing.assert_allclose(arrays(found.GetPointData())["J"], 1.2 ** 3, rtol=1e-12)
        self.assertIn("python3-sinew", field(found, "found_by"))
        for ids, properties, words in (((range(500), None), {}, "at rest have ids"), ((None, range(500)), {}, "later moment have ids"),
                                       ((range(500), range(500)), {"IdArray": "tag"}, "no array tag"),
                                       ((range(500), range(500, 1000)), {}, "no id is in both")):
            with Messages() as messages:
                self.deformation(self.rest, now, ids, **properties)
            self.assertIn(words, messages.text)

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
            if properties.get("ReferenceTime") == 2:
                self.assertIn("cannot be read at the time 2", messages.text)
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
    unittest.main(argv=["plugin_deformation_test", "-v", *sys.argv[3:]])
