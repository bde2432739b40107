# SPDX-License-Identifier: GPL-3.0-or-later
"""The force on a rigid ball that is pressed, without friction, into a layer that a rigid ground holds: Hertz's, 4/3 E*
sqrt(R) d^1.5 with E* = E / (1 - nu^2), times what the ground adds.

Tractions p(r) = -(1 / r) d/dr of the integral of phi(t) over sqrt(t^2 - r^2) from r to the edge a of the contact turn
the contact's condition into an equation of Fredholm's for phi, which vanishes at the edge (Lebedev and Ufliand 1958).
On a layer far thicker than a, it is Hertz's.
"""
import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # of small matrices
import numpy as np


def softness(x, ratio):
    """Of a layer on ground to which it is bonded, over that of a half space, to waves of x layers' depths per radian."""
    k = 3 - 4 * ratio
    return (2 * k * np.sinh(2 * x) - 4 * x) / (2 * k * np.cosh(2 * x) + 4 * x * x + 1 + k * k)


def pressed(contact, ratio, places=24, waves=200):
    """Depth d, over a^2 / R, and force over Hertz's for that depth, of a contact radius a over the layer's depth."""
    t, weight = np.polynomial.legendre.leggauss(places)
    t, weight = (np.append(t, 1) + 1) / 2, np.append(weight, 0) / 2  # the last place is the edge
    x, of_wave = np.polynomial.legendre.leggauss(waves)
    x, of_wave = (x + 1) * 10, of_wave * 10 * contact  # the layer is soft beyond as half spaces are
    cosines = np.cos(np.outer(t, contact * x))
    kernel = 2 / np.pi * (cosines * ((softness(x, ratio) - 1) * of_wave)) @ cosines.T
    flat, round_ = np.linalg.solve(np.eye(places + 1) + kernel * weight, np.stack([np.ones_like(t), t**2], 1)).T
    depth = round_[-1] / flat[-1]
    return depth, 1.5 * (depth * flat - round_) @ weight / depth**1.5


def force(modulus, ratio, ball, depth, layer):
    """Of a ball of that radius at that depth, m."""
    low, high = 0.0, 2.0
    for _ in range(50):
        middle = (low + high) / 2
        reached = pressed(middle, ratio)[0] * (middle * layer)**2 / ball
        low, high = (middle, high) if reached < depth else (low, middle)
    hertz = 4 / 3 * modulus / (1 - ratio**2) * ball**0.5 * depth**1.5
    return hertz * pressed(low, ratio)[1]
