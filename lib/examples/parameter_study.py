# SPDX-License-Identifier: GPL-3.0-or-later
"""parameter_study.py SCENE.yaml: how far the body lags behind its bones, by its stiffness."""
import sys

import numpy
import sinew

print("Young's modulus (Pa)  farthest from rest (m)")
for young_modulus in (5e3, 1e4, 2e4):
    scene = sinew.read_scene(sys.argv[1], {"material.young_modulus": young_modulus})
    simulation = sinew.Simulation(scene)
    rest = simulation.positions.copy()
    simulation.run_until(0.1)
    farthest = numpy.linalg.norm(simulation.positions - rest, axis=1).max()
    print(f"{young_modulus:20.0f}  {farthest:.4g}")
