#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# demo.sh: builds sinew and bends the paper's box, from mesh to pictures and report.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
tools/install_packages.sh build python
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DSINEW_TESTS=OFF -DSINEW_OWN_PROCESSOR=ON >/dev/null
cmake --build build
build/bin/sinew run --force configs/box_bend.yaml

cat <<END

The run is in $PWD/out/box_bend:
  report.html                  what happened, in numbers and charts
  pictures/contact_sheet.png   the body at rest, half way, bent, and back
  pictures/movie.mp4           the whole motion
  view.pvsm                    everything in ParaView, if it is installed: build/bin/sinew view out/box_bend
END
