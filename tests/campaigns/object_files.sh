# SPDX-License-Identifier: GPL-3.0-or-later
# object_files.sh: what bare.sh --objects BUILD takes from a finished build, so that a bare root need not compile it
# again: object files, precompiled headers and Ninja's records of what they were made from, all with their times. The
# clone lies at the same path there, and Ninja looks in the root for every header of every object: where one is missing
# or newer, it compiles, and without the package that fails. Configuring, generating, archives, linking and whatever
# the programs need when they run are the root's own. For scripts that have sourced bare_root.sh.

# Packages by the first command of demo.sh, so that headers can be compared before it builds.
packages() { in_clone "$(grep -m 1 '^tools/install_packages.sh' tools/demo.sh)"; }

# Their names below a build. CMake writes the other files listed here anew, and keeps the time of what has not changed.
object_files() {
  (cd "$1" && find . -path ./tests -prune -o -path ./probes -prune -o -type f \( -name '*.o' -o -name '*.gch' -o \
    -name .ninja_log -o -name .ninja_deps -o -name 'cmake_pch.hxx*' -o -path '*/Unity/unity_*.cxx' -o \
    -name 'vtkModuleAutoInit_*.h' \) -print)
}

# BUILD: the root's packages may be newer than those of this machine. Headers that differ become new, so that
# their objects are compiled anew.
date_headers() {
  local file
  ninja -C "$1" -t deps | awk -v own="$PWD/" '/^    \// && index($1, own) != 1 {print $1}' | sort -u |
    (xargs -d '\n' sha1sum 2>/dev/null || true) | sed "s|  /|  $root/|" |
    (sha1sum --check --quiet --ignore-missing 2>/dev/null || true) | sed -n 's/: FAILED$//p' |
    while read -r file; do
      touch "$file"
      echo "not as here: ${file#"$root"}"
    done
}

# BUILD: copies its object files into $root$clone/build, where they tell of this commit and of the root's compiler.
seed_objects() {
  local compiler
  compiler=$(g++ -print-prog-name=cc1plus)
  if ! cmp "$compiler" "$root$compiler" || ! git -c safe.directory="$PWD" diff --quiet HEAD; then
    echo "another compiler, or sources that are not committed: all is compiled there"
    return
  fi
  git -c safe.directory="$PWD" ls-files -z | tar -c --null -T - | tar -x -C "$root$clone"  # with their times
  date_headers "$1"
  mkdir -p "$root$clone/build"
  object_files "$1" | tar -c -C "$1" -T - | tar -x -C "$root$clone/build"
}

compiled_anew() { echo "compiled in the root: $(grep -c 'Building CXX object' "$logs/demo.log" || true) object files"; }
