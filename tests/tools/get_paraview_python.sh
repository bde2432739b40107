#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# get_paraview_python.sh FOLDER: unpacks Debian's python3-paraview there, for PYTHONPATH
# FOLDER/usr/lib/python3/dist-packages; nothing when it is there already. It is not installed because it
# conflicts with python3-vtk9, which libvtk9-dev brings along.
set -euo pipefail

folder=${1:?usage: get_paraview_python.sh FOLDER}
modules=usr/lib/python3/dist-packages/paraview
[ -d "$folder/$modules" ] && exit 0

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
chmod 755 "$work"
(cd "$work" && apt-get -qq download python3-paraview 2>log) || {
  cat "$work/log" >&2
  echo "get_paraview_python.sh: python3-paraview cannot be downloaded; run apt-get update, check the network" >&2
  exit 1
}
dpkg -x "$work"/python3-paraview_*.deb "$work/unpacked"
mkdir -p "$folder"
cp -a "$work/unpacked/." "$folder/"
