# SPDX-License-Identifier: GPL-3.0-or-later
"""Deformation of points between two moments, by the Python package sinew."""
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataSet, vtkPointSet, vtkPolyData, vtkStaticPointLocator

from .common import Refused, block_named, flagged, leaves, package, texts, vtk_array

ID_NAMES = ("id", "ID", "Id", "ids", "particle_id", "GlobalIds", "GlobalNodeId", "GlobalPointIds", "vtkOriginalPointIds")
FARTHEST = 1e100  # products of three coordinates remain numbers


def ids_of(data, id_array):
    """The array of that name, or without a name one that usually has ids; None: there is none."""
    found = [data.GetPointData().GetAbstractArray(name) for name in ([id_array] if id_array else ID_NAMES)]
    return next((array for array in found if array), None if id_array else data.GetPointData().GetGlobalIds())


def values_of(array):
    """Ids as whole numbers of one type, other numbers, or texts."""
    if array.GetNumberOfComponents() != 1:
        raise Refused(f"the array {array.GetName()} has {array.GetNumberOfComponents()} numbers for each point; set IdArray to one "
                      "that tells points apart")
    if isinstance(array, vtkStringArray):
        return numpy.array([array.GetValue(i) for i in range(array.GetNumberOfValues())])
    values = vtk_to_numpy(array)
    return values.astype(numpy.int64) if values.dtype.kind in "iu" else values


def without_copies(data):
    """The data set, or its points and their arrays without those that are copies of another piece's."""
    copies = flagged(data.GetPointData(), data.GetNumberOfPoints(), 1)
    if not copies.any():
        return data
    own, places, of, to = vtkPolyData(), vtkPoints(), vtkIdList(), vtkIdList()
    places.SetDataTypeToDouble()
    for point in numpy.flatnonzero(~copies):
        to.InsertNextId(places.InsertNextPoint(data.GetPoint(int(point))))
        of.InsertNextId(int(point))
    own.SetPoints(places)
    own.GetPointData().CopyAllOn()
    own.GetPointData().CopyAllocate(data.GetPointData(), of.GetNumberOfIds())
    own.GetPointData().CopyData(data.GetPointData(), of, to)
    return own


def point_sets(data, id_array):
    """The data sets whose points count: of a run the particles, of other composites those with ids, or all; without
    copies of another piece's points."""
    particles = block_named(data, "particles")
    every = [leaf for leaf in leaves(data) if isinstance(leaf, vtkDataSet) and leaf.GetNumberOfPoints()]
    if particles and particles in every:
        every = [particles]
    sets = [one for one in map(without_copies, every) if one.GetNumberOfPoints()]
    if not sets:
        raise Refused("the input has no points; of a table, apply Table To Points first")
    with_ids = [one for one in sets if ids_of(one, id_array)]
    if id_array and not with_ids:
        raise Refused(f"there is no array {id_array} of points; set IdArray to the one that tells points apart, or to nothing")
    return with_ids or sets


def points_of(data, id_array):
    """Positions and ids of all points; no ids where they have none."""
    positions, ids = [], []
    for one in point_sets(data, id_array):
        if isinstance(one, vtkPointSet):
            positions.append(vtk_to_numpy(one.GetPoints().GetData()).astype(float))
        else:
            positions.append(numpy.array([one.GetPoint(i) for i in range(one.GetNumberOfPoints())]))
        found = ids_of(one, id_array)
        ids.append(values_of(found) if found else None)
    positions = numpy.concatenate(positions)
    if not (abs(positions) < FARTHEST).all():
        raise Refused("the coordinates of a point are too large or not finite; remove such points (Threshold)")
    if ids[0] is None:
        return positions, None
    ids = numpy.concatenate(ids)
    if len(numpy.unique(ids)) != len(ids):
        raise Refused("several points have the same id; each needs one of its own")
    return positions, ids


def radius_of(data, id_array):
    """The largest radius of particles; 0: they have none."""
    radii = [one.GetPointData().GetArray("radius") for one in point_sets(data, id_array)]
    largest = max(array.GetRange()[1] if array and array.GetNumberOfComponents() == 1 else 0 for array in radii)
    return largest if numpy.isfinite(largest) else 0


