# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of a run: its series, read by ParaView's own reader, and its tables."""
import csv
import io
import json
import math
import os
import xml.etree.ElementTree as ET

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_DOUBLE, VTK_FLOAT, vtkDataArray, vtkDataArraySelection
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from .common import Refused

TABLES = ("metrics", "bones", "supports", "probes")
OWNERS = ("bone", "name")  # columns that say whose a row is


def is_own(path, folder):
    """Whether it is a regular file below a folder, wherever links lead: others may block, or be somebody else's."""
    real = os.path.realpath(path)
    return real.startswith(os.path.join(os.path.realpath(folder), "")) and os.path.isfile(real)


def damaged(path, why):
    return Refused(f"{path}: {getattr(why, 'strerror', None) or why}; restore it from a copy, or run the scene again")


def checked(path):
    """A file of a run's folder. Refused where it is no regular file, or leads out of the folder."""
    if not is_own(path, os.path.dirname(path)):
        raise damaged(path, "is no regular file of this folder")
    return path


def rows_of(pvd):
    """Times and files that a PVD names; none where it is not there."""
    if not os.path.lexists(pvd):
        return []
    try:
        rows = [(row.get("timestep"), row.get("file")) for row in ET.parse(checked(pvd)).getroot().iter("DataSet")]
    except (OSError, ET.ParseError, LookupError, ValueError) as error:  # the last two: of its encoding
        raise damaged(pvd, error) from None
    times = [number(time or "none") for time, _ in rows]
    if not all(file and time is not None and math.isfinite(time) for time, (_, file) in zip(times, rows)):
        raise damaged(pvd, "a row has no file, or no timestep in seconds")
    return [(time, os.path.join(os.path.dirname(pvd), file)) for time, (_, file) in zip(times, rows)]


def folder_of_run(file):
    if not file or file == "None":
        raise Refused("no file is named; choose the run.json of a run")
    folder = file if os.path.isdir(file) else os.path.dirname(os.path.abspath(file))
    if not os.path.isfile(os.path.join(folder, "run.json")):
        raise Refused(f"{file}: is not in the folder of a run; choose the run.json that sinew run writes")
    return folder


def time_of(path):
    """When a file was changed, ns; 0: it is not there."""
    try:
        return os.stat(path).st_mtime_ns
    except OSError:
        return 0


def series_of(folder):
    """All series that a run may have, as its record lists them; those of older runs by their arrays. None until a run has
    written it."""
    try:
        with open(checked(os.path.join(folder, "run.json")), encoding="utf-8") as file:
            record = json.load(file)
        series = record.get("series") or record.get("arrays") or {}
        return {name: row for name, row in series.items() if name.isidentifier() and isinstance(row, dict)}
    except (OSError, ValueError, AttributeError, RecursionError):
        return {}


def state_of(folder):
    """Changes whenever a series has more frames."""
    return folder, [(name, time_of(os.path.join(folder, f"{name}.pvd"))) for name in series_of(folder)]


def open_series(folder):
    """Those that have frames."""
    found = ((name, rows_of(os.path.join(folder, f"{name}.pvd"))) for name in series_of(folder))
    return [OpenSeries(name, folder, rows) for name, rows in found if rows]


def newest_time(folder):
    """The last time that all series have which no setting asks for; None: there is none."""
    table = series_of(folder)
    return min((one.rows[-1][0] for one in open_series(folder) if "asked_by" not in table[one.name]), default=None)


def whole_frame(folder, name, time):
    """The frame of a series at a time, with all arrays; None: there is none."""
    rows, every = rows_of(os.path.join(folder, f"{name}.pvd")), vtkDataArraySelection()
    if not rows or time is None:
        return None
    series = OpenSeries(name, folder, rows)
    series.choose(every)
    return series.at(time, every)


def without_rounding(grid):
    """Zeros in place of arrays that are nowhere above 1e-9 of their scale: of pure numbers 1, of lengths the size of the
    whole. Drawn, such a range would be noise in all colors."""
    scales = {"1": 1, "m": grid.GetLength()}
    for index in range(grid.GetPointData().GetNumberOfArrays()):
        array = grid.GetPointData().GetArray(index)
        scale = scales.get(array.GetInformation().Get(vtkDataArray.UNITS_LABEL()) if array else None, 0)
        if scale and array.GetDataType() in (VTK_FLOAT, VTK_DOUBLE) and abs(vtk_to_numpy(array)).max(initial=0) < 1e-9 * scale:
            zeros = array.NewInstance()
            zeros.DeepCopy(array)
            zeros.Fill(0)
            grid.GetPointData().AddArray(zeros)


