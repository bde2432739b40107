# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs on the disk: their frames, their tables, whatever else of them is in arrays."""
import csv
import io
import os

import numpy

from . import _sinew
from ._data import Dataset, pyvista_of, vtk_composite


def table(columns, units):
    """A pandas.DataFrame with units in its attrs, or where there is no pandas a dict of arrays."""
    try:
        from pandas import DataFrame
    except ImportError:
        return columns
    frame = DataFrame(columns)
    frame.attrs["units"] = units
    return frame


def _number(text):
    """Not-a-number where it is empty, None where it is no number."""
    try:
        return float(text) if text else numpy.nan
    except ValueError:
        return None


def read_table(path):
    """The columns of a CSV file of a run: numbers, empty ones not-a-number, or texts, as its first row has them. Leaves out
    rows that have something else there or were cut, as the last one of a run in progress."""
    try:
        if os.path.lexists(path) and not os.path.isfile(path):
            raise OSError(0, "is no regular file")  # which to open may block
        with open(path, newline="", encoding="utf-8", errors="surrogateescape") as file:
            text = file.read()
        names, *rows = csv.reader(io.StringIO(text[:text.rfind("\n") + 1], newline="")) if "\n" in text else [[]]
    except (OSError, csv.Error) as error:
        why = getattr(error, "strerror", error)
        raise _sinew.Error(f"{path}: {why}; restore it from a copy, or run the scene again") from None
    first = dict(zip(names, rows[0] if rows else ()))
    kinds = [str if name == "bone" or _number(first.get(name)) is None else _number for name in names]
    rows = [[kind(text) for kind, text in zip(kinds, row)] for row in rows if len(row) == len(names)]
    columns = list(zip(*(row for row in rows if None not in row))) or [()] * len(names)
    return {name: numpy.array(column, str if kind is str else float) for name, kind, column in zip(names, kinds, columns)}


class Frame:
    """A moment of a run. Positions and the like are views, not writable."""

    def __init__(self, run, index):
        self._run, self._index = run, index
        self._frame = run._files.frame(index)
        self._datasets = {}

    @property
    def time(self):
        """s."""
        return self._frame.time

    @property
    def positions(self):
        """Of the particles (n, 3), m."""
        return self._frame.positions

    @property
    def velocities(self):
        """Of the particles (n, 3), m/s; empty: not written."""
        return self._frame.velocities

    @property
    def displacement(self):
        """Its size for each particle (n,), m."""
        return numpy.linalg.norm(self.positions - self._run.rest, axis=1)

    @property
    def surface(self):
        """Vertices of the skin (n, 3), m; their faces are those of the run."""
        return self._frame.surface

    @property
    def von_mises(self):
        """Pa; empty: not written. See array()."""
        return self._frame.von_mises

    @property
    def broken_bonds(self):
        return self._frame.broken_bonds

    @property
    def bone_frames(self):
        """Homogeneous matrices (bones, 4, 4): the axes of each bone, of which the first points along it, and its head, m."""
        return self._frame.bone_frames

    @property
    def reactions(self):
        """Force, N, and moment about its head, N m, of the body on each bone: (bones, 6)."""
        frames = self.dataset("frames")
        return numpy.hstack([frames["reaction_force"], frames["reaction_moment"]])

    def dataset(self, series="particles"):
        """A series at this moment: a Dataset. Cells between the particles (volume) are made where none were written."""
        if series not in self._datasets:
            self._datasets[series] = self._run._dataset(series, self._index)
        return self._datasets[series]

    def array(self, name):
        """An array of the particles by name: one that was written, or else, of those that positions define, measured:
        "stress" (n, 6), Pa, "strain", "F", "J", ..."""
        particles = self.dataset()
        if name in particles.point_arrays:
            return particles[name]
        return self._run._meter.array(self._frame, name)

    __getitem__ = array

    def keys(self):
        """Names of the arrays of the particles that were written."""
        return [*self.dataset().point_arrays]

    def __iter__(self):
        return iter(self.keys())

    def __contains__(self, name):
        return name in self.keys()

    def to_vtk(self):
        """A vtkMultiBlockDataSet with a named block for each series of the run that has this moment."""
        there = [name for name in self._run.series if self._run._row_of(name, self._index) is not None]
        return vtk_composite({name: self.dataset(name) for name in there})

    def to_pyvista(self):
        """A pyvista.MultiBlock of the same."""
        return pyvista_of(self.to_vtk())

    def __repr__(self):
        return f"<sinew.Frame {self._index} at {self.time:.6g} s: {len(self.positions)} particles>"


