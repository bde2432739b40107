# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs on the disk: their frames, their tables, whatever else of them is in arrays."""
from __future__ import annotations

import csv
import io
import os
import pathlib
from collections.abc import Iterator
from typing import Any

import numpy
from numpy.typing import NDArray

from . import _sinew
from ._data import Dataset, pyvista_of, tell_unknown, vtk_composite
from ._error import Error
from ._progress import shown_progress, with_threads
from ._scene import Scene
from ._values import Path, Progress, checked, table


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
        raise Error(f"{path}: {why}; restore it from a copy, or run the scene again") from None
    first = dict(zip(names, rows[0] if rows else ()))
    kinds = [str if name == "bone" or _number(first.get(name)) is None else _number for name in names]
    rows = [[kind(text) for kind, text in zip(kinds, row)] for row in rows if len(row) == len(names)]
    columns = list(zip(*(row for row in rows if None not in row))) or [()] * len(names)
    return {name: numpy.array(column, str if kind is str else float) for name, kind, column in zip(names, kinds, columns)}


class Frame:
    """A moment of a run: run[0], run[-1], or one of run[10:20].

    frame["stress"] is any array of the particles by its name. Positions and the like are views, not writable."""

    def __init__(self, run, index):
        self._run, self._index = run, index
        self._frame = run._files.frame(index)
        self._datasets = {}

    @property
    def time(self) -> float:
        """Time of the moment, s."""
        return self._frame.time

    @property
    def positions(self) -> NDArray[numpy.float64]:
        """Positions of the particles (n, 3), m."""
        return self._frame.positions

    @property
    def velocities(self) -> NDArray[numpy.float64]:
        """Velocities of the particles (n, 3), m/s; empty: not written."""
        return self._frame.velocities

    @property
    def displacement(self) -> NDArray[numpy.float64]:
        """Displacement of each particle from rest (n, 3), m."""
        return self.positions - self._run.rest

    @property
    def distance(self) -> NDArray[numpy.float64]:
        """Length of the displacement of each particle (n,), m."""
        return numpy.linalg.norm(self.displacement, axis=1)

    @property
    def surface(self) -> NDArray[numpy.float64]:
        """Vertices of the skin (v, 3), m; their faces are those of the run."""
        return self._frame.surface

    @property
    def von_mises(self) -> NDArray[numpy.float64]:
        """Von Mises stress of each particle (n,), Pa: as the run wrote it, or measured. See array()."""
        return self.array("von_mises")

    @property
    def broken_bonds(self) -> NDArray[numpy.int32]:
        """Number of broken bonds of each particle (n,); empty: a material without bonds."""
        return self._frame.broken_bonds

    @property
    def bone_frames(self) -> NDArray[numpy.float64]:
        """Homogeneous matrices (bones, 4, 4): the axes of each bone, of which the first points along it, and its head, m."""
        return self._frame.bone_frames

    @property
    def reactions(self) -> NDArray[numpy.float64]:
        """Force, N, and moment about its head, N m, of the body on each bone: (bones, 6)."""
        frames = self.dataset("frames")
        return numpy.hstack([frames["reaction_force"], frames["reaction_moment"]])

    @checked
    def dataset(self, series: str = "particles") -> Dataset:
        """A series at this moment: a Dataset. Cells between the particles (volume) are made where none were written.

        Raises Error for a series that the run lacks."""
        if series not in self._datasets:
            self._datasets[series] = self._run._dataset(series, self._index)
        return self._datasets[series]

    @checked
    def array(self, name: str) -> NDArray[Any]:
        """An array of the particles by name: one that was written, or else, of those that positions define, measured:
        "stress" (n, 6), Pa, "strain", "F", "J", ...

        Warns where particles have none, which are not-a-number. Raises Error for an unknown name, and for one that is known
        only while a run steps."""
        particles = self.dataset()
        there = name in particles.point_arrays
        values = particles[name] if there else self._run._meter.array(self._frame, name)
        return tell_unknown(values, name, self._run._told)

    __getitem__ = array

    def keys(self) -> list[str]:
        """Names of the arrays of the particles that were written; array() measures others."""
        return [*self.dataset().point_arrays]

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __contains__(self, name: object) -> bool:
        return name in self.keys()

    def to_vtk(self) -> Any:
        """A vtkMultiBlockDataSet with a named block for each series of the run that has this moment."""
        there = [name for name in self._run.series if self._run._row_of(name, self._index) is not None]
        return vtk_composite({name: self.dataset(name) for name in there})

    def to_pyvista(self) -> Any:
        """A pyvista.MultiBlock of the same. Raises Error where pyvista is not installed."""
        return pyvista_of(self.to_vtk())

    def __repr__(self):
        return f"<sinew.Frame {self._index} at {self.time:.6g} s: {len(self.positions)} particles>"


class Frames:
    """Some frames of a run in order, or of one of its series: run[10:20], run.frames("surface").

    Each is read when it is asked for: a Frame, or a Dataset of the series. Raises IndexError beyond the last."""

    def __init__(self, run, indices, series=None):
        self._run, self._indices, self._series = run, indices, series

    def __len__(self) -> int:
        return len(self._indices)

    @checked
    def __getitem__(self, index: int | slice) -> Any:
        if isinstance(index, slice):
            return Frames(self._run, self._indices[index], self._series)
        try:
            frame = self._indices[index]
        except IndexError:
            raise IndexError(f"there is no frame {index}: there are {len(self)}") from None
        return Frame(self._run, frame) if self._series is None else self._run._dataset_at(self._series, frame)

    @property
    def times(self) -> NDArray[numpy.float64]:
        """Times of these frames (t,), s."""
        return self._run._times_of(self._series)[list(self._indices)]

    def __repr__(self):
        what = self._series or "frames"
        return f"<{len(self)} of {what} of {os.fspath(self._run.folder)!r}>"


