# SPDX-License-Identifier: GPL-3.0-or-later
"""own_force.py MESH: a body made in Python sways in a wind that grows with height and comes in gusts."""
import sys

import numpy
import sinew

body = sinew.fill(sys.argv[1], count=3000)
low, high = body.points.min(0), body.points.max(0)
middle, size = (low + high) / 2, high - low
stem = {"name": "stem", "head": [middle[0], middle[1], low[2]], "tail": [middle[0], middle[1], low[2] + 0.1 * size[2]]}
scene = sinew.make_scene({
    "material": {"model": "bonded"},
    "skeleton": {"bones": [stem]},
    "motion": {"tracks": [{"bone": "stem", "keys": [{"time": 0}]}]},
    "binding": {"explicit": [{"bone": "none", "low": [*(low[:2] - 1), stem["tail"][2]], "high": [*(high + 1)]}]},
}, body)
simulation = sinew.Simulation(scene, body, own_forces=True)
height = (body.points[:, 2] - low[2]) / size[2]
for frame in range(30):
    gust = max(0, numpy.sin(4 * numpy.pi * simulation.time))
    forces = numpy.zeros_like(body.points)
    forces[:, 0] = body.mass * 5 * gust * height
    simulation.set_forces(forces)
    simulation.run_until((frame + 1) / 60)
sway = (simulation.positions - body.points)[height > 0.9, 0].mean()
print(f"the top is {sway:.3g} m off after {simulation.time:.2g} s")
