#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads all that the Python package, or the plugin for ParaView, gives of a run: a line for each refusal, and code 2.

usage: read_run.py package BUILD/python RUN | read_run.py plugin SOURCE/tools/paraview RUN
"""
import sys


def reads_by_package(folder):
    import sinew
    run = sinew.open_run(folder)
    yield from (lambda name=name: getattr(run, name) for name in ("scene", "times", "rest", "faces", "bone_names", "metrics", "bones"))
    for series in run.series:
        yield lambda series=series: [data.points.sum() for data in run.frames(series)]
    for frame in run.frames():
        yield from (lambda frame=frame, name=name: frame[name] for name in ("strain", "stress"))


def reads_by_plugin(folder):
    from sinew_parts import run_files
    from vtkmodules.vtkCommonCore import vtkDataArraySelection

    def read(name):
        rows = run_files.rows_of(f"{folder}/{name}.pvd")
        if rows:
            series, arrays = run_files.OpenSeries(name, folder, rows), vtkDataArraySelection()
            series.choose(arrays)
            for time, _ in rows:
                series.at(time, arrays)
    yield from (lambda name=name: read(name) for name in run_files.series_of(folder))
    yield from (lambda name=name: run_files.table_of(f"{folder}/{name}.csv") for name in run_files.TABLES)


def main():
    how, where, folder = sys.argv[1:]
    sys.path.insert(0, where)
    reads, code, read = (reads_by_package if how == "package" else reads_by_plugin)(folder), 0, print
    while read:
        try:
            read = next(reads, None)
            if read:
                read()
        except Exception as error:
            if type(error).__name__ not in ("Error", "Refused"):
                raise
            print(f"sinew: {error}", file=sys.stderr)
            code = 2
    return code


if __name__ == "__main__":
    sys.exit(main())