class Frames:
    """Some frames of a run in order, or of one of its series; each is read when it is asked for."""

    def __init__(self, run, indices, series=None):
        self._run, self._indices, self._series = run, indices, series

    def __len__(self):
        return len(self._indices)

    def __getitem__(self, index):
        if isinstance(index, slice):
            return Frames(self._run, self._indices[index], self._series)
        try:
            frame = self._indices[index]
        except IndexError:
            raise IndexError(f"there is no frame {index}: there are {len(self)}") from None
        return Frame(self._run, frame) if self._series is None else self._run._dataset_at(self._series, frame)

    @property
    def times(self):
        """s."""
        return self._run._times_of(self._series)[list(self._indices)]

    def __repr__(self):
        what = self._series or "frames"
        return f"<{len(self)} of {what} of {os.fspath(self._run.folder)!r}>"


class Run:
    """A run on the disk: run[0], run[-1], run[10:20], run.frames("surface"), run.metrics.

    Frames that are there when it is opened: open it again to see more of a run in progress."""

    def __init__(self, folder):
        self._files = _sinew._open_run(os.path.abspath(folder))
        self._kept = {}

    def _once(self, name, make):
        if name not in self._kept:
            self._kept[name] = make()
        return self._kept[name]

    def __len__(self):
        return len(self._files)

    def __getitem__(self, index):
        return Frames(self, range(len(self)))[index]

    def frames(self, series=None):
        """All frames, or the data sets of a series, which with output.every may be more than those of particles."""
        if series is not None:
            self._check(series)
        return Frames(self, range(len(self._times_of(series))), series)

    @property
    def folder(self):
        return self._files.folder

    @property
    def scene(self):
        """The Scene that was run."""
        return self._files.scene

    @property
    def times(self):
        """Of the frames, s."""
        return self._once("times", lambda: self._files.times)

    @property
    def rest(self):
        """Positions of the particles at rest (n, 3), m."""
        return self._once("rest", lambda: self._files.rest)

    @property
    def radius(self):
        """Of the particles, m."""
        return self._files.radius

    @property
    def faces(self):
        """Of the skin (m, 3)."""
        return self._files.faces

    @property
    def bone_names(self):
        return self._files.bones

    @property
    def series(self):
        """Names of the series that were written."""
        return _sinew._series_in(self.folder)

    @property
    def metrics(self):
        """What the run measures, a row for each frame: a pandas.DataFrame, or without pandas a dict of arrays."""
        measured = self._once("metrics", lambda: _sinew._measure(self._files))
        return table({name: numpy.array(values) for name, values in measured.items()}, _sinew._units_of_metrics())

    @property
    def bones(self):
        """Forces and moments of bones, bones.csv: a row for each bone of each frame, as metrics."""
        read = self._once("bones", lambda: read_table(self.folder / "bones.csv"))
        return table({name: numpy.array(values) for name, values in read.items()}, {})

    def report(self):
        """Measures the run into its folder, as `sinew measure` does; the path of report.html."""
        return _sinew._report(self._files)

    @property
    def _meter(self):
        return self._once("meter", lambda: _sinew._RunMeter(self._files))

    def _check(self, series):
        if series not in self.series and series != "volume":
            raise _sinew.Error(f"this run has no series {series!r}; take one of {', '.join(self.series)}")

    def _rows(self, series):
        return self._once(f"{series}.pvd", lambda: _sinew._read_pvd(self.folder / f"{series}.pvd"))

    def _written(self, series):
        return (self.folder / f"{series}.pvd").is_file()

    def _times_of(self, series):
        if series is None or not self._written(series):
            return self.times
        return numpy.array([time for time, _ in self._rows(series)])

    def _dataset_at(self, series, row):
        """The data set of a row of its own series."""
        if not self._written(series):
            return self._dataset(series, row)
        time, path = self._rows(series)[row]
        return Dataset(_sinew._read_vtu(path), series, time)

    def _row_of(self, series, index):
        """The row of a series at the time of a frame; None: it has none."""
        away = abs(self._times_of(series) - self.times[index])
        return int(away.argmin()) if len(away) and away.min() <= 1e-6 else None

    def _dataset(self, series, index):
        """The data set at the time of a frame."""
        time = self.times[index]
        if series == "volume" and not self._written("volume"):
            cells = self._once("cells", lambda: _sinew._RunCells(self._files))
            return Dataset(cells.at(index, self._dataset("particles", index)._data), series, time)
        self._check(series)
        row = self._row_of(series, index)
        if row is None:
            raise _sinew.Error(f"{series} have no frame at {time} s; the run may be in progress")
        return self._dataset_at(series, row)

    def __repr__(self):
        span = f"{self.times[0]:.6g} to {self.times[-1]:.6g} s" if len(self) else "none"
        return (f"<sinew.Run {os.fspath(self.folder)!r}: {len(self)} frames, {span}; {len(self.rest)} particles, "
                f"{len(self.bone_names)} bones>")


def measure(folder):
    """The columns of a run's metrics.csv, computed anew: a dict of arrays."""
    return _sinew._measure(_sinew._open_run(folder))


def open_run(folder):
    """The Run in a folder."""
    return Run(folder)
