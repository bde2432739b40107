# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes: files, arrays, and what other packages have, to particles and answers."""
import json
import numbers
import os

import numpy

from . import _sinew
from ._data import Dataset, particles_of_body, pyvista_of, trimesh_of
from ._values import Findings, is_path, pairs


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
        raise _sinew.Error("vertices are empty; give a vtkPolyData with points")
    points, polygons = vtk_to_numpy(data.GetPoints().GetData()), data.GetPolys()
    if data.GetStrips().GetNumberOfCells():
        raise _sinew.Error("the mesh has triangle strips; apply vtkTriangleFilter first")
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
        raise _sinew.Error(f"faces are missing: the cells are {kinds}; give the polygons of the surface")
    return mesh.points, faces[0] if len(faces) == 1 else [list(face) for block in faces for face in block]


def _arrays_of_scene(scene):
    """Of a trimesh.Scene, all meshes where it shows them, as one."""
    parts = [part for part in scene.dump() if len(getattr(part, "faces", ()))]
    if not parts:
        raise _sinew.Error("the Scene shows no meshes; give one with faces")
    before = numpy.cumsum([0] + [len(part.vertices) for part in parts])
    return (numpy.concatenate([part.vertices for part in parts]),
            numpy.concatenate([part.faces + first for part, first in zip(parts, before)]))


def polygons_of(mesh, faces=None):
    """The polygons of arrays, or of a mesh of trimesh (or its Scene), VTK, PyVista or meshio."""
    if is_path(mesh):
        raise _sinew.Error(f"{os.fspath(mesh)!r} is a path; give vertices and faces, or ask sinew.info() about the file")
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
            raise _sinew.Error(f"the mesh is a {mesh.GetClassName()}; extract its surface as vtkPolyData (vtkGeometryFilter)")
        elif hasattr(mesh, "points") and hasattr(mesh, "cells"):
            mesh, faces = _arrays_of_cells(mesh)
    return _sinew._polygons(mesh, faces, warning)


def _surface(mesh, faces, options):
    return _sinew._surface(polygons_of(mesh, faces), pairs({f"body.{key}": value for key, value in options.items()}))


class Mesh:
    """A surface as fill() takes it: triangles, points merged, faces oriented outward.

    Unpacks into its arrays: vertices, faces = sinew.repair(V, F)."""

    def __init__(self, surface):
        self._surface = surface

    @property
    def vertices(self):
        """(n, 3), m."""
        return self._surface.vertices

    @property
    def faces(self):
        """(m, 3)."""
        return self._surface.faces

    @property
    def component(self):
        """Number of each face's component: faces joined by edges."""
        return self._surface.component

    @property
    def closed(self):
        return self._surface.closed

    @property
    def changes(self):
        """How many points and faces were merged, dropped, turned, added, by name."""
        return self._surface.changes

    def __iter__(self):
        return iter((self.vertices, self.faces))

    def __len__(self):
        return 2

    def __getitem__(self, index):
        return (self.vertices, self.faces)[index]

    def __repr__(self):
        state = "closed" if self.closed else "open"
        return f"<sinew.Mesh: {len(self.vertices)} vertices, {len(self.faces)} faces, {state}>"

    def to_trimesh(self):
        """A trimesh.Trimesh of the same arrays."""
        return trimesh_of(self.vertices, self.faces)


class Diagnosis(Findings):
    """What is in a mesh and what is wrong with it, as `sinew info` finds it, and where.

    Indices are of `mesh`. Per face: turned (against the given order of corners), intersecting (another face), flat.
    `edges` (n, 2) are those with a defect: edge_defects says open, crowded or twisted, holes which hole it borders."""

    def __init__(self, surface):
        text, warnings, where = _sinew._diagnose(surface)
        super().__init__(text, warnings)
        self.mesh = Mesh(surface)
        for name, array in where.items():
            setattr(self, name, array)

    def to_vtk(self):
        """The mesh with its defective edges, as `sinew info -o` draws it: a vtkUnstructuredGrid with the array defect."""
        return Dataset(self._drawing, "defects").to_vtk()


def diagnose(mesh, faces=None, **options):
    """What is in a mesh, and what is wrong with it and where: a Diagnosis.

    Takes arrays, or a mesh as fill() does, but not a path; options as repair()."""
    return Diagnosis(_surface(mesh, faces, options))


def repair(mesh, faces=None, **options):
    """A Mesh that can be filled: polygons cut into triangles, equal points merged, collapsed and doubled faces dropped,
    faces oriented outward. Options of a scene's section body do more: close_holes=True, wrap=0.01, weld=1e-6."""
    return Mesh(_surface(mesh, faces, options))


def _queried(mesh, faces, points):
    """Surface and points of (vertices, faces, points) or (mesh, points)."""
    return (_surface(mesh, None, {}), faces) if points is None else (_surface(mesh, faces, {}), points)


def distance(mesh, faces=None, points=None, signed=False):
    """Distance of each point (n, 3) from the nearest face: (n,). `signed`: negative inside, where the winding number
    is above 1/2. Also distance(mesh, points), of a mesh as fill() takes it, but not a path."""
    surface, points = _queried(mesh, faces, points)
    away = surface.distance(points)
    return numpy.where(surface.winding_number(points) > 0.5, -away, away) if signed else away


