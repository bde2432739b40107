# SPDX-License-Identifier: GPL-3.0-or-later
# object_files.sh: what bare.sh --objects BUILD takes from a finished build, so that a bare root need not compile it
# again: object files, precompiled headers and Ninja's records of what they were made from, all with their times. The
# clone lies at the same path there, and Ninja looks in the root for every header of every object: where one is missing
# or newer, it compiles, and that fails without the package. Configuring, generating, archives, linking and
# whatever the programs need when they run are the root's own. For scripts that have sourced bare_root.sh.

# Their names below a build. CMake writes the sources of precompiled headers and of sources compiled together anew, and
# keeps the time of what has not changed.
object_files() {
  (cd "$1" && find . -path ./tests -prune -o -path ./probes -prune -o -type f \( -name '*.o' -o -name '*.gch' -o \
    -name .ninja_log -o -name .ninja_deps -o -name 'cmake_pch.hxx*' -o -path '*/Unity/unity_*.cxx' \) -print)
}

# BUILD: copies them into $root$clone/build. Sources that are those of this checkout get their times; others, not
# committed here, are new.
seed_objects() {
  local file
  git -c safe.directory="$PWD" ls-tree -rz --name-only HEAD | while read -r -d '' file; do
    if cmp -s "$file" "$root$clone/$file"; then
      touch -hr "$file" "$root$clone/$file"
    else
      touch "$root$clone/$file"
    fi
  done
  mkdir -p "$root$clone/build"
  object_files "$1" | tar -c -C "$1" -T - | tar -x -C "$root$clone/build"
}

# Files outside of the clone that its compilers have read, and the compiler.
read_by_compilers() {
  in_clone "ninja -C build -t deps" | awk -v own="$clone/" '/^    \// && index($1, own) != 1 {print $1}' | sort -u
  in_root g++ -print-prog-name=cc1plus
}

# Lists in $logs/differ those that are others in the root than on this machine, whose object files prove nothing then.
same_compilation() {
  local file
  read_by_compilers | while read -r file; do
    cmp "$file" "$root$file" 2>/dev/null || echo "$file"
  done > "$logs/differ"
  echo "compiled in the root: $(grep -c 'Building CXX object' "$logs/demo.log") objects"
}
