# SPDX-License-Identifier: GPL-3.0-or-later
"""Deformation of points between two moments, by least squares over the neighbors at the first."""
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataSet, vtkPointSet, vtkPolyData, vtkStaticPointLocator

from .common import Refused, block_named, flagged, leaves, package, texts, vtk_array

ID_NAMES = ("id", "ID", "Id", "ids", "particle_id", "GlobalIds", "GlobalNodeId", "GlobalPointIds", "vtkOriginalPointIds")
PAIRS_AT_ONCE = 1 << 22
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


def cells_of(points, size):
    """Points sorted by cells of a grid of that size, with the keys of their cells and the grid's strides."""
    cell = numpy.floor((points - points.min(0)) / size).astype(numpy.int64) + 1
    counts = cell.max(0) + 2
    strides = numpy.array([1, counts[0], counts[0] * counts[1]])
    keys = cell @ strides
    order = numpy.argsort(keys, kind="stable")
    return order, keys[order], strides


def pairs_within(points, cutoff):
    """Yields arrays i, j of pairs closer than the cutoff, each in both directions."""
    order, keys, strides = cells_of(points, cutoff)
    sorted_points = points[order]
    for offset in numpy.ndindex(3, 3, 3):
        shifted = keys + (numpy.array(offset) - 1) @ strides
        first = numpy.searchsorted(keys, shifted, "left")
        count = numpy.searchsorted(keys, shifted, "right") - first
        ends = numpy.cumsum(count)
        begin = 0
        while begin < len(points):
            done = ends[begin - 1] if begin else 0
            end = max(begin + 1, int(numpy.searchsorted(ends, done + PAIRS_AT_ONCE, "right")))
            each = count[begin:end]
            i = numpy.repeat(numpy.arange(begin, end), each)
            j = numpy.arange(each.sum()) - numpy.repeat(ends[begin:end] - each - done, each) + numpy.repeat(first[begin:end], each)
            near = (((sorted_points[i] - sorted_points[j]) ** 2).sum(1) < cutoff * cutoff) & (i != j)
            yield order[i[near]], order[j[near]]
            begin = end


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


def inverses(matrices):
    """Of symmetric 3 x 3 matrices (9, n); not-a-number where the neighbors lie in one plane."""
    matrices = matrices.T.reshape(-1, 3, 3)
    sizes = numpy.linalg.eigvalsh(matrices)
    defined = sizes[:, 0] > 1e-6 * sizes[:, 2]
    found = numpy.full_like(matrices, numpy.nan)
    found[defined] = numpy.linalg.inv(matrices[defined])
    return found


class ByNumPy:
    """Points at rest, whose neighbors are sought anew for each moment."""
    name = "NumPy (python3-sinew is not found)"

    def __init__(self, points, cutoff):
        self.points, self.cutoff = points, cutoff

    def gradients(self, now):
        """F = (sum dx dX^T) (sum dX dX^T)^-1 over neighbors at rest, and the mean of |dx - F dX|^2. Not-a-number where
        the neighbors lie in one plane. A second pass, over what the first F leaves, makes it exact to rounding."""
        rest, number = self.points, len(self.points)
        spread, F, inverse = numpy.zeros((9, number)), numpy.zeros((number, 3, 3)), None
        for _ in range(2):
            moved, squares, counts = numpy.zeros((9, number)), numpy.zeros(number), numpy.zeros(number)
            for i, j in pairs_within(rest, self.cutoff):
                at_rest, left = rest[j] - rest[i], now[j] - now[i]
                known = numpy.isfinite(left).all(1)
                i, at_rest, left = i[known], at_rest[known], left[known]
                left = left - numpy.einsum("nab,nb->na", F[i], at_rest)
                counts += numpy.bincount(i, minlength=number)
                squares += numpy.bincount(i, (left ** 2).sum(1), number)
                for a in range(3):
                    for b in range(3):
                        moved[3 * a + b] += numpy.bincount(i, left[:, a] * at_rest[:, b], number)
                        if inverse is None:
                            spread[3 * a + b] += numpy.bincount(i, at_rest[:, a] * at_rest[:, b], number)
            if inverse is None:
                inverse = inverses(spread)
            F = F + moved.T.reshape(-1, 3, 3) @ inverse
        with numpy.errstate(invalid="ignore", divide="ignore"):
            return F, numpy.where(numpy.isfinite(F[:, 0, 0]), squares / counts, numpy.nan)


