# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes: files, arrays, and what other packages have, to particles and answers."""
from __future__ import annotations

import json
import numbers
import os
import re
from collections.abc import Iterator, Mapping
from typing import Any

import numpy
from numpy.typing import ArrayLike, NDArray

from . import _sinew
from ._data import Dataset, particles_of_body, pyvista_of, trimesh_of
from ._error import Error, in_python
from ._progress import with_threads
from ._scene import Scene, read_scene
from ._values import Findings, Held, MeshLike, Path, checked, is_path, pairs, shown


def _shown(data):
    """Of VTK's polygons, which are neither copies of another piece's nor hidden; None: all."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    flags = data.GetCellData().GetArray("vtkGhostType")
    if not flags:
        return None
    before = data.GetNumberOfVerts() + data.GetNumberOfLines()
    return vtk_to_numpy(flags)[before:before + data.GetNumberOfPolys()] & 33 == 0


def _arrays_of_vtk(data):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    if not data.GetNumberOfPoints():
        raise Error("vertices are empty; give a vtkPolyData with points")
    points, polygons = vtk_to_numpy(data.GetPoints().GetData()), data.GetPolys()
    if data.GetStrips().GetNumberOfCells():
        raise Error("the mesh has triangle strips; apply vtkTriangleFilter first")
    corners = vtk_to_numpy(polygons.GetConnectivityArray())
    offsets = vtk_to_numpy(polygons.GetOffsetsArray())
    sizes, shown, warning = numpy.diff(offsets), _shown(data), ""
    if shown is not None and not shown.all():
        corners, sizes = corners[numpy.repeat(shown, sizes)], sizes[shown]
        offsets = numpy.concatenate(([0], numpy.cumsum(sizes)))
        warning = (f"polygons that are left out, as copies of another piece's (ghosts) or hidden: {(~shown).sum()} of "
                   f"{len(shown)}")
    if len(sizes) and (sizes == sizes[0]).all():
        return points, corners.reshape(-1, sizes[0]), warning
    return points, numpy.insert(corners, offsets[:-1], sizes), warning


def _arrays_of_cells(mesh):
    """Of meshio's meshes, their polygons."""
    faces = [block.data for block in mesh.cells if block.type in ("triangle", "quad") or block.type.startswith("polygon")]
    if not faces:
        kinds = ", ".join(sorted({block.type for block in mesh.cells})) or "none"
        raise Error(f"faces are missing: the cells are {kinds}; give the polygons of the surface")
    return mesh.points, faces[0] if len(faces) == 1 else [list(face) for block in faces for face in block]


def _arrays_of_scene(scene):
    """Of a trimesh.Scene, all meshes where it shows them, as one."""
    parts = [part for part in scene.dump() if len(getattr(part, "faces", ()))]
    if not parts:
        raise Error("the Scene shows no meshes; give one with faces")
    before = numpy.cumsum([0] + [len(part.vertices) for part in parts])
    return (numpy.concatenate([part.vertices for part in parts]),
            numpy.concatenate([part.faces + first for part, first in zip(parts, before)]))


def polygons_of(mesh, faces=None):
    """The polygons of arrays, or of a mesh of trimesh (or its Scene), VTK, PyVista or meshio."""
    if is_path(mesh):
        raise Error(f"{os.fspath(mesh)!r} is a path; give vertices and faces, or ask sinew.info() about the file")
    warning = ""
    if faces is None:
        if isinstance(mesh, (tuple, list)) and len(mesh) == 2:
            mesh, faces = mesh
        elif hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
            mesh, faces = mesh.vertices, mesh.faces
        elif hasattr(mesh, "geometry") and hasattr(mesh, "dump"):
            mesh, faces = _arrays_of_scene(mesh)
        elif hasattr(mesh, "GetPolys"):
            mesh, faces, warning = _arrays_of_vtk(mesh)
        elif hasattr(mesh, "GetClassName"):
            raise Error(f"the mesh is a {mesh.GetClassName()}; extract its surface as vtkPolyData (vtkGeometryFilter)")
        elif hasattr(mesh, "points") and hasattr(mesh, "cells"):
            mesh, faces = _arrays_of_cells(mesh)
    return _sinew._polygons(mesh, faces, warning)


