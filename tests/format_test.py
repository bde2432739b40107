#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every C++ file is as clang-format 14 leaves it.

usage: format_test.py SOURCE_DIR      prints what is not, exit code 1 if there is any

Other versions lay out some lines differently: with them it leaves with 77, skipped.
"""
import re
import subprocess
import sys
from pathlib import Path

VERSION, SKIPPED = 14, 77


def main():
    told = subprocess.run(["clang-format", "--version"], text=True, capture_output=True, check=True).stdout
    if int(re.search(r"version (\d+)", told)[1]) != VERSION:
        print(f"skipped: this is {told.strip()}, and files are laid out by version {VERSION}")
        return SKIPPED
    source = Path(sys.argv[1]).resolve()
    files = [path for folder in ("lib", "tools", "tests") for path in sorted((source / folder).rglob("*"))
             if path.suffix in (".h", ".cpp")]
    checked = subprocess.run(["clang-format", "--dry-run", "--Werror", *map(str, files)], text=True, capture_output=True)
    found = [line for line in checked.stderr.split("\n") if "error:" in line]
    print("\n".join(found[:20]) or f"{len(files)} files are in order")
    if found:
        print("put them in order: git ls-files '*.h' '*.cpp' | xargs clang-format -i")
    return 1 if found or checked.returncode else 0


if __name__ == "__main__":
    sys.exit(main())
