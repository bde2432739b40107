#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes broken meshes for tests, always the same. Needs nothing but Python.

For a sphere, a torus and the creature, or for the MESHes given (closed, OBJ or PLY):
FOLDER/NAME_BREAK.ply, one per way to break it (data/broken.py), NAME_closed.ply being the whole
one. And FOLDER/SHAPE.ply, meshes that never had a clear inside (data/odd_shapes.py).
"""

import argparse
import sys
from pathlib import Path

import odd_shapes
from broken import BREAKS, snapped
from mesh_files import read_mesh, write_ply

CREATURE = Path(__file__).resolve().parent / "meshes" / "creature.ply"


def bases(paths):
    """The closed meshes by name."""
    if paths:
        return {path.stem: read_mesh(path) for path in paths}
    return {"sphere": odd_shapes.sphere(), "torus": odd_shapes.torus(),
            "creature": read_mesh(CREATURE)}


def write(folder, name, mesh):
    write_ply(folder / f"{name}.ply", ["Made by data/make_broken.py."], *mesh)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="FOLDER", type=Path, help="is made if needed")
    parser.add_argument("meshes", metavar="MESH", type=Path, nargs="*")
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    for name, mesh in bases(given.meshes).items():
        whole = snapped(mesh)
        for way, broken in BREAKS.items():
            write(given.folder, f"{name}_{way}", broken(whole))
    for name, shape in odd_shapes.SHAPES.items():
        write(given.folder, name, snapped(shape()))


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError) as error:
        print(f"make_broken.py: {error}", file=sys.stderr)
        sys.exit(2)