def _surface(mesh, faces, options):
    return _sinew._surface(polygons_of(mesh, faces), pairs({f"body.{key}": value for key, value in options.items()}))


class Body(Held):
    """Particles at rest, filled by fill() or made from arrays.

    points (n, 3), m; `radius`, m, and `mass`, kg, of each; without a mass, that of `density`, kg/m^3, in the share of a
    closest packing. Raises Error for points that are not finite, and where radius or mass is not above 0."""

    @checked
    def __init__(self, points: ArrayLike, radius: float, mass: float | None = None, density: float = 1000.0) -> None:
        super().__init__(_sinew._Body(points, radius, mass, density))

    @property
    def points(self) -> NDArray[numpy.float64]:
        """Positions of the particles (n, 3), m."""
        return self._native.points

    @property
    def component(self) -> NDArray[numpy.int32]:
        """Which part of the mesh each particle is in (n,), from 0; empty: made from arrays."""
        return self._native.component

    @property
    def neighbors(self) -> NDArray[numpy.int32]:
        """How many others each particle touches (n,); empty: made from arrays."""
        return self._native.neighbors

    @property
    def vertices(self) -> NDArray[numpy.float64]:
        """Vertices of the surface that was filled (v, 3), m; empty: made from arrays."""
        return self._native.vertices

    @property
    def faces(self) -> NDArray[numpy.int32]:
        """Faces of that surface (f, 3), as indices of vertices."""
        return self._native.faces

    @property
    def radius(self) -> float:
        """Radius of each particle, m."""
        return self._native.radius

    @property
    def mass(self) -> float:
        """Mass of each particle, kg."""
        return self._native.mass

    @property
    def report(self) -> dict[str, Any]:
        """What filling found, by name, as body.vtu keeps it; empty: made from arrays."""
        return json.loads(self._native._meta)["fill"] if self._native._meta else {}

    @property
    def warnings(self) -> list[str]:
        """What is doubtful of the filling: texts, each with its cure."""
        return [*map(in_python, self._native.warnings)]

    def __len__(self) -> int:
        return len(self._native)

    def __repr__(self):
        of = f" in {len(self.faces)} faces" if len(self.faces) else ""
        return f"<sinew.Body: {len(self)} particles of radius {self.radius:.6g} m, {self.mass * len(self):.6g} kg{of}>"

    def to_vtk(self) -> Any:
        """A vtkUnstructuredGrid on the same memory: a vertex for each particle, with the arrays of body.vtu."""
        return particles_of_body(self)

    def to_pyvista(self) -> Any:
        """A pyvista.UnstructuredGrid of the same. Raises Error where pyvista is not installed."""
        return pyvista_of(self.to_vtk())

    def to_trimesh(self) -> Any:
        """The surface as a trimesh.Trimesh. Raises Error where trimesh is not installed, or there is no surface."""
        if not len(self.faces):
            raise Error("this body has no surface; fill a mesh")
        return trimesh_of(self.vertices, self.faces)


