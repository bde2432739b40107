# SPDX-License-Identifier: GPL-3.0-or-later
"""What commands do that are programs of their own: pictures, studies, files for other programs."""
from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path as _Folder
from typing import Any

from . import _sinew
from ._error import Error, of_library
from ._progress import shown_progress, with_threads
from ._runs import Run
from ._scene import Scene
from ._values import Findings, Path, Progress, checked, pairs, shown


def _program(name):
    """The program of a command: beside the package, as installed or built, or else on the PATH."""
    program = f"sinew-{name}"
    for folder in _Folder(__file__).resolve().parents[1:]:
        if os.access(folder / "bin" / program, os.X_OK):
            return str(folder / "bin" / program)
    found = shutil.which(program)
    if not found:
        raise Error(f"the program {program} is neither beside this package nor on the PATH; install sinew's programs, or add "
                    "their folder to PATH")
    return found


def _word(name, value):
    if isinstance(value, (list, tuple)):
        return ",".join(_word(name, one) for one in value)
    if hasattr(value, "tolist"):
        return _word(name, value.tolist())
    if isinstance(value, (str, bytes, os.PathLike)):
        return os.fsdecode(value)
    if isinstance(value, (int, float)):
        return repr(value)
    raise Error(f"{name} is {shown(value)}; give a text, a number or a list of them")


def _options(options):
    """Arguments as options of a command: no_movie=True is --no-movie, times=[0, 1] is --times 0,1."""
    words = []
    for name, value in options.items():
        if value is None or value is False:
            continue
        option = f"--{name.replace('_', '-')}"
        words += [option] if value is True else [option, _word(name, value)]
    return words


def _lines(program, told):
    """Reads what a program says while it works."""
    said = []
    for line in program.stderr:
        said.append(line.rstrip("\n"))
        if found := re.search(r"frame (\d+)/(\d+)|(\d+) of (\d+) runs|(\d+) %", line):
            done, of = [*filter(None, found.groups()), 100][:2]
            if told and not line.startswith("sinew: "):
                told(int(done), int(of))
    return said


def _ended(program):
    """Waits for a program that is to stop, which finishes its frame."""
    program.send_signal(signal.SIGINT)
    program.stderr.read()
    program.wait()


def _failure(name, code, said):
    told = [line for line in said if line.startswith("sinew: ") and not line.startswith("sinew: warning: ")]
    usage = next((line for line in said if line and not line.startswith(" ")), "no reason was given; see `sinew help`")
    text = told[-1][len("sinew: "):] if told else usage
    return of_library(text if code > 0 else f"sinew-{name} was ended by signal {-code}; run it again", code if code > 0 else 3)


def run_program(name, words, options, progress, threads):
    """What a command finds. Ctrl-C stops it as it stops the command."""
    with_threads(threads, lambda: None)
    command = [_program(name), *words, *_options(options), "--json", "--threads", str(threads)]
    with tempfile.TemporaryFile("w+") as out, shown_progress(progress, name) as told:
        program = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.PIPE, text=True,
                                   errors="surrogateescape", start_new_session=True)
        try:
            said = _lines(program, told)
            program.wait()
        except BaseException:
            _ended(program)
            raise
        finally:
            program.stderr.close()
        if program.returncode not in (0, 1):
            raise _failure(name, program.returncode, said)
        out.seek(0)
        text = out.read()
    warnings = [line.partition("warning: ")[2] for line in said if re.match(r"(sinew: )?warning: ", line)]
    try:
        return Findings(text, warnings)
    except ValueError:
        raise Error(f"sinew-{name} gave no results; leave out {', '.join(options) or 'what it was told'}") from None


def _folder_of(run):
    return os.fsdecode(run.folder if isinstance(run, Run) else run)


def _positional(path):
    """A path that no command takes for an option."""
    path = os.fsdecode(path)
    return path if not path.startswith("-") else os.path.join(".", path)


