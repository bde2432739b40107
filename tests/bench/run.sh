#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh [--quick] [--update-readme]: measures the speed of stepping beside LAMMPS, the paper's cells and this
# machine's limits; tables, plot and raw figures go to build/bench/speed. About 15 minutes; --quick: one.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/../.."
tools/install_packages.sh build bench
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DSINEW_TESTS=ON >/dev/null
cmake --build build --target step_bench make_state sinew sinew-simulate
exec /usr/bin/python3 tests/bench/compare.py build/bench build/bench/speed "$@"
