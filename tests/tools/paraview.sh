#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# paraview.sh MODULES SCRIPT.py ...: runs a script with pvbatch on a display of its own. MODULES is the
# folder filled by get_paraview_python.sh.
set -euo pipefail

modules=${1:?usage: paraview.sh MODULES SCRIPT.py ...}/usr/lib/python3/dist-packages
shift
if [ ! -d "$modules/paraview" ]; then
  echo "paraview.sh: there is no $modules/paraview; call tests/tools/get_paraview_python.sh first" >&2
  exit 1
fi
export PYTHONPATH="$modules" PYTHONDONTWRITEBYTECODE=1
exec xvfb-run -a pvbatch "$@"
