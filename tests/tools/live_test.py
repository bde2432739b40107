#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""live_test.py MAKE_SERIES MODULES: ParaView follows a run while it is written.

MODULES is the folder filled by get_paraview_python.sh."""
import os
import re
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib
from pathlib import Path

MAKE_SERIES, MODULES = (str(Path(place).resolve()) for place in sys.argv[1:3])
PARAVIEW = Path(__file__).resolve().parent / "paraview.sh"


def pixels_of(path):
    """Rows of bytes of a PNG as ParaView writes it: 8 bits a channel, no interlace."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, _, color = struct.unpack(">IIBB", body[:10])
        packed += body if kind == b"IDAT" else b""
        at += size + 12
    return width, height, {2: 3, 6: 4}[color], zlib.decompress(packed)


class Live(unittest.TestCase):
    def setUp(self):
        # Open MPI's daemon may still be removing its folder there.
        self.scratch = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        # ParaView begins Open MPI, which removes the folder of its sessions when it ends, also from under
        # another that begins.
        os.environ["OMPI_MCA_orte_tmpdir_base"] = self.scratch.name
        os.environ["PMIX_MCA_gds"] = "hash"  # the store in shared memory fails where others start at the same time
        self.run_folder = Path(self.scratch.name) / "a run"
        self.addCleanup(self.scratch.cleanup)

    def start_run(self, frames, pause):
        run = subprocess.Popen([MAKE_SERIES, self.run_folder, "zlib", str(frames), str(pause)])
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        while not (self.run_folder / "live.py").exists():
            time.sleep(0.01)
        return run

    def follow(self, *options):
        return subprocess.run([PARAVIEW, MODULES, self.run_folder / "live.py", *options],
                              capture_output=True, text=True, timeout=250)

    def test_follows_a_growing_run_and_leaves_a_picture(self):
        run = self.start_run(5000, 0.05)
        picture = self.run_folder / "live.png"
        done = self.follow("--frames", "4", "--size", "800", "400", "--picture", str(picture))
        self.assertIsNone(run.poll(), "the run ended before its viewer")
        self.assertEqual(done.returncode, 0, done.stderr)
        shown = [int(number) for number in re.findall(r"^frame (\d+)$", done.stdout, re.MULTILINE)]
        self.assertEqual(len(shown), 4)
        self.assertEqual(shown, sorted(set(shown)))
        self.assertNotIn("rror", done.stderr)
        width, height, channels, bytes_ = pixels_of(picture)
        self.assertEqual((width, height), (800, 400))
        self.assertGreater(len(set(bytes_)), 100)

    def test_a_finished_run_shows_its_last_frame_on_any_display(self):
        self.start_run(3, 0).wait()
        (self.run_folder / "run.json").write_text('{"program": "sinew", "status": "finished"}')
        picture = self.run_folder / "live.png"
        environment = {**os.environ, "PYTHONPATH": MODULES + "/usr/lib/python3/dist-packages",
                       "OMPI_MCA_orte_tmpdir_base": str(self.run_folder)}
        number = str(100 + os.getpid() % 50000)  # not the first that is free, which another display may be leaving
        done = subprocess.run(["xvfb-run", "-a", "-n", number, "pvbatch", self.run_folder / "live.py", "--frames", "2",
                               "--size", "400", "200", "--picture", str(picture)], env=environment,
                              capture_output=True, text=True, timeout=250)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("frame 2\nthe run has ended, 1 shown; view.py", done.stdout)
        self.assertNotIn("rror", done.stderr)
        self.assertEqual(pixels_of(picture)[:2], (400, 200))

    def test_without_a_display_it_says_how_to_draw(self):
        self.start_run(3, 0).wait()
        environment = {**os.environ, "PYTHONPATH": MODULES + "/usr/lib/python3/dist-packages",
                       "OMPI_MCA_orte_tmpdir_base": str(self.run_folder)}
        environment.pop("DISPLAY", None)
        for script in ("live.py", "view.py"):
            done = subprocess.run(["pvbatch", self.run_folder / script], env=environment, capture_output=True,
                                  text=True, timeout=250)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertEqual(done.stderr.strip(), f"{script}: there is no screen; draw without one by: xvfb-run -a "
                                                  f"pvbatch {script} --picture FILE.png")

    def test_a_run_that_is_slow_leaves_a_picture_and_no_error_of_the_display(self):
        self.start_run(3, 0).wait()
        (self.run_folder / "run.json").write_text('{"program": "sinew", "status": "running"}')
        picture = self.run_folder / "live.png"
        done = self.follow("--frames", "2", "--patience", "2", "--size", "400", "200", "--picture", str(picture))
        self.assertEqual(done.stderr.strip(), "live.py: no further frame within 2 s, 1 shown")
        self.assertEqual(done.returncode, 2)
        self.assertTrue(picture.exists())

    def test_a_picture_that_is_not_written_ends_with_its_code(self):
        self.start_run(3, 0).wait()
        for words, code, what in ((["--picture", "nowhere/a.png"], 4, "nowhere/a.png: cannot be written (No such file"),
                                  (["--array", "nonsense"], 2, "no array 'nonsense'; they have "),
                                  (["--size", "0", "0"], 2, "give 64 to 8192 pixels")):
            done = self.follow("--patience", "2", *words)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(what, done.stderr.splitlines()[-1])

    def test_a_run_that_ends_is_no_failure_of_the_frames_shown(self):
        self.start_run(3, 0).wait()
        done = self.follow("--frames", "2", "--patience", "2")
        self.assertIn("no further frame within 2 s, 1 shown", done.stderr)
        self.assertNotEqual(done.returncode, 0)


if __name__ == "__main__":
    unittest.main(argv=["live_test", "-v"])