def usual_cutoff(points, radius):
    """2.4 times the radius of particles that touch; of other points 1.2 times the usual distance of the twelfth nearest."""
    cloud, places = vtkPolyData(), vtkPoints()
    places.SetData(numpy_to_vtk(points, deep=1))
    cloud.SetPoints(places)
    locator, found = vtkStaticPointLocator(), vtkIdList()
    locator.SetDataSet(cloud)
    locator.BuildLocator()
    nearest, farthest = [], []
    for i in range(0, len(points), max(1, len(points) // 2000)):
        locator.FindClosestNPoints(13, points[i], found)
        near = points[[found.GetId(k) for k in range(found.GetNumberOfIds())]]
        distances = numpy.sort(numpy.linalg.norm(near - points[i], axis=1))
        nearest.append(distances[min(1, len(distances) - 1)])
        farthest.append(distances[-1])
    if 0.8 * numpy.median(nearest) < 2 * radius < 1.25 * numpy.median(nearest):
        return 2.4 * radius
    usual = float(numpy.median(farthest))
    if not usual > 0:
        raise Refused("the points lie upon each other at rest; set Cutoff to the range of neighbors")
    return 1.2 * usual


class Rest:
    """The points at rest with their ids, and what is found for them once."""

    def __init__(self, data, id_array):
        self.points, self.ids = points_of(data, id_array)
        self.radius = radius_of(data, id_array)
        self._shape = None, None

    def is_like(self, other):
        return self.radius == other.radius and numpy.array_equal(self.points, other.points) and \
            numpy.array_equal(self.ids, other.ids)

    def shape(self, module, cutoff):
        """With neighbors closer than the cutoff; 0: of particles with radii those that touch, of other points the usual
        ones."""
        if self._shape[0] != cutoff:
            try:
                self._shape = cutoff, module.RestShape(self.points, cutoff or usual_cutoff(self.points, self.radius))
            except module.Error as error:
                raise Refused(f"{error} (property Cutoff)") from None
        return self._shape[1]


COMPONENTS = {9: ("XX", "XY", "XZ", "YX", "YY", "YZ", "ZX", "ZY", "ZZ"), 6: ("XX", "YY", "ZZ", "XY", "YZ", "XZ"), 3: ("1", "2", "3")}


def fill_points(output, sets, positions, names):
    """The points of the input as vertices, with the arrays that all its data sets have; those that have one of these names
    become NAME_of_input."""
    places, cells = vtkPoints(), vtkCellArray()
    places.SetData(numpy_to_vtk(positions, deep=1))
    output.SetPoints(places)
    number = len(positions)
    cells.SetData(numpy_to_vtkIdTypeArray(numpy.arange(number + 1), deep=1), numpy_to_vtkIdTypeArray(numpy.arange(number), deep=1))
    output.SetCells(1, cells)
    first = sets[0].GetPointData()
    for name in [first.GetArrayName(i) for i in range(first.GetNumberOfArrays())]:
        arrays = [one.GetPointData().GetAbstractArray(name) for one in sets]
        if None in arrays or len({(type(array), array.GetNumberOfComponents()) for array in arrays}) > 1:
            continue
        together = arrays[0].NewInstance()
        together.DeepCopy(arrays[0])
        for array in arrays[1:]:
            together.InsertTuples(together.GetNumberOfTuples(), array.GetNumberOfTuples(), 0, array)
        together.SetName(f"{name}_of_input" if name in names else name)
        output.GetPointData().AddArray(together)


def matched(reference, now, ids):
    """Places of the reference's points now, and of each present point in the reference; -1: it was not there."""
    rest, rest_ids = reference.points, reference.ids
    if (ids is None) != (rest_ids is None):
        raise Refused(f"only the points {'at rest' if ids is None else 'of the later moment'} have ids; give ids to both, or "
                      "to neither (Pass Arrays), to match them by their order")
    if ids is None:
        if len(rest) != len(now):
            raise Refused(f"there are {len(rest)} points at rest and {len(now)} later, and no ids (an array `id`) to match them by")
        return now, numpy.arange(len(now))
    if (ids.dtype.kind == "U") != (rest_ids.dtype.kind == "U"):
        raise Refused("ids are numbers at one moment and texts at the other; give the same to both")
    order = numpy.argsort(rest_ids)
    at = numpy.minimum(numpy.searchsorted(rest_ids[order], ids), len(order) - 1)
    place = numpy.where(rest_ids[order][at] == ids, order[at], -1)
    if not (place >= 0).any():
        raise Refused("no id is in both moments; set IdArray to the array that tells points apart")
    moved = numpy.full_like(rest, numpy.nan)
    moved[place[place >= 0]] = now[place >= 0]
    return moved, place


def add_deformation(output, reference, data, cutoff, id_array):
    """The points of `data` with what has happened to them since the reference."""
    if cutoff < 0:
        raise Refused("the cutoff is below 0; give 0, or the range of neighbors")
    module = package("RestShape")
    if module is None:
        raise Refused("the Python package sinew is not found; install python3-sinew, or name its folder in PYTHONPATH")
    now, ids = points_of(data, id_array)
    moved, place = matched(reference, now, ids)
    arrays = reference.shape(module, cutoff).arrays(moved)
    fill_points(output, point_sets(data, id_array), now, arrays)
    for name, values in arrays.items():
        placed = numpy.where((place >= 0).reshape(-1, *[1] * (values.ndim - 1)), values[place], numpy.nan)
        array = vtk_array(name, placed)
        for component, label in enumerate(COMPONENTS.get(array.GetNumberOfComponents(), ())):
            array.SetComponentName(component, label)
        output.GetPointData().AddArray(array)
    output.GetFieldData().AddArray(texts("found_by", [f"python3-sinew {module.__version__}"]))