class RestShape(Held):
    """Points (n, 3) at rest, of any program; those closer than `cutoff` (the points' unit) are neighbors, found once.

    The deformation of a later moment is the least-squares fit over them (Falk and Langer 1998). Raises Error for a cutoff
    that is not above 0, and for one with more neighbors than there is memory for."""

    @checked
    def __init__(self, points: ArrayLike, cutoff: float) -> None:
        super().__init__(_sinew._RestShape(points, cutoff))

    @property
    def points(self) -> NDArray[numpy.float64]:
        """The points at rest (n, 3)."""
        return self._native.points

    def __len__(self) -> int:
        return len(self._native)

    def __repr__(self):
        return f"<sinew.RestShape of {len(self)} points, {self._native.pairs} pairs>"

    @checked
    def gradients(self, now: ArrayLike) -> tuple[NDArray[numpy.float64], NDArray[numpy.float64]]:
        """Deformation gradients F (n, 3, 3) and D2min (n,), the mean of |dx - F dX|^2 over the neighbors.

        `now` (n, 3): the points in the same order, not-a-number where one is gone. Both are not-a-number there, and where
        the neighbors lie in a plane. Raises Error for another number of points."""
        return self._native.gradients(now)

    @checked
    def arrays(self, now: ArrayLike) -> dict[str, NDArray[numpy.float64]]:
        """What follows from these, by name: F and R of F = R U (n, 9), row by row, strain (n, 6) (Green-Lagrange; XX, YY, ZZ,
        XY, YZ, XZ), stretch (n, 3) (the largest first), J, strain_eq, D2min, and rotation, the angle of R in degrees (n,).

        `now` as in gradients(). Raises Error for another number of points."""
        return self._native.arrays(now)


class Mesh(Held):
    """A surface as fill() takes it: triangles, points merged, faces oriented outward.

    Made by repair(). Unpacks into its arrays: vertices, faces = sinew.repair(V, F)."""

    @property
    def vertices(self) -> NDArray[numpy.float64]:
        """Positions of the vertices (n, 3), m."""
        return self._native.vertices

    @property
    def faces(self) -> NDArray[numpy.int32]:
        """Vertices of each face (m, 3), counterclockwise from outside."""
        return self._native.faces

    @property
    def component(self) -> NDArray[numpy.int32]:
        """Number of each face's component (m,): faces joined by edges."""
        return self._native.component

    @property
    def closed(self) -> bool:
        """Whether each edge has two faces."""
        return self._native.closed

    @property
    def changes(self) -> dict[str, int]:
        """How many points and faces were merged, dropped, turned, added, by name."""
        return self._native.changes

    def __iter__(self) -> Iterator[NDArray[Any]]:
        return iter((self.vertices, self.faces))

    def __len__(self):
        return 2

    @checked
    def __getitem__(self, index: int) -> NDArray[Any]:
        return (self.vertices, self.faces)[index]

    def __repr__(self):
        state = "closed" if self.closed else "open"
        return f"<sinew.Mesh: {len(self.vertices)} vertices, {len(self.faces)} faces, {state}>"

    def to_trimesh(self) -> Any:
        """A trimesh.Trimesh of the same arrays. Raises Error where trimesh is not installed."""
        return trimesh_of(self.vertices, self.faces)


class Diagnosis(Findings):
    """What is in a mesh and what is wrong with it, as `sinew info` finds it, and where: a dict with arrays beside.

    Made by diagnose(). Indices are of `mesh`. Per face (m,): `turned` (against the given order of corners), `intersecting`
    (another face), `flat`. `edges` (k, 2) are those with a defect: `edge_defects` (k,) says open, crowded or twisted, `holes`
    (k,) which hole it borders, -1 for none."""

    mesh: Mesh
    turned: NDArray[numpy.bool_]
    intersecting: NDArray[numpy.bool_]
    flat: NDArray[numpy.bool_]
    edges: NDArray[numpy.int32]
    edge_defects: NDArray[numpy.str_]
    holes: NDArray[numpy.int32]

    def __init__(self, surface):
        text, warnings, where = _sinew._diagnose(surface)
        super().__init__(text, warnings)
        self.mesh = Mesh(surface)
        for name, array in where.items():
            setattr(self, name, array)

    def to_vtk(self) -> Any:
        """The mesh with its defective edges, as `sinew info -o` draws it: a vtkUnstructuredGrid with the array defect."""
        return Dataset(self._drawing, "defects").to_vtk()


