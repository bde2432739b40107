#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""view_test.py BIN SOURCE MODULES: sinew view starts ParaView on a state of its own making, without ParaView's Python.

MODULES is the folder filled by get_paraview_python.sh. A program that only tells its arguments stands in for ParaView;
paraview_test.py and window_test.py load states into ParaView itself.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

BIN, SOURCE, MODULES = (Path(place).resolve() for place in sys.argv[1:4])
PYTHON = str(MODULES / "usr/lib/python3/dist-packages")
SMALL = ["--set", "body.radius=0.025", "--set", "solver.duration=0.2", "--set", "output.interval=0.05"]


class View(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        # ParaView begins Open MPI, which removes the folder of its sessions when it ends, also from under
        # another that begins.
        os.environ["OMPI_MCA_orte_tmpdir_base"] = cls.scratch.name
        os.environ["PMIX_MCA_gds"] = "hash"  # the store in shared memory fails where others start at the same time
        cls.one_run = Path(cls.scratch.name) / "a run"
        done = subprocess.run([BIN / "sinew", "simulate", "--quiet", SOURCE / "configs/box_bend.yaml", "-o", cls.one_run,
                               *SMALL], capture_output=True, text=True, timeout=100)
        assert done.returncode == 0, done.stderr

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def setUp(self):
        folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.run_folder = self.folder / "Läufe, viele" / "a run"
        shutil.copytree(self.one_run, self.run_folder)
        self.state = self.run_folder / "view.pvsm"
        self.programs = self.folder / "programs"
        self.programs.mkdir()
        for name in ("paraview", "pvbatch"):
            (self.programs / name).write_text('#!/bin/sh\nprintf "%s\\n" "$@"\n')
            (self.programs / name).chmod(0o755)
        # Without the build's own copy of ParaView's Python beside it.
        self.view = self.folder / "bin" / "sinew-view"
        self.view.parent.mkdir()
        shutil.copy(BIN / "sinew-view", self.view)

    def start(self, *words, **changed):
        environment = {**os.environ, "PATH": f"{self.programs}:/usr/bin:/bin", "DISPLAY": ":77", "HOME": str(self.folder),
                       "TMPDIR": str(self.folder), **changed}
        environment = {name: value for name, value in environment.items() if value is not None}
        return subprocess.run([self.view, *map(str, words)], capture_output=True, text=True, timeout=100,
                              env=environment)

    def opened(self, *words, **changed):
        """The state that ParaView was started on."""
        done = self.start(self.run_folder, *words, **changed)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"\A--state=/.*/view\.pvsm\n\Z")
        return Path(done.stdout[len("--state="):-1])

    def assert_one_line(self, done, code, *parts):
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        for part in parts:
            self.assertIn(part, done.stderr)

    def test_a_run_leaves_a_state_that_colors_strain(self):
        text = (self.one_run / "view.pvsm").read_text()
        self.assertIn(f'value="{self.one_run}/particles.pvd"', text)
        self.assertIn('value="equivalent strain (1)"', text)
        self.assertNotIn("cript", text.replace("CustomScript", ""))  # nothing that needs Python

    def test_the_state_of_a_folder_that_was_moved_names_it_anew(self):
        self.assertNotIn("viele", self.state.read_text())
        self.assertEqual(self.opened(), self.state)
        names = re.findall(r'value="(.*\.pvd)"', self.state.read_text())
        self.assertEqual([Path(name).parent for name in names], [self.run_folder] * 4)

    def test_options_go_into_the_state(self):
        text = self.opened("--array", "velocity", "--cut", "x", "--forces", "force_bone", "--time", "0.06").read_text()
        for part in ("velocity (m/s)", "coordsX-displacement_X", "force_bone: the longest arrow"):
            self.assertIn(part, text)
        self.assertRegex(text, r'"AnimationTime"[^/]*\n[^/]*value="0.05"')

    def test_cameras_are_linked_where_the_version_is_known(self):
        self.assertNotIn("CameraLink", self.opened().read_text())
        for version, linked, excepted in (("5.11.0", True, False), ("5.13.2", True, True), ("5.12.1", False, False)):
            (self.programs / "paraview").write_text(
                f'#!/bin/sh\n[ "$1" = --version ] && echo "paraview version {version}" || printf "%s\\n" "$@"\n')
            text = self.opened().read_text()
            self.assertEqual(("CameraLink" in text, "exceptionBehavior" in text), (linked, excepted), version)

    def test_a_state_that_paraview_saved_is_kept(self):
        saved = "<GenericParaViewApplication/>\n"
        self.state.write_text(saved)
        other = self.opened()
        self.assertEqual(self.state.read_text(), saved)
        self.assertNotEqual(other, self.state)
        self.assertIn(f'value="{self.run_folder}/particles.pvd"', other.read_text())

    def test_a_link_in_place_of_the_state_is_not_written_through(self):
        mine = self.folder / "mine"
        mine.write_text("mine")
        self.state.unlink()
        self.state.symlink_to(mine)
        self.assertNotEqual(self.opened(), self.state)
        self.assertEqual(mine.read_text(), "mine")

    @unittest.skipIf(os.geteuid() == 0 and not shutil.which("setpriv"), "root may write everywhere")
    def test_a_folder_that_cannot_be_written_to_has_its_state_elsewhere(self):
        before = self.state.read_bytes()
        for place in [self.folder, *self.folder.rglob("*")]:
            place.chmod(0o755 if place.is_dir() or place.parent in (self.programs, self.view.parent) else 0o644)
        out = self.folder / "out"
        out.mkdir()
        out.chmod(0o777)
        self.run_folder.chmod(0o555)
        command = [self.view, self.run_folder]
        if os.geteuid() == 0:
            command = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", *command]
        done = subprocess.run(command, capture_output=True, text=True, timeout=100,
                              env={"PATH": f"{self.programs}:/usr/bin:/bin", "DISPLAY": ":77", "TMPDIR": str(out)})
        self.run_folder.chmod(0o755)
        self.assert_one_line(done, 0, "Permission denied", "; showing ")
        self.assertRegex(done.stdout, rf"\A--state={out}/.*/view\.pvsm\n\Z")
        self.assertEqual(self.state.read_bytes(), before)

    def test_mistakes_are_told_with_their_cure(self):
        self.assert_one_line(self.start(self.folder), 2, "is not the folder of a run")
        self.assert_one_line(self.start(self.run_folder, "--cut", "w"), 2, "x, y, z, none")
        self.assert_one_line(self.start(self.run_folder, "--array", "velocty"), 2, "did you mean velocity?")
        self.assert_one_line(self.start(self.run_folder, DISPLAY=None, WAYLAND_DISPLAY=None), 4, "--picture FILE.png")
        self.assert_one_line(self.start(self.run_folder, PATH=str(self.folder)), 4, "apt-get install paraview")

    def test_pictures_that_cannot_be_are_refused_before_paraview_starts(self):
        (self.folder / "folder.png").mkdir()
        for name, code, cure in (("nowhere/a.png", 4, "; "), ("folder.png", 4, "another name"), ("a.PNG", 2, "ends with .png"),
                                 ("a.vtu", 2, "ends with .png"), ("a", 2, "ends with .png")):
            for more in ([], ["--live"]):
                done = self.start(self.run_folder, "--picture", self.folder / name, *more)
                self.assert_one_line(done, code, name.split("/")[0], cure)
        self.assertEqual([path.name for path in self.folder.glob("*.*")], ["folder.png"])
        picture = ("--picture", self.folder / "a.png")
        self.assert_one_line(self.start(self.run_folder, *picture, "--array", "velocty"), 2, "did you mean velocity?")
        self.assert_one_line(self.start(self.run_folder, *picture, "--size", 0, 0), 2, "--size", "64", "8192")
        (self.run_folder / "particles.pvd").write_text("<VTKFile")
        self.assert_one_line(self.start(self.run_folder, *picture), 2, "particles.pvd", "; ")

    @unittest.skipIf(Path("/usr/lib/python3/dist-packages/paraview").exists(), "ParaView's Python is installed")
    def test_what_needs_paraviews_python_says_so_in_a_line(self):
        installed = "/usr/bin:/bin"  # Debian's ParaView, whose Python is another package
        self.assert_one_line(self.start(self.run_folder, "--live", PATH=installed), 2,
                             "a live view needs ParaView's Python", "python3-paraview", "sinew view '")
        self.assert_one_line(self.start(self.run_folder, "--picture", "a.png", PATH=installed), 4,
                             "sinew render '", "python3-paraview")

    def test_pictures_are_drawn_without_a_screen(self):
        picture = self.folder / "it's drawn.png"
        done = self.start(self.run_folder, "--picture", picture, "--size", "400", "300", "--forces", "force_bone",
                          "--cut", "x", PATH="/usr/bin:/bin", DISPLAY=None, PYTHONPATH=PYTHON)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(picture.read_bytes()[16:24], bytes([0, 0, 1, 144, 0, 0, 1, 44]))

    def test_a_live_view_opens_the_source_of_the_plugin(self):
        self.assert_one_line(self.start(self.run_folder, "--live", PYTHONPATH=PYTHON), 2, "install ./sinew-paraview")
        plugin = self.folder / "share/sinew/paraview"
        plugin.parent.mkdir(parents=True)
        plugin.symlink_to(SOURCE / "tools/paraview")
        (self.programs / "paraview").write_text('#!/bin/sh\necho "$PV_PLUGIN_PATH"\ncat "${1#--state=}"\n')
        before = self.state.read_bytes()
        done = self.start(self.run_folder, "--live", "--forces", PYTHONPATH=PYTHON)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue((Path(done.stdout.splitlines()[0]) / "sinew_paraview.py").is_file())
        for part in ('type="SinewSeries"', f'value="{self.run_folder}/run.json"', 'value="force_pair"'):
            self.assertIn(part, done.stdout)
        self.assertNotIn("PVDReader", done.stdout)
        self.assertEqual(self.state.read_bytes(), before)  # which opens without the plugin
        self.assertEqual(list(self.folder.glob("sinew-view-*")), [])

    def test_a_live_view_waits_for_a_run_that_has_just_begun(self):
        (self.run_folder / "run.json").write_text('{"program": "sinew", "status": "running"}')
        for name in ("view.pvsm", "particles.pvd"):
            (self.run_folder / name).rename(self.folder / name)
        picture = self.folder / "a.png"
        going = subprocess.Popen([BIN / "sinew-view", self.run_folder, "--live", "--picture", picture, "--size", "400", "300"],
                                 env={**os.environ, "PYTHONPATH": PYTHON})
        self.addCleanup(going.kill)
        time.sleep(0.5)
        self.assertIsNone(going.poll())
        for name in ("particles.pvd", "view.pvsm"):
            (self.folder / name).rename(self.run_folder / name)
        self.assertEqual(going.wait(200), 0)
        self.assertTrue(picture.exists())
        (self.run_folder / "run.json").write_text('{"program": "sinew", "status": "failed"}')
        for name in ("view.pvsm", "particles.pvd", "particles/particles_000000.vtu"):
            (self.run_folder / name).unlink()
        self.assert_one_line(self.start(self.run_folder, "--live", "--picture", picture, PYTHONPATH=PYTHON), 2, "no frames", "log.txt")

    def test_nothing_that_lies_in_the_folder_is_run(self):
        ran = self.folder / "it ran"
        for name in ("view.py", "live.py", "paraview.py", "camera.py", "sinew_live.py"):
            (self.run_folder / name).write_text(f"open({str(ran)!r}, 'w')")
        script = f"open({str(ran)!r}, 'w')"
        self.state.write_text(
            '<ServerManagerState version="5.11.0"><Proxy group="sources" type="ProgrammableSource" id="9" servers="1">'
            f'<Property name="Script"><Element index="0" value="{script}"/></Property></Proxy></ServerManagerState>')
        for more in ([], ["--live"]):
            picture = self.folder / f"drawn{len(more)}.png"
            done = subprocess.run([BIN / "sinew", "view", self.run_folder, "--picture", picture, "--size", "200", "150",
                                   *more], cwd=self.run_folder, capture_output=True, text=True, timeout=200,
                                  env={**os.environ, "PYTHONPATH": PYTHON})
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertTrue(picture.exists())
            self.assertFalse(ran.exists(), more)
        self.assertNotIn("ProgrammableSource", self.opened().read_text())


if __name__ == "__main__":
    unittest.main(argv=["view_test", "-v", *sys.argv[4:]])
