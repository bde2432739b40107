# SPDX-License-Identifier: GPL-3.0-or-later
"""parameter_study.py SCENE.yaml: how far the body is from rest after 0.1 s, by its stiffness and its damping."""
import sys

import numpy
import sinew


def farthest(simulation):
    return numpy.linalg.norm(simulation.dataset("particles")["displacement"], axis=1).max()


table = sinew.sweep(sys.argv[1], {"material.young_modulus": [5e3, 1e4, 2e4], "material.damping": [0.5, 1]},
                    results=farthest, settings={"solver.duration": 0.1})
print("Young's modulus (Pa)  damping  farthest from rest (m)")
for row in zip(table["material.young_modulus"], table["material.damping"], table["farthest"]):
    print("%20.0f  %7.2g  %.4g" % row)
