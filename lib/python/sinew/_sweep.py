# SPDX-License-Identifier: GPL-3.0-or-later
"""Many runs of one scene, as a table."""
from __future__ import annotations

import csv
import os
import re
import tempfile
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy

from . import _sinew
from ._error import Error, of_library
from ._programs import _positional, _scene_file, run_program
from ._progress import shown_progress
from ._scene import Scene
from ._simulation import Simulation
from ._values import Path, Progress, checked, pairs, shown, table, yaml

_OWN_COLUMNS = ("folder", "status", "reason", "seconds")


def _split(results):
    """Results by name, and functions."""
    asked = [results] if isinstance(results, (str, Mapping)) or callable(results) else list(results or [])
    for index, one in enumerate(asked):
        if not (isinstance(one, (str, Mapping)) or callable(one)):
            raise Error(f"results[{index}] is {shown(one)}; give a name, a dict as {{'name': 'J_min', 'of': 'final'}}, or a "
                        "function")
    functions = {getattr(one, "__name__", type(one).__name__): one for one in asked if callable(one)}
    named = [one for one in asked if not callable(one)]
    if len(functions) + len(named) < len(asked):
        raise Error("two of the functions have one name, as their column would; give each a name of its own by def")
    return named, functions


def _lines(keys):
    """A mapping below a key of YAML; words are plain, as in the names of folders."""
    return "".join(f"\n  {yaml(str(key))}: " + re.sub('"([A-Za-z_]+)"', r"\1", yaml(value)) for key, value in keys.items())


def _study(scene, vary, design, named, settings, keep):
    """Text of a study's file."""
    try:
        fixed = _lines({path: value for path, value in settings.items() if value is not None})
        lines = [f"scene: {yaml(os.path.abspath(scene))}", f"vary:{_lines(vary)}", f"set:{fixed}" if fixed else "",
                 f"design: {yaml(design)}", f"results: {yaml(named)}" if named else "", f"keep: {yaml(keep)}", ""]
        return "\n".join(lines).encode("utf-8", "surrogateescape")
    except (TypeError, ValueError, RecursionError):
        raise Error("a value of vary, design, results or settings is no number, text, list or dict; give one of these") \
            from None


def _in_dictionaries(error):
    """The same Error where the study's file was written here."""
    text = re.sub(r"\S*study\.yaml(:\d+)*: ", "", str(error))
    quoted = re.sub(r"\{[^}]*\}", lambda found: re.sub(r"(?<![\w.])([A-Za-z_]\w*)", r'"\1"', found[0]), text)
    return of_library(quoted, error.exit_code)


def _write(folder, text):
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise of_library(f"{os.fsdecode(folder)}: {error.strerror}; choose another folder", 4) from None
    path = os.path.join(os.fsdecode(folder), "study.yaml")
    _sinew._write_file(path, text)
    return path


def _column(texts):
    """Numbers, or texts where one is none."""
    try:
        return numpy.array(texts, float)
    except ValueError:
        return numpy.array(texts, str)


def _columns(path):
    """The columns of a CSV file by name."""
    with open(path, newline="", encoding="utf-8", errors="surrogateescape") as file:
        names, *rows = csv.reader(file)
    return {name: _column(column) for name, column in zip(names, zip(*rows))}


def _by_program(study, folder, options, progress, threads):
    """The tables of a sweep in its folder. Raises Error where all runs failed."""
    index = os.path.join(os.fsdecode(folder), "index.csv")
    try:
        run_program("sweep", [_positional(study), "-o", _positional(folder)], options, progress, threads)
    except Error as error:
        if error.exit_code != 3 or not os.path.exists(index):
            raise _in_dictionaries(error) from None
        found = _columns(index)
        failed = found["status"] == "failed"
        raise of_library(f"{failed.sum()} of {len(failed)} runs failed, as {found['folder'][failed][0]}: "
                         f"{found['reason'][failed][0]}; see {index}, and do them again with --retry-failed", 3) from None
    results = _columns(os.path.join(os.fsdecode(folder), "results.csv"))
    told = _columns(index)
    return {**results, **{name: told[name] for name in _OWN_COLUMNS}}