@checked
def render(run: Run | Path, view: str | Sequence | None = None, folder: Path | None = None, *, progress: Progress = None,
           threads: int = 0, **options: Any) -> Findings:
    """Draws pictures and a movie of a run, as `sinew render` does: a dict with the folder and the number of `pictures`.

    `view`: one or a list of body, surface, halves, cut, particles, section, strain, lines, forces, bonds, bones, binding;
    `folder`: where they go, by default `pictures` in the run. Options are the command's, by name: array="von_mises",
    times=[0, 1] (s), no_movie=True, compare=other, camera="front", look="paper", width=1920 (pixels), ... `progress` and
    `threads` as in simulate(). Raises Error for an unknown option or view, and where the program is missing."""
    words = [_positional(_folder_of(run))] + (["-o", _positional(folder)] if folder is not None else [])
    options = {name: _folder_of(value) if isinstance(value, Run) else value for name, value in options.items()}
    return run_program("render", words, {"view": view, **options}, progress, threads)


@checked
def converge(scene: Scene | Path, radii: Sequence, folder: Path, force: bool = False, resume: bool = False, *,
             settings: dict | None = None, progress: Progress = None, threads: int = 0) -> Findings:
    """Runs a scene (or a scene's file) with particles of several radii (m) into a folder, and extrapolates its metrics to
    size 0, as `sinew converge` does: a dict of `values`, `limit` and `error` by metric.

    `force`, `resume`, `progress` and `threads` as in simulate(), `settings` as in read_scene(). Raises Error for fewer
    than two radii, for one given twice, and as simulate() does."""
    words = [_positional(_scene_file(scene, folder)), "-o", _positional(folder)]
    for path, value in pairs(settings or {}):
        words += ["--set", f"{path}={value}"]
    return run_program("converge", words, {"radii": list(radii), "force": force, "resume": resume}, progress, threads)


def _scene_file(scene, folder):
    """The path of a scene's file, which is written into the folder where there is none."""
    if not isinstance(scene, Scene):
        return os.fsdecode(scene)
    _sinew._write_scene(scene._native, folder)
    return os.path.join(os.fsdecode(folder), "scene.yaml")


@checked
def export(source: Run | Scene | Path, to: str | None = None, file: Path | None = None, times: Sequence | float | None = None, *,
           progress: Progress = None, threads: int = 0, **options: Any) -> Findings:
    """Writes the particles or the surface of a run, or the body of a scene, for other programs, as `sinew export` does: a
    dict with `file` or `folder`.

    `to`: vtu, lammps, xyz, csv, gltf, volume, obj, ply, stl, of a scene calculix, ... (`sinew export --help` lists all); by
    default that of the file's name. `times` (s): those of the frames, by default all. Options are the command's, by name:
    series="obstacles", size=0.01 (m), linear=True, frequency=6. Raises Error for an unknown format, times outside of the run,
    and where the program is missing."""
    if isinstance(source, Scene):
        with tempfile.TemporaryDirectory() as folder:
            try:
                return _export(_scene_file(source, folder), to, file, times, progress, threads, options)
            except Error as error:
                raise of_library(re.sub(re.escape(folder) + r"/scene\.yaml(:\d+)*: ", "", str(error)), error.exit_code) from None
    return _export(_folder_of(source), to, file, times, progress, threads, options)


def _export(source, to, file, times, progress, threads, options):
    words = [_positional(source)] + (["-o", _positional(file)] if file is not None else [])
    return run_program("export", words, {"to": to, "times": times, **options}, progress, threads)


@checked
def compare(runs: Sequence, folder: Path, *, progress: Progress = None, threads: int = 0, **options: Any) -> Findings:
    """Compares two runs or more into a folder of its own, as `sinew measure A B -o DIR` does: a dict of differences, or of
    more than two runs of each run's values; report.html in the folder shows them.

    `runs`: Runs or folders, the first is the reference. Raises Error for folders that are no runs, and for runs without a
    common time."""
    if len(runs) < 2:
        raise Error(f"runs are {len(runs)}; give two or more, the first as the reference")
    for index, run in enumerate(runs):
        if not isinstance(run, (Run, str, bytes, os.PathLike)):
            raise Error(f"runs[{index}] is {shown(run)}; give a sinew.Run or a path")
    words = [*(_positional(_folder_of(run)) for run in runs), "-o", _positional(folder)]
    return run_program("measure", words, options, progress, threads)
