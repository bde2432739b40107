# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes, as settings."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy

from . import _sinew
from ._error import Error
from ._values import Held, Path, checked, pairs, table


class Scene(Held):
    """A scene's settings, read by read_scene() or made by make_scene(); str() is the scene with every key, as YAML."""

    def __init__(self) -> None:
        raise Error("a Scene is not made by itself; read one by read_scene(), or make one by make_scene()")

    @property
    def duration(self) -> float:
        """Time that a run covers, s."""
        return self._native.duration

    @property
    def interval(self) -> float:
        """Time between two frames of a run, s."""
        return self._native.interval

    def __str__(self):
        return str(self._native)

    def __repr__(self):
        return f"<sinew.Scene of {self.duration:.6g} s; str() has every key>"


@checked
def read_scene(path: Path, settings: Mapping | None = None) -> Scene:
    """The Scene of a YAML file.

    `settings` replaces values by their paths: {"material.model": "bonded", "body.radius": 0.01}, in SI units. Raises Error,
    which names file, line and key, for what the file or a setting gets wrong."""
    return Scene._of(_sinew._read_scene(path, pairs(settings or {})))


_PRESET_UNITS = {"young_modulus": "Pa", "density": "kg/m^3"}


def presets() -> Any:
    """Materials that a scene chooses by name (material.preset), each with its `source`: a pandas.DataFrame, or where there
    is no pandas a dict of arrays (n,) by name.

    `young_modulus` is in Pa, `density` in kg/m^3; `yield_strain` is not-a-number where a material does not flow."""
    names = ("name", "young_modulus", "density", "poisson_ratio", "damping_ratio", "yield_strain", "what", "source")
    return table({name: numpy.array(column) for name, column in zip(names, zip(*_sinew._presets()))}, _PRESET_UNITS)
