# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of dictionaries, simulations that a script steps, and whole runs."""
from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy
from numpy.typing import ArrayLike, NDArray

from . import _sinew
from ._data import Dataset, tell_unknown, vtk_composite
from ._error import Error, of_dictionaries
from ._meshes import Body, polygons_of
from ._progress import shown_progress, with_threads
from ._runs import Run
from ._scene import Scene, read_scene
from ._values import Findings, Held, MeshLike, Path, Progress, checked, floats, is_path, shown, yaml


def _section_body(sections):
    given = sections.get("body", {})
    if not isinstance(given, Mapping):
        raise Error(f"body is {shown(given)}; give a dict, such as {{'radius': 0.01}}")
    return given


@checked
def make_scene(sections: Mapping, body: Body | None = None, folder: Path = ".", mesh: MeshLike = None) -> Scene:
    """The Scene of nested dictionaries, whose keys are those of a scene's file; paths are relative to `folder`.

    With a `body`, the scene needs no section body: Simulation(scene, body) takes its particles. With a `mesh`, as fill()
    takes it but in no file, section body needs no mesh; a run writes the mesh, in double, beside scene.yaml. Values are in
    SI units. Raises Error, which names the key, for what is missing or wrong."""
    given = _section_body(sections)
    if body is not None:
        sections = {**sections, "body": {"mesh": "particles", "radius": body.radius, **given}}
    polygons = None if mesh is None else polygons_of(mesh)
    if polygons is not None:
        sections = {**sections, "body": {**_section_body(sections), "mesh": "mesh", **given}}
    try:
        text = yaml(sections)
    except (TypeError, ValueError, RecursionError):
        raise Error("a value of the scene is no number, text, list or dict; give one of these") from None
    try:
        scene = _sinew._scene_of_text(text, folder)
    except Error as error:
        raise of_dictionaries(error) from None
    if polygons is not None:
        _sinew._set_mesh(scene, polygons)
    return Scene._of(scene)


def scene_of(scene):
    """The Scene of itself or of its file."""
    return read_scene(scene) if is_path(scene) else scene


@checked
def check(scene: Scene | Path, folder: Path = ".", threads: int = 0) -> Findings:
    """What a run of the scene (or of a scene's file) would need, how its body behaves, and which settings are doubtful, as
    `sinew check --json` has it: a dict in SI units, with `warnings`.

    Disk space is that of `folder`. `threads`: at most so many, 0 one per core. Raises Error where a run would be refused."""
    return Findings(*with_threads(threads, lambda: _sinew._check(scene_of(scene)._native, folder)))


@checked
def simulate(scene: Scene | Path, folder: Path, force: bool = False, resume: bool = False, *, progress: Progress = None,
             threads: int = 0) -> Run:
    """Runs a scene (or a scene's file) into a folder, as `sinew simulate` does: the Run.

    `force` replaces a run that is there, `resume` goes on with one that was stopped. Ctrl-C raises KeyboardInterrupt once
    the frames so far and a checkpoint are written: simulate(scene, folder, resume=True) goes on from there with the same
    bits. `progress`: a function that is called with the number of frames done and of all; True or False with and without a
    bar; by default there is one on a terminal and in a notebook. `threads`: at most so many, 0 one per core.

    Raises Error for what the scene gets wrong and for a folder that holds another run (exit_code 2), for a simulation that
    became unstable, whose frames stay (3), and for files that could not be written (4)."""
    settings = scene_of(scene)._native
    with shown_progress(progress, "simulating") as told:
        with_threads(threads, lambda: _sinew._simulate(settings, folder, force, resume, told))
    return Run(folder)


class State(Held):
    """A moment of a simulation, with the pose and the forces that were set until then: what Simulation.save() returns.

    Can be pickled, and written to a file: write(), read_state()."""

    def __init__(self) -> None:
        raise Error("a State is not made by itself; take that of a simulation by save(), or one of a file by read_state()")

    @property
    def steps(self) -> int:
        """Steps that the simulation had made."""
        return self._native.steps

    @checked
    def write(self, path: Path) -> None:
        """Writes it to a file, for read_state(). Raises Error where the file cannot be written."""
        _sinew._write_file(path, self._native.bytes())

    def __reduce_ex__(self, protocol):
        return _state_of, (self._native.bytes(),)

    def __repr__(self):
        return f"<sinew.State at step {self.steps}>"


def _state_of(data):
    return State._of(_sinew._state_of(data))


@checked
def read_state(path: Path) -> State:
    """The State that State.write() has written to a file.

    Raises Error for a file that is damaged, and for one of another version of sinew."""
    try:
        with open(path, "rb") as file:
            return _state_of(file.read())
    except OSError as error:
        raise Error(f"{os.fsdecode(path)}: {error.strerror}; give a file that State.write() has written") from None


