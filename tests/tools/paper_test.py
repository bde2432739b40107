#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Each equation of the paper, recomputed by numpy from the files of a run, frame by frame: forces over all pairs,
reference points from the bones at rest, and the step from one frame to the next.

usage: paper_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

import meshio
import numpy

from small_run import SOURCE, sinew

R, K1, DENSITY = 0.025, 5000.0, 800.0
STEP, FRAMES = 2e-4, 750
SCENE = """
body: {{mesh: {mesh}, radius: {R}}}
material: {{k1: {K1}, lambda: {rigidity}, a: {a}, b: {b}, density: {DENSITY}}}
binding: {{twist_form: {twist}, stiffness: 1.5, twist_stiffness: 1.2, axial_stiffness: 0.7}}
skeleton:
  bones:
    - {{name: lower, head: [0, 0, 0], tail: [0, 0, 0.34648]}}
    - {{name: upper, parent: lower, tail: [0, 0, 0.69296]}}
motion:
  tracks:
    - bone: upper
      keys: [{{time: 0}}, {{time: 0.15, euler: [0, 50, 0], twist: 20}}]
solver: {{duration: 0.15, time_step: {STEP}, gravity: [0, 0, -3]}}
output:
  interval: {STEP}
  double_precision: true
  arrays: acceleration bone_point force_radial force_twist force_axial
"""
VARIANTS = {"default": {"rigidity": 1, "a": 2, "b": 2.6, "twist": "servo"},
            "literal": {"rigidity": 0.05, "a": 2, "b": 2 * 2 ** 0.5, "twist": "servo"},
            "gap": {"rigidity": 0.3, "a": 2.15, "b": 2.6, "twist": "servo"},
            "open_loop": {"rigidity": 1, "a": 2, "b": 2.6, "twist": "open_loop"}}


def pair_force(d, a, b, k2):
    """Eq. 1; positive: repulsion."""
    return numpy.select([d < 2 * R, d < a, d < b], [K1 * (4 * R * R - d * d), 0, -k2 * (d - a) * (b - d)], 0)


def norms(vectors):
    return numpy.linalg.norm(vectors, axis=-1, keepdims=True)


def dots(one, other):
    return numpy.sum(one * other, axis=-1, keepdims=True)


def turn_about_own_axis(axis, side, side_at_rest, axis_at_rest):
    """Angle of a bone about its axis, beside its shortest turn from rest."""
    v, c = numpy.cross(axis_at_rest, axis), axis_at_rest @ axis
    carried = side_at_rest * c + numpy.cross(v, side_at_rest) + v * (v @ side_at_rest) / (1 + c)
    return numpy.arctan2(axis @ numpy.cross(carried, side), carried @ side)


class Frame:
    """Particles and bones of one moment."""

    def __init__(self, folder, number):
        particles = meshio.read(folder / f"particles/particles_{number:06}.vtu")
        frames = meshio.read(folder / f"frames/frames_{number:06}.vtu")
        self.x, self.data = particles.points, particles.point_data
        self.v = self.data["velocity"]
        self.head = frames.points
        self.axes = numpy.stack([frames.point_data[f"axis_{k}"] for k in "xyz"], axis=2)  # columns
        self.length = frames.point_data["length"]
        self.bone = self.data["bone"]


