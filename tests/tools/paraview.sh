#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# paraview.sh MODULES SCRIPT.py ...: runs a script with pvbatch on a display of its own. MODULES is the
# folder filled by get_paraview_python.sh.
set -euo pipefail

here=$(dirname "${BASH_SOURCE[0]}")
modules=$(realpath -m "${1:?usage: paraview.sh MODULES SCRIPT.py ...}")/usr/lib/python3/dist-packages
shift
if [ ! -d "$modules/paraview" ]; then
  echo "paraview.sh: there is no $modules/paraview; call tests/tools/get_paraview_python.sh first" >&2
  exit 1
fi
export PYTHONPATH="$modules" PYTHONDONTWRITEBYTECODE=1
# Open MPI removes the folder of its sessions when it ends, also from under a program that begins.
OMPI_MCA_orte_tmpdir_base=$(mktemp -d)
export OMPI_MCA_orte_tmpdir_base
# Its daemon may still be removing its folder.
trap 'rm -rf "$OMPI_MCA_orte_tmpdir_base" 2>/dev/null || true' EXIT
trap 'exit 143' TERM INT
setpriv --pdeathsig TERM "$here/on_display.sh" pvbatch "$@" &
wait $!
