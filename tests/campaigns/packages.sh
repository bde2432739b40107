#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# packages.sh PACKAGES: installs the Debian packages in a bare root of Debian 12 (bare_root.sh, apt alone), runs a
# shipped scene, reads the manual, completes words in bash and zsh, runs a Python script, links a program, removes
# all without a trace, and installs all at once over older ones. As root; takes minutes and 2 GB.
set -euo pipefail

packages=$(realpath "${1:?usage: packages.sh PACKAGES}")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$here/bare_root.sh"
make_bare_root bookworm
mkdir "$root/packages"
cp "$packages"/*.deb "$root/packages/"

in_root apt-get -qq install -y --no-install-recommends man-db bash-completion zsh >/dev/null
rm -f "$root/etc/dpkg/dpkg.cfg.d/"*  # minimal images leave manuals out
in_root find / -xdev -name '*sinew*' -not -path '/packages/*' -not -path '/var/cache/man/*' > "$root/before"
in_root dpkg -l | awk '{print $2}' > "$root/had"
start=$SECONDS
in_root sh -c 'apt-get -qq install -y --no-install-recommends ffmpeg /packages/sinew_*.deb /packages/python3-sinew_*.deb >/dev/null'
installed=$SECONDS
in_root sh -c 'cd /root && sinew run /usr/share/sinew/configs/box_bend.yaml --quiet'
echo "installed in $((installed - start)) s, first pictures $((SECONDS - installed)) s later"
test -s "$root/root/out/box_bend/pictures/contact_sheet.png"
in_root man sinew-fill | grep -q -- --radius
in_root man 5 sinew-scene | grep -q young_modulus
in_root bash -c '
  . /usr/share/bash-completion/bash_completion; _completion_loader sinew || true
  COMP_WORDS=(sinew run --set material.you) COMP_CWORD=3; compopt() { :; }; _sinew; echo "${COMPREPLY[*]}"' |
  grep -qx 'material.young_modulus='
in_root zsh -c '
  autoload -Uz compinit; compinit -u; autoload -Uz _sinew
  compadd() { print -l -- $found }; words=(sinew run --set material.you); CURRENT=4; _sinew' |
  grep -q 'material.young_modulus='
in_root python3 -c '
import sinew
body = sinew.fill("/usr/share/sinew/data/meshes/box.obj", count=1000)
print(len(body), "particles by Python")'
in_root sh -c 'apt-get -qq purge -y sinew python3-sinew >/dev/null && apt-get -qq autoremove -y >/dev/null'
in_root find / -xdev -name '*sinew*' -not -path '/packages/*' -not -path '/var/cache/man/*' -not -path '/root/*' > "$root/after"
diff "$root/before" "$root/after"
echo "removed without a trace"

in_root sh -c 'apt-get -qq install -y --no-install-recommends g++ cmake ninja-build /packages/libsinew-dev_*.deb >/dev/null'
cp -r "$here/../../lib/examples" "$root/root/examples"
in_root sh -c 'cd /root && cmake -S examples -B b -G Ninja -DCMAKE_CXX_FLAGS=-O0 >/dev/null && cmake --build b --target fill_mesh >/dev/null
  printf "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n" > t.obj && b/fill_mesh t.obj t.vtu'

# All at once, over older ones, and away again.
mkdir "$root/older"
for package in "$root"/packages/*.deb; do
  dpkg-deb -R "$package" "$root/unpacked"
  sed -i -E 's/^Version: .*/Version: 0.0.1/; s/(sinew[a-z3-]* \(= )[0-9.]+/\10.0.1/g' "$root/unpacked/DEBIAN/control"
  dpkg-deb -b "$root/unpacked" "$root/older/$(basename "$package")" >/dev/null
  rm -rf "$root/unpacked"
done
in_root sh -c 'apt-get -qq purge -y libsinew-dev >/dev/null'  # the present version
in_root sh -c 'apt-get -qq install -y /older/*.deb >/dev/null'
in_root sh -c 'apt-get -qq install -y /packages/*.deb >/dev/null'
in_root dpkg-query -W -f '${Package} ${Version} ${Status}\n' sinew libsinew-dev python3-sinew sinew-paraview
in_root sh -c 'cd /root && sinew --version && python3 -c "import sinew"'
in_root sh -c 'apt-get -qq purge -y "*sinew*" >/dev/null && apt-get -qq autoremove -y >/dev/null'
in_root find / -xdev -name '*sinew*' -not -path '/packages/*' -not -path '/var/cache/man/*' -not -path '/older/*' -not -path '/root/*' > "$root/after"
diff "$root/before" "$root/after"
echo "all packages install together, over older ones, and leave without a trace"
