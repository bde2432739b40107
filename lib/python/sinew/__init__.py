# SPDX-License-Identifier: GPL-3.0-or-later
"""Elastic bodies bent by a skeleton: fill meshes with particles, simulate scenes, read and measure runs.

Lengths are in meters, times in seconds, all else in SI units. What goes wrong raises sinew.Error, whose text says
what to do and whose exit_code is that of the commands. Arrays are views of the library's own memory, not writable;
those of a Simulation change with its next steps: copy what you keep.
"""
from . import _sinew
from ._data import Dataset, vtk_composite as _composite
from ._meshes import Diagnosis, Mesh, NewScene, check, diagnose, distance, fill, info, new, polygons_of as _polygons_of, \
    repair, tetrahedra, winding_number
from ._runs import Frame, Frames, Run, measure, open_run
from ._sinew import Body, Error, RestShape, Scene, Simulation, __version__
from ._values import Findings, is_path as _is_path, pairs as _pairs, yaml as _yaml

__all__ = ["Body", "Dataset", "Diagnosis", "Error", "Findings", "Frame", "Frames", "Mesh", "NewScene", "RestShape", "Run",
           "Scene", "Simulation", "check", "diagnose", "distance", "fill", "info", "make_scene", "measure", "new", "open_run",
           "read_scene", "repair", "simulate", "tetrahedra", "winding_number"]


def read_scene(path, settings=None):
    """The scene of a YAML file; `settings` replaces values: {"material.model": "bonded"}."""
    return _sinew._read_scene(path, _pairs(settings or {}))


def make_scene(sections, body=None, folder=".", mesh=None):
    """The scene of nested dictionaries, as a YAML file has them; paths are relative to `folder`.

    With a `body`, the scene needs no section body: Simulation(scene, body) takes its particles. With a `mesh`, as fill()
    takes it but in no file, section body needs no mesh; a run writes the mesh, in double, beside scene.yaml."""
    given = sections.get("body", {})
    if body is not None:
        sections = {**sections, "body": {"mesh": "particles", "radius": body.radius, **given}}
    polygons = None if mesh is None else _polygons_of(mesh)
    if polygons is not None:
        sections = {**sections, "body": {**sections.get("body", {}), "mesh": "mesh", **given}}
    scene = _sinew._scene_of_text(_yaml(sections), folder)
    if polygons is not None:
        _sinew._set_mesh(scene, polygons)
    return scene


def simulate(scene, folder, force=False, resume=False):
    """Runs a scene (or a scene's file) into a folder, as `sinew simulate` does, and opens the run."""
    scene = read_scene(scene) if _is_path(scene) else scene
    _sinew._simulate(scene, folder, force, resume)
    return Run(folder)


def _scene_repr(scene):
    return f"<sinew.Scene of {scene.duration:.6g} s; str() has every key>"


def _simulation_repr(simulation):
    return f"<sinew.Simulation at {simulation.time:.6g} s, step {simulation.steps}: {len(simulation.bones)} bones>"


def _to_vtk(simulation):
    names = ("particles", "surface", "bones", "frames") if len(simulation.faces) else ("particles", "bones", "frames")
    return _composite({name: simulation.dataset(name) for name in names})


Scene.__repr__ = _scene_repr
Simulation.__repr__ = _simulation_repr
Simulation.dataset = lambda simulation, series="particles": Dataset(simulation._dataset(series), series)
Simulation.to_vtk = _to_vtk
