#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the shipped scenes must show, read from the files of a run.

usage: scene_test.py RUN      a run of configs/box_bend.yaml or configs/box_twist.yaml
"""
import csv
import json
import sys
import unittest
from pathlib import Path

RUN = Path(sys.argv[1])
ROWS = [{key: float(value) for key, value in row.items()}
        for row in csv.DictReader((RUN / "metrics.csv").open())]
RECORD = json.loads((RUN / "run.json").read_text())
RADIUS = RECORD["radius"]


def at(time):
    return min(ROWS, key=lambda row: abs(row["time"] - time))


class PaperBox(unittest.TestCase):
    def test_is_the_papers_body(self):
        self.assertEqual(RECORD["particles"], 2965)
        self.assertGreaterEqual(len(ROWS), 30)

    def test_energy_balance_closes(self):
        work = max(abs(row["work_of_bones"]) for row in ROWS)
        self.assertLess(max(abs(row["energy_residual"]) for row in ROWS), 0.005 * work)

    def test_steps_are_within_the_limit(self):
        self.assertLessEqual(RECORD["time_step_factor"], 0.5)


@unittest.skipUnless(RUN.name == "box_bend", "for the bend")
class Bend(unittest.TestCase):
    def test_hold_lies_near_the_rigid_pose(self):
        hold = at(1.5)
        self.assertLess(hold["pose_error_far_rms"], 2 * RADIUS)
        self.assertLess(abs(hold["tip_angle"] - 90), 1)
        self.assertLessEqual(hold["inverted"], 3)

    def test_hold_settles(self):
        settled = json.loads((RUN / "metrics.json").read_text())["run"]["settling_time"]["value"]
        self.assertLessEqual(settled, 0.5)

    def test_the_papers_body_flows_a_little(self):
        self.assertLess(at(1.5)["broken_neighbors"], 0.04)
        self.assertGreater(at(1.5)["broken_neighbors"], 0.02)
        self.assertLess(ROWS[-1]["displacement_rms"], 0.7 * RADIUS)

    def test_volume_is_nearly_kept(self):
        self.assertLess(max(row["volume_error"] for row in ROWS), 0.03)


@unittest.skipUnless(RUN.name == "box_twist", "for the twist")
class Twist(unittest.TestCase):
    def test_tip_follows_and_nothing_is_cut(self):
        end = ROWS[-1]
        self.assertLess(abs(end["tip_angle"] - 90), 1)
        self.assertLess(max(row["twist_jump_max"] for row in ROWS), 5)
        self.assertLess(max(row["broken_neighbors"] for row in ROWS), 0.01)


if __name__ == "__main__":
    unittest.main(argv=["scene_test", "-v"])