def winding_number(mesh, faces=None, points=None):
    """Generalized winding number of the surface about each point (n, 3): (n,), 1 inside and 0 outside of a closed one.

    The surface is as fill() takes it: faces are oriented first. Not-a-number on it (Jacobson et al. 2013)."""
    surface, points = _queried(mesh, faces, points)
    return surface.winding_number(points)


def _by_settings(kinds, mesh, faces, radius, count, density, options):
    """Calls one of (of a path, of polygons, of a scene)."""
    if isinstance(faces, numbers.Number):
        raise _sinew.Error(f"faces are {faces}; give radius={faces} or count={faces} by its name")
    values = pairs({"body.radius": radius, "body.count": count, "material.density": density,
                    **{f"body.{key}": value for key, value in options.items()}})
    if radius is not None and count is not None:
        raise _sinew.Error("the size of the particles is given twice; keep one of radius and count")
    of_path, of_polygons, of_scene = kinds
    if isinstance(mesh, _sinew.Scene):
        if values or faces is not None:
            raise TypeError("a scene says itself what is filled, and how; read it with these settings")
        return of_scene(mesh)
    if is_path(mesh) and faces is None:
        return of_path(mesh, values)
    return of_polygons(polygons_of(mesh, faces), values)


def fill(mesh, faces=None, radius=None, count=None, density=None, **options):
    """Fills a mesh with closest-packed particles of this radius (m) or about this count: a Body.

    The mesh: vertices (n, 3) and faces (m, 3), (m, k) or a list of lists; a pair of them; the path of a file; a Scene,
    which says itself how it is filled; or a mesh of trimesh (or its Scene), PyVista, VTK or meshio. Options are the keys of a scene's
    section body: unit="mm", packing="hcp", clearance=0.001, close_holes=True, ..."""
    kinds = _sinew._fill, _sinew._fill_polygons, _sinew._fill_scene
    return _by_settings(kinds, mesh, faces, radius, count, density, options)


def tetrahedra(mesh, faces=None, radius=None, count=None, **options):
    """Tetrahedra between the particles that fill() finds, up to the surface: a Dataset, whose `cells` are (m, 4)."""
    kinds = _sinew._tetrahedra, _sinew._tetrahedra_polygons, _sinew._tetrahedra_scene
    return Dataset(_by_settings(kinds, mesh, faces, radius, count, None, options), "volume")


class NewScene:
    """A scene that new() has written: its path and what was chosen, with the reasons."""

    def __init__(self, found):
        self.path, self.mesh, warning = found["path"], found["mesh"], found["warning"]
        self.reasons = {key: found[key] for key in ("unit", "up", "bones", "rest", "size") if found[key]}
        self.warnings = [warning] if warning else []

    @property
    def scene(self):
        return _sinew._read_scene(self.path, [])

    def __repr__(self):
        return "\n".join([f"<sinew.NewScene {self.path!r}>", *(f"  {key}: {why}" for key, why in self.reasons.items())])


def new(mesh, rig=None, scene=None, faces=None, force=False):
    """Writes a scene for a mesh, with bones and motion, as `sinew new` does: a NewScene.

    `mesh` as in fill(), or a rig alone; `rig`: a BVH or glTF file; `scene`: the path, by default NAME-OF-MESH.yaml here
    (mesh.yaml of arrays, whose mesh is written beside it, in double)."""
    if not is_path(mesh) and rig is not None and not is_path(rig):  # new(vertices, faces)
        faces, rig = rig, None
    words = (os.fspath(rig) if rig is not None else "", os.fspath(scene) if scene is not None else "", force)
    if is_path(mesh) and faces is None:
        return NewScene(_sinew._new(mesh, *words))
    return NewScene(_sinew._new_of_polygons(polygons_of(mesh, faces), *words))


def info(path, settings=None, radius=None, verify=False, drawing=None):
    """What is in a mesh, rig, clip, scene or run, as `sinew info --json` has it: a dict, with `warnings`.

    `settings` as of read_scene(), of a mesh those of its section: {"body.unit": "mm"}; `radius` (m): how fast a rig moves
    such particles; `verify` compares a run with its checksums; `drawing`: a .vtu file of the mesh's defects to be written."""
    drawn = os.fspath(drawing) if drawing is not None else ""
    if not is_path(path):
        raise _sinew.Error("info() describes files; of arrays use diagnose()")
    return Findings(*_sinew._info(path, pairs(settings or {}), radius, verify, drawn))


def check(scene, folder="."):
    """What a run of the scene (or of a scene's file) would need, how its body behaves, and which settings are doubtful, as
    `sinew check --json` has it: a dict, with `warnings`. Disk space is that of `folder`."""
    return Findings(*_sinew._check(_sinew._read_scene(scene, []) if is_path(scene) else scene, folder))


def _report(body):
    return json.loads(body._meta)["fill"] if body._meta else {}


def _to_trimesh(body):
    if not len(body.faces):
        raise _sinew.Error("this body has no surface; fill a mesh")
    return trimesh_of(body.vertices, body.faces)


def _repr(body):
    of = f" in {len(body.faces)} faces" if len(body.faces) else ""
    return f"<sinew.Body: {len(body)} particles of radius {body.radius:.6g} m, {body.mass * len(body):.6g} kg{of}>"


_sinew.Body.report = property(_report, doc="What filling found, by name, as body.vtu keeps it.")
_sinew.Body.to_vtk = particles_of_body
_sinew.Body.to_pyvista = lambda body: pyvista_of(particles_of_body(body))
_sinew.Body.to_trimesh = _to_trimesh
_sinew.Body.__repr__ = _repr
