#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# make_packages.sh BUILD: the Debian packages sinew, libsinew-dev, python3-sinew and sinew-lammps, into
# BUILD/packages. Installs and configures what BUILD lacks for them. What `cmake --build BUILD --target packages` runs.
set -euo pipefail

build=$(realpath "${1:?usage: make_packages.sh BUILD}")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
"$here/../install_packages.sh" build package
cmake "$build" -DSINEW_PYTHON=ON -DSINEW_OWN_PROCESSOR=OFF >/dev/null
cmake --build "$build" --target programs sinew_all_rooms sinew-tables sinew_python

pages=$build/share/man
rm -rf "$pages"
mkdir -p "$pages/man1" "$pages/man5"
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git -C "$here" log -1 --format=%ct 2>/dev/null || date +%s)}
manual() {  # PROGRAM PURPOSE
  help2man --no-info --name "$2" "$build/bin/$1" |
    sed -e "s/^\.TH SINEW /.TH ${1^^} /" -e "s/^sinew \\\\- /${1/-/\\\\-} \\\\- /" > "$pages/man1/$1.1"
  gzip -9n "$pages/man1/$1.1"
}
manual sinew "bends elastic bodies with a skeleton"
for program in $("$build/bin/sinew" --help | awk '/^$/ { listed = 0 } listed { print $1 } /^Commands:/ { listed = 1 }'); do
  purpose=$("$build/bin/sinew-$program" --help | head -1)
  manual "sinew-$program" "$(sed -e 's/\.$//' -e 's/^./\L&/' <<< "$purpose")"
done
"$build/bin/sinew-tables" manual | gzip -9n > "$pages/man5/sinew-scene.5.gz"
version=$("$build/bin/sinew" --version)
gzip -9n > "$build/share/changelog.gz" <<END
sinew (${version#sinew }) unstable; urgency=medium

  * See CHANGELOG.md.

 -- the authors of sinew <sinew@example.org>  $(date -R -u -d "@$SOURCE_DATE_EPOCH")
END

cd "$build"
rm -rf packages
cpack -G DEB --config CPackConfig.cmake -B packages >/dev/null
rm -rf packages/_CPack_Packages
ls packages
