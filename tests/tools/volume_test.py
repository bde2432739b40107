#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tetrahedra of meshes and of runs, as other programs read them.

usage: volume_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import json
import re
import shutil
import signal
import subprocess
import sys
import unittest

import meshio
import numpy

from small_run import BIN, SOURCE, SmallRun, sinew

BREAKING = ["--set", "material.model=bonded", "--set", "material.breaking_strain=0.1"]


def cells_of(mesh):
    return mesh.cells_dict["tetra"]


def volumes_of(mesh):
    a, b, c, d = (mesh.points[cells_of(mesh)[:, k]].astype(float) for k in range(4))
    return numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / 6


class Meshes(SmallRun):
    def fill(self, name, *words, check=0):
        target = self.folder / name
        done = sinew("fill", SOURCE / "data/meshes/arm.ply", "--count", 5000, "--to", "tetrahedra", "-o", target,
                     "--json", *words, check=check)
        return done, target

    def test_every_format_has_the_same_cells(self):
        done, target = self.fill("arm.vtu")
        report = json.loads(done.stdout)
        first = meshio.read(target)
        volumes = volumes_of(first)
        self.assertGreater(volumes.min(), 0)
        self.assertEqual(len(volumes), report["tetrahedra"])
        self.assertAlmostEqual(volumes.sum() / report["volume"], 1, 9)
        self.assertAlmostEqual(volumes.sum() / 0.0025228, 1, 2)
        self.assertGreater(report["smallest_angle"], 8)
        for name in ("arm.msh", "arm.mesh", "arm.inp"):
            with self.subTest(name):
                other = meshio.read(self.fill(name)[1])
                self.assertTrue((cells_of(other) == cells_of(first)).all())
                self.assertLess(abs(other.points - first.points).max(), 1e-10)
        self.assertTrue((meshio.read(self.folder / "arm.msh").point_data["id"] == first.point_data["id"]).all())
        self.assertTrue((meshio.read(self.folder / "arm.mesh").point_data["medit:ref"] - 1
                         == first.point_data["id"]).all())
        nodes = meshio.read(self.folder / "arm.inp").point_sets["PARTICLES"]
        self.assertEqual(list(nodes), list(numpy.flatnonzero(first.point_data["id"] >= 0)))

    def test_warnings_are_in_the_json(self):
        text = (SOURCE / "data/meshes/box.obj").read_text()
        (self.folder / "open.obj").write_text(text[:text.rstrip().rfind("\n")] + "\n")  # without its last face
        found = sinew("fill", self.folder / "open.obj", "--radius", 0.03, "--to", "tetrahedra", "--json", cwd=self.folder, check=0)
        warnings = json.loads(found.stdout)["warnings"]
        self.assertTrue(warnings)
        self.assertIn(warnings[0], found.stderr)

    def test_the_ending_chooses_the_format(self):
        for name in ("arm.lammps", "arm", "arm.data"):
            done, target = self.fill(name, check=2)
            self.assert_one_line(done, 2, name, ".vtu, .msh, .mesh or .inp")
            self.assertFalse(target.exists())
        self.assertEqual(self.fill("arm.MSH")[1].read_bytes(), self.fill("arm.msh")[1].read_bytes())

    def test_particles_are_where_the_body_has_them(self):
        _, target = self.fill("arm.vtu")
        cells = meshio.read(target)
        sinew("fill", SOURCE / "data/meshes/arm.ply", "--count", 5000, "-o", self.folder / "body.vtu", check=0)
        body = meshio.read(self.folder / "body.vtu")
        ids = cells.point_data["id"]
        kept = ids >= 0
        self.assertGreater(kept.sum(), 3000)
        self.assertTrue((cells.points[kept] == body.points[ids[kept]]).all())

    def test_other_endings_are_refused(self):
        done, target = self.fill("arm.stl", check=2)
        self.assert_one_line(done, 2, "arm.stl", ".vtu, .msh, .mesh or .inp")
        self.assertFalse(target.exists())


