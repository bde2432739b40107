# SPDX-License-Identifier: GPL-3.0-or-later
"""A small scene and the programs that run it, for tests of whole commands. The test is called with the
folder of the programs and the folder of the project.
"""
import json
import re
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

BIN, SOURCE = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()

SCENE = """
body:
  mesh: {mesh}
  radius: 0.025
skeleton:
  bones:
    - name: lower
      head: [0, 0, 0]
      tail: [0, 0, 0.34648]
    - name: upper
      parent: lower
      tail: [0, 0, 0.69296]
motion:
  tracks:
    - bone: upper
      keys:
        - time: 0
        - time: 0.2
          axis: [0, 1, 0]
          angle: 30
        - time: 0.4
          axis: [0, 1, 0]
          angle: 0
solver:
  duration: 0.4
"""

SERIES = ["particles", "surface", "bones", "frames"]
CACHE = BIN.parent / "CMakeCache.txt"  # not there where sinew is installed
HAS_GROUPS = not CACHE.is_file() or "SINEW_GROUPS:BOOL=OFF" not in CACHE.read_text()


def check_schemas(words, since, cwd):
    """What a command has written below the folders that it was told of is as the installed schemas say."""
    import schemas  # here: what runs in ParaView's Python may lack jsonschema

    for folder in {Path(cwd or ".", str(word)) for word in words} | {Path(cwd or "/none", "out")}:
        if folder.is_dir():
            schemas.check_written(folder, since)


def sinew(*words, check=None, timeout=300, sound=True, **options):
    """sound: whether the records that it leaves are as their schemas say."""
    begun = time.time()
    done = subprocess.run([BIN / "sinew", *map(str, words)], capture_output=True, text=True,
                          timeout=timeout, **options)
    if done.returncode == 0 and sound:
        check_schemas(words, begun, options.get("cwd"))
    if check is not None and done.returncode != check:
        raise AssertionError(f"{words} ended with {done.returncode}:\n{done.stdout}\n{done.stderr}")
    return done


class SmallRun(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)
        self.scene = self.folder / "small.yaml"
        self.scene.write_text(SCENE.format(mesh=SOURCE / "data/meshes/box.obj"))
        self.out = self.folder / "run"

    def tearDown(self):
        self.temporary.cleanup()

    def simulate(self, *words, check=0):
        return sinew("simulate", self.scene, "-o", self.out, *words, check=check)

    def record(self, folder=None):
        return json.loads(((folder or self.out) / "run.json").read_text())

    def wait_for(self, child, file):
        for _ in range(3000):
            if (self.out / file).exists():
                return
            self.assertIsNone(child.poll(), "the run ended by itself")
            time.sleep(0.02)
        self.fail(f"no {file} after a minute")

    def assert_one_line(self, done, exit_code, *parts):
        self.assertEqual(done.returncode, exit_code, done.stderr)
        said = [line for line in done.stderr.splitlines() if line.startswith("sinew: ")]
        errors = [line for line in said if not line.startswith("sinew: warning: ")]
        self.assertEqual(len(errors), 1, done.stderr)
        self.assertIn("; ", errors[0])
        for part in parts:
            self.assertIn(part, errors[0])

    def was_begun(self, file, name, frames):
        """By ranks that were ahead of the frames when one of them was killed."""
        number = re.fullmatch(rf"\.{name}_(\d+)\.vtu\.tmp", file)
        return self.record()["status"] == "failed" and number is not None and int(number[1]) >= frames

    def assert_series_are_whole(self, frames):
        """Every series has these frames, in the order of their times, and nothing torn beside."""
        for name in SERIES:
            expected = [f"{name}/{name}_{i:06}.vtu" for i in range(frames)]
            pvd = (self.out / f"{name}.pvd").read_text()
            self.assertEqual(re.findall(r'file="([^"]*)"', pvd), expected)
            times = [float(time) for time in re.findall(r'timestep="([^"]*)"', pvd)]
            self.assertEqual(times, sorted(times))
            listed = json.loads((self.out / f"{name}.vtu.series").read_text())["files"]
            self.assertEqual([(one["name"], one["time"]) for one in listed], list(zip(expected, times)))
            for file in expected:
                self.assertTrue((self.out / file).read_bytes().endswith(b"</VTKFile>\n"), file)
            beside = [path.name for path in (self.out / name).iterdir() if f"{name}/{path.name}" not in expected]
            self.assertEqual([file for file in beside if not self.was_begun(file, name, frames)], [])
