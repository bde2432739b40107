#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Each test that README.md names exists, so that a guarantee is not lost with a name.

usage: guarantees_test.py BUILD SOURCE
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

# What needs packages that may be missing, or is built on request.
OPTIONAL = {"lammps", "sanitized", "tools.engine", "tools.hosts", "tools.api", "tools.arrays", "tools.python", "tools.tutorials"}


def entries(build):
    """The names of ctest's entries; asked for in another folder, since ctest writes where it works."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "CTestTestfile.cmake").write_text(f'subdirs("{build}/tests")\n')
        listed = subprocess.run(["ctest", "-N"], cwd=folder, check=True, capture_output=True, text=True)
    return re.findall(r"^ *Test +#\d+: (.*)$", listed.stdout, re.MULTILINE)


def named(readme, rooms):
    """What is in code in the tables and names a room, a test or a pattern of tests."""
    words = [word for line in readme.splitlines() if line.startswith("|") for word in re.findall(r"`([^`]+)`", line)]
    return sorted({word for word in words if word.split(".")[0] in rooms and not word.endswith((".py", ".sh"))})


def exists(name, there):
    """Whether `ctest -R ^NAME` finds a test, a star standing for anything."""
    pattern = re.compile(re.escape(name).replace(r"\*", ".*"))
    return any(map(pattern.match, there))


def main():
    build, source = (Path(place).resolve() for place in sys.argv[1:3])
    there = entries(build)
    rooms = {name.split(".")[0] for name in there if "." in name} | OPTIONAL
    names = named((source / "tests/README.md").read_text(), rooms)
    missing = [name for name in names if name not in OPTIONAL and not exists(name, there)]
    for name in missing:
        print(f"tests/README.md names {name}: there is no such test")
    print(f"{len(names)} names, {len(there)} tests")
    return 1 if missing or not names else 0


if __name__ == "__main__":
    sys.exit(main())
