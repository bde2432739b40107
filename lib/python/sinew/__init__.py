# SPDX-License-Identifier: GPL-3.0-or-later
"""Elastic bodies bent by a skeleton: fill meshes with particles, simulate scenes, read and measure runs.

Lengths are in meters, times in seconds, all else in SI units. What goes wrong raises sinew.Error, whose text says
what to do and whose exit_code is that of the commands. Arrays are views of the library's own memory, not writable;
those of a Simulation change with its next steps: copy what you keep.
"""
import json as _json
import os as _os

from . import _sinew
from ._sinew import Body, Error, Frame, Run, Scene, Simulation, __version__, measure, open_run

__all__ = ["Body", "Error", "Frame", "Run", "Scene", "Simulation", "fill", "make_scene", "measure", "open_run",
           "read_scene", "simulate"]


def _text(value):
    """As JSON, whose pairs of surrogates YAML does not know."""
    return _json.dumps(value, ensure_ascii=False)


def _yaml(value):
    """As YAML; the words for what is not given, auto and none, are not texts."""
    if hasattr(value, "tolist"):  # NumPy's
        value = value.tolist()
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_text(str(key))}: {_yaml(item)}" for key, item in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(_yaml, value)) + "]"
    if isinstance(value, _os.PathLike):
        value = _os.fspath(value)
    return value if value in ("auto", "none") else _text(value)


def _values(settings):
    return [(path, _yaml(value)) for path, value in settings.items()]


def read_scene(path, settings=None):
    """The scene of a YAML file; `settings` replaces values: {"material.model": "bonded"}."""
    return _sinew._read_scene(path, _values(settings or {}))


def make_scene(sections, body=None, folder="."):
    """The scene of nested dictionaries, as a YAML file has them; paths are relative to `folder`.

    With a `body`, the scene needs no section body: Simulation(scene, body) takes its particles."""
    if body is not None:
        sections = {**sections, "body": {"mesh": "particles", "radius": body.radius, **sections.get("body", {})}}
    return _sinew._scene_of_text(_yaml(sections), folder)


def fill(mesh, radius=None, count=None, density=None, **options):
    """Fills a mesh, or the mesh of a Scene, with closest-packed particles of this radius (m) or about this count.

    Options are the keys of a scene's section body: unit="mm", packing="hcp", clearance=0.001, ..."""
    given = {"body.radius": radius, "body.count": count, "material.density": density,
             **{f"body.{key}": value for key, value in options.items()}}
    values = {path: value for path, value in given.items() if value is not None}
    if not isinstance(mesh, Scene):
        return _sinew._fill(mesh, _values(values))
    if values:
        raise TypeError(f"a scene says itself how it is filled; read it with {values}")
    return _sinew._fill_scene(mesh)


def simulate(scene, folder, force=False, resume=False):
    """Runs a scene into a folder, as `sinew simulate` does, and opens the run."""
    _sinew._simulate(scene, folder, force, resume)
    return open_run(folder)
