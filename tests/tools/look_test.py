#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""sinew render and sinew view on a small run: what they draw, and what they say when they cannot.

usage: look_test.py BIN SOURCE MODULES      folder of the programs, of the project, and the one filled by
                                            get_paraview_python.sh
"""
import fcntl
import json
import os
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

BIN, SOURCE, MODULES = (Path(place).resolve() for place in sys.argv[1:4])
SMALL = ["--set", "body.radius=0.025", "--set", "solver.duration=0.2", "--set", "output.interval=0.05"]
SIZE = ["--width", "320", "--height", "200"]


def sinew(*words, **options):
    return subprocess.run([BIN / "sinew", *map(str, words)], capture_output=True, text=True,
                          timeout=100, **options)


def size_of(png):
    head = png.read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n", png
    return struct.unpack(">II", head[16:24])


def without(*names, **changed):
    """The environment without these variables."""
    left = {name: value for name, value in os.environ.items() if name not in names}
    return {**left, **changed}


class ViewPreset(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        # ParaView begins Open MPI, which removes the folder of its sessions when it ends, also from under
        # another that begins.
        os.environ["OMPI_MCA_orte_tmpdir_base"] = cls.scratch.name
        os.environ["PMIX_MCA_gds"] = "hash"  # the store in shared memory fails where others start at the same time
        cls.run_folder = Path(cls.scratch.name) / "a run"
        cls.bonded = Path(cls.scratch.name) / "bonded"
        for folder, more in ((cls.run_folder, []), (cls.bonded, ["--set", "material.model=bonded"])):
            done = sinew("simulate", "--quiet", SOURCE / "configs/box_bend.yaml", "-o", folder, *SMALL,
                         *more)
            assert done.returncode == 0, done.stderr

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.pictures = Path(self.temporary.name)

    def render(self, *words, **options):
        return sinew("render", self.run_folder, "-o", self.pictures, *SIZE, *words, **options)

    def display(self):
        """Of a server without limits."""
        words = [f":{100 + os.getpid() % 50000}", "-displayfd", "1", "-noreset", "-nolisten", "tcp"]
        server = subprocess.Popen(["Xvfb", *words], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.addCleanup(server.communicate)
        self.addCleanup(server.kill)
        return ":" + server.stdout.readline().strip()

    def names(self):
        return sorted(path.name for path in self.pictures.iterdir())

    def assert_one_line(self, done, exit_code, *parts):
        self.assertEqual(done.returncode, exit_code, done.stderr)
        lines = [line for line in done.stderr.splitlines() if line]
        self.assertEqual(len(lines), 1, done.stderr)
        self.assertTrue(lines[0].startswith("sinew: "))
        for part in ("; ", *parts):
            self.assertIn(part, lines[0])

    def test_every_view_leaves_its_pictures_and_a_sheet(self):
        views = ["surface", "particles", "section", "strain", "halves", "cut", "lines", "forces", "bones"]
        done = self.render("--view", ",".join(views), "--times", "0.1,0.2", "--no-movie")
        self.assertEqual(done.returncode, 0, done.stderr)
        expected = [f"{view}_{part}.png" for view in views for part in ("000002", "000004", "sheet")]
        self.assertEqual(self.names(), sorted(expected))
        pixels = {name: (self.pictures / name).read_bytes() for name in expected}
        self.assertEqual(len(set(pixels.values())), len(expected))  # each shows something else
        self.assertEqual(size_of(self.pictures / "strain_000004.png"), (320, 200))

    def test_an_array_colors_the_skin_with_a_legend(self):
        """Also one that the surface of the run lacks, here by its particles."""
        foot = {}
        for array in [None, "strain_eq", "strain", "velocity", "von_mises", "bone"]:
            words = ["--array", array] if array else []
            done = self.render("--view", "surface", "--times", "0.2", "--no-movie", *words)
            self.assertEqual(done.returncode, 0, done.stderr)
            raw = subprocess.run(["ffmpeg", "-loglevel", "error", "-i", self.pictures / "surface_000004.png", "-f",
                                  "rawvideo", "-pix_fmt", "rgb24", "-"], capture_output=True, check=True).stdout
            rows = [raw[i:i + 320 * 3] for i in range(0, len(raw), 320 * 3)]
            colored = lambda row: sum(max(row[i:i + 3]) - min(row[i:i + 3]) > 60 for i in range(0, len(row), 3))
            foot[array] = (max(map(colored, rows[-40:])), sum(map(colored, rows[:-40])))
        self.assertEqual(foot[None][0], 0)
        for array, (legend, body) in foot.items():
            if array:
                self.assertGreater(legend, 80, array)
                self.assertGreater(body, 2 * foot[None][1] + 500, array)

    def test_an_array_that_is_nowhere_is_refused_naming_those_that_are(self):
        for view in ["surface", "halves", "body"]:
            self.assert_one_line(self.render("--view", view, "--array", "warmth", "--no-movie"), 2, "'warmth'",
                                 "strain_eq", "velocity")
            self.assert_one_line(self.render("--view", view, "--array", "acceleration", "--no-movie"), 2,
                                 "acceleration", "velocity")

    def test_arrays_that_positions_define_are_measured_where_the_run_lacks_them(self):
        done = self.render("--view", "cut", "--array", "stress_kirchhoff", "--times", "0.2", "--no-movie")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_planes_cut_where_they_are_asked_to(self):
        for plane in ["0,0,0.2,0,0,1", "0,0,0.5,0,0,1"]:
            done = self.render("--view", "cut", f"--plane={plane}", "--times", "0.2", "--no-movie")
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_one_line(self.render("--view", "cut", "--plane=0,0,9,0,0,1", "--no-movie"), 2, "does not meet the body")
        self.assert_one_line(self.render("--view", "cut", "--plane=0,0,9", "--no-movie"), 2, "six numbers")

    def test_for_print_words_are_written_as_vectors(self):
        done = self.render("--look", "paper", "--view", "cut", "--times", "0.2", "--no-movie")
        self.assertEqual(done.returncode, 0, done.stderr)
        pages = sorted(self.pictures.glob("*.svg"))
        self.assertEqual([page.stem for page in pages], sorted(page.stem for page in self.pictures.glob("*.png")))
        text = pages[0].read_text()
        self.assertIn(">0.2 s,", text)
        self.assertIn('width="180mm"', text)

    def test_camera_colors_range_and_array_change_the_picture(self):
        ways = [[], ["--camera", "front"], ["--camera", "1,0,0.5"], ["--camera", "top"],
                ["--colormap", "cividis"], ["--range", "0,0.01"], ["--array", "velocity"]]
        drawn = set()
        for way in ways:
            done = self.render("--times", "0.2", "--no-movie", *way)
            self.assertEqual(done.returncode, 0, done.stderr)
            drawn.add((self.pictures / "body_000004.png").read_bytes())
        self.assertEqual(len(drawn), len(ways))

    def test_background_axes_bones_and_traces_change_the_picture(self):
        ways = [[], ["--background", "black"], ["--background", "#102030"], ["--background", "transparent"],
                ["--axes"], ["--bones", "upper"], ["--trace", "0,50"]]
        drawn = set()
        for way in ways:
            done = self.render("--times", "0.2", "--no-movie", *way)
            self.assertEqual(done.returncode, 0, done.stderr)
            drawn.add((self.pictures / "body_000004.png").read_bytes())
            self.assertEqual((self.pictures / "body_000004.png").read_bytes()[25],
                             6 if "transparent" in way else 2)  # RGBA, RGB
        self.assertEqual(len(drawn), len(ways))

    def test_bonds_are_drawn_where_they_are_written(self):
        words = ["-o", self.pictures, *SIZE, "--view", "bonds", "--times", "0,0.2", "--no-movie"]
        self.assert_one_line(sinew("render", self.run_folder, *words), 2, "--set output.bonds=true")
        run = self.pictures / "run"
        done = sinew("simulate", "--quiet", SOURCE / "configs/box_bend.yaml", "-o", run, *SMALL, "--set",
                     "output.bonds=true", "--set", "material.model=bonded")
        self.assertEqual(done.returncode, 0, done.stderr)
        for array in ("strain", "length", "force"):
            done = sinew("render", run, *words, "--array", array)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_the_camera_orbits_in_the_movie(self):
        frames = {}
        for orbit in ([], ["--orbit", "90"]):
            done = self.render("--view", "bones", "--no-pictures", *orbit)
            self.assertEqual(done.returncode, 0, done.stderr)
            raw = subprocess.run(["ffmpeg", "-loglevel", "error", "-i", self.pictures / "bones.mp4", "-f",
                                  "rawvideo", "-pix_fmt", "rgb24", "-"], capture_output=True, check=True).stdout
            size = 320 * 200 * 3
            frames[bool(orbit)] = [raw[i:i + size] for i in range(0, len(raw), size)]
        self.assertEqual(len(frames[True]), 5)
        difference = lambda one, other: sum(abs(a - b) for a, b in zip(one, other))
        turned, still = frames[True], frames[False]
        self.assertGreater(difference(turned[0], turned[1]), 2 * difference(still[0], still[1]))
        self.assertGreater(difference(turned[-1], still[-1]), 100000)

    def test_two_runs_side_by_side(self):
        done = self.render("--compare", self.bonded, "--times", "0.2")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.names(), ["compare_body.mp4", "compare_body_000004.png",
                                        "compare_body_sheet.png"])

    def test_two_runs_side_by_side_have_one_range(self):
        """That of both, whichever comes first; each keeps its own in its record."""
        told, own = [], []
        for one, other in ((self.run_folder, self.bonded), (self.bonded, self.run_folder)):
            done = sinew("render", one, "--compare", other, "-o", self.pictures, *SIZE, "--no-movie", "--times", "0.2",
                         "--view", "strain", "--json")
            self.assertEqual(done.returncode, 0, done.stderr)
            told.append(json.loads(done.stdout)["ranges"]["strain_eq"])
            own.append(json.loads((one / "run.json").read_text())["ranges"]["strain_eq"])
        self.assertNotEqual(*own)
        self.assertEqual(told, 2 * [[min(low for low, _ in own), max(high for _, high in own)]])

    def test_large_pictures_take_little_memory(self):
        words = ["render", self.run_folder, "-o", self.pictures, "--no-movie", "--times", "0.2",
                 "--view", "particles", "--width", "4096", "--height", "4096"]
        code = ("import resource, subprocess, sys; done = subprocess.run(sys.argv[1:]);"
                "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss); sys.exit(done.returncode)")
        done = subprocess.run([sys.executable, "-c", code, BIN / "sinew", *map(str, words)],
                              capture_output=True, text=True, timeout=200)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(size_of(self.pictures / "particles_000004.png"), (4096, 4096))
        peak = 1024 * int(done.stdout.split()[-1])
        self.assertLess(peak, 1.3e9)  # drawn in one piece it takes twice as much

    def test_what_a_killed_render_left_is_removed(self):
        mine = self.pictures / ".notes.tmp"
        left = [self.pictures / name for name in (".movie.mp4.tmp", ".strain.mp4.tmp", ".body_000003.png.tmp",
                                                  ".contact_sheet.png.tmp")]
        for file in [mine, *left]:
            file.write_text("")
        other = os.open(self.pictures, os.O_RDONLY)
        fcntl.flock(other, fcntl.LOCK_SH)  # as another render that is drawing holds it
        self.assertEqual(self.render("--times", "0", "--no-movie").returncode, 0)
        self.assertTrue(all(file.exists() for file in left[:3]))
        os.close(other)
        self.assertEqual(self.render("--times", "0", "--no-movie").returncode, 0)
        self.assertEqual(self.names(), [".notes.tmp", "body_000000.png", "contact_sheet.png"])

    def test_times_outside_the_run_are_refused_with_its_range(self):
        for times in ["nan", "-1", "1e300", "inf", "0.21", "0.1,0.3"]:
            self.assert_one_line(self.render(f"--times={times}"), 2, "times from 0 to 0.2 s")
        self.assertEqual(self.names(), [])

    def test_mistakes_are_told_with_their_cure(self):
        for words, part in [(["--view", "secton"], "did you mean section?"),
                            (["--colormap", "jet"], "viridis"),
                            (["--array", "displacment"], "did you mean displacement?"),
                            (["--range", "1,0"], "--range 0,0.5"),
                            (["--camera", "0,0,0"], "--camera 1,-2,0.5"),
                            (["--bones", "uper"], "did you mean upper?"),
                            (["--trace", "100000"], "give ids of them, which lie from 0 to"),
                            (["--background", "blak"], "did you mean black?"),
                            (["--background", "#12"], "six hexadecimal digits"),
                            (["--background", "transparent"], "add --no-movie"),
                            (["--orbit", "90", "--no-movie"], "leave out --no-movie"),
                            (["--orbit", "nan"], "--orbit 360"),
                            (["--camera", "frnt"], "did you mean front?")]:
            self.assert_one_line(self.render(*words), 2, part)
        self.assert_one_line(sinew("render", self.pictures), 2, "is not the folder of a run")

    def test_the_pictures_of_a_run_begin_with_its_scene(self):
        self.assertEqual(self.render("--no-movie").returncode, 0)
        self.assertIn("scene.png", self.names())
        self.assertEqual(size_of(self.pictures / "scene.png"), (320, 200))

    def test_bonds_that_a_run_writes_are_in_its_report(self):
        run = self.pictures / "bonds"
        body = (f"body: {{mesh: {SOURCE}/data/meshes/box.obj, radius: 0.025}}\nmaterial: {{model: bonded}}\n"
                "skeleton: {bones: [{name: all, head: [0, 0, 0], tail: [0, 0, 0.69]}]}\n"
                "solver: {duration: 0.05}\noutput: {interval: 0.05, bonds: true}\n")
        (self.pictures / "bonds.yaml").write_text(body)
        done = sinew("run", self.pictures / "bonds.yaml", "-o", run)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = (run / "report.html").read_text()
        for name in ("scene.png", "bonds_000000.png", "bonds_sheet.png"):
            self.assertIn(f"pictures/{name}", page)
        self.assertEqual(sorted(file.name for file in (run / "pictures").glob("*.mp4")), ["movie.mp4"])

    def test_check_draws_the_scene(self):
        scene, picture = SOURCE / "configs/box_bend.yaml", self.pictures / "scene.png"
        done = sinew("check", scene, *SMALL, "--picture", picture)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"picture: {picture}", done.stdout)
        self.assertEqual(size_of(picture), (1280, 720))
        self.assert_one_line(sinew("check", scene, *SMALL, "--picture", self.pictures / "scene.vtu"), 2, ".png")

    def test_check_draws_where_flesh_meets(self):
        text = (SOURCE / "configs/box_bend.yaml").read_text().replace("../", f"{SOURCE}/")
        scene, picture = self.pictures / "folded.yaml", self.pictures / "folded.png"
        scene.write_text(text.replace("euler: [0, 90, 0]", "euler: [0, 178, 0]"))
        done = sinew("check", scene, "--set", "body.radius=0.025", "--picture", picture)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("flesh_meets: lower and upper", done.stdout)
        self.assertEqual(size_of(self.pictures / "folded_meets.png"), (1280, 720))

    def test_check_needs_a_display_for_the_picture_only(self):
        scene, bare = SOURCE / "configs/box_bend.yaml", without("DISPLAY", PATH=str(self.pictures / "missing"))
        self.assertEqual(sinew("check", scene, *SMALL, env=bare).returncode, 0)
        done = sinew("check", scene, *SMALL, "--picture", self.pictures / "a.png", env=bare)
        self.assert_one_line(done, 4, "apt-get install xvfb")

    def test_obstacles_and_held_particles_change_the_pictures(self):
        body = (f"body: {{mesh: {SOURCE}/data/meshes/box.obj, radius: 0.025}}\n"
                "skeleton: {bones: [{name: all, head: [0, 0, 0], tail: [0, 0, 0.69]}]}\n"
                "solver: {duration: 0.05}\noutput: {interval: 0.05}\n")
        worlds = {"nothing": "", "obstacle": "obstacles: [{name: floor, shape: plane, point: [0, 0, -0.1]}]",
                  "pins": "pins: [{low: [-1, -1, 0], high: [1, 1, 0.1]}]"}
        drawn = {"scene.png": set(), "contact_sheet.png": set()}
        for name, world in worlds.items():
            scene, run = self.pictures / f"{name}.yaml", self.pictures / name
            scene.write_text(body + f"world: {{{world}}}\n")
            for words in (["simulate", "--quiet", scene, "-o", run], ["render", run, "--no-movie", *SIZE]):
                done = sinew(*words)
                self.assertEqual(done.returncode, 0, done.stderr)
            for picture, seen in drawn.items():
                seen.add((run / "pictures" / picture).read_bytes())
        for picture, seen in drawn.items():
            self.assertEqual(len(seen), len(worlds), picture)

    def test_supports_and_loads_are_arrows_in_pictures_report_and_paraview(self):
        run, pictures = self.pictures / "pressed", self.pictures / "live.png"
        modules = without(PYTHONPATH=str(MODULES / "usr/lib/python3/dist-packages"))
        drawn = []
        for supports in ("supports.pvd", None):
            done = []
            if supports:
                done.append(sinew("simulate", SOURCE / "configs/limb_press.yaml", "-o", run, "--set", "body.radius=0.025"))
            done += [sinew("render", run, "--no-movie", "--times", "1", *SIZE), sinew("measure", run, "--quiet"),
                     sinew("view", run, "--live", "--picture", pictures, "--size", "400", "200", env=modules)]
            self.assertEqual([one.returncode for one in done], [0] * len(done), [one.stderr for one in done])
            drawn.append([(run / "pictures/body_000002.png").read_bytes(), pictures.read_bytes()])
            self.assertEqual('"isLoad":[false,true]' in (run / "report.html").read_text(), bool(supports))
            (run / "supports.pvd").unlink(missing_ok=True)
            shutil.rmtree(run / "supports", ignore_errors=True)
        for one, other in zip(*drawn):
            self.assertNotEqual(one, other)

    def test_a_disk_that_is_full_is_one_line(self):
        few = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))
        done = self.render("--no-movie", preexec_fn=few, restore_signals=False,
                           env={**os.environ, "DISPLAY": self.display()})
        self.assert_one_line(done, 4, "body_000000.png", "File too large")
        self.assertEqual(self.names(), [])

    def test_a_missing_display_is_one_line(self):
        done = self.render(env=without("DISPLAY", PATH=str(self.pictures / "missing")))
        self.assert_one_line(done, 4, "apt-get install xvfb")

    def test_view_and_live_explain_what_is_missing(self):
        done = sinew("view", self.run_folder, "--picture", self.pictures / "a.png", "--array", "none",
                     env=without(PYTHONPATH=str(MODULES / "usr/lib/python3/dist-packages")))
        self.assert_one_line(done, 2, "the particles have no array 'none'; did you mean bone?")


if __name__ == "__main__":
    unittest.main(argv=["look_test", "-v", *sys.argv[4:]])
