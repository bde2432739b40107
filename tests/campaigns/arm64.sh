#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# arm64.sh [BIN]: builds this checkout's commit for ARM64, runs the shipped scenes for a moment under qemu's user
# mode, and tells which of them end in the state that the programs in BIN (build/bin) find on this machine. Fails
# where the build fails, or where one of those differs that are the same so far. Compilers and qemu are in a bare root
# (bare_root.sh), and so are Debian's packages for ARM64, unpacked. As root; takes half an hour and 6 GB.
set -euo pipefail

. "$(dirname "${BASH_SOURCE[0]}")/bare_root.sh"
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
bin=$(realpath "${1:-build/bin}")
[ -x "$bin/sinew-simulate" ] || { echo "arm64.sh: there is no $bin/sinew-simulate; build it first" >&2; exit 2; }
same_so_far=(box_bend box_bend_bvh box_twist two_fingers)
# In the sizes that they have: a radius that follows from a count depends on the C library's cube root.
short=(--quiet --force --set solver.duration=0.15 --set output.interval=0.05)
make_bare_root bookworm
logs=$PWD/build/arm64
mkdir -p "$root/source" "$logs"

# Debian's packages for ARM64, by an apt with a state of its own, below /arm64.
packages() {
  in_root apt-get -qq install -y --no-install-recommends g++-aarch64-linux-gnu cmake ninja-build qemu-user-static
  local apt=(apt-get -qq -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Dir::State=/apt/state
    -o Dir::State::status=/apt/status -o Dir::Cache=/apt/cache)
  in_root mkdir -p /apt/state /apt/cache/archives/partial /apt/state/lists/partial
  in_root touch /apt/status
  in_root "${apt[@]}" update
  # shellcheck disable=SC2046
  in_root "${apt[@]}" install -y --download-only --no-install-recommends libc6-dev libstdc++-12-dev \
    $(tools/install_packages.sh --list build | grep -E -- '-dev$|^libjs-')
  in_root sh -c 'rm -rf /arm64; mkdir /arm64; for package in /apt/cache/archives/*.deb; do dpkg -x $package /arm64; done'
  # What the packages' scripts and Debian's merged /usr do otherwise.
  in_root sh -c 'cp -a /arm64/lib/. /arm64/usr/lib/ && rm -r /arm64/lib && ln -s usr/lib /arm64/lib
    cd /arm64/usr/lib/aarch64-linux-gnu && ln -s blas/libblas.so.3 lapack/liblapack.so.3 . &&
    cp -a /arm64/usr/share/javascript /arm64/usr/share/nodejs /usr/share/'
}

toolchain() {
  cat <<'END'
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_SYSROOT /arm64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
END
}

build() {
  git -c safe.directory="$PWD" archive HEAD | tar -x -C "$root/source"
  toolchain > "$root/arm64.cmake"
  in_root cmake -S /source -B /build -G Ninja -DCMAKE_TOOLCHAIN_FILE=/arm64.cmake -DCMAKE_BUILD_TYPE=Release \
    -DSINEW_TESTS=OFF -DSINEW_PYTHON=OFF
  in_root nice cmake --build /build --target programs
}

state_in() { sed -n 's/.*"state_hash": *"\([^"]*\)".*/\1/p' "$1/run.json"; }

stage packages packages
stage build build
differ=0
for file in configs/*.yaml; do
  scene=$(basename "$file" .yaml)
  "$bin/sinew-simulate" "$file" "${short[@]}" -o "$root/native/$scene" >/dev/null
  in_root qemu-aarch64-static -L /arm64 -E LD_LIBRARY_PATH=/usr/lib/aarch64-linux-gnu /build/bin/sinew-simulate \
    "/source/$file" "${short[@]}" -o "/runs/$scene" >/dev/null
  if [ "$(state_in "$root/native/$scene")" = "$(state_in "$root/runs/$scene")" ]; then
    echo "$scene: the same state"
  elif [[ " ${same_so_far[*]} " == *" $scene "* ]]; then
    echo "$scene: ANOTHER STATE, which was the same so far"
    differ=1
  else
    echo "$scene: another state"
  fi
done
exit "$differ"
