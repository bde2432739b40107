# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of a run: its series, read by ParaView's own reader, and its tables."""
import csv
import os
import xml.etree.ElementTree as ET

import numpy
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from .common import Refused

SERIES = ("particles", "surface", "volume", "bones", "frames", "obstacles", "supports", "bonds")
TABLES = ("metrics", "bones", "supports", "probes")
OWNERS = ("bone", "name")  # columns that say whose a row is


def rows_of(pvd):
    """Times and files that a PVD names; none where it is not there."""
    try:
        rows = ET.parse(pvd).getroot().iter("DataSet")
    except FileNotFoundError:
        return []
    except ET.ParseError as error:
        raise Refused(f"{pvd}: {error}; restore it from a copy, or run the scene again") from None
    rows = [(row.get("timestep"), row.get("file")) for row in rows]
    if any(None in row for row in rows):
        raise Refused(f"{pvd}: a row has no timestep or no file; restore it from a copy, or run the scene again")
    return [(float(time), os.path.join(os.path.dirname(pvd), file)) for time, file in rows]


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


def state_of(folder):
    """Changes whenever a series has more frames."""
    return folder, [time_of(os.path.join(folder, f"{name}.pvd")) for name in SERIES]


def open_series(folder):
    """Those that have frames."""
    found = ((name, rows_of(os.path.join(folder, f"{name}.pvd"))) for name in SERIES)
    return [OpenSeries(name, rows) for name, rows in found if rows]


def complete(path):
    """Whether a file ends as XML of VTK does; its reader, given one that was cut, reports an error or crashes."""
    try:
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

    def __init__(self, name, rows):
        self.name, self.rows = name, rows
        self.reader, self.number = vtkXMLUnstructuredGridReader(), 0

    def choose(self, selection):
        """Offers its arrays: those of the first frame that can be read."""
        for _, path in (self.rows[0], self.rows[len(self.rows) // 2], self.rows[-1]):
            if not complete(path):
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
        number = self._read(row[1], selection) if complete(row[1]) else None
        if number is None or (number == 0 and (self.number or not readable(row[1]))):  # all frames have the same points
            raise Refused(f"{row[1]}: cannot be read; see sinew info {os.path.dirname(os.path.dirname(row[1]))} --verify")
        self.number = number
        shown = vtkUnstructuredGrid()
        shown.ShallowCopy(self.reader.GetOutput())
        return shown


def column(values):
    """Numbers, where empty ones are not-a-number, or None for texts."""
    try:
        return numpy.array([float(value) if value else numpy.nan for value in values])
    except ValueError:
        return None


def read_csv(path):
    try:
        with open(path, newline="", encoding="utf-8", errors="replace") as file:
            rows = list(csv.reader(file))
    except FileNotFoundError:
        raise Refused(f"{path}: is not there; run `sinew measure {os.path.dirname(path)}` for metrics, or choose another table") \
            from None
    rows = [row for row in rows if len(row) == len(rows[0])]  # the last one of a run in progress may be torn
    return {name: [row[i] for row in rows[1:]] for i, name in enumerate(rows[0])} if rows else {}


def plain_table(columns):
    """A row for each row of the file."""
    table = {}
    for name, values in columns.items():
        numbers = column(values)
        table[name] = values if numbers is None else numbers
    return table


def wide_table(columns):
    """A row for each time: the columns of each bone, support or probe beside each other, by its name."""
    owners = [name for name in OWNERS if name in columns]
    if not owners or "time" not in columns:
        return plain_table(columns)
    owner, times = columns[owners[0]], column(columns["time"])
    steps, row_of = numpy.unique(times, return_inverse=True)
    table = {"time": steps}
    for who in dict.fromkeys(owner):
        of = numpy.array([name == who for name in owner])
        for name, values in columns.items():
            numbers = column(values)
            if name in ("time", owners[0]) or numbers is None:
                continue
            table[f"{who} {name}"] = numpy.full(len(steps), numpy.nan)
            table[f"{who} {name}"][row_of[of]] = numbers[of]
    return table


def table_of(path):
    """Columns of numbers, or lists of texts, by their names."""
    columns = read_csv(path)
    return plain_table(columns) if os.path.basename(path) == "metrics.csv" else wide_table(columns)
