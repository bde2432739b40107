#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# install_packages.sh build|python|test|package|bench|ci ...: installs with apt-get the missing Debian packages for
# building, the Python package, testing, making packages, the benchmarks or bare roots. With --list first, prints their names only.
set -euo pipefail

build=(g++ cmake ninja-build libeigen3-dev libcgal-dev libvtk9-dev libyaml-cpp-dev libtbb-dev
  libdeflate-dev liblz4-dev libexpat1-dev libmeshoptimizer-dev libdraco-dev libcli11-dev nlohmann-json3-dev libfmt-dev libx11-dev xvfb ffmpeg
  libjs-chart.js libjs-three liblammps-dev lammps openmpi-bin)
test=(libgtest-dev libbenchmark-dev pybind11-dev python3-dev python3 python3-ase python3-ipykernel python3-jsonschema python3-matplotlib python3-meshio python3-nbconvert python3-numpy python3-vtk9 python3-yaml xauth iproute2 paraview libqt5svg5 procps calculix-ccx chromium chromium-driver blender draco gltfpack clang-format clang-tidy)
python=(pybind11-dev python3-dev python3-numpy)
package=(pybind11-dev python3-dev dpkg-dev file help2man)
bench=(libbenchmark-dev libgtest-dev python3)
ci=(ccache debootstrap debian-archive-keyring git)
dispensable=(calculix-ccx libqt5svg5 blender draco gltfpack)  # Debian 13 has no ccx; tests that need one are skipped; icons of ParaView's buttons

print_only=false
if [ "${1:-}" = --list ]; then
  print_only=true
  shift
fi
wanted=()
for list in "$@"; do
  case $list in
    build) wanted+=("${build[@]}") ;;
    python) wanted+=("${python[@]}") ;;
    test) wanted+=("${test[@]}") ;;
    package) wanted+=("${package[@]}") ;;
    bench) wanted+=("${bench[@]}") ;;
    ci) wanted+=("${ci[@]}") ;;
    *) echo "install_packages.sh: '$list' is none of build, python, test, package, bench, ci" >&2; exit 2 ;;
  esac
done

if $print_only; then
  printf '%s\n' "${wanted[@]}"
  exit 0
fi
missing=()
for package in "${wanted[@]}"; do
  status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
  [ "$status" = "install ok installed" ] || missing+=("$package")
done
# Without lists of apt nothing can be told, and all stay.
leave_out_unavailable() {
  local package
  [ -n "$(apt-cache show cmake 2>/dev/null)" ] || return 0
  for package in "${dispensable[@]}"; do
    [ -n "$(apt-cache show "$package" 2>/dev/null)" ] ||
      mapfile -t missing < <(printf '%s\n' "${missing[@]}" | grep -vx "$package")
  done
}
leave_out_unavailable
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || {
    echo "install_packages.sh: as root, run: apt-get install ${missing[*]}" >&2
    exit 2
  }
  as_root=(sudo)
fi
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get -qq update
leave_out_unavailable
echo "installing: ${missing[*]}" >&2
"${as_root[@]}" apt-get -qq install -y --no-install-recommends "${missing[@]}" >/dev/null
