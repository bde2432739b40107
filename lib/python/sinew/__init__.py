# SPDX-License-Identifier: GPL-3.0-or-later
"""Elastic bodies bent by a skeleton: fill meshes with particles, simulate scenes, read and measure runs.

    body = sinew.fill("arm.ply", radius=0.006)          # a mesh as a file, arrays, or of another package
    run = sinew.simulate("arm.yaml", "out/arm")         # frames, metrics, pictures: run[-1], run.metrics, sinew.render(run)
    simulation = sinew.Simulation(sinew.read_scene("arm.yaml"))    # stepped, posed and pushed from here

Lengths are in meters, times in seconds, all else in SI units. What goes wrong raises sinew.Error, whose text says
what to do and whose exit_code is that of the commands. Arrays are views of the library's own memory, not writable;
those of a Simulation change with its next steps: copy what you keep.
"""
from ._data import Dataset
from ._error import Error
from ._meshes import Body, Diagnosis, Mesh, NewScene, RestShape, diagnose, distance, fill, info, new, repair, tetrahedra, \
    winding_number
from ._programs import compare, converge, export, render
from ._runs import Frame, Frames, Run, measure, open_run
from ._scene import Scene, presets, read_scene
from ._simulation import Simulation, State, check, make_scene, read_state, simulate
from ._sinew import __version__
from ._sweep import sweep
from ._values import Findings, publish as _publish

__all__ = ["Body", "Dataset", "Diagnosis", "Error", "Findings", "Frame", "Frames", "Mesh", "NewScene", "RestShape", "Run",
           "Scene", "Simulation", "State", "check", "compare", "converge", "diagnose", "distance", "export", "fill", "info",
           "make_scene", "measure", "new", "open_run", "presets", "read_scene", "read_state", "render", "repair", "simulate",
           "sweep", "tetrahedra", "winding_number"]

for _name in __all__:
    _publish(globals()[_name])
