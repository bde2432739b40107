# SPDX-License-Identifier: GPL-3.0-or-later
"""Arguments that are checked by their annotations, Python's values as YAML, and JSON as Python's."""
from __future__ import annotations

import functools
import inspect
import json
import math
import numbers
import os
import sys
import types
import typing
from collections.abc import Callable, Mapping, Sequence

import numpy

from ._error import Error, in_python

Path = typing.Union[str, bytes, os.PathLike]
MeshLike = typing.Any  # vertices, a pair of vertices and faces, a path, or a mesh of trimesh, PyVista, VTK or meshio
Progress = typing.Union[bool, Callable[[int, int], object], None]
Function = typing.TypeVar("Function", bound=Callable)
_LARGEST, _LARGEST_FLOAT = 2 ** 63, sys.float_info.max  # whole numbers of the library are below the first
_WORDS = {int: "a whole number", float: "a number", bool: "True or False", str: "a text", bytes: "a path", os.PathLike: "a path",
          Callable: "a function", Mapping: "a dict", Sequence: "a list", slice: "a slice"}


def _text(value):
    """Refuses what is no text for a file or the library."""
    try:
        os.fsencode(value)
        return None if b"\0" in os.fsencode(value) else value
    except UnicodeEncodeError:
        return None


def _as(kind, value):
    """The value as this kind, or None."""
    if isinstance(value, numpy.ndarray) and value.ndim == 0 and kind in (int, float, bool):
        value = value[()]
    flag = isinstance(value, (bool, numpy.bool_))
    if kind is bool:
        return bool(value) if flag else None
    if kind is int:
        return int(value) if isinstance(value, numbers.Integral) and not flag and abs(value) < _LARGEST else None
    if kind is float:
        return float(value) if isinstance(value, numbers.Real) and not flag and not _LARGEST_FLOAT < abs(value) < math.inf else None
    if kind in (str, bytes, os.PathLike):
        return _text(value) if isinstance(value, kind) else None
    if kind is Sequence and isinstance(value, numpy.ndarray):
        return list(value)
    if kind is Sequence and isinstance(value, (str, bytes)):
        return None
    return value if isinstance(value, kind) else None


def _kinds(annotation):
    """The types that an annotation names; None: any value, which the function checks itself."""
    if annotation is typing.Any:
        return None
    origin = typing.get_origin(annotation)
    if origin in (typing.Union, types.UnionType):
        parts = [_kinds(part) for part in typing.get_args(annotation)]
        return None if None in parts else [kind for part in parts for kind in part]
    return [origin or annotation]


def _cure(kinds):
    kinds = [kind for kind in kinds if kind is not type(None) and not (os.PathLike in kinds and kind in (str, bytes))]
    words = [_WORDS.get(kind, f"a sinew.{kind.__name__}") for kind in kinds]
    return " or ".join(dict.fromkeys(words))


def shown(value):
    """A value in a message of one line."""
    if isinstance(value, numpy.ndarray):
        return f"an array of shape {value.shape}"
    try:
        text = repr(value)
    except Exception:
        text = ""
    return text if 0 < len(text) <= 60 and text.isprintable() else f"a {type(value).__name__}"


def _checked_value(name, value, kinds):
    if value is None and type(None) in kinds:
        return None
    for kind in kinds:
        if kind is not type(None) and (found := _as(kind, value)) is not None:
            return found
    raise Error(f"{name} is {shown(value)}; give {_cure(kinds)}")


def checked(function: Function) -> Function:
    """Checks the arguments of a function by its annotations: an Error names the argument and the cure."""
    signature = inspect.signature(function)
    texts = {name: one.annotation for name, one in signature.parameters.items() if isinstance(one.annotation, str) and
             one.kind is not one.VAR_KEYWORD and "ArrayLike" not in one.annotation}
    known = {name: kinds for name, text in texts.items() if (kinds := _kinds(eval(text, function.__globals__)))}

    @functools.wraps(function)
    def call(*words, **named):
        try:
            bound = signature.bind(*words, **named)
        except TypeError:
            return function(*words, **named)  # Python says itself which is missing or too many
        for name, value in bound.arguments.items():
            if name in known:
                bound.arguments[name] = _checked_value(name, value, known[name])
        return function(*bound.args, **bound.kwargs)
    return call


class _Plain(str):
    """An annotation that help() shows as it is written."""
    __repr__ = str.__str__


def publish(thing):
    """Lets help() show a class or function as users find it."""
    thing.__module__ = "sinew"
    for one in map(inspect.unwrap, filter(callable, vars(thing).values() if inspect.isclass(thing) else [thing])):
        if inspect.isfunction(one):
            one.__annotations__ = {name: _Plain(text) for name, text in one.__annotations__.items()}


def floats(name, given, shape, cure):
    """An array of finite numbers of this shape."""
    try:
        array = numpy.asarray(given, float)
    except (TypeError, ValueError):
        raise Error(f"{name} is {shown(given)}; {cure}") from None
    if array.shape != shape:
        raise Error(f"{name} has the shape {array.shape}; {cure}")
    return array


def _json(value):
    """As JSON, whose pairs of surrogates YAML does not know."""
    return json.dumps(value, ensure_ascii=False)


def yaml(value):
    """As YAML; the words for what is not given, auto and none, are not texts."""
    if hasattr(value, "tolist"):  # NumPy's
        value = value.tolist()
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_json(str(key))}: {yaml(item)}" for key, item in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(yaml, value)) + "]"
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    return value if value in ("auto", "none") else _json(value)


def pairs(settings):
    """Paths and YAML of those that are given."""
    found = []
    for path, value in settings.items():
        try:
            if value is not None:
                found.append((_checked_value("the name of a setting", path, [str]), yaml(value)))
        except (TypeError, ValueError, RecursionError):
            raise Error(f"{path} is {shown(value)}; give a number, a text or a list") from None
    return found


def is_path(value):
    """Whether it is a path. Raises Error for one that no file can have."""
    kinds = [str, bytes, os.PathLike]
    return isinstance(value, tuple(kinds)) and bool(_checked_value("the path", value, kinds) is not None)


def table(columns, units):
    """A pandas.DataFrame with units in its attrs, or where there is no pandas a dict of arrays."""
    try:
        from pandas import DataFrame
    except ImportError:
        return columns
    frame = DataFrame(columns)
    frame.attrs["units"] = units
    return frame


class Held:
    """An object of the library."""

    def __init__(self, native):
        self._native = native

    @classmethod
    def _of(cls, native):
        held = object.__new__(cls)
        held._native = native
        return held

    def __reduce_ex__(self, protocol):
        raise TypeError(f"cannot pickle or copy a sinew.{type(self).__name__}; keep the arrays or the scene it was made of")


class Findings(dict):
    """What check(), info(), render() and the like find, by name, as the command's --json has it: a dict.

    Numbers are in SI units; `warnings` are texts, each with its cure."""

    def __init__(self, text: str, warnings: list):
        super().__init__(json.loads(text))
        self.warnings = [*map(in_python, warnings)]

    def __repr__(self):
        lines = [f"  {key}: {value!r}" for key, value in self.items() if not isinstance(value, (list, dict)) or len(value) < 8]
        return "\n".join([f"{type(self).__name__}:", *lines, *(f"  warning: {text}" for text in self.warnings)])
