#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pair forces and energy of the paper's box, displaced at random, agree with LAMMPS's.

usage: lammps_test.py LAMMPS_WORLD      the program that writes the input and our forces
"""
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

MATERIALS = [("2", "2.6", "1"), ("2.2", "2.8", "0.7")]  # a and b in radii, lambda
LARGEST_ERROR = 1e-6

SCRIPT = """
units lj
atom_style atomic
boundary f f f
read_data box.data
pair_style table linear 200000
pair_coeff 1 1 eq1.table EQ1 {b}
neighbor 0.002 bin
thermo_modify norm no
variable energy equal pe
dump forces all custom 1 theirs.txt id fx fy fz
dump_modify forces sort id format float %.17g
run 0
print "energy ${{energy}}" file energy.txt
"""


def run_lammps(folder, b):
    (folder / "in.txt").write_text(SCRIPT.format(b=b))
    # Open MPI removes the folder of its sessions when it ends, also from under a program that begins.
    done = subprocess.run(["lmp", "-in", "in.txt", "-log", "none"], cwd=folder, text=True,
                          env={**os.environ, "OMPI_MCA_orte_tmpdir_base": str(folder)}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode != 0:
        sys.exit("lmp failed:\n" + done.stdout[-2000:])


def vectors(lines, columns):
    return [[float(line.split()[c]) for c in columns] for line in lines]


def errors(folder):
    """Largest error of a force by the largest force, and of the energy by the energy."""
    ours = (folder / "ours.txt").read_text().splitlines()
    energy, b = map(float, ours[0].split())
    run_lammps(folder, b)
    theirs = (folder / "theirs.txt").read_text().splitlines()[9:]
    their_energy = float((folder / "energy.txt").read_text().split()[1])
    pairs = list(zip(vectors(ours[1:], (0, 1, 2)), vectors(theirs, (1, 2, 3)), strict=True))
    if len(pairs) != 2965:
        sys.exit(f"{len(pairs)} particles instead of 2965")
    largest = max(math.hypot(*force) for force, _ in pairs)
    error = max(math.dist(force, their) for force, their in pairs)
    return error / largest, abs(energy - their_energy) / abs(energy)


def main():
    failed = False
    for material in MATERIALS:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.argv[1], folder, *material], check=True)
            force, energy = errors(Path(folder))
        print(f"a, b, lambda {material}: force error {force:.3g}, energy error {energy:.3g}")
        failed |= not (force < LARGEST_ERROR and energy < LARGEST_ERROR)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