class Run:
    """A run on the disk: run[0], run[-1], run[10:20], run.frames("surface"), run.metrics, run.bones.

    Frames that are there when it is opened: open it again to see more of a run in progress. Raises Error, which names the
    file, for a folder that holds no run, and for a damaged one."""

    @checked
    def __init__(self, folder: Path) -> None:
        self._files = _sinew._open_run(os.path.abspath(folder))
        self._kept, self._told = {}, set()

    def _once(self, name, make):
        if name not in self._kept:
            self._kept[name] = make()
        return self._kept[name]

    def __len__(self) -> int:
        return len(self._files)

    @checked
    def __getitem__(self, index: int | slice) -> Any:
        return Frames(self, range(len(self)))[index]

    @checked
    def frames(self, series: str | None = None) -> Frames:
        """All frames, or the data sets of a series, which with output.every may be more than those of particles.

        Raises Error for a series that the run lacks."""
        if series is not None:
            self._check(series)
        return Frames(self, range(len(self._times_of(series))), series)

    @property
    def folder(self) -> pathlib.Path:
        """Where the run is: an absolute path."""
        return self._files.folder

    @property
    def scene(self) -> Scene:
        """The Scene that was run."""
        return Scene._of(self._files.scene)

    @property
    def times(self) -> NDArray[numpy.float64]:
        """Times of the frames (t,), s."""
        return self._once("times", lambda: self._files.times)

    @property
    def rest(self) -> NDArray[numpy.float64]:
        """Positions of the particles at rest (n, 3), m."""
        return self._once("rest", lambda: self._files.rest)

    @property
    def radius(self) -> float:
        """Radius of the particles, m."""
        return self._files.radius

    @property
    def faces(self) -> NDArray[numpy.int32]:
        """Faces of the skin (f, 3), as indices of its vertices."""
        return self._files.faces

    @property
    def bone_names(self) -> list[str]:
        """Names of the bones, in the order of all arrays of bones."""
        return self._files.bones

    @property
    def series(self) -> list[str]:
        """Names of the series that were written: particles, surface, bones, frames, ..."""
        return _sinew._series_in(self.folder)

    @property
    def metrics(self) -> Any:
        """What the run measures, a row for each frame: a pandas.DataFrame with the units in `attrs`, or without pandas a
        dict of arrays (t,)."""
        measured = self._once("metrics", lambda: measure(self))
        return table({name: numpy.array(values) for name, values in measured.items()}, _sinew._units_of_metrics())

    def _table(self, name, asked_by=""):
        path = self.folder / f"{name}.csv"
        if asked_by and not os.path.lexists(path):
            raise Error(f"this run has no {name}; run a scene with {asked_by}")
        read = self._once(name, lambda: read_table(path))
        return table({column: numpy.array(values) for column, values in read.items()}, {})

    @property
    def bones(self) -> Any:
        """Forces (N) and moments (N m) of bones on the body, bones.csv: a table as `metrics`, a row for each bone of each
        frame."""
        return self._table("bones")

    @property
    def supports(self) -> Any:
        """Forces (N), power (W) and moments (N m) of supports and loads on the body, supports.csv: a table as `metrics`, a
        row for each of them in each frame. Raises Error where the scene has none."""
        return self._table("supports", "supports or loads")

    @property
    def probes(self) -> Any:
        """Positions (m), displacements (m), strain, stress (Pa) and force (N) of probes, probes.csv: a table as `metrics`, a row
        for each probe in each frame. Raises Error where the scene has none."""
        return self._table("probes", "probes")

    @checked
    def report(self, *, progress: Progress = None, threads: int = 0) -> pathlib.Path:
        """Measures the run into its folder, as `sinew measure` does: the path of report.html.

        `progress` and `threads` as in simulate(). Raises Error where the files cannot be written (exit_code 4)."""
        with shown_progress(progress, "measuring") as told:
            return with_threads(threads, lambda: _sinew._report(self._files, told))

    @property
    def _meter(self):
        return self._once("meter", lambda: _sinew._RunMeter(self._files))

    def _check(self, series):
        if series not in self.series and series != "volume":
            raise Error(f"this run has no series {series!r}; take one of {', '.join(self.series)}")

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
            return Dataset(cells.at(index, self._dataset("particles", index)._native), series, time)
        self._check(series)
        row = self._row_of(series, index)
        if row is None:
            raise Error(f"{series} have no frame at {time} s; the run may be in progress")
        return self._dataset_at(series, row)

    def __repr__(self):
        span = f"{self.times[0]:.6g} to {self.times[-1]:.6g} s" if len(self) else "none"
        return (f"<sinew.Run {os.fspath(self.folder)!r}: {len(self)} frames, {span}; {len(self.rest)} particles, "
                f"{len(self.bone_names)} bones>")


@checked
def measure(folder: Run | Path, *, progress: Progress = None, threads: int = 0) -> dict[str, NDArray[numpy.float64]]:
    """The metrics of a run, computed anew: a dict of arrays (t,) by name, in SI units (degrees for angles).

    `folder`: that of a run, or a Run. Ctrl-C ends it between two frames; `progress` and `threads` as in simulate(). Raises
    Error, which names the file, for a damaged run."""
    files = folder._files if isinstance(folder, Run) else _sinew._open_run(folder)
    with shown_progress(progress, "measuring") as told:
        return with_threads(threads, lambda: _sinew._measure(files, told))


@checked
def open_run(folder: Path) -> Run:
    """The Run in a folder. Raises Error where there is none."""
    return Run(folder)
