#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs all cases and writes their results into README.md.
#   tests/validation/run.sh            # a quarter of an hour
#   tests/validation/run.sh --check    # fails where a result is not within its share, or README.md differs
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source=$(cd "$here/../.." && pwd)
out=$source/build/validation
[ -x "$source/build/bin/sinew" ] || { echo "build sinew first: cmake --build build" >&2; exit 2; }
"$source/tools/install_packages.sh" test
picture=$source/data/pictures/paper_and_elasticity.png
[ "${1:-}" != --check ] || picture=$out/paper.png
/usr/bin/python3 "$here/validate.py" "$source/build/bin" "$out" || failed=1
/usr/bin/python3 "$here/paper_figure.py" "$source/build/bin" "$out" "$picture" || failed=1
/usr/bin/python3 "$here/validate.py" --page "$out/results.json" "$here/README.md" ${1:+"$1"}
exit "${failed:-0}"
