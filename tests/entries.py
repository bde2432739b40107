#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries of ctest for a program of tests: each suite is one, since starting a program takes longer than most cases;
each case of a long suite is one, so that they share the cores.

usage: entries.py PROGRAM PREFIX FILE [--long SUITE ...] [--properties NAME VALUE ...]

FILE is included by ctest. The TIMEOUT among the properties is that of one case.
"""
import argparse
import subprocess
import sys
from pathlib import Path


def suites_of(program):
    """The cases of each suite, as the program lists them: a suite's name ends with a dot, its cases are indented."""
    listing = subprocess.run([program, "--gtest_list_tests"], check=True, capture_output=True, text=True, timeout=60)
    suites = {}
    for line in listing.stdout.splitlines():
        name = line.split("#")[0].strip()
        if line.startswith("  "):
            suites[suite].append(name)
        elif name.endswith("."):
            suite = name
            suites[suite] = []
    return suites


def entry(name, program, gtest_filter, properties):
    words = " ".join(f"[==[{word}]==]" for pair in properties.items() for word in map(str, pair))
    return (f"add_test([==[{name}]==] [==[{program}]==] [==[--gtest_filter={gtest_filter}]==])\n"
            f"set_tests_properties([==[{name}]==] PROPERTIES {words})\n")


def entries(program, prefix, long, properties):
    suites = {name.rstrip("."): cases for name, cases in suites_of(program).items()}
    if unknown := set(long) - set(suites):
        raise SystemExit(f"{program} has no suite {', '.join(sorted(unknown))}")
    for suite, cases in suites.items():
        if suite in long:
            for case in cases:
                yield entry(f"{prefix}{suite}.{case}", program, f"{suite}.{case}", properties)
        else:
            timeout = int(properties["TIMEOUT"]) * len(cases)
            yield entry(prefix + suite, program, f"{suite}.*", properties | {"TIMEOUT": timeout})


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=Path)
    parser.add_argument("prefix")
    parser.add_argument("file", type=Path)
    parser.add_argument("--long", nargs="*", default=[])
    parser.add_argument("--properties", nargs="*", default=[])
    options = parser.parse_args()
    names, values = options.properties[::2], options.properties[1::2]
    text = "".join(entries(options.program, options.prefix, options.long, dict(zip(names, values))))
    options.file.write_text(text)
    return 0 if text else f"{options.program} has no tests"


if __name__ == "__main__":
    sys.exit(main())