def _planned(study, threads):
    """The varied values of each run, as texts of YAML by their keys."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            words = [_positional(study), "-o", os.path.join(folder, "none")]
            return [run["values"] for run in run_program("sweep", words, {"dry_run": True}, False, threads)["runs"]]
        except Error as error:
            raise _in_dictionaries(error) from None


def _number(name, value):
    try:
        return float(value)
    except (TypeError, ValueError):
        raise Error(f"{name}(simulation) is {shown(value)}; return a number") from None


def _by_functions(scene, study, functions, settings, progress, threads):
    """Columns of what the functions find at the end of each run, which is stepped here."""
    runs, rows = _planned(study, threads), []
    with shown_progress(progress, "sweeping") as told:
        for done, values in enumerate(runs):
            try:
                one = Scene._of(_sinew._read_scene(scene, [*pairs(settings), *values.items()]))
                simulation = Simulation(one, threads=threads)
                simulation.run_until(one.duration)
                rows.append([*(_number(name, function(simulation)) for name, function in functions.items()), "finished", ""])
            except Error as error:
                if error.exit_code != 3:
                    raise
                rows.append([*(numpy.nan for _ in functions), "failed", str(error)])
            if told:
                told(done + 1, len(runs))
    return {**{key: _column([values[key] for values in runs]) for key in runs[0]},
            **{name: numpy.array(column) for name, column in zip([*functions, "status", "reason"], zip(*rows))}}


@checked
def sweep(scene: Scene | Path, vary: Mapping, folder: Path | None = None, *, design: str | Mapping = "grid",
          results: str | Mapping | Callable | Sequence | None = None, settings: Mapping | None = None, keep: str = "last",
          progress: Progress = None, threads: int = 0, **options: Any) -> Any:
    """Runs a scene (or a scene's file) with many values of its settings, as `sinew sweep` does: a table with a row for each
    run, as a pandas.DataFrame, or where there is no pandas a dict of arrays (runs,) by name.

    `vary`: values by the paths of settings, {"material.young_modulus": [5e3, 1e4]}, or {"from": 5e3, "to": 2e4, "count": 5}
    (with "scale": "log"). `design`: "grid" (every combination), "list" (the k-th value of each), or {"kind":
    "latin_hypercube" or "sobol", "samples": 100, "seed": 1}. `results`: names of metrics or of columns as "grip: force_z",
    or {"name": "J_min", "of": "final"} (or worst, largest, at with "time"), by default volume_error, J_min and
    pose_error_rms; or functions that take a Simulation at the end of its run and return a number, in columns of their names.

    Runs lie in `folder`, which results by name need: the same call goes on with what is missing. Runs for functions are
    stepped here, one after the other. Failed runs have the `status` "failed", a `reason`, and not-a-number as results.
    `settings` as in read_scene() hold for all runs, `keep` is last, metrics or all (frames). Options are the command's, by
    name: jobs=4, memory=8 (GB), timeout=60 (s), retry_failed=True, strict=True. Progress counts runs; `progress` and
    `threads` as in simulate(). Raises Error for what the study gets wrong, and where all runs have failed (exit_code 3)."""
    named, functions = _split(results)
    if (named or not functions) and folder is None:
        raise Error("results by name need a folder for their runs; give one, as folder='out/sweep'")
    if options and not (named or not functions):
        raise Error(f"{next(iter(options))} is an option of runs with results by name; leave it out")
    if not vary:
        raise Error("vary is empty; give values of a setting, as {'body.radius': [0.01, 0.014]}")
    if taken := {*functions} & {*_OWN_COLUMNS, *map(str, vary)}:
        raise Error(f"a column {taken.pop()} is there without your function; call it otherwise")
    with tempfile.TemporaryDirectory() as own:
        place = own if folder is None else folder
        path = _scene_file(scene, place)
        text = _study(path, vary, design, named, settings or {}, keep)
        study, found = _write(place, text), {}
        if named or not functions:
            found = _by_program(study, place, options, progress, threads)
        if functions:
            measured = _by_functions(path, study, functions, settings or {}, progress, threads)
            found = {**measured, **found}
    return table(found, {})
