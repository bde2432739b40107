#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The notebooks in lib/examples run, and the pages of the tutorials show their cells.

usage: tutorials_test.py BIN SOURCE      folder of the programs, folder of the project; PYTHONPATH names the package's
"""
import importlib.util
import os
import re
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(sys.argv[2]).resolve()
sys.path.insert(0, str(SOURCE / "data"))
import make_tutorials


@unittest.skipUnless(all(map(importlib.util.find_spec, ("nbconvert", "ipykernel"))), "without nbconvert and ipykernel")
class Notebooks(unittest.TestCase):
    def executed(self, name, pictures):
        os.environ.pop("MPLBACKEND", None)  # pictures are drawn into the page
        with tempfile.TemporaryDirectory() as folder:
            page = (make_tutorials.executed(name, Path(folder), "html") / f"{name}.html").read_text()
        self.assertEqual(page.count("<img"), pictures)
        self.assertRegex(page, r"simulating \[#+\] 100 %")
        return page

    def test_from_a_mesh_to_its_report(self):
        self.assertIn("report.html", self.executed("mesh_to_report", 3))

    def test_a_rubber_block_in_a_machine(self):
        ratio = float(re.search(r"&#39;(\d\.\d+)&#39;", self.executed("rubber_block", 3))[1])
        self.assertTrue(1.0 < ratio < 1.2, ratio)  # held faces stiffen a block twice as high as wide by some percent

    def test_a_muscle_between_bones(self):
        self.executed("muscle_between_bones", 3)

    def test_a_scan_that_bends(self):
        self.executed("scan_that_bends", 3)


class Pages(unittest.TestCase):
    def test_pages_show_the_cells_and_pictures_of_their_notebooks(self):
        for name in make_tutorials.NAMES:
            page = (SOURCE / f"lib/examples/{name}.md").read_text()
            self.assertEqual(re.findall(r"```python\n(.*?)\n```", page, re.S), make_tutorials.code_of(name), f"{name}: make_tutorials.py")
            pictures = re.findall(r"!\[.+?\]\((.*?)\)", page)
            self.assertGreater(len(pictures), 2)
            for picture in pictures:
                self.assertTrue((SOURCE / "lib/examples" / picture).is_file(), picture)


if __name__ == "__main__":
    unittest.main(argv=["tutorials_test", "-v", *sys.argv[3:]])
