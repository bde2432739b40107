#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python package: the same bits as the commands, no copies, no leaks, errors with a cure.

usage: python_test.py BIN SOURCE      folder of the programs, folder of the project; PYTHONPATH names the package's
"""
import gc
import os
import resource
import signal
import subprocess
import sys
import threading
import time
import unittest

import meshio
import numpy
import sinew

from small_run import SOURCE, SmallRun
from small_run import sinew as command

BAR = {
    "material": {"model": "bonded"},
    "skeleton": {"bones": [{"name": "low", "head": [0, 0, 0], "tail": [0, 0, 0.1]},
                           {"name": "high", "parent": "low", "tail": [0, 0, 0.2]}]},
    "motion": {"tracks": [{"bone": "high", "keys": [{"time": 0}]}]},
}


def grid(nx, ny, nz, spacing):
    """A face-centered cubic packing of particles whose diameter is `spacing`."""
    side = spacing * 2 ** 0.5
    cells = numpy.stack(numpy.meshgrid(range(nx), range(ny), range(nz), indexing="ij"), -1).reshape(-1, 1, 3)
    corners = numpy.array([[0, 0, 0], [0.5, 0.5, 0], [0.5, 0, 0.5], [0, 0.5, 0.5]])
    return side * (cells + corners).reshape(-1, 3)


class Scenes(SmallRun):
    def test_fill_is_as_the_command(self):
        body = sinew.fill(SOURCE / "data/meshes/arm.ply", radius=0.01)
        command("fill", SOURCE / "data/meshes/arm.ply", "--radius", "0.01", "-o", self.folder / "arm.vtu", check=0)
        filled = meshio.read(self.folder / "arm.vtu")
        numpy.testing.assert_array_equal(body.points, filled.points)
        numpy.testing.assert_array_equal(body.component, filled.point_data["component"])
        self.assertEqual(body.mass, filled.point_data["mass"][0])
        self.assertEqual(len(body), len(body.points))
        small = sinew.fill(SOURCE / "data/meshes/arm.ply", count=500, unit="cm", packing="hcp")
        self.assertAlmostEqual(len(small) / 500, 1, delta=0.1)
        glass = [sinew.fill(SOURCE / "data/meshes/arm.ply", count=500, packing="random", seed=seed) for seed in (1, 1, 2)]
        numpy.testing.assert_array_equal(glass[0].points, glass[1].points)
        self.assertNotEqual(glass[0].points.tobytes(), glass[2].points.tobytes())

    def test_paths_and_names_of_any_letters(self):
        for word in ("ü", "骨", "🦴", "it's \"so\"", "a\\b"):
            folder = self.folder / word
            folder.mkdir()
            mesh = folder / f"{word}.obj"
            mesh.write_bytes((SOURCE / "data/meshes/box.obj").read_bytes())
            self.assertEqual(len(sinew.fill(mesh, count=100)), len(sinew.fill(str(mesh), count=100)))
            bones = [{"name": word, "head": [0, 0, 0], "tail": [0, 0, 1]}]
            scene = sinew.make_scene({"body": {"mesh": mesh, "radius": 0.05}, "skeleton": {"bones": bones},
                                      "solver": {"duration": 0.01}, "output": {"interval": 0.01}},
                                     folder=folder)
            self.assertEqual(sinew.Simulation(scene).bones, [word])
            self.assertEqual(len(sinew.simulate(scene, folder / "run")), 2)

    def test_a_scene_is_filled_as_it_says(self):
        scene = sinew.read_scene(self.scene)
        self.assertEqual(sinew.fill(scene).radius, 0.025)
        with self.assertRaisesRegex(sinew.Error, "a scene says itself"):
            sinew.fill(scene, radius=0.01)

    def test_steps_are_as_the_commands(self):
        self.simulate("--set", "output.double_precision=true")
        simulation = sinew.Simulation(sinew.read_scene(self.scene))
        end = meshio.read(sorted((self.out / "particles").glob("*.vtu"))[-1])
        simulation.run_until(0.4)
        numpy.testing.assert_array_equal(simulation.positions, end.points)
        numpy.testing.assert_array_equal(simulation.velocities, end.point_data["velocity"])
        surface = meshio.read(sorted((self.out / "surface").glob("*.vtu"))[-1])
        numpy.testing.assert_array_equal(simulation.surface, surface.points)
        numpy.testing.assert_array_equal(simulation.faces, surface.cells_dict["triangle"])

    def test_runs_and_metrics_are_as_the_files(self):
        run = sinew.simulate(sinew.read_scene(self.scene, {"body.radius": 0.04}), self.out)
        self.assertEqual(len(run), 13)
        self.assertAlmostEqual(run[-1].time, 0.4)
        numpy.testing.assert_allclose(run.times, [run[i].time for i in range(13)])
        moved = numpy.linalg.norm(run[6].positions - run.rest, axis=1)
        numpy.testing.assert_allclose(moved, run[6].distance, atol=1e-6)
        command("measure", self.out, check=0)
        columns = sinew.measure(self.out)
        table = numpy.genfromtxt(self.out / "metrics.csv", delimiter=",", names=True)
        for name in ("time", "volume_error", "kinetic_energy"):
            numpy.testing.assert_allclose(columns[name], table[name], rtol=1e-12)
        with self.assertRaises(IndexError):
            run[13]

    def test_errors_are_those_of_the_commands(self):
        for cause, part in ((lambda: sinew.read_scene("none.yaml"), "none.yaml"),
                            (lambda: sinew.read_scene(self.scene, {"body.radus": 1}), "radius"),
                            (lambda: sinew.fill("none.obj", radius=1), "none.obj"),
                            (lambda: sinew.open_run(self.folder), "run"),
                            (lambda: sinew.Body([[0, 0]], 1), "(n, 3)"),
                            (lambda: sinew.Body([], 1), "(n, 3)"),
                            (lambda: sinew.Body([[0, 0, float("nan")]], 1), "finite"),
                            (lambda: sinew.Body([[0, 0, 0]], -1), "radius")):
            with self.assertRaises(sinew.Error) as raised:
                cause()
            self.assertIn(part, str(raised.exception))
            self.assertEqual(raised.exception.exit_code, 2)

    def test_cures_are_arguments_of_python(self):
        stopped = self.folder / "stopped"
        sinew.simulate(sinew.read_scene(self.scene, {"solver.duration": 60, "solver.wall_time": 1}), stopped)
        other = sinew.read_scene(self.scene, {"solver.duration": 60, "material.model": "bonded"})
        sinew.new(SOURCE / "data/meshes/box.obj", scene=self.folder / "new.yaml")
        for cause in (lambda: sinew.simulate(other, stopped), lambda: sinew.simulate(other, stopped, resume=True),
                      lambda: sinew.new(SOURCE / "data/meshes/box.obj", scene=self.folder / "new.yaml")):
            with self.assertRaisesRegex(sinew.Error, "force=True") as raised:
                cause()
            self.assertNotRegex(str(raised.exception), r"(^| )--?[a-z]")
        for file in (stopped / "checkpoint").iterdir():
            file.write_bytes(file.read_bytes()[:-1])
        with self.assertRaisesRegex(sinew.Error, "remove the file to go on without it"):
            sinew.simulate(sinew.read_scene(stopped / "scene.yaml"), stopped, resume=True)


class Examples(SmallRun):
    def example(self, name, *words, before=()):
        done = subprocess.run([*before, sys.executable, SOURCE / "lib/examples" / name, *map(str, words)],
                              capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_a_chart_of_a_run(self):
        self.simulate()
        self.example("chart.py", self.out, self.folder / "chart.png")
        self.assertGreater((self.folder / "chart.png").stat().st_size, 5000)

    def test_a_study_of_parameters(self):
        rows = self.example("parameter_study.py", self.scene).splitlines()[1:]
        moduli, damping, far = numpy.array([row.split() for row in rows], float).T
        numpy.testing.assert_array_equal(moduli, [5e3, 5e3, 1e4, 1e4, 2e4, 2e4])
        numpy.testing.assert_array_equal(damping, [0.5, 1] * 3)
        self.assertTrue((far > 0).all() and len(set(far)) == 6)

    def test_a_force_of_ones_own(self):
        words = self.example("own_force.py", SOURCE / "data/meshes/tentacle.ply").split()
        self.assertGreater(float(words[3]), 0.01)  # downwind

    def test_a_picture_by_vtk(self):
        self.example("vtk_scene.py", self.scene, self.folder / "pose.png", before=[SOURCE / "tests/tools/on_display.sh"])
        self.assertGreater((self.folder / "pose.png").stat().st_size, 5000)


class Made(unittest.TestCase):
    """Bodies and scenes made in Python."""

    def setUp(self):
        self.body = sinew.Body(grid(3, 3, 10, 0.02) - [0.04, 0.04, 0], 0.01)
        self.scene = sinew.make_scene(BAR, self.body)

    def test_a_pose_moves_the_body(self):
        simulation = sinew.Simulation(self.scene, self.body)
        self.assertEqual(simulation.bones, ["low", "high"])
        half = numpy.radians(45) / 2
        simulation.set_pose({"high": (numpy.cos(half), 0, numpy.sin(half), 0)}, over=0.5)
        simulation.run_until(1)
        top = self.body.points[:, 2] > 0.22
        expected = (self.body.points[top] - [0, 0, 0.1]) @ numpy.array([[1, 0, -1], [0, 2 ** 0.5, 0], [1, 0, 1]]) \
            / 2 ** 0.5 + [0, 0, 0.1]
        self.assertLess(abs(simulation.positions[top] - expected).max(), 0.01)
        for wrong, part in (({"none": (1, 0, 0, 0)}, "take one of low, high"), ({"high": (0, 0, 0, 0)}, "quaternion")):
            with self.assertRaises(sinew.Error) as raised:
                simulation.set_pose(wrong)
            self.assertIn(part, str(raised.exception))
        before = simulation.positions.copy()
        simulation.set_pose({"low": (1, 0, 0, 0)})  # high stays as it is
        simulation.run_until(1.2)
        self.assertLess(abs(simulation.positions - before).max(), 0.003)

    def test_a_pose_begins_where_the_motion_of_the_scene_is(self):
        keys = [{"time": 0}, {"time": 0.2, "axis": [0, 1, 0], "angle": 30}]
        scene = sinew.make_scene(BAR | {"motion": {"tracks": [{"bone": "high", "keys": keys}]}}, self.body)
        simulation = sinew.Simulation(scene, self.body)
        simulation.run_until(0.6)
        before = simulation.positions.copy()
        simulation.set_pose({"low": (1, 0, 0, 0)})
        simulation.run_until(0.8)
        self.assertLess(abs(simulation.positions - before).max(), 0.003)

    def test_groups_refuse_a_pose_and_go_on(self):
        for dynamic in (False, True):
            words = {"hierarchy": {"enabled": True, "dynamic": dynamic, "min_particles": 64}}
            simulation = sinew.Simulation(sinew.make_scene(BAR | words, self.body), self.body)
            with self.assertRaises(sinew.Error) as raised:
                simulation.set_pose({"high": (1, 0, 0, 0)})
            self.assertIn("groups of particles", str(raised.exception))
            self.assertIn("set hierarchy.enabled to false", str(raised.exception))
            simulation.step(2)

    def test_forces_of_ones_own_accelerate(self):
        """Newton's second law for the first step, and a body that is pushed alike moves as in gravity."""
        pushed = sinew.Simulation(self.scene, self.body, own_forces=True)
        fallen = sinew.Simulation(sinew.make_scene(BAR | {"solver": {"gravity": [0, 0, -2]}}, self.body), self.body)
        pushed.set_forces(numpy.full((len(self.body), 3), (0, 0, -2)) * self.body.mass)
        for simulation in (pushed, fallen):
            simulation.step(50)
        numpy.testing.assert_allclose(pushed.positions, fallen.positions, atol=1e-9)
        forces = numpy.zeros((len(self.body), 3))
        forces[7] = (0.1, 0, 0)
        other = sinew.Simulation(self.scene, self.body, own_forces=True)
        other.set_forces(forces)
        other.step()
        moved = numpy.abs(other.positions - self.body.points).max(1)
        self.assertEqual(numpy.argmax(moved), 7)
        for bad in (numpy.zeros((3, 3)), numpy.full((len(self.body), 3), numpy.nan)):
            with self.assertRaises(sinew.Error):
                other.set_forces(bad)

    def test_bones_reactions_and_arrays_while_stepping(self):
        scene = sinew.read_scene(SOURCE / "configs/box_bend.yaml", {"body.radius": 0.04})
        simulation = sinew.Simulation(scene)
        at_rest = simulation.bone_frames
        self.assertEqual(at_rest.shape, (len(simulation.bones), 4, 4))
        simulation.run_until(0.5)
        for frame in simulation.bone_frames:
            numpy.testing.assert_allclose(frame[:3, :3] @ frame[:3, :3].T, numpy.eye(3), atol=1e-12)
            numpy.testing.assert_array_equal(frame[3], [0, 0, 0, 1])
        self.assertGreater(abs(simulation.bone_frames - at_rest).max(), 0.1)
        self.assertEqual(simulation.reactions.shape, (len(simulation.bones), 6))
        strain, stress = simulation.array("strain"), simulation.array("stress")
        self.assertEqual((strain.shape, stress.shape), ((len(simulation.positions), 6),) * 2)
        self.assertGreater(numpy.nanmax(abs(strain)), 1e-3)
        self.assertEqual(simulation.array("J").shape, (len(simulation.positions),))
        on_skin = simulation.surface_array("J")
        self.assertEqual(on_skin.shape, (len(simulation.surface),))
        self.assertLessEqual(on_skin.max(), numpy.nanmax(simulation.array("J")))
        layers = simulation.array("surface_layer")
        self.assertEqual(layers.dtype, numpy.int32)
        self.assertEqual(set(layers), {1, 2})  # of three half-planes across
        for wrong in ("strian", "strain, stress", ""):
            with self.assertRaises(sinew.Error):
                simulation.array(wrong)
        with self.assertRaises(sinew.Error) as raised:
            sinew.Simulation(self.scene, self.body).array("strain")
        self.assertIn("surface", str(raised.exception))

    def test_reactions_answer_the_springs_of_bones(self):
        scene = sinew.read_scene(SOURCE / "configs/box_bend.yaml", {"body.radius": 0.04, "binding.bone_damping": 0})
        simulation = sinew.Simulation(scene)
        simulation.run_until(0.3)
        pulls = sum(simulation.array(f"force_{name}") for name in ("radial", "twist", "axial"))
        self.assertGreater(abs(pulls).max(), 0.01)
        numpy.testing.assert_allclose(-pulls.sum(0), simulation.reactions[:, :3].sum(0), atol=1e-9)

    def test_reactions_answer_gravity(self):
        """At rest, what the bones carry is the weight."""
        scene = sinew.make_scene(BAR | {"solver": {"gravity": [0, 0, -2]}, "material": {"damping_ratio": 1}}, self.body)
        simulation = sinew.Simulation(scene, self.body)
        simulation.run_until(3)
        weight = 2 * self.body.mass * len(self.body)
        numpy.testing.assert_allclose(simulation.reactions[:, :3].sum(0), [0, 0, -weight], atol=0.01 * weight)

    def test_a_saved_moment_goes_on_with_the_same_bits(self):
        simulation = sinew.Simulation(self.scene, self.body, own_forces=True)
        simulation.set_forces(numpy.full((len(self.body), 3), (0, 0, -2)) * self.body.mass)
        simulation.step(40)
        state, positions = simulation.save(), []
        for _ in range(2):
            simulation.step(30)
            positions.append(simulation.positions.copy())
            simulation.restore(state)
            self.assertEqual(simulation.steps, 40)
        numpy.testing.assert_array_equal(*positions)

    def test_a_saved_moment_has_its_pose_and_forces(self):
        simulation = sinew.Simulation(self.scene, self.body, own_forces=True)
        pushes = numpy.zeros((len(self.body), 3))
        pushes[:, 1] = 1e-3

        def after(time):
            simulation.run_until(time)
            return simulation.positions.tobytes(), simulation.bone_frames.tobytes()

        name = simulation.bones[-1]
        simulation.run_until(0.05)
        plain = simulation.save()
        expected = after(0.1)
        simulation.restore(plain)
        simulation.set_pose({name: (0.966, 0, 0.259, 0)}, over=0.1)
        simulation.set_forces(pushes)
        simulation.run_until(0.08)
        turned = simulation.save()
        bent = after(0.15)
        self.assertNotEqual(bent, expected)
        for state, time, result in ((plain, 0.1, expected), (turned, 0.15, bent), (plain, 0.1, expected)):
            simulation.restore(state)
            self.assertEqual(after(time), result)
        other = sinew.Simulation(self.scene, self.body, own_forces=True)
        other.restore(turned)
        other.run_until(0.15)
        self.assertEqual(other.positions.tobytes(), bent[0])
        still = sinew.Simulation(self.scene, self.body)  # which takes no forces
        still.run_until(0.05)
        other.restore(still.save())  # nor were any set then
        other.run_until(0.1)
        self.assertEqual(other.positions.tobytes(), expected[0])
        bones = [{"name": "only", "head": [0, 0, 0], "tail": [0, 0, 0.5]}]
        fewer = sinew.Simulation(sinew.make_scene(BAR | {"skeleton": {"bones": bones}, "motion": {}}, self.body), self.body)
        farther = sinew.Body(self.body.points + [0, 0, 1e-6], 0.01)
        others = sinew.Simulation(self.scene, farther)  # as many particles, bones of the same names
        for wrong in (fewer, others):
            with self.assertRaisesRegex(sinew.Error, "does not fit this body.*restore one that the same scene has saved"):
                wrong.restore(turned)

    def test_positions_are_a_view(self):
        simulation = sinew.Simulation(self.scene, self.body)
        first = simulation.positions
        surface = sinew.Simulation(sinew.read_scene(SOURCE / "configs/box_bend.yaml", {"body.radius": 0.04}))
        views = [surface.surface, surface.forces, surface.velocities]
        surface.step(3)
        for view, again in zip(views, (surface.surface, surface.forces, surface.velocities)):
            self.assertEqual(view.ctypes.data, again.ctypes.data)
        simulation.step(3)
        self.assertEqual(first.ctypes.data, simulation.positions.ctypes.data)
        self.assertFalse(first.flags.writeable)
        self.assertEqual(self.body.points.ctypes.data, self.body.points.ctypes.data)
        del simulation
        gc.collect()
        self.assertTrue(numpy.isfinite(first).all())  # the view keeps its owner

    def test_other_threads_go_on(self):
        counted = 0
        simulation = sinew.Simulation(self.scene, self.body)
        worker = threading.Thread(target=simulation.step, args=(3000,))
        worker.start()
        busy = 0
        while worker.is_alive():
            counted += 1
            try:
                simulation.positions
            except sinew.Error:
                busy += simulation.steps > 0
            time.sleep(0)
        self.assertGreater(counted, 100)
        self.assertGreater(busy, 10)
        self.assertEqual(simulation.steps, 3000)

    def test_two_threads_that_step_take_turns(self):
        simulation = sinew.Simulation(self.scene, self.body)
        refused = []

        def steps():
            for _ in range(300):
                try:
                    simulation.step(1)
                except sinew.Error:
                    refused.append(1)
        threads = [threading.Thread(target=steps) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(simulation.steps, 4 * 300 - len(refused))

    def test_numbers_of_steps(self):
        simulation = sinew.Simulation(self.scene, self.body)
        simulation.step(0)
        with self.assertRaisesRegex(sinew.Error, "below 0"):
            simulation.step(-1)
        simulation.step(2)
        simulation.run_until(simulation.time)
        self.assertEqual(simulation.steps, 2)
        with self.assertRaisesRegex(sinew.Error, "0 s is past: the simulation is at .*; give a later time"):
            simulation.run_until(0)
        code = "import sinew, sys; exec(sys.argv[1]); simulation.step(2**63 - 1)"
        child = subprocess.Popen([sys.executable, "-c", code, self.code_of_simulation() + "simulation.step(3); print(1, flush=True)"],
                                 stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        child.stdout.readline()
        time.sleep(0.5)
        self.assertIsNone(child.poll(), "it steps on")
        child.kill()
        child.communicate()

    def code_of_simulation(self):
        return (f"body = sinew.Body([[0, 0, 0], [0.01, 0, 0], [0, 0.01, 0], [0, 0, 0.01]], 0.005)\n"
                f"scene = sinew.make_scene({BAR!r}, body)\nsimulation = sinew.Simulation(scene, body)\n")

    def test_leaving_while_a_thread_steps(self):
        code = ("import sinew, threading, time\n" + self.code_of_simulation() +
                "thread = threading.Thread(target=simulation.step, args=(10**12,), daemon=True)\n"
                "thread.start()\ntime.sleep(0.2)\nprint(simulation.steps > 0)\n")
        for _ in range(5):
            done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=30)
            self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "True\n", ""))

    def test_objects_that_nobody_has_made(self):
        """Called in another process: what is tested is that it does not crash."""
        code = "import sinew\n" + self.code_of_simulation() + """
for kind in (getattr(sinew._sinew, name) for name in
             ("_Simulation", "_Body", "_Scene", "_State", "_RestShape", "_Run", "_Frame", "_Dataset", "_Surface", "_Polygons",
              "_RunMeter", "_RunCells")):
    thing = kind.__new__(kind)
    for name in dir(kind):
        if name.startswith("__") and name not in ("__len__", "__str__", "__getitem__", "__repr__"):
            continue
        for words in ((), (1,), ({},)):
            try:
                value = getattr(thing, name)
                value(*words)
            except (TypeError, RuntimeError, IndexError, ValueError, sinew.Error):
                pass
native = sinew._sinew
unmade = lambda kind: kind.__new__(kind)
for use in (lambda: native._Simulation(unmade(native._Scene), None, False), lambda: native._fill_scene(unmade(native._Scene)),
            lambda: native._Simulation(scene._native, unmade(native._Body), False),
            lambda: simulation._native.restore(unmade(native._State))):
    try:
        use()
    except (TypeError, RuntimeError, sinew.Error):
        pass
print("alive")
"""
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=30)
        self.assertEqual((done.returncode, done.stdout), (0, "alive\n"), done.stderr)

    def test_nothing_is_pickled_or_copied(self):
        """In another process, which such an attempt must not end."""
        code = "import copy, copyreg, pickle, sinew\n" + self.code_of_simulation() + """
shape = sinew.RestShape(body.points, 0.005)
held = (simulation, body, scene, shape)
for thing in (*held, *(one._native for one in (*held, simulation.save(), simulation.dataset()))):
    for use in (*(lambda thing, protocol=protocol: pickle.dumps(thing, protocol) for protocol in range(pickle.HIGHEST_PROTOCOL + 1)),
                *(lambda thing, protocol=protocol: thing.__reduce_ex__(protocol) for protocol in range(5)),
                copy.copy, copy.deepcopy, *([] if thing in held else
                [lambda thing: copyreg._reduce_ex(thing, 0), lambda thing: type(thing).__base__()])):
        try:
            use(thing)
        except TypeError as error:
            assert "cannot pickle" in str(error), error
        else:
            assert False, thing
print("alive")
"""
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=30)
        self.assertEqual((done.returncode, done.stdout), (0, "alive\n"), done.stderr)

    def test_numbers_that_cannot_be_computed_with(self):
        for bad in (1e155, -1e155, 1e308, float("inf"), float("nan")):
            with self.assertRaisesRegex(sinew.Error, "too large or not finite"):
                sinew.Body([[0, 0, 0], [bad, 0, 0]], 0.01)
            with self.assertRaisesRegex(sinew.Error, "too large or not finite|not above 0"):
                sinew.Body([[0, 0, 0]], abs(bad))
            with self.assertRaises(sinew.Error):
                sinew.make_scene({**BAR, "skeleton": {"bones": [{"name": "low", "head": [bad, 0, 0], "tail": [0, 0, 1]}]}},
                                 self.body)

    def test_simulations_leak_nothing(self):
        def used():
            gc.collect()
            return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        for _ in range(30):
            sinew.Simulation(self.scene, self.body).step()
        before = used()
        for _ in range(200):
            sinew.Simulation(self.scene, self.body).step()
        self.assertLess(used() - before, 2000)  # kB; 200 bodies of 360 particles have 60,000

    def test_ctrl_c_stops_stepping(self):
        code = ("import sinew, sys; sys.path.insert(0, sys.argv[1]); import numpy\n"
                "body = sinew.Body(numpy.load(sys.argv[2]), 0.01)\n"
                "scene = sinew.make_scene(eval(sys.argv[3]), body)\n"
                "simulation = sinew.Simulation(scene, body)\n"
                "print('ready', flush=True)\n"
                "try:\n  simulation.step(10**9)\n"
                "except KeyboardInterrupt:\n  print('stopped', simulation.steps > 0)\n")
        points = os.path.join(os.environ.get("TMPDIR", "/tmp"), f"points{os.getpid()}.npy")
        numpy.save(points, self.body.points)
        child = subprocess.Popen([sys.executable, "-c", code, ".", points, repr(BAR)], stdout=subprocess.PIPE, text=True)
        self.addCleanup(child.kill)
        self.assertEqual(child.stdout.readline(), "ready\n")
        time.sleep(0.5)
        child.send_signal(signal.SIGINT)
        self.assertEqual(child.communicate(timeout=20)[0], "stopped True\n")
        os.remove(points)


if __name__ == "__main__":
    unittest.main(argv=["python_test", "-v", *sys.argv[3:]])