class Paper(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        folder = Path(cls.temporary.name)
        for name, values in VARIANTS.items():
            scene = folder / f"{name}.yaml"
            scene.write_text(SCENE.format(mesh=SOURCE / "data/meshes/box.obj", R=R, K1=K1, DENSITY=DENSITY, STEP=STEP,
                                          **values))
            sinew("simulate", scene, "-o", folder / name, check=0)
        cls.runs = {name: folder / name for name in VARIANTS}
        cls.frames = {name: [Frame(run, n) for n in (0, FRAMES - 1, FRAMES)] for name, run in cls.runs.items()}

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def each(cls):
        for name, values in VARIANTS.items():
            yield values, *cls.frames[name]

    def assert_same(self, found, expected, at_least):
        """To 1e-9 of the largest, which is no smaller than `at_least`."""
        largest = norms(expected).max()
        self.assertGreater(largest, at_least)
        numpy.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * largest)

    def test_pair_force_is_equation_1(self):
        for values, _, _, now in self.each():
            a, b = values["a"] * R, values["b"] * R
            k2 = values["rigidity"] * 4 * K1 * R / (b - a)
            offset = now.x[:, None] - now.x[None]
            d = norms(offset)
            numpy.fill_diagonal(d[:, :, 0], 9 * b)
            self.assert_same(now.data["force_pair"], numpy.sum(pair_force(d, a, b, k2) * offset / d, axis=1), 1e-3)

    def test_damping_is_equation_2(self):
        for values, _, _, now in self.each():
            near = numpy.linalg.norm(now.x[:, None] - now.x[None], axis=2) < values["b"] * R
            numpy.fill_diagonal(near, False)
            count = near.sum(1)
            numpy.testing.assert_array_equal(now.data["neighbors"], count)
            C = 0.5 * (4 * K1 * R * self.mass(now)) ** 0.5
            self.assert_same(now.data["force_damping"], -C * (now.v - near @ now.v / count[:, None]), 1e-4)

    def mass(self, frame):
        """The mesh's volume in equal parts."""
        return DENSITY * self.volume() / len(frame.x)

    @staticmethod
    def volume():
        mesh = meshio.read(SOURCE / "data/meshes/box.obj")
        volume = 0
        for block in mesh.cells:
            for corner in range(1, block.data.shape[1] - 1):
                p, q, r = (mesh.points[block.data[:, k]] for k in (0, corner, corner + 1))
                volume += numpy.sum(p * numpy.cross(q, r)) / 6
        return abs(volume)

    def bone_geometry(self, rest, now):
        """Reference points at rest and now, axes now, and places that the bones have carried: n x 3 each."""
        bone = now.bone
        at_rest, axis = rest.axes[bone], rest.axes[bone][:, :, 0]
        along = numpy.clip(dots(rest.x - rest.head[bone], axis), 0, rest.length[bone][:, None])
        foot = rest.head[bone] + along * axis
        turn = now.axes[bone] @ numpy.swapaxes(at_rest, 1, 2)
        carry = lambda point: now.head[bone] + numpy.einsum("nij,nj->ni", turn, point - rest.head[bone])
        return foot, carry(foot), now.axes[bone][:, :, 0], carry(rest.x)

    def spring(self, frame, factor):
        """factor E V0 / A of each particle's bone; A: the volume on it over its length."""
        count = numpy.bincount(frame.bone, minlength=len(frame.length))
        return (factor * 2 * 1.3505 * K1 * frame.length / count)[frame.bone][:, None]

    def test_a_particle_is_bound_to_the_nearest_bone(self):
        for _, rest, _, _ in self.each():
            distances = []
            for head, axes, length in zip(rest.head, rest.axes, rest.length, strict=True):
                along = numpy.clip((rest.x - head) @ axes[:, 0], 0, length)
                distances.append(norms(rest.x - head - along[:, None] * axes[:, 0])[:, 0])
            own = numpy.take_along_axis(numpy.array(distances), rest.bone[None], 0)[0]
            numpy.testing.assert_allclose(own, numpy.min(distances, axis=0), atol=1e-12)

    def test_reference_point_moves_with_the_bone(self):
        for _, rest, _, now in self.each():
            foot, point, _, _ = self.bone_geometry(rest, now)
            numpy.testing.assert_allclose(rest.data["bone_point"], foot, atol=1e-12)
            numpy.testing.assert_allclose(now.data["bone_point"], point, atol=1e-12)
            self.assertGreater(norms(point - foot).max(), 0.1)

    def test_radial_force_keeps_the_distance_from_the_reference_point(self):
        for _, rest, _, now in self.each():
            foot, point, _, _ = self.bone_geometry(rest, now)
            offset, length = now.x - point, norms(rest.x - foot)
            distance = norms(offset)
            expected = -self.spring(now, 1.5) * numpy.where(length < 1e-6 * R, offset, (1 - length / distance) * offset)
            self.assert_same(now.data["force_radial"], expected, 1e-3)

    def test_twist_force_turns_with_the_bone(self):
        for values, rest, _, now in self.each():
            _, point, axis, target = self.bone_geometry(rest, now)
            across = lambda offset: offset - dots(axis, offset) * axis
            wanted, actual = across(target - point), across(now.x - point)
            if values["twist"] == "open_loop":
                angle = numpy.array([turn_about_own_axis(one[:, 0], one[:, 1], first[:, 1], first[:, 0])
                                     for first, one in zip(rest.axes, now.axes, strict=True)])
                expected = self.spring(now, 1.2) * angle[now.bone][:, None] * numpy.cross(axis, actual)
            else:
                expected = self.servo(axis, wanted, actual) * self.spring(now, 1.2)
            self.assert_same(now.data["force_twist"], expected, 1e-3)

    @staticmethod
    def servo(axis, wanted, actual):
        """-grad of rho0^2 s^2 alpha^2 / 2, s = min(1, 2 rho / rho0), by its closed form; alpha below 120 degrees."""
        rho0, rho = norms(wanted), numpy.maximum(norms(actual), 1e-300)
        alpha = numpy.arctan2(dots(axis, numpy.cross(wanted, actual)), dots(wanted, actual))
        assert abs(alpha[rho0[:, 0] > 1e-6 * R]).max() < numpy.radians(120)
        taper = numpy.minimum(1, 2 * rho / numpy.maximum(rho0, 1e-300))
        slope = numpy.where(taper < 1, 2 / numpy.maximum(rho0, 1e-300), 0)
        outward = actual / rho
        force = -rho0 ** 2 * taper * (alpha * taper / rho * numpy.cross(axis, outward) + alpha ** 2 * slope * outward)
        return numpy.where(rho0 < 1e-6 * R, 0, force)

    def test_axial_force_holds_against_sliding(self):
        for _, rest, _, now in self.each():
            _, _, axis, target = self.bone_geometry(rest, now)
            self.assert_same(now.data["force_axial"], -self.spring(now, 0.7) * dots(axis, now.x - target) * axis, 1e-3)

    def test_acceleration_is_force_over_mass_and_gravity(self):
        for _, _, _, now in self.each():
            force = now.data["force_pair"] + now.data["force_damping"] + now.data["force_bone"]
            numpy.testing.assert_allclose(now.data["force"], force, atol=1e-15)
            self.assert_same(now.data["acceleration"], force / self.mass(now) + [0, 0, -3], 0.1)

    def test_a_step_is_that_of_euler(self):
        """The semi-implicit one: velocities first."""
        for _, _, before, now in self.each():
            change = STEP * before.data["acceleration"]
            numpy.testing.assert_allclose(now.v - before.v, change, rtol=0, atol=1e-9 * norms(before.v).max())
            numpy.testing.assert_allclose(now.x - before.x, STEP * now.v, rtol=0, atol=1e-12)


