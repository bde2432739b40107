# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors, in words of Python."""
import re


class Error(Exception):
    """What went wrong, and what to do about it, in one line.

    Raised for every wrong argument, file or setting, for a simulation that became unstable and for files that could not
    be written. `exit_code` is that of the commands: 2 bad input, 3 unstable, 4 not written."""

    exit_code = 2


def _value(text):
    text = text.strip("'\"")
    if re.fullmatch(r"[-+\d.e]+(,[-+\d.e]+)+", text):
        return f"[{text.replace(',', ', ')}]"
    if re.fullmatch(r"true|false", text):
        return text.capitalize()
    return text if re.fullmatch(r"[-+\d][-+\d.e]*", text) else repr(text)


def _setting(match):
    return f'settings={{"{match[1]}": {_value(match[2])}}}'


# Options of commands -> arguments.
_WORDS = [
    (r"--set ([\w.]+)=([^\s,;]+)", _setting),
    (r"--(force|resume|verify|json|linear)\b", r"\1=True"),
    (r"--(set|threads)\b", lambda match: {"set": "settings", "threads": "threads"}[match[1]]),
    (r"--(view|array|to|up|series|look|colormap|camera|background|fail-on)[ =]('[^']*'|[\w.#,-]+)",
     lambda match: f"{match[1].replace('-', '_')}={_value(match[2])}"),
    (r"--([a-z][a-z-]*)[ =]([-+]?\d[-+\d.e,]*)", lambda match: f"{match[1].replace('-', '_')}={_value(match[2])}"),
    (r"--([a-z]+(?:-[a-z]+)*)", lambda match: match[1].replace("-", "_")),
    (r"^scene(:\d+:\d+)?: ", ""),  # the place in dictionaries as YAML
    (r",? with -o\b|,? with it(?= or -o)", ""),
    (r"(?<=leave )-o(?= out)|(?<![\w-])-o\b", "the output"),
]
# Words for files of YAML -> words for dictionaries.
_OF_YAML = [
    (r"add ([\w.]+): and write its entries below it, each beginning with '- '", r'add "\1": [...], a list'),
    (r"write its entries below it, each beginning with '- '", "give a list of its entries"),
    (r"write its keys below it, one 'key: value' a line: ", "give a dict with keys among "),
    (r"must be a group of keys", "must be a dict"),
    (r"add ([\w.]+): with ", r'add "\1": '),
]


def _translated(text, words):
    for pattern, word in words:
        text = re.sub(pattern, word, text)
    return text


def in_python(text):
    """A message of a command, whose options are arguments."""
    return _translated(text, _WORDS)


def of_library(text, exit_code):
    """The Error of a message of the library or of a command."""
    error = Error(in_python(text))
    error.exit_code = exit_code
    return error


def of_dictionaries(error):
    """The same Error where a scene was given as dictionaries."""
    return of_library(_translated(str(error), _OF_YAML), error.exit_code)
