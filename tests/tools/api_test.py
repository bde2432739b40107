#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python package as its users meet it: words for everything, errors of Python, and what the commands do.

usage: api_test.py BIN SOURCE      folder of the programs, folder of the project; PYTHONPATH names the package's
"""
import contextlib
import inspect
import io
import json
import os
import pickle
import pydoc
import re
import signal
import sys
import threading
import unittest
import warnings
from unittest import mock

import numpy
import schemas
import sinew

from small_run import SCENE, SOURCE, SmallRun
from small_run import sinew as command

BOX = SOURCE / "data/meshes/box.obj"
MACHINE = {"body": {"mesh": BOX, "radius": 0.04}, "material": {"model": "bonded"}, "solver": {"duration": 0.1},
           "supports": [{"name": "clamp", "facing": [0, 0, -1]}], "loads": [{"name": "hand", "facing": [0, 0, 1], "force": [1, 0, 0]}],
           "probes": [{"name": "middle", "low": [-1, -1, 0.2], "high": [1, 1, 0.5]}]}


MADE_BY_THE_PACKAGE = {"Frame", "Frames", "Dataset", "Diagnosis", "NewScene", "Findings", "Mesh"}


def public():
    """Names and objects of all that is public: functions, classes, and their methods and properties."""
    for name in sinew.__all__:
        thing = getattr(sinew, name)
        yield name, thing
        for member, value in vars(thing).items() if inspect.isclass(thing) else ():
            if (isinstance(value, property) or callable(value)) and (not member.startswith("_") or member == "__init__"):
                yield f"{name}.{member}", value


def function_of(thing):
    return thing.fget if isinstance(thing, property) else thing


class Words(unittest.TestCase):
    """What help() says."""

    def test_everything_has_its_words(self):
        for name, thing in public():
            if name.endswith("__init__"):
                continue
            words = inspect.getdoc(thing) or ""
            self.assertGreater(len(words.split()), 3, name)
            self.assertFalse(re.match(r"\w+\(.*\) *(->|$)", words), f"{name}: a signature alone")
            self.assertTrue(words.rstrip().endswith((".", "...")) or "\n" in words, name)

    def test_arrays_have_shapes_and_wrong_arguments_errors(self):
        for name, thing in public():
            if inspect.isclass(thing):
                continue
            signature, words = inspect.signature(function_of(thing)), inspect.getdoc(thing) or ""
            returned = str(signature.return_annotation)
            if "NDArray" in returned and "dict" not in returned and not re.search(r"array|surface_array", name):
                self.assertRegex(words, r"\((\w+|\d), ?[\w, ]*\)", f"{name}: no shape")
            if isinstance(thing, property) or name.endswith("__init__"):
                continue
            if set(signature.parameters) - {"self"}:
                self.assertRegex(words, r"Raises|The same|as gradients", f"{name}: no errors")

    def test_types_stand_where_the_words_do(self):
        self.assertFalse(list((SOURCE / "lib/python/sinew").glob("*.pyi")))
        for name, thing in public():
            if inspect.isclass(thing) or name.removesuffix(".__init__") in MADE_BY_THE_PACKAGE:
                continue
            signature = inspect.signature(function_of(thing))
            self.assertIsNot(signature.return_annotation, inspect.Signature.empty, name)
            for parameter in [*signature.parameters.values()][0 if "." not in name else 1:]:
                self.assertIsNot(parameter.annotation, inspect.Parameter.empty, f"{name}: {parameter.name}")

    def test_the_whole_page_reads(self):
        page = pydoc.plain(pydoc.render_doc(sinew))
        for name in sinew.__all__:
            self.assertIn(name, page)
        for word in ("pybind11", "_sinew.", "arg0", "handle"):
            self.assertNotIn(word, page)


WRONG = [None, [1], {"a": 1}, "x", "a\0b", "\ud800", b"\xff", 1.5, -1, 2 ** 70, True, float("nan"), object(), numpy.array(["x"]),
         numpy.zeros((2, 2)), slice(1), lambda *_: 1, sinew.Error, ({},), 10 ** 400, numpy.float32(2)]


class Arguments(SmallRun):
    """Errors say what is wrong in words of Python."""

    def setUp(self):
        super().setUp()
        self.small = sinew.read_scene(self.scene, {"body.radius": 0.04, "solver.duration": 0.04})
        before = os.getcwd()
        os.chdir(self.folder)
        self.addCleanup(os.chdir, before)

    def calls(self):
        """By the name of each public function and method: what to call, and arguments that are right."""
        small, run = self.small, sinew.simulate(self.small, self.out)
        body, state = sinew.Body([[0, 0, 0], [0.1, 0, 0]], 0.05), sinew.Simulation(self.small).save()
        simulation, points = sinew.Simulation(small), numpy.eye(3)
        state.write("state")
        V = numpy.array([[0., 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
        F = numpy.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        mesh, settings = {"mesh": V, "faces": F}, {"body.radius": 0.05}
        shape = sinew.RestShape(V, 2.0)
        stepped = {"progress": False, "threads": 1}
        return {
            "Body": (sinew.Body, {"points": V, "radius": 0.1, "mass": 1.0, "density": 1.0}),
            "RestShape": (sinew.RestShape, {"points": V, "cutoff": 2.0}), "RestShape.gradients": (shape.gradients, {"now": V}),
            "RestShape.arrays": (shape.arrays, {"now": V}), "Run": (sinew.Run, {"folder": self.out}),
            "Run.frames": (run.frames, {"series": "surface"}), "Run.report": (run.report, stepped),
            "Frame.array": (run[0].array, {"name": "J"}), "Frame.dataset": (run[0].dataset, {"series": "bones"}),
            "Simulation": (sinew.Simulation, {"scene": small, "body": body, "own_forces": False, "threads": 1}),
            "Simulation.step": (simulation.step, {"count": 1}), "Simulation.run_until": (simulation.run_until, {"time": 0.01}),
            "Simulation.set_forces": (simulation.set_forces, {"forces": points}),
            "Simulation.set_pose": (simulation.set_pose, {"rotations": {"upper": (1, 0, 0, 0)}, "over": 0.1}),
            "Simulation.array": (simulation.array, {"name": "J"}), "Simulation.surface_array": (simulation.surface_array, {"name": "J"}),
            "Simulation.dataset": (simulation.dataset, {"series": "bones"}), "Simulation.restore": (simulation.restore, {"state": state}),
            "Simulation.write": (simulation.write, {"folder": "mine", "force": True}), "State.write": (state.write, {"path": "s"}),
            "read_scene": (sinew.read_scene, {"path": self.scene, "settings": settings}), "read_state": (sinew.read_state, {"path": "state"}),
            "make_scene": (sinew.make_scene, {"sections": {"skeleton": {"bones": []}}, "body": body, "folder": ".", "mesh": (V, F)}),
            "check": (sinew.check, {"scene": small, "folder": ".", "threads": 1}),
            "simulate": (sinew.simulate, {"scene": small, "folder": "r", "force": True, "resume": False, **stepped}),
            "measure": (sinew.measure, {"folder": self.out, **stepped}), "open_run": (sinew.open_run, {"folder": self.out}),
            "fill": (sinew.fill, {**mesh, "radius": 0.1, "count": None, "density": 1.0, "threads": 1}),
            "tetrahedra": (sinew.tetrahedra, {**mesh, "radius": 0.1, "count": None, "threads": 1}),
            "diagnose": (sinew.diagnose, mesh), "repair": (sinew.repair, mesh), "winding_number": (sinew.winding_number, {**mesh, "points": V}),
            "distance": (sinew.distance, {**mesh, "points": V, "signed": True}),
            "new": (sinew.new, {**mesh, "rig": None, "scene": "new.yaml", "force": True, "quick": True}),
            "info": (sinew.info, {"path": BOX, "settings": {"body.unit": "mm"}, "radius": None, "verify": False, "drawing": "d.vtu"}),
            "render": (sinew.render, {"run": run, "view": "surface", "folder": "p", **stepped}),
            "converge": (sinew.converge, {"scene": small, "radii": [0.1, 0.2], "folder": "c", "force": False, "resume": False,
                                          "settings": {}, **stepped}),
            "sweep": (sinew.sweep, {"scene": small, "vary": {"body.radius": [0.05]}, "folder": "s", "design": "grid", "results": "J_min",
                                    "settings": {}, "keep": "last", **stepped}),
            "export": (sinew.export, {"source": run, "to": "xyz", "file": "x", "times": [0], **stepped}),
            "compare": (sinew.compare, {"runs": [run, run], "folder": "o", **stepped})}

    def test_every_wrong_argument_is_an_error(self):
        calls = self.calls()
        listed = {name.removesuffix(".__init__") for name, thing in public() if not inspect.isclass(thing) and not
                  isinstance(thing, property) and set(inspect.signature(thing).parameters) - {"self"}}
        self.assertEqual(listed - MADE_BY_THE_PACKAGE, set(calls))
        with mock.patch("sinew._programs.subprocess.Popen", side_effect=sinew.Error("no program; none is called here")), \
                warnings.catch_warnings(), contextlib.redirect_stderr(io.StringIO()):
            warnings.simplefilter("ignore")
            for name, (function, right) in calls.items():
                self.assertEqual(set(right) | {"options"}, set(inspect.signature(function).parameters) | {"options"}, name)
                for argument in right:
                    with self.subTest(name, argument=argument):
                        for wrong in WRONG if name != "Simulation.run_until" else WRONG[:9]:  # others are far times
                            self.refuses(name, function, {**right, argument: wrong})

    def refuses(self, name, function, words):
        """Or takes."""
        try:
            function(**words)
        except sinew.Error as error:
            self.assertIn("; ", str(error), name)
            self.assertNotRegex(str(error), r"(^| )--[a-z]|incompatible|\n", name)
        except Exception as error:
            self.fail(f"{name}({words!r}): {type(error).__name__}: {error}")

    def test_errors_speak_python(self):
        simulation, run = sinew.Simulation(self.small), sinew.simulate(self.small, self.out)
        bones = [{"name": "a", "head": [0, 0, 0], "tail": [0, 0, 1]}]
        body = {"mesh": str(BOX), "radius": 0.1}
        for cause, words in (
                (lambda: simulation.step(1.5), "count is 1.5; give a whole number"),
                (lambda: simulation.set_pose({"upper": (1, 0, 0)}), r"rotations\['upper'\] has the shape \(3,\); give a quaternion \(w, x, y, z\)"),
                (lambda: simulation.set_pose({"upper": "x"}), r"rotations\['upper'\] is 'x'; give a quaternion"),
                (lambda: sinew.make_scene([1]), r"sections is \[1\]; give a dict"),
                (lambda: sinew.make_scene({"body": 3}), "body is 3; give a dict"),
                (lambda: sinew.check(sinew.make_scene({**MACHINE, "solver": {"method": "static"}, "supports": []})), "^no equilibrium: "),
                (lambda: sinew.make_scene({"body": body}), r'^skeleton.bones is missing; add "bones": \[\.\.\.\], a list$'),
                (lambda: sinew.make_scene({"body": body, "skeleton": {"bones": 3}}), "^skeleton.bones must be a list; give a list of its entries$"),
                (lambda: sinew.make_scene({"body": body, "skeleton": {"bones": bones}, "solver": [1]}), "solver must be a dict; give a dict with keys"),
                (lambda: sinew.make_scene({"body": body, "skeleton": {"bones": bones, "name": object()}}), "no number, text, list or dict"),
                (lambda: sinew.simulate(self.small, self.out), "replace it with force=True, or choose another folder$"),
                (lambda: sinew.converge(self.small, [1], self.folder / "c"), "give two radii"),
                (lambda: sinew.render(run, veiw="surface"), "unknown option 'veiw'; did you mean view"),
                (lambda: sinew.export(run, version=True), "sinew-export gave no results; leave out to, times, version"),
                (lambda: sinew.export(run, "xyz", self.folder / "x", times=[9]), "no frame at 9 s; give times"),
                (lambda: sinew.compare([run], self.folder / "o"), "runs are 1; give two or more"),
                (lambda: sinew.check(self.small, threads=-1), "threads is -1; give a number from 0"),
                (lambda: sinew.State(), "read_state"), (lambda: sinew.Scene(), "read_scene"),
                (lambda: run["x"], "index is 'x'; give a whole number or a slice")):
            with self.assertRaisesRegex(sinew.Error, words) as raised:
                cause()
            self.assertEqual(raised.exception.exit_code, 2)
        with self.assertRaisesRegex(TypeError, "unexpected keyword argument 'radus'"):
            sinew.RestShape(numpy.eye(3), radus=1)
        for text, words in (("run the scene again with --set output.bonds=true --force", 'settings={"output.bonds": True} force=True'),
                            ("choose another view: --view forces", "view='forces'"), ("as --times 0,0.5", "times=[0, 0.5]"),
                            ("give a larger --size than 3 m", "a larger size than 3 m")):
            self.assertIn(words, sinew._error.in_python(text))

    def test_missing_packages_are_named(self):
        with mock.patch.dict(sys.modules, {"vtkmodules": None}), self.assertRaisesRegex(sinew.Error, r"vtkmodules is not installed, which"):
            sinew.Body(numpy.eye(3), 0.1).to_vtk()

    def test_values_that_are_not_there_are_told(self):
        run = sinew.simulate(self.small, self.out)
        frame = run[-1]
        self.assertEqual(frame.displacement.shape, frame["displacement"].shape)
        numpy.testing.assert_allclose(frame.displacement, frame["displacement"], atol=1e-7)
        numpy.testing.assert_array_equal(frame.distance, numpy.linalg.norm(frame.displacement, axis=1))
        numpy.testing.assert_array_equal(frame.von_mises, frame["von_mises"])
        self.assertEqual(frame.von_mises.shape, (len(run.rest),))
        words = {"body": {"mesh": str(SOURCE / "data/meshes/arm.ply"), "radius": 0.009}, "solver": {"duration": 0.04},
                 "skeleton": {"bones": [{"name": "arm", "head": [0, 0, 0], "tail": [0.6, 0, 0]}]}}
        arm = sinew.make_scene(words)  # some of whose particles have too few neighbors
        for source in (sinew.Simulation(arm), sinew.simulate(arm, self.folder / "arm")[0]):
            with self.assertWarnsRegex(RuntimeWarning, r"strain_eq is not-a-number for \d+ of \d+ particles: .*; leave them out"):
                self.assertTrue(numpy.isnan(source.array("strain_eq")).any())
            with warnings.catch_warnings():
                warnings.simplefilter("error")  # once is enough
                source.array("strain_eq")


class Commands(SmallRun):
    """What the commands do, Python does."""

    def setUp(self):
        super().setUp()
        self.small = sinew.read_scene(self.scene, {"body.radius": 0.04})

    def test_tables_of_supports_and_probes(self):
        run = sinew.simulate(sinew.make_scene(MACHINE), self.out)
        for name in ("supports", "probes"):
            told = numpy.genfromtxt(self.out / f"{name}.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
            read = getattr(run, name)
            self.assertEqual(tuple(read), told.dtype.names)
            for column in told.dtype.names:
                numpy.testing.assert_array_equal(read[column], told[column])
        plain = sinew.simulate(self.small, self.folder / "plain")
        for name in ("supports", "probes"):
            with self.assertRaisesRegex(sinew.Error, f"this run has no {name}; run a scene with"):
                getattr(plain, name)

    def test_pictures_files_and_studies_are_those_of_the_commands(self):
        run = sinew.simulate(self.small, self.out)
        told = []
        drawn = sinew.render(run, view=["surface"], folder=self.folder / "p", no_movie=True, times=[0, 0.2], width=200, height=100, threads=1,
                             progress=lambda done, of: told.append((done, of)))
        self.assertEqual(drawn["pictures"], len(list((self.folder / "p").glob("*.png"))))
        self.assertEqual(sinew.export(run, "xyz", self.folder / "a.xyz", times=[0.2])["frames"], 1)
        command("export", self.out, "--to", "xyz", "--times", "0.2", "-o", self.folder / "b.xyz", check=0)
        self.assertEqual((self.folder / "a.xyz").read_bytes(), (self.folder / "b.xyz").read_bytes())
        other = sinew.simulate(sinew.read_scene(self.scene, {"body.radius": 0.05}), self.folder / "other")
        found = sinew.compare([run, other.folder], self.folder / "c")
        asked = command("measure", self.out, other.folder, "-o", self.folder / "d", "--json", check=0).stdout
        self.assertEqual(found, json.loads(asked.replace(str(self.folder / "d"), str(self.folder / "c"))))
        told = []
        again = sinew.converge(self.small, [0.05, 0.06], self.folder / "e", settings={"solver.duration": 0.1},
                               progress=lambda *done: told.append(done))
        self.assertEqual(told[:2], [(1, 2), (2, 2)])
        asked = command("converge", self.scene, "--radii", "0.05,0.06", "--set", "solver.duration=0.1", "-o", self.folder / "f", "--json",
                        check=0).stdout
        self.assertEqual(again, json.loads(asked.replace(str(self.folder / "f"), str(self.folder / "e"))))
        self.assertTrue(again.warnings == [] or all(again.warnings))

    def test_a_quick_new_scene_is_that_of_the_command(self):
        command("new", BOX, "--quick", "-o", self.folder / "told.yaml", check=0)
        mine = sinew.new(BOX, scene=self.folder / "mine.yaml", quick=True)
        unlike_time = lambda path: re.sub(r"(?m)#.* takes .*$", "", (self.folder / path).read_text())
        self.assertEqual(unlike_time("mine.yaml"), unlike_time("told.yaml"))
        mesh = sinew.fill(BOX, count=100)
        of_arrays = sinew.new(mesh.vertices, mesh.faces, scene=self.folder / "arrays.yaml", quick=True)
        self.assertLessEqual(max(of_arrays.scene.duration, mine.scene.duration), 2)
        self.assertIn("time", mine.reasons)

    def test_presets_are_those_of_the_command(self):
        told = json.loads(command("presets", "--json", check=0).stdout)["presets"]
        found = sinew.presets()
        for name in told[0]:
            numpy.testing.assert_array_equal(found[name], [numpy.nan if row[name] is None else row[name] for row in told])
        for name in ("natural_rubber", "gelatin", "silicone_40a", "bone", "cartilage"):
            self.assertIn(name, [*found["name"]])
        pandas = mock.Mock(DataFrame=type("DataFrame", (dict,), {"attrs": {}}))
        with mock.patch.dict(sys.modules, {"pandas": pandas}):
            self.assertIsInstance(sinew.presets(), pandas.DataFrame)
        self.assertEqual(pandas.DataFrame.attrs["units"]["density"], "kg/m^3")
        lines = command("presets", check=0).stdout
        for row in told:
            self.assertRegex(lines, rf"(?m)^{row['name']}: .*\n  .*; {re.escape(row['source'])}$")

    def test_sweep_gives_a_table_of_runs_and_functions(self):
        def height(simulation):
            return simulation.positions[:, 2].max()
        vary, told = {"body.radius": [0.05, 0.06], "material.model": ["paper", "bonded"]}, []
        words = {"settings": {"solver.duration": 0.1, "output.double_precision": True}, "results": [{"name": "kinetic_energy", "of": "final"}, height], "keep": "all"}
        found = sinew.sweep(self.small, vary, self.out, **words, progress=lambda *done: told.append(done))
        numpy.testing.assert_array_equal(found["body.radius"], [0.05, 0.05, 0.06, 0.06])
        self.assertEqual([*found["material.model"]], ["paper", "bonded"] * 2)
        self.assertEqual({*found["status"]}, {"finished"})
        for row, folder in enumerate(found["folder"]):
            run = sinew.open_run(self.out / folder)
            self.assertEqual(found["kinetic_energy, final"][row], run.metrics["kinetic_energy"][-1])
            self.assertEqual(found["height"][row], run[-1].positions[:, 2].max())
        self.assertEqual(told[-1], (4, 4))
        before = (self.out / "results.csv").read_bytes()
        again = sinew.sweep(self.small, {**vary, "body.radius": [0.05]}, self.out, **words, progress=False)
        numpy.testing.assert_array_equal(again["seconds"], found["seconds"][:2])  # no run was done again
        self.assertTrue(before.startswith((self.out / "results.csv").read_bytes()))

    def test_functions_alone_take_samples_and_failed_runs(self):
        def end(simulation):
            return simulation.time
        table = sinew.sweep(self.scene, {"material.young_modulus": {"from": 5e3, "to": 2e4, "scale": "log"}}, results=end,
                            design={"kind": "latin_hypercube", "samples": 4, "seed": 2},
                            settings={"body.radius": 0.06, "solver.duration": 0.05})
        parts = numpy.sort(numpy.floor(4 * numpy.log(table["material.young_modulus"] / 5e3) / numpy.log(4)))
        numpy.testing.assert_array_equal(parts, range(4))
        self.assertTrue((abs(table["end"] - 0.05) < 0.01).all())
        unstable = sinew.sweep(self.scene, {"solver.time_step": [0.001, 0.1]}, results=end, settings={"solver.duration": 2})
        self.assertEqual([*unstable["status"]], ["finished", "failed"])
        self.assertRegex(unstable["reason"][1], "time_step")
        self.assertTrue(numpy.isnan(unstable["end"][1]))

    def test_sweeps_are_refused_in_words_of_python(self):
        few = {"body.radius": [0.05, 0.06]}
        for vary, words, cause in (
                (few, {}, "need a folder for their runs; give one"), ({}, {"results": len}, "vary is empty; give values"),
                (few, {"results": [1]}, r"results\[0\] is 1; give a name, a dict"),
                (few, {"results": [len, len]}, "one name.*; give each"), (few, {"results": len, "jobs": 2}, "jobs is an option.*; leave it out"),
                (few, {"results": "J_mim", "folder": self.out}, "^there is no metric 'J_mim'; did you mean J_min"),
                (few, {"results": "J_min", "design": "sobol", "folder": self.out}, r'write design: \{"kind": "latin_hypercube", "samples": 100\}'),
                ({"body.radus": [1]}, {"results": len}, "did you mean radius"),
                (few, {"results": lambda simulation: "x", "settings": {"solver.duration": 0.05}}, r"<lambda>\(simulation\) is 'x'; return a number")):
            with self.assertRaisesRegex(sinew.Error, cause) as raised:
                sinew.sweep(self.scene, vary, **words)
            self.assertNotRegex(str(raised.exception), r"(^| )--[a-z]|study\.yaml")
        with self.assertRaisesRegex(sinew.Error, "2 of 2 runs failed, as runs/.*; see .*index.csv, and do them again with retry_failed") as raised:
            sinew.sweep(self.scene, {"solver.time_step": [0.1, 0.2]}, self.out, settings={"solver.duration": 2})
        self.assertEqual(raised.exception.exit_code, 3)

    def test_missing_programs_are_named(self):
        with mock.patch("sinew._programs.__file__", str(self.folder / "sinew/_programs.py")), \
                mock.patch.dict(os.environ, {"PATH": str(self.folder)}), \
                self.assertRaisesRegex(sinew.Error, "sinew-render is neither beside this package nor on the PATH; install"):
            sinew.render(self.folder)

    def test_progress_and_threads(self):
        told = []
        one = sinew.simulate(self.small, self.out, progress=lambda *done: told.append(done), threads=1)
        self.assertEqual(told, [(frame, 12) for frame in range(13)])
        with self.assertRaises(ZeroDivisionError):
            sinew.simulate(self.small, self.folder / "two", progress=lambda done, of: 1 // (6 - done))
        two = sinew.simulate(self.small, self.folder / "two", resume=True, threads=2)
        numpy.testing.assert_array_equal(one[-1].positions, two[-1].positions)
        told.clear()
        numpy.testing.assert_array_equal(sinew.measure(one, progress=lambda *done: told.append(done))["J_min"], two.metrics["J_min"])
        self.assertEqual(told[-1], (13, 13))
        with self.assertRaises(ZeroDivisionError):
            one.report(progress=lambda done, of: 1 // 0)
        screen = io.StringIO()
        with contextlib.redirect_stderr(screen):
            one.report(progress=False)
            self.assertEqual(screen.getvalue(), "")
            one.report(progress=True)
        self.assertRegex(screen.getvalue(), r"\rmeasuring \[#+\] 100 %")
        screen.isatty = lambda: True
        with contextlib.redirect_stderr(screen):
            self.assertIn("simulating", (sinew.simulate(self.small, self.out, force=True), screen.getvalue())[1])

    def interrupted(self, work, has_begun):
        """Presses Ctrl-C once it is at work."""
        over = threading.Event()

        def press():
            while not over.wait(0.02):
                if has_begun():
                    return os.kill(os.getpid(), signal.SIGINT)
        thread = threading.Thread(target=press)
        thread.start()
        try:
            with self.assertRaises(KeyboardInterrupt):
                work()
        finally:
            over.set()
            thread.join()

    def test_ctrl_c_ends_work_and_nothing_is_lost(self):
        long = sinew.read_scene(self.scene, {"body.radius": 0.04, "solver.duration": 600})
        written = lambda folder, frame: (folder / f"particles/particles_{frame:06}.vtu").exists()
        self.interrupted(lambda: sinew.simulate(long, self.out), lambda: written(self.out, 500))
        self.assertEqual(self.record()["status"], "stopped")
        frames, told = len(sinew.open_run(self.out)), []
        self.assertGreater(frames, 500)
        self.interrupted(lambda: sinew.simulate(long, self.out, resume=True), lambda: written(self.out, frames + 5))
        self.assertGreater(len(sinew.open_run(self.out)), frames + 5)
        self.interrupted(lambda: sinew.measure(self.out, progress=lambda *done: told.append(done)), lambda: told)
        self.assertLess(*told[-1])
        first = self.folder / "study/radius_0.04"
        self.interrupted(lambda: sinew.converge(long, [0.04, 0.05], self.folder / "study"), lambda: written(first, 5))
        self.assertEqual(self.record(first)["status"], "stopped")
        self.assertGreater(len(sinew.open_run(first)), 5)

    def test_states_are_pickled_and_written(self):
        simulation = sinew.Simulation(self.small, own_forces=True)
        simulation.set_forces(numpy.full((len(simulation.positions), 3), 1e-3))
        simulation.step(20)
        simulation.set_pose({"upper": (0.966, 0, 0, 0.259)}, over=0.2)
        simulation.step(3)
        state = simulation.save()
        state.write(self.folder / "state")
        simulation.step(20)
        simulation.set_pose({"lower": (0.966, 0, 0.259, 0)}, over=0.1)  # upper goes on to where it was to go
        simulation.step(20)
        for again in (pickle.loads(pickle.dumps(state)), sinew.read_state(self.folder / "state")):
            self.assertEqual(again.steps, 23)
            other = sinew.Simulation(self.small, own_forces=True)
            other.restore(again)
            other.step(20)
            other.set_pose({"lower": (0.966, 0, 0.259, 0)}, over=0.1)
            other.step(20)
            numpy.testing.assert_array_equal(simulation.positions, other.positions)
        with self.assertRaisesRegex(sinew.Error, "does not fit this body"):
            sinew.Simulation(sinew.read_scene(self.scene, {"body.radius": 0.05})).restore(again)
        whole = (self.folder / "state").read_bytes()
        for damaged in (whole[:-1], whole[:20], b"", whole[:-9] + b"x" + whole[-8:], b"x" + whole):
            (self.folder / "state").write_bytes(damaged)
            with self.assertRaisesRegex(sinew.Error, "the saved state is .*; save it anew"):
                sinew.read_state(self.folder / "state")

    def test_a_script_writes_the_run_of_what_it_steps(self):
        run = sinew.simulate(self.small, self.out)
        simulation = sinew.Simulation(self.small)
        for number, time in enumerate(run.times):
            simulation.run_until(time)
            self.assertEqual(simulation.write(self.folder / "mine"), number + 1)
        with self.assertRaisesRegex(sinew.Error, "not later than the last.*; step the simulation"):
            simulation.write(self.folder / "mine")
        with self.assertRaisesRegex(sinew.Error, "finish"):
            simulation.write(self.folder / "else")
        mine = simulation.finish()
        self.assertEqual(self.record(mine.folder)["status"], "finished")
        self.assertEqual(self.record(mine.folder)["frames"], 13)
        self.assertGreater(schemas.check_written(self.folder), 1)
        for frame in (0, 6, 12):
            for series in ("particles", "surface", "bones", "frames"):
                one, other = run[frame].dataset(series), mine[frame].dataset(series)
                for name in ("points", *one.point_arrays):
                    numpy.testing.assert_array_equal(getattr(one, "points"), getattr(other, "points"))
        numpy.testing.assert_allclose(run.metrics["volume"], mine.metrics["volume"], rtol=1e-12)
        self.assertNotIn("warning", command("info", mine.folder, "--verify", check=0).stdout)
        for wrong in (lambda: simulation.finish(), lambda: simulation.write(mine.folder)):
            with self.assertRaisesRegex(sinew.Error, "; "):
                wrong()
        simulation.step()
        simulation.write(mine.folder, force=True)
        del simulation
        self.assertEqual(self.record(mine.folder)["status"], "stopped")
        self.assertEqual(len(sinew.open_run(mine.folder)), 1)
        body = sinew.Body([[0, 0, 0], [0.1, 0, 0]], 0.05)
        bare = sinew.make_scene({"skeleton": {"bones": [{"name": "a", "head": [0, 0, 0], "tail": [0, 0, 1]}]}}, body)
        with self.assertRaisesRegex(sinew.Error, "no surface"):
            sinew.Simulation(bare, body).write(self.folder / "bare")


if __name__ == "__main__":
    unittest.main(argv=["api_test", "-v", *sys.argv[3:]])
