#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# bare.sh [--suite trixie] [--tests] [--without-each] [--cache FOLDER] [--packages]: what the README says first, on a machine that
# has never seen the project: a bare root of Debian 12 (bookworm) or another release, as bare_root.sh makes it. There
# it builds this checkout's commit with tools/demo.sh, runs a scene of a mesh, builds the Python package, installs
# ParaView and looks at both runs with it. --tests runs tests/run.sh as well; --without-each breaks optional packages,
# each in turn, and configures.
# --cache shares a folder of ccache, so that what a build of this checkout has compiled is not compiled again: it looks
# at every header in the root, and where one is missing or another, the compiler does. --packages ends when the packages
# that demo.sh wants are installed, in the root that BARE_ROOT names.
# Logs and what ParaView shows are left in build/bare/SUITE. As root; takes a quarter of an hour and 5 GB.
set -euo pipefail

. "$(dirname "${BASH_SOURCE[0]}")/bare_root.sh"
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
suite=bookworm also=() cache= packages_alone=false
while [ $# -gt 0 ]; do
  case $1 in
    --suite) suite=${2:?--suite of what?}; shift ;;
    --tests) also+=(tests) ;;
    --without-each) also+=(without_each) ;;
    --cache) cache=$(realpath -m "${2:?--cache in which folder?}"); shift ;;
    --packages) packages_alone=true ;;
    *) echo "bare.sh: '$1' is none of --suite SUITE, --tests, --without-each, --cache FOLDER, --packages" >&2; exit 2 ;;
  esac
  shift
done
logs=$PWD/build/bare/$suite
mkdir -p "$logs"
own=/root/own/two_fingers
clone=${cache:+$PWD}  # compilers are told absolute paths
clone=${clone:-/root/sinew}
settings=${cache:+env CCACHE_DIR=/root/.ccache CCACHE_STATSLOG=/root/ccache.log CCACHE_BASEDIR=$PWD
  CCACHE_SLOPPINESS=pch_defines,time_macros,locale CMAKE_CXX_COMPILER_LAUNCHER=ccache}

fail() {
  echo "$*" >&2
  exit 1
}

in_clone() { in_root sh -c "cd '$clone' && $1"; }

clone() {
  git -c safe.directory="$PWD" diff --quiet HEAD || echo "bare.sh: changes that are not committed are left out" >&2
  in_root rm -rf "$clone" /root/own
  mkdir -p "$root$clone"
  git -c safe.directory="$PWD" archive HEAD | tar -x -C "$root$clone"
}

# By the first command of demo.sh.
packages() { in_clone "$(grep -m 1 '^tools/install_packages.sh' tools/demo.sh)"; }

share_cache() {
  in_root apt-get -qq install -y --no-install-recommends ccache
  mkdir -p "$cache" "$root/root/.ccache"
  mount --bind "$cache" "$root/root/.ccache"
}

compiled_anew() {
  echo "compiled in the root: $(grep -cx cache_miss "$root/root/ccache.log") of $(grep -c '^#' "$root/root/ccache.log") object files"
}

own_mesh() {
  in_clone "mkdir /root/own && build/bin/sinew new data/meshes/two_fingers.obj -o $own.yaml &&
    build/bin/sinew run $own.yaml -o $own"
}

# DIR: a run as `sinew run` leaves it. Series by their checksums, pictures and movies to their last pixel.
check_run() {
  local file frames
  in_clone "build/bin/sinew info $1 --verify"
  for file in report.html particles.pvd surface.pvd bones.pvd view.pvsm; do
    [ -s "$root$1/$file" ] || fail "$1/$file is missing"
  done
  for file in "$root$1"/pictures/*.png; do
    [ "$(head -c 8 "$file" | od -An -tx1 | tr -d ' ')" = 89504e470d0a1a0a ] || fail "$file is no picture"
    in_root ffmpeg -v error -xerror -i "${file#"$root"}" -f null - || fail "$file is damaged"
    [ "$(stat -c %s "$file")" -gt 10000 ] || fail "$file is empty"
  done
  frames=$(in_root ffprobe -v error -count_frames -select_streams v -show_entries stream=nb_read_frames -of csv=p=0 \
    "$1/pictures/movie.mp4")
  [ "$frames" -ge 30 ] || fail "the movie of $1 has $frames frames"
}

check_runs() {
  check_run "$clone/out/box_bend"
  check_run "$own"
}

# PICTURE COMMAND
look() {
  in_clone "tests/campaigns/screenshot.sh /root/$1 $2"
  cp "$root/root/$1" "$logs/"
}

# By the page's own lines: what it installs and builds, and its first recipe.
python_package() {
  local page=lib/python/README.md
  in_clone "$(sed -n 's/^    sudo \(apt-get\) \(install pybind11.*\)/\1 -qq -y \2/p' $page)"
  in_clone "$(sed -n 's/^    sudo \(apt-get\) \(install python3-meshio.*\)/\1 -qq -y \2/p' $page)"
  awk '/^```python/ {inside = 1; next} /^```/ && inside {exit} inside' $page > "$root/root/recipe.py"
  echo 'print(body); assert len(body) > 1000' >> "$root/root/recipe.py"
  in_clone "PYTHONPATH=build/python /usr/bin/python3 /root/recipe.py"
}

tests() { in_clone tests/run.sh; }

# Prints what configuring reports as left out.
left_out() {
  in_clone "rm -rf /root/tried && cmake -S . -B /root/tried -G Ninja -DSINEW_TESTS=OFF >/root/tried.log" || return
  grep '^-- Without' "$root/root/tried.log" || true
}

# Each package is removed from below those that depend on it, as an interrupted installation leaves them.
without_each() {
  local package lines python
  python=$(in_root python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')
  local optional=(lammps liblammps-dev libopenmpi-dev pybind11-dev "libpython$python-dev" doxygen)
  in_root apt-get -qq install -y --no-install-recommends "${optional[@]}" openmpi-bin python3-dev
  lines=$(left_out)
  [ -z "$lines" ] || fail "with all packages: $lines"
  for package in "${optional[@]}" openmpi-bin python3-dev; do
    in_root dpkg --force-depends --remove "$package"
    lines=$(left_out)
    echo "without $package: $lines"
    [ "$(grep -c . <<< "$lines")" -le 1 ] || fail "without $package: more than one line"
    [[ -n $lines || $package = openmpi-bin || $package = python3-dev ]] || fail "without $package: nothing is left out"
    in_root apt-get -qq install -y --no-install-recommends "$package"
  done
}

make_bare_root "$suite"
took SECONDS root
stage clone clone
stage packages packages
if $packages_alone; then exit; fi
[ -z "$cache" ] || stage cache share_cache
stage demo in_clone "$(tr '\n' ' ' <<< "$settings") tools/demo.sh"
[ -z "$cache" ] || compiled_anew
stage own_mesh own_mesh
stage files check_runs
stage python_package python_package
stage paraview in_root apt-get -qq install -y --no-install-recommends paraview
stage view look view.png "build/bin/sinew view out/box_bend"
stage state look state.png "paraview --state=$own/view.pvsm"
for more in "${also[@]}"; do stage "$more" "$more"; done
