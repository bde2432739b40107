#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh [CTEST OPTIONS]: builds everything and runs all tests; ends with ctest's closing lines.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
tools/install_packages.sh build test
tests/tools/get_paraview_python.sh build/paraview-python
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DSINEW_TESTS=ON -DSINEW_STRICT=ON >/dev/null
cmake --build build
ctest --test-dir build --output-on-failure --parallel "$(nproc)" "$@"