class Runs(SmallRun):
    def frames(self, folder):
        files = re.findall(r'file="([^"]*)"', (folder / "volume.pvd").read_text())
        return [folder / file for file in files]

    def test_a_run_writes_what_is_exported_afterwards(self):
        for words in ([], ["--set", "output.bonds=true", *BREAKING]):
            with self.subTest(words):
                self.simulate("--force", "--set", "output.volume=true", *words)
                other = self.folder / "other"
                sinew("export", self.out, "--to", "volume", "-o", other, check=0)
                self.assertEqual((self.out / "volume.pvd").read_text(), (other / "volume.pvd").read_text())
                for own, exported in zip(self.frames(self.out), self.frames(other)):
                    self.assertEqual(own.read_bytes(), exported.read_bytes(), own)
                shutil.rmtree(other)

    def test_cells_have_the_arrays_of_particles(self):
        self.simulate("--set", "output.volume=true", "--set", "output.arrays=stress")
        particles = sorted((self.out / "particles").iterdir())
        for file, of_particles in zip(self.frames(self.out), particles):
            cells, body = meshio.read(file), meshio.read(of_particles)
            self.assertEqual(set(cells.point_data), set(body.point_data))
            ids = cells.point_data["id"]
            kept = ids >= 0
            self.assertTrue((cells.points[kept] == body.points[ids[kept]]).all())
            for name, values in body.point_data.items():
                self.assertTrue(numpy.array_equal(cells.point_data[name][kept], values[ids[kept]], equal_nan=True), name)
        first, last = (volumes_of(meshio.read(self.frames(self.out)[k])) for k in (0, -1))
        J = meshio.read(self.frames(self.out)[-1]).cell_data["J"][0]
        self.assertLess(abs(last / first - J).max(), 2e-3)  # volumes of Float32
        self.assertTrue((meshio.read(self.frames(self.out)[0]).cell_data["torn"][0] == 0).all())
        self.assertEqual(sinew("info", self.out, "--verify").returncode, 0)
        self.assertIn("volume/volume_000000.vtu", (self.out / "checksums.sfv").read_text())
        self.assertIn("torn", self.record()["arrays"]["volume"])

    def test_broken_bonds_tear_cells(self):
        self.simulate("--set", "output.volume=true", "--set", "output.bonds=true", *BREAKING)
        file = self.frames(self.out)[-1]
        cells, bonds = meshio.read(file), meshio.read(self.out / "bonds" / file.name.replace("volume", "bonds"))
        lines = bonds.cells_dict["line"][bonds.cell_data["broken"][0] == 1]
        self.assertGreater(len(lines), 10)
        broken = set(map(tuple, lines.tolist()))
        torn = cells.cell_data["torn"][0]
        ids = cells.point_data["id"][cells_of(cells)]
        for row, is_torn in zip(ids, torn):
            pairs = {(min(i, j), max(i, j)) for i in row for j in row if i >= 0 and j >= 0}
            if pairs & broken:
                self.assertEqual(is_torn, 1)
            elif (row >= 0).all():
                self.assertEqual(is_torn, 0)

    def test_export_into_a_run_is_listed_and_removed_with_it(self):
        self.simulate()
        self.assertFalse((self.out / "volume.pvd").exists())
        done = sinew("export", self.out, "--to", "volume", "--json", check=0)
        self.assertEqual(json.loads(done.stdout)["frames"], len(self.frames(self.out)))
        self.assertIn("volume.pvd", (self.out / "checksums.sfv").read_text())
        self.assertIn("volume.vtu.series", (self.out / "checksums.sfv").read_text())
        self.assertEqual(sinew("info", self.out, "--verify").returncode, 0)
        self.simulate("--force")
        self.assertEqual(list(self.out.glob("volume.*")), [])
        self.assertFalse((self.out / "volume").exists() and list((self.out / "volume").iterdir()))

    def test_a_killed_run_goes_on_with_the_same_cells(self):
        words = ["--set", "output.volume=true", "--set", "output.checkpoint_interval=0",
                 "--set", "output.interval=0.02"]
        self.simulate(*words)
        expected = [file.read_bytes() for file in self.frames(self.out)]
        self.simulate("--force", *words)
        child = subprocess.Popen([BIN / "sinew", "simulate", self.scene, "-o", self.out, "--force", "--quiet", *words])
        self.wait_for(child, "volume/volume_000005.vtu")
        child.send_signal(signal.SIGKILL)
        child.wait()
        sinew("simulate", self.scene, "-o", self.out, "--resume", *words, check=0)
        self.assertEqual([file.read_bytes() for file in self.frames(self.out)], expected)
        self.assertEqual(sinew("info", self.out, "--verify").returncode, 0)

    def test_parts_of_a_body_have_no_cells(self):
        done = sinew("simulate", self.scene, "-o", self.out, "--set", "output.volume=true",
                     "--set", "output.inside_every=2")
        self.assert_one_line(done, 2, "all of its particles")


if __name__ == "__main__":
    unittest.main(argv=["volume_test", "-v", *sys.argv[3:]])
