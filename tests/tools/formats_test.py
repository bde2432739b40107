#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Particles for other programs: every format is loaded by its program where Debian has it (LAMMPS, ASE, YADE,
meshio), else read here by its description, and compared with body.vtu or with the frames of the run.

usage: formats_test.py BIN SOURCE      YADE and ASE are left out where they are not installed
"""
import csv
import json
import os
import re
import shutil
import struct
import subprocess
import unittest
from pathlib import Path

import meshio
import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from small_run import SCENE, SOURCE, SmallRun, sinew

try:
    import ase.io
except ImportError:
    ase = None


def read_lammps(path):
    """Sections of a data file: name -> rows of words."""
    sections, name = {}, None
    for line in path.read_text().splitlines()[1:]:
        words = line.split("#")[0].split()
        if words and words[0][0].isupper():
            name = words[0]
            sections[name] = []
        elif words and name:
            sections[name].append([float(word) for word in words])
    return {name: np.array(sorted(rows)) for name, rows in sections.items()}


def run_lammps(folder, *commands):
    """What LAMMPS says of these commands."""
    (folder / "in.lmp").write_text("\n".join(["units si", "atom_style bond", "boundary s s s", *commands]) + "\n")
    # Open MPI removes the folder of its sessions when it ends, also from under a program that begins.
    done = subprocess.run(["lmp", "-in", "in.lmp", "-log", "none"], cwd=folder, capture_output=True, text=True,
                          env={**os.environ, "OMPI_MCA_orte_tmpdir_base": str(folder)}, timeout=100)
    if done.returncode:
        raise AssertionError(done.stdout + done.stderr)
    return dict(line.split(": ", 1) for line in done.stdout.splitlines() if line.startswith("said "))


def read_bgeo(path):
    """Partio's reading of Houdini's classic format: name -> values of every point."""
    data, at = path.read_bytes(), 0

    def take(code):
        nonlocal at
        values = struct.unpack_from(">" + code, data, at)
        at += struct.calcsize(">" + code)
        return values

    magic, version, points, prims, *_, attributes, vertex, prim, detail = take("5s9i")
    assert (magic, version, prims, vertex, prim, detail) == (b"BgeoV", 5, 0, 0, 0, 0)
    columns = [("position", "f", 4)]
    for _ in range(attributes):
        name = take(f"{take('H')[0]}s")[0].decode()
        size, kind = take("Hi")
        take(f"{size}i")
        columns.append((name, {0: "f", 1: "i", 5: "f"}[kind], size))
    rows = [[take(f"{size}{kind}") for _, kind, size in columns] for _ in range(points)]
    assert data[at:] == b"\0\xff"
    return {name: np.array([row[k] for row in rows]) for k, (name, _, _) in enumerate(columns)}


def read_glb(path):
    """Its points in sinew's axes, and its JSON."""
    data = path.read_bytes()
    magic, version, size, json_size, kind = struct.unpack_from("<4sIII4s", data)
    assert (magic, version, size, kind) == (b"glTF", 2, len(data), b"JSON")
    told = json.loads(data[20:20 + json_size])
    assert struct.unpack_from("<I4s", data, 20 + json_size) == (told["buffers"][0]["byteLength"], b"BIN\0")
    points = np.frombuffer(data, "<f4", offset=28 + json_size).reshape(-1, 3)
    accessor = told["accessors"][0]
    assert accessor["count"] == len(points)
    assert np.array_equal(accessor["min"], points.min(0)) and np.array_equal(accessor["max"], points.max(0))
    return (points + np.array(told["nodes"][0]["translation"]))[:, [2, 0, 1]], told


def pairs_within(points, distance):
    return {(i, j) for i in range(len(points)) for j in range(i + 1, len(points))
            if np.linalg.norm(points[i] - points[j]) < distance}


