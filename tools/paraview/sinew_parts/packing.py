# SPDX-License-Identifier: GPL-3.0-or-later
"""Closest packings of polygons, by the Python package sinew or by the command."""
import json
import os
import shutil
import subprocess
import tempfile

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_DOUBLE, vtkDoubleArray, vtkIdList, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkDataSet, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkImplicitPolyDataDistance, vtkTriangleFilter
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridReader

try:
    from vtkmodules.vtkFiltersCore import vtkExtractCells
except ImportError:  # before VTK 9.2
    from vtkmodules.vtkFiltersExtraction import vtkExtractCells

from .common import Refused, flagged, leaves, package, texts, vtk_array

PACKINGS = ("fcc", "hcp", "random", "conformal")
RULES = ("union", "hollow")


def triangles_of(polygons):
    cut = vtkTriangleFilter()
    cut.SetInputData(polygons)
    cut.PassVertsOff()
    cut.PassLinesOff()
    cut.Update()
    return cut.GetOutput()


def without_ghosts(data):
    """The data set without cells that are copies of another piece's (1) or hidden (32), and their number."""
    left_out = flagged(data.GetCellData(), data.GetNumberOfCells(), 33)
    if not left_out.any() or left_out.all():
        return (vtkPolyData() if left_out.any() else data), int(left_out.sum())
    own, ids = vtkExtractCells(), vtkIdList()
    for cell in numpy.flatnonzero(~left_out):
        ids.InsertNextId(int(cell))
    own.SetInputData(data)
    own.SetCellList(ids)
    own.Update()
    grid = own.GetOutput()
    grid.GetCellData().RemoveArray("vtkGhostType")
    # Pieces may have points of their own where they meet.
    places = vtk_to_numpy(grid.GetPoints().GetData())
    first, inverse = numpy.unique(places, axis=0, return_index=True, return_inverse=True)[1:]
    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    corners[:] = first[inverse.ravel()][corners]
    return grid, int(left_out.sum())


def polygons_of(data):
    """All polygons of any data, in one vtkPolyData of double precision, and what is told of them."""
    append, left_out = vtkAppendPolyData(), 0
    append.SetOutputPointsPrecision(1)  # VTK's DOUBLE_PRECISION
    for leaf in leaves(data):
        if not isinstance(leaf, vtkDataSet) or not leaf.GetNumberOfCells():
            continue
        leaf, ghosts = without_ghosts(leaf)
        left_out += ghosts
        if not leaf.GetNumberOfCells():
            continue
        if not isinstance(leaf, vtkPolyData):
            outside = vtkGeometryFilter()
            outside.SetInputData(leaf)
            outside.Update()
            leaf = outside.GetOutput()
        if leaf.GetStrips().GetNumberOfCells():
            leaf = triangles_of(leaf)
        bare = vtkPolyData()
        bare.SetPoints(leaf.GetPoints())
        bare.SetPolys(leaf.GetPolys())
        append.AddInputData(bare)
    if not append.GetNumberOfInputConnections(0):
        raise Refused("the input has no polygons; give a surface, or a grid that has one (Extract Surface)")
    append.Update()
    merged = append.GetOutput()
    if not merged.GetNumberOfPolys():
        raise Refused("the input has no polygons; give a surface, or a grid that has one (Extract Surface)")
    if merged.GetPoints().GetDataType() != VTK_DOUBLE:
        points = vtkPoints()
        points.SetDataTypeToDouble()
        points.DeepCopy(merged.GetPoints())
        merged.SetPoints(points)
    told = f"cells that are left out, as copies of another piece's (ghosts) or hidden: {left_out}"
    return merged, [told] if left_out else []


class ByModule:
    """Fills by the package sinew."""

    def __init__(self, module):
        self.module = module
        self.name = f"python3-sinew {module.__version__}"

    def fill(self, mesh, options, tetrahedra):
        try:
            body = self.module.fill(mesh, **options)
            grid = self.module.tetrahedra(mesh, **options).to_vtk() if tetrahedra else body.to_vtk()
            if not tetrahedra:
                grid.GetPointData().AddArray(vtk_array("distance", self.module.distance(mesh, body.points)))
            return grid, body.report, body.warnings
        except self.module.Error as error:
            raise Refused(error) from None

    def diagnose(self, mesh, options):
        try:
            found = self.module.diagnose(mesh, **options)
            return found.to_vtk(), dict(found), found.warnings
        except self.module.Error as error:
            raise Refused(error) from None


