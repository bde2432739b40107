#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""live_test.py BIN SOURCE MAKE_SERIES MODULES: ParaView follows a run while it is written, by the plugin's live source.

MODULES is the folder filled by get_paraview_python.sh."""
import json
import os
import re
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib
from pathlib import Path

BIN, SOURCE, MAKE_SERIES, MODULES = (Path(place).resolve() for place in sys.argv[1:5])
PARAVIEW = Path(__file__).resolve().parent / "paraview.sh"
PYTHON = str(MODULES / "usr/lib/python3/dist-packages")
SERIES = {name: {} for name in ("particles", "surface", "bones", "frames")}

# What ParaView's window does with the state that sinew view --live opens.
FOLLOW = """
import sys, time
sys.path.insert(0, sys.argv[1])
import sinew_paraview
from paraview.simple import *
LoadPlugin(sinew_paraview.__file__, ns=globals())
LoadState(sys.argv[2])
frames, shown = int(sys.argv[3]), 0
sources = [source for source in GetSources().values() if source.GetXMLName() == "SinewSeries"]
end = time.monotonic() + 60
while shown < frames and time.monotonic() < end:
    if shown and not any([source.GetClientSideObject().GetNeedsUpdate() for source in sources]):
        time.sleep(0.1)
        continue
    for source in sources:
        source.GetClientSideObject().Modified()
        source.MarkModified(source.SMProxy)
    RenderAllViews()
    shown += 1
    times = {servermanager.Fetch(source).GetFieldData().GetArray("TimeValue").GetValue(0) for source in sources}
    points = GetColorTransferFunction("displacement").RGBPoints
    print("frame", *times, "colors", points[0], points[-4], flush=True)