@checked
def diagnose(mesh: MeshLike, faces: ArrayLike | None = None, **options: Any) -> Diagnosis:
    """What is in a mesh, and what is wrong with it and where: a Diagnosis.

    Takes vertices (n, 3), m, and faces, or a mesh as fill() does, but not a path; options as repair(). Raises Error, which
    names the vertex or face, for arrays that are no mesh."""
    return Diagnosis(_surface(mesh, faces, options))


@checked
def repair(mesh: MeshLike, faces: ArrayLike | None = None, **options: Any) -> Mesh:
    """A Mesh that can be filled: polygons cut into triangles, equal points merged, collapsed and doubled faces dropped,
    faces oriented outward.

    Takes what diagnose() takes. Options of a scene's section body do more: close_holes=True, wrap=0.01 (m), weld=1e-6 (m).
    Raises Error for arrays that are no mesh."""
    return Mesh(_surface(mesh, faces, options))


def _queried(mesh, faces, points):
    """Surface and points of (vertices, faces, points) or (mesh, points)."""
    return (_surface(mesh, None, {}), faces) if points is None else (_surface(mesh, faces, {}), points)


@checked
def distance(mesh: MeshLike, faces: ArrayLike | None = None, points: ArrayLike | None = None,
             signed: bool = False) -> NDArray[numpy.float64]:
    """Distance of each point (n, 3) from the nearest face: (n,), m.

    `signed`: negative inside, where the winding number is above 1/2. Also distance(mesh, points), of a mesh as fill() takes
    it, but not a path. Raises Error for arrays of other shapes."""
    surface, points = _queried(mesh, faces, points)
    away = surface.distance(points)
    return numpy.where(surface.winding_number(points) > 0.5, -away, away) if signed else away


@checked
def winding_number(mesh: MeshLike, faces: ArrayLike | None = None, points: ArrayLike | None = None) -> NDArray[numpy.float64]:
    """Generalized winding number of the surface about each point (n, 3): (n,), 1 inside and 0 outside of a closed one.

    The surface is as fill() takes it: faces are oriented first. Not-a-number on it (Jacobson et al. 2013).
    Raises Error for arrays of other shapes."""
    surface, points = _queried(mesh, faces, points)
    return surface.winding_number(points)


def _by_settings(kinds, mesh, faces, radius, count, density, threads, options):
    """Calls one of (of a path, of polygons, of a scene)."""
    if isinstance(faces, numbers.Number):
        raise Error(f"faces are {faces}; give radius={faces} or count={faces} by its name")
    values = pairs({"body.radius": radius, "body.count": count, "material.density": density,
                    **{f"body.{key}": value for key, value in options.items()}})
    if radius is not None and count is not None:
        raise Error("the size of the particles is given twice; keep one of radius and count")
    of_path, of_polygons, of_scene = kinds
    if isinstance(mesh, Scene):
        if values or faces is not None:
            raise Error("a scene says itself what is filled, and how; read it with these settings")
        return with_threads(threads, lambda: of_scene(mesh._native))
    if is_path(mesh) and faces is None:
        return with_threads(threads, lambda: of_path(mesh, values))
    return with_threads(threads, lambda: of_polygons(polygons_of(mesh, faces), values))


@checked
def fill(mesh: MeshLike, faces: ArrayLike | None = None, radius: float | None = None, count: int | None = None,
         density: float | None = None, *, threads: int = 0, **options: Any) -> Body:
    """Fills a mesh with closest-packed particles of this radius (m) or about this count: a Body.

    The mesh: vertices (n, 3) and faces (m, 3), (m, k) or a list of lists; a pair of them; the path of a file; a Scene,
    which says itself how it is filled; or a mesh of trimesh (or its Scene), PyVista, VTK or meshio. `density` is in kg/m^3.
    Options are the keys of a scene's section body: unit="mm", packing="hcp", clearance=0.001 (m), close_holes=True, ...
    `threads`: at most so many, 0 one per core. Raises Error for what is no mesh, for an unknown option, and where no particle
    fits."""
    kinds = _sinew._fill, _sinew._fill_polygons, _sinew._fill_scene
    return Body._of(_by_settings(kinds, mesh, faces, radius, count, density, threads, options))


