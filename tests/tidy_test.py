#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""clang-tidy 14 finds nothing, by the checks in .clang-tidy.

usage: tidy_test.py SOURCE_DIR [--every N]      every N-th source of lib and tools; all without it

Sources that include CGAL take minutes each, for their headers: a sample is taken from the others.
Other versions have other checks: with them it leaves with 77, skipped.
"""
import argparse
import concurrent.futures
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

VERSION, SKIPPED = 14, 77


def commands(build, source):
    """How each source is compiled, without what g++ alone is asked for: its precompiled headers, its warnings."""
    subprocess.run(["cmake", "-S", source, "-B", build, "-DSINEW_UNITY=OFF", "-DSINEW_TESTS=OFF"], check=True,
                   stdout=subprocess.DEVNULL)
    entries = json.loads((build / "compile_commands.json").read_text())
    for entry in entries:
        entry["command"] = re.sub(r"-Winvalid-pch|-include \S*cmake_pch\.hxx|-Wconversion|-Werror", "", entry["command"])
    return entries


def sources(entries, source, every):
    """Those of lib and tools, in a fixed order, or a sample."""
    files = {Path(entry["file"]).resolve() for entry in entries if every == 1 or "CGAL_USE" not in entry["command"]}
    inside = [path for folder in ("lib", "tools") for path in files if (source / folder) in path.parents]
    return sorted(inside)[::every]


def complaints(build, path):
    checked = subprocess.run(
        ["clang-tidy", "-p", str(build), "--quiet", "--extra-arg=-Wno-unknown-warning-option",
         "--extra-arg=-Wno-ignored-optimization-argument", str(path)], text=True, capture_output=True)
    # What it finds in the headers of others is not ours to mend.
    lines = [line for line in checked.stdout.split("\n")
             if re.search(r": (warning|error): ", line) and not line.startswith("/usr/")]
    failed = [f"{path}: clang-tidy failed: {checked.stderr[-500:]}"] if checked.returncode and not lines else []
    return lines + failed


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("source", type=Path)
    parser.add_argument("--every", type=int, default=1)
    options = parser.parse_args()
    told = subprocess.run(["clang-tidy", "--version"], text=True, capture_output=True, check=True).stdout
    if int(re.search(r"version (\d+)", told)[1]) != VERSION:
        print(f"skipped: this is not version {VERSION}, whose checks are meant:\n{told}")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        build = Path(folder)
        entries = commands(build, options.source)
        (build / "compile_commands.json").write_text(json.dumps(entries))
        files = sources(entries, options.source.resolve(), options.every)
        found = set()
        for lines in pool.map(lambda path: complaints(build, path), files):
            print("\n".join(sorted(set(lines) - found)), end="\n" if set(lines) - found else "", flush=True)
            found.update(lines)
    if not found:
        print(f"{len(files)} files are clean")
    return 1 if found or not files else 0


if __name__ == "__main__":
    sys.exit(main())
