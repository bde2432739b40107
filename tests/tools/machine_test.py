#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A testing machine: bars that supports and loads pull, twist, press and hang, against closed forms.

usage: machine_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import csv
import functools
import json
import re
import sys
import tempfile
import unittest
from pathlib import Path

import small_run

SOURCE = small_run.SOURCE
E, G, K = 1e5, 4e4, 1e5 / 1.5  # Pa: isotropic bonds have a Poisson's ratio of 1/4

BAR = """
body:
  mesh: {source}/data/meshes/box.obj
  radius: 0.01
material:
  model: bonded
  young_modulus: 1e5
  damping_form: central
world:
  drag: 20
solver:
  duration: 1.5
output:
  interval: 0.1
{machine}
"""

PULL = """
supports:
  - {{name: below, hold: z, facing: [0, 0, -1]}}
  - name: above
    hold: z
    facing: [0, 0, 1]
    keys:
      - time: 0
      - {{time: 1, translation: [0, 0, {by}]}}
"""

sinew = functools.partial(small_run.sinew, check=0)


def volume_of(mesh):
    """Length and area across of an upright box."""
    points = [[float(word) for word in line.split()[1:4]]
              for line in mesh.read_text().splitlines() if line.startswith("v ")]
    size = [max(axis) - min(axis) for axis in zip(*points)]
    return size[2], size[0] * size[1]


LENGTH, AREA = volume_of(SOURCE / "data/meshes/box.obj")


