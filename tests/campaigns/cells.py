#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume cells of every mesh in data and of every one that data/make_broken.py breaks: the tables of
lib/sinew/volume/README.md.

usage: cells.py BIN SOURCE [--update] [TABLE ...]      folder of the programs, folder of the project; --update writes
                                                       the tables into the page; TABLE: only whole, broken or odd
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

BIN, SOURCE = (Path(place).resolve() for place in sys.argv[1:3])
sys.path.insert(0, str(SOURCE / "data"))
import odd_shapes  # noqa: E402
from broken import BREAKS, shrunk, snapped, volume_of  # noqa: E402
from mesh_files import read_mesh  # noqa: E402

PAGE = SOURCE / "lib/sinew/volume/README.md"
WHOLE = [*sorted((SOURCE / "data/meshes").iterdir()), *sorted((SOURCE / "data/motions").glob("*.glb"))]
PACKINGS = {"fcc": [], "fcc, turned": ["--set", "body.lattice_rotation=random"], "hcp": ["--packing", "hcp"],
            "hcp, turned": ["--packing", "hcp", "--set", "body.lattice_rotation=random"]}
COUNTS = {"sphere": 2000, "torus": 5000, "creature": 20000}
IN_THIN_WALLS = 20  # times as many: the walls of a mesh in itself are thinner than a particle else
VOLUMES_OF_BOXES = {"non_manifold_edge": 0.002, "non_manifold_point": 0.002, "non_manifold_wall": 0.002,
                    "touching_boxes": 0.002}


def fill(mesh, *words):
    """The report of sinew fill, or why it refuses: "sinew: --count 5000: the surface has no inside: ..."."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([BIN / "sinew", "fill", mesh, "--json", "-o", Path(folder) / "filled.vtu",
                               *map(str, words)], capture_output=True, text=True, timeout=600)
    if done.returncode:
        return "refused: " + done.stderr.strip().splitlines()[-1].split(": ")[2]
    return json.loads(done.stdout)


def volume_by_particles(mesh, *size):
    """Of what is inside, by the particles of a turned lattice."""
    filled = fill(mesh, *size, *PACKINGS["fcc, turned"])
    return filled if isinstance(filled, str) else filled["particles"] * 32 ** 0.5 * filled["radius"] ** 3


def volume_of_broken(path, whole, way):
    """Of the inside of a whole mesh that is broken that way."""
    volume = volume_of(whole)
    known = {"nested_in": volume - volume_of(shrunk(whole)), "two_bodies": 2 * volume, "touching": 2 * volume,
             "tiny": volume * 1e-18, "huge": volume * 1e18}
    return volume_by_particles(path, "--count", 1000000) if way in ("overlapping", "open_base") else known.get(way, volume)


def described(mesh, volume, *words):
    """"13,888, +0.00 %, 20.1, 0.04 s"."""
    cells = fill(mesh, "--to", "tetrahedra", *words)
    if isinstance(cells, str):
        return cells
    error = 100 * (cells["volume"] / volume - 1)
    return (f"{cells['tetrahedra']:,}, {error:+.2f} %, {cells['smallest_angle']:.1f}, {cells['seconds_cells']:.2f} s")


def whole_rows():
    yield ["mesh", *PACKINGS]
    for path in WHOLE:
        volume = fill(path, "--count", 1000)["mesh_volume"]
        yield [path.name, *(described(path, volume, "--count", 20000, *words) for words in PACKINGS.values())]


def broken_rows(folder):
    wholes = {"sphere": snapped(odd_shapes.sphere()), "torus": snapped(odd_shapes.torus()),
              "creature": snapped(read_mesh(SOURCE / "data/meshes/creature.ply"))}
    yield ["broken", *wholes]
    for way in BREAKS:
        row = []
        for name, whole in wholes.items():
            path = folder / f"{name}_{way}.ply"
            count = COUNTS[name] * (IN_THIN_WALLS if way == "nested_in" else 1)
            row.append(described(path, volume_of_broken(path, whole, way), "--count", count))
        yield [way, *row]


def odd_rows(folder):
    yield ["odd", "cells, volume, smallest angle, time"]
    for name in odd_shapes.SHAPES:
        path = folder / f"{name}.ply"
        size = ("--radius", 0.004) if name == "random_triangles" else ("--count", 5000)
        volume = VOLUMES_OF_BOXES.get(name) or volume_by_particles(path, *size)
        yield [name, volume if isinstance(volume, str) else described(path, volume, *size)]


def table(rows):
    lines = []
    for row in rows:
        lines.append("| " + " | ".join(row) + " |")
        print(lines[-1], flush=True)
        if len(lines) == 1:
            lines.append("|---" * len(row) + "|")
    return "\n".join(lines)


def update(name, text):
    begin = f"<!-- cells: {name} -->\n"
    page = PAGE.read_text()
    first = page.index(begin) + len(begin)
    PAGE.write_text(page[:first] + text + "\n" + page[page.index("<!-- end of cells -->", first):])


def main():
    wanted = {"whole", "broken", "odd"} & set(sys.argv[3:])
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        subprocess.run([sys.executable, SOURCE / "data/make_broken.py", folder], check=True)
        for name, rows in (("whole", whole_rows()), ("broken", broken_rows(folder)), ("odd", odd_rows(folder))):
            if wanted and name not in wanted:
                continue
            text = table(rows)
            if "--update" in sys.argv:
                update(name, text)


if __name__ == "__main__":
    main()
