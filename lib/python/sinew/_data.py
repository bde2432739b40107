# SPDX-License-Identifier: GPL-3.0-or-later
"""Data sets: arrays by name, and as VTK, PyVista and trimesh have them, without copies where these allow it."""
from __future__ import annotations

import warnings
from collections.abc import Iterator
from typing import Any

import numpy
from numpy.typing import NDArray

from . import _sinew
from ._error import Error
from ._values import checked

_CELL_TYPES = {1: 1, 2: 3, 3: 5, 4: 10}  # VTK's numbers by points per cell: vertex, line, triangle, tetrahedron


def _wanted(module, what):
    try:
        return __import__(module)
    except ImportError:
        raise Error(f"{module} is not installed, which {what} needs; install it, or use the arrays") from None


def trimesh_of(vertices, faces):
    return _wanted("trimesh", "to_trimesh()").Trimesh(vertices, faces, process=False)


def pyvista_of(data):
    return _wanted("pyvista", "to_pyvista()").wrap(data)


def vtk_array(values, name, unit=""):
    """A VTK array on the same memory."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkDataArray
    array = numpy_to_vtk(numpy.ascontiguousarray(values))
    array.SetName(name)
    if unit:
        array.GetInformation().Set(vtkDataArray.UNITS_LABEL(), unit)
    return array


def vtk_grid(points, blocks, point_arrays, cell_arrays=(), field_arrays=(), units={}):
    """A vtkUnstructuredGrid of cells in blocks of one size each."""
    _wanted("vtkmodules", "to_vtk()")
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid
    grid, places, cells = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    places.SetData(vtk_array(points, "Points", "m"))
    grid.SetPoints(places)
    sizes = numpy.concatenate([numpy.full(len(block), block.shape[1]) for block in blocks])
    corners = numpy.concatenate([block.ravel() for block in blocks]).astype(numpy.int64)
    offsets = numpy.concatenate([[0], numpy.cumsum(sizes)]).astype(numpy.int64)
    cells.SetData(_ids(offsets), _ids(corners))
    kinds = numpy.array([0, *(_CELL_TYPES[i] for i in range(1, 5))], numpy.uint8)[sizes]
    grid.SetCells(vtk_array(kinds, "types"), cells)
    for attributes, arrays in ((grid.GetPointData(), point_arrays), (grid.GetCellData(), cell_arrays),
                               (grid.GetFieldData(), field_arrays)):
        for name, values in dict(arrays).items():
            attributes.AddArray(vtk_array(values, name, units.get(name, "")))
    return grid


def _ids(values):
    """A copy: vtkCellArray shares the memory of such arrays without keeping it."""
    from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray
    return numpy_to_vtkIdTypeArray(values, deep=1)


def particles_of_body(body):
    """The particles of a Body: a vertex each, with the arrays of body.vtu."""
    number = len(body)
    arrays = {"id": numpy.arange(number, dtype=numpy.int32), "radius": numpy.full(number, body.radius),
              "mass": numpy.full(number, body.mass)}
    arrays.update({name: getattr(body, name) for name in ("neighbors", "component") if len(getattr(body, name))})
    return vtk_grid(body.points, [numpy.arange(number).reshape(-1, 1)], arrays, units={"radius": "m", "mass": "kg"})


def tell_unknown(values, name, told):
    """The values; warns once where some of the particles have none."""
    unknown = numpy.isnan(values).reshape(len(values), -1).any(1).sum() if values.dtype.kind == "f" and len(values) else 0
    if unknown and name not in told:
        told.add(name)
        warnings.warn(f"{name} is not-a-number for {unknown} of {len(values)} particles: they have too few neighbors at rest to "
                      "be strained, are inverted, or have no bone; leave them out (numpy.nanmax), or make the radius smaller",
                      RuntimeWarning, stacklevel=4)
    return values


class Dataset:
    """One series at one moment, as its file has it: what dataset(), run.frames("surface") and tetrahedra() return.

    `series` names it, `time` (s) is the moment. data["stress"] is an array of the points, or else of the cells or the whole.
    All are views, not writable."""

    series: str
    time: float

    def __init__(self, data, series, time=None):
        self._native, self.series = data, series
        self.time = data.time if time is None else time

    @property
    def points(self) -> NDArray[numpy.float64]:
        """Positions of the points (n, 3), m."""
        return self._native.points

    @property
    def cells(self) -> NDArray[numpy.int32]:
        """Points of each cell: (m, 1) vertices, (m, 2) lines, (m, 3) triangles or (m, 4) tetrahedra."""
        return self._native.cells

    @property
    def lines(self) -> NDArray[numpy.int32]:
        """Points of the lines that follow the cells (k, 2); mostly none."""
        return self._native.lines

    @property
    def point_arrays(self) -> dict[str, NDArray[Any]]:
        """Arrays of the points by name, a row for each."""
        return self._native.point_arrays

    @property
    def cell_arrays(self) -> dict[str, NDArray[Any]]:
        """Arrays of the cells by name, a row for each; lines follow the cells."""
        return self._native.cell_arrays

    @property
    def field_arrays(self) -> dict[str, NDArray[Any]]:
        """Values of the whole by name: energies (J), ..."""
        return self._native.field_arrays

    @property
    def units(self) -> dict[str, str]:
        """Units of the arrays, by name; "1": a pure number."""
        return _sinew._units(self.series, self._native)

    def keys(self) -> list[str]:
        """Names of all arrays: of points, cells and the whole."""
        return [*self.point_arrays, *self.cell_arrays, *self.field_arrays]

    def __contains__(self, name: object) -> bool:
        return name in self.keys()

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    @checked
    def __getitem__(self, name: str) -> NDArray[Any]:
        for arrays in (self.point_arrays, self.cell_arrays, self.field_arrays):
            if name in arrays:
                return arrays[name]
        raise Error(f"{self.series} have no array {name!r}; take one of {', '.join(self.keys())}")

    def __repr__(self):
        return (f"<sinew.Dataset {self.series} at {self.time:.6g} s: {len(self.points)} points, "
                f"{len(self.cells) + len(self.lines)} cells; {', '.join(self.keys())}>")

    def to_vtk(self) -> Any:
        """A vtkUnstructuredGrid on the same arrays."""
        blocks = [block for block in (self.cells, self.lines) if len(block)] or [self.cells]
        return vtk_grid(self.points, blocks, self.point_arrays, self.cell_arrays,
                        {**self.field_arrays, "TimeValue": numpy.array([self.time])}, self.units)

    def to_pyvista(self) -> Any:
        """A pyvista.UnstructuredGrid on the same arrays. Raises Error where pyvista is not installed."""
        return pyvista_of(self.to_vtk())


def vtk_composite(datasets):
    """A vtkMultiBlockDataSet of named data sets."""
    _wanted("vtkmodules", "to_vtk()")
    from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkMultiBlockDataSet
    blocks = vtkMultiBlockDataSet()
    for index, (name, data) in enumerate(datasets.items()):
        blocks.SetBlock(index, data.to_vtk())
        blocks.GetMetaData(index).Set(vtkCompositeDataSet.NAME(), name)
    return blocks