SaveScreenshot(sys.argv[4], GetLayout(), ImageResolution=[800, 400], SeparatorWidth=0)
"""


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
        scratch = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.addCleanup(scratch.cleanup)
        # ParaView begins Open MPI, which removes the folder of its sessions when it ends, also from under
        # another that begins.
        os.environ["OMPI_MCA_orte_tmpdir_base"] = scratch.name
        os.environ["PMIX_MCA_gds"] = "hash"  # the store in shared memory fails where others start at the same time
        self.folder = Path(scratch.name)
        self.run_folder, self.picture = self.folder / "a run", self.folder / "live.png"
        self.run_folder.mkdir()

    def start_run(self, frames, pause, status="running"):
        self.record(status)
        run = subprocess.Popen([MAKE_SERIES, self.run_folder, "zlib", str(frames), str(pause)])
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        return run

    def record(self, status):
        text = json.dumps({"program": "sinew", "status": status, "series": SERIES})
        (self.run_folder / "run.json").write_text(text)

    def view(self, *words, **changed):
        environment = {**os.environ, "PYTHONPATH": PYTHON, "DISPLAY": ":77", "TMPDIR": str(self.folder), **changed}
        return subprocess.run([BIN / "sinew", "view", self.run_folder, *words], capture_output=True, text=True,
                              timeout=250, env=environment)

    def with_paraview(self, what):
        """PATH with a ParaView in front that does this with the state that it is started on."""
        programs = self.folder / "programs"
        programs.mkdir()
        (programs / "paraview").write_text(f'#!/bin/sh\n[ "$1" = --version ] && exit\nstate=${{1#--state=}}\n{what}\n')
        (programs / "paraview").chmod(0o755)
        return f"{programs}:/usr/bin:/bin"

    def state(self, *words):
        """What ParaView is started on."""
        done = self.view("--live", *words, PATH=self.with_paraview(f'cp "$state" "{self.folder}/live.pvsm"'))
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.folder / "live.pvsm"

    def follow(self, frames, *words):
        state, script = self.state(*words), self.folder / "follow.py"
        script.write_text(FOLLOW)
        done = subprocess.run([PARAVIEW, MODULES, script, SOURCE / "tools/paraview", state, str(frames), self.picture],
                              capture_output=True, text=True, timeout=250)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("rror", done.stderr)
        lines = re.findall("frame (.*) colors (.*)", done.stdout)
        return [list(map(float, " ".join(line).split())) for line in lines]

    def test_follows_a_growing_run_and_leaves_a_picture(self):
        """All series have the same moment, and the scale of colors grows with them."""
        run = self.start_run(2000, 0.05)
        rows = self.follow(4)
        self.assertIsNone(run.poll(), "the run ended before its viewer")
        self.assertEqual([len(row) for row in rows], [3] * 4)  # the time of all, and the ends of the scale
        times, highest = [row[0] for row in rows], [row[2] for row in rows]
        self.assertEqual(times, sorted(set(times)))
        self.assertEqual(highest, sorted(highest))
        self.assertLess(highest[0], highest[-1])
        width, height, channels, bytes_ = pixels_of(self.picture)
        self.assertEqual((width, height), (800, 400))
        self.assertGreater(len(set(bytes_)), 100)

    def test_a_range_that_was_asked_for_stays_though_values_exceed_it(self):
        self.start_run(2000, 0.05)
        self.assertEqual([row[1:] for row in self.follow(3, "--range", "0.001,0.002")], [[0.001, 0.002]] * 3)

    def test_a_finished_run_shows_its_last_frame(self):
        self.start_run(3, 0, "finished").wait()
        self.assertEqual([row[0] for row in self.follow(1)], [1])

    def test_ended_by_a_signal_it_ends_paraview_and_leaves_no_folder(self):
        self.start_run(3, 0).wait()
        path = self.with_paraview(f'echo $$ > "{self.folder}/begun.new"; mv "{self.folder}/begun.new" "{self.folder}/begun"\nexec sleep 200')
        for ending in (signal.SIGTERM, signal.SIGHUP):
            environment = {**os.environ, "PYTHONPATH": PYTHON, "DISPLAY": ":77", "TMPDIR": str(self.folder), "PATH": path}
            viewer = subprocess.Popen([BIN / "sinew", "view", self.run_folder, "--live"], env=environment)
            while not (self.folder / "begun").exists() and viewer.poll() is None:
                time.sleep(0.05)
            begun = int((self.folder / "begun").read_text())
            (self.folder / "begun").unlink()
            viewer.send_signal(ending)
            self.assertNotEqual(viewer.wait(timeout=60), 0)
            self.assertFalse(Path(f"/proc/{begun}").exists())
            self.assertEqual(list(self.folder.glob("sinew-view-*")), [])

    def test_without_a_display_it_says_how_to_draw(self):
        self.start_run(3, 0).wait()
        done = self.view("--live", DISPLAY="", WAYLAND_DISPLAY="")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertRegex(done.stderr, "^sinew: there is no screen.*--picture FILE.png.*\n$")

    def test_a_run_that_is_slow_leaves_a_picture_of_its_newest_frame(self):
        self.start_run(3, 0).wait()
        drawn = []
        for live in (["--live"], ["--time", "0"]):
            done = self.view(*live, "--picture", self.picture, "--size", "400", "200")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            drawn.append(pixels_of(self.picture))
        self.assertEqual(drawn[0][:2], (400, 200))
        self.assertTrue(drawn[0] != drawn[1])

    def test_a_picture_that_is_not_written_ends_with_its_code(self):
        self.start_run(3, 0).wait()
        for words, code, what in ((["--picture", "nowhere/a.png"], 4, "nowhere/a.png"),
                                  (["--picture", self.picture, "--array", "nonsense"], 2, "no array 'nonsense'"),
                                  (["--picture", self.picture, "--size", "0", "0"], 2, "64")):
            done = self.view("--live", *words)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(what, done.stderr.splitlines()[-1])

    def test_a_run_that_ended_without_a_frame_is_told(self):
        self.record("failed")
        done = self.view("--live", "--picture", self.picture)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertRegex(done.stderr, "^sinew: .*has no frames; see why in .*log.txt.*\n$")


if __name__ == "__main__":
    unittest.main(argv=["live_test", "-v", *sys.argv[5:]])