class Requested(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.scene = self.folder / "scene.yaml"
        self.scene.write_text(SCENE.format(mesh=SOURCE / "data/meshes/box.obj", R=0.04, K1=K1, DENSITY=DENSITY,
                                           STEP="0.01", **VARIANTS["default"]).replace("time_step: 0.01, ", ""))

    def tearDown(self):
        shutil.rmtree(self.folder)

    def test_particles_without_a_bone_have_no_point_and_no_pull(self):
        run = self.folder / "core"
        sinew("simulate", self.scene, "-o", run, "--set", "binding.core_radius=0.05", check=0)
        frame = Frame(run, 5)
        free = frame.bone < 0
        self.assertTrue(free.any() and not free.all())
        self.assertTrue(numpy.isnan(frame.data["bone_point"][free]).all())
        self.assertFalse(numpy.isnan(frame.data["bone_point"][~free]).any())
        for name in ["radial", "twist", "axial"]:
            self.assertEqual(abs(frame.data[f"force_{name}"][free]).max(), 0)

    def test_an_anchor_is_one_spring(self):
        run = self.folder / "anchor"
        sinew("simulate", self.scene, "-o", run, "--set", "binding.force=anchor", "--set", "binding.bone_damping=0",
              check=0)
        frame = Frame(run, 15)
        numpy.testing.assert_allclose(frame.data["force_radial"], frame.data["force_bone"], atol=1e-12)
        self.assertGreater(norms(frame.data["force_radial"]).max(), 1e-3)
        self.assertEqual(abs(frame.data["force_twist"]).max(), 0)

    def test_parts_of_the_pull_sum_to_it_where_several_bones_hold(self):
        run = self.folder / "zone"
        sinew("simulate", self.scene, "-o", run, "--set", "binding.joint_zone=2", "--set", "binding.bone_damping=0",
              check=0)
        frame = Frame(run, 15)
        self.assertLess(frame.data["weight"].min(), 0.9)
        total = sum(frame.data[f"force_{name}"] for name in ["radial", "twist", "axial"])
        numpy.testing.assert_allclose(total, frame.data["force_bone"], atol=1e-11)

    def test_files_do_not_give_them_later(self):
        run = self.folder / "plain"
        sinew("simulate", self.scene, "-o", run, "--set", "output.arrays=none", check=0)
        refused = sinew("measure", run, "--arrays", "J force_twist")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("force_twist", refused.stderr)
        self.assertIn("output.arrays", refused.stderr)
        sinew("measure", run, "--arrays", "all", check=0)
        self.assertEqual(numpy.isfinite(meshio.read(run / "values/values_000003.vtu").point_data["J"]).any(), True)


if __name__ == "__main__":
    unittest.main(argv=["paper_test", "-v", *sys.argv[3:]])
