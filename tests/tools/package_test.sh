#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# package_test.sh BUILD: installs sinew into an empty folder; a program outside finds and links it, and
# the installed programs run.
set -euo pipefail

build=${1:?usage: package_test.sh BUILD}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/installed" >/dev/null

cat > "$work/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(outside CXX)
find_package(sinew REQUIRED)
add_executable(outside outside.cpp)
target_link_libraries(outside PRIVATE sinew::config sinew::fill sinew::io sinew::physics sinew::metrics
                                      sinew::render)
END
cat > "$work/outside.cpp" <<'END'
#include "core/closest_packing.h"
#include "fill/pack.h"
#include "fill/volume_inside.h"
#include "io/arrays.h"
#include "metrics/table.h"
#include "physics/pair_force.h"
#include "render/color.h"

int main() {
  const sinew::PairForce pair{0.01, 1, 1, 0.02, 0.026};
  const bool works = pair.force(0.02) == 0 && sinew::radius_for_count(1, 1000) > 0 &&
                     !sinew::written_arrays().empty() && !sinew::metrics_table().empty() &&
                     sinew::mapped_color(0.5)[0] > 0;
  return works ? 0 : 1;
}
END
cmake -S "$work" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$work/installed" >/dev/null
cmake --build "$work/build" >/dev/null
"$work/build/outside"
"$work/installed/bin/sinew" --version
"$work/installed/bin/sinew" info --help >/dev/null
for script in view live; do  # what sinew view starts
  test -s "$work/installed/share/sinew/$script.py"
done