@checked
def tetrahedra(mesh: MeshLike, faces: ArrayLike | None = None, radius: float | None = None, count: int | None = None,
               *, threads: int = 0, **options: Any) -> Dataset:
    """Tetrahedra between the particles that fill() finds, up to the surface: a Dataset, whose `cells` are (m, 4).

    Takes what fill() takes; `points` (n, 3) are in m. Raises Error as fill() does."""
    kinds = _sinew._tetrahedra, _sinew._tetrahedra_polygons, _sinew._tetrahedra_scene
    return Dataset(_by_settings(kinds, mesh, faces, radius, count, None, threads, options), "volume")


class NewScene:
    """A scene that new() has written, and returns.

    `path` and `mesh` name its files, `reasons` says by name (unit, up, bones, rest, size, time) what was chosen and why, and
    `warnings` what is doubtful."""

    path: str
    mesh: str
    reasons: dict[str, str]
    warnings: list[str]

    def __init__(self, found):
        self.path, self.mesh, warning = found["path"], found["mesh"], found["warning"]
        keys = [key for key in ("unit", "up", "bones", "rest", "size", "time") if found[key]]
        self.reasons = {key: re.sub(r" \(--up .*\)", "", found[key]) for key in keys}
        self.warnings = [in_python(warning)] if warning else []

    @property
    def scene(self) -> Scene:
        """The Scene, read anew from its file, which may have been edited."""
        return read_scene(self.path)

    def __repr__(self):
        return "\n".join([f"<sinew.NewScene {self.path!r}>", *(f"  {key}: {why}" for key, why in self.reasons.items())])


@checked
def new(mesh: MeshLike, rig: Any = None, scene: Path | None = None, faces: ArrayLike | None = None,
        force: bool = False, quick: bool = False) -> NewScene:
    """Writes a scene for a mesh, with bones and motion, as `sinew new` does: a NewScene.

    `mesh` as in fill(), or a rig alone; `rig`: a BVH or glTF file; `scene`: the path, by default NAME-OF-MESH.yaml here
    (mesh.yaml of arrays, whose mesh is written beside it, in double); `force` replaces one that is there; `quick`: it
    runs in ten seconds or so, by few particles and 2 s at most. Raises Error where one is there without force, and for what
    is no mesh or rig."""
    if not is_path(mesh) and rig is not None and not is_path(rig):  # new(vertices, faces)
        faces, rig = rig, None
    words = (os.fspath(rig) if rig is not None else "", os.fspath(scene) if scene is not None else "", force, quick)
    if is_path(mesh) and faces is None:
        return NewScene(_sinew._new(mesh, *words))
    return NewScene(_sinew._new_of_polygons(polygons_of(mesh, faces), *words))


@checked
def info(path: Any, settings: Mapping | None = None, radius: float | None = None, verify: bool = False,
         drawing: Path | None = None) -> Findings:
    """What is in a mesh, rig, clip, scene or run, as `sinew info --json` has it: a dict, with `warnings`.

    `settings` as of read_scene(), of a mesh those of its section: {"body.unit": "mm"}; `radius` (m): how fast a rig moves
    such particles; `verify` compares a run with its checksums; `drawing`: a .vtu file of the mesh's defects to be written.
    Raises Error, which names the file, where it is damaged."""
    if not is_path(path):
        raise Error(f"path is {shown(path)}: info() describes files; of arrays use diagnose()")
    drawn = os.fspath(drawing) if drawing is not None else ""
    return Findings(*_sinew._info(path, pairs(settings or {}), radius, verify, drawn))