class ByCommand:
    """Fills by the command sinew, through files."""

    def __init__(self, path):
        self.path = path
        self.name = f"command {path}"

    def _run(self, *words):
        try:
            done = subprocess.run([self.path, *words, "--json", "--quiet"], capture_output=True, text=True, errors="replace")
        except OSError as error:
            raise Refused(f"{self.path}: {error.strerror}; set SINEW to the path of the command sinew") from None
        if done.returncode:
            lines = [line for line in done.stderr.splitlines() if line.startswith("sinew: ")] or [done.stderr or "it failed"]
            raise Refused(lines[-1].removeprefix("sinew: "))
        try:
            return json.loads(done.stdout)
        except ValueError:
            raise Refused(f"{self.path} does not answer as sinew does; set SINEW to the path of the command sinew") from None

    @staticmethod
    def _read(path):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(path)
        reader.Update()
        return reader.GetOutput()

    @staticmethod
    def _flags(options):
        words = []
        for key, value in options.items():
            flag = "--" + key.replace("_", "-")
            words += [flag] if value is True else [f"{flag}={value}"]
        return words

    def fill(self, mesh, options, tetrahedra):
        with tempfile.TemporaryDirectory(prefix="sinew-") as folder:
            given, filled = os.path.join(folder, "mesh.vtp"), os.path.join(folder, "filled.vtu")
            write_polygons(mesh, given)
            kind = ["--to", "tetrahedra"] if tetrahedra else []
            report = self._run("fill", given, *self._flags(options), *kind, "-o", filled)
            warnings = report.pop("warnings", [])
            report.pop("file", None)
            grid = self._read(filled)
            if not tetrahedra:
                grid.GetPointData().AddArray(distances(grid.GetPoints(), mesh))
            return grid, report, warnings

    def diagnose(self, mesh, options):
        with tempfile.TemporaryDirectory(prefix="sinew-") as folder:
            given, drawn = os.path.join(folder, "mesh.vtp"), os.path.join(folder, "defects.vtu")
            write_polygons(mesh, given)
            found = self._run("info", given, *self._flags(options), "-o", drawn)
            warnings = found.pop("warnings", [])
            for key in ("file", "drawing"):
                found.pop(key, None)
            return self._read(drawn), found, warnings


def distances(points, mesh):
    """Distances of points from a mesh, by VTK."""
    surface, away = vtkImplicitPolyDataDistance(), vtkDoubleArray()
    surface.SetInput(triangles_of(mesh))
    surface.FunctionValue(points.GetData(), away)
    return vtk_array("distance", abs(vtk_to_numpy(away)))


def write_polygons(mesh, path):
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(path)
    writer.SetInputData(mesh)
    writer.SetDataModeToBinary()
    if not writer.Write() or writer.GetErrorCode():
        raise Refused(f"{path}: cannot be written; free some space")


def engine():
    module = package("diagnose")
    if module:
        return ByModule(module)
    command = os.environ.get("SINEW") or shutil.which("sinew")
    if command:
        return ByCommand(command)
    raise Refused("neither the Python package sinew nor the command sinew is found; install python3-sinew or sinew, or set "
                  "SINEW to the path of the command")


def add_findings(data, findings, warnings, engine_name):
    """As field data: numbers by their names, the rest in a text."""
    fields = data.GetFieldData()
    for key, value in findings.items():
        if isinstance(value, (bool, int, float)):
            fields.AddArray(vtk_array(key, numpy.array([float(value)])))
        elif isinstance(value, list) and value and all(isinstance(one, (int, float)) for one in value):
            fields.AddArray(vtk_array(key, numpy.array([value], float)))
    fields.AddArray(texts("report", [json.dumps(findings)]))
    fields.AddArray(texts("warnings", warnings))
    fields.AddArray(texts("found_by", [engine_name]))
