#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page for strangers (lib/README.md, "A series") adds one by two rows: a program that has them, and nothing else,
writes it, and tells of it in run.json (which Python and the plugin read) and in the state for ParaView.

usage: adding_a_series_test.py SOURCE FOLDER             writes the two sources with the rows to the folder
       adding_a_series_test.py SOURCE FOLDER SIMULATE    tests the program that was made of them
"""
import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE, FOLDER = (Path(place).resolve() for place in sys.argv[1:3])
# The end of each table.
TABLES = {"io/series_table.cpp": "\n});\n\n}  // namespace\n", "run/frame_data.cpp": "\n});\n\nstd::vector<std::string_view> series_of("}


def rows_of_the_page():
    section = (SOURCE / "lib/README.md").read_text().split("\n### A series\n")[1].split("\n### ")[0]
    return re.findall(r"^    (\{.*\},)$", section, re.MULTILINE)


def write_sources():
    FOLDER.mkdir(parents=True, exist_ok=True)
    for (file, end), row in zip(TABLES.items(), rows_of_the_page(), strict=True):
        text = (SOURCE / "lib/sinew" / file).read_text()
        assert text.count(end) == 1, f"{file}: where does its table end?"
        (FOLDER / Path(file).name).write_text(text.replace(end, f"\n    {row}{end}"))


class AddingASeries(unittest.TestCase):
    def test_it_is_written_and_found_by_its_row_alone(self):
        import meshio
        from small_run import SCENE
        name, cells = re.match(r'\{"(\w+)", CellKind::(\w+)', rows_of_the_page()[0]).groups()
        with tempfile.TemporaryDirectory() as scratch:
            scene, run = Path(scratch) / "small.yaml", Path(scratch) / "run"
            scene.write_text(SCENE.format(mesh=SOURCE / "data/meshes/box.obj"))
            subprocess.run([sys.argv[3], scene, "-o", run, "--set", "solver.duration=0.1", "--quiet"], check=True)
            record = json.loads((run / "run.json").read_text())["series"]
            self.assertEqual(record[name]["cells"], cells)
            self.assertIn(f"{name}.pvd", (run / "view.pvsm").read_text())
            files = sorted((run / name).iterdir())
            self.assertEqual(len(files), len(list((run / "frames").iterdir())))
            self.assertEqual(len(meshio.read(files[-1]).points), 2)  # bones of the scene


if __name__ == "__main__":
    if len(sys.argv) == 3:
        write_sources()
    else:
        unittest.main(argv=["adding_a_series_test", "-v"])
