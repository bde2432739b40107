#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every frame of a run of the static method is of its own moment: Newton's method and relaxation agree in all that is
written, what acts from outside sums to nothing, and a run that stops anywhere goes on to the same frames.

usage: equilibria_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import csv
import functools
import json
import sys
import tempfile
import unittest
from pathlib import Path

import meshio
import numpy

import small_run
from bars import write_box

RESIDUAL = 1e-8
ROUNDING = 1e-7  # N, m and others: what the solvers leave of forces that are nothing
LAYER = 0.01 * 2 ** 0.5  # between the planes of a packing with radius 0.01
PLANES, LENGTH = 5, 17
WIDTH, HEIGHT = PLANES * LAYER, LENGTH * LAYER
YOUNG_MODULUS = 1e5  # Pa
BENDING = YOUNG_MODULUS * WIDTH ** 4 / 4 / HEIGHT ** 3  # N/m, of the free end across

SCENE = """
body: {{mesh: bar.obj, radius: 0.01{body}}}
material: {{model: {model}, young_modulus: 1e5{material}}}
probes: [{{name: middle, low: [{low}], high: [{high}]}}]
solver: {{method: static, duration: 1, residual: {residual}}}
output: {{interval: 0.25, arrays: "stress, strain", bonds: true, volume: true}}
{machine}
"""

CLAMP = "  - {name: clamp, facing: [0, 0, -1]}\n"
GRIP = "supports:\n" + CLAMP + """\
  - name: grip
    facing: [0, 0, 1]
    keys: [{time: 0}, {time: 1, translation: [0.03, 0.01, -0.004], axis: [0, 0, 1], angle: 20}]
"""
LOAD = "supports:\n" + CLAMP + f"""\
loads:
  - name: pull
    force: [{0.02 * BENDING}, {0.01 * BENDING}, {-0.03 * BENDING}]
    facing: [0, 0, 1]
    keys: [{{time: 0, factor: 0}}, {{time: 0.5, factor: 0.7}}, {{time: 1, factor: 1}}]
  - {{name: weight, gravity: [2, 0, -9.81]}}
"""
OBSTACLE = "supports:\n" + CLAMP + f"""\
world:
  obstacles:
    - name: plate
      shape: plane
      point: [0, 0, {HEIGHT + 0.008}]
      normal: [0.1, 0, -1]
      keys: [{{time: 0}}, {{time: 1, translation: [0, 0, -0.015]}}]
"""
BONE = "supports:\n" + CLAMP + f"""\
skeleton: {{bones: [{{name: hand, head: [0, 0, {HEIGHT * 0.6}], tail: [0, 0, {HEIGHT}]}}]}}
motion: {{tracks: [{{bone: hand, keys: [{{time: 0}}, {{time: 1, axis: [0, 1, 0.3], angle: 25}}]}}]}}
binding: {{core_radius: 0.02}}
"""
DEPTH = 2000  # Pa
PRESSURE = "supports:\n" + CLAMP + f"""\
loads: [{{name: deep, pressure: {DEPTH}, keys: [{{time: 0, factor: 0}}, {{time: 1, factor: 1}}]}}]
"""

sinew = functools.partial(small_run.sinew, check=0, timeout=300)


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def quantities(out):
    """All numbers of a run by name, frame by frame: components of a vector in one array."""
    found = {}

    def add(name, values):
        found.setdefault(name, []).append(numpy.asarray(values, dtype=float))

    for table in ("supports.csv", "probes.csv", "bones.csv", "metrics.csv", "metrics_bones.csv"):
        for row in rows(out / table) if (out / table).exists() else []:
            vectors = {}
            for column, cell in row.items():
                if column in ("name", "kind", "bone", "time"):
                    continue
                vectors.setdefault(column.rstrip("xyz") if column[-2:-1] == "_" else column, []).append(float(cell or "nan"))
            for column, values in vectors.items():
                add((table, row.get("name") or row.get("bone"), column), values)
    for series in sorted(out.glob("*.pvd")):
        for file in sorted((out / series.stem).glob("*.vtu")):
            if b'NumberOfPoints="0"' in file.read_bytes():  # meshio reads none of these
                continue
            mesh = meshio.read(file)
            add((series.stem, "points"), mesh.points)
            for name, values in mesh.point_data.items():
                add((series.stem, name), values)
            for name, values in mesh.cell_data.items():
                add((series.stem, name), numpy.concatenate(values or [[]]))
    return found


