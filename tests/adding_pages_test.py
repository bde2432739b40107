#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""lib/README tells what to touch to add something: each list names all files that name its example.

usage: adding_pages_test.py SOURCE
"""
import fnmatch
import re
import sys
from pathlib import Path

SUFFIXES = (".h", ".cpp", ".py", ".pyi", ".fish", ".bash", "")
EXAMPLE = re.compile(r"One that is there: ((?:`[^`]+`(?:, )?)+)")
WITH_EXAMPLE = 9  # lists


def sections(page):
    adding = page.split("\n## Adding things\n")[1].split("\n## ")[0]
    for text in adding.split("\n### ")[1:]:
        title, _, body = text.partition("\n")
        yield title, body


def sources(root):
    for folder in ("lib/sinew", "lib/python", "tools"):
        for path in sorted((root / folder).rglob("*")):
            if path.is_file() and path.suffix in SUFFIXES and "__pycache__" not in path.parts:
                yield path.relative_to(root).as_posix(), path.read_text(errors="replace")


def names(body):
    """Patterns of the files that a list names: NAME stands for any, and `a.h` and `.cpp` for both."""
    quoted = re.findall(r"`([^`\n]+)`", body)
    for before, word in zip([""] + quoted, quoted):
        if re.fullmatch(r"\.\w+", word):
            word = before.rsplit(".", 1)[0] + word
        if "." in word or "/" in word:
            yield "*/" + word.replace("NAME", "*")


def forgotten(title, body, files):
    example = EXAMPLE.search(body)
    if not example:
        return
    patterns = list(names(body[:example.start()] + body[example.end():]))
    wanted = re.findall(r"`([^`]+)`", example[1])
    found = [path for path, text in files if any(word in text for word in wanted)]
    if not found:
        yield f"{title}: no file names {example[1]}"
    for path in found:
        if not any(fnmatch.fnmatch("/" + path, pattern) for pattern in patterns):
            yield f"{title}: does not tell of {path}, which names {example[1]}"


def main():
    root = Path(sys.argv[1]).resolve()
    page = (root / "lib/README.md").read_text()
    files = list(sources(root))
    found = [line for title, body in sections(page) for line in forgotten(title, body, files)]
    examples = sum(1 for _, body in sections(page) if EXAMPLE.search(body))
    if examples < WITH_EXAMPLE:
        found.append(f"{examples} lists have an example, not {WITH_EXAMPLE}")
    print("\n".join(found) or f"{examples} lists tell of all files that name their examples")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
