#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What frames hold: output.only, every, region and inside_every, and what is measured of them.

usage: frame_content_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import csv
import json
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

import meshio
import numpy

from small_run import SCENE, SOURCE, sinew

REGION = [-1, -1, 0.2, 1, 1, 1]
DURATION = ["--set", "solver.duration=0.3"]


def frames(folder, series):
    return sorted((folder / series).glob("*.vtu"))


def metrics(folder):
    with (folder / "metrics.csv").open() as file:
        return {float(row["time"]): row for row in csv.DictReader(file)}


class FrameContent(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.runs = Path(cls.temporary.name)
        cls.scene = cls.runs / "small.yaml"
        cls.scene.write_text(SCENE.format(mesh=SOURCE / "data/meshes/box.obj"))
        cls.whole = cls.simulated("whole")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def simulated(cls, name, **output):
        words = [word for key, value in output.items() for word in ("--set", f"output.{key}={value}")]
        sinew("simulate", cls.scene, "-o", cls.runs / name, *DURATION, *words, check=0)
        return cls.runs / name

    def test_only_the_arrays_that_are_named_are_there(self):
        run = self.simulated("only", only="velocity, neighbors", arrays="J")
        for part, whole in zip(frames(run, "particles"), frames(self.whole, "particles"), strict=True):
            some, all_of_them = meshio.read(part), meshio.read(whole)
            self.assertEqual(set(some.point_data), {"velocity", "neighbors", "J"})
            numpy.testing.assert_array_equal(some.points, all_of_them.points)
            numpy.testing.assert_array_equal(some.point_data["velocity"], all_of_them.point_data["velocity"])

    def test_a_body_of_one_layer_lacks_strains_unless_they_are_named(self):
        strip = "".join(f"v {x} {y} {z}\n" for z in (-.004, .004) for y in (0, .1) for x in (0, .4))
        mesh, scene = self.runs / "strip.obj", self.runs / "strip.yaml"
        mesh.write_text(strip + "f 1 3 4\nf 1 4 2\nf 5 6 8\nf 5 8 7\nf 1 2 6\nf 1 6 5\nf 3 7 8\nf 3 8 4\nf 1 5 7\nf 1 7 3\nf 2 4 8\nf 2 8 6\n")
        scene.write_text(f"""body: {{mesh: {mesh}, radius: 0.005}}
material: {{model: bonded, young_modulus: 1e5}}
skeleton: {{bones: [{{name: a, head: [0, 0.05, 0], tail: [0.2, 0.05, 0]}}, {{name: b, parent: a, tail: [0.4, 0.05, 0]}}]}}
motion: {{tracks: [{{bone: b, keys: [{{time: 0}}, {{time: 0.1, axis: [0, 0, 1], angle: 10}}]}}]}}
solver: {{duration: 0.1}}
""")
        sinew("simulate", scene, "-o", self.runs / "strip", check=0)
        last = meshio.read(frames(self.runs / "strip", "particles")[-1])
        self.assertNotIn("strain_eq", last.point_data)
        self.assertIn("velocity", last.point_data)
        for name in ("strain_eq", "J"):
            refused = sinew("simulate", scene, "-o", self.runs / "refused", "--force", "--set", f"output.arrays={name}", check=2)
            self.assertIn("no particle has a value of " + name, refused.stderr)

    def test_particles_come_with_each_nth_frame_and_the_rest_with_all(self):
        run = self.simulated("every", every=4)
        for part, whole in zip(frames(run, "particles"), frames(self.whole, "particles")[::4], strict=True):
            self.assertEqual(part.read_bytes(), whole.read_bytes())
        for series in ["surface", "bones", "frames"]:
            for part, whole in zip(frames(run, series), frames(self.whole, series), strict=True):
                self.assertEqual(part.read_bytes(), whole.read_bytes())
        self.assertEqual((run / "bones.csv").read_text(), (self.whole / "bones.csv").read_text())
        for folder in [run, self.whole]:
            sinew("measure", folder, check=0)
        measured, of_whole = metrics(run), metrics(self.whole)
        self.assertEqual(list(measured), list(of_whole)[::4])
        for time, row in measured.items():
            self.assertEqual(row, of_whole[time])

    def test_a_run_that_was_stopped_goes_on_with_the_same_frames(self):
        run = self.simulated("stopped", every=4)
        whole = {path.name: path.read_bytes() for path in frames(run, "particles")}
        shutil.rmtree(run)
        done = sinew("simulate", self.scene, "-o", run, *DURATION, "--set", "output.every=4", "--set",
                     "solver.wall_time=0.01")
        self.assertEqual(done.returncode, 130, done.stderr)
        sinew("simulate", self.scene, "-o", run, *DURATION, "--set", "output.every=4", "--resume", check=0)
        self.assertEqual({path.name: path.read_bytes() for path in frames(run, "particles")}, whole)

    def test_a_region_holds_the_particles_that_were_in_it_at_rest(self):
        text = ", ".join(str(value) for value in REGION)
        run = self.simulated("region", region=f"[{text}]", only="id, velocity")
        rest = meshio.read(run / "body.vtu").points
        inside = numpy.flatnonzero((rest >= REGION[:3]).all(axis=1) & (rest <= REGION[3:]).all(axis=1))
        self.assertTrue(0 < len(inside) < len(rest))
        for part, whole in zip(frames(run, "particles"), frames(self.whole, "particles"), strict=True):
            some = meshio.read(part)
            numpy.testing.assert_array_equal(some.point_data["id"], inside)
            numpy.testing.assert_array_equal(some.points, meshio.read(whole).points[inside])
        sinew("measure", run, "--arrays", "J", check=0)
        last = meshio.read(frames(run, "values")[-1])
        numpy.testing.assert_array_equal(last.point_data["id"], inside)
        moved = numpy.linalg.norm(last.points - rest[inside], axis=1).max()
        measured = metrics(run)
        self.assertAlmostEqual(float(measured[max(measured)]["displacement_max"]), moved, 6)
        self.assertEqual([row["volume_error"] for row in measured.values()],
                         [row["volume_error"] for row in self.measured_whole().values()])

    def measured_whole(self):
        sinew("measure", self.whole, check=0)
        return metrics(self.whole)

    def test_the_surface_has_the_arrays_of_particles_that_are_asked_for(self):
        usual = {"displacement", "normal", "bone"}
        for name, words, more in [("plain", {}, {"strain_eq"}),
                                  ("none", {"skin": "none"}, set()),
                                  ("few", {"only": "id"}, {"strain_eq"}),
                                  ("asked", {"skin": "velocity, stress"}, {"strain_eq", "velocity", "stress"})]:
            run = self.simulated("skin_" + name, **words)
            for path in frames(run, "surface"):
                self.assertEqual(set(meshio.read(path).point_data), usual | more)
        surface = meshio.read(frames(run, "surface")[-1])
        particles = meshio.read(frames(run, "particles")[-1])
        self.assertEqual(surface.point_data["stress"].shape, (len(surface.points), 6))
        for array in ["strain_eq", "velocity"]:  # means lie between what they are of
            self.assertTrue(numpy.isfinite(surface.point_data[array]).all())
            self.assertTrue((surface.point_data[array].max(axis=0) <= particles.point_data[array].max(axis=0)).all())
            self.assertTrue((surface.point_data[array].min(axis=0) >= particles.point_data[array].min(axis=0)).all())
        units = json.loads((run / "run.json").read_text())["arrays"]["surface"]
        self.assertEqual((units["stress"]["unit"], units["velocity"]["unit"]), ("Pa", "m/s"))

    def test_the_surface_has_the_same_arrays_where_frames_lack_particles(self):
        run = self.simulated("skin_every", every=4, skin="force, J")
        whole = self.simulated("skin_whole", skin="force, J")
        for part, of_whole in zip(frames(run, "surface"), frames(whole, "surface"), strict=True):
            self.assertEqual(part.read_bytes(), of_whole.read_bytes())

    def test_an_array_that_particles_lack_is_refused_for_the_surface(self):
        done = sinew("simulate", self.scene, "-o", self.runs / "refused", "--set", "output.skin=velocty")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("did you mean velocity?", done.stderr)

    def test_what_a_particle_has_no_value_of_is_not_a_number(self):
        for words, name, some in [(["binding.core_radius=0.05"], "pose_error", True),
                                  (["body.lattice_rotation=[20, 30, 40]", "body.radius=0.035"], "J", None)]:
            run = self.runs / "partial"
            sets = [part for word in [*words, f"output.arrays={name}"] for part in ("--set", word)]
            sinew("simulate", self.scene, "-o", run, "--force", *DURATION, *sets, check=0)
            for path in frames(run, "particles"):
                frame = meshio.read(path)
                undefined = numpy.isnan(frame.point_data[name])
                self.assertFalse(undefined.all())
                if some:
                    numpy.testing.assert_array_equal(undefined, frame.point_data["bone"] < 0)
                    self.assertTrue(undefined.any())
                self.assertTrue(numpy.isfinite(frame.point_data["force"]).all())
            sinew("measure", run, check=0)

    def test_stress_of_bonds_that_change_is_written_and_cannot_be_found_later(self):
        for words in (["material.model=bonded", "material.breaking_strain=0.3"], ["material.preset=clay"]):
            run = self.runs / "changing"
            sets = [part for word in [*words, "output.arrays=stress"] for part in ("--set", word)]
            sinew("simulate", self.scene, "-o", run, "--force", *DURATION, *sets, check=0)
            for path in frames(run, "particles"):
                for name in ("stress", "von_mises"):  # the second unasked
                    self.assertTrue(numpy.isfinite(meshio.read(path).point_data[name]).all())
            done = sinew("measure", run, "--arrays", "stress")
            self.assertEqual(done.returncode, 2, done.stderr)
            for part in ["stress", "break or creep", "output.arrays"]:
                self.assertIn(part, done.stderr)
            sinew("measure", run, check=0)
            self.assertIn('"von_mises_95"', (run / "metrics.json").read_text())

    def test_of_the_inside_each_nth_particle_is_written(self):
        finer = ["--set", "body.radius=0.013"]
        run, all_of_it = self.runs / "inside", self.runs / "finer"
        sinew("simulate", self.scene, "-o", all_of_it, *DURATION, *finer, check=0)
        sinew("simulate", self.scene, "-o", run, *DURATION, *finer, "--set", "output.inside_every=5", check=0)
        rest = meshio.read(frames(all_of_it, "particles")[0])
        radius = rest.point_data["radius"][0]
        apart = numpy.linalg.norm(rest.points[:, None, :] - rest.points[None, :, :], axis=2)
        near = (apart < 2.2 * radius) & (apart > 0)
        has_all = near.sum(axis=1) == 12
        inside = has_all & (near & ~has_all[None, :] == 0).all(axis=1)
        self.assertGreater(inside.sum(), 20)
        written = numpy.flatnonzero(~inside).tolist() + numpy.flatnonzero(inside)[::5].tolist()
        for part, whole in zip(frames(run, "particles"), frames(all_of_it, "particles"), strict=True):
            some, all_of_them = meshio.read(part), meshio.read(whole)
            numpy.testing.assert_array_equal(some.points, all_of_them.points[sorted(written)])
            self.assertTrue(numpy.isfinite(some.point_data["von_mises"]).all())
        sinew("measure", run, check=0)

    def test_what_cannot_be_written_is_refused_at_its_line(self):
        for words, parts in {"output.only=velocty": ["did you mean velocity?"],
                             "output.every=0": ["output.every"],
                             "output.region=[0, 0, 0, 1, 1]": ["6"],
                             "output.region=[0, 0, 1, 1, 1, 0]": ["corners", "least"],
                             "output.region=[5, 5, 5, 6, 6, 6]": ["no particle", "meters"],
                             "output.inside_every=0": ["output.inside_every"]}.items():
            with self.subTest(words=words):
                done = sinew("simulate", self.scene, "-o", self.runs / "bad", "--set", words)
                self.assertEqual(done.returncode, 2, done.stderr)
                for part in [words.split("=")[0], *parts]:
                    self.assertIn(part, done.stderr)
                self.assertFalse((self.runs / "bad/particles").exists())


if __name__ == "__main__":
    unittest.main(argv=["frame_content_test", "-v", *sys.argv[3:]])
