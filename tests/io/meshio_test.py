# SPDX-License-Identifier: GPL-3.0-or-later
"""meshio_test.py DIR: meshio reads every VTU file of the run in DIR. Works on any run."""
import glob
import os
import sys
import unittest

import meshio

RUN = os.path.abspath(sys.argv[1])
KINDS = {"particles": "vertex", "surface": "triangle", "bones": "line", "frames": "vertex"}


def frames(series):
    return sorted(glob.glob(os.path.join(RUN, series, series + "_*.vtu")))


class Meshio(unittest.TestCase):
    def test_every_file_opens_with_the_same_counts(self):
        for series, kind in KINDS.items():
            counts = set()
            for path in frames(series):
                mesh = meshio.read(path)
                self.assertEqual([block.type for block in mesh.cells], [kind])
                counts.add((len(mesh.points), len(mesh.cells[0].data)))
            self.assertEqual(len(counts), 1, series)

    def test_particles_are_one_vertex_each_in_the_written_order(self):
        mesh = meshio.read(frames("particles")[-1])
        self.assertTrue((mesh.point_data["id"] == range(len(mesh.points))).all())
        self.assertTrue((mesh.cells[0].data[:, 0] == range(len(mesh.points))).all())
        self.assertEqual(mesh.point_data["displacement"].shape, (len(mesh.points), 3))

    def test_bones_have_four_lines_each(self):
        mesh = meshio.read(frames("bones")[0])
        self.assertEqual(len(mesh.cells[0].data), 4 * len(meshio.read(frames("frames")[0]).points))
        self.assertEqual(set(mesh.cell_data["axis"][0]), {0, 1, 2, 3})

    def test_body_is_in_double_precision(self):
        body = meshio.read(os.path.join(RUN, "body.vtu"))
        self.assertEqual(body.points.dtype, "float64")
        self.assertEqual(len(body.points), len(meshio.read(frames("particles")[0]).points))


if __name__ == "__main__":
    unittest.main(argv=["meshio_test", "-v"])