class Filled(SmallRun):
    """Two boxes, filled for each format."""

    def setUp(self):
        super().setUp()
        mesh = meshio.read(SOURCE / "data/meshes/box.obj")
        faces = np.concatenate([block.data for block in mesh.cells if block.type == "triangle"])
        away = mesh.points + [1, 0, 0]
        self.mesh = self.folder / "boxes.obj"
        meshio.write_points_cells(self.mesh, np.concatenate([mesh.points, away]),
                                  [("triangle", np.concatenate([faces, faces + len(mesh.points)]))])
        self.body = meshio.read(self.fill("vtu", "body.vtu"))
        self.points = self.body.points
        self.mass = self.body.point_data["mass"].sum()
        self.component = self.body.point_data["component"]
        self.assertEqual(set(self.component), {0, 1})

    def fill(self, to, name):
        path = self.folder / name
        sinew("fill", self.mesh, "--radius", 0.03, "--to", to, "-o", path, check=0)
        return path

    @unittest.skipUnless(shutil.which("lmp"), "LAMMPS is not installed")
    def test_lammps_reads_the_data(self):
        self.fill("lammps", "body.data")
        said = run_lammps(self.folder, "read_data body.data", "bond_style zero", "bond_coeff *",
                          "variable m equal mass(all)", "variable n equal count(all)", "run 0", 'print "said mass: $(v_m:%.15g)"',
                          'print "said atoms: ${n}"', "write_data back.data")
        self.assertEqual(float(said["said atoms"]), len(self.points))
        self.assertAlmostEqual(float(said["said mass"]) / self.mass, 1, 12)
        back = read_lammps(self.folder / "back.data")
        np.testing.assert_allclose(back["Atoms"][:, 3:6], self.points, rtol=0, atol=1e-14)
        np.testing.assert_array_equal(back["Atoms"][:, 1], self.component + 1)
        bonds = {tuple(sorted((int(a) - 1, int(b) - 1))) for _, _, a, b in back["Bonds"]}
        self.assertEqual(bonds, pairs_within(self.points, 2.2 * 0.03))
        self.assertEqual(len(bonds) * 2, self.body.point_data["neighbors"].sum())

    @unittest.skipUnless(shutil.which("lmp"), "LAMMPS is not installed")
    def test_lammps_reads_the_dump(self):
        self.fill("lammps", "body.data")
        moved = self.fill("dump", "body.dump")
        moved.write_text(moved.read_text().replace("TIMESTEP\n0\n", "TIMESTEP\n5\n"))
        run_lammps(self.folder, "read_data body.data", "displace_atoms all move 0.01 0 0 units box", "bond_style zero",
                   "bond_coeff *", "read_dump body.dump 5 x y z box no", "run 0", "write_data back.data")
        np.testing.assert_allclose(read_lammps(self.folder / "back.data")["Atoms"][:, 3:6], self.points, rtol=0,
                                   atol=1e-14)

    @unittest.skipUnless(ase, "ASE is not installed")
    def test_ase_reads_xyz(self):
        atoms = ase.io.read(self.fill("xyz", "body.xyz"))
        np.testing.assert_array_equal(atoms.positions, self.points)
        self.assertAlmostEqual(atoms.arrays["mass"].sum() / self.mass, 1, 12)
        np.testing.assert_array_equal(atoms.arrays["component"], self.component)
        self.assertFalse(atoms.pbc.any())

    def test_csv(self):
        with open(self.fill("csv", "body.csv"), newline="") as file:
            rows = list(csv.DictReader(file))
        np.testing.assert_array_equal([[float(row[axis]) for axis in "xyz"] for row in rows], self.points)
        self.assertAlmostEqual(sum(float(row["mass"]) for row in rows) / self.mass, 1, 12)
        self.assertAlmostEqual(sum(float(row["volume"]) for row in rows) / self.mass * 1000, 1, 12)
        self.assertEqual([int(row["component"]) for row in rows], list(self.component))

    def yade_rows(self):
        lines = self.fill("yade", "body.txt").read_text().splitlines()
        self.assertEqual(lines[0], "#format x_y_z_r_matId")
        density = float(lines[1].split(":")[1])
        return density, np.array([[float(word) for word in line.split()] for line in lines if line[0] != "#"])

    def test_yade(self):
        density, rows = self.yade_rows()
        np.testing.assert_array_equal(rows[:, :3], self.points)
        self.assertAlmostEqual((density * 4 / 3 * np.pi * rows[:, 3] ** 3).sum() / self.mass, 1, 12)

    @unittest.skipUnless(shutil.which("yade"), "YADE is not installed")
    def test_yade_reads_it(self):
        density, _ = self.yade_rows()
        (self.folder / "load.py").write_text(f"""
from yade import ymport
import json
O.materials.append(FrictMat(density={density!r}))
O.bodies.append(ymport.textExt("body.txt"))
json.dump({{"places": [list(b.state.pos) for b in O.bodies], "mass": sum(b.state.mass for b in O.bodies),
           "radii": [b.shape.radius for b in O.bodies], "litter": O.tmpFilename()}}, open("back.json", "w"))
""")
        subprocess.run(["yade", "-n", "-x", "load.py"], cwd=self.folder, capture_output=True, timeout=100,
                       stdin=subprocess.DEVNULL, env=os.environ | {"HOME": str(self.folder)})
        back = json.loads((self.folder / "back.json").read_text())
        litter = Path(back["litter"]).parent
        self.assertTrue(litter.name.startswith("yade-"), litter)
        shutil.rmtree(litter)
        np.testing.assert_array_equal(back["places"], self.points)
        self.assertAlmostEqual(back["mass"] / self.mass, 1, 12)
        self.assertEqual(set(back["radii"]), {0.03})

    def test_peridigm(self):
        text = self.fill("peridigm", "body.txt").read_text()
        self.assertTrue(text.startswith("#header: x y z block_id volume\n"))
        rows = np.array([[float(w) for w in line.split()] for line in text.splitlines() if line[0] != "#"])
        np.testing.assert_array_equal(rows[:, :3], self.points)
        self.assertEqual(set(rows[:, 3]), {1})
        self.assertAlmostEqual(rows[:, 4].sum() * 1000 / self.mass, 1, 12)

    def test_bgeo(self):
        read = read_bgeo(self.fill("bgeo", "body.bgeo"))
        np.testing.assert_array_equal(read["position"][:, :3], self.points.astype("f4"))
        self.assertEqual(set(read["position"][:, 3]), {1})
        np.testing.assert_array_equal(read["component"][:, 0], self.component)
        np.testing.assert_array_equal(read["id"][:, 0], range(len(self.points)))
        self.assertAlmostEqual(read["mass"].sum() / self.mass, 1, 5)
        self.assertAlmostEqual(read["pscale"].max(), 0.03, 7)

    def test_gltf(self):
        points, told = read_glb(self.fill("gltf", "body.glb"))
        np.testing.assert_allclose(points, self.points, rtol=0, atol=1e-7)
        reader = vtk.vtkGLTFReader()
        reader.SetFileName(str(self.folder / "body.glb"))
        reader.Update()
        blocks = reader.GetOutput().NewIterator()
        blocks.InitTraversal()
        seen = vtk_to_numpy(blocks.GetCurrentDataObject().GetPoints().GetData())
        np.testing.assert_allclose(seen[:, [2, 0, 1]], self.points, rtol=0, atol=1e-7)
        self.assertEqual(told["meshes"][0]["primitives"][0]["mode"], 0)
        self.assertAlmostEqual(told["meshes"][0]["extras"]["mass"] * len(points) / self.mass, 1, 12)

    def test_shells_complete_the_formats(self):
        told = sinew("fill", "--help", check=0).stdout.split("--to")[1].split("--verify")[0]
        names = re.findall(r"(\w+) \(", told)
        self.assertGreaterEqual(len(names), 10)
        names.remove("tetrahedra")  # no format of particles
        for script in ("_sinew", "sinew.bash", "sinew.fish"):
            text = (SOURCE / "tools/packaging" / script).read_text()
            self.assertIn(" ".join(names), text)
            self.assertIn("tetrahedra", text)

    def test_a_named_format_takes_any_file_name(self):
        for to, usual, name in (("lammps", "a.data", "b.lammps"), ("csv", "a.csv", "b"), ("xyz", "a.xyz", "b.data"),
                                ("bgeo", "a.bgeo", "b.x.obj"), ("vtu", "a.vtu", "b.dump"), ("gltf", "a.glb", "b.")):
            usual = self.fill(to, usual).read_bytes()
            before = set(self.folder.iterdir())
            self.assertEqual(self.fill(to, name).read_bytes(), usual, to)
            self.assertEqual({path.name for path in set(self.folder.iterdir()) - before}, {name})
        copy = self.folder / "copy.obj"
        copy.write_bytes(Path(self.mesh).read_bytes())
        self.assert_one_line(sinew("fill", copy, "--radius", 0.03, "--to", "lammps", "-o", copy), 2, "is an input")
        self.assertEqual(copy.read_bytes(), Path(self.mesh).read_bytes())
        text = self.scene.read_text()  # another scene than the input
        self.assert_one_line(sinew("fill", copy, "--radius", 0.03, "--to", "xyz", "-o", self.scene), 2, "is a scene, and would be")
        self.assertEqual(self.scene.read_text(), text)

    def test_names_are_checked(self):
        self.assert_one_line(sinew("fill", self.mesh, "--radius", 0.03, "-o", self.folder / "a.txt"), 2, "yade",
                             "peridigm")
        self.assert_one_line(sinew("fill", self.mesh, "--radius", 0.03, "--to", "lamps"), 2, "did you mean lammps?")
        self.assertEqual(sinew("fill", self.mesh, "--radius", 0.03, "--to", "csv", cwd=self.folder).returncode, 0)
        self.assertTrue((self.folder / "body.csv").exists())


