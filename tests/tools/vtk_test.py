#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes as VTK and meshio write them, in every encoding, read by whole commands.

usage: /usr/bin/python3 vtk_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import json
import math
import os
import resource
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import meshio
import numpy
import vtk

from small_run import BIN, sinew

RADIUS = 0.5


def ran(filter_, *inputs):
    for given in inputs:
        filter_.SetInputData(given)
    filter_.Update()
    return filter_.GetOutput()


def sphere():
    source = vtk.vtkSphereSource()
    source.SetRadius(RADIUS)
    source.SetThetaResolution(24)
    source.SetPhiResolution(24)
    return ran(source)


def measures(surface):
    """Volume and area of triangles."""
    mass = vtk.vtkMassProperties()
    mass.SetInputData(ran(vtk.vtkTriangleFilter(), surface))
    return mass.GetVolume(), mass.GetSurfaceArea()


def tetrahedra():
    """Of 300 points at random, which fill their convex hull."""
    points, cloud = vtk.vtkPoints(), vtk.vtkPolyData()
    for point in numpy.random.default_rng(1).normal(size=(300, 3)):
        points.InsertNextPoint(point)
    cloud.SetPoints(points)
    return ran(vtk.vtkDelaunay3D(), cloud)


def hexahedra(cell=vtk.VTK_HEXAHEDRON):
    """Four boxes in a row along x, 1 long in all."""
    grid, points = vtk.vtkUnstructuredGrid(), vtk.vtkPoints()
    for x in range(5):
        for y, z in ((0, 0), (1, 0), (1, 1), (0, 1)):
            points.InsertNextPoint(x / 4, y / 4, z / 4)
    grid.SetPoints(points)
    order = [0, 1, 2, 3, 4, 5, 6, 7] if cell == vtk.VTK_HEXAHEDRON else [0, 1, 3, 2, 4, 5, 7, 6]
    for x in range(4):
        grid.InsertNextCell(cell, 8, [4 * x + k for k in order])
    return grid


def distances(size=40, sign=1.0):
    """Signed distances from a sphere, off the origin and with its own spacing."""
    image = vtk.vtkImageData()
    image.SetDimensions(size, size, size)
    image.SetSpacing(3 * [1.4 / (size - 1)])
    image.SetOrigin(9.3, -0.7, -0.7)
    values = vtk.vtkFloatArray()
    values.SetName("distance")
    for i in range(image.GetNumberOfPoints()):
        x, y, z = image.GetPoint(i)
        values.InsertNextValue(sign * (math.dist((x, y, z), (10, 0, 0)) - RADIUS))
    image.GetPointData().SetScalars(values)
    return image


