#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What compare.py makes of figures: ratios within rounds, the tighter limit, a plot that is XML."""
import unittest
import xml.etree.ElementTree as ElementTree

import speed_plot
import speed_tables

# The machine became half as fast after the first round: the ratios are 4 and 5 all the same.
RESULTS = {
    "processor": "P", "cores": 2, "particles": {3_000: 2_965, 300_000: 300_415},
    "figures": {
        "rest/3000/single/1": [80, 50], "rest/3000/single/2": [160, 100], "rest/3000/lammps/1": [20, 10],
        "rest/3000/cells/1": [2, 1], "rest/3000/all_pairs/1": [0.5, 0.25], "rest/3000/double/1": [40, 20],
        "rest/300000/single/1": [100, 90], "rest/300000/double/1": [60, 50], "flowed/300000/single/1": [45, 40],
        "paper, rest/30000/single/1": [100, 50], "paper, rest/30000/double/1": [40, 20],
        "bonded, bending/30000/single/1": [80, 45], "bonded, bending/30000/double/1": [30, 15],
        "bonded, bending/30000/lammps/1": [6, 4],
        "box_bend, whole/33437/single/1": [40], "box_bend, whole/33437/double/1": [12],
        "bonded, bending/30000/single/2": [90], "bonded, bending/30000/double/2": [40],
    },
    "limits": {"peak/single GFLOP/s": [84, 80], "peak/double GFLOP/s": [42], "triad/threads:1 traffic": [36, 30]},
    "bytes_per_particle": {"single": 200.4},
    "lammps_lists": {"rest/3000": {"builds": 0, "dangerous": 0}, "flowed/300000": {"builds": 10, "dangerous": 9}},
}


class Tables(unittest.TestCase):
    def setUp(self):
        self.lines = speed_tables.markdown(RESULTS).splitlines()

    def line(self, begin):
        return next(line for line in self.lines if line.startswith(begin))

    def test_ratios_are_taken_within_rounds(self):
        self.assertIn("| 65 / 130 | – | 1.5 | 15 | 4.5 (4 to 5) |", self.line("| 2,965"))

    def test_states_are_those_of_the_size_with_most_of_them(self):
        self.assertTrue(self.line("| flowed").startswith("| flowed | – |"))
        self.assertIn("The states, 300,415 particles:", self.lines)

    def test_laws_are_compared_with_the_paper_at_rest(self):
        self.assertIn("| 62.5 / 90 | 0.85 | 22.5 / 40 | 0.75 | – | 5 |", self.line("| bonded, bending"))

    def test_scenes_are_compared_with_the_paper_at_rest(self):
        self.assertIn("| – | 0.53 | – | 0.40 |", self.line("| box_bend (33,437)"))

    def test_the_tighter_limit_is_named(self):
        self.assertIn("| 84 GFLOP/s | 200 | 48 % |", self.line("| single, arithmetic (the tighter)"))
        self.assertIn("| 36 GB/s | 500 | 19 % |", self.line("| single, memory |"))

    def test_lists_that_lammps_kept_too_long_are_told(self):
        self.assertTrue(self.line("LAMMPS checked its lists too late").endswith("missed pairs: 9 of 10 times (flowed, 300,000)."))

    def test_plot_is_xml_with_a_curve_per_candidate_and_state(self):
        root = ElementTree.fromstring(speed_plot.svg(RESULTS))
        self.assertEqual(len(root.findall("{*}polyline")), 6)


if __name__ == "__main__":
    unittest.main()