class Simulation(Held):
    """A scene, filled and bound, at its start; or with the particles of a Body.

    own_forces=True lets set_forces() push its particles. `threads`: at most so many make the steps, 0 one per core. Arrays
    are views at the same address, which change with the next steps: copy what you keep. While step() or run_until() is at
    work in another thread, all but `time` and `steps` is refused. Raises Error for what the scene gets wrong."""

    @checked
    def __init__(self, scene: Scene, body: Body | None = None, *, own_forces: bool = False, threads: int = 0) -> None:
        native = None if body is None else body._native
        super().__init__(with_threads(threads, lambda: _sinew._Simulation(scene._native, native, own_forces)))
        self._threads, self._told = threads, set()

    @checked
    def step(self, count: int = 1) -> None:
        """Makes so many steps. Other threads of Python go on meanwhile; Ctrl-C stops it between two steps.

        Raises Error for a number below 0, and where the simulation becomes unstable (exit_code 3)."""
        with_threads(self._threads, lambda: self._native.step(count))

    @checked
    def run_until(self, time: float) -> None:
        """Steps until this time (s), or up to a step beyond. Raises Error for one that is past, else as step()."""
        with_threads(self._threads, lambda: self._native.run_until(time))

    @checked
    def set_forces(self, forces: ArrayLike) -> None:
        """Sets the forces on the particles (n, 3), N, until others are set.

        Raises Error where the simulation was not made with own_forces=True, and for other shapes."""
        self._native.set_forces(forces)

    @checked
    def set_pose(self, rotations: Mapping, over: float = 1 / 30) -> None:
        """Rotates bones, from how they are, within `over` seconds: quaternions (w, x, y, z) by the names of bones, from rest,
        in the directions of the parent bone.

        From the first call on, the scene's motion ends: bones that are not named, in this call or before, stay as they are.
        Raises Error for an unknown bone, for what is no rotation, and where the body has groups of particles."""
        given = {name: floats(f"rotations[{name!r}]", one, (4,), "give a quaternion (w, x, y, z)")
                 for name, one in rotations.items()}
        if any(not isinstance(name, str) for name in given):
            raise Error(f"rotations has the key {next(n for n in given if not isinstance(n, str))!r}; give names of bones")
        self._native.set_pose(given, over)

    def energies(self) -> dict[str, float]:
        """Energies by name, J: kinetic, pair, bone, gravity, contact, work (done on the body) and dissipated."""
        return self._native.energies()

    @checked
    def array(self, name: str) -> NDArray[Any]:
        """An array of the particles at this moment, as output.arrays names it: "stress" (n, 6), Pa, "strain", "J", ...

        Warns where particles have none, which are not-a-number. Raises Error for an unknown name, and where the body has no
        surface."""
        return tell_unknown(self._native.array(name), name, self._told)

    @checked
    def surface_array(self, name: str) -> NDArray[Any]:
        """An array by its name at the vertices of the surface, (v,) or (v, 6): means of the particles that each follows, by
        their weights. Raises Error as array() does."""
        return self._native.surface_array(name)

    @checked
    def dataset(self, series: str = "particles") -> Dataset:
        """What a file of the series would hold of this moment: particles, surface, bones, frames, ...

        Raises Error for a series that runs of the scene lack."""
        return Dataset(self._native.dataset(series), series)

    def to_vtk(self) -> Any:
        """A vtkMultiBlockDataSet with a named block for each of particles, surface, bones and frames."""
        names = ("particles", "surface", "bones", "frames") if len(self.faces) else ("particles", "bones", "frames")
        return vtk_composite({name: self.dataset(name) for name in names})

    @checked
    def write(self, folder: Path, force: bool = False) -> int:
        """Adds a frame of the present moment to the run in a folder: the number of frames so far.

        The first call begins the run, as simulate() would; `force` replaces one that is there. finish() ends it; without, the
        run has the status "stopped" once the simulation is gone. Raises Error where the simulation has made no step since the
        last frame, for a body without a surface, and as simulate() does."""
        return with_threads(self._threads, lambda: self._native.write(os.path.abspath(folder), force))

    def finish(self) -> Run:
        """Ends the run that write() has begun: the Run. Raises Error where none is being written."""
        return Run(self._native.finish())

    def save(self) -> State:
        """The present moment, its pose and forces set from here included: restore() goes on from it with the same bits."""
        return State._of(self._native.save())

    @checked
    def restore(self, state: State) -> None:
        """Goes back (or on) to a saved moment of this scene. Raises Error for one of another body."""
        self._native.restore(state._native)

    @property
    def bone_frames(self) -> NDArray[numpy.float64]:
        """Homogeneous matrices (bones, 4, 4): the axes of each bone, of which the first points along it, and its head, m."""
        return self._native.bone_frames

    @property
    def reactions(self) -> NDArray[numpy.float64]:
        """Force, N, and moment about its head, N m, of the body on each bone: (bones, 6)."""
        return self._native.reactions

    @property
    def time(self) -> float:
        """Time of the present moment, s; any thread may ask."""
        return self._native.time

    @property
    def steps(self) -> int:
        """Number of steps made; any thread may ask."""
        return self._native.steps

    @property
    def bones(self) -> list[str]:
        """Names of the bones, in the order of all arrays of bones."""
        return self._native.bones

    @property
    def positions(self) -> NDArray[numpy.float64]:
        """Positions of the particles (n, 3), m."""
        return self._native.positions

    @property
    def velocities(self) -> NDArray[numpy.float64]:
        """Velocities of the particles (n, 3), m/s."""
        return self._native.velocities

    @property
    def forces(self) -> NDArray[numpy.float64]:
        """Forces on the particles (n, 3), N: the sum of all terms."""
        return self._native.forces

    @property
    def surface(self) -> NDArray[numpy.float64]:
        """Vertices of the deformed skin (v, 3), m. Raises Error where the body has no surface."""
        return self._native.surface

    @property
    def faces(self) -> NDArray[numpy.int32]:
        """Faces of the skin (f, 3), as indices of its vertices."""
        return self._native.faces

    def __repr__(self):
        return f"<sinew.Simulation at {self.time:.6g} s, step {self.steps}: {len(self.bones)} bones>"
