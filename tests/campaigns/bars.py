#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""E, E I and G J of square bars over those of their mesh and of the modulus asked for: a table by size, direction of
the packing and kind of bonds.

usage: bars.py BIN SOURCE [PLANES ...]      folder of the programs, folder of the project; planes across: 5 9 17
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tools"))
from bars import ROTATIONS, Bar  # noqa: E402  (reads the arguments)


def main():
    planes = [float(word) for word in sys.argv[3:]] or [5, 9, 17]
    print("| planes | along | isotropic: pulled, bent, twisted | twelve bonds: pulled, bent, twisted |")
    print("|---|---|---|---|")
    for across in planes:
        for axis in ROTATIONS:
            cells = []
            for isotropic, ratio in (("true", 0.25), ("false", 0.261)):
                bar = Bar(across, axis, {"isotropic": isotropic}, ratio)
                cells.append(", ".join(f"{bar.stiffness(kind):.2f}" for kind in ("pull", "bend", "twist")))
            name = axis if axis == "random" else f"[{axis}]"
            print(f"| {across:g} | {name} | {cells[0]} | {cells[1]} |", flush=True)


if __name__ == "__main__":
    main()
