#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# coverage.sh [BUILD [CTEST OPTIONS]]: which lines of lib the tests run, by room and as a whole. Needs gcovr.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/../.."
build=${1:-build/coverage}
shift || true
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS="-O1 --coverage" >/dev/null
cmake --build "$build"
tests/tools/get_paraview_python.sh "$build/paraview-python"
# A program outside, as tools.package builds one, cannot link what counts.
ctest --test-dir "$build" --parallel "$(nproc)" --exclude-regex '^tools\.package$' "$@" ||
  echo "coverage.sh: some tests failed" >&2
# Counters of lines that several threads run may come out negative: gcovr is told to go on.
gcovr --root . --filter lib/sinew/ --gcov-ignore-parse-errors \
  --json-summary "$build/coverage.json" --txt "$build/coverage.txt" "$build"
/usr/bin/python3 - "$build/coverage.json" <<'END'
import collections
import json
import sys

rooms = collections.defaultdict(lambda: [0, 0])
for file in json.load(open(sys.argv[1]))["files"]:
    for name in (file["filename"].split("/")[2], "all of lib"):
        rooms[name][0] += file["line_covered"]
        rooms[name][1] += file["line_total"]
for name, (covered, total) in sorted(rooms.items(), key=lambda room: room[0] == "all of lib"):
    print(f"{name:12} {covered:6} of {total:6} lines {100 * covered / total:6.1f} %")
END
