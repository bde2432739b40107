#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh [CTEST OPTIONS]: builds everything, without a warning, and runs all tests; ends with ctest's closing lines.
# ALSO names more targets to build: sanitized_tests, which ctest then runs as well, and benches.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
tools/install_packages.sh build test
tests/tools/get_paraview_python.sh build/paraview-python
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DSINEW_TESTS=ON -DSINEW_OWN_PROCESSOR=OFF >/dev/null
# Not by -Werror: with other options than those of tools/demo.sh, all that it built would be built again. After a
# warning all is built again, so that it is seen until it is gone.
# shellcheck disable=SC2086
cmake --build build --target all ${ALSO:-} | tee build/build.log
if grep ' warning: ' build/build.log >&2; then
  echo "tests/run.sh: the compiler warns of these lines" >&2
  cmake --build build --target clean
  exit 1
fi
tests/costs.py tell build
ctest --test-dir build --output-on-failure --parallel "$(nproc)" "$@"
