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

def rows_of(pvd):
    """Times and files that a PVD names; none where it is not there."""
    try:
        rows = ET.parse(pvd).getroot().iter("DataSet")
    except FileNotFoundError:
        return []
    except ET.ParseError as error:
        raise Refused(f"{pvd}: {error}; restore it from a copy, or run the scene again") from None
    return [(float(row.get("timestep")), os.path.join(os.path.dirname(pvd), row.get("file"))) for row in rows]


def folder_of_run(file):
    if not file or file == "None":
        raise Refused("no file is named; choose the run.json of a run")
    folder = file if os.path.isdir(file) else os.path.dirname(os.path.abspath(file))
    if not os.path.isfile(os.path.join(folder, "run.json")):
        raise Refused(f"{file}: is not in the folder of a run; choose the run.json that sinew run writes")
    return folder


def state_of(folder):
    """Changes whenever a series has more frames."""
    paths = [os.path.join(folder, f"{name}.pvd") for name in SERIES]
    return folder, [os.stat(path).st_mtime_ns if os.path.exists(path) else 0 for path in paths]


def open_series(folder):
    """Those that have frames."""
    found = ((name, rows_of(os.path.join(folder, f"{name}.pvd"))) for name in SERIES)
    return [OpenSeries(name, rows) for name, rows in found if rows]


class OpenSeries:
    """The files of one series, read by ParaView's own reader."""

    def __init__(self, name, rows):
        self.name, self.rows = name, rows
        self.reader = vtkXMLUnstructuredGridReader()

    def choose(self, selection):
        """Offers its arrays, and reads those that are chosen."""
        self.reader.SetFileName(self.rows[0][1])
        self.reader.UpdateInformation()
        for own in (self.reader.GetPointDataArraySelection(), self.reader.GetCellDataArraySelection()):
            for i in range(own.GetNumberOfArrays()):
                name = f"{self.name}: {own.GetArrayName(i)}"
                if not selection.ArrayExists(name):
                    selection.AddArray(name)

    def apply(self, selection):
        for own in (self.reader.GetPointDataArraySelection(), self.reader.GetCellDataArraySelection()):
            for i in range(own.GetNumberOfArrays()):
                name = own.GetArrayName(i)
                own.SetArraySetting(name, int(selection.ArrayIsEnabled(f"{self.name}: {name}")))

    def at(self, time, selection):
        """The frame at a time or the last before it; None: there is none yet."""
        row = max((row for row in self.rows if row[0] <= time + 1e-9 * abs(time)), default=None)
        if row is None:
            return None
        self.reader.SetFileName(row[1])
        self.reader.UpdateInformation()
        self.apply(selection)
        self.reader.Update()
        if self.reader.GetErrorCode():
            raise Refused(f"{row[1]}: cannot be read; see sinew info {os.path.dirname(os.path.dirname(row[1]))} --verify")
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
    kinds = [name for name, values in columns.items() if column(values) is None]
    if not kinds or "time" not in columns:
        return plain_table(columns)
    owner, times = columns[kinds[0]], column(columns["time"])
    steps, row_of = numpy.unique(times, return_inverse=True)
    table = {"time": steps}
    for who in dict.fromkeys(owner):
        of = numpy.array([name == who for name in owner])
        for name, values in columns.items():
            numbers = column(values)
            if name == "time" or numbers is None:
                continue
            table[f"{who} {name}"] = numpy.full(len(steps), numpy.nan)
            table[f"{who} {name}"][row_of[of]] = numbers[of]
    return table


def table_of(folder, name):
    """Columns of numbers, or lists of texts, by their names."""
    columns = read_csv(os.path.join(folder, f"{name}.csv"))
    return plain_table(columns) if name == "metrics" else wide_table(columns)