def left_out(name):
    """What tells how an equilibrium was found, and velocities, which relaxation halts."""
    return name[-1].startswith("unbalanced") or name[-1] in ("velocity", "speed_max")


class Equilibria(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)
        write_box(self.folder / "bar.obj", WIDTH, HEIGHT)

    def tearDown(self):
        self.temporary.cleanup()

    def scene(self, machine, model="bonded", body="", material="", residual=RESIDUAL, at=(0, 0, 0)):
        path = self.folder / "bar.yaml"
        low, high = (", ".join(str(x + by) for x, by in zip(corner, at))
                     for corner in ((-1, -1, 0.4 * HEIGHT), (1, 1, 0.6 * HEIGHT)))
        path.write_text(SCENE.format(machine=machine, model=model, body=body, material=material, low=low, high=high,
                                     residual=residual))
        return path

    def run_by(self, solver, *words, measured=True):
        out = self.folder / solver
        sinew("simulate", self.folder / "bar.yaml", "-o", out, "--force", "--set",
              f"solver.static_solver={solver}", *words)
        if measured:
            sinew("measure", out)
        return out

    def record(self, out):
        return json.loads((out / "run.json").read_text())

    def assert_same_frames(self, one, other):
        a, b = quantities(one), quantities(other)
        self.assertEqual(a.keys(), b.keys())
        for name in a:
            if left_out(name):
                continue
            largest = max(numpy.nanmax(numpy.abs(frame), initial=0) for frame in a[name] + b[name])
            for k, (left, right) in enumerate(zip(a[name], b[name], strict=True)):
                apart = numpy.nanmax(numpy.abs(left - right), initial=0)
                self.assertLessEqual(apart, 1e-4 * largest + ROUNDING, f"{name}, row {k}")

    def acting(self, out, frame, center):
        """Forces and moments about the center on the body in a frame, of each that acts from outside; moments of
        obstacles are about frames that no file tells, and left out."""
        for row in rows(out / "supports.csv"):
            if float(row["time"]) == frame * 0.25:
                force, moment, pivot = (numpy.array([float(row[f"{what}_{axis}"]) for axis in "xyz"])
                                        for what in ("force", "moment", "pivot"))
                yield force, moment + numpy.cross(pivot - center, force)
        if self.record(out)["bones"]:
            bones = meshio.read(out / f"frames/frames_{frame:06}.vtu")
            for head, force, moment in zip(bones.points, -bones.point_data["reaction_force"],
                                           -bones.point_data["reaction_moment"]):
                yield force, moment + numpy.cross(head - center, force)
        if (out / "obstacles.pvd").exists():
            plate = meshio.read(out / f"obstacles/obstacles_{frame:06}.vtu")
            yield -plate.point_data["reaction_force"][0], None

    def test_what_acts_from_outside_sums_to_nothing_in_every_frame(self):
        for machine in (GRIP, LOAD, OBSTACLE, BONE, PRESSURE):
            self.scene(machine)
            out = self.run_by("auto", "--set", "output.double_precision=true")
            table = rows(out / "metrics.csv")
            acting = []
            for frame in range(5):
                center = meshio.read(out / f"particles/particles_{frame:06}.vtu").points.mean(axis=0)
                acting.append(list(self.acting(out, frame, center)))
            largest = max(numpy.linalg.norm(force) for one in acting for force, _ in one)
            if machine is PRESSURE:  # whose own sum is nothing
                largest = DEPTH * (4 * WIDTH * HEIGHT + 2 * WIDTH ** 2)
            for frame, found in enumerate(acting):
                force = numpy.linalg.norm(sum(force for force, _ in found))
                self.assertLessEqual(force, RESIDUAL * largest, (machine, frame))
                self.assertAlmostEqual(float(table[frame]["unbalanced_force"]), force, delta=0.1 * RESIDUAL * largest)
                if machine is not OBSTACLE:
                    moment = numpy.linalg.norm(sum(moment for _, moment in found))
                    self.assertLessEqual(moment, RESIDUAL * largest * HEIGHT, (machine, frame))
            record = self.record(out)
            for name in ("unbalanced_force", "unbalanced_moment"):
                self.assertEqual(record[name], max(step[name] for step in record["load_steps"]))
                self.assertAlmostEqual(record[name] / max(float(row[name]) for row in table), 1, 6)
            self.assertLessEqual(record["unbalanced_force"], RESIDUAL * largest)

    def test_a_run_that_stops_anywhere_goes_on_to_the_same_frames(self):
        """After each of Newton's iterations; a relaxation where its iterations are too few."""
        for machine, solver, limit, code in ((LOAD, "newton", "solver.wall_time=1e-9", 130),
                                             (OBSTACLE, "relaxation", "solver.iterations=700", 3)):
            scene, words = self.scene(machine), ["--set", f"solver.static_solver={solver}", "--set", "output.interval=0.5"]
            whole, parts = self.run_by(solver, *words[2:], measured=False), self.folder / "parts"
            done = sinew("simulate", scene, "-o", parts, "--force", *words, "--set", limit, check=code)
            stops = 1
            while done.returncode == 130:
                stops += 1
                done = sinew("simulate", scene, "-o", parts, "--resume", *words, "--set", limit, check=None)
            if code == 3:
                done = sinew("simulate", scene, "-o", parts, "--resume", *words, check=None)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertGreater(stops, 5 if code == 130 else 0)
            for file in sorted(path for path in whole.rglob("*.*") if path.suffix in (".vtu", ".csv")):
                self.assertEqual(file.read_bytes(), (parts / file.relative_to(whole)).read_bytes(), file)

    def test_newtons_frames_are_those_of_relaxation(self):
        for machine, more in ((GRIP, {}), (LOAD, {"body": ", lattice_rotation: [31, 17, 9]"}), (OBSTACLE, {}),
                              (BONE, {}),
                              (GRIP, {"model": "bonded_volume", "material": ", poisson_ratio: 0.4"})):
            with self.subTest(machine=machine, **more):
                self.scene(machine, **more)
                newton = self.run_by("newton")
                self.assertLess(self.record(newton)["load_steps"][-1]["iterations"], 100)
                self.assert_same_frames(newton, self.run_by("relaxation"))

    def test_a_body_far_from_the_origin_rests_as_at_it(self):
        """Where coordinates have fewer digits left for forces."""
        forces = []
        for way in (0, 1e4):
            place = (way, -2 * way, way / 2)
            write_box(self.folder / "bar.obj", WIDTH, HEIGHT, place)
            self.scene(GRIP, residual=1e-4, at=place)
            for solver in ("newton", "relaxation"):
                out = self.run_by(solver, "--set", "output.volume=false", measured=False)
                forces.append([[float(row["force_" + axis]) for axis in "xyz"] for row in rows(out / "supports.csv")])
        for found in forces[1:]:
            self.assertLess(numpy.abs(numpy.subtract(found, forces[0])).max(), 2e-3 * numpy.abs(forces[0]).max())

    def test_forces_that_single_precision_hides_are_told(self):
        """A slender bar yields to a force that is nothing beside the rounding of what strains it."""
        write_box(self.folder / "bar.obj", WIDTH, 65 * LAYER)
        scene = self.scene(GRIP.replace("0.03, 0.01", "0.3, 0.1"), residual=1e-3)
        for precision, is_told in (("single", True), ("double", False)):
            done = sinew("simulate", scene, "-o", self.folder / precision, "--set", f"solver.precision={precision}")
            self.assertEqual("the forces on the body sum to" in done.stderr, is_told, done.stderr)

    def test_nothing_acts_before_anything_moves(self):
        for machine in (GRIP, OBSTACLE, BONE):
            self.scene(machine)
            found = quantities(self.run_by("newton"))
            for name in (name for name in found if name[-1] in ("force_", "displacement", "force")):
                rest = numpy.nanmax(numpy.abs(found[name][0]), initial=0)
                moved = max(numpy.nanmax(numpy.abs(frame), initial=0) for frame in found[name])
                self.assertLessEqual(rest, 1e-6 * moved + 1e-12, name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
