#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""sinew measure on whole runs: what it compares, what it refuses, what it writes on request.

usage: measure_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import csv
import json
import math
import re
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

from small_run import SCENE, SOURCE, sinew

SETTINGS = ["--set", "output.skin_lbs=true", "--set", "output.skin_dqs=true", "--set", "solver.duration=0.3"]

FOREIGN = """<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">
  <UnstructuredGrid><Piece NumberOfPoints="1" NumberOfCells="1">
    <Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0</DataArray></Points>
    <Cells><DataArray type="Int64" Name="connectivity" format="ascii">0</DataArray>
      <DataArray type="Int64" Name="offsets" format="ascii">1</DataArray>
      <DataArray type="UInt8" Name="types" format="ascii">1</DataArray></Cells>
  </Piece></UnstructuredGrid>
</VTKFile>
"""


def rows(path):
    with path.open() as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


class Measure(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.runs = Path(cls.temporary.name)
        cls.scene = cls.runs / "small.yaml"
        cls.scene.write_text(SCENE.format(mesh=SOURCE / "data/meshes/box.obj"))
        for name, words in {"paper": [], "bonded": ["--set", "material.model=bonded"],
                            "coarse": ["--set", "body.radius=0.03"]}.items():
            sinew("simulate", cls.scene, "-o", cls.runs / name, *SETTINGS, *words, check=0)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def setUp(self):
        self.out = Path(tempfile.mkdtemp(dir=self.runs)) / "compared"

    def copy_of(self, name):
        shutil.copytree(self.runs / name, self.out)
        return self.out

    def assert_refused(self, folder, *parts):
        for word in ["measure", "render"]:
            done = sinew(word, folder)
            self.assertEqual(done.returncode, 2, (word, done.stderr))
            said = [line for line in done.stderr.splitlines() if line.startswith("sinew: ")]
            self.assertEqual(len(said), 1, done.stderr)
            for part in parts:
                self.assertIn(part, said[0])

    def test_a_run_compared_with_itself_differs_in_nothing(self):
        again = self.runs / "again"
        if not again.exists():
            shutil.copytree(self.runs / "paper", again)
        sinew("measure", self.runs / "paper", again, "-o", self.out, check=0)
        for row in rows(self.out / "compare.csv"):
            for name, value in row.items():
                if name.endswith("_difference") or name.startswith("reference_"):
                    self.assertTrue(value == 0 or math.isnan(value) or abs(value) < 1e-15, (name, value))
        report = (self.out / "report.html").read_text()
        self.assertIn("No setting does.", report)
        self.assertNotIn('class="remarks"', report)
        self.assertEqual(json.loads((self.out / "metrics.json").read_text())["remarks"], [])

    def test_broken_bonds_are_counted(self):
        torn = self.out / "torn"
        sinew("simulate", self.scene, "-o", torn, "--set", "material.model=bonded",
              "--set", "material.breaking_strain=0.02", *SETTINGS, check=0)
        done = sinew("measure", torn, "--fail-on", "broken_bonds > 0.001")
        self.assertEqual(done.returncode, 1, done.stderr)
        broken = [row["broken_bonds"] for row in rows(torn / "metrics.csv")]
        self.assertEqual(broken[0], 0)
        self.assertGreater(broken[-1], 0.001)
        self.assertEqual(broken, sorted(broken))
        self.assertIn("broken bonds", (torn / "report.html").read_text())

    def test_two_models_of_one_body_are_compared_particle_by_particle(self):
        done = sinew("measure", self.runs / "paper", self.runs / "bonded", "-o", self.out, "--json", check=0)
        found = json.loads(done.stdout)
        self.assertEqual(found["frames"], 10)
        self.assertNotIn("remarks", found)
        paper, bonded = (json.loads((self.runs / name / "run.json").read_text())["seconds"]["stepping"]
                         for name in ("paper", "bonded"))
        self.assertAlmostEqual(found["speedup"], paper / bonded, 6)
        table = rows(self.out / "compare.csv")
        self.assertEqual(table[0]["reference_particles_max"], 0)
        self.assertGreater(table[-1]["reference_particles_rms"], 0)
        self.assertGreaterEqual(table[-1]["reference_particles_max"], table[-1]["reference_particles_rms"])
        self.assertGreaterEqual(table[-1]["reference_surface_max"], table[-1]["reference_hausdorff"])
        for row in table:
            self.assertEqual(row["volume_difference"], row["volume_b"] - row["volume_a"])
        self.assertIn("paper → bonded", (self.out / "report.html").read_text())
        for name in ["paper", "bonded"]:  # measuring them is not writing into them
            self.assertFalse((self.runs / name / "report.html").exists() and name == "bonded")

    def test_a_reference_of_another_program_is_measured(self):
        points, triangles = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], "0 2 1 0 1 3 1 2 3 2 0 3"
        folder = self.out / "others"
        (folder / "a").mkdir(parents=True)
        data = '<DataArray type="{}" Name="{}" format="ascii">{}</DataArray>'.format
        cells = lambda ids, ends: data("Int64", "connectivity", ids) + data("Int64", "offsets", ends)
        places = '<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">' + " ".join(
            str(x) for point in points for x in point) + "</DataArray></Points>"
        piece = '<VTKFile type="{0}" byte_order="LittleEndian"><{0}><Piece NumberOfPoints="4" {1}>{2}{3}</Piece></{0}></VTKFile>'.format
        (folder / "a/0.vtp").write_text(piece("PolyData", 'NumberOfPolys="4"', places, f"<Polys>{cells(triangles, '3 6 9 12')}</Polys>"))
        (folder / "a/1.vtu").write_text(piece("UnstructuredGrid", 'NumberOfCells="5"', places, "<Cells>" + cells(
            triangles + " 0 1", "3 6 9 12 14") + data("UInt8", "types", "5 5 5 5 3") + "</Cells>"))
        row = '<DataSet timestep="{}" file="{}"/>'.format
        pvd = "<VTKFile><Collection>{}</Collection></VTKFile>".format
        found = []
        for name in ("a\\0.vtp", "a/1.vtu"):
            (folder / "s.pvd").write_text(pvd(row(0, name)))
            sinew("measure", self.runs / "paper", "--reference", folder / "s.pvd", check=0)
            found.append(rows(self.runs / "paper" / "metrics.csv")[0]["reference_hausdorff"])
        self.assertEqual(found[0], found[1])
        self.assertGreater(found[0], 0)
        (folder / "s.pvd").write_text(pvd(2 * row(0, "a/0.vtp")))
        done = sinew("measure", self.runs / "paper", "--reference", folder / "s.pvd", check=2)
        self.assertIn("several parts", done.stderr)

    def test_limits_hold_for_the_differences(self):
        two = [self.runs / "paper", self.runs / "bonded", "-o", self.out]
        told = sinew("measure", *two, "--fail-on", "reference_particles_max > 1", check=0).stdout.splitlines()
        self.assertRegex(told[0], r"compared: paper and bonded, 10 frames, particles up to \S+ m apart")
        self.assertEqual((len(told), told[-1]), (12, f"report: {self.out}/report.html"))
        table = rows(self.out / "compare.csv")
        largest = {}
        for line in told[1:-1]:
            name, a, b, unit, time = re.fullmatch(r"(\w+): (\S+) and (\S+)( .+)?, at (\S+) s", line).groups()
            row = min(table, key=lambda row: abs(row["time"] - float(time)))
            self.assertAlmostEqual(float(a), row[name + "_a"], delta=abs(row[name + "_a"]) / 100)
            self.assertAlmostEqual(float(b), row[name + "_b"], delta=abs(row[name + "_b"]) / 100)
            ends = [abs(row[name + end]) for row in table for end in ("_a", "_b")]
            largest[name] = abs(row[name + "_difference"]) / max(end for end in ends if not math.isnan(end))
        self.assertEqual(list(largest.values()), sorted(largest.values(), reverse=True))
        self.assertEqual(len(largest), 10)
        done = sinew("measure", *two, "--fail-on", "reference_particles_max > 1e-9", check=1)
        self.assertIn("reference_particles_max", done.stderr)
        self.assertFalse(json.loads((self.out / "metrics.json").read_text())["checks"][0]["pass"])

    def test_other_particles_are_said_to_be_others(self):
        done = sinew("measure", self.runs / "paper", self.runs / "coarse", "-o", self.out, "--json", check=0)
        found = json.loads(done.stdout)
        self.assertIn("The particles are not the same", found["remarks"][0])
        self.assertEqual(len(found["remarks"]), 1)  # the mesh is the same
        self.assertIn("The particles are not the same", (self.out / "report.html").read_text())
        row = rows(self.out / "compare.csv")[-1]
        self.assertTrue(math.isnan(row["reference_particles_rms"]))
        self.assertGreater(row["reference_surface_rms"], 0)

    def test_frames_are_matched_by_their_time(self):
        rarer = self.runs / "rarer"
        sinew("simulate", self.scene, "-o", rarer, *SETTINGS, "--set", "output.interval=0.1", "--force",
              check=0)
        done = sinew("measure", rarer, self.runs / "paper", "-o", self.out, "--json", check=0)
        self.assertEqual([round(row["time"], 9) for row in rows(self.out / "compare.csv")], [0, 0.1, 0.2, 0.3])
        self.assertIn("6 frames have no counterpart", json.loads(done.stdout)["remarks"][0])

    def test_a_comparison_needs_a_folder_of_its_own(self):
        for words in [[], ["-o", self.runs / "paper"], ["-o", self.runs / "coarse"]]:
            done = sinew("measure", self.runs / "paper", self.runs / "bonded", *words)
            self.assertEqual(done.returncode, 2)
            self.assertIn("-o", done.stderr)
        self.assertEqual(sinew("measure", self.runs / "paper", "-o", self.out).returncode, 2)

    def test_a_run_compares_itself_with_poses_skins_and_a_reference(self):
        run = self.copy_of("paper")
        sinew("measure", run, "--reference", self.runs / "bonded" / "surface.pvd", check=0)
        first, last = rows(run / "metrics.csv")[0], rows(run / "metrics.csv")[-1]
        for name in ["pose", "lbs", "dqs", "reference"]:
            self.assertLess(first[f"{name}_hausdorff"], 1e-6, name)  # all begin alike
            self.assertGreater(last[f"{name}_hausdorff"], last[f"{name}_distance_mean"], name)
            self.assertGreater(last[f"{name}_distance_mean"], 0, name)
        self.assertGreaterEqual(last["reference_surface_max"], last["reference_hausdorff"])
        done = sinew("measure", run, "--reference", run / "scene.yaml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("scene.yaml", done.stderr)
        done = sinew("measure", run, "--reference", run / "bones.pvd")
        self.assertEqual(done.returncode, 2)
        self.assertIn("is a surface or a volume", done.stderr)

    def test_sections_csv_has_a_row_per_frame_and_section(self):
        run = self.copy_of("paper")
        sinew("measure", run, check=0)
        table = rows(run / "sections.csv")
        self.assertEqual(list(table[0]), ["time", "bone", "along", "joint", "area", "area_ratio"])
        times = {row["time"] for row in table}
        self.assertEqual(len(times), 10)
        self.assertEqual(len(table) % len(times), 0)
        for row in table:
            if row["time"] == 0:
                self.assertAlmostEqual(row["area_ratio"], 1, 5)
        worst = max(1 - row["area_ratio"] for row in table)
        self.assertAlmostEqual(worst, max(row["candy_wrapper"] for row in rows(run / "metrics.csv")), 9)

    def test_arrays_come_on_request_from_both_programs_alike(self):
        run = self.out
        sinew("simulate", self.scene, "-o", run, *SETTINGS, "--set", "output.arrays=all", "--set",
              "output.encoding=none", check=0)
        sinew("measure", run, "--arrays", "all", check=0)
        wanted = {"F": 9, "J": 1, "stretch": 3, "strain": 6, "hencky_strain": 6, "strain_eq": 1, "stress": 6,
                  "stress_kirchhoff": 6, "von_mises": 1, "D2min": 1, "turnover": 1, "inverted": 1, "pose_error": 1}
        for folder in ["particles", "values"]:
            text = (run / folder / f"{folder}_000009.vtu").read_bytes().decode("latin-1")
            for name, components in wanted.items():
                tag = re.search(rf'<DataArray [^>]*Name="{name}"[^>]*>', text)
                self.assertIsNotNone(tag, (folder, name))
                if components > 1:
                    self.assertIn(f'NumberOfComponents="{components}"', tag[0])
                if components == 6:
                    for k, axis in enumerate(["XX", "YY", "ZZ", "XY", "YZ", "XZ"]):
                        self.assertIn(f'ComponentName{k}="{axis}"', tag[0])
        sinew("simulate", self.scene, "-o", run, *SETTINGS, "--force", check=0)
        self.assertFalse((run / "values.pvd").exists())
        self.assertFalse((run / "sections.csv").exists())
        plain = (run / "particles" / "particles_000000.vtu").read_bytes()
        self.assertNotIn(b'Name="stress"', plain)
        done = sinew("simulate", self.scene, "-o", run, "--force", "--set", "output.arrays=stres")
        self.assertEqual(done.returncode, 2)
        self.assertIn("did you mean stress?", done.stderr)

    def test_a_frame_that_is_gone_or_torn_is_named(self):
        for series in ["particles", "surface", "frames"]:
            file = f"{series}_000004.vtu"
            with self.subTest(series=series):
                run = self.copy_of("paper")
                whole = (run / series / file).read_bytes()
                (run / series / file).unlink()
                self.assert_refused(run, file)
                (run / series / file).write_bytes(whole[:len(whole) // 2])
                self.assert_refused(run, file)
                (run / series / file).write_bytes(b"")
                self.assert_refused(run, file)
                shutil.rmtree(run)

    def test_a_file_of_another_program_or_body_is_named(self):
        run = self.copy_of("paper")
        (run / "particles/particles_000003.vtu").write_text(FOREIGN)
        self.assert_refused(run, "particles_000003.vtu")
        shutil.copy(self.runs / "coarse/particles/particles_000003.vtu", run / "particles")
        self.assert_refused(run, "particles_000003.vtu", "another number of particles")
        shutil.copy(self.runs / "paper/surface/surface_000003.vtu", run / "particles/particles_000003.vtu")
        self.assert_refused(run, "particles_000003.vtu")

    def test_a_foreign_body_scene_or_record_is_named(self):
        for file, text in {"body.vtu": FOREIGN, "scene.yaml": "body: 3\n", "particles.pvd": "<VTKFile/>",
                           "surface.pvd": "", "run.json": "[]"}.items():
            with self.subTest(file=file):
                run = self.copy_of("paper")
                (run / file).write_text(text)
                done = sinew("measure", run)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(file, done.stderr)
                shutil.rmtree(run)

    def test_a_run_without_frames_says_so_and_what_to_do(self):
        run = self.copy_of("paper")
        for series in [*run.glob("*.pvd")]:
            series.unlink()
            shutil.rmtree(run / series.stem)
        for status, cure in {"running": "--resume", "stopped": "--resume", "unstable": "--force"}.items():
            record = json.loads((run / "run.json").read_text())
            (run / "run.json").write_text(json.dumps(record | {"status": status}))
            self.assert_refused(run, f"{run}: the run has no frames", cure)

    def test_a_series_that_is_shorter_is_measured_up_to_its_end_with_a_warning(self):
        run = self.copy_of("paper")
        text = (run / "surface.pvd").read_text()
        (run / "surface.pvd").write_text("\n".join(line for line in text.split("\n")
                                                   if not re.search(r"_00000[6-9]\.vtu", line)))
        done = sinew("measure", run, check=0)
        self.assertEqual(len(rows(run / "metrics.csv")), 6)
        self.assertIn("6 of 10 frames", done.stderr)

    def test_series_of_other_times_are_refused(self):
        run = self.copy_of("paper")
        text = (run / "surface.pvd").read_text()
        (run / "surface.pvd").write_text(text.replace('timestep="0.1"', 'timestep="0.11"'))
        self.assert_refused(run, "surface.pvd", "0.11")


if __name__ == "__main__":
    unittest.main(argv=["measure_test", "-v", *sys.argv[3:]])