def complete(path, folder):
    """Whether a file of a run ends as XML of VTK does; its reader, given one that was cut, reports an error or crashes."""
    try:
        if not is_own(path, folder):
            return False
        with open(path, "rb") as file:
            file.seek(max(os.path.getsize(path) - 64, 0))
            return file.read().rstrip().endswith(b"</VTKFile>")
    except OSError:
        return False


def readable(path):
    try:
        ET.parse(path)
    except (OSError, ET.ParseError):
        return False
    return True


class OpenSeries:
    """The files of one series, read by ParaView's own reader."""

    def __init__(self, name, folder, rows):
        self.name, self.folder, self.rows = name, folder, rows
        self.reader, self.number = vtkXMLUnstructuredGridReader(), 0

    def choose(self, selection):
        """Offers its arrays: those of the first frame that can be read."""
        for _, path in (self.rows[0], self.rows[len(self.rows) // 2], self.rows[-1]):
            if not complete(path, self.folder):
                continue
            self.reader.SetFileName(path)
            self.reader.UpdateInformation()
            if self._own_arrays():
                break
        for _, name in self._own_arrays():
            if not selection.ArrayExists(f"{self.name}: {name}"):
                selection.AddArray(f"{self.name}: {name}")

    def _own_arrays(self):
        """Pairs of the reader's selections and a name."""
        own = (self.reader.GetPointDataArraySelection(), self.reader.GetCellDataArraySelection())
        return [(one, one.GetArrayName(i)) for one in own for i in range(one.GetNumberOfArrays())]

    def apply(self, selection):
        for own, name in self._own_arrays():
            own.SetArraySetting(name, int(selection.ArrayIsEnabled(f"{self.name}: {name}")))

    def _read(self, path, selection):
        """Number of points of a frame."""
        self.reader.SetFileName(path)
        self.reader.UpdateInformation()
        self.apply(selection)
        self.reader.Update()
        return self.reader.GetOutput().GetNumberOfPoints()

    def at(self, time, selection):
        """The frame at a time or the last before it; before all of them the first."""
        row = max((row for row in self.rows if row[0] <= time + 1e-9 * abs(time)), default=self.rows[0])
        number = self._read(row[1], selection) if complete(row[1], self.folder) else None
        if number is None or (number == 0 and (self.number or not readable(row[1]))):  # all frames have the same points
            raise Refused(f"{row[1]}: cannot be read; see sinew info {self.folder} --verify")
        self.number = number
        shown = vtkUnstructuredGrid()
        shown.ShallowCopy(self.reader.GetOutput())
        return shown


def number(text):
    """Not-a-number where it is empty, None where it is no number."""
    try:
        return float(text) if text else math.nan
    except ValueError:
        return None


def read_csv(path):
    """Columns of numbers, or lists of texts, by their names: what a column is, its first row says. Leaves out rows that
    have something else there or were cut, as the last one of a run in progress."""
    if not os.path.lexists(path):
        raise Refused(f"{path}: is not there; run `sinew measure {os.path.dirname(path)}` for metrics, or choose another table")
    try:
        with open(checked(path), newline="", encoding="utf-8", errors="replace") as file:
            text = file.read()
        names, *rows = csv.reader(io.StringIO(text[:text.rfind("\n") + 1], newline="")) if "\n" in text else [[]]
    except (OSError, csv.Error) as error:
        raise damaged(path, error) from None
    first = dict(zip(names, rows[0] if rows else ()))
    kinds = [str if name in OWNERS or name != "time" and number(first.get(name)) is None else number for name in names]
    rows = [[kind(text) for kind, text in zip(kinds, row)] for row in rows if len(row) == len(names)]
    columns = list(zip(*(row for row in rows if None not in row))) or [()] * len(names)
    return {name: list(column) if kind is str else numpy.array(column, float)
            for name, kind, column in zip(names, kinds, columns)}


def wide_table(columns):
    """A row for each time: the columns of each bone, support or probe beside each other, by its name."""
    owner = next((columns[name] for name in OWNERS if name in columns), None)
    if owner is None or "time" not in columns:
        return columns
    times, row_of = numpy.unique(columns["time"], return_inverse=True)
    number_of = {name: i for i, name in enumerate(dict.fromkeys(owner))}
    if len(number_of) * len(times) > 100 * len(owner):
        raise Refused("a table has other names at each time; restore it from a copy, or run the scene again")
    cells = numpy.array([number_of[name] for name in owner], int), row_of
    wide = {}
    for name, values in columns.items():
        if name != "time" and not isinstance(values, list):
            wide[name] = numpy.full((len(number_of), len(times)), numpy.nan)
            wide[name][cells] = values
    return {"time": times, **{f"{who} {name}": values[i] for who, i in number_of.items() for name, values in wide.items()}}


def table_of(path):
    """Columns of numbers, or lists of texts, by their names."""
    columns = read_csv(path)
    return columns if os.path.basename(path) == "metrics.csv" else wide_table(columns)
