# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the skeleton and the motion of our own scenes without any package.

It knows what configs/*.yaml use: blocks by indentation, lists of "- ", and braces and brackets
within a line. For scenes of other people there is `sinew`.
"""

import json
import re


def read_scene(path):
    lines = []
    for line in path.read_text().splitlines():
        line = re.sub(r"(^|\s)#.*", "", line).rstrip()
        if line:
            lines.append((len(line) - len(line.lstrip()), line.lstrip()))
    value, rest = block(lines, lines[0][0])
    assert not rest, f"{path}: {rest[0]}"
    return value


def block(lines, indent):
    """The value that begins with the first line, and the lines after it."""
    if lines[0][1].startswith("- "):
        items = []
        while lines and lines[0][0] == indent and lines[0][1].startswith("- "):
            text = lines[0][1][2:].lstrip()
            inner = indent + len(lines[0][1]) - len(text)
            if text[0] == "{":
                items.append(flow(text))
                lines = lines[1:]
            else:
                item, lines = block([(inner, text)] + lines[1:], inner)
                items.append(item)
        return items, lines
    entries = {}
    while lines and lines[0][0] == indent:
        key, text = lines[0][1].split(":", 1)
        lines = lines[1:]
        if text.strip():
            entries[key] = flow(text.strip())
        else:
            entries[key], lines = block(lines, lines[0][0])
    return entries, lines


def flow(text):
    """{a: [1, 2], b: word} as JSON would write it."""
    word = r"(?<![\w./-])([A-Za-z_./][\w./-]*)"
    text = re.sub(word, r'"\1"', text)
    text = re.sub(r"(?<![\w.])(\d+/\d+)", r'"\1"', text)
    return json.loads(text)
