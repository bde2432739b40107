# SPDX-License-Identifier: GPL-3.0-or-later
"""Python's values as YAML, and JSON as Python's."""
import json
import os

from . import _sinew


def _text(value):
    """As JSON, whose pairs of surrogates YAML does not know."""
    return json.dumps(value, ensure_ascii=False)


def yaml(value):
    """As YAML; the words for what is not given, auto and none, are not texts."""
    if hasattr(value, "tolist"):  # NumPy's
        value = value.tolist()
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_text(str(key))}: {yaml(item)}" for key, item in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(yaml, value)) + "]"
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    return value if value in ("auto", "none") else _text(value)


def pairs(settings):
    """Paths and YAML of those that are given."""
    found = []
    for path, value in settings.items():
        try:
            if value is not None:
                found.append((path, yaml(value)))
        except TypeError:
            raise _sinew.Error(f"{path} is {value!r}; give a number, a text or a list") from None
    return found


def is_path(value):
    return isinstance(value, (str, bytes, os.PathLike))


class Findings(dict):
    """What a command finds, by name, as its --json has it; `warnings` are texts, each with its cure."""

    def __init__(self, text, warnings):
        super().__init__(json.loads(text))
        self.warnings = warnings

    def __repr__(self):
        lines = [f"  {key}: {value!r}" for key, value in self.items() if not isinstance(value, (list, dict)) or len(value) < 8]
        return "\n".join([f"{type(self).__name__}:", *lines, *(f"  warning: {text}" for text in self.warnings)])