class ByModule:
    """Points at rest, whose neighbors the package sinew finds once."""

    def __init__(self, module, points, cutoff):
        self.name = f"python3-sinew {module.__version__}"
        try:
            self._shape = module.RestShape(points, cutoff)
        except module.Error as error:
            raise Refused(f"{error} (property Cutoff)") from None

    def gradients(self, now):
        return self._shape.gradients(now)


class Rest:
    """The points at rest with their ids, and what is found for them once."""

    def __init__(self, data, id_array):
        self.points, self.ids = points_of(data, id_array)
        self.radius = radius_of(data, id_array)
        self._fit = None, None

    def is_like(self, other):
        return self.radius == other.radius and numpy.array_equal(self.points, other.points) and \
            numpy.array_equal(self.ids, other.ids)

    def fit(self, cutoff):
        """What finds gradients over neighbors closer than the cutoff; 0: of particles with radii those that touch, of other
        points the usual ones."""
        if self._fit[0] != cutoff:
            range_of_neighbors = cutoff or usual_cutoff(self.points, self.radius)
            module = package("RestShape")
            kind = (lambda *given: ByModule(module, *given)) if module else ByNumPy
            self._fit = cutoff, kind(self.points, range_of_neighbors)
        return self._fit[1]


def determinants(F):
    return (F[:, 0] * numpy.cross(F[:, 1], F[:, 2])).sum(1)


def deformation_arrays(F, away):
    """The arrays by name, as sinew measures them; tensors as ParaView orders them."""
    known = numpy.isfinite(F).all((1, 2))
    U, stretch, Vt = (numpy.full(shape, numpy.nan) for shape in (F.shape, F.shape[:2], F.shape))
    U[known], stretch[known], Vt[known] = numpy.linalg.svd(F[known])
    J = determinants(F)
    turn = numpy.sign(determinants(U @ Vt))
    U[:, :, 2] *= turn[:, None]
    R = U @ Vt
    C = numpy.swapaxes(F, 1, 2) @ F
    E = (C - numpy.eye(3)) / 2
    with numpy.errstate(invalid="ignore", divide="ignore"):
        log = numpy.log(stretch)
    deviator = log - log.mean(1, keepdims=True)
    cosine = (numpy.trace(R, axis1=1, axis2=2) - 1) / 2
    axial = numpy.stack([R[:, 2, 1] - R[:, 1, 2], R[:, 0, 2] - R[:, 2, 0], R[:, 1, 0] - R[:, 0, 1]], 1) / 2
    angle = numpy.degrees(numpy.arctan2(numpy.linalg.norm(axial, axis=1), cosine))
    return {"F": F.reshape(-1, 9), "J": J, "strain": numpy.stack([E[:, 0, 0], E[:, 1, 1], E[:, 2, 2], E[:, 0, 1], E[:, 1, 2], E[:, 0, 2]], 1),
            "stretch": stretch, "strain_eq": numpy.sqrt(2 / 3 * (deviator ** 2).sum(1)), "D2min": away, "R": R.reshape(-1, 9),
            "rotation": angle}


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
    now, ids = points_of(data, id_array)
    moved, place = matched(reference, now, ids)
    fit = reference.fit(cutoff)
    arrays = deformation_arrays(*fit.gradients(moved))
    fill_points(output, point_sets(data, id_array), now, arrays)
    for name, values in arrays.items():
        placed = numpy.where((place >= 0).reshape(-1, *[1] * (values.ndim - 1)), values[place], numpy.nan)
        array = vtk_array(name, placed)
        for component, label in enumerate(COMPONENTS.get(array.GetNumberOfComponents(), ())):
            array.SetComponentName(component, label)
        output.GetPointData().AddArray(array)
    output.GetFieldData().AddArray(texts("found_by", [fit.name]))