class Vtk(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)
        self.addCleanup(self.temporary.cleanup)

    def written(self, writer, data, name):
        writer.SetFileName(str(self.folder / name))
        writer.SetInputData(data)
        self.assertEqual(writer.Write(), 1)
        return self.folder / name

    def assert_measures(self, path, expected, share=1e-5):
        info = json.loads(sinew("info", path, "--json", "--quiet", check=0).stdout)
        self.assertAlmostEqual(info["volume"], expected[0], delta=share * expected[0], msg=path.name)
        self.assertAlmostEqual(info["area"], expected[1], delta=share * expected[1], msg=path.name)
        return info

    def in_every_encoding(self, writer, data, name, expected):
        for mode in ("Ascii", "Binary", "Appended"):
            for compressor in (None, vtk.vtkZLibDataCompressor(), vtk.vtkLZ4DataCompressor()):
                for raw in (0, 1) if mode == "Appended" else (0,):
                    getattr(writer, f"SetDataModeTo{mode}")()
                    writer.SetCompressor(compressor)
                    writer.SetEncodeAppendedData(not raw)
                    self.assert_measures(self.written(writer, data, name), expected)

    def test_polygons_in_every_encoding(self):
        self.in_every_encoding(vtk.vtkXMLPolyDataWriter(), sphere(), "a.vtp", measures(sphere()))

    def test_volume_cells_in_every_encoding(self):
        ball = tetrahedra()
        expected = measures(ran(vtk.vtkDataSetSurfaceFilter(), ball))
        self.in_every_encoding(vtk.vtkXMLUnstructuredGridWriter(), ball, "a.vtu", expected)

    def test_boxes_and_voxels(self):
        for cell in (vtk.VTK_HEXAHEDRON, vtk.VTK_VOXEL):
            path = self.written(vtk.vtkXMLUnstructuredGridWriter(), hexahedra(cell), "a.vtu")
            self.assert_measures(path, (1 / 16, 1 + 1 / 8))

    def test_legacy_files_of_both_versions(self):
        ball = tetrahedra()
        outer = measures(ran(vtk.vtkDataSetSurfaceFilter(), ball))
        for version in (42, 51):
            for binary in (0, 1):
                for writer, data, expected in (
                        (vtk.vtkPolyDataWriter(), sphere(), measures(sphere())),
                        (vtk.vtkPolyDataWriter(), ran(vtk.vtkStripper(), sphere()), measures(sphere())),
                        (vtk.vtkUnstructuredGridWriter(), ball, outer),
                        (vtk.vtkUnstructuredGridWriter(), hexahedra(), (1 / 16, 1 + 1 / 8))):
                    writer.SetFileVersion(version)
                    writer.SetFileType(vtk.VTK_BINARY if binary else vtk.VTK_ASCII)
                    self.assert_measures(self.written(writer, data, "a.vtk"), expected)

    def test_level_sets_of_either_sign(self):
        exact = 4 * math.pi / 3 * RADIUS ** 3, 4 * math.pi * RADIUS ** 2
        for sign in (1.0, -1.0):
            image = distances(sign=sign)
            info = self.assert_measures(self.written(vtk.vtkXMLImageDataWriter(), image, "a.vti"), exact, 0.01)
            self.assertTrue(info["closed"])
            self.assertAlmostEqual(info["box_low"][0], 9.5, delta=1e-3)
            for binary in (0, 1):
                writer = vtk.vtkStructuredPointsWriter()
                writer.SetFileType(vtk.VTK_BINARY if binary else vtk.VTK_ASCII)
                self.assert_measures(self.written(writer, image, "a.vtk"), exact, 0.01)

    def test_a_level_set_cut_by_its_border_says_so(self):
        image = distances()
        image.SetOrigin(10, -0.7, -0.7)
        values = image.GetPointData().GetScalars()
        for i in range(image.GetNumberOfPoints()):
            values.SetValue(i, math.dist(image.GetPoint(i), (10, 0, 0)) - RADIUS)
        path = self.written(vtk.vtkXMLImageDataWriter(), image, "half.vti")
        info = self.assert_measures(path, (2 * math.pi / 3 * RADIUS ** 3, 3 * math.pi * RADIUS ** 2), 0.02)
        self.assertIn("border", " ".join(info["warnings"]))
        done = sinew("fill", path, "--radius", "0.05", "-o", self.folder / "b.vtu", check=0)
        self.assertIn("border", done.stderr)
        self.assertIn("border", sinew("new", path, "-o", self.folder / "half.yaml", check=0).stderr)

    def test_files_of_meshio(self):
        points = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], float)
        mesh = meshio.Mesh(points, [("tetra", numpy.array([[0, 1, 2, 3], [1, 2, 3, 4]])),
                                    ("triangle", numpy.array([[1, 2, 3]])), ("line", numpy.array([[0, 1]]))])
        for name, how in (("a.vtu", {"binary": True}), ("b.vtu", {"binary": False}), ("a.vtk", {"binary": True}),
                          ("b.vtk", {"binary": False})):
            mesh.write(self.folder / name, **how)
            self.assert_measures(self.folder / name, (0.5, 1.5 + 1.5 * math.sqrt(2)), 1)
            info = json.loads(sinew("info", self.folder / name, "--json", "--quiet", check=0).stdout)
            self.assertAlmostEqual(info["volume"], 0.5, places=6)

    def test_every_command_takes_them(self):
        path = self.written(vtk.vtkXMLUnstructuredGridWriter(), hexahedra(), "bar.vtu")
        scene, out = self.folder / "bar.yaml", self.folder / "out"
        sinew("fill", path, "--count", 500, "-o", self.folder / "body.vtu", check=0)
        coarsely = ["--set", "body.radius=none", "--set", "body.count=1000"]
        sinew("new", path, "-o", scene, check=0)
        sinew("check", scene, *coarsely, check=0)
        sinew("simulate", scene, "-o", out, "--quiet", *coarsely, "--set", "solver.duration=0.05", check=0)
        sinew("info", out / "surface/surface_000000.vtu", check=0)
        said = sinew("info", self.folder / "body.vtu", check=2).stderr
        self.assertIn("surface or a volume", said)
        self.assertIn("VTP, VTU, VTK, VTI", sinew("fill", "--help", check=0).stdout)

    def test_materials_of_cells_become_parts_of_the_body(self):
        """Boxes in a row, of which the last has another material."""
        for name, array, writer in (("a.vtu", "gmsh:physical", vtk.vtkXMLUnstructuredGridWriter()),
                                    ("b.vtk", "MaterialIds", vtk.vtkUnstructuredGridWriter())):
            grid, numbers = hexahedra(), vtk.vtkIntArray()
            numbers.SetName(array)
            for number in (7, 7, 7, 3):
                numbers.InsertNextValue(number)
            grid.GetCellData().AddArray(numbers)
            scene, out = self.folder / "bar.yaml", self.folder / "out"
            path = self.written(writer, grid, name)
            made = json.loads(sinew("new", path, "-o", scene, "--count", 3000, "--force", "--json", check=0).stdout)
            self.assertIn("materials", made)
            self.assert_measures(self.folder / "bar_material_3.ply", (1 / 64, 6 / 16))
            sinew("simulate", scene, "-o", out, "--force", "--quiet", "--set", "solver.duration=0.05", check=0)
            record = json.loads((out / "run.json").read_text())
            part, = (one for one in record["materials"] if one["name"] == "material 3")
            self.assertAlmostEqual(part["particles"] / record["particles"], 1 / 4, delta=0.03)
            scene.unlink()
            refused = sinew("new", path, "-o", scene, "--count", 3000, check=2).stderr
            self.assertIn("bar_material_3.ply: is there already", refused)
            self.assertFalse(scene.exists())

    def refused_within(self, megabytes, path):
        """What is said of a file by a command that may take so much memory."""
        bound = lambda: resource.setrlimit(resource.RLIMIT_AS, (megabytes * 10**6, megabytes * 10**6))
        return sinew("info", path, check=2, preexec_fn=bound).stderr

    def test_files_are_refused_by_their_first_bytes_and_by_their_size(self):
        begin = b'<?xml version="1.0"?><VTKFile type="UnstructuredGrid" byte_order="LittleEndian">'
        for name, head, size, words in (("a.vtu", b"", 3 << 30, "not a VTK XML file"), ("a.vti", b"", 3 << 30, "not a VTK XML file"),
                                        ("a.vtk", b"", 3 << 30, "no legacy VTK file"), ("b.vtu", begin, 1 << 40, "too many for the"),
                                        ("b.vtk", b"# vtk DataFile Version 3.0\n", 1 << 40, "too many for the")):
            path = self.folder / name
            path.write_bytes(head)
            os.truncate(path, size)
            self.assertRegex(self.refused_within(1000, path), f"^sinew: {path}: .*{words}.*; ")

    def test_an_image_without_a_surface_takes_the_memory_of_its_values(self):
        image = vtk.vtkImageData()
        image.SetDimensions(400, 400, 400)
        values = vtk.vtkFloatArray()
        values.SetNumberOfValues(400 ** 3)
        values.Fill(1)
        image.GetPointData().SetScalars(values)
        path = self.written(vtk.vtkXMLImageDataWriter(), image, "same.vti")
        self.assertIn("no surface is in the image: its values reach from 1 to 1", sinew("info", path, check=2).stderr)
        code = ("import resource, subprocess, sys; subprocess.run(sys.argv[1:], stdout=-3, stderr=-3); "
                "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)")  # not of this large process
        taken = subprocess.run([sys.executable, "-c", code, BIN / "sinew", "info", path], capture_output=True, text=True)
        self.assertLess(int(taken.stdout) / 1000, 12 * 400 ** 3 / 1e6 + 100)  # MB, of the array alone

    def test_a_wheel_of_many_corners_is_read_in_seconds(self):
        corners, path = 50_000, self.folder / "wheel.obj"
        places = [(math.cos(2 * math.pi * i / corners), math.sin(2 * math.pi * i / corners), z) for z in (0, 0.5)
                  for i in range(corners)]
        low = range(1, corners + 1)
        sides = [(i, i % corners + 1, corners + i % corners + 1, corners + i) for i in low]
        faces = [low[::-1], [corners + i for i in low], *sides]
        path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in places) +
                        "".join("f " + " ".join(map(str, face)) + "\n" for face in faces))
        info = json.loads(sinew("info", path, "--json", "--quiet", check=0, timeout=20).stdout)
        self.assertAlmostEqual(info["volume"], math.pi / 2, places=6)
        self.assertTrue(info["closed"])


if __name__ == "__main__":
    unittest.main(argv=["vtk_test.py"])