class Exported(SmallRun):
    def setUp(self):
        super().setUp()
        self.scene.write_text(SCENE.format(mesh=SOURCE / "data/meshes/box.obj") + "output: {interval: 0.1}\n")
        self.simulate()
        self.frames = [meshio.read(path) for path in sorted((self.out / "particles").iterdir())]
        self.assertEqual(len(self.frames), 5)

    def export(self, *words, check=0):
        return sinew("export", self.out, *words, check=check, cwd=self.folder)

    def near(self, points, frame, error=1e-7):  # frames of a run are in single precision
        np.testing.assert_allclose(points, self.frames[frame].points, rtol=0, atol=error)

    @unittest.skipUnless(ase, "ASE is not installed")
    def test_ase_reads_all_frames(self):
        self.export("--to", "xyz", "-o", "run.xyz")
        found = ase.io.read(self.folder / "run.xyz", index=":")
        self.assertEqual(len(found), 5)
        for k, atoms in enumerate(found):
            self.near(atoms.positions, k)
            self.assertAlmostEqual(atoms.info["Time"], 0.1 * k, 9)
            np.testing.assert_allclose(atoms.arrays["velo"], self.frames[k].point_data["velocity"], atol=1e-7)

    @unittest.skipUnless(shutil.which("lmp"), "LAMMPS is not installed")
    def test_lammps_reads_a_frame_of_the_dump(self):
        self.export("--to", "lammps", "--times", 0, "-o", "rest.data")
        self.export("-o", "run.dump")
        run_lammps(self.folder, "read_data rest.data", "bond_style zero", "bond_coeff *",
                   "read_dump run.dump 3 x y z vx vy vz box yes", "run 0", "write_data back.data")
        back = read_lammps(self.folder / "back.data")
        self.near(back["Atoms"][:, 3:6], 3)
        np.testing.assert_allclose(back["Velocities"][:, 1:], self.frames[3].point_data["velocity"], atol=1e-7)

    def test_types_are_the_bones(self):
        self.export("--to", "lammps", "--times", "0.2", "-o", "bent.data")
        read = read_lammps(self.folder / "bent.data")
        bone = self.frames[2].point_data["bone"]
        kinds = {kind: k + 1 for k, kind in enumerate(sorted(set(bone)))}
        np.testing.assert_array_equal(read["Atoms"][:, 2], [kinds[kind] for kind in bone])
        self.assertIn("# bone upper\n", (self.folder / "bent.data").read_text())
        rest = meshio.read(self.out / "body.vtu").points
        self.assertEqual({(int(a) - 1, int(b) - 1) for _, _, a, b in read["Bonds"]}, pairs_within(rest, 2.2 * 0.025))

    def break_bonds(self, output):
        self.scene.write_text(SCENE.format(mesh=SOURCE / "data/meshes/box.obj") + f"output: {{interval: 0.1{output}}}\n"
                              "material: {model: bonded, breaking_strain: 0.05}\n")
        self.simulate("--force")
        done = self.export("--to", "lammps", "--times", 0.2, "-o", "torn.data")
        return done, {(int(a) - 1, int(b) - 1) for _, _, a, b in read_lammps(self.folder / "torn.data")["Bonds"]}

    def test_broken_bonds_are_left_out_where_they_are_known(self):
        done, bonds = self.break_bonds(", bonds: true")
        self.assertNotIn("broken", done.stderr)
        written = meshio.read(self.out / "bonds/bonds_000002.vtu")
        lines, broken = written.cells_dict["line"], written.cell_data_dict["broken"]["line"] != 0
        self.assertGreater(broken.sum(), 0)
        self.assertEqual({tuple(sorted(pair)) for pair in bonds}, {tuple(sorted(pair)) for pair in lines[~broken]})
        done, bonds = self.break_bonds("")
        self.assertIn(f"up to {broken.sum()} broken bonds", done.stderr)
        self.assertEqual(bonds, pairs_within(meshio.read(self.out / "body.vtu").points, 2.2 * 0.025))

    def test_particles_keep_their_ids_where_frames_have_some_of_them(self):
        self.scene.write_text(SCENE.format(mesh=SOURCE / "data/meshes/box.obj") +
                              "output: {interval: 0.1, region: [-1, -1, 0.3, 1, 1, 1]}\n")
        self.simulate("--force")
        frame = meshio.read(self.out / "particles/particles_000001.vtu")
        ids = frame.point_data["id"]
        self.assertGreater(ids[0], 0)
        self.export("--to", "csv", "--times", 0.1, "-o", "part.csv")
        with open(self.folder / "part.csv", newline="") as file:
            self.assertEqual([int(row["id"]) for row in csv.DictReader(file)], list(ids))
        self.export("--to", "lammps", "--times", 0.1, "-o", "part.data")
        read = read_lammps(self.folder / "part.data")
        np.testing.assert_array_equal(read["Atoms"][:, 0], ids + 1)
        self.assertTrue(set(read["Bonds"][:, 2:].flat) <= set(ids + 1))
        np.testing.assert_allclose(read["Atoms"][:, 3:6], frame.points, rtol=0, atol=1e-7)

    def test_one_file_per_frame(self):
        self.export("--to", "peridigm", "-o", "mesh")
        self.assertEqual(sorted(path.name for path in (self.folder / "mesh").glob("*[0-9][0-9].txt")),
                         [f"particles_{k:06}.txt" for k in range(5)])
        rows = np.loadtxt(self.folder / "mesh/particles_000004.txt")
        self.near(rows[:, :3], 4)
        nodes = np.loadtxt(self.folder / "mesh/particles_000004_block_2.txt", dtype=int)
        np.testing.assert_array_equal(nodes, np.flatnonzero(rows[:, 3] == 2) + 1)
        self.export("--to", "bgeo", "--times", "0.1,0.3")
        names = sorted(path.name for path in (self.folder / "run_bgeo").iterdir())
        self.assertEqual(names, ["particles_000001.bgeo", "particles_000003.bgeo"])
        read = read_bgeo(self.folder / "run_bgeo/particles_000003.bgeo")
        self.near(read["position"][:, :3], 3)
        np.testing.assert_allclose(read["velocity"], self.frames[3].point_data["velocity"], atol=1e-7)

    def test_vtu_and_gltf(self):
        self.export("--times", "0.2", "-o", "one.vtu")
        one = meshio.read(self.folder / "one.vtu")
        self.near(one.points, 2)
        np.testing.assert_array_equal(one.point_data["bone"], self.frames[2].point_data["bone"])
        self.export("--times", "0.2", "-o", "one.glb")
        self.near(read_glb(self.folder / "one.glb")[0], 2)

    def test_surfaces_of_moments(self):
        self.scene.write_text(SCENE.format(mesh=SOURCE / "data/meshes/box.obj") + "output: {interval: 0.1, skin_lbs: true}\n")
        self.simulate("--force")
        for series, words in (("surface", []), ("skin_lbs", ["--series", "skin_lbs"])):
            wanted = meshio.read(self.out / series / f"{series}_000003.vtu")
            triangles = wanted.points[wanted.cells_dict["triangle"]]
            for name in ("one.obj", "one.ply", "one.stl"):
                self.export("--times", 0.3, "-o", name, *words)
                read = meshio.read(self.folder / name)
                np.testing.assert_array_equal(read.points[read.cells_dict["triangle"]].astype(np.float32), triangles)
                self.assertEqual(sinew("info", self.folder / name, "--json", check=0).stdout.count('"closed": true'), 1)
        self.export("--to", "stl")
        self.assertEqual(sorted(path.name for path in (self.folder / "run_stl").iterdir()), [f"surface_{k:06}.stl" for k in range(5)])
        for words in (["--series", "skin_dqs"], ["--series", "bones"], ["--series", "obstacles"]):
            self.assert_one_line(self.export("--to", "obj", *words, check=2), 2, words[1])
        self.assert_one_line(self.export("--to", "csv", "--series", "skin_lbs", check=2), 2, "obj, ply or stl")

    def test_a_named_format_takes_any_file_name(self):
        for name in ("one.data", "one.lammps", "one"):
            self.export("--to", "lammps", "--times", "0.2", "-o", name)
            self.assertEqual((self.folder / name).read_bytes(), (self.folder / "one.data").read_bytes())
        self.export("--to", "xyz", "-o", "all.frames")
        self.export("--to", "xyz", "-o", "all.xyz")
        self.assertEqual((self.folder / "all.frames").read_bytes(), (self.folder / "all.xyz").read_bytes())

    def test_what_cannot_be_exported(self):
        self.assert_one_line(self.export(check=2), 2, "--to")
        self.assert_one_line(self.export("--to", "csv", "--times", 0.9, check=2), 2, "0.9", "to 0.4")
        self.assert_one_line(self.export("--to", "csv", "-o", self.out, check=2), 2, "run itself")
        body = (self.out / "body.vtu").read_bytes()
        self.assert_one_line(self.export("--times", 0, "-o", "run/body.vtu", check=2), 2, "run itself")
        self.assertEqual((self.out / "body.vtu").read_bytes(), body)
        self.assert_one_line(self.export("--to", "vtu", "-o", "run/particles", check=2), 2, "run itself")
        self.export("--to", "csv", "-o", "run/tables")
        self.assert_one_line(self.export("--to", "csv", "-o", self.scene, check=2), 2, "no folder")
        self.assert_one_line(self.export("--to", "csv", "--times", 0, "-o", ".", check=2), 2, "is a folder")
        self.assert_one_line(self.export("--to", "csv", "--times", 0, "-o", self.scene, check=2), 2, "is a scene")
        self.assert_one_line(sinew("export", self.folder, "--to", "csv"), 2, "folder of a run")


if __name__ == "__main__":
    unittest.main(argv=["formats_test.py"])