class Machine(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)
        self.out = self.folder / "run"

    def tearDown(self):
        self.temporary.cleanup()

    def scene(self, machine):
        path = self.folder / "bar.yaml"
        path.write_text(BAR.format(source=SOURCE, machine=machine))
        return path

    def run_of(self, machine, *words, out=None):
        out = out or self.out
        sinew("simulate", "--force", self.scene(machine), "-o", out, *words)
        return self.rows(out)

    def rows(self, folder, table="supports.csv"):
        """Last rows by name."""
        with (folder / table).open() as file:
            return {row["name"]: row for row in csv.DictReader(file)}

    def vector(self, row, name):
        return [float(row[f"{name}_{axis}"]) for axis in "xyz"]

    def assert_near(self, found, expected, part):
        self.assertLess(abs(found - expected), part * abs(expected), f"{found} for {expected}")

    def test_a_pulled_bar_has_the_reaction_of_its_modulus(self):
        for precision in "double", "single":
            rows = self.run_of(PULL.format(by=0.002), "--set", f"solver.precision={precision}")
            low, high = rows["below"], rows["above"]
            gauge = self.vector(high, "pivot")[2] - self.vector(low, "pivot")[2] - 0.002
            expected = E * AREA * 0.002 / gauge
            self.assert_near(self.vector(high, "force")[2], expected, 0.03)
            self.assert_near(self.vector(low, "force")[2], -expected, 0.03)
            self.assert_near(self.vector(high, "displacement")[2], 0.002, 1e-6)
            for row in low, high:
                self.assertEqual(self.vector(row, "force")[:2], [0, 0])

    def test_a_twisted_bar_has_the_moment_of_its_shear_modulus(self):
        angle = 0.02  # rad
        rows = self.run_of(f"""
supports:
  - {{name: below, facing: [0, 0, -1]}}
  - name: above
    hold: xy
    facing: [0, 0, 1]
    keys: [{{time: 0}}, {{time: 1, angle: {angle * 57.29578}}}]
""")
        low, high = rows["below"], rows["above"]
        gauge = self.vector(high, "pivot")[2] - self.vector(low, "pivot")[2]
        expected = 0.1406 * G * AREA ** 2 * angle / gauge
        self.assert_near(self.vector(high, "moment")[2], expected, 0.05)
        self.assert_near(self.vector(low, "moment")[2], -expected, 0.05)

    def test_reactions_balance_loads_and_weight_at_rest(self):
        rows = self.run_of("""
supports:
  - {name: wall, facing: [0, 0, 1]}
loads:
  - {name: weight, gravity: [0, 0, -2]}
  - {name: pull, traction: [0, 0, -500], facing: [0, 0, -1]}
  - {name: hook, force: [0, 0, 3], center: [0, 0, 0.3], radius: 0.05, keys: [{time: 0, factor: 0}, {time: 1, factor: 1}]}
""", "--set", "solver.duration=3")
        mass = json.loads((self.out / "run.json").read_text())
        weight = 2 * mass["particles"] * mass["particle_mass"]
        self.assert_near(self.vector(rows["weight"], "force")[2], -weight, 1e-9)
        self.assert_near(self.vector(rows["pull"], "force")[2], -500 * AREA, 1e-6)
        self.assert_near(self.vector(rows["hook"], "force")[2], 3, 1e-9)
        given = [sum(self.vector(rows[name], "force")[axis] for name in ("weight", "pull", "hook"))
                 for axis in range(3)]
        held = self.vector(rows["wall"], "force")
        for axis in range(3):
            self.assertLess(abs(held[axis] + given[axis]), 1e-6 * abs(held[2]))

    def test_a_body_under_pressure_on_all_sides_shrinks_by_its_bulk_modulus(self):
        rows = self.run_of("loads:\n  - {name: sea, pressure: 600}\n")
        self.assertLess(max(map(abs, self.vector(rows["sea"], "force"))), 1e-9 * 600 * AREA)
        self.assertLess(max(map(abs, self.vector(rows["sea"], "moment"))), 1e-9 * 600 * AREA)
        sinew("measure", self.out)
        with (self.out / "metrics.csv").open() as file:
            volumes = [float(row["volume"]) for row in csv.DictReader(file)]
        self.assert_near(1 - volumes[-1] / volumes[0], 600 / K, 0.05)

    def test_a_resumed_run_leaves_the_same_table_and_state(self):
        machine = PULL.format(by=0.02) + """
loads: [{name: sea, pressure: 600}]
probes: [{name: middle, low: [-1, -1, 0.3], high: [1, 1, 0.4]}]
"""
        self.run_of(machine)
        parts = self.folder / "parts"
        sinew("simulate", self.scene(machine), "-o", parts, "--set", "solver.wall_time=0.2", check=None)
        for limit in [*4 * ["0.2"], "none"]:
            sinew("simulate", self.scene(machine), "-o", parts, "--resume", "--set", f"solver.wall_time={limit}",
                  check=None)
        records = [json.loads((folder / "run.json").read_text()) for folder in (self.out, parts)]
        self.assertGreater(records[1]["resumed"], 0)
        self.assertEqual([record["status"] for record in records], 2 * ["finished"])
        self.assertEqual(*[record["state_hash"] for record in records])
        for table in "supports.csv", "probes.csv":
            self.assertEqual(*[(folder / table).read_bytes() for folder in (self.out, parts)])

    def test_a_bar_that_is_held_relaxes_to_what_is_left_of_its_modulus(self):
        relaxing = ["--set", "material.relaxation_shares=[0.3, 0.2]", "--set", "material.relaxation_times=[0.05, 0.2]"]
        pull, clamped = {}, PULL.replace("hold: z, facing: [0, 0, -1]", "facing: [0, 0, -1]")
        for name, words in ("elastic", []), ("relaxed", relaxing), ("static", [*relaxing, "--set", "solver.method=static"]):
            rows = self.run_of(clamped.format(by=0.002), *words, "--set", "solver.duration=3", "--set", "output.interval=1")
            pull[name] = self.vector(rows["above"], "force")[2]
        self.assert_near(pull["relaxed"], pull["elastic"] / 2, 0.005)
        self.assert_near(pull["static"], pull["elastic"] / 2, 0.005)

    def test_parts_inside_a_mesh_have_a_material_of_their_own(self):
        inner = self.folder / "inner.obj"
        box = (SOURCE / "data/meshes/box.obj").read_text().splitlines()
        inner.write_text("\n".join(" ".join(["v", *(str(0.6 * float(x)) for x in line.split()[1:4])])
                                   if line.startswith("v ") else line for line in box))
        machine = """
materials:
  - {name: core, young_modulus: 3e5, poisson_ratio: 0.3, density: 4000, breaking_strain: 0.5, mesh: inner.obj}
supports: [{name: wall, facing: [0, 0, 1]}]
loads: [{name: weight, gravity: [0, 0, -2]}]
"""
        words = ["--set", "material.model=bonded_volume", "--set", "material.poisson_ratio=0.45"]
        rows = self.run_of(machine, *words, "--set", "solver.method=static", "--set", "solver.duration=0",
                           "--set", "output.arrays=stress")
        record = json.loads((self.out / "run.json").read_text())
        flesh, core = record["materials"]
        self.assertEqual((flesh["name"], core["name"]), ("material", "core"))
        self.assertEqual(flesh["particles"] + core["particles"], record["particles"])
        self.assert_near(core["mass"], 4 * core["particles"] * record["particle_mass"], 1e-9)
        self.assert_near(core["particles"] / record["particles"], 0.6 ** 3, 0.15)
        weight = 2 * (flesh["mass"] + core["mass"])
        self.assert_near(self.vector(rows["wall"], "force")[2], weight, 1e-5)
        inner.rename(self.folder / "moved.obj")
        sinew("measure", self.out)
        page = (self.out / "report.html").read_text()
        self.assertTrue(re.search(r"(?s)Load steps.*?frame 0.*?\d iterations, residual \d", page))
        self.assertTrue(re.search(r"(?s)Parts<.*?core.*?particles, ", page))
        inner.write_text(inner.with_name("moved.obj").read_text())
        swinging, parts = [self.folder / name for name in ("swinging", "parts")]
        shorter = [*words, "--set", "solver.duration=0.3"]
        sinew("simulate", self.scene(machine), "-o", swinging, *shorter)
        sinew("simulate", self.scene(machine), "-o", parts, *shorter, "--set", "solver.wall_time=0.1", check=None)
        sinew("simulate", self.scene(machine), "-o", parts, *shorter, "--resume")
        hashes = [json.loads((folder / "run.json").read_text())["state_hash"] for folder in (swinging, parts)]
        self.assertEqual(*hashes)

    def test_its_resolved_scene_gives_the_same_run(self):
        machine = PULL.format(by=0.002)
        self.run_of(machine, "--set", "solver.duration=0.2")
        sinew("simulate", self.out / "scene.yaml", "-o", self.folder / "again")
        self.assertEqual(*[(folder / "supports.csv").read_bytes()
                           for folder in (self.out, self.folder / "again")])

    def test_probes_measure_parts_and_points(self):
        self.run_of(PULL.format(by=0.002) + """
probes:
  - {name: middle, low: [-1, -1, 0.3], high: [1, 1, 0.4]}
  - {name: axis, at: [0, 0, 0.3]}
  - {name: above, facing: [0, 0, 1]}
""", "--set", "output.every=5")
        probes, rows = self.rows(self.out, "probes.csv"), self.rows(self.out)
        with (self.out / "probes.csv").open() as file:
            self.assertEqual(len(list(csv.DictReader(file))), 3 * 16)
        middle, axis, above = (probes[name] for name in ("middle", "axis", "above"))
        strain = float(middle["strain_zz"])
        self.assert_near(float(middle["strain_xx"]), -strain / 4, 0.03)
        self.assert_near(float(middle["stress_zz"]), E * strain, 0.03)
        self.assertLess(abs(float(middle["stress_xx"])), 1e-3 * E * strain)
        self.assert_near(float(axis["z"]) - float(axis["displacement_z"]), 0.3, 1e-12)
        gauge = self.vector(rows["above"], "pivot")[2] - self.vector(rows["below"], "pivot")[2] - 0.002
        low = self.vector(rows["below"], "pivot")[2]
        self.assert_near(float(axis["displacement_z"]), 0.002 * (0.3 - low) / gauge, 0.01)
        for name in "force", "displacement":
            for one, other in zip(self.vector(above, name), self.vector(rows["above"], name)):
                self.assertLess(abs(one - other), 1e-9 * max(1, abs(other)))
        self.assert_charts_show(above, middle)

    def assert_charts_show(self, above, middle):
        """The report has a chart of each quantity of the probes, with its unit and its last size."""
        sinew("measure", self.out)
        text = (self.out / "report.html").read_text()
        data = json.loads(re.search(r'id="data">(.*?)</script>', text, re.DOTALL)[1])
        charts = {chart["title"]: chart for chart in data["charts"]}
        stress = [float(middle[f"stress_{k}"]) for k in ("xx", "yy", "zz")]
        strain = [float(middle[f"strain_{k}"]) for k in ("xx", "yy", "zz")]
        deviator = lambda tensor: sum((one - sum(tensor) / 3) ** 2 for one in tensor) ** 0.5  # without shear
        for title, unit, name, size in [
                ("Displacement of probes", "m", "above", float(above["displacement_z"])),
                ("Forces on probes", "N", "above", float(above["force_z"])),
                ("Strain at probes", "", "middle", (2 / 3) ** 0.5 * deviator(strain)),
                ("Stress at probes", "Pa", "middle", 1.5 ** 0.5 * deviator(stress))]:
            self.assertEqual(charts[title]["unit"], unit)
            points = {line["name"]: line["points"] for line in charts[title]["lines"]}[name]
            self.assertEqual(len(points), 16)
            self.assertEqual(points[-1][0], 1.5)
            self.assert_near(points[-1][1], abs(size), 1e-3)

    def test_all_arrays_are_those_that_a_body_without_bones_has(self):
        self.run_of(PULL.format(by=0.002), "--set", "solver.duration=0.1", "--set", "output.arrays=all")
        frame = next((self.out / "particles").glob("*.vtu")).read_bytes()
        self.assertIn(b'"hencky_strain"', frame)
        self.assertNotIn(b'"pose_error"', frame)
        sinew("measure", self.out, "--arrays", "all")
        named = sinew("measure", self.out, "--arrays", "pose_error", check=2)
        self.assertIn("no particle has a bone", named.stderr)

    def test_the_report_offers_any_pair_of_columns(self):
        self.run_of(PULL.format(by=0.002) + "probes:\n  - {name: 'a, b', at: [0, 0, 0.3]}\n",
                    "--set", "solver.duration=0.5")
        sinew("measure", self.out)
        page = (self.out / "report.html").read_text()
        data = json.loads(re.search(r'id="data">(.*?)</script>', page, re.S).group(1))["machine"]
        columns = data["columns"]
        self.assertEqual([columns[data[axis]]["name"] for axis in ("across", "up")],
                         ["above: displacement_z", "above: force_z"])
        self.assertIn("a, b: strain_zz", [column["name"] for column in columns])
        self.assertNotIn("above: force_x", [column["name"] for column in columns])
        for column in columns:
            self.assertEqual(len(column["values"]), 6)
        table = self.out / "supports.csv"
        table.write_text(table.read_text().replace("support,", "support,x", 1))
        done = sinew("measure", self.out, check=2)
        self.assertRegex(done.stderr, "supports.csv: has 'x[^']*' where a number belongs; run")

    def test_what_a_probe_does_not_know_is_empty_and_said_once(self):
        """The end of a limb that turns so fast that its particles are inverted."""
        bones = ("skeleton: {bones: [{name: a, head: [0, 0, 0], tail: [0, 0, 0.35]}, {name: b, parent: a, tail: [0, 0, 0.69]}]}\n"
                 "motion: {tracks: [{bone: b, keys: [{time: 0}, {time: 0.05, axis: [0, 1, 0], angle: 720}]}]}\n"
                 "probes: [{name: end, facing: [0, 0, 1]}]\n")
        scene = self.folder / "fast.yaml"
        scene.write_text(f"body: {{mesh: {SOURCE / 'data/meshes/box.obj'}, radius: 0.03}}\nmaterial: {{model: bonded}}\n"
                         f"{bones}solver: {{duration: 0.1}}\noutput: {{interval: 0.05}}\n")
        done = sinew("simulate", scene, "-o", self.out)
        with (self.out / "probes.csv").open() as file:
            last = list(csv.DictReader(file))[-1]
        self.assertEqual({last[f"stress_{axes}"] for axes in ("xx", "yy", "zz", "xy", "yz", "xz")}, {""})
        self.assertTrue(all(value for name, value in last.items() if not name.startswith("stress")))
        self.assertEqual(done.stderr.count("probe 'end' has no strain or stress in some frames"), 1)
        sinew("measure", self.out)
        self.assertNotIn("nan", (self.out / "probes.csv").read_text())

    def test_supports_and_loads_are_a_series_of_their_own(self):
        self.run_of(PULL.format(by=0.002) + "loads: [{name: sea, pressure: 600}]\n",
                    "--set", "solver.duration=0.2", "--set", "output.encoding=none")
        rows = re.findall(r'file="([^"]*)"', (self.out / "supports.pvd").read_text())
        self.assertEqual(rows, [f"supports/supports_{i:06}.vtu" for i in range(3)])
        head = (self.out / rows[-1]).read_bytes()
        for name in [b"number", b"load", b"force", b"moment", b"power", b"displacement"]:
            self.assertIn(b'Name="' + name + b'"', head)
        self.assertIn(b'NumberOfPoints="3"', head)
        sinew("info", self.out, "--verify")
        sinew("simulate", "--force", self.scene("loads: []\nskeleton: {bones: [{name: a, head: [0, 0, 0], tail: [0, 0, 0.6]}]}\n"),
              "-o", self.out, "--set", "solver.duration=0.1")
        self.assertFalse((self.out / "supports.pvd").exists())
        self.assertFalse((self.out / "supports.csv").exists())

    def test_fast_supports_get_shorter_steps(self):
        self.run_of("supports:\n  - name: all\n    hold: x\n    keys: [{time: 0}, {time: 0.1, translation: [2, 0, 0]}]\n",
                    "--set", "solver.duration=0.2")
        self.assertIn("shorter_steps", json.loads((self.out / "run.json").read_text()))

    def test_a_load_on_what_is_held_is_doubtful(self):
        load = "loads:\n  - {name: hand, force: [1, 0, 0], facing: [0, 0, -1]}\n"
        for hold, doubtful in {"xyz": True, "z": False}.items():
            done = sinew("check", self.scene(f"supports:\n  - {{name: s, facing: [0, 0, -1], hold: {hold}}}\n" + load))
            self.assertEqual("load 'hand' acts on held particles" in done.stderr + done.stdout, doubtful)

    def test_check_tells_where_the_faces_of_supports_and_loads_look(self):
        for offset in "[0, 0, 0]", "[7, -3, 2]":
            scene = self.scene(PULL.format(by=0) + "loads: [{name: sea, pressure: 1}, {name: weight, gravity: [0, 0, -1]}]\n")
            scene.write_text(scene.read_text().replace("body:\n", f"body:\n  offset: {offset}\n"))
            told = {one["part"]: one for one in json.loads(sinew("check", scene, "--json").stdout)["faces_of_parts"]}
            self.assertEqual(list(told), ["below", "above", "sea"])  # a weight has no faces
            for name, side in ("below", "-z"), ("above", "+z"):
                self.assertEqual(list(told[name]["area_along"]), [side])
                self.assertAlmostEqual(told[name]["area_along"][side] / AREA, 1, places=9)
            self.assertEqual(len(told["sea"]["area_along"]), 6)
            self.assertIn("faces_of_part: sea, ", sinew("check", scene).stdout)

    def test_mistakes_are_named_with_their_line_and_cure(self):
        for machine, said in [
                ("supports:\n  - {name: a, low: [1, 1, 1], high: [2, 2, 2]}\n",
                 r"no particle is in the part of supports\[0\]; choose one that reaches"),
                ("supports:\n  - {name: a, bone: lower}\n", "there is no bone 'lower'"),
                ("supports:\n  - {name: a, ids: [1e6]}\n", r"there is no particle 1000000; give"),
                ("loads:\n  - {name: a, pressure: 1, low: [1, 1, 1], high: [2, 2, 2]}\n",
                 "no face of the surface is in the part of"),
                ("supports: [{name: s}]\nmaterials:\n  - {name: a, low: [0, 0, 0], high: [1, 1, 1]}\n", "material 'a' has nothing of its own; give"),
                ("supports: [{name: s}]\nmaterials:\n  - {name: a, poisson_ratio: 0.3}\n", "bonds alone is 1/4; leave poisson_ratio out"),
                ("supports: [{name: s}]\nmaterials:\n  - {name: a, density: 5, mesh: none.obj}\n", "none.obj"),
                ("supports: [{name: s}]\nmaterials:\n  - {name: a, density: -5}\n", "density is '-5', out of range; give"),
                ("supports: [{name: s}]\nmaterials:\n  - {name: a, density: 5, low: [5, 5, 5], high: [6, 6, 6]}\n",
                 r"no particle is in the part of materials\[0\]; choose"),
                ("supports:\n  - {name: a, hold_along: [0, 0, 0]}\n", "a direction without length; give"),
                ("supports:\n  - {name: a, point: [0, 0, 0]}\n", "half of a plane; give"),
                ("supports:\n  - {name: a, center: [0, 0, 0]}\n", "half of a ball; give"),
                ("supports:\n  - {name: a, low: [1, 1, 1], high: [0, 0, 0]}\n", "not below high on all axes; give"),
                ("supports:\n  - {name: a, keys: [{time: 1}, {time: 0}]}\n", "not in ascending time; sort"),
                ("supports:\n  - {name: a, keys: [{time: 0, angle: 5}]}\n", "is not at rest; begin"),
                ("supports:\n  - {name: a, holds: z}\n", "unknown key 'holds' .*; did you mean hold"),
                ("supports:\n  - {name: a, hold: xw}\n", "hold is 'xw'; use one of"),
                ("supports:\n  - {name: a}\n  -\n", r"supports\[1\].name is missing; add"),
                ("supports:\n  - {name: a}\n  - {name: a}\n", "two of supports are named 'a'; give"),
                ("supports:\n  - {name: a, hold_along: [1, 1, 0]}\n  - {name: b, hold: x}\n", "oblique direction; make"),
                ("loads:\n  - {name: a, force: [1, 0, 0], low: [1, 1, 1], high: [2, 2, 2]}\n",
                 r"no particle is in the part of loads\[0\]; choose"),
                ("loads:\n  - {name: a, force: [1, 0, 0], pressure: 5}\n", "more than one kind of load; give"),
                ("loads:\n  - {name: a}\n", "no kind of load; give"),
                ("loads:\n  - {name: a, force: 5}\n", "not a list of three numbers; give"),
                ("loads:\n  - {name: a, force: [1, 0, 0], keys: [{time: 1, factor: full}]}\n", "'full', not a number; give"),
                ("supports: [{name: s}]\nprobes:\n  - {name: a, low: [1, 1, 1], high: [2, 2, 2]}\n",
                 r"no particle is in the part of probes\[0\]; choose"),
                ("supports: [{name: s}]\nprobes:\n  - {name: a, at: [9, 0, 0]}\n", r"probe 'a' is 8.9\d* m away .*; give a point"),
                ("supports: [{name: s}]\nprobes:\n  - {name: a, at: [0, 0, 0], ids: [1]}\n", "a point and a part; keep one"),
                ("supports:\n  - {name: a, hold: x, hold_along: [1, 1, 0]}\n", "has hold and hold_along; keep one"),
                ("loads:\n  - {name: a, force: [0, 0, 1], component: 3}\n", "no particle is in the part"),
                ("supports:\n  - {name: a, hold: z}\n  - {name: b, keys: [{time: 0}, {time: 1, angle: 5}]}\n",
                 r"supports 'a' and 'b' both hold z of \d+ particles, and move them differently; make")]:
            out = self.folder / "a" / "b"
            for done in (sinew("check", self.scene(machine), check=2),
                         sinew("simulate", self.scene(machine), "-o", out, check=2)):
                self.assertRegex(done.stderr, r"bar.yaml:\d+:\d+: .*" + said)
                self.assertEqual(len(re.findall("^sinew: (?!warning)", done.stderr, re.M)), 1)
                self.assertEqual(done.stderr.count("bar.yaml:"), 1, done.stderr)
            self.assertFalse(out.parent.exists(), "something is written")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
